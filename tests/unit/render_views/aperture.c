/* aperture.c - depth of field by lens samples, compared with optics. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "stages/render_views/aperture.h"

#define W 96
#define H 80

/* A dot of light of one square pixel at a world point, drawn with exact coverage; or a wall with a pattern. */
struct world {
    struct vec3 dot;
    double wall; /* depth; 0: only the dot */
    int frames;
};

static double overlap(double a, double b) { return fmax(0, 1 - fabs(a - b)); } /* of two unit intervals */

static enum status draw(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err)
{
    struct world *w = ctx;
    double u = 0, v = 0;

    w->frames++;
    if (rendered_frame_resize(out, camera->width, camera->height, true, err)) return err->status;
    const double z = view_project(camera, w->dot, &u, &v);
    for (int y = 0; y < camera->height; y++)
        for (int x = 0; x < camera->width; x++) {
            const int p = y * camera->width + x;
            double light = overlap(x + 0.5, u) * overlap(y + 0.5, v);
            if (w->wall > 0) {
                const struct vec3 at = view_unproject(camera, x + 0.5, y + 0.5, w->wall);
                light = 0.5 + 0.2 * sin(40 * at.x) + 0.2 * cos(30 * at.y);
            }
            for (int k = 0; k < 3; k++) out->rgba[4 * p + k] = (float)light;
            out->rgba[4 * p + 3] = 1;
            out->z[p] = (float)(w->wall > 0 ? w->wall : z);
            out->hole[p] = x == 3;
        }
    out->hole_fraction = 1.0 / W;
    return ST_OK;
}

static struct view a_camera(void)
{
    /* turned about y by a 3-4-5 triangle, so that the lens's axes differ from the world's */
    struct view v = {.name = "0001", .width = W, .height = H, .fx = 200, .fy = 190, .cx = 40.25, .cy = 42};
    v.cam_from_world = (struct mat3){{{0.8, 0, -0.6}, {0, 1, 0}, {0.6, 0, 0.8}}};
    v.translation = vec3_make(0.3, -0.2, 0.5);
    v.center = vec3_scale(mat3_apply(mat3_transpose(v.cam_from_world), v.translation), -1);
    return v;
}

static void lens_points_fill_a_disk_evenly(void **state)
{
    (void)state;
    double sum[5] = {0};
    for (int i = 0; i < 1024; i++) {
        double x, y;
        aperture_lens_point(i, &x, &y);
        assert_true(x * x + y * y <= 1 + 1e-12);
        const double values[5] = {x, y, x * x, y * y, x * y};
        for (int k = 0; k < 5; k++) sum[k] += values[k] / 1024;
    }
    const double wanted[5] = {0, 0, 0.25, 0.25, 0};
    for (int k = 0; k < 5; k++) assert_true(fabs(sum[k] - wanted[k]) < 2e-3);
}

static void points_in_focus_keep_their_pixel(void **state)
{
    (void)state;
    const struct view v = a_camera();
    for (int i = 0; i < 20; i++) {
        const double z = i % 2 ? 2.5 : 2.5 + 0.3 * i, u = 5 + 4 * i, t = 70 - 3 * i;
        const double a = 0.01 * (i - 9), b = 0.02 * (i % 5 - 2);
        const struct vec3 at = view_unproject(&v, u, t, z);
        const struct view moved = view_from_lens_point(&v, a, b, 2.5);
        double mu, mv;
        assert_true(fabs(view_project(&moved, at, &mu, &mv) - z) < 1e-12);
        assert_true(fabs(mu - u - v.fx * a * (z - 2.5) / (2.5 * z)) < 1e-9);
        assert_true(fabs(mv - t - v.fy * b * (z - 2.5) / (2.5 * z)) < 1e-9);
        /* the centre agrees with the pose */
        assert_true(vec3_length(vec3_add(mat3_apply(moved.cam_from_world, moved.center), moved.translation)) < 1e-12);
    }
}

