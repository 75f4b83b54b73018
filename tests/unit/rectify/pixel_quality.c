/* pixel_quality.c - the noise that a view states covers its errors, and marks reach the pixels that a kernel
 * reaches. */
#include "common/image/luminance.h"
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/image/noise_model.h"
#include "stages/rectify/resample.h"

enum { WIDTH = 600, HEIGHT = 400, PIXELS = WIDTH * HEIGHT };

static const struct mat3 same_axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static struct camera lens_of(int width, int height)
{
    return (struct camera){CAMERA_SIMPLE_PINHOLE, width, height, {300, width / 2.0, height / 2.0}};
}

/* Shows the photo's axis at `zoom` of its size; (dx, dy) px shift the principal point. */
static struct view view_of(int width, int height, double zoom, double dx, double dy)
{
    return (struct view){.name = "view",
                         .width = width,
                         .height = height,
                         .fx = 300 * zoom,
                         .fy = 300 * zoom,
                         .cx = width / 2.0 + dx,
                         .cy = height / 2.0 + dy,
                         .cam_from_world = same_axes};
}

static double normal(const struct rng *rng, uint64_t i)
{
    const double a = rng_uniform(rng, i, 0), b = rng_uniform(rng, i, 1);
    return sqrt(-2 * log(1 - a)) * cos(2 * 3.14159265358979323846 * b);
}

/* A ramp of light across the photo, the colours apart, without and with the noise of 2000 electrons. */
static void shoot(struct image *truth, struct image *photo)
{
    const struct rng rng = rng_make(3, "pixel_quality", "test");
    struct err err = ERR_INIT;
    assert_ok(image_init(truth, WIDTH, HEIGHT, 3, &err), err);
    assert_ok(image_init(photo, WIDTH, HEIGHT, 3, &err), err);
    for (int i = 0; i < 3 * PIXELS; i++) {
        const double v = (0.05 + 0.7 * (i / 3 % WIDTH) / WIDTH) * (1 - 0.2 * (i % 3));
        truth->data[i] = (float)v;
        photo->data[i] = (float)(v + normal(&rng, (uint64_t)i) * sqrt(v * 2000 + 25) / 2000);
    }
}

static void judge(struct photo_quality *q, const struct image *photo)
{
    const struct single_exposure assumed = {2000, 5, 0.95, 0.001};
    const struct photo linear = {.info = {.width = photo->width, .height = photo->height, .bits = 32}};
    struct err err = ERR_INIT;
    assert_ok(photo_quality_of_exposure(q, &linear, photo, &assumed, &err), err);
}

struct coverage {
    double within[3]; /* percent */
    size_t pixels;
};

static struct coverage cover(const struct image *view, const struct image *truth, const struct photo_quality *q)
{
    struct coverage c = {0};
    for (size_t i = 0; i < (size_t)view->width * (size_t)view->height; i++) {
        const float *p = view->data + 4 * i, *t = truth->data + 4 * i;
        if (!(p[3] > 0)) continue;
        const float light = luminance_of(p), sigma = light * photo_relative_sigma(q->variance[i], light);
        for (int k = 0; k < 3; k++) c.within[k] += fabsf(light - luminance_of(t)) <= (float)(k + 1) * sigma;
        c.pixels++;
    }
    for (int k = 0; k < 3; k++) c.within[k] *= 100 / (double)c.pixels;
    return c;
}

