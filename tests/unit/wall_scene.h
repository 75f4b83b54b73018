/* wall_scene.h - scenes of upright rectangles, for example a wall with a box in front of it; layers by ray casting. */
#ifndef REMODEL_TESTS_WALL_SCENE_H
#define REMODEL_TESTS_WALL_SCENE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "common/film/subject_list.h"
#include "common/layers/layer_scene.h"

enum { W = 160, H = 120, TILE = 10, MAX_VIEWS = 16, MAX_RECTANGLES = 3 };

struct rectangle { /* faces -z: |x - cx| <= half_x, |y - cy| <= half_y at world depth z */
    double cx, cy, z, half_x, half_y;
};

static const struct rectangle wall_and_box[] = {{0, 0, 10, 40, 40}, {0.5, 0.3, 6, 1.2, 1.5}};

struct wall_scene {
    struct view views[MAX_VIEWS];
    struct camera_set set;
    struct layered_depth depths[MAX_VIEWS];
    struct layer_scene scene;
    struct vec3 ups[MAX_VIEWS];
};

/* Adds a view at `center` towards `target`, its y axis towards `down`. */
static inline void add_view(struct wall_scene *f, struct vec3 center, struct vec3 target, struct vec3 down)
{
    struct view *v = &f->views[f->set.view_count++];
    *v = (struct view){.name = "view", .width = W, .height = H, .fx = W, .fy = W, .cx = W / 2.0, .cy = H / 2.0};
    const struct vec3 z = vec3_normalize(vec3_sub(target, center));
    const struct vec3 x = vec3_normalize(vec3_cross(down, z)), y = vec3_cross(z, x);
    v->cam_from_world = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    v->center = center;
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, center), -1);
    f->set.views = f->views;
}

static inline void add_straight(struct wall_scene *f, double x, double y, double z)
{
    add_view(f, vec3_make(x, y, z), vec3_make(x, y, z + 1), vec3_make(0, 1, 0));
}

/* The nearest rectangle along a pixel's ray, or -1; *depth is along the camera's axis. */
static inline int hit(const struct view *v, double px, double py, const struct rectangle *r, int count, double *depth)
{
    const struct vec3 d = vec3_sub(view_unproject(v, px, py, 1), v->center);
    int best = -1;
    *depth = HUGE_VAL;
    for (int i = 0; i < count; i++) {
        const double t = (r[i].z - v->center.z) / d.z; /* d has depth 1, so t is the depth */
        const struct vec3 p = vec3_add(v->center, vec3_scale(d, t));
        if (t > 0 && t < *depth && fabs(p.x - r[i].cx) <= r[i].half_x && fabs(p.y - r[i].cy) <= r[i].half_y)
            *depth = t, best = i;
    }
    return best;
}

/* Coefficients of 1/z over a view's pixels, for the world plane z = world_z. */
static inline void plane_in_view(const struct view *v, double world_z, double plane[3])
{
    const struct vec3 n = mat3_apply(v->cam_from_world, vec3_make(0, 0, 1));
    const double d = world_z + vec3_dot(n, v->translation);
    plane[0] = n.x / v->fx / d;
    plane[1] = n.y / v->fy / d;
    plane[2] = (n.z - n.x * v->cx / v->fx - n.y * v->cy / v->fy) / d;
}

/* Makes the layers of a view; tiles of each rectangle are segments. */
static inline void make_layers(struct layered_depth *l, const struct view *v, const struct rectangle *r, int count)
{
    struct err err = ERR_INIT;
    const int columns = W / TILE, tiles = columns * (H / TILE);
    int ids[MAX_RECTANGLES * (W / TILE) * (H / TILE)] = {0};
    assert_true(count <= MAX_RECTANGLES);
    assert_int_equal(layered_depth_init(l, v->width, v->height, &err), ST_OK);
    l->segments = calloc((size_t)tiles * MAX_RECTANGLES, sizeof *l->segments);
    assert_non_null(l->segments);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            double z;
            const size_t p = (size_t)(y * W + x);
            const int at = hit(v, x + 0.5, y + 0.5, r, count, &z);
            if (at < 0) continue;
            int *id = &ids[at * tiles + y / TILE * columns + x / TILE];
            if (!*id) {
                *id = ++l->segment_count;
                struct depth_segment *s = &l->segments[*id - 1];
                *s = (struct depth_segment){.id = (uint32_t)*id, .sigma = 0.001, .confidence = 1};
                plane_in_view(v, r[at].z, s->plane);
            }
            l->segments[*id - 1].pixels++;
            l->interior.id[p] = (uint32_t)*id;
            l->interior.z[p] = (float)z;
            for (int c = 0; c < 4; c++) l->interior.rgba[4 * p + (size_t)c] = 1;
        }
}

static inline void finish(struct wall_scene *f, const struct rectangle *r, int count)
{
    struct err err = ERR_INIT;
    for (int i = 0; i < f->set.view_count; i++) make_layers(&f->depths[i], &f->views[i], r, count);
    assert_int_equal(layer_scene_init(&f->scene, &f->set, f->depths, &err), ST_OK);
}

static inline struct vec3 row_of(struct mat3 m, int row) { return vec3_make(m.m[row][0], m.m[row][1], m.m[row][2]); }

/* An upright subject that faces -z. */
static inline struct subject upright_subject(double x, double y, double z, double half_x, double half_y)
{
    struct subject s = {.view = (char *)"view", .source = SUBJECT_USER, .x1 = 1, .y1 = 1, .depth = z};
    s.corner[0] = vec3_make(x - half_x, y - half_y, z);
    s.corner[1] = vec3_make(x + half_x, y - half_y, z);
    s.corner[2] = vec3_make(x + half_x, y + half_y, z);
    s.corner[3] = vec3_make(x - half_x, y + half_y, z);
    return s;
}

/* Checks that a view is valid for video: even size, orthonormal rotation, one focal length, consistent centre. */
static inline void assert_camera(const struct view *v)
{
    assert_true(v->width > 0 && v->width % 2 == 0 && v->height > 0 && v->height % 2 == 0);
    assert_float_equal(vec3_length(mat3_apply(v->cam_from_world, vec3_make(1, 2, 3))), sqrt(14), 1e-12);
    assert_true(isfinite(vec3_length(v->translation)) && v->fx == v->fy && v->fx > 0);
    const struct vec3 c = vec3_add(mat3_apply(v->cam_from_world, v->center), v->translation);
    assert_true(vec3_length(c) < 1e-12 * (1 + vec3_length(v->center)));
}

/* Distance of a projected world point from the principal point, px; the point must be in front of the camera. */
static inline double off_axis(const struct view *v, struct vec3 point)
{
    double u = 0, w = 0;
    assert_true(view_project(v, point, &u, &w) > 0);
    return hypot(u - v->cx, w - v->cy);
}

#endif
