/* relit_error.c - where light changes, PSNR of relit pictures, errors of quotients of light. */
#include "stages/evaluate/light/relit_error.h"

#include <math.h>
#include <string.h>

#include "common/image/image.h"
#include "stages/evaluate/render/revealed_error.h"
#include "tests/unit/scratch.h"

enum { N = 6 };

static void fill(float *rgb, const double *levels)
{
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++) rgb[3 * i + c] = (float)levels[i];
}

static void surfaces_that_stay_are_kept(void **state)
{
    const uint32_t before[N] = {1, 1, 1, 0, 2, 2}, after[N] = {1, 1, 3, 1, 0, 2};
    const float near[N] = {2, 2, 2, 0, 2, 0}, far[N] = {2, 2.2F, 2, 2, 0, 0};
    const struct true_surface s = {{before, after}, {near, far}};
    uint8_t mask[N];
    (void)state;
    revealed_kept_find(mask, &s, N);
    assert_memory_equal(mask, ((uint8_t[]){1, 0, 0, 0, 0, 1}), N); /* moved, another face, the outdoors twice */
}

static void light_changes_by_more_than_a_twentieth(void **state)
{
    float before[3 * N], after[3 * N];
    uint8_t mask[N] = {1, 1, 1, 1, 1, 0};
    (void)state;
    fill(before, (const double[]){1, 1, 1, 0, 1, 1});
    fill(after, (const double[]){1.04, 1.06, 0.94, 1, 0, 2});
    relit_changes_keep(mask, before, after, N);
    assert_memory_equal(mask, ((uint8_t[]){0, 1, 1, 0, 0, 0}), N);
}

static void psnr_is_that_of_srgb_over_all_that_was_added(void **state)
{
    float found[3 * N], truth[4 * N];
    uint8_t mask[N] = {1, 1, 1, 1, 0, 1};
    struct encoded_error e = {0};
    double psnr;
    (void)state;
    fill(found, (const double[]){0.25, 0.25, 4, 0.1, 0.1, 0.1});
    for (int i = 0; i < N; i++) {
        for (int c = 0; c < 3; c++) truth[4 * i + c] = i < 2 ? 0.4F : i == 2 ? 9 : 0.2F;
        truth[4 * i + 3] = i < 5;
    }
    const struct radiance_pixels p = {found, truth, mask, N, 2, 2}; /* found is 0.25, white; truth 0.2, white, 0.1 */
    assert_false(relit_encoded_error_psnr(&e, &psnr));
    relit_encoded_error_add(&e, &p);
    relit_encoded_error_add(&e, &p);
    assert_int_equal(e.samples, 2 * 4 * 3);
    const double d = (double)srgb_from_linear(0.25F) - (double)srgb_from_linear(0.2F);
    assert_true(relit_encoded_error_psnr(&e, &psnr));
    assert_true(fabs(psnr + 10 * log10(d * d / 2)) < 1e-4);
}

static void equal_pictures_have_100_db(void **state)
{
    float found[3 * N], truth[4 * N];
    struct encoded_error e = {0};
    double psnr;
    (void)state;
    for (int i = 0; i < 3 * N; i++) found[i] = 0.5F;
    for (int i = 0; i < 4 * N; i++) truth[i] = i % 4 < 3 ? 0.5F : 1;
    const struct radiance_pixels p = {found, truth, NULL, N, 1, 1};
    relit_encoded_error_add(&e, &p);
    assert_true(relit_encoded_error_psnr(&e, &psnr));
    assert_true(fabs(psnr - 100) < 1e-9);
}

static void the_true_change_is_applied_by_channel(void **state)
{
    float before[3 * N], after[3 * N], picture[3 * N];
    const uint8_t mask[N] = {1, 1, 0, 1, 1, 1};
    (void)state;
    fill(before, (const double[]){1, 2, 1, 1, 1, 1});
    fill(after, (const double[]){3, 1, 3, 1, 1, 1});
    fill(picture, (const double[]){0.5, 0.5, 0.5, 0.5, 0.5, 0.5});
    after[1] = 6;
    before[3 * 3 + 2] = 0; /* blue light that is new: the quotient of luminances, 1 / (1 - 0.0722) */
    relit_change_apply(picture, before, after, mask, N);
    const float wanted[] = {1.5F, 3, 1.5F, 0.25F, 0.25F, 0.25F, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F / (1 - 0.0722F)};
    for (int i = 0; i < 12; i++) assert_true(fabsf(picture[i] - wanted[i]) < 1e-4F);
}

static void a_quotient_is_judged_by_the_luminance_that_it_makes(void **state)
{
    float before[3 * N], after[3 * N], quotient[3 * N];
    const uint8_t mask[N] = {1, 1, 0, 0, 0, 0};
    struct quantiles errors;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(quantiles_init(&errors, &err), err);
    fill(before, (const double[]){2, 2, 2, 2, 2, 2});
    fill(after, (const double[]){3, 3, 3, 3, 3, 3});
    fill(quotient, (const double[]){1.5, 1.5, 9, 9, 9, 9});
    quotient[3] = 2.5F; /* red too high by 1, of 0.2126 of the luminance: 0.2126 x 2 / 3 */
    relit_quotient_errors_add(&errors, quotient, before, after, mask, N);
    assert_int_equal(errors.count, 2);
    assert_true(quantiles_get(&errors, 0) < 1e-6);
    assert_true(fabs(quantiles_get(&errors, 1) - 0.2126 * 2 / 3) < 2e-4);
    quantiles_release(&errors);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_that_stay_are_kept),
        cmocka_unit_test(light_changes_by_more_than_a_twentieth),
        cmocka_unit_test(psnr_is_that_of_srgb_over_all_that_was_added),
        cmocka_unit_test(equal_pictures_have_100_db),
        cmocka_unit_test(the_true_change_is_applied_by_channel),
        cmocka_unit_test(a_quotient_is_judged_by_the_luminance_that_it_makes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