/* Unscaled, shifted by a part of a pixel, and reduced: each way has its own code. */
static void stated_noise_covers_the_errors_of_views(void **state)
{
    static const struct {
        double zoom, dx, dy;
    } cases[] = {{1, 0, 0}, {1, 0.5, 0.5}, {1, 0.2, 0.7}, {1.3, 0, 0}, {0.5, 0.3, 0}, {0.23, 0, 0.1}};
    const struct camera lens = lens_of(WIDTH, HEIGHT);
    struct image truth, photo;
    struct photo_quality q = {0};
    (void)state;
    shoot(&truth, &photo);
    judge(&q, &photo);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const double zoom = cases[k].zoom, size = fmin(zoom, 1);
        const struct view view = view_of((int)(WIDTH * size), (int)(HEIGHT * size), zoom, cases[k].dx, cases[k].dy);
        const struct resample_source noisy = {.linear = &photo, .quality = &q}, exact = {.linear = &truth};
        struct image seen = {0}, wanted = {0};
        struct photo_quality stated = {0};
        struct err err = ERR_INIT;
        assert_ok(resample_photo(&seen, &stated, &noisy, &lens, &same_axes, &view, &err), err);
        assert_ok(resample_photo(&wanted, NULL, &exact, &lens, &same_axes, &view, &err), err);
        const struct coverage c = cover(&seen, &wanted, &stated);
        print_message("zoom %g, shift %g %g: %.2f %.2f %.2f %% of %zu pixels\n", zoom, cases[k].dx, cases[k].dy,
                      c.within[0], c.within[1], c.within[2], c.pixels);
        /* four standard errors of a share, with neighbours that share samples counted as one in four; where the filter
         * limits results to the range of the nearest samples, noise is smaller than stated, by less than a percent of
         * the pixels */
        static const double shares[3] = {68.27, 95.45, 99.73}, deviations[3] = {0.466, 0.208, 0.052};
        for (int n = 0; n < 3; n++) {
            const double error = 4 * 100 * deviations[n] / sqrt((double)c.pixels / 4);
            assert_true(c.within[n] > shares[n] - error);
            assert_true(c.within[n] < shares[n] + error + 1);
        }
        image_release(&seen);
        image_release(&wanted);
        photo_quality_release(&stated);
    }
    photo_quality_release(&q);
    image_release(&truth);
    image_release(&photo);
}

/* Half a pixel to the side, the kernel has the weights of Lanczos-3 at 0.5, 1.5 and 2.5 on both sides. */
static void equal_noise_falls_by_the_squared_weights(void **state)
{
    enum { SIDE = 24 };
    const struct camera lens = lens_of(SIDE, SIDE);
    const struct view view = view_of(SIDE, SIDE, 1, 0.5, 0);
    struct image photo = {0}, seen = {0};
    struct photo_quality q = {0}, stated = {0};
    struct err err = ERR_INIT;
    double sum = 0, squares = 0;
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double x = M_PI * (i + 0.5), w = sin(x) / x * sin(x / 3) / (x / 3);
        sum += 2 * w;
        squares += 2 * w * w;
    }
    assert_ok(image_init(&photo, SIDE, SIDE, 3, &err), err);
    for (int i = 0; i < 3 * SIDE * SIDE; i++) photo.data[i] = 0.5f;
    assert_ok(photo_quality_init(&q, SIDE, SIDE, &err), err);
    for (int i = 0; i < SIDE * SIDE; i++) q.variance[i] = 0.01f;
    const struct resample_source source = {.linear = &photo, .quality = &q};
    assert_ok(resample_photo(&seen, &stated, &source, &lens, &same_axes, &view, &err), err);
    assert_float_equal(stated.variance[SIDE / 2 * SIDE + SIDE / 2], 0.01 * squares / (sum * sum), 1e-6);
    image_release(&seen);
    photo_quality_release(&stated);
    image_release(&photo);
    photo_quality_release(&q);
}

/* A photo of one column: every tap is the same sample, so filtering across it does not reduce noise. */
static void repeated_border_samples_count_as_one(void **state)
{
    const struct camera lens = {CAMERA_SIMPLE_PINHOLE, 1, 64, {300, 0.5, 32}};
    const struct view view = {.name = "view",
                              .width = 1,
                              .height = 64,
                              .fx = 300,
                              .fy = 300,
                              .cx = 0.7,
                              .cy = 32,
                              .cam_from_world = same_axes};
    struct image photo = {0}, seen = {0};
    struct photo_quality q = {0}, stated = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(image_init(&photo, 1, 64, 3, &err), err);
    for (int i = 0; i < 3 * 64; i++) photo.data[i] = 0.5f;
    assert_ok(photo_quality_init(&q, 1, 64, &err), err);
    for (int i = 0; i < 64; i++) q.variance[i] = 0.01f;
    const struct resample_source source = {.linear = &photo, .quality = &q};
    assert_ok(resample_photo(&seen, &stated, &source, &lens, &same_axes, &view, &err), err);
    for (int y = 8; y < 56; y++) assert_float_equal(stated.variance[y], 0.01, 1e-6); /* rows coincide */
    image_release(&seen);
    photo_quality_release(&stated);
    image_release(&photo);
    photo_quality_release(&q);
}

