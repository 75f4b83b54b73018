/* align.c - exposures with known shifts. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "stages/hdr_merge/align.h"

enum { WIDTH = 320, HEIGHT = 240 };

/* Radiance of boxes and noise over four decades, with detail finer than the shifts. */
static double scene(int x, int y)
{
    const int bx = (x + 4096) / 23, by = (y + 4096) / 17;
    const uint32_t h = (uint32_t)(bx * 7919 + by * 104729) * 2654435761u;
    const double big = pow(10, 3.0 * ((h >> 8) % 1000) / 1000 - 2), ripple = 1 + 0.3 * sin(0.9 * x) * cos(0.7 * y);
    return big * ripple;
}

struct stack {
    struct photo photos[8];
    double exposures[8];
    int count;
};

/* Exposure k shows (x - dx, y - dy) of the scene at (x, y). noise: in steps of 8 bits. */
static void shoot(struct stack *s, int count, double shortest, double step, const struct shift *shifts, double noise)
{
    *s = (struct stack){.count = count};
    for (int k = 0; k < count; k++) {
        const struct rng rng = rng_make(3, "align", "test");
        s->exposures[k] = shortest * pow(step, k);
        s->photos[k].info = (struct photo_info){.width = WIDTH, .height = HEIGHT, .bits = 8};
        s->photos[k].samples = malloc(sizeof(uint16_t) * 3 * WIDTH * HEIGHT);
        assert_non_null(s->photos[k].samples);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const double light = scene(i % WIDTH - shifts[k].dx, i / WIDTH - shifts[k].dy) * s->exposures[k];
            for (int c = 0; c < 3; c++) {
                double v = 255 * srgb_from_linear((float)(light * (1 - 0.2 * c)));
                v += noise * (rng_uniform(&rng, (uint64_t)(3 * i + c), (uint32_t)(2 * k)) +
                              rng_uniform(&rng, (uint64_t)(3 * i + c), (uint32_t)(2 * k + 1)) - 1);
                s->photos[k].samples[3 * i + c] = (uint16_t)fmin(fmax(v + 0.5, 0), 255);
            }
        }
    }
}

static void release(struct stack *s)
{
    for (int k = 0; k < s->count; k++) photo_release(&s->photos[k]);
}

static void expect(const struct stack *s, int middle, int max_shift, const struct shift *wanted)
{
    const struct response srgb = {0};
    const struct brackets b = {s->photos, s->exposures, s->count, &srgb, NULL};
    struct alignment a;
    struct err err = ERR_INIT;
    assert_ok(align_brackets(&a, &b, middle, max_shift, &err), err);
    for (int k = 0; k < s->count; k++) {
        const int dx = wanted[k].dx - wanted[middle].dx, dy = wanted[k].dy - wanted[middle].dy;
        if (a.shifts[k].dx != dx || a.shifts[k].dy != dy)
            fail_msg("exposure %d: found %d, %d, wanted %d, %d", k, a.shifts[k].dx, a.shifts[k].dy, dx, dy);
        assert_true(a.found[k]);
    }
}

static void known_shifts_are_found(void **state)
{
    const struct shift shifts[][3] = {
        {{0, 0}, {0, 0}, {0, 0}}, {{1, 0}, {0, 0}, {0, -1}},      {{-7, 5}, {0, 0}, {13, 2}},
        {{3, 3}, {2, 1}, {1, 1}}, {{15, -15}, {0, 0}, {-15, 15}}, {{16, 0}, {0, 0}, {0, 16}},
    };
    (void)state;
    for (size_t n = 0; n < sizeof shifts / sizeof *shifts; n++)
        for (int noise = 0; noise <= 12; noise += 12) {
            struct stack s;
            shoot(&s, 3, 0.1, 4, shifts[n], noise);
            for (int threads = 1; threads <= 2; threads++) {
                parallel_set_threads(threads);
                expect(&s, 1, 16, shifts[n]);
            }
            parallel_set_threads(0);
            release(&s);
        }
}

