/* layer_render.c - layered depth maps of scenes with known shape, seen from where no photo was taken. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/layer_raster.h"
#include "common/layer_render.h"
#include "common/parallel.h"

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (double)(b)) <= (tolerance))

#define W         160
#define H         120
#define FOCAL     150.0
#define MAX_VIEWS 5
#define CELL      12 /* segments are cut along a grid of this pitch */

/* ---------------------------------------------------------------------------------- scenes that are formulas */

struct shape {
    double (*depth)(const struct view *v, double u, double w, int *surface); /* z in the view; surface 0, 1.. */
    bool constant_z; /* segments are cut in constant z, else follow the tangent plane */
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

/* A pixel's depth on a surface z = f(x, y) of the world, in a view that looks along z: by iteration. */
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

static double wave_depth(const struct view *v, double u, double w, int *surface)
{
    *surface = 0;
    return meet(v, u, w, wave);
}

static double tilted_depth(const struct view *v, double u, double w, int *surface)
{
    *surface = 0;
    return meet(v, u, w, tilted);
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

/* 1/z through three points of the tangent, or constant. */
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
            const struct vec3 world =
                vec3_add(v->center, vec3_make((u - v->cx) / v->fx * z, (w - v->cy) / v->fy * z, z));
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
        if (!d->segments[i].pixels) d->segments[i].plane[2] = 1;
    }
}

static void scene_make(struct scene *s, const struct shape *shape, const double (*centers)[3], int count)
{
    struct layered_depth depths[MAX_VIEWS] = {0};
    struct err err = ERR_INIT;

    memset(s, 0, sizeof *s);
    for (int i = 0; i < count; i++) {
        s->views[i] = view_at(centers[i][0], centers[i][1], centers[i][2]);
        depth_make(&depths[i], &s->views[i], shape);
    }
    s->set.views = s->views;
    s->set.view_count = count;
    if (layer_scene_init(&s->layers, &s->set, depths, &err)) fail_msg("%s", err.text);
}

static void render(struct rendered_frame *f, const struct scene *s, const struct view *novel, int fill)
{
    const struct layer_render_options options = {3, fill};
    struct err err = ERR_INIT;
    if (layer_render(f, &s->layers, novel, &options, &err)) fail_msg("%s", err.text);
}

/* dB of the frame against the scene's own texture seen from there, over pixels `margin` inside the frame that are no
 * holes; peak 1. */
static double psnr(const struct rendered_frame *f, const struct view *v, const struct shape *shape, int margin)
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
            texture(vec3_add(v->center, vec3_make((u - v->cx) / v->fx * z, (w - v->cy) / v->fy * z, z)), surface, rgb);
            for (int k = 0; k < 3; k++) sum += pow((double)f->rgba[4 * p + (size_t)k] - (double)rgb[k], 2);
            count += 3;
        }
    return -10 * log10(fmax(sum, 1e-12) / count);
}

static int holes_inside(const struct rendered_frame *f, int margin)
{
    int holes = 0;
    for (int y = margin; y < H - margin; y++)
        for (int x = margin; x < W - margin; x++) holes += f->hole[y * W + x];
    return holes;
}

static const double one[][3] = {{0, 0, 0}};
static const double four[][3] = {{-0.3, -0.2, 0}, {0.3, -0.2, 0}, {-0.3, 0.25, 0}, {0.3, 0.25, 0}};

static const struct shape tilted_planes = {tilted_depth, false, 0.01};
static const struct shape wave_planes = {wave_depth, false, 0.01};
static const struct shape wave_steps = {wave_depth, true, 0.02};
static const struct shape square = {square_depth, true, 0.01};

/* ------------------------------------------------------------------------------------------------------- tests */

