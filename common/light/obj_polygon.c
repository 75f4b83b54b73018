/* obj_polygon.c - see obj_polygon.h.
 *
 * A convex polygon is a fan. A concave one is cut like a face of a solid (solid_triangulate.c), seen along the
 * sum of the cross products of its sides. */
#include "common/light/obj_polygon.h"

#include <stdlib.h>
#include <string.h>

#include "common/model/solid_mesh.h"

static struct vec3 mean_normal(const struct obj_corner *c, int n)
{
    struct vec3 sum = {0, 0, 0};
    for (int i = 1; i + 1 < n; i++)
        sum = vec3_add(sum, vec3_cross(vec3_sub(c[i].at, c[0].at), vec3_sub(c[i + 1].at, c[0].at)));
    return vec3_normalize(sum);
}

static bool is_convex(const struct obj_corner *c, int n, struct vec3 normal)
{
    for (int i = 0; i < n; i++) {
        const struct vec3 before = c[i].at, at = c[(i + 1) % n].at, after = c[(i + 2) % n].at;
        if (vec3_dot(vec3_cross(vec3_sub(at, before), vec3_sub(after, at)), normal) < 0) return false;
    }
    return true;
}

static void make_fan(int *triangles, int n)
{
    for (int i = 0; i + 2 < n; i++) {
        triangles[3 * i] = 0;
        triangles[3 * i + 1] = i + 1;
        triangles[3 * i + 2] = i + 2;
    }
}

/* As the one face of a mesh. *crosses: it has no ears. */
static enum status clip(int *triangles, bool *crosses, const struct obj_corner *corners, int n, struct vec3 normal,
                        struct err *err)
{
    struct solid_vertex *vertices = calloc((size_t)n, sizeof *vertices);
    struct solid_half_edge *edges = calloc((size_t)n, sizeof *edges);
    struct solid_loop loop = {0};
    struct solid_face face = {.normal = normal, .offset = vec3_dot(normal, corners[0].at), .loops = 1};
    struct solid_name name = {0};
    struct solid_mesh mesh = {.vertices = vertices,
                              .half_edges = edges,
                              .loops = &loop,
                              .faces = &face,
                              .names = &name,
                              .vertex_count = n,
                              .half_edge_count = n,
                              .loop_count = 1,
                              .face_count = 1,
                              .name_count = 1};
    struct solid_triangles cut = {0};
    struct err refused = ERR_INIT;
    if (!vertices || !edges) err_nomem(err, "corners of a polygon", (size_t)n * sizeof *vertices);
    for (int i = 0; !err->status && i < n; i++) {
        vertices[i].p = corners[i].at;
        edges[i].origin = i;
        edges[i].next = (i + 1) % n;
    }
    if (!err->status) solid_mesh_triangulate(&cut, &mesh, &refused);
    if (refused.status == ST_NOMEM) err_set(err, ST_NOMEM, "%s", refused.text);
    *crosses = refused.status == ST_DATA;
    for (int i = 0; i < cut.count; i++)
        memcpy(triangles + 3 * (ptrdiff_t)i, cut.triangles[i].v, sizeof cut.triangles[i].v);
    solid_triangles_release(&cut);
    free(vertices);
    free(edges);
    return err->status;
}

enum status obj_polygon_triangles(int **triangles, int *count, bool *crosses, const struct obj_corner *corners, int n,
                                  struct err *err)
{
    const struct vec3 normal = mean_normal(corners, n);
    *crosses = false;
    *count = n - 2;
    *triangles = malloc(3 * (size_t)*count * sizeof **triangles);
    if (!*triangles) return err_nomem(err, "triangles of a polygon", 3 * (size_t)*count * sizeof **triangles);
    if (is_convex(corners, n, normal))
        make_fan(*triangles, n);
    else if (!clip(*triangles, crosses, corners, n, normal, err) && *crosses)
        make_fan(*triangles, n);
    return err->status;
}
