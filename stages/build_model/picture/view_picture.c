/* view_picture.c - the model seen from above.
 *
 * An orthographic picture from the south-west, 55 degrees above the horizon, twice as large as it is written, so
 * that the mean over 2 x 2 pixels smooths edges.
 *
 * To look into the rooms, ceilings are left out, and everything above the highest ceiling or wall is cut. Faces that
 * look away from the viewer are not drawn: a wall that stands between the viewer and its room is seen through. What
 * shows walls, then, are their cut tops, drawn dark at the height at which each is cut.
 *
 * Triangles go through a depth buffer (raster.c). Edges are sampled at 1.5 points a pixel and drawn where they are
 * not behind the buffer by more than a few pixels, so that an edge is not hidden by its own faces. Frusta of the
 * photographs are drawn through everything, because they are what a person checks against the walls.
 *
 * Shading is a fixed function of the normal: one light from above and the side, tints by the kind of face's name. */
#include "stages/build_model/picture/view_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/photo.h"
#include "common/math/numbers.h"
#include "stages/build_model/picture/plan_picture.h"
#include "stages/build_model/picture/raster.h"

enum { VIEW_WIDTH = 1400, VIEW_HEIGHT = 1000, SUPERSAMPLING = 2 };

struct aerial {
    struct vec3 right, down, back; /* of the picture, and towards the viewer */
    double scale, x, y;
};

static struct vec3 aerial_point(const struct aerial *a, struct vec3 p)
{
    return vec3_make(a->scale * vec3_dot(a->right, p) + a->x, a->scale * vec3_dot(a->down, p) + a->y,
                     vec3_dot(a->back, p));
}

static void aerial_line(struct raster *r, const struct aerial *a, struct vec3 p, struct vec3 q, bool through,
                        double radius, const unsigned char color[3])
{
    const struct vec3 x = aerial_point(a, p), y = aerial_point(a, q);
    const int steps = (int)fmin(hypot(y.x - x.x, y.y - x.y) * 1.5, 1e5) + 1;
    for (int i = 0; i <= steps; i++) {
        const double t = (double)i / steps, u = x.x + t * (y.x - x.x), v = x.y + t * (y.y - x.y);
        if (!(u >= 0 && v >= 0 && u < r->width && v < r->height)) continue;
        const double near = x.z + t * (y.z - x.z) + 6 / a->scale;
        if (!through && near < (double)r->near[(size_t)v * (size_t)r->width + (size_t)u]) continue;
        raster_dot(r->rgb, r->width, r->height, u, v, radius, color, 0.8);
    }
}

/* Draws a triangle's part below a height. */
static void aerial_triangle(struct raster *r, const struct aerial *a, const struct vec3 p[3], double top,
                            const unsigned char color[3])
{
    struct vec3 kept[4];
    int n = 0;
    for (int k = 0; k < 3; k++) {
        const struct vec3 u = p[k], v = p[(k + 1) % 3];
        if (u.z <= top) kept[n++] = u;
        if ((u.z <= top) != (v.z <= top))
            kept[n++] = vec3_add(u, vec3_scale(vec3_sub(v, u), (top - u.z) / (v.z - u.z)));
    }
    for (int k = 1; k + 1 < n; k++)
        raster_triangle(r, aerial_point(a, kept[0]), aerial_point(a, kept[k]), aerial_point(a, kept[k + 1]), color);
}

/* Draws the cut tops of the walls dark. */
static void draw_cuts(struct raster *r, const struct aerial *a, const struct plan *plan, double top)
{
    static const unsigned char dark[3] = {92, 96, 104}, ink[3] = {40, 42, 48};
    for (int i = 0; i < plan->wall_count; i++) {
        const struct plan_wall *w = &plan->walls[i];
        double c[4][2], span[2];
        if (w->removed) continue;
        plan_wall_corners(plan, i, c);
        plan_wall_span(plan, i, span);
        const double z = fmin(top, plan_wall_top(plan, i, span[0], span[1]));
        struct vec3 p[4];
        for (int k = 0; k < 4; k++) p[k] = vec3_make(c[k][0], c[k][1], z);
        for (int k = 1; k < 3; k++) aerial_triangle(r, a, (const struct vec3[3]){p[0], p[k], p[k + 1]}, HUGE_VAL, dark);
        for (int k = 1; k < 4; k += 2) aerial_line(r, a, p[k], p[(k + 1) % 4], false, 0.7, k == 1 ? dark : ink);
    }
}

