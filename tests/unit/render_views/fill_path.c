/* fill_path.c - a camera slides past a box in front of a wall; the wall hidden from the only photo is filled. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "stages/render_views/fill_path.h"

#define W      120
#define H      80
#define FRAMES 23
#define BOX_Z  4.0
#define WALL_Z 10.0

static const float red[3] = {0.9f, 0, 0};

/* Smooth noise on the wall, in cells of five pixels. */
static void wall_color(double x, double y, float rgb[3])
{
    const struct rng rng = rng_make(5, "test", "wall");
    const double u = (x + 100) * 2, v = (y + 100) * 2, fx = u - floor(u), fy = v - floor(v);
    for (uint64_t k = 0; k < 3; k++) {
        double sum = 0;
        for (int c = 0; c < 4; c++) {
            const uint64_t cell = (uint64_t)(floor(v) + (c >> 1)) * 100000 + (uint64_t)(floor(u) + (c & 1));
            sum += ((c & 1) ? fx : 1 - fx) * ((c >> 1) ? fy : 1 - fy) * rng_uniform(&rng, cell, k);
        }
        rgb[k] = (float)(0.2 + 0.6 * sum);
    }
}

static bool in_box(double x, double y) { return fabs(x) < 0.8 && fabs(y) < 0.9; }

struct world {
    struct camera_path path;
    int renders;
};

/* Renders frame `index` without filling: wall points that the box hides from (0, 0, 0) are holes. */
static enum status render(void *ctx, int index, struct rendered_frame *f, struct err *err)
{
    struct world *world = ctx;
    const struct view *camera = &world->path.frames[index].camera;
    const enum status st = rendered_frame_resize(f, W, H, true, err);

    world->renders++;
    for (int p = 0; !st && p < W * H; p++) {
        float *c = f->rgba + 4 * p;
        const struct vec3 near = view_unproject(camera, p % W + 0.5, p / W + 0.5, BOX_Z - camera->center.z);
        const struct vec3 far = view_unproject(camera, p % W + 0.5, p / W + 0.5, WALL_Z - camera->center.z);
        const bool box = in_box(near.x, near.y);
        f->hole[p] = !box && in_box(far.x * BOX_Z / WALL_Z, far.y * BOX_Z / WALL_Z);
        c[3] = !f->hole[p];
        f->z[p] = f->hole[p] ? 0 : (float)((box ? BOX_Z : WALL_Z) - camera->center.z);
        memset(c, 0, 3 * sizeof *c);
        if (box)
            memcpy(c, red, sizeof red);
        else if (!f->hole[p])
            wall_color(far.x, far.y, c);
    }
    return st;
}

static void world_make(struct world *world, int frames)
{
    struct err err = ERR_INIT;
    memset(world, 0, sizeof *world);
    assert_ok(camera_path_init(&world->path, "test", 30, frames, &err), err);
    for (int i = 0; i < frames; i++) {
        struct view *c = &world->path.frames[i].camera;
        c->width = W;
        c->height = H;
        c->fx = c->fy = 100;
        c->cx = W / 2.0;
        c->cy = H / 2.0;
        c->cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        c->center = vec3_make(-0.6 + 1.3 * i / FRAMES, 0.02 * i, -0.015 * i);
        c->translation = vec3_scale(c->center, -1);
    }
}

static struct fill_path_options options(int anchors)
{
    const struct exemplar_params exemplar = EXEMPLAR_PARAMS_DEFAULT;
    return (struct fill_path_options){{{3, 6}, 0.01f}, exemplar, 6, anchors, NULL};
}

/* Renders and fills a frame. */
static void frame_fill(struct fill_path *fill, struct world *world, int index, struct rendered_frame *f)
{
    struct err err = ERR_INIT;
    const int renders = world->renders;
    assert_ok(render(world, index, f, &err), err);
    world->renders = renders;
    assert_ok(fill_path_frame(fill, index, &world->path.frames[index].camera, f, &err), err);
    assert_true(f->unfilled_fraction == 0);
    for (size_t p = 0; p < W * H; p++) {
        const float *c = f->rgba + 4 * p;
        assert_true(isfinite(c[0]) && isfinite(c[1]) && isfinite(c[2]) && c[3] == 1);
        if (!f->hole[p]) continue;
        assert_true(c[1] > 0.1f && c[2] > 0.1f); /* not the box's colour */
        assert_float_equal(f->z[p], WALL_Z - world->path.frames[index].camera.center.z, 0.02);
    }
}

