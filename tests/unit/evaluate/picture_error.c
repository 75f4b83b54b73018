/* picture_error.c - a rendered picture with holes and borders against a photograph, computed by hand. */
#include "stages/evaluate/measure/picture_error.h"

#include <math.h>

#include "tests/unit/scratch.h"

enum { W = 20, H = 16 };

static uint8_t photo[W * H * 3], frame[W * H * 3], inside[W * H], hole[W * H];

/* Photo 100, without its first column; frame 110, with a black hole in the last two rows. */
static void make_pictures(void)
{
    memset(photo, 100, sizeof photo);
    memset(frame, 110, sizeof frame);
    memset(hole, 0, sizeof hole);
    for (int i = 0; i < W * H; i++) {
        inside[i] = i % W > 0;
        hole[i] = i / W >= H - 2;
        if (hole[i]) memset(frame + 3 * i, 0, 3);
        if (!inside[i]) memset(frame + 3 * i, 255, 3);
    }
}

static void holes_are_left_out_of_the_covered_metrics(void **state)
{
    struct picture_errors e;
    struct err err = ERR_INIT;
    (void)state;
    make_pictures();
    assert_ok(picture_errors(&e, photo, frame, inside, hole, W, H, &err), err);
    assert_true(fabs(e.holes - 2.0 / 16) < 1e-12);
    assert_true(fabs(e.psnr_covered - 20 * log10(255.0 / 10)) < 1e-12);
    assert_true(fabs(e.psnr - 10 * log10(255.0 * 255 / ((14 * 100.0 + 2 * 10000.0) / 16))) < 1e-12);
    /* SSIM of two flat greys is (2 a b + C1) / (a a + b b + C1); covered windows touch neither hole nor border */
    double c1 = 2.55 * 2.55;
    assert_true(e.has_covered && e.has_ssim && e.has_ssim_covered && e.ssim < e.ssim_covered);
    assert_true(fabs(e.ssim_covered - (22000 + c1) / (22100 + c1)) < 1e-9);

    memset(frame, 110, sizeof frame);
    memset(inside, 1, sizeof inside);
    memset(hole, 0, sizeof hole);
    assert_ok(picture_errors(&e, photo, frame, inside, hole, W, H, &err), err);
    assert_true(fabs(e.ssim - (22000 + c1) / (22100 + c1)) < 1e-9);
    assert_true(e.holes == 0 && e.ssim == e.ssim_covered && e.psnr == e.psnr_covered);
}

static void missing_metrics_are_flagged(void **state)
{
    struct picture_errors e;
    struct err err = ERR_INIT;
    (void)state;
    make_pictures();
    memset(hole, 1, sizeof hole); /* nothing is covered */
    assert_ok(picture_errors(&e, photo, frame, inside, hole, W, H, &err), err);
    assert_true(e.holes == 1 && e.has_ssim && !e.has_covered && !e.has_ssim_covered);
    memset(hole, 0, sizeof hole);
    assert_ok(picture_errors(&e, photo, frame, inside, hole, 8, 8, &err), err); /* smaller than SSIM's window */
    assert_true(!e.has_ssim && e.has_covered);
    memset(inside, 0, sizeof inside);
    assert_int_equal(picture_errors(&e, photo, frame, inside, hole, W, H, &err), ST_DATA);
    assert_err(err, ST_DATA, "not one pixel");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holes_are_left_out_of_the_covered_metrics),
        cmocka_unit_test(missing_metrics_are_flagged),
    };
    return cmocka_run_group_tests_name("picture_error", tests, NULL, NULL);
}
