/* metrics.c - PSNR and SSIM against closed forms, and against a direct sum over each window. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "stages/evaluate/measure/metrics.h"

#define W 37
#define H 71 /* three chunks of rows */

static uint8_t a[W * H * 3], b[W * H * 3];

static void fill_noise(void)
{
    uint32_t s = 1;
    for (int i = 0; i < W * H * 3; i++) {
        s = s * 1664525 + 1013904223;
        a[i] = (uint8_t)(s >> 24);
        b[i] = (uint8_t)(a[i] / 2 + (s >> 17 & 63));
    }
}

static void psnr_matches_its_closed_form(void **state)
{
    struct err err = ERR_INIT;
    uint8_t mask[W * H] = {0};
    double db = 0;
    (void)state;
    memset(a, 100, sizeof a);
    memset(b, 105, sizeof b);
    assert_ok(metrics_psnr(a, b, W, H, NULL, &db, &err), err);
    assert_true(fabs(db - 20 * log10(255.0 / 5)) < 1e-12);
    assert_ok(metrics_psnr(a, a, W, H, NULL, &db, &err), err);
    assert_true(db == 99);

    /* one pixel differs by 1, 2, 2: its mean square is 3 */
    memcpy(b, a, sizeof b);
    b[3 * 50] = 101, b[3 * 50 + 1] = 98, b[3 * 50 + 2] = 102;
    mask[50] = 1;
    assert_ok(metrics_psnr(a, b, W, H, mask, &db, &err), err);
    assert_true(fabs(db - 10 * log10(255.0 * 255 / 3)) < 1e-12);
    mask[50] = 0, mask[51] = 255;
    assert_ok(metrics_psnr(a, b, W, H, mask, &db, &err), err);
    assert_true(db == 99);
    mask[51] = 0;
    assert_int_equal(metrics_psnr(a, b, W, H, mask, &db, &err), ST_DATA);
    assert_err(err, ST_DATA, "not one pixel");
}

static void ssim_of_equal_pictures_is_one(void **state)
{
    struct err err = ERR_INIT;
    double ssim = 0;
    (void)state;
    fill_noise();
    assert_ok(metrics_ssim(a, a, W, H, NULL, &ssim, &err), err);
    assert_true(fabs(ssim - 1) < 1e-12);
}

static void ssim_of_flat_pictures_matches_its_closed_form(void **state)
{
    struct err err = ERR_INIT;
    double ssim = 0, c1 = 2.55 * 2.55;
    (void)state;
    memset(a, 60, sizeof a);
    memset(b, 200, sizeof b);
    assert_ok(metrics_ssim(a, b, W, H, NULL, &ssim, &err), err);
    assert_true(fabs(ssim - (2 * 60.0 * 200 + c1) / (60.0 * 60 + 200.0 * 200 + c1)) < 1e-9);
    memset(b, 0, sizeof b);
    assert_ok(metrics_ssim(b, b, W, H, NULL, &ssim, &err), err); /* 0 / 0 without the constants */
    assert_true(fabs(ssim - 1) < 1e-12);
}

/* SSIM of the window at (x, y) from the definitions in [Wang 2004], in two dimensions. */
static double window_directly(int x, int y, int c)
{
    double weight = 0, ma = 0, mb = 0, saa = 0, sbb = 0, sab = 0, c1 = 2.55 * 2.55, c2 = 7.65 * 7.65;
    for (int pass = 0; pass < 3; pass++) { /* weights, means, moments about the means */
        for (int j = -5; j <= 5; j++) {
            for (int i = -5; i <= 5; i++) {
                double w = exp(-(i * i + j * j) / 4.5);
                double va = a[((y + j) * W + x + i) * 3 + c], vb = b[((y + j) * W + x + i) * 3 + c];
                if (pass == 0) {
                    weight += w;
                } else if (pass == 1) {
                    ma += w / weight * va;
                    mb += w / weight * vb;
                } else {
                    saa += w / weight * (va - ma) * (va - ma);
                    sbb += w / weight * (vb - mb) * (vb - mb);
                    sab += w / weight * (va - ma) * (vb - mb);
                }
            }
        }
    }
    return (2 * ma * mb + c1) * (2 * sab + c2) / ((ma * ma + mb * mb + c1) * (saa + sbb + c2));
}

