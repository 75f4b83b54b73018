/* formula_scene.h - scenes whose depth and colour are formulas, cut into segments, for tests of the renderers. */
#ifndef REMODEL_TESTS_FORMULA_SCENE_H
#define REMODEL_TESTS_FORMULA_SCENE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/layers/layer_render.h"

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (double)(b)) <= (tolerance))

#define W         160
#define H         120
#define FOCAL     150.0
#define MAX_VIEWS 16
#define CELL      12 /* px, pitch of the grid of segments */

/* ---------------------------------------------------------------------------------- scenes */

struct shape {
    double (*depth)(const struct view *v, double u, double w, int *surface); /* z in the view; *surface: 0, 1, .. */
    bool constant_z; /* segments of constant z, else tangent planes */
    double sigma;
};

struct scene {
    struct view views[MAX_VIEWS];
    struct camera_set set;
    struct layer_scene layers;
};

static struct view view_at(double x, double y, double z)
{
    struct view v = {.name = "view", .width = W, .height = H, .fx = FOCAL, .fy = FOCAL, .cx = W / 2.0, .cy = H / 2.0};
    v.cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    v.center = vec3_make(x, y, z);
    v.translation = vec3_make(-x, -y, -z);
    return v;
}

/* Depth of a pixel on the surface z = f(x, y) of the world, in a view that looks along z; by iteration. */
static double meet(const struct view *v, double u, double w, double (*f)(double x, double y))
{
    double z = 4;
    for (int i = 0; i < 60; i++)
        z = 0.5 * z +
            0.5 * (f(v->center.x + (u - v->cx) / v->fx * z, v->center.y + (w - v->cy) / v->fy * z) - v->center.z);
    return z;
}

static double wave(double x, double y) { return 4 + 0.25 * sin(1.3 * x) + 0.15 * cos(1.7 * y) + 0.2 * x; }
static double tilted(double x, double y) { return 4 + 0.5 * x - 0.2 * y; }

static inline double wave_depth(const struct view *v, double u, double w, int *surface)
{
    *surface = 0;
    return meet(v, u, w, wave);
}

/* A plane, in closed form, also for turned views. 0 where it is not visible. */
static inline double tilted_depth(const struct view *v, double u, double w, int *surface)
{
    const struct vec3 c = v->center, d = vec3_sub(view_unproject(v, u, w, 1), c);
    const double z = (tilted(c.x, c.y) - c.z) / (d.z - 0.5 * d.x + 0.2 * d.y);
    *surface = 0;
    return z > 0 ? z : 0;
}

/* A square of half width 0.5 at z = 3 in front of a wall at z = 6. */
static double square_depth(const struct view *v, double u, double w, int *surface)
{
    const double z = 3 - v->center.z;
    const double x = v->center.x + (u - v->cx) / v->fx * z, y = v->center.y + (w - v->cy) / v->fy * z;
    *surface = fabs(x) < 0.5 && fabs(y) < 0.5;
    return *surface ? z : 6 - v->center.z;
}

static void texture(struct vec3 p, int surface, float rgb[3])
{
    rgb[0] = (float)(0.4 + 0.25 * sin(9 * p.x) + 0.1 * sin(4 * p.y + 3 * p.x));
    rgb[1] = (float)(0.4 + 0.2 * cos(8 * p.y) + 0.1 * sin(5 * p.x));
    rgb[2] = surface ? 0 : 0.8f;
}

/* Plane through three points of the tangent plane, or of constant z. */
static void segment_plane(double plane[3], const struct view *v, const struct shape *shape, double u, double w)
{
    int s;
    const double c = 1 / shape->depth(v, u, w, &s);
    const double a = shape->constant_z ? 0 : 1 / shape->depth(v, u + 0.5, w, &s) - 1 / shape->depth(v, u - 0.5, w, &s);
    const double b = shape->constant_z ? 0 : 1 / shape->depth(v, u, w + 0.5, &s) - 1 / shape->depth(v, u, w - 0.5, &s);
    plane[0] = a;
    plane[1] = b;
    plane[2] = c - a * u - b * w;
}