static void an_input_camera_gives_back_its_photo(void **state)
{
    (void)state;
    static const struct shape *const shapes[] = {&tilted_planes, &wave_steps, &square};
    for (int k = 0; k < 3; k++) {
        struct scene s;
        struct rendered_frame f = {0};
        scene_make(&s, shapes[k], one, 1);
        render(&f, &s, &s.views[0], 6);
        assert_near(f.hole_fraction, 0, 0);
        assert_true(psnr(&f, &s.views[0], shapes[k], 0) > 65); /* half's rounding is the limit */
        layer_scene_release(&s.layers);

        scene_make(&s, shapes[k], four, 4); /* on the mesh: that view's weight is one */
        render(&f, &s, &s.views[2], 6);
        assert_true(psnr(&f, &s.views[2], shapes[k], 0) > 45);
        layer_scene_release(&s.layers);
        rendered_frame_release(&f);
    }
}

static void depth_follows_the_planes(void **state)
{
    (void)state;
    struct scene s;
    struct rendered_frame f = {0};
    const struct view novel = view_at(0.1, 0.05, 0.3);
    scene_make(&s, &tilted_planes, four, 4);
    render(&f, &s, &novel, 6);
    for (int y = 15; y < H - 15; y++)
        for (int x = 15; x < W - 15; x++) assert_near(f.z[y * W + x], meet(&novel, x + 0.5, y + 0.5, tilted), 1e-4);
    assert_true(psnr(&f, &novel, &tilted_planes, 15) > 35);
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void a_surface_in_pieces_shows_no_cracks(void **state)
{
    (void)state;
    /* one view, so nothing else could close a crack; tangent planes, then steps of constant z */
    static const struct shape *const shapes[] = {&wave_planes, &wave_steps};
    for (int k = 0; k < 2; k++) {
        struct scene s;
        struct rendered_frame f = {0};
        scene_make(&s, shapes[k], one, 1);
        for (int i = 0; i < 12; i++) { /* up to 17 px of parallax, 0.7 between neighbours */
            const struct view novel = view_at(0.45 * cos(i), 0.45 * sin(i), 0.2 * sin(2 * i));
            render(&f, &s, &novel, 0);
            assert_int_equal(holes_inside(&f, 30), 0);
            for (int y = 30; y < H - 30; y++)
                for (int x = 30; x < W - 30; x++) {
                    assert_near(f.rgba[4 * (y * W + x) + 3], 1, 0);
                    assert_near(f.rgba[4 * (y * W + x) + 2], 0.8, 0.01);
                }
        }
        layer_scene_release(&s.layers);
        rendered_frame_release(&f);
    }
}

static void a_small_move_changes_the_picture_a_little(void **state)
{
    (void)state;
    static const struct shape *const shapes[] = {&wave_steps, &square};
    static const double steps[] = {1e-2, 1e-3, 1e-4};
    for (int k = 0; k < 2; k++) {
        struct scene s;
        struct rendered_frame a = {0}, b = {0};
        const struct view here = view_at(0.07, 0.03, 0.4);
        scene_make(&s, shapes[k], four, 4);
        render(&a, &s, &here, 6);
        for (int i = 0; i < 3; i++) {
            const struct view there = view_at(0.07 + steps[i], 0.03, 0.4);
            double change = 0;
            render(&b, &s, &there, 6);
            for (int p = 0; p < W * H * 4; p++) change += fabs((double)a.rgba[p] - (double)b.rgba[p]);
            /* a parallax of FOCAL / z = 40 px a unit, texture of 0.05 a px */
            assert_true(change / (W * H * 4) < 3 * steps[i]);
        }
        layer_scene_release(&s.layers);
        rendered_frame_release(&a);
        rendered_frame_release(&b);
    }
}

static void threads_do_not_change_a_bit(void **state)
{
    (void)state;
    struct scene s;
    struct rendered_frame a = {0}, b = {0};
    const int threads = parallel_threads();
    scene_make(&s, &square, four, 4);
    for (int i = 0; i < 3; i++) {
        const struct view novel = view_at(0.4 * i, 0.1, -0.3 + 0.3 * i);
        parallel_set_threads(1);
        render(&a, &s, &novel, 6);
        parallel_set_threads(3);
        render(&b, &s, &novel, 6);
        assert_memory_equal(a.rgba, b.rgba, sizeof *a.rgba * W * H * 4);
        assert_memory_equal(a.z, b.z, sizeof *a.z * W * H);
        assert_memory_equal(a.hole, b.hole, W * H);
    }
    /* a frame that was used before, and of another size, gives what a fresh one gives */
    struct view small = view_at(0, 0.1, -0.3);
    small.width = 64;
    render(&a, &s, &small, 6);
    render(&a, &s, &s.views[0], 6);
    rendered_frame_release(&b);
    render(&b, &s, &s.views[0], 6);
    assert_memory_equal(a.rgba, b.rgba, sizeof *a.rgba * W * H * 4);
    parallel_set_threads(threads);
    layer_scene_release(&s.layers);
    rendered_frame_release(&a);
    rendered_frame_release(&b);
}

static void what_no_view_saw_is_a_hole_filled_from_behind(void **state)
{
    (void)state;
    struct scene s;
    struct rendered_frame f = {0}, cover = {0};
    struct err err = ERR_INIT;
    const double shift = 0.2;
    const struct view novel = view_at(shift, 0, 0);
    const int disparity = 5; /* FOCAL shift (1/3 - 1/6) */
    scene_make(&s, &square, one, 1);
    assert_near(s.layers.near_depth, 3, 1e-9);
    assert_near(s.layers.far_depth, 6, 1e-9);

    render(&f, &s, &novel, 0);
    /* a strip of `disparity` px right of the square (35..45 px wide picture of half width 25), and the border's
     * FOCAL shift / 6 = 5 */
    assert_near(f.hole_fraction * W * H, 50 * disparity + H * 5, 80);
    assert_near(f.unfilled_fraction, f.hole_fraction, 0);
    const int left = W / 2 + 25 - 10, middle = H / 2; /* the square's right edge moves by FOCAL shift / 3 = 10 */
    assert_int_equal(f.hole[middle * W + left + 2], 1);
    assert_near(f.rgba[4 * (middle * W + left + 2) + 3], 0, 0);
    assert_near(f.z[middle * W + left + 2], 0, 0);
    assert_near(f.z[middle * W + left - 2], 3, 1e-5);

    assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 1, &err), ST_OK);
    assert_memory_equal(cover.hole, f.hole, W * H);
    assert_near(cover.hole_fraction, f.hole_fraction, 0);
    assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 0.5, &err), ST_OK);
    assert_int_equal(cover.width, W / 2);
    assert_near(cover.hole_fraction, f.hole_fraction, 0.01);

    render(&f, &s, &novel, 6);
    assert_near(f.unfilled_fraction, 0, 0);
    assert_int_equal(f.hole[middle * W + left + 2], 1);
    for (int x = left + 1; x < left + disparity; x++) {
        assert_near(f.z[middle * W + x], 6, 0.01);
        assert_near(f.rgba[4 * (middle * W + x) + 2], 0.8, 0.02); /* the wall's blue, none of the square's */
    }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
    rendered_frame_release(&cover);
}

