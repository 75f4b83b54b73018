/* overlay_edges.c - the edges of a model as a photograph shows them.
 *
 * Whether an edge is visible in a photograph is decided by a cube map of depth about the camera: six square perspective
 * pictures of the model's triangles. So any lens can ask in any direction. A side is drawn when it is first asked for:
 * most photographs look at two or three. */
#include "stages/build_model/picture/overlay_edges.h"

#include <math.h>

#include "stages/build_model/picture/raster.h"

enum { CUBE = 1024 };

struct cube {
    struct raster side[6]; /* empty until it is asked for */
    struct vec3 center;
    const struct solid_mesh *mesh;
    const struct solid_triangles *triangles;
};

/* Coordinates in the frame of one of the cube's six cameras: z the largest. */
static struct vec3 cube_turn(int side, struct vec3 p)
{
    switch (side) {
    case 0:
        return vec3_make(p.y, p.z, p.x);
    case 1:
        return vec3_make(p.y, p.z, -p.x);
    case 2:
        return vec3_make(p.x, p.z, p.y);
    case 3:
        return vec3_make(p.x, p.z, -p.y);
    case 4:
        return vec3_make(p.x, p.y, p.z);
    default:
        return vec3_make(p.x, p.y, -p.z);
    }
}

static struct vec3 cube_pixel(struct vec3 p)
{
    return vec3_make(0.5 * CUBE * (1 + p.x / p.z), 0.5 * CUBE * (1 + p.y / p.z), 1 / p.z);
}

static void draw_triangle(struct raster *r, int side, struct vec3 center, const struct vec3 corners[3])
{
    const double min_z = 1e-3;
    struct vec3 p[3], clipped[4];
    int n = 0;
    for (int k = 0; k < 3; k++) p[k] = cube_turn(side, vec3_sub(corners[k], center));
    for (int k = 0; k < 3; k++) { /* clip at min_z */
        const struct vec3 a = p[k], b = p[(k + 1) % 3];
        if (a.z > min_z) clipped[n++] = a;
        if ((a.z > min_z) != (b.z > min_z))
            clipped[n++] = vec3_add(a, vec3_scale(vec3_sub(b, a), (min_z - a.z) / (b.z - a.z)));
    }
    for (int k = 1; k + 1 < n; k++)
        raster_triangle(r, cube_pixel(clipped[0]), cube_pixel(clipped[k]), cube_pixel(clipped[k + 1]), NULL);
}

static enum status draw_side(struct cube *c, int side, struct err *err)
{
    if (raster_init(&c->side[side], CUBE, CUBE, NULL, err)) return err->status;
    for (int i = 0; i < c->triangles->count; i++) {
        const struct solid_triangle *t = &c->triangles->triangles[i];
        const struct vec3 corners[3] = {c->mesh->vertices[t->v[0]].p, c->mesh->vertices[t->v[1]].p,
                                        c->mesh->vertices[t->v[2]].p};
        if (!solid_face_is_pane(c->mesh, t->face)) draw_triangle(&c->side[side], side, c->center, corners);
    }
    return ST_OK;
}

static enum status cube_sees(struct cube *c, struct vec3 point, bool *sees, struct err *err)
{
    const struct vec3 to = vec3_sub(point, c->center);
    const double x = fabs(to.x), y = fabs(to.y), z = fabs(to.z);
    const int side = x >= y && x >= z ? (to.x < 0) : y >= z ? 2 + (to.y < 0) : 4 + (to.z < 0);
    const struct vec3 p = cube_turn(side, to);
    *sees = !(p.z > 1e-3);
    if (*sees) return ST_OK;
    if (!c->side[side].near && draw_side(c, side, err)) return err->status;
    const struct vec3 at = cube_pixel(p);
    /* visible if nothing is clearly in front of one of the 3 x 3 pixels: an edge lies on the border of its faces */
    for (int k = 0; k < 9 && !*sees; k++) {
        const int u = (int)at.x + k % 3 - 1, v = (int)at.y + k / 3 - 1;
        if (u < 0 || v < 0 || u >= CUBE || v >= CUBE) continue;
        *sees = (double)c->side[side].near[(size_t)v * CUBE + (size_t)u] <= at.z * 1.01;
    }
    return ST_OK;
}

static enum status trace_edge(struct cube *cube, const struct overlay_edges *how, int half_edge,
                              void (*dot)(void *ctx, const struct overlay_dot *dot), void *ctx, struct err *err)
{
    const struct solid_half_edge *e = &cube->mesh->half_edges[half_edge];
    const struct vec3 a = cube->mesh->vertices[e->origin].p,
                      b = cube->mesh->vertices[cube->mesh->half_edges[e->next].origin].p;
    struct overlay_dot d = {.half_edge = half_edge,
                            .glass = solid_face_is_pane(cube->mesh, cube->mesh->loops[e->loop].face)};
    double last[2] = {-1e9, -1e9};
    for (int i = 0; i <= how->steps; i++) {
        const struct vec3 p = vec3_add(a, vec3_scale(vec3_sub(b, a), (double)i / how->steps));
        if (!photo_camera_project(how->camera, p, &d.u, &d.v)) continue;
        d.u *= how->scale, d.v *= how->scale;
        if (hypot(d.u - last[0], d.v - last[1]) < how->apart || d.u < 0 || d.v < 0 || d.u > how->width ||
            d.v > how->height)
            continue;
        last[0] = d.u, last[1] = d.v;
        if (cube_sees(cube, p, &d.seen, err)) return err->status;
        dot(ctx, &d);
    }
    return ST_OK;
}

enum status overlay_edges_trace(const struct solid_mesh *mesh, const struct overlay_edges *how,
                                void (*dot)(void *ctx, const struct overlay_dot *dot), void *ctx, struct err *err)
{
    struct solid_triangles tris = {0};
    struct cube cube = {.center = how->camera->center, .mesh = mesh, .triangles = &tris};
    solid_mesh_triangulate(&tris, mesh, err);
    for (int h = 0; !err->status && h < mesh->half_edge_count; h++)
        if (mesh->half_edges[h].twin >= h) trace_edge(&cube, how, h, dot, ctx, err);
    for (int i = 0; i < 6; i++) raster_release(&cube.side[i]);
    solid_triangles_release(&tris);
    return err->status;
}