static void a_dot_becomes_the_circle_of_confusion(void **state)
{
    (void)state;
    const struct view v = a_camera();
    static const double depths[] = {1.5, 2, 2.5, 4, 12};
    const double aperture = 0.25, focus = 2.5;

    for (int i = 0; i < 5; i++) {
        const double z = depths[i], diameter = aperture * v.fx * fabs(z - focus) / (z * focus);
        struct world w = {.dot = view_unproject(&v, 46.5, 41.5, z)};
        const struct aperture_options options = {512, 0};
        struct aperture_stats stats;
        struct rendered_frame f = {0};
        struct err err = ERR_INIT;
        double sum = 0, xx = 0, yy = 0, x_sum = 0;
        int left = W, right = -1;

        assert_ok(aperture_render(&f, &v, aperture, focus, &options, draw, &w, &stats, &err), err);
        assert_true(stats.samples == 512 && w.frames == 513);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const double light = f.rgba[4 * (y * W + x)], dx = x + 0.5 - 46.5, dy = y + 0.5 - 41.5;
                sum += light;
                x_sum += light * dx;
                xx += light * dx * dx;
                yy += light * dy * dy;
                if (light > 0 && x < left) left = x;
                if (light > 0 && x > right) right = x;
            }
        /* all light, centred, in a disk: variance diameter^2 / 16, plus that of a pixel */
        assert_true(fabs(sum - 1) < 1e-4);
        assert_true(fabs(x_sum / sum) < 0.05 + 0.01 * diameter);
        assert_true(fabs(xx - diameter * diameter / 16) < 0.25 + 0.01 * diameter * diameter);
        assert_true(fabs(yy - diameter * diameter * v.fy * v.fy / (v.fx * v.fx) / 16) <
                    0.25 + 0.01 * diameter * diameter);
        assert_true(fabs(right - left - diameter) <= 1.5);
        rendered_frame_release(&f);
    }
}

static void a_plane_in_focus_is_unchanged_and_needs_few_samples(void **state)
{
    (void)state;
    const struct view v = a_camera();
    const struct aperture_options options = {256, 0.002};
    struct aperture_stats stats;
    struct rendered_frame sharp = {0}, f = {0};
    struct world w = {.wall = 2.5};
    struct err err = ERR_INIT;

    assert_ok(draw(&w, &v, &sharp, &err), err);
    assert_ok(aperture_render(&f, &v, 0.25, 2.5, &options, draw, &w, &stats, &err), err);
    assert_int_equal(stats.samples, 8);
    for (int i = 0; i < W * H; i++) {
        for (int k = 0; k < 4; k++) assert_true(fabsf(f.rgba[4 * i + k] - sharp.rgba[4 * i + k]) < 1e-5f);
        assert_true(f.z[i] == sharp.z[i] && f.hole[i] == sharp.hole[i]);
    }
    assert_true(f.hole_fraction == sharp.hole_fraction);

    /* out of focus it needs more samples, and fewer with a larger tolerance */
    w.wall = 1.9;
    const struct aperture_options coarse = {256, 0.01};
    struct aperture_stats few;
    assert_ok(aperture_render(&f, &v, 0.25, 2.5, &options, draw, &w, &stats, &err), err);
    assert_true(stats.samples > 8 && stats.samples <= 256);
    assert_ok(aperture_render(&f, &v, 0.25, 2.5, &coarse, draw, &w, &few, &err), err);
    assert_true(few.samples <= stats.samples && few.error < 0.01);
    rendered_frame_release(&sharp);
    rendered_frame_release(&f);
}

