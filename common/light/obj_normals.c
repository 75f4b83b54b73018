/* obj_normals.c - see obj_normals.h.
 *
 * Weights are angles [Thuermer 1998], so that it does not matter along which diagonal a square is cut. Vertices are
 * told apart by position, as many exporters write a vertex for each face. A vertex of more triangles than MAX_AROUND
 * keeps their own normals, or the time would grow with the square of their number. */
#include "common/light/obj_normals.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/numbers.h"

enum { MAX_AROUND = 256 };

struct obj_around { /* a corner of a triangle */
    struct vec3 at;
    int triangle, corner;
};

static int by_position(const void *a, const void *b)
{
    const struct obj_around *p = a, *q = b;
    if (p->at.x != q->at.x) return p->at.x < q->at.x ? -1 : 1;
    if (p->at.y != q->at.y) return p->at.y < q->at.y ? -1 : 1;
    if (p->at.z != q->at.z) return p->at.z < q->at.z ? -1 : 1;
    if (p->triangle != q->triangle) return p->triangle < q->triangle ? -1 : 1;
    return p->corner - q->corner;
}

static bool is_same_position(struct vec3 a, struct vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

struct vec3 obj_unit(struct vec3 v)
{
    const double largest = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
    if (!(largest > 0)) return v;
    return vec3_normalize(vec3_make(v.x / largest, v.y / largest, v.z / largest));
}

static struct vec3 normal_of(const struct vec3 t[3])
{
    return obj_unit(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
}

static double angle_at(const struct vec3 t[3], int corner)
{
    const struct vec3 a = vec3_sub(t[(corner + 1) % 3], t[corner]), b = vec3_sub(t[(corner + 2) % 3], t[corner]);
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

static void smooth_vertex(struct obj_mesh *mesh, const struct obj_around *around, size_t count)
{
    const double cosine = cos(OBJ_CREASE * DEGREE);
    for (size_t i = 0; i < count; i++) {
        const struct vec3 own = normal_of(mesh->triangles[around[i].triangle]);
        struct vec3 sum = {0, 0, 0};
        for (size_t k = 0; k < count; k++) {
            const struct vec3 *t = mesh->triangles[around[k].triangle];
            const struct vec3 normal = normal_of(t);
            if (vec3_dot(own, normal) > cosine) sum = vec3_add(sum, vec3_scale(normal, angle_at(t, around[k].corner)));
        }
        sum = obj_unit(sum);
        if (vec3_length(sum) > 0) mesh->normals[around[i].triangle][around[i].corner] = sum;
    }
}

enum status obj_normals_smooth(struct obj_mesh *mesh, struct err *err)
{
    const size_t n = 3 * (size_t)mesh->count;
    struct obj_around *around = malloc((n + 1) * sizeof *around);
    if (!around) return err_nomem(err, "corners of a mesh", n * sizeof *around);
    for (size_t i = 0; i < n; i++)
        around[i] = (struct obj_around){mesh->triangles[i / 3][i % 3], (int)(i / 3), (int)(i % 3)};
    qsort(around, n, sizeof *around, by_position);
    for (size_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && is_same_position(around[end].at, around[i].at);) end++;
        if (end - i <= MAX_AROUND) smooth_vertex(mesh, around + i, end - i);
    }
    free(around);
    return ST_OK;
}