/* Each of eight drifting exposures is compared with its neighbour; the sum may exceed max_shift. */
static void shifts_of_neighbours_add_up(void **state)
{
    struct shift shifts[8];
    struct stack s;
    (void)state;
    for (int k = 0; k < 8; k++) shifts[k] = (struct shift){3 * k, -2 * k};
    shoot(&s, 8, 0.01, 2, shifts, 4);
    expect(&s, 3, 4, shifts);
    release(&s);
}

static void exposures_without_contrast_are_not_shifted(void **state)
{
    const struct shift none[3] = {{0, 0}, {0, 0}, {0, 0}};
    const struct response srgb = {0};
    struct stack s;
    struct alignment a;
    struct err err = ERR_INIT;
    (void)state;
    shoot(&s, 3, 1e-9, 1e9, none, 0); /* black, white, white */
    const struct brackets b = {s.photos, s.exposures, 3, &srgb, NULL};
    assert_ok(align_brackets(&a, &b, 1, 16, &err), err);
    for (int k = 0; k < 3; k++) assert_true(!a.shifts[k].dx && !a.shifts[k].dy && a.found[k] == (k == 1));
    release(&s);
    shoot(&s, 2, 0.5, 4, none, 250); /* only noise: no shift */
    const struct brackets noise = {s.photos, s.exposures, 2, &srgb, NULL};
    assert_ok(align_brackets(&a, &noise, 0, 16, &err), err);
    assert_true(!a.shifts[1].dx && !a.shifts[1].dy);
    release(&s);
}

/* A shifted stack merges to the same radiance as an unshifted one, and without correction does not. */
static void merging_applies_the_shifts(void **state)
{
    const struct shift none[3] = {{0, 0}, {0, 0}, {0, 0}}, moved[3] = {{-7, 5}, {0, 0}, {13, 2}};
    const struct response srgb = {0};
    const struct merge_params params = MERGE_PARAMS_DEFAULT;
    struct noise noise[3];
    struct stack still, shaken;
    struct merged wanted = {0}, found = {0}, wrong = {0};
    struct err err = ERR_INIT;
    size_t differ = 0, differ_wrong = 0;
    (void)state;
    for (int k = 0; k < 3; k++) noise[k] = noise_given(params.electrons, params.read_noise, &srgb, 8);
    shoot(&still, 3, 0.1, 4, none, 0);
    shoot(&shaken, 3, 0.1, 4, moved, 0);
    const struct brackets a = {still.photos, still.exposures, 3, &srgb, NULL},
                          b = {shaken.photos, shaken.exposures, 3, &srgb, moved},
                          c = {shaken.photos, shaken.exposures, 3, &srgb, NULL};
    assert_ok(merge_brackets(&wanted, &a, noise, &params, &err), err);
    assert_ok(merge_brackets(&found, &b, noise, &params, &err), err);
    assert_ok(merge_brackets(&wrong, &c, noise, &params, &err), err);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const int at = y * WIDTH + x;
            for (int i = 0; i < 3; i++)
                assert_true(isfinite(found.radiance.data[3 * at + i]) && found.radiance.data[3 * at + i] >= 0);
            assert_true(found.variance[at] > 0 && found.variance[at] <= 1);
            if (x < 7 || x >= WIDTH - 13 || y < 0 || y >= HEIGHT - 5) continue; /* outside of some exposure */
            for (int i = 0; i < 3; i++) {
                differ += found.radiance.data[3 * at + i] != wanted.radiance.data[3 * at + i];
                differ_wrong += wrong.radiance.data[3 * at + i] != wanted.radiance.data[3 * at + i];
            }
        }
    assert_int_equal(differ, 0);
    assert_true(differ_wrong > WIDTH * HEIGHT / 2);
    merge_release(&wanted);
    merge_release(&found);
    merge_release(&wrong);
    release(&still);
    release(&shaken);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_shifts_are_found),
        cmocka_unit_test(shifts_of_neighbours_add_up),
        cmocka_unit_test(exposures_without_contrast_are_not_shifted),
        cmocka_unit_test(merging_applies_the_shifts),
    };
    return cmocka_run_group_tests_name("align", tests, NULL, NULL);
}