static void marks_reach_as_far_as_the_kernel(void **state)
{
    enum { SIDE = 40, AT = 21 };
    const struct camera lens = lens_of(SIDE, SIDE);
    struct image photo = {0};
    struct photo_quality q = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(image_init(&photo, SIDE, SIDE, 3, &err), err);
    for (int i = 0; i < 3 * SIDE * SIDE; i++) photo.data[i] = 0.5f;
    photo.data[3 * (AT * SIDE + AT)] = 0.97f;
    photo.data[3 * (30 * SIDE + 8) + 2] = 0;
    judge(&q, &photo);
    assert_int_equal(q.marks[AT * SIDE + AT], PHOTO_BRIGHT);
    assert_int_equal(q.marks[30 * SIDE + 8], PHOTO_DARK);
    for (int shifted = 0; shifted < 2; shifted++) {
        const struct view view = view_of(SIDE, SIDE, 1, shifted ? 0.5 : 0, shifted ? 0.5 : 0);
        const struct resample_source source = {.linear = &photo, .quality = &q};
        struct image seen = {0};
        struct photo_quality stated = {0};
        assert_ok(resample_photo(&seen, &stated, &source, &lens, &same_axes, &view, &err), err);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                /* the view's pixel x is at x - 0.5 in the photo if it is shifted */
                const double at_x = x - 0.5 * shifted, at_y = y - 0.5 * shifted, reach = shifted ? 3 : 0.5;
                const bool bright = fabs(at_x - AT) < reach && fabs(at_y - AT) < reach;
                const bool dark = fabs(at_x - 8) < reach && fabs(at_y - 30) < reach;
                if (!(seen.data[4 * (y * SIDE + x) + 3] > 0)) continue;
                assert_int_equal(stated.marks[y * SIDE + x], (bright ? PHOTO_BRIGHT : 0) | (dark ? PHOTO_DARK : 0));
            }
        image_release(&seen);
        photo_quality_release(&stated);
    }
    image_release(&photo);
    photo_quality_release(&q);
}

static void threads_do_not_change_the_result(void **state)
{
    const struct camera lens = lens_of(WIDTH, HEIGHT);
    const struct view view = view_of(420, 280, 0.7, 0.3, 0.4);
    struct image truth, photo, first = {0};
    struct photo_quality q = {0}, one = {0};
    struct err err = ERR_INIT;
    (void)state;
    shoot(&truth, &photo);
    judge(&q, &photo);
    const struct resample_source source = {.linear = &photo, .quality = &q};
    for (int threads = 1; threads <= 3; threads++) {
        struct image seen = {0};
        struct photo_quality stated = {0};
        parallel_set_threads(threads);
        assert_ok(resample_photo(&seen, &stated, &source, &lens, &same_axes, &view, &err), err);
        if (threads == 1) {
            first = seen;
            one = stated;
            continue;
        }
        assert_memory_equal(stated.variance, one.variance, 420 * 280 * sizeof *one.variance);
        assert_memory_equal(stated.marks, one.marks, 420 * 280);
        image_release(&seen);
        photo_quality_release(&stated);
    }
    parallel_set_threads(1);
    photo_quality_release(&one);
    photo_quality_release(&q);
    image_release(&first);
    image_release(&truth);
    image_release(&photo);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stated_noise_covers_the_errors_of_views),
        cmocka_unit_test(equal_noise_falls_by_the_squared_weights),
        cmocka_unit_test(repeated_border_samples_count_as_one),
        cmocka_unit_test(marks_reach_as_far_as_the_kernel),
        cmocka_unit_test(threads_do_not_change_the_result),
    };
    return cmocka_run_group_tests_name("pixel_quality", tests, NULL, NULL);
}
