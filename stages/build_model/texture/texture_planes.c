/* texture_planes.c - axes in the planes of faces; see texture_planes.h. */
#include "stages/build_model/texture/texture_planes.h"

#include <math.h>

static const double same_cosine = 1e-9; /* 1 - cosine of normals of one plane */

bool texture_faces_are_parallel(const struct solid_face *a, const struct solid_face *b)
{
    return vec3_dot(a->normal, b->normal) > 1 - same_cosine;
}

bool texture_faces_are_coplanar(const struct solid_face *a, const struct solid_face *b)
{
    return texture_faces_are_parallel(a, b) && fabs(a->offset - b->offset) <= SAME_PLANE;
}

struct plane_axes plane_axes_of(const struct solid_face *f)
{
    const struct vec3 n = f->normal;
    const struct vec3 u = fabs(n.z) < 0.999 ? vec3_normalize(vec3_cross(vec3_make(0, 0, 1), n)) : vec3_make(1, 0, 0);
    return (struct plane_axes){u, vec3_cross(n, u), n, f->offset};
}

struct vec3 plane_axes_point(const struct plane_axes *axes, double u, double v)
{
    return vec3_add(vec3_scale(axes->n, axes->offset), vec3_add(vec3_scale(axes->u, u), vec3_scale(axes->v, v)));
}

struct plane_rect plane_rect_of(const struct plane_axes *axes, struct vec3 a, struct vec3 b)
{
    const double ua = vec3_dot(axes->u, a), ub = vec3_dot(axes->u, b);
    const double va = vec3_dot(axes->v, a), vb = vec3_dot(axes->v, b);
    return (struct plane_rect){{fmin(ua, ub), fmax(ua, ub)}, {fmin(va, vb), fmax(va, vb)}};
}

/* Widens the rectangle to a face's outer loop. */
static void add_face(struct plane_rect *r, const struct solid_mesh *mesh, int face, const struct plane_axes *axes)
{
    const int first = mesh->loops[mesh->faces[face].loop].half_edge;
    int h = first;
    do {
        const struct vec3 p = mesh->vertices[mesh->half_edges[h].origin].p;
        const double u = vec3_dot(axes->u, p), v = vec3_dot(axes->v, p);
        *r = (struct plane_rect){{fmin(r->u[0], u), fmax(r->u[1], u)}, {fmin(r->v[0], v), fmax(r->v[1], v)}};
        h = mesh->half_edges[h].next;
    } while (h != first);
}

struct plane_rect plane_rect_of_surface(const struct solid_mesh *mesh, int face, const struct plane_axes *axes)
{
    struct plane_rect r = {{INFINITY, -INFINITY}, {INFINITY, -INFINITY}};
    const struct solid_face *f = &mesh->faces[face];
    for (int i = 0; i < mesh->face_count; i++)
        if (mesh->faces[i].name == f->name && texture_faces_are_coplanar(f, &mesh->faces[i]))
            add_face(&r, mesh, i, axes);
    return r;
}
