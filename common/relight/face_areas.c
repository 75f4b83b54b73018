/* face_areas.c - see face_areas.h.
 *
 * A face is cut into triangles. The nearest point of a triangle is found region by region: beside a corner, beside an
 * edge, or inside [Ericson 2005, 5.1.5]. */
#include "common/relight/face_areas.h"

#include <math.h>
#include <stdlib.h>

static const double ON_FACE = 1e-5; /* of the model's largest coordinate */

/* The point of a triangle nearest to p. */
static struct vec3 nearest_on_triangle(struct vec3 p, struct vec3 a, struct vec3 b, struct vec3 c)
{
    const struct vec3 ab = vec3_sub(b, a), ac = vec3_sub(c, a), ap = vec3_sub(p, a), bp = vec3_sub(p, b),
                      cp = vec3_sub(p, c);
    const double d1 = vec3_dot(ab, ap), d2 = vec3_dot(ac, ap), d3 = vec3_dot(ab, bp), d4 = vec3_dot(ac, bp);
    const double d5 = vec3_dot(ab, cp), d6 = vec3_dot(ac, cp);
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (d1 <= 0 && d2 <= 0) return a;
    if (d3 >= 0 && d4 <= d3) return b;
    if (d6 >= 0 && d5 <= d6) return c;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return vec3_add(a, vec3_scale(ab, d1 / (d1 - d3)));
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return vec3_add(a, vec3_scale(ac, d2 / (d2 - d6)));
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return vec3_add(b, vec3_scale(vec3_sub(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6))));
    const double scale = 1 / (va + vb + vc);
    return vec3_add(a, vec3_add(vec3_scale(ab, vb * scale), vec3_scale(ac, vc * scale)));
}

static enum status index_faces(struct face_areas *a, struct err *err)
{
    const struct solid_mesh *mesh = a->mesh;
    a->ids = 1;
    for (int i = 0; i < mesh->name_count; i++)
        if (mesh->names[i].id >= a->ids) a->ids = mesh->names[i].id + 1;
    a->first = calloc((size_t)a->ids + 2, sizeof *a->first);
    a->faces = calloc((size_t)mesh->face_count + 1, sizeof *a->faces);
    if (!a->first || !a->faces) return err_nomem(err, "faces", (size_t)mesh->face_count * sizeof *a->faces);
    for (int i = 0; i < mesh->face_count; i++) a->first[solid_face_id(mesh, i) + 2]++;
    for (int id = 2; id < a->ids + 2; id++) a->first[id] += a->first[id - 1];
    for (int i = 0; i < mesh->face_count; i++) a->faces[a->first[solid_face_id(mesh, i) + 1]++] = i;
    return ST_OK;
}

enum status face_areas_make(struct face_areas *a, const struct solid_mesh *mesh, struct err *err)
{
    double size = 0;
    *a = (struct face_areas){.mesh = mesh};
    for (int i = 0; i < mesh->vertex_count; i++) {
        const struct vec3 p = mesh->vertices[i].p;
        size = fmax(size, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
    }
    a->tolerance = ON_FACE * size;
    if (solid_mesh_triangulate(&a->triangles, mesh, err) || index_faces(a, err)) return err->status;
    return ST_OK;
}

void face_areas_release(struct face_areas *a)
{
    if (!a) return;
    solid_triangles_release(&a->triangles);
    free(a->first);
    free(a->faces);
    *a = (struct face_areas){0};
}

/* Distance of p from the plane of a face. */
static double off_plane(const struct face_areas *a, int face, struct vec3 p)
{
    return fabs(vec3_dot(a->mesh->faces[face].normal, p) - a->mesh->faces[face].offset);
}

double face_areas_distance(const struct face_areas *a, int face, struct vec3 p, struct vec3 *nearest)
{
    double least = INFINITY;
    for (int t = a->triangles.first[face]; t < a->triangles.first[face + 1]; t++) {
        const int *v = a->triangles.triangles[t].v;
        const struct vec3 q =
            nearest_on_triangle(p, a->mesh->vertices[v[0]].p, a->mesh->vertices[v[1]].p, a->mesh->vertices[v[2]].p);
        const double d = vec3_length(vec3_sub(p, q));
        if (!(d < least)) continue;
        least = d;
        *nearest = q;
    }
    return least;
}

bool face_areas_nearest(const struct face_areas *a, int id, struct vec3 p, struct vec3 *nearest, int *face, bool *on)
{
    double plane = INFINITY, least = INFINITY;
    *on = false;
    if (id < 0 || id >= a->ids || a->first[id] == a->first[id + 1]) return false;
    for (int i = a->first[id]; i < a->first[id + 1]; i++) plane = fmin(plane, off_plane(a, a->faces[i], p));
    for (int i = a->first[id]; i < a->first[id + 1]; i++) {
        struct vec3 q;
        if (off_plane(a, a->faces[i], p) > plane + a->tolerance) continue;
        const double d = face_areas_distance(a, a->faces[i], p, &q);
        if (!(d < least)) continue;
        least = d;
        *nearest = q;
        *face = a->faces[i];
    }
    if (!isfinite(least)) return false;
    *on = least <= a->tolerance;
    if (*on) *nearest = p;
    return true;
}