static void depth_make(struct layered_depth *d, const struct view *v, const struct shape *shape)
{
    const int columns = (W + CELL - 1) / CELL, rows = (H + CELL - 1) / CELL;
    struct err err = ERR_INIT;

    assert_int_equal(layered_depth_init(d, W, H, &err), ST_OK);
    d->segment_count = 2 * columns * rows;
    d->segments = calloc((size_t)d->segment_count, sizeof *d->segments);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const size_t p = (size_t)(y * W + x);
            int surface;
            const double u = x + 0.5, w = y + 0.5, z = shape->depth(v, u, w, &surface);
            const struct vec3 world = view_unproject(v, u, w, z);
            const uint32_t id = (uint32_t)(2 * (y / CELL * columns + x / CELL) + surface + 1);
            struct depth_segment *s = &d->segments[id - 1];
            float *rgba = d->interior.rgba + 4 * p;
            texture(world, surface, rgba);
            rgba[3] = 1;
            d->interior.z[p] = (float)z;
            d->interior.id[p] = id;
            s->pixels++;
            if (surface || shape->depth != square_depth)
                segment_plane(s->plane, v, shape, x / CELL * CELL + CELL / 2.0, y / CELL * CELL + CELL / 2.0);
            if (shape->depth == square_depth) {
                s->plane[0] = s->plane[1] = 0;
                s->plane[2] = 1 / z;
            }
        }
    for (int i = 0; i < d->segment_count; i++) {
        d->segments[i].id = (uint32_t)i + 1;
        d->segments[i].sigma = shape->sigma;
        d->segments[i].confidence = 1;
        if (!d->segments[i].pixels) d->segments[i].plane[2] = 1;
    }
}

/* brightness[i % 3] is added to the texture in view i. */
static inline void scene_make_uneven(struct scene *s, const struct shape *shape, const double (*centers)[3], int count,
                                     const float brightness[3])
{
    struct layered_depth depths[MAX_VIEWS] = {0};
    struct err err = ERR_INIT;

    memset(s, 0, sizeof *s);
    for (int i = 0; i < count; i++) {
        s->views[i] = view_at(centers[i][0], centers[i][1], centers[i][2]);
        depth_make(&depths[i], &s->views[i], shape);
        for (int p = 0; p < W * H * 4; p++)
            if (p % 4 != 3) depths[i].interior.rgba[p] *= brightness[i % 3];
    }
    s->set.views = s->views;
    s->set.view_count = count;
    if (layer_scene_init(&s->layers, &s->set, depths, &err)) fail_msg("%s", err.text);
}

static inline void scene_make(struct scene *s, const struct shape *shape, const double (*centers)[3], int count)
{
    static const float even[3] = {1, 1, 1};
    scene_make_uneven(s, shape, centers, count, even);
}

static const struct layer_render_options renderers[2] = {
    {.soft_z = SOFT_Z_WIDTHS, .fill_diameter = 6},
    {.offline = true, .more_views = 4, .soft_z = SOFT_Z_WIDTHS, .fill_diameter = 6},
};

static inline void render(struct rendered_frame *f, const struct scene *s, const struct view *novel, bool offline,
                          int fill)
{
    struct layer_render_options options = renderers[offline];
    struct err err = ERR_INIT;
    options.fill_diameter = fill;
    if (layer_render(f, &s->layers, novel, &options, &err)) fail_msg("%s", err.text);
}

static inline void frame_is_finite(const struct rendered_frame *f)
{
    for (int p = 0; p < f->width * f->height; p++) {
        assert_true(isfinite(f->z[p]) && f->z[p] >= 0);
        for (int k = 0; k < 4; k++) assert_true(isfinite(f->rgba[4 * p + k]) && f->rgba[4 * p + k] >= 0);
    }
}

/* PSNR in dB, peak 1, of the frame against the scene's texture, over pixels `margin` inside the frame that are not
 * holes. */
static inline double psnr(const struct rendered_frame *f, const struct view *v, const struct shape *shape, int margin)
{
    double sum = 0;
    int count = 0;
    for (int y = margin; y < H - margin; y++)
        for (int x = margin; x < W - margin; x++) {
            const size_t p = (size_t)(y * W + x);
            int surface;
            float rgb[3];
            const double u = x + 0.5, w = y + 0.5, z = shape->depth(v, u, w, &surface);
            if (f->hole[p]) continue;
            texture(view_unproject(v, u, w, z), surface, rgb);
            for (int k = 0; k < 3; k++) sum += pow((double)f->rgba[4 * p + (size_t)k] - (double)rgb[k], 2);
            count += 3;
        }
    return -10 * log10(fmax(sum, 1e-12) / count);
}

static inline int holes_inside(const struct rendered_frame *f, int margin)
{
    int holes = 0;
    for (int y = margin; y < H - margin; y++)
        for (int x = margin; x < W - margin; x++) holes += f->hole[y * W + x];
    return holes;
}

#endif
