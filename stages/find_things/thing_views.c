/* thing_views.c - things in the pictures of the views; see thing_views.h.
 *
 * The radiance of sides. Light is gathered from a thing whose surface with the normal n has the radiance
 * sum_k n_k^2 s_k, blended of three of its six sides [McTaggart 2004]. So the sides s are those with which this
 * blend is nearest to the pixels' radiance, by least squares. Means weighted by n_k^2 would be blended twice: a
 * table's bright top would make its sides bright, since normals of voxels lean. MIN_SIDE pixels of the mean radiance
 * are added to each side. */
#include "stages/find_things/thing_views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/cholesky.h"
#include "common/math/distance.h"
#include "stages/find_things/fuse_views.h"

enum { SIDE_STEP = 3 }; /* one in so many pixels tells of a side */

#define MIN_SIDE      10.0   /* such pixels count as much as the mean */
#define MIN_SHARE     0.0005 /* of the picture: a view with less of a thing does not count as one that shows it */
#define WHOLE         0.5    /* share of a segment's pixels that make all of it show the thing */
#define HALF_DIAGONAL 0.87   /* of a voxel */
#define CLOSED        0.008f /* of the width: half of the widest gap that is closed */
#define NEAREST       0.5    /* voxels from the camera's plane */
#define CUT           0.4    /* score of a view whose border cuts the thing */

/* The thing that most pixels of a segment show: `lead` counts up for it and down for others, so that a majority
 * wins; a second pass counts its pixels. */
struct segment_vote {
    uint32_t id;
    int lead, pixels, all;
};

static enum status fill_segments(uint32_t *mask, const struct layered_depth *d, struct err *err)
{
    const size_t pixels = (size_t)d->width * (size_t)d->height;
    struct segment_vote *list = calloc((size_t)d->segment_count + 1, sizeof *list);
    if (!list) return err_nomem(err, "the segments of a view", (size_t)d->segment_count * sizeof *list);
    for (size_t i = 0; i < pixels; i++) {
        struct segment_vote *v = &list[d->interior.id[i]];
        v->all++;
        if (!mask[i]) continue;
        if (!v->lead) v->id = mask[i];
        v->lead += v->id == mask[i] ? 1 : -1;
    }
    for (size_t i = 0; i < pixels; i++) {
        struct segment_vote *v = &list[d->interior.id[i]];
        v->pixels += mask[i] && mask[i] == v->id;
    }
    for (size_t i = 0; i < pixels; i++) {
        const struct segment_vote *v = &list[d->interior.id[i]];
        if (d->interior.id[i] && v->pixels >= WHOLE * v->all) mask[i] = v->id;
    }
    free(list);
    return ST_OK;
}

/* Clutter in narrow gaps of a thing's picture shows it, too: closes the pixels of `id` by CLOSED of the width. */
static enum status close_gaps(uint32_t *mask, uint32_t id, const struct view_ids *ids, uint8_t *inside, float *squared,
                              struct err *err)
{
    const size_t pixels = (size_t)ids->width * (size_t)ids->height;
    const float reach = CLOSED * (float)ids->width;
    for (size_t i = 0; i < pixels; i++) inside[i] = mask[i] != id;
    if (distance_squared(squared, inside, ids->width, ids->height, err)) return err->status;
    for (size_t i = 0; i < pixels; i++) inside[i] = squared[i] <= reach * reach;
    if (distance_squared(squared, inside, ids->width, ids->height, err)) return err->status;
    for (size_t i = 0; i < pixels; i++)
        if (!mask[i] && squared[i] > reach * reach && ids->clutter[i] >= CLUTTER_UNSURE) mask[i] = id;
    return ST_OK;
}

static enum status close_all(uint32_t *mask, const struct view_ids *ids, struct err *err)
{
    const size_t pixels = (size_t)ids->width * (size_t)ids->height;
    uint8_t *inside = malloc(pixels);
    float *squared = malloc(pixels * sizeof *squared);
    uint32_t most = 0;
    if (!inside || !squared) err_nomem(err, "the things of a view", pixels * 5);
    for (size_t i = 0; i < pixels; i++) most = mask[i] > most ? mask[i] : most;
    uint8_t *seen = calloc((size_t)most + 1, 1);
    if (!seen) err_nomem(err, "things", most);
    for (size_t i = 0; !err->status && i < pixels; i++) seen[mask[i]] = 1;
    for (uint32_t id = 1; !err->status && id <= most; id++)
        if (seen[id]) close_gaps(mask, id, ids, inside, squared, err);
    free(seen);
    free(inside);
    free(squared);
    return err->status;
}

enum status thing_shows_find(uint32_t *mask, const struct thing_volume *volume, const struct view *camera,
                             const struct layered_depth *depth, const struct view_ids *ids, double scale,
                             struct err *err)
{
    for (int y = 0; y < camera->height; y++)
        for (int x = 0; x < camera->width; x++) {
            const size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            mask[i] = 0;
            if (!(ids->clutter[i] > CLUTTER_UNSURE) || !(depth->interior.z[i] > 0)) continue;
            mask[i] =
                thing_volume_at(volume, view_unproject(camera, x + 0.5, y + 0.5, scale * (double)depth->interior.z[i]));
        }
    return fill_segments(mask, depth, err) || close_all(mask, ids, err) ? err->status : ST_OK;
}

