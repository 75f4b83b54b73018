/* surfaces.c - the surfaces that textures are made for, and which pixels of a raster they cover.
 *
 * A surface is all faces of one id in one plane, of the unedited model and of the models of edits: edits make walls
 * longer, and their texels are to come from the same atlas. Planes are the same up to 1e-6 of the model's size.
 * Faces are sorted by id first, so that only faces of one id are compared.
 *
 * Filling. A raster is a projective map from pixels to points of the plane: (X, Y, Z, W) is linear in (x, y, 1). For
 * an edge of a triangle, with the plane through it that is square to the surface, e . (X, Y, Z, W) >= 0 on the
 * triangle's side, which is linear in the pixel too. A row of pixels inside a triangle is therefore an interval, the
 * intersection of three half lines and of W > 0, and nothing needs clipping, in any perspective.
 *
 * Cost: a row of a triangle takes four divisions and a memset; look-ups by id are binary searches. */
#include "common/texture/surfaces.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"

#define SAME_PLANE   1e-6 /* of the model's size */
#define SAME_NORMALS 1e-6 /* 1 - cosine */

static bool same_plane(const struct surface *a, struct vec3 normal, double offset, double size)
{
    return vec3_dot(a->normal, normal) > 1 - SAME_NORMALS && fabs(a->offset - offset) <= SAME_PLANE * size;
}

static double size_of(const struct solid_mesh *models, int count)
{
    double size = 0;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < models[k].vertex_count; i++) {
            const struct vec3 p = models[k].vertices[i].p;
            size = fmax(size, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
        }
    return size;
}

struct face_of_id {
    int id, face;
};

/* The faces of a model in order of id, then of face, and its triangles. */
struct sorted_model {
    const struct solid_mesh *mesh;
    struct solid_triangles triangles;
    struct face_of_id *faces; /* owned */
};

static int compare_faces(const void *a, const void *b)
{
    const struct face_of_id *p = a, *q = b;
    if (p->id != q->id) return p->id < q->id ? -1 : 1;
    return p->face < q->face ? -1 : p->face > q->face;
}

static enum status sort_model(struct sorted_model *s, const struct solid_mesh *m, struct err *err)
{
    s->mesh = m;
    s->faces = malloc(((size_t)m->face_count + 1) * sizeof *s->faces);
    if (!s->faces) return err_nomem(err, "faces", (size_t)m->face_count * sizeof *s->faces);
    for (int f = 0; f < m->face_count; f++) s->faces[f] = (struct face_of_id){solid_face_id(m, f), f};
    if (m->face_count) qsort(s->faces, (size_t)m->face_count, sizeof *s->faces, compare_faces);
    return solid_mesh_triangulate(&s->triangles, m, err);
}

static bool face_is_below(const void *face, const void *id)
{
    return ((const struct face_of_id *)face)->id < *(const int *)id;
}

/* The place of the first face of an id, or of the next id. */
static int first_face(const struct sorted_model *s, int id)
{
    return (int)sort_place(s->faces, (size_t)s->mesh->face_count, sizeof *s->faces, face_is_below, &id);
}

/* The surfaces of the unedited model, in order of id, then of the first face. */
static enum status list_surfaces(struct surfaces *s, const struct sorted_model *m, struct err *err)
{
    int first = 0; /* surface of the id */
    for (int i = 0; i < m->mesh->face_count; i++) {
        const struct solid_face *face = &m->mesh->faces[m->faces[i].face];
        if (i > 0 && m->faces[i].id != m->faces[i - 1].id) first = s->count;
        int k = first;
        while (k < s->count && !same_plane(&s->list[k], face->normal, face->offset, s->size)) k++;
        if (k < s->count) continue;
        if (array_append(&s->list, (size_t)s->count, sizeof *s->list, "surfaces", err)) return err->status;
        s->list[s->count++] = (struct surface){.id = m->faces[i].id,
                                               .normal = face->normal,
                                               .offset = face->offset,
                                               .glass = solid_face_is_pane(m->mesh, m->faces[i].face)};
    }
    return ST_OK;
}