/* The true error is measured with 4096 samples. */
static void the_error_estimate_is_close_to_the_true_error(void **state)
{
    (void)state;
    const struct view v = a_camera();
    struct rendered_frame truth = {0}, f = {0};
    struct world w = {.wall = 1.7};
    struct err err = ERR_INIT;
    const struct aperture_options all = {4096, 0};

    assert_ok(aperture_render(&truth, &v, 0.2, 2.5, &all, draw, &w, NULL, &err), err);
    for (int n = 16; n <= 64; n *= 2) {
        const struct aperture_options options = {n, 0};
        struct aperture_stats stats;
        double sum = 0;
        assert_ok(aperture_render(&f, &v, 0.2, 2.5, &options, draw, &w, &stats, &err), err);
        for (int i = 0; i < 4 * W * H; i++) {
            const double d = sqrt(f.rgba[i]) - sqrt(truth.rgba[i]);
            sum += i % 4 < 3 ? d * d / (3 * W * H) : 0;
        }
        if (getenv("APERTURE_SHOW"))
            print_message("%d samples: estimated error %g, true error %g\n", n, stats.error, sqrt(sum));
        assert_true(sqrt(sum) < stats.error);
    }
    rendered_frame_release(&truth);
    rendered_frame_release(&f);
}

static void aperture_0_gives_the_pinhole_frame(void **state)
{
    (void)state;
    const struct view v = a_camera();
    const struct aperture_options options = {64, 0.01};
    struct aperture_stats stats;
    struct rendered_frame sharp = {0}, f = {0};
    struct world w = {.wall = 3};
    struct err err = ERR_INIT;

    assert_ok(draw(&w, &v, &sharp, &err), err);
    assert_ok(aperture_render(&f, &v, 0, 0, &options, draw, &w, &stats, &err), err);
    assert_int_equal(stats.samples, 0);
    assert_true(stats.error == 0);
    assert_memory_equal(f.rgba, sharp.rgba, W * H * 4 * sizeof(float));
    rendered_frame_release(&sharp);
    rendered_frame_release(&f);
}

static void any_thread_count_gives_the_same_bits(void **state)
{
    (void)state;
    const struct view v = a_camera();
    const struct aperture_options options = {48, 0};
    struct rendered_frame one = {0}, two = {0};
    struct world w = {.wall = 1.9};
    struct err err = ERR_INIT;
    const int threads = parallel_threads();

    parallel_set_threads(1);
    assert_ok(aperture_render(&one, &v, 0.25, 2.5, &options, draw, &w, NULL, &err), err);
    parallel_set_threads(3);
    assert_ok(aperture_render(&two, &v, 0.25, 2.5, &options, draw, &w, NULL, &err), err);
    parallel_set_threads(threads);
    assert_memory_equal(one.rgba, two.rgba, W * H * 4 * sizeof(float));
    rendered_frame_release(&one);
    rendered_frame_release(&two);
}

static enum status fail_third(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err)
{
    struct world *w = ctx;
    return w->frames == 2 ? err_set(err, ST_DATA, "the third frame failed.") : draw(ctx, camera, out, err);
}

static void invalid_apertures_and_failed_frames_are_errors(void **state)
{
    (void)state;
    const struct view v = a_camera();
    const struct aperture_options options = {64, 0.01};
    const double bad[][2] = {{-1, 2}, {NAN, 2}, {INFINITY, 2}, {0.1, 0}, {0.1, -2}, {0.1, NAN}};
    struct rendered_frame f = {0};
    struct world w = {.wall = 3};

    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err err = ERR_INIT;
        assert_int_equal(aperture_render(&f, &v, bad[i][0], bad[i][1], &options, draw, &w, NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, "frame 0001");
    }
    struct err err = ERR_INIT;
    w.frames = 0;
    assert_int_equal(aperture_render(&f, &v, 0.1, 2, &options, fail_third, &w, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "third frame failed");
    rendered_frame_release(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lens_points_fill_a_disk_evenly),
        cmocka_unit_test(points_in_focus_keep_their_pixel),
        cmocka_unit_test(a_dot_becomes_the_circle_of_confusion),
        cmocka_unit_test(a_plane_in_focus_is_unchanged_and_needs_few_samples),
        cmocka_unit_test(the_error_estimate_is_close_to_the_true_error),
        cmocka_unit_test(aperture_0_gives_the_pinhole_frame),
        cmocka_unit_test(any_thread_count_gives_the_same_bits),
        cmocka_unit_test(invalid_apertures_and_failed_frames_are_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