static bool is_ceiling(const struct solid_mesh *mesh, int face)
{
    return !strncmp(solid_face_name(mesh, face), "ceiling/", 8);
}

/* Scales and centres the view on the mesh's vertices. */
static void fit_view(struct aerial *a, const struct solid_mesh *mesh, const struct raster *r)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    a->scale = 1;
    a->x = a->y = 0;
    for (int i = 0; i < mesh->vertex_count; i++) {
        const struct vec3 p = aerial_point(a, mesh->vertices[i].p);
        low[0] = fmin(low[0], p.x), high[0] = fmax(high[0], p.x);
        low[1] = fmin(low[1], p.y), high[1] = fmax(high[1], p.y);
    }
    if (!(high[0] > low[0])) return;
    a->scale = 0.92 * fmin(r->width / (high[0] - low[0]), r->height / (high[1] - low[1]));
    a->x = 0.5 * (r->width - a->scale * (low[0] + high[0]));
    a->y = 0.5 * (r->height - a->scale * (low[1] + high[1]));
}

static void face_color(const struct solid_mesh *mesh, int face, unsigned char color[3])
{
    static const struct {
        const char *with;
        double rgb[3];
    } tints[] = {{"floor/", {0.80, 0.72, 0.58}}, {"box/", {0.72, 0.60, 0.42}},    {"door/", {0.75, 0.55, 0.40}},
                 {"glass/", {0.45, 0.68, 0.90}}, {"window/", {0.70, 0.78, 0.86}}, {"", {0.86, 0.86, 0.84}}};
    const struct vec3 n = mesh->faces[face].normal;
    const double light = 0.62 + 0.26 * n.z + 0.14 * (0.8 * n.x - 0.6 * n.y);
    size_t i = 0;
    while (strncmp(solid_face_name(mesh, face), tints[i].with, strlen(tints[i].with)) != 0) i++;
    for (int c = 0; c < 3; c++) color[c] = (unsigned char)(255 * fmin(1, fmax(0.05, light * 1.1 * tints[i].rgb[c])));
}

static void draw_frusta(struct raster *r, const struct aerial *a, const struct placer *placer, double size)
{
    static const unsigned char red[3] = {205, 40, 40};
    for (int i = 0; placer && i < placer->photo_count; i++) {
        const struct photo_camera *c = &placer->photos[i].camera;
        const struct mat3 turn = mat3_transpose(c->cam_from_world);
        struct vec3 corner[4];
        for (int k = 0; k < 4; k++) {
            struct vec3 ray;
            const double u = k == 1 || k == 2 ? c->lens.width : 0, v = k >= 2 ? c->lens.height : 0;
            if (!camera_unproject(&c->lens, u, v, &ray) || ray.z < 0.4)
                ray = vec3_normalize(vec3_make(k == 1 || k == 2 ? 1.2 : -1.2, k >= 2 ? 0.8 : -0.8, 1));
            corner[k] = vec3_add(c->center, vec3_scale(mat3_apply(turn, ray), size));
        }
        for (int k = 0; k < 4; k++) {
            aerial_line(r, a, c->center, corner[k], true, 0.9, red);
            aerial_line(r, a, corner[k], corner[(k + 1) % 4], true, 0.9, red);
        }
    }
}

/* All faces that look towards the viewer, except ceilings. */
static void draw_faces(struct raster *r, const struct aerial *a, const struct solid_mesh *mesh,
                       const struct solid_triangles *tris, double top)
{
    for (int i = 0; i < tris->count; i++) {
        const struct solid_triangle *t = &tris->triangles[i];
        unsigned char color[3];
        if (is_ceiling(mesh, t->face) || vec3_dot(mesh->faces[t->face].normal, a->back) <= 0) continue;
        face_color(mesh, t->face, color);
        aerial_triangle(
            r, a,
            (const struct vec3[3]){mesh->vertices[t->v[0]].p, mesh->vertices[t->v[1]].p, mesh->vertices[t->v[2]].p},
            top, color);
    }
}

