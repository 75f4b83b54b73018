/* reveal.c - see reveal.h. */
#include "stages/trace_ids/reveal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "common/image/exr.h"

static const double SAME_PLANE = 1e-6; /* of the offset's magnitude or 1 */

static enum status add_layer(struct revealed *r, struct err *err)
{
    const size_t pixels = (size_t)r->width * (size_t)r->height, layers = (size_t)r->layers + 1;
    uint32_t **id = realloc(r->id, layers * sizeof *id);
    if (id) r->id = id;
    float **z = realloc(r->z, layers * sizeof *z);
    if (z) r->z = z;
    if (!id || !z) return err_nomem(err, "layers", layers * sizeof *z);
    r->id[r->layers] = calloc(pixels, sizeof **r->id);
    r->z[r->layers] = calloc(pixels, sizeof **r->z);
    r->layers++;
    return r->id[r->layers - 1] && r->z[r->layers - 1] ? ST_OK : err_nomem(err, "a layer", pixels * sizeof **r->z);
}

/* The face of the unedited model with this face's id and plane; -1: none. */
static int counterpart(const struct solid_mesh *base, const struct solid_mesh *edit, int face)
{
    const struct solid_face *f = &edit->faces[face];
    const int id = solid_face_id(edit, face);
    for (int i = 0; i < base->face_count; i++) {
        const struct solid_face *g = &base->faces[i];
        if (solid_face_id(base, i) == id && vec3_dot(f->normal, g->normal) > 1 - SAME_PLANE &&
            fabs(f->offset - g->offset) <= SAME_PLANE * (1 + fabs(g->offset)))
            return i;
    }
    return -1;
}

/* Puts a surface into a pixel's layers, in order of depth, unless it is there. */
static enum status insert(struct revealed *r, size_t at, uint32_t id, float z, struct err *err)
{
    int k = 0;
    while (k < r->layers && r->id[k][at] && (r->z[k][at] < z || (r->z[k][at] == z && r->id[k][at] < id))) k++;
    for (int i = 0; i < r->layers && r->id[i][at]; i++)
        if (r->id[i][at] == id && fabsf(r->z[i][at] - z) <= 1e-4f * z) return ST_OK;
    if (!r->layers || r->id[r->layers - 1][at]) {
        if (add_layer(r, err)) return err->status;
    }
    for (int i = r->layers - 1; i > k; i--) r->id[i][at] = r->id[i - 1][at], r->z[i][at] = r->z[i - 1][at];
    r->id[k][at] = id;
    r->z[k][at] = z;
    return ST_OK;
}

static bool same_surface(const struct solid_mesh *m, int a, int b)
{
    return a == b || (a >= 0 && b >= 0 && m->faces[a].name == m->faces[b].name &&
                      fabs(m->faces[a].offset - m->faces[b].offset) <= SAME_PLANE * (1 + fabs(m->faces[a].offset)));
}

static enum status add_edit(struct revealed *r, const struct solid_mesh *base, const struct view_faces *shown,
                            const struct solid_mesh *edit, const struct view *camera, struct err *err)
{
    struct ray_scene rays = {0};
    const size_t pixels = (size_t)r->width * (size_t)r->height;
    int32_t *face = malloc(pixels * sizeof *face);
    float *z = malloc(pixels * sizeof *z);
    int *of_base = malloc(((size_t)edit->face_count + 1) * sizeof *of_base);
    enum status st = face && z && of_base ? model_rays_make(&rays, edit, true, err)
                                          : err_nomem(err, "an edit's faces", pixels * sizeof *z);
    if (!st) model_rays_view(face, z, &rays, camera);
    for (int i = 0; !st && i < edit->face_count; i++) of_base[i] = counterpart(base, edit, i);
    for (size_t i = 0; !st && i < pixels; i++) {
        const int known = face[i] < 0 ? -1 : of_base[face[i]];
        if (known >= 0 && !same_surface(base, known, shown->face[i]))
            st = insert(r, i, (uint32_t)solid_face_id(base, known), z[i], err);
    }
    ray_scene_release(&rays);
    free(face);
    free(z);
    free(of_base);
    return st;
}

enum status reveal_find(struct revealed *r, const struct solid_mesh *base, const struct view_faces *shown,
                        const struct solid_mesh *edits, int edit_count, const struct view *camera, struct err *err)
{
    enum status st = ST_OK;
    *r = (struct revealed){shown->width, shown->height, 0, NULL, NULL};
    for (int e = 0; !st && e < edit_count; e++) st = add_edit(r, base, shown, &edits[e], camera, err);
    return st;
}

void reveal_release(struct revealed *r)
{
    for (int k = 0; k < r->layers; k++) {
        free(r->id[k]);
        free(r->z[k]);
    }
    free(r->id);
    free(r->z);
    *r = (struct revealed){0};
}

static bool same_bytes(const char *a, const char *b)
{
    FILE *p = fopen(a, "rb"), *q = fopen(b, "rb");
    bool same = p && q;
    int c = 0;
    while (same && c != EOF) same = (c = getc(p)) == getc(q);
    if (p) fclose(p);
    if (q) fclose(q);
    return same;
}

enum status reveal_write(const struct revealed *r, double scale, const char *path, const struct provenance *prov,
                         struct err *err)
{
    const size_t pixels = (size_t)r->width * (size_t)r->height;
    struct exr_image exr = {0};
    struct exr_plane *plane;
    char fresh[FILE_PATH], name[EXR_NAME_SIZE];
    enum status st = exr_image_init(&exr, r->width, r->height, err);
    for (int k = 0; !st && k < (r->layers ? r->layers : 1); k++) {
        snprintf(name, sizeof name, "layer%d.id", k);
        st = exr_add_plane(&exr, name, EXR_UINT, &plane, err);
        if (!st && r->layers) memcpy(plane->u, r->id[k], pixels * sizeof *plane->u);
        snprintf(name, sizeof name, "layer%d.Z", k);
        if (!st) st = exr_add_plane(&exr, name, EXR_FLOAT, &plane, err);
        for (size_t i = 0; !st && r->layers && i < pixels; i++) plane->f[i] = (float)(r->z[k][i] / scale);
    }
    if (!st && snprintf(fresh, sizeof fresh, "%s.new", path) >= (int)sizeof fresh)
        st = err_set(err, ST_USAGE, "%s: the path is too long.", path);
    if (!st) st = exr_write(&exr, fresh, prov, err);
    if (!st && same_bytes(fresh, path))
        unlink(fresh);
    else if (!st && rename(fresh, path))
        st = err_set(err, ST_IO, "%s cannot be put in place of %s: %m.", fresh, path);
    exr_image_release(&exr);
    return st;
}
