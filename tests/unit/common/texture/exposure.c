/* exposure.c - the exposure that a camera would have chosen, and pictures of 8 bits. */
#include "common/texture/exposure.h"

#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/image/photo.h"

enum { SIDE = 100, PIXELS = SIDE * SIDE };

struct made {
    struct model_picture picture;
    float rgb[3 * PIXELS];
    uint8_t made[PIXELS];
};

/* Pixel i has the level (i + 1) / PIXELS in one of its colours, in a shuffled order, and less in the others. */
static struct made *make_ramp(void)
{
    struct made *m = calloc(1, sizeof *m);
    assert_non_null(m);
    m->picture = (struct model_picture){.width = SIDE, .height = SIDE, .rgb = m->rgb, .made = m->made};
    for (int i = 0; i < PIXELS; i++) {
        const int rank = (int)(((long)i * 7919) % PIXELS); /* 7919 is prime to PIXELS */
        m->rgb[3 * i] = m->rgb[3 * i + 1] = m->rgb[3 * i + 2] = 1e-6f;
        m->rgb[3 * i + rank % 3] = (float)(rank + 1) / PIXELS;
        m->made[i] = MADE_ORIGINAL;
    }
    return m;
}

static int count_white(const struct made *m, double exposure)
{
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        const float *p = m->rgb + 3 * i;
        count += m->made[i] != MADE_NOTHING && exposure * (double)fmaxf(p[0], fmaxf(p[1], p[2])) >= 1 - 1e-12;
    }
    return count;
}

static void the_wanted_share_of_pixels_saturates(void **state)
{
    (void)state;
    struct made *m = make_ramp();
    const double shares[] = {1, 0.5, 0.1, 0.01, 0.0001};
    for (size_t k = 0; k < sizeof shares / sizeof *shares; k++)
        assert_int_equal(count_white(m, exposure_choose(&m->picture, shares[k])), lround(shares[k] * PIXELS));
    assert_int_equal(count_white(m, exposure_choose(&m->picture, 0)), 1);
    free(m);
}

static void selection_agrees_with_sorting(void **state)
{
    (void)state;
    struct made *m = make_ramp();
    const struct rng rng = rng_make(3, "exposure", "levels");
    for (int i = 0; i < PIXELS; i++) /* from 2^-16 to 2^15, many of them equal */
        m->rgb[3 * i] = m->rgb[3 * i + 1] = m->rgb[3 * i + 2] = ldexpf(
            1 + (float)(rng_u32(&rng, (uint64_t)i, 0) % 64) / 64, (int)(rng_u32(&rng, (uint64_t)i, 1) % 32) - 16);
    for (int k = 1; k <= PIXELS; k += 997) {
        const double level = 1 / exposure_choose(&m->picture, (double)k / PIXELS);
        int above = 0, reach = 0;
        for (int i = 0; i < PIXELS; i++) {
            above += (double)m->rgb[3 * i] > level * (1 + 1e-12);
            reach += (double)m->rgb[3 * i] >= level * (1 - 1e-12);
        }
        assert_true(above < k && k <= reach); /* the k-th largest */
    }
    free(m);
}

static void pixels_that_show_nothing_do_not_count(void **state)
{
    (void)state;
    struct made *m = make_ramp();
    const double before = exposure_choose(&m->picture, 0.02);
    for (int i = 0; i < PIXELS; i++)
        if (m->rgb[3 * i] > 0.5f || m->rgb[3 * i + 1] > 0.5f || m->rgb[3 * i + 2] > 0.5f) m->made[i] = MADE_NOTHING;
    assert_true(fabs(exposure_choose(&m->picture, 0.02) / before - 0.98 / 0.49) <
                0.01); /* half of the levels are left */
    free(m);
}

static void a_picture_of_nothing_and_a_black_one_have_exposure_1(void **state)
{
    (void)state;
    struct made *m = make_ramp();
    memset(m->rgb, 0, sizeof m->rgb);
    assert_true(exposure_choose(&m->picture, 0.01) == 1);
    memset(m->made, MADE_NOTHING, sizeof m->made);
    assert_true(exposure_choose(&m->picture, 0.01) == 1);
    assert_true(exposure_choose(&(struct model_picture){0}, 0.01) == 1);
    free(m);
}

static void a_picture_is_written_by_its_name_and_white_is_where_the_exposure_says(void **state)
{
    (void)state;
    struct made *m = make_ramp();
    struct err err = ERR_INIT;
    struct photo png = {0}, jpeg = {0};
    for (int i = 0; i < 3 * PIXELS; i++) m->rgb[i] = i < 3 * PIXELS / 2 ? 4 : 2 * linear_from_srgb(100 / 255.f);
    for (int i = 0; i < SIDE; i++) m->made[i] = MADE_NOTHING;
    assert_ok(exposure_write(&m->picture, 0.5, scratch_path("a.png"), &err), err);
    assert_ok(exposure_write(&m->picture, 0.5, scratch_path("a.jpg"), &err), err);
    assert_ok(photo_read(&png, scratch_path("a.png"), &err), err);
    assert_ok(photo_read(&jpeg, scratch_path("a.jpg"), &err), err);
    const struct photo *both[] = {&png, &jpeg};
    for (int k = 0; k < 2; k++) {
        struct image linear = {0};
        assert_ok(photo_to_linear(&linear, both[k], &err), err);
        assert_int_equal(linear.width, SIDE);
        assert_true(fabsf(srgb_from_linear(*image_at(&linear, 50, 30)) - 1) < 0.004f);
        assert_true(fabsf(srgb_from_linear(*image_at(&linear, 50, 80)) * 255 - 100) < 1.01f);
        assert_true(k || *image_at(&linear, 50, 0) == 0); /* shows nothing */
        image_release(&linear);
    }
    exposure_write(&m->picture, 1, scratch_path("a.gif"), &err);
    assert_err(err, ST_USAGE, "a.gif");
    photo_release(&png);
    photo_release(&jpeg);
    free(m);
}

static void an_exposure_is_kept_while_the_room_is_seen_and_follows_where_it_is_not(void **state)
{
    (void)state;
    assert_true(exposure_follow(1.7, 0.2, 0.2) == 1.7);
    assert_true(fabs(exposure_follow(2, 0.1, 0.04) - 2) < 1e-12);             /* 0.08 of white */
    assert_true(fabs(exposure_follow(2, 0.1, 0.005) - 10) < 1e-12);           /* brought to EXPOSURE_DIM */
    assert_true(fabs(exposure_follow(1, 0.02, 0.01) - 2) < 1e-12);            /* a dark room stays as dark as it was */
    assert_true(fabs(exposure_follow(1, 0.3, 1.2) - 0.5) < 1e-12);            /* EXPOSURE_BRIGHT */
    assert_true(fabs(exposure_follow(1, 0.3, 1e-9) - EXPOSURE_MOST) < 1e-12); /* all but dark */
    assert_true(exposure_follow(3, 0.3, 0) == 3 && exposure_follow(3, 0, 0) == 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_wanted_share_of_pixels_saturates),
        cmocka_unit_test(selection_agrees_with_sorting),
        cmocka_unit_test(pixels_that_show_nothing_do_not_count),
        cmocka_unit_test(a_picture_of_nothing_and_a_black_one_have_exposure_1),
        cmocka_unit_test(a_picture_is_written_by_its_name_and_white_is_where_the_exposure_says),
        cmocka_unit_test(an_exposure_is_kept_while_the_room_is_seen_and_follows_where_it_is_not),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