static void no_hole_along_a_rail(void **state)
{
    (void)state;
    /* along the rail and in front of it; coverage and rendering agree on every pixel */
    static const double rail[][3] = {{-0.6, 0, 0}, {-0.3, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}};
    struct scene s;
    struct rendered_frame f = {0};
    scene_make(&s, &square, rail, 4);
    for (int i = 0; i < 9; i++) {
        const struct view novel = view_at(-0.6 + 0.15 * i, 0, 0.2);
        struct rendered_frame cover = {0};
        struct err err = ERR_INIT;
        render(&f, &s, &novel, 0);
        assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 1, &err), ST_OK);
        assert_memory_equal(cover.hole, f.hole, W * H);
        assert_int_equal(holes_inside(&f, 30), 0);
        assert_true(psnr(&f, &novel, &square, 30) > 25);
        rendered_frame_release(&cover);
    }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void a_picture_border_leaves_no_line(void **state)
{
    (void)state;
    /* the right views are a fifth darker: where their pictures end the frame must not step */
    static const double rail[][3] = {{-0.8, 0, 0}, {0.8, 0, 0}};
    const struct view novel = view_at(-0.2, 0, 0);
    struct scene s;
    struct layered_depth depths[2];
    struct rendered_frame f = {0};
    struct err err = ERR_INIT;

    memset(&s, 0, sizeof s);
    for (int i = 0; i < 2; i++) {
        s.views[i] = view_at(rail[i][0], rail[i][1], rail[i][2]);
        depth_make(&depths[i], &s.views[i], &tilted_planes);
        for (int p = 0; p < W * H * 4; p++)
            if (p % 4 != 3) depths[i].interior.rgba[p] = i ? 0.8f : 1;
    }
    s.set.views = s.views;
    s.set.view_count = 2;
    assert_int_equal(layer_scene_init(&s.layers, &s.set, depths, &err), ST_OK);
    render(&f, &s, &novel, 6);
    for (int y = 4; y < H - 4; y++) /* not the corners, where both fade at once */
        for (int x = 1; x < W; x++)
            assert_near(f.rgba[4 * (y * W + x)], f.rgba[4 * (y * W + x - 1)], 0.06); /* 0.2 over 8 px of fading */
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void erase(struct layered_depth *d, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t p = (size_t)(y * W + x);
            d->interior.id[p] = 0;
            memset(d->interior.rgba + 4 * p, 0, 4 * sizeof(float));
        }
}

