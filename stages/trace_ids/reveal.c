/* reveal.c - surfaces of the unedited model that a view would see after an edit.
 *
 * An atlas must hold texture for what an edit can reveal: the street wall behind a partition that is removed, the floor
 * that a wider door shows. The view is traced in each edited model. A pixel's face there counts if the unedited model
 * has a face of the same id on the same plane (its normal and offset agree within 1e-6 of the model's size), and does
 * not show it in this pixel. Faces that only the edit has get their texture otherwise, and are left out. Its depth is
 * that of the unedited model's plane, so that two edits that reveal one surface add it once, with the same bits. */
#include "stages/trace_ids/reveal.h"

#include <stdlib.h>

#include "common/base/array.h"

#define SAME_PLANE 1e-6 /* of the model's size */

void reveal_release(struct reveal *r)
{
    if (!r) return;
    for (int k = 0; k < r->layers; k++) free(r->faces[k]);
    free(r->faces);
    *r = (struct reveal){0};
}

static bool same_surface(const struct solid_mesh *a, int f, const struct solid_mesh *b, int g, double reach)
{
    const struct solid_face *p = &a->faces[f], *q = &b->faces[g];
    return solid_face_id(a, f) == solid_face_id(b, g) && vec3_length(vec3_sub(p->normal, q->normal)) <= SAME_PLANE &&
           fabs(p->offset - q->offset) <= reach;
}

/* Sets to[i], for each face of `mesh`, to 1 + the first face of the base on the same surface; 0: there is none. */
static void map_surfaces(uint32_t *to, const struct solid_mesh *mesh, const struct solid_mesh *base, const int *by_id,
                         const int *first, int ids, double reach)
{
    for (int i = 0; i < mesh->face_count; i++) {
        const int id = solid_face_id(mesh, i);
        for (int k = id < ids ? first[id] : 0; id < ids && !to[i] && k < first[id + 1]; k++)
            if (same_surface(mesh, i, base, by_id[k], reach)) to[i] = (uint32_t)by_id[k] + 1;
    }
}

/* The faces of a mesh in order of id: those of id k from first[k] to first[k + 1]. */
static void sort_faces(int *by_id, int *first, const struct solid_mesh *mesh, int ids)
{
    for (int i = 0; i < mesh->face_count; i++) first[solid_face_id(mesh, i) + 1]++;
    for (int k = 0; k < ids; k++) first[k + 1] += first[k];
    for (int i = 0; i < mesh->face_count; i++) by_id[first[solid_face_id(mesh, i)]++] = i;
    for (int k = ids; k > 0; k--) first[k] = first[k - 1];
    first[0] = 0;
}

/* Surfaces of the edited and of the base model, by face. Owned. */
struct surfaces {
    uint32_t *edited, *base;
};

static enum status find_surfaces(struct surfaces *s, const struct model_rays *edited, const struct model_rays *base,
                                 struct err *err)
{
    const int ids = base->ids;
    const double reach = SAME_PLANE * model_rays_size(base);
    int *first = calloc((size_t)ids + 2, sizeof *first);
    int *by_id = calloc((size_t)base->mesh.face_count + 1, sizeof *by_id);
    s->edited = calloc((size_t)edited->mesh.face_count + 1, sizeof *s->edited);
    s->base = calloc((size_t)base->mesh.face_count + 1, sizeof *s->base);
    if (!first || !by_id || !s->edited || !s->base) err_nomem(err, "surfaces", (size_t)ids * 4);
    if (!err->status) {
        sort_faces(by_id, first, &base->mesh, ids);
        map_surfaces(s->edited, &edited->mesh, &base->mesh, by_id, first, ids, reach);
        map_surfaces(s->base, &base->mesh, &base->mesh, by_id, first, ids, reach);
    }
    free(first);
    free(by_id);
    return err->status;
}

static enum status add_layer(struct reveal *r, struct err *err)
{
    const size_t pixels = (size_t)r->base->width * (size_t)r->base->height;
    if (array_append(&r->faces, (size_t)r->layers, sizeof *r->faces, "layers", err)) return err->status;
    r->faces[r->layers] = calloc(pixels, sizeof **r->faces);
    if (!r->faces[r->layers]) return err_nomem(err, "a layer of revealed surfaces", pixels * sizeof **r->faces);
    r->layers++;
    return ST_OK;
}

static double depth_of(const struct reveal *r, uint32_t face, size_t pixel)
{
    const size_t width = (size_t)r->base->width;
    return 1 / view_trace_inverse_depth(r->base, face, (double)(pixel % width) + 0.5, (double)(pixel / width) + 0.5);
}

/* Puts a face into a pixel's list, which is in order of depth, then of id. */
static enum status insert(struct reveal *r, size_t pixel, uint32_t face, double z, struct err *err)
{
    int at = 0;
    for (; at < r->layers && r->faces[at][pixel]; at++) {
        if (r->faces[at][pixel] == face) return ST_OK;
        const double there = depth_of(r, r->faces[at][pixel], pixel);
        if (there > z || (there >= z && r->faces[at][pixel] > face)) break;
    }
    for (; face; at++) {
        if (at == r->layers && add_layer(r, err)) return err->status;
        const uint32_t next = r->faces[at][pixel];
        if (next == face) return ST_OK;
        r->faces[at][pixel] = face;
        face = next;
    }
    return ST_OK;
}

enum status reveal_add(struct reveal *r, const struct view_trace *edited, int64_t *pixels, struct err *err)
{
    const size_t count = (size_t)r->base->width * (size_t)r->base->height;
    struct surfaces s = {0};
    *pixels = 0;
    if (r->base->in_solid) return ST_OK;
    find_surfaces(&s, edited->model, r->base->model, err);
    for (size_t i = 0; !err->status && i < count; i++) {
        const uint32_t face = edited->faces[i] ? s.edited[edited->faces[i] - 1] : 0, now = r->base->faces[i];
        if (!face || (now && s.base[now - 1] == face)) continue;
        const double z = depth_of(r, face, i);
        if (!((float)z > 0 && isfinite((float)z))) continue; /* a plane through the camera */
        (*pixels)++;
        insert(r, i, face, z, err);
    }
    free(s.edited);
    free(s.base);
    return err->status;
}

enum status reveal_result(struct view_reveal *result, const struct reveal *r, struct err *err)
{
    const size_t count = (size_t)r->base->width * (size_t)r->base->height;
    if (view_reveal_init(result, r->base->width, r->base->height, r->layers, err)) return err->status;
    for (int k = 0; k < r->layers; k++)
        for (size_t i = 0; i < count; i++) {
            const uint32_t face = r->faces[k][i];
            if (!face) continue;
            result->id[k][i] = (uint32_t)solid_face_id(&r->base->model->mesh, (int)face - 1);
            result->z[k][i] = (float)depth_of(r, face, i);
        }
    return ST_OK;
}