void thing_meets_find(uint32_t *meets, const struct surface_voxel *voxels, size_t count, double voxel,
                      const struct view *camera, const struct view_ids *ids, double scale, float *nearest)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    for (size_t i = 0; i < pixels; i++) meets[i] = 0, nearest[i] = INFINITY;
    for (size_t k = 0; k < count; k++) {
        double u, v;
        const double z = view_project(camera, voxels[k].at, &u, &v);
        if (!(z > NEAREST * voxel)) continue;
        const double radius = HALF_DIAGONAL * voxel * camera->fx / z;
        if (!(u + radius > 0 && v + radius > 0 && u - radius < camera->width && v - radius < camera->height)) continue;
        const int left = (int)fmax(0, ceil(u - radius - 0.5)), right = (int)fmin(camera->width - 1, u + radius - 0.5),
                  top = (int)fmax(0, ceil(v - radius - 0.5)), below = (int)fmin(camera->height - 1, v + radius - 0.5);
        for (int y = top; y <= below; y++)
            for (int x = left; x <= right; x++) {
                const size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
                if (!((float)z < nearest[i]) || !(z + voxel < scale * (double)ids->z[i])) continue;
                nearest[i] = (float)z;
                meets[i] = voxels[k].id;
            }
    }
}

struct patch {
    size_t pixels;
    int low[2], high[2];
};

static double score_of(const struct patch *p, const struct view *view)
{
    const bool cut =
        p->low[0] == 0 || p->low[1] == 0 || p->high[0] == view->width - 1 || p->high[1] == view->height - 1;
    return (double)p->pixels / ((double)view->width * view->height) * (cut ? CUT : 1);
}

/* Away from the surface that a pixel shows; 0: it is not known. */
static struct vec3 normal_of_pixel(const struct thing_geometry *g, uint32_t id, size_t pixel)
{
    const size_t width = (size_t)g->camera->width;
    const double z = g->scale * (double)g->z[pixel];
    if (!(z > 0)) return vec3_make(0, 0, 0);
    const double u = (double)(pixel % width) + 0.5, v = (double)(pixel / width) + 0.5;
    return thing_volume_normal(g->volume, id, view_unproject(g->camera, u, v, z));
}

static void add_sides(struct thing_sight *s, struct vec3 normal, const float *rgb)
{
    const double n[3] = {normal.x, normal.y, normal.z};
    for (int k = 0; k < 3; k++) {
        const int side = 2 * k + (n[k] < 0);
        for (int j = 0; j < 3; j++)
            s->side_weights[side * THING_SIDES + 2 * j + (n[j] < 0)] += n[k] * n[k] * n[j] * n[j];
        for (int c = 0; c < 3; c++) s->side_sum[side][c] += n[k] * n[k] * (double)rgb[c];
    }
}

void thing_sights_add_radiance(struct thing_sight *sights, const uint32_t *mask, const struct image *photo,
                               const struct thing_geometry *geometry)
{
    for (size_t i = 0; i < (size_t)photo->width * (size_t)photo->height; i++) {
        const float *rgba = photo->data + 4 * i;
        if (!mask[i] || !(rgba[3] > 0)) continue;
        struct thing_sight *s = &sights[mask[i] - 1];
        for (int c = 0; c < 3; c++) s->sum[c] += (double)rgba[c];
        s->pixels++;
        if (geometry && i % SIDE_STEP == 0) add_sides(s, normal_of_pixel(geometry, mask[i], i), rgba);
    }
}

void thing_sight_radiance(struct thing *t, const struct thing_sight *s)
{
    double factor[THING_SIDES * THING_SIDES];
    memcpy(factor, s->side_weights, sizeof factor);
    for (int k = 0; k < THING_SIDES; k++) factor[k * THING_SIDES + k] += MIN_SIDE;
    const bool known = cholesky_factor(factor, THING_SIDES); /* always, but for overflow */
    for (int c = 0; c < 3; c++) {
        double sides[THING_SIDES];
        t->radiance[c] = s->pixels ? fmax(0, s->sum[c] / (double)s->pixels) : 0;
        for (int k = 0; k < THING_SIDES; k++) sides[k] = s->side_sum[k][c] + MIN_SIDE * t->radiance[c];
        cholesky_forward(factor, THING_SIDES, sides);
        cholesky_backward(factor, THING_SIDES, sides);
        for (int k = 0; k < THING_SIDES; k++) t->sides[k][c] = known ? fmax(0, sides[k]) : t->radiance[c];
    }
}

enum status thing_sights_add(struct thing_sight *sights, int count, const uint32_t *mask, const struct view *view,
                             int view_index, struct err *err)
{
    struct patch *list = calloc((size_t)count + 1, sizeof *list);
    if (!list) return err_nomem(err, "things of a view", (size_t)count * sizeof *list);
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++) {
            const uint32_t id = mask[(size_t)y * (size_t)view->width + (size_t)x];
            if (!id) continue;
            struct patch *p = &list[id - 1];
            const int at[2] = {x, y};
            for (int k = 0; k < 2; k++) {
                if (!p->pixels || at[k] < p->low[k]) p->low[k] = at[k];
                if (!p->pixels || at[k] > p->high[k]) p->high[k] = at[k];
            }
            p->pixels++;
        }
    for (int k = 0; k < count; k++) {
        const double score = score_of(&list[k], view);
        struct thing_sight *s = &sights[k];
        s->views += (double)list[k].pixels >= MIN_SHARE * view->width * view->height;
        if (!(score > s->score)) continue;
        s->score = score;
        s->best = view_index;
        memcpy(s->low, list[k].low, sizeof s->low);
        memcpy(s->high, list[k].high, sizeof s->high);
    }
    free(list);
    return ST_OK;
}