static void a_hole_takes_the_nearest_view_that_does_not_hang_in_the_air(void **state)
{
    (void)state;
    /* the two views that the mesh names lack the same patch of wall above the square: novel [70, 90) x [18, 30) */
    static const double rail[][3] = {{-0.6, 0, 0}, {-0.3, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}};
    const struct view novel = view_at(0.05, 0, 0.001);
    for (int phantom = 0; phantom < 2; phantom++) {
        struct scene s;
        struct layered_depth depths[4];
        struct rendered_frame f = {0};
        struct err err = ERR_INIT;

        memset(&s, 0, sizeof s);
        for (int i = 0; i < 4; i++) {
            s.views[i] = view_at(rail[i][0], rail[i][1], rail[i][2]);
            depth_make(&depths[i], &s.views[i], &square);
        }
        erase(&depths[1], 78, 18, 100, 30); /* FOCAL 0.3 / 6 = 7.5 px to either side */
        erase(&depths[2], 62, 18, 84, 30);
        for (int i = 0; phantom && i < depths[3].segment_count; i++) /* the next one's wall is in front of all */
            if (fabs(depths[3].segments[i].plane[2] - 1.0 / 6) < 1e-6) depths[3].segments[i].plane[2] = 1 / 1.5;
        s.set.views = s.views;
        s.set.view_count = 4;
        assert_int_equal(layer_scene_init(&s.layers, &s.set, depths, &err), ST_OK);
        render(&f, &s, &novel, 0);
        assert_int_equal(holes_inside(&f, 10), 0);
        for (int y = 19; y < 29; y++)
            for (int x = 72; x < 88; x++) assert_near(f.z[y * W + x], 6, 0.01);
        assert_true(psnr(&f, &novel, &square, 10) > 30);
        layer_scene_release(&s.layers);
        rendered_frame_release(&f);
    }
}

static void boundaries_composite_to_the_photo(void **state)
{
    (void)state;
    /* the square's rim, two pixels wide, is matted: half in each layer */
    struct layered_depth d;
    struct view v = view_at(0, 0, 0);
    struct camera_set set = {.views = &v, .view_count = 1};
    struct layer_scene layers = {0};
    struct rendered_frame f = {0};
    struct err err = ERR_INIT;
    const struct layer_render_options options = {3, 6};
    float *photo = malloc(sizeof *photo * W * H * 4);

    depth_make(&d, &v, &square);
    memcpy(photo, d.interior.rgba, sizeof *photo * W * H * 4);
    for (int y = 0; y < H; y++)
        for (int x = 1; x + 1 < W; x++) {
            const size_t p = (size_t)(y * W + x);
            const uint32_t side[2] = {d.interior.id[p - 1], d.interior.id[p + 1]};
            const uint32_t other = side[0] != d.interior.id[p] ? side[0] : side[1];
            if (other == d.interior.id[p] || (other & 1) == (d.interior.id[p] & 1)) continue;
            d.boundary.id[p] = other;
            d.boundary.z[p] = (float)(1 / d.segments[other - 1].plane[2]);
            for (int k = 0; k < 4; k++) {
                d.boundary.rgba[4 * p + (size_t)k] = 0.375f * photo[4 * p + (size_t)k];
                d.interior.rgba[4 * p + (size_t)k] = 0.625f * photo[4 * p + (size_t)k];
            }
        }
    assert_int_equal(layer_scene_init(&layers, &set, &d, &err), ST_OK);
    assert_int_equal(layer_render(&f, &layers, &v, &options, &err), ST_OK);
    for (int p = 0; p < W * H; p++) {
        for (int k = 0; k < 3; k++) assert_near(f.rgba[4 * p + k], photo[4 * p + k], 1.0 / 1024);
        assert_true(fabsf(f.z[p] - 3) < 1e-4f || fabsf(f.z[p] - 6) < 1e-4f);
    }
    free(photo);
    layer_scene_release(&layers);
    rendered_frame_release(&f);
}