/* Measures the flicker of filled pixels between frames a and b: it is *difference / *pixels. Reprojects each filled
 * pixel of a into b, where the four pixels around must be filled, too; adds the mean over R, G, B of |sqrt a - sqrt b|
 * to *difference, with b interpolated bilinearly, and 1 to *pixels. */
static void flicker_add(double *difference, double *pixels, const struct rendered_frame *a, const struct view *camera_a,
                        const struct rendered_frame *b, const struct view *camera_b)
{
    const size_t wa = (size_t)a->width, wb = (size_t)b->width;

    for (size_t p = 0; p < wa * (size_t)a->height; p++) {
        double u, v;
        if (!a->hole[p] || !(a->rgba[4 * p + 3] > 0) || !(a->z[p] > 0)) continue;
        const struct vec3 at =
            view_unproject(camera_a, (double)(p % wa) + 0.5, (double)(p / wa) + 0.5, (double)a->z[p]);
        if (!(view_project(camera_b, at, &u, &v) > 0)) continue;
        if (!(u >= 0.5 && v >= 0.5 && u < b->width - 0.5 && v < b->height - 0.5)) continue;
        const size_t q = (size_t)(v - 0.5) * wb + (size_t)(u - 0.5);
        const size_t around[4] = {q, q + 1, q + wb, q + wb + 1};
        const double fx = u - 0.5 - floor(u - 0.5), fy = v - 0.5 - floor(v - 0.5);
        const double weights[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
        double sum = 0;
        bool filled = true; /* skips pixels that a near object covers in b */
        for (int k = 0; k < 4; k++) filled &= b->hole[around[k]] && b->rgba[4 * around[k] + 3] > 0;
        if (!filled) continue;
        for (size_t c = 0; c < 3; c++) {
            double other = 0;
            for (int k = 0; k < 4; k++) other += weights[k] * sqrt(fmax(0, (double)b->rgba[4 * around[k] + c]));
            sum += fabs(sqrt(fmax(0, (double)a->rgba[4 * p + c])) - other) / 3;
        }
        *difference += sum;
        *pixels += 1;
    }
}

static double flicker(int anchors, double *pixels)
{
    const struct fill_path_options o = options(anchors);
    struct world world;
    struct fill_path fill;
    struct rendered_frame frames[2] = {0};
    double difference = 0;

    *pixels = 0;
    world_make(&world, FRAMES);
    fill_path_init(&fill, &world.path, render, &world, &o);
    for (int i = 0; i < FRAMES; i++) {
        frame_fill(&fill, &world, i, &frames[i % 2]);
        if (i)
            flicker_add(&difference, pixels, &frames[(i - 1) % 2], &world.path.frames[i - 1].camera, &frames[i % 2],
                        &world.path.frames[i].camera);
    }
    for (int i = 0; i < 2; i++) rendered_frame_release(&frames[i]);
    fill_path_release(&fill);
    camera_path_release(&world.path);
    return difference / *pixels;
}

static void anchors_reduce_flicker(void **state)
{
    (void)state;
    double alone_pixels, pixels;
    const double alone = flicker(0, &alone_pixels), coherent = flicker(8, &pixels);
    print_message("flicker %.4f over %.0f pixels without anchors, %.4f over %.0f with anchors\n", alone, alone_pixels,
                  coherent, pixels);
    assert_true(alone_pixels > 2000 && pixels > 0.9 * alone_pixels);
    assert_true(coherent < 0.2 * alone);
}

/* 0 for a static picture, and the step if the picture gets brighter. */
static void flicker_of_a_known_change_is_measured(void **state)
{
    (void)state;
    struct world world;
    struct rendered_frame a = {0}, b = {0};
    struct err err = ERR_INIT;
    double difference = 0, pixels = 0;

    world_make(&world, 1);
    const struct view *camera = &world.path.frames[0].camera;
    for (int k = 0; k < 2; k++) {
        struct rendered_frame *f = k ? &b : &a;
        assert_ok(rendered_frame_resize(f, W, H, true, &err), err);
        for (int p = 0; p < W * H; p++) {
            f->hole[p] = p % W < 60;
            for (int c = 0; c < 4; c++) f->rgba[4 * p + c] = c == 3 ? 1 : k ? 0.25f : 0.16f;
            f->z[p] = 7;
        }
    }
    flicker_add(&difference, &pixels, &a, camera, &a, camera);
    assert_true(pixels > 50 * 70 && difference < 1e-9);
    flicker_add(&difference, &pixels, &a, camera, &b, camera);
    assert_float_equal(difference / pixels, 0.05,
                       1e-6); /* half of the counted pixels are of the second call, and differ by 0.1 */
    rendered_frame_release(&a);
    rendered_frame_release(&b);
    camera_path_release(&world.path);
}

static void a_frame_does_not_depend_on_the_frames_rendered_before(void **state)
{
    (void)state;
    static const int lists[][8] = {/* 0-based; -1 ends */
                                   {22, 21, 9, 8, 7, 3, 0, -1},
                                   {13, -1},
                                   {5, 20, 1, 16, 8, 5, 22, -1},
                                   {2, 4, -1}};
    const struct fill_path_options o = options(4);
    struct world world;
    struct fill_path fill;
    struct rendered_frame all[FRAMES] = {0}, f = {0};

    world_make(&world, FRAMES);
    parallel_set_threads(1);
    fill_path_init(&fill, &world.path, render, &world, &o);
    for (int i = 0; i < FRAMES; i++) frame_fill(&fill, &world, i, &all[i]);
    assert_int_equal(world.renders, 7); /* 0 4 8 12 16 20 22: each anchor once */
    assert_int_equal(fill.rendered, 7);
    fill_path_release(&fill);
    fill_path_release(&fill);
    parallel_set_threads(2);
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        fill_path_init(&fill, &world.path, render, &world, &o);
        for (int i = 0; i < 8 && lists[k][i] >= 0; i++) {
            const struct rendered_frame *same = &all[lists[k][i]];
            frame_fill(&fill, &world, lists[k][i], &f);
            assert_memory_equal(f.rgba, same->rgba, W * H * 4 * sizeof *f.rgba);
            assert_memory_equal(f.z, same->z, W * H * sizeof *f.z);
        }
        if (lists[k][1] < 0) assert_true(fill.rendered <= 5);
        fill_path_release(&fill);
    }
    parallel_set_threads(0);
    for (int i = 0; i < FRAMES; i++) rendered_frame_release(&all[i]);
    rendered_frame_release(&f);
    camera_path_release(&world.path);
}