/* Adds the triangles of one surface in one model. */
static enum status add_triangles(struct surfaces *s, struct surface *of, const struct sorted_model *m, struct err *err)
{
    for (int k = first_face(m, of->id); k < m->mesh->face_count && m->faces[k].id == of->id; k++) {
        const int f = m->faces[k].face;
        const struct solid_face *face = &m->mesh->faces[f];
        if (!same_plane(of, face->normal, face->offset, s->size)) continue;
        for (int i = m->triangles.first[f]; i < m->triangles.first[f + 1]; i++) {
            if (array_append(&s->triangles, (size_t)s->triangle_count, sizeof *s->triangles, "triangles", err))
                return err->status;
            for (int c = 0; c < 3; c++)
                s->triangles[s->triangle_count][c] = m->mesh->vertices[m->triangles.triangles[i].v[c]].p;
            s->triangle_count++;
            of->triangles++;
        }
    }
    return ST_OK;
}

enum status surfaces_make(struct surfaces *s, const struct solid_mesh *models, int count, struct err *err)
{
    struct sorted_model *sorted = calloc((size_t)count, sizeof *sorted);
    *s = (struct surfaces){.size = size_of(models, count)};
    if (!sorted) err_nomem(err, "models", (size_t)count * sizeof *sorted);
    for (int k = 0; !err->status && k < count; k++) sort_model(&sorted[k], &models[k], err);
    if (!err->status) list_surfaces(s, &sorted[0], err);
    for (int i = 0; !err->status && i < s->count; i++) {
        s->list[i].first = s->triangle_count;
        for (int k = 0; !err->status && k < count; k++) add_triangles(s, &s->list[i], &sorted[k], err);
    }
    for (int k = 0; sorted && k < count; k++) {
        solid_triangles_release(&sorted[k].triangles);
        free(sorted[k].faces);
    }
    free(sorted);
    return err->status;
}

void surfaces_release(struct surfaces *s)
{
    free(s->list);
    free(s->triangles);
    *s = (struct surfaces){0};
}

static bool surface_is_below(const void *surface, const void *id)
{
    return ((const struct surface *)surface)->id < *(const int *)id;
}

int surfaces_find(const struct surfaces *s, int id)
{
    const int at = (int)sort_place(s->list, (size_t)s->count, sizeof *s->list, surface_is_below, &id);
    return at < s->count && s->list[at].id == id ? at : -1;
}

int surfaces_find_at(const struct surfaces *s, int id, struct vec3 p, double tolerance)
{
    int best = -1;
    double nearest = tolerance;
    const int first = surfaces_find(s, id);
    for (int i = first; i >= 0 && i < s->count && s->list[i].id == id; i++) {
        const double off = fabs(vec3_dot(s->list[i].normal, p) - s->list[i].offset);
        if (off <= nearest) best = i, nearest = off;
    }
    return best;
}

/* Narrows [*low, *high] to where a + b x >= 0. */
static void narrow(double *low, double *high, double a, double b)
{
    if (b > 0)
        *low = fmax(*low, -a / b);
    else if (b < 0)
        *high = fmin(*high, -a / b);
    else if (!(a >= 0))
        *high = -INFINITY;
}

/* The half planes of a triangle as linear functions of the pixel: line[k] . (x, y, 1) >= 0 inside. */
static void triangle_lines(double line[4][3], const struct vec3 t[3], struct vec3 normal,
                           const struct surface_raster *r)
{
    for (int k = 0; k < 3; k++) {
        const struct vec3 side = vec3_cross(normal, vec3_sub(t[(k + 1) % 3], t[k]));
        const double inner = vec3_dot(side, vec3_sub(t[(k + 2) % 3], t[k])) < 0 ? -1 : 1;
        const double e[4] = {inner * side.x, inner * side.y, inner * side.z, -inner * vec3_dot(side, t[k])};
        for (int c = 0; c < 3; c++) {
            line[k][c] = 0;
            for (int i = 0; i < 4; i++) line[k][c] += e[i] * r->point[i][c];
        }
    }
    memcpy(line[3], r->point[3], sizeof line[3]);
}

void surface_fill(uint8_t *inside, const struct surfaces *s, int surface, const struct surface_raster *r)
{
    const struct surface *of = &s->list[surface];
    for (int i = of->first; i < of->first + of->triangles; i++) {
        double line[4][3];
        triangle_lines(line, s->triangles[i], of->normal, r);
        for (int y = 0; y < r->height; y++) {
            double low = 0.5, high = r->width - 0.5;
            for (int k = 0; k < 4; k++) narrow(&low, &high, line[k][1] * (y + 0.5) + line[k][2], line[k][0]);
            if (!(low <= high)) continue;
            const int first = (int)ceil(low - 0.5), last = (int)floor(high - 0.5);
            if (first <= last) memset(inside + (size_t)y * (size_t)r->width + first, 1, (size_t)(last - first + 1));
        }
    }
}