static void odd_places_to_stand(void **state)
{
    (void)state;
    struct scene s;
    struct rendered_frame f = {0};
    scene_make(&s, &square, four, 4);

    struct view away = view_at(0, 0, 0); /* turned round: nothing to see */
    away.cam_from_world = (struct mat3){{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
    away.translation = vec3_make(0, 0, 0);
    render(&f, &s, &away, 6);
    assert_near(f.hole_fraction, 1, 0);
    assert_near(f.unfilled_fraction, 1, 0);

    struct view behind = view_at(0, 0, 9); /* behind the wall, looking on */
    render(&f, &s, &behind, 6);
    assert_near(f.hole_fraction, 1, 0);

    const struct view places[] = {view_at(0, 0, 3), view_at(0.1, 0, 2.999999), view_at(0, 0, 6), view_at(0, 0, -50),
                                  view_at(1e4, 0, 0)}; /* on the square, the wall, far off */
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        render(&f, &s, &places[i], 6);
        for (int p = 0; p < W * H; p++) {
            assert_true(isfinite(f.z[p]) && f.z[p] >= 0);
            for (int k = 0; k < 4; k++) assert_true(isfinite(f.rgba[4 * p + k]));
        }
    }
    struct view pixel = view_at(0, 0, 0);
    pixel.width = pixel.height = 1;
    pixel.cx = pixel.cy = 0.5;
    render(&f, &s, &pixel, 6);
    assert_near(f.z[0], 3, 1e-4);
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void broken_depth_maps_are_refused(void **state)
{
    (void)state;
    struct view v = view_at(0, 0, 0);
    struct camera_set set = {.views = &v, .view_count = 1};
    struct layer_scene layers = {0};
    struct layered_depth d;
    struct err err = ERR_INIT;

    depth_make(&d, &v, &square);
    d.boundary.id[7] = (uint32_t)d.segment_count + 1;
    assert_int_equal(layer_scene_init(&layers, &set, &d, &err), ST_DATA);
    assert_non_null(strstr(err.text, "pixel (7, 0)"));
    assert_null(d.segments);

    err = (struct err)ERR_INIT;
    depth_make(&d, &v, &square);
    v.width = W + 1;
    assert_int_equal(layer_scene_init(&layers, &set, &d, &err), ST_DATA);
    assert_non_null(strstr(err.text, "160 x 120"));
    layer_scene_release(&layers);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_input_camera_gives_back_its_photo),
        cmocka_unit_test(depth_follows_the_planes),
        cmocka_unit_test(a_surface_in_pieces_shows_no_cracks),
        cmocka_unit_test(a_small_move_changes_the_picture_a_little),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(what_no_view_saw_is_a_hole_filled_from_behind),
        cmocka_unit_test(no_hole_along_a_rail),
        cmocka_unit_test(a_picture_border_leaves_no_line),
        cmocka_unit_test(a_hole_takes_the_nearest_view_that_does_not_hang_in_the_air),
        cmocka_unit_test(boundaries_composite_to_the_photo),
        cmocka_unit_test(odd_places_to_stand),
        cmocka_unit_test(broken_depth_maps_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