static void ssim_matches_a_direct_sum_per_window(void **state)
{
    struct err err = ERR_INIT;
    uint8_t mask[W * H] = {0};
    double all = 0, ssim = 0;
    (void)state;
    fill_noise();
    for (int y = 5; y < H - 5; y++) {
        for (int x = 5; x < W - 5; x++) {
            double one = 0;
            for (int c = 0; c < 3; c++) one += window_directly(x, y, c) / 3;
            all += one;
            if ((x + y) % 13) continue;
            mask[y * W + x] = 7;
            assert_ok(metrics_ssim(a, b, W, H, mask, &ssim, &err), err);
            assert_true(fabs(ssim - one) < 1e-12);
            mask[y * W + x] = 0;
        }
    }
    assert_ok(metrics_ssim(a, b, W, H, NULL, &ssim, &err), err);
    assert_true(fabs(ssim - all / ((W - 10) * (H - 10))) < 1e-12);
    mask[0] = 1; /* no window has its centre in the corner */
    assert_int_equal(metrics_ssim(a, b, W, H, mask, &ssim, &err), ST_DATA);
    assert_err(err, ST_DATA, "not one window");
}

static void a_picture_of_one_window_has_an_ssim(void **state)
{
    static uint8_t small_a[11 * 11 * 3], small_b[11 * 11 * 3];
    struct err err = ERR_INIT;
    double ssim = 0, one = 0;
    (void)state;
    fill_noise();
    for (int y = 0; y < 11; y++) {
        memcpy(small_a + y * 33, a + y * W * 3, 33);
        memcpy(small_b + y * 33, b + y * W * 3, 33);
    }
    for (int c = 0; c < 3; c++) one += window_directly(5, 5, c) / 3;
    assert_ok(metrics_ssim(small_a, small_b, 11, 11, NULL, &ssim, &err), err);
    assert_true(fabs(ssim - one) < 1e-12);
    assert_int_equal(metrics_ssim(small_a, small_b, 10, 12, NULL, &ssim, &err), ST_DATA);
    assert_err(err, ST_DATA, "10 x 12");
}

static void ssim_is_the_same_for_any_threads(void **state)
{
    struct err err = ERR_INIT;
    double one = 0, more = 0;
    (void)state;
    fill_noise();
    parallel_set_threads(1);
    assert_ok(metrics_ssim(a, b, W, H, NULL, &one, &err), err);
    for (int threads = 2; threads < 6; threads++) {
        parallel_set_threads(threads);
        assert_ok(metrics_ssim(a, b, W, H, NULL, &more, &err), err);
        assert_memory_equal(&one, &more, sizeof one);
    }
    parallel_set_threads(0);
}

/* Compared with a test of every pixel of every window; some masks reach all borders. */
static void windows_lie_wholly_in_the_mask(void **state)
{
    uint8_t mask[W * H], windows[W * H];
    uint32_t s = 5;
    (void)state;
    for (int density = 0; density < 4; density++) {
        int found = 0;
        for (int i = 0; i < W * H; i++) {
            s = s * 1664525 + 1013904223;
            mask[i] = density == 0 || (s >> 16) % 400 >= (uint32_t)density;
        }
        metrics_ssim_windows(windows, mask, W, H);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                bool whole = x >= 5 && y >= 5 && x < W - 5 && y < H - 5;
                for (int k = 0; k < 121 && whole; k++) whole = mask[(y + k / 11 - 5) * W + x + k % 11 - 5];
                assert_int_equal(windows[y * W + x], whole);
                found += whole;
            }
        assert_true(found > 0);
        if (density == 0) assert_int_equal(found, (W - 10) * (H - 10));
    }
    metrics_ssim_windows(windows, mask, 7, 7); /* smaller than a window */
    for (int i = 0; i < 49; i++) assert_int_equal(windows[i], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(psnr_matches_its_closed_form),
        cmocka_unit_test(ssim_of_equal_pictures_is_one),
        cmocka_unit_test(ssim_of_flat_pictures_matches_its_closed_form),
        cmocka_unit_test(ssim_matches_a_direct_sum_per_window),
        cmocka_unit_test(a_picture_of_one_window_has_an_ssim),
        cmocka_unit_test(ssim_is_the_same_for_any_threads),
        cmocka_unit_test(windows_lie_wholly_in_the_mask),
    };
    return cmocka_run_group_tests_name("metrics", tests, NULL, NULL);
}