/* Paths of one frame, anchors at every frame, and anchors farther apart than the path is long. */
static void short_paths_work(void **state)
{
    (void)state;
    static const int cases[][2] = {{1, 8}, {2, 8}, {3, 1}, {5, 100000}}; /* frames, anchor spacing */
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct fill_path_options o = options(cases[k][1]), alone = options(0);
        struct world world;
        struct fill_path fill, single;
        struct rendered_frame f = {0}, g = {0};
        world_make(&world, cases[k][0]);
        fill_path_init(&fill, &world.path, render, &world, &o);
        fill_path_init(&single, &world.path, render, &world, &alone);
        for (int i = 0; i < cases[k][0]; i++) frame_fill(&fill, &world, i, &f);
        assert_true(fill.rendered <= cases[k][0]);
        frame_fill(&fill, &world, 0, &f);
        frame_fill(&single, &world, 0, &g);
        for (size_t i = 0; i < W * H * 4; i++) assert_float_equal(f.rgba[i], g.rgba[i], 1e-4);
        fill_path_release(&fill);
        fill_path_release(&single);
        rendered_frame_release(&f);
        rendered_frame_release(&g);
        camera_path_release(&world.path);
    }
}

static enum status broken(void *ctx, int index, struct rendered_frame *f, struct err *err)
{
    (void)ctx, (void)f;
    return err_set(err, ST_DATA, "frame %d cannot be rendered.", index + 1);
}

static void a_failed_anchor_is_an_error(void **state)
{
    (void)state;
    const struct fill_path_options o = options(8);
    struct world world;
    struct fill_path fill;
    struct rendered_frame f = {0};
    struct err err = ERR_INIT;

    world_make(&world, FRAMES);
    fill_path_init(&fill, &world.path, broken, NULL, &o);
    assert_ok(render(&world, 3, &f, &err), err);
    assert_int_equal(fill_path_frame(&fill, 3, &world.path.frames[3].camera, &f, &err), ST_DATA);
    assert_err(err, ST_DATA, "frame 1 cannot");
    fill_path_release(&fill);
    rendered_frame_release(&f);
    camera_path_release(&world.path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(anchors_reduce_flicker),
        cmocka_unit_test(flicker_of_a_known_change_is_measured),
        cmocka_unit_test(a_frame_does_not_depend_on_the_frames_rendered_before),
        cmocka_unit_test(short_paths_work),
        cmocka_unit_test(a_failed_anchor_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
