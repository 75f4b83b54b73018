/* thing_volume.c - grids of voxels, and the file of which thing each belongs to; see thing_volume.h. */
#include "common/model/thing_volume.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/image/exr.h"

int64_t thing_voxel_at(const struct voxel_grid *g, struct vec3 p)
{
    const double x = floor((p.x - g->origin.x) / g->voxel), y = floor((p.y - g->origin.y) / g->voxel),
                 z = floor((p.z - g->origin.z) / g->voxel);
    if (!(x >= 0 && y >= 0 && z >= 0 && x < g->size[0] && y < g->size[1] && z < g->size[2])) return -1;
    return ((int64_t)z * g->size[1] + (int64_t)y) * g->size[0] + (int64_t)x;
}

struct vec3 thing_voxel_centre(const struct voxel_grid *g, int64_t at)
{
    const int64_t x = at % g->size[0], y = at / g->size[0] % g->size[1], z = at / g->size[0] / g->size[1];
    return vec3_add(g->origin, vec3_scale(vec3_make((double)x + 0.5, (double)y + 0.5, (double)z + 0.5), g->voxel));
}

float thing_volume_distance(const struct thing_volume *v, uint32_t id, struct vec3 p)
{
    const struct voxel_grid *g = &v->grid;
    const double x = (p.x - g->origin.x) / g->voxel - 0.5, y = (p.y - g->origin.y) / g->voxel - 0.5,
                 z = (p.z - g->origin.z) / g->voxel - 0.5;
    if (!(x >= 0 && y >= 0 && z >= 0 && x < g->size[0] - 1 && y < g->size[1] - 1 && z < g->size[2] - 1))
        return THING_UNSEEN;
    const size_t i = (size_t)x, j = (size_t)y, k = (size_t)z, row = (size_t)g->size[0],
                 slice = row * (size_t)g->size[1], at = k * slice + j * row + i;
    const float a = (float)(x - (double)i), b = (float)(y - (double)j), c = (float)(z - (double)k);
    float sum = 0;
    for (size_t n = 0; n < 8; n++) {
        const size_t voxel = at + (n & 1) + (n >> 1 & 1) * row + (n >> 2) * slice;
        const float d = v->distance[voxel];
        if (v->id[voxel] != id || d == THING_UNSEEN) return THING_UNSEEN;
        sum += d * (n & 1 ? a : 1 - a) * (n >> 1 & 1 ? b : 1 - b) * (n >> 2 ? c : 1 - c);
    }
    return sum;
}

struct vec3 thing_volume_normal(const struct thing_volume *v, uint32_t id, struct vec3 p)
{
    static const struct vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double slope[3];
    for (int k = 0; k < 3; k++) {
        const struct vec3 step = vec3_scale(axes[k], v->grid.voxel);
        const float after = thing_volume_distance(v, id, vec3_add(p, step)),
                    before = thing_volume_distance(v, id, vec3_sub(p, step));
        if (after >= THING_UNSEEN || before >= THING_UNSEEN) return vec3_make(0, 0, 0);
        slope[k] = (double)(after - before);
    }
    const struct vec3 n = vec3_make(slope[0], slope[1], slope[2]);
    return vec3_length(n) > 0 ? vec3_normalize(n) : n;
}

enum status thing_volume_write(const struct thing_volume *v, const char *path, const struct provenance *prov,
                               struct err *err)
{
    const struct voxel_grid *g = &v->grid;
    struct exr_image im = {0};
    struct exr_plane *id, *distance;
    if (!exr_image_init(&im, g->size[0], g->size[1] * g->size[2], err) &&
        !exr_add_plane(&im, "id", EXR_UINT, NULL, err) && !exr_add_plane(&im, "distance", EXR_HALF, NULL, err) &&
        !exr_set_number(&im, "voxel", g->voxel, err) && !exr_set_number(&im, "slices", g->size[2], err) &&
        !exr_set_number(&im, "origin_x", g->origin.x, err) && !exr_set_number(&im, "origin_y", g->origin.y, err) &&
        !exr_set_number(&im, "origin_z", g->origin.z, err)) {
        id = exr_find(&im, "id");
        distance = exr_find(&im, "distance");
        memcpy(id->u, v->id, voxel_count(g) * sizeof *v->id);
        memcpy(distance->f, v->distance, voxel_count(g) * sizeof *v->distance);
        exr_write(&im, path, prov, err);
    }
    exr_image_release(&im);
    return err->status;
}

static enum status read_number(double *value, const struct exr_image *im, const char *name, const char *path,
                               struct err *err)
{
    const char *text = exr_attribute(im, name);
    if (text && scan_double(text, value) && isfinite(*value)) return ST_OK;
    return err_set(err, ST_DATA, "%s: attribute %s is %s, wanted a number; run find_things again.", path, name,
                   text ? text : "missing");
}

static enum status read_grid(struct voxel_grid *g, const struct exr_image *im, const char *path, struct err *err)
{
    double slices;
    if (read_number(&g->voxel, im, "voxel", path, err) || read_number(&slices, im, "slices", path, err) ||
        read_number(&g->origin.x, im, "origin_x", path, err) || read_number(&g->origin.y, im, "origin_y", path, err) ||
        read_number(&g->origin.z, im, "origin_z", path, err))
        return err->status;
    if (!(g->voxel > 0) || !(slices >= 1 && slices <= im->height) || slices != floor(slices) ||
        im->height % (int)slices)
        return err_set(err, ST_DATA,
                       "%s has %d rows for %g slices of voxels of %g; wanted as many rows in each; run find_things "
                       "again.",
                       path, im->height, slices, g->voxel);
    g->size[0] = im->width;
    g->size[1] = im->height / (int)slices;
    g->size[2] = (int)slices;
    return ST_OK;
}

enum status thing_volume_read(struct thing_volume *v, const char *path, uint32_t max_id, struct provenance *prov,
                              struct err *err)
{
    static const char *const names[] = {"id", "distance"};
    struct exr_image im = {0};
    *v = (struct thing_volume){0};
    if (exr_read_product(&im, PRODUCT_THING_VOLUME, path, names, 2, prov, err)) return err->status;
    struct exr_plane *id = exr_find(&im, "id"), *distance = exr_find(&im, "distance");
    if (!id->u || !distance->f)
        err_set(err, ST_DATA, "%s: channel %s has the wrong type; run find_things again.", path, names[id->u != NULL]);
    else if (!read_grid(&v->grid, &im, path, err)) {
        v->id = id->u;
        v->distance = distance->f;
        id->u = NULL;
        distance->f = NULL;
    }
    exr_image_release(&im);
    for (size_t i = 0; !err->status && i < voxel_count(&v->grid); i++)
        if (!(v->distance[i] >= -1 && v->distance[i] <= 1) && v->distance[i] != THING_UNSEEN)
            err_set(err, ST_DATA, "%s: voxel %zu has distance %g, wanted -1 to 1, or %g; run find_things again.", path,
                    i, (double)v->distance[i], (double)THING_UNSEEN);
        else if (v->id[i] > max_id)
            err_set(err, ST_DATA, "%s: voxel %zu is of thing %u, but there are %u; run find_things again.", path, i,
                    v->id[i], max_id);
    if (err->status) thing_volume_release(v);
    return err->status;
}

void thing_volume_release(struct thing_volume *v)
{
    if (!v) return;
    free(v->id);
    free(v->distance);
    *v = (struct thing_volume){0};
}