/* The visible parts below the top of all edges, except those between ceilings. */
static void draw_mesh_edges(struct raster *r, const struct aerial *a, const struct solid_mesh *mesh, double top)
{
    static const unsigned char ink[3] = {40, 42, 48};
    for (int h = 0; h < mesh->half_edge_count; h++) {
        const struct solid_half_edge *e = &mesh->half_edges[h];
        const int f = mesh->loops[e->loop].face, g = mesh->loops[mesh->half_edges[e->twin].loop].face;
        if (e->twin < h || (is_ceiling(mesh, f) && is_ceiling(mesh, g))) continue;
        struct vec3 p = mesh->vertices[e->origin].p, q = mesh->vertices[mesh->half_edges[e->next].origin].p;
        if (p.z > q.z) {
            const struct vec3 swap = p;
            p = q;
            q = swap;
        }
        if (p.z >= top) continue;
        if (q.z > top) q = vec3_add(p, vec3_scale(vec3_sub(q, p), (top - p.z) / (q.z - p.z)));
        aerial_line(r, a, p, q, false, 0.7, ink);
    }
}

static enum status write_downsampled(const struct raster *r, const char *path, struct err *err)
{
    const int w = r->width / SUPERSAMPLING, h = r->height / SUPERSAMPLING;
    unsigned char *small = malloc(3 * (size_t)w * (size_t)h);
    if (!small) return err_nomem(err, "a picture", 3 * (size_t)w * (size_t)h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int c = 0; c < 3; c++) {
                int sum = 0;
                for (int k = 0; k < SUPERSAMPLING * SUPERSAMPLING; k++)
                    sum += r->rgb[3 * ((size_t)(SUPERSAMPLING * y + k / SUPERSAMPLING) * (size_t)r->width +
                                       (size_t)(SUPERSAMPLING * x + k % SUPERSAMPLING)) +
                                  (size_t)c];
                small[3 * ((size_t)y * (size_t)w + (size_t)x) + (size_t)c] =
                    (unsigned char)(sum / (SUPERSAMPLING * SUPERSAMPLING));
            }
    png_write(path, small, w, h, 3, err);
    free(small);
    return err->status;
}

enum status view_picture_write(const struct solid_mesh *mesh, const struct plan *plan, const struct placer *placer,
                               const char *path, struct err *err)
{
    static const unsigned char paper[3] = {248, 248, 246};
    struct solid_triangles tris = {0};
    struct raster r = {0};
    double high = 0;
    for (int i = 0; i < plan->wall_count; i++) high = fmax(high, plan->walls[i].removed ? 0 : plan->walls[i].top);
    for (int i = 0; i < plan->room_count; i++)
        for (int e = 0; !plan->rooms[i].removed && e < plan->rooms[i].edge_count; e++)
            high = fmax(high, plan_top_at(&plan->rooms[i].lower, plan->rooms[i].edges[e].corner));
    /* from the south-west, 55 degrees above the horizon */
    const struct vec3 back =
        vec3_make(-0.30 * cos(55 * DEGREE) / hypot(0.30, 1), -cos(55 * DEGREE) / hypot(0.30, 1), sin(55 * DEGREE));
    struct aerial a = {.back = vec3_normalize(back)};
    a.right = vec3_normalize(vec3_cross(vec3_make(0, 0, 1), a.back));
    a.down = vec3_cross(a.right, a.back);
    a.down = vec3_scale(a.down, a.down.z < 0 ? 1 : -1);
    if (raster_init(&r, SUPERSAMPLING * VIEW_WIDTH, SUPERSAMPLING * VIEW_HEIGHT, paper, err)) return err->status;
    if (!solid_mesh_triangulate(&tris, mesh, err)) {
        fit_view(&a, mesh, &r);
        draw_faces(&r, &a, mesh, &tris, high);
        draw_mesh_edges(&r, &a, mesh, high);
        draw_cuts(&r, &a, plan, high);
        draw_frusta(&r, &a, placer, PICTURE_FRUSTUM * (high > 0 ? high / 2.5 : 1));
        write_downsampled(&r, path, err);
    }
    solid_triangles_release(&tris);
    raster_release(&r);
    return err->status;
}
