/* soft_z.c - the soft z-buffer compared with hand-computed numbers, vector with scalar code, and merging of
 * fragments. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/rng.h"
#include "common/layers/layer_render.h"
#include "common/layers/soft_z.h"

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (double)(b)) <= (tolerance))

static void weights_follow_equation_3_1(void **state)
{
    (void)state;
    /* rho 10, gamma 1: 1 up to dz 1, 1/2 in the middle (5), 0 from 9 on */
    assert_near(soft_z_weight(0, 1, 10), 1, 0);
    assert_near(soft_z_weight(1, 1, 10), 1, 0);
    assert_near(soft_z_weight(3, 1, 10), 0.5 * (1 + sqrt(0.5)), 1e-6); /* cos(pi / 4) */
    assert_near(soft_z_weight(5, 1, 10), 0.5, 1e-6);
    assert_near(soft_z_weight(7, 1, 10), 0.5 * (1 - sqrt(0.5)), 1e-6);
    assert_near(soft_z_weight(9, 1, 10), 0, 1e-6);
    assert_near(soft_z_weight(9.01f, 1, 10), 0, 0);
    assert_near(soft_z_weight(0, 0, 0), 1, 0); /* width 0: only the nearest */
    assert_near(soft_z_weight(1e-6f, 0, 0), 0, 0);
}

static void the_width_combines_two_uncertainties(void **state)
{
    (void)state;
    const struct soft_z own = {3, 100}, thesis = {0, 100};
    /* 0.03 * 10 = 0.3 and 0.02 * 20 = 0.4 give 0.5; the weight is 1/2 at 3 times that */
    assert_near(soft_z_rho(&own, 10, 0.03f, 20, 0.02f), 3.0, 1e-5);
    assert_near(soft_z_rho(&thesis, 10, 0.03f, 20, 0.02f), 100, 0);
}

struct sample { /* of one view in a pixel */
    float rgba[4], z, sigma, blend;
};

/* Blends eight equal pixels and checks that the results are equal. */
static void blend(const struct soft_z *s, const struct sample *samples, int count, float rgba[4], float *z)
{
    struct soft_z_samples8 views[3];
    float colours[3][8][4], planes[3][4][8], out[8][4], out_z[8];

    for (int k = 0; k < count; k++) {
        const float one[4] = {samples[k].rgba[3], samples[k].z, samples[k].sigma, samples[k].blend};
        for (int n = 0; n < 8; n++) {
            memcpy(colours[k][n], samples[k].rgba, sizeof colours[k][n]);
            for (int p = 0; p < 4; p++) planes[k][p][n] = one[p];
        }
        views[k] = (struct soft_z_samples8){(const float(*)[4])colours[k], planes[k][0], planes[k][1], planes[k][2],
                                            planes[k][3]};
    }
    soft_z_blend8(s, views, count, out, out_z);
    for (int n = 1; n < 8; n++) {
        assert_memory_equal(out[n], out[0], sizeof out[0]);
        assert_true(out_z[n] == out_z[0]);
    }
    memcpy(rgba, out[0], sizeof out[0]);
    *z = out_z[0];
}

static void samples_are_blended_by_weight_alpha_and_depth(void **state)
{
    (void)state;
    const struct soft_z soft = {0, 10};
    float rgba[4], z;

    /* dz 5 is half of rho: w 1/2. Colour (0.6 * 1 * 1 + 0.4 * 0.5 * 0) / 0.8; depth without blend: (10 + 0.5 * 15) /
     * 1.5 */
    const struct sample two[] = {{{1, 0, 0, 1}, 10, 0.01f, 0.6f}, {{0, 1, 0, 1}, 15, 0.01f, 0.4f}};
    blend(&soft, two, 2, rgba, &z);
    assert_near(rgba[0], 0.75, 1e-6);
    assert_near(rgba[1], 0.25, 1e-6);
    assert_near(rgba[3], 1, 0);
    assert_near(z, 17.5 / 1.5, 1e-5);

    /* weighted by alpha, premultiplied: blends 1/2 and 1/2, alphas 1 and 0.6, one depth */
    const struct sample thin[] = {{{1, 0, 0, 1}, 10, 0.01f, 0.5f}, {{0, 0.6f, 0, 0.6f}, 10, 0.01f, 0.5f}};
    blend(&soft, thin, 2, rgba, &z);
    assert_near(rgba[0], 1 / 1.6, 1e-6);
    assert_near(rgba[1], 0.6 / 1.6, 1e-6);
    assert_near(z, 10, 1e-6);

    /* hidden: a sample far behind counts neither in colour nor in depth */
    const struct sample far[] = {{{1, 0, 0, 1}, 10, 0.01f, 0.1f}, {{0, 1, 0, 1}, 30, 0.01f, 0.9f}};
    blend(&soft, far, 2, rgba, &z);
    assert_near(rgba[0], 1, 1e-6);
    assert_near(z, 10, 1e-6);
}

static void with_a_width_inverse_depths_are_compared(void **state)
{
    (void)state;
    float rgba[4], z;

    /* 1/10 - 1/11 is k uncertainties: w 1/2 */
    const double u = hypot(0.01 / 10, 0.01 / 11), k = (1.0 / 10 - 1.0 / 11) / u;
    const struct soft_z soft = {(float)k, 1};
    const struct sample two[] = {{{1, 0, 0, 1}, 10, 0.01f, 0.6f}, {{0, 1, 0, 1}, 11, 0.01f, 0.4f}};
    blend(&soft, two, 2, rgba, &z);
    assert_near(rgba[0], 0.75, 1e-4);
    assert_near(z, (10 + 0.5 * 11) / 1.5, 1e-3);

    /* a pixel without a sample, whose z is 0, beside one with a sample */
    const struct sample none[] = {{{1, 0, 0, 1}, 10, 0.01f, 0.6f}, {{0, 0, 0, 0}, 0, 0, 0}};
    blend(&soft, none, 2, rgba, &z);
    assert_near(rgba[0], 1, 0);
    assert_near(z, 10, 1e-6);
}

static struct soft_z_fragment fragment(float red, float green, float blue, float alpha, float z);

static void a_far_unsure_surface_does_not_show_through(void **state)
{
    (void)state;
    const struct soft_z soft = {SOFT_Z_WIDTHS, 20};
    float rgba[4], z;
    /* 996 behind is 2 uncertainties in z, and 340 in 1/z */
    const struct sample two[] = {{{1, 0, 0, 1}, 4, 0.002f, 0.5f}, {{0, 1, 0, 1}, 1000, 0.5f, 0.5f}};
    blend(&soft, two, 2, rgba, &z);
    assert_near(rgba[0], 1, 1e-6);
    assert_near(z, 4, 1e-6);

    struct soft_z_fragment f[4];
    for (int i = 0; i < 4; i++) {
        f[i] = i % 2 ? fragment(0, 1, 0, 1, 1000) : fragment(1, 0, 0, 1, 4);
        f[i].sigma = i % 2 ? 0.5f : 0.002f;
        f[i].vote = i % 2 ? 0.3f : 1;
    }
    soft_z_merge(&soft, f, 4, rgba, &z);
    assert_near(rgba[0], 1, 1e-6);
    assert_near(z, 4, 1e-4);
}

static void a_view_enters_without_a_jump(void **state)
{
    (void)state;
    const struct soft_z soft = {3, 10};
    float rgba[4], z, before = 0;

    for (int i = 0; i <= 100; i++) { /* the nearer view's blending weight from 0 to 0.1 */
        const float part = 0.001f * (float)i;
        const struct sample s[] = {{{1, 0, 0, 1}, 5, 0.01f, part}, {{0, 1, 0, 1}, 8, 0.01f, 1 - part}};
        blend(&soft, s, 2, rgba, &z);
        if (i) assert_true(fabsf(rgba[0] - before) < 0.35f); /* the largest step is the last of hiding the far sample */
        if (i == 0) assert_near(rgba[0], 0, 0);
        if (i == 1) assert_true(rgba[0] < 0.01f && z > 7.9f);
        if (i >= 50) assert_near(rgba[0], 1, 1e-5);
        before = rgba[0];
    }
}

/* ---------------------------------------------------------------------------------------------- vector code */

static void vector_presences_equal_scalar_ones(void **state)
{
    (void)state;
    const struct rng rng = rng_make(1, "test", "presence");
    for (uint64_t i = 0; i < 200; i++) {
        float blend[8], alpha[8], p[8];
        for (uint64_t k = 0; k < 8; k++) {
            blend[k] = (float)(0.12 * rng_uniform(&rng, i, 2 * k));
            alpha[k] = k ? (float)(1.2 * rng_uniform(&rng, i, 2 * k + 1)) : 0;
        }
        f32x8_store(p, soft_z_presence8(f32x8_load(blend), f32x8_load(alpha)));
        for (int k = 0; k < 8; k++)
            assert_near(p[k], fminf(1, blend[k] / SOFT_Z_FULL_BLEND) * fminf(1, alpha[k] / SOFT_Z_FULL_ALPHA), 1e-5);
    }
}

static void vector_cosines_equal_scalar_ones(void **state)
{
    (void)state;
    for (int i = 0; i <= 10000; i++) {
        float fall[8];
        const float t = (float)i / 10000;
        f32x8_store(fall, soft_z_fall8(f32x8_all(t)));
        assert_near(fall[i % 8], 0.5 * (1 + cos(M_PI * (double)t)), 2e-6);
    }
}

static float known(float sigma) { return fmaxf(sigma, SOFT_Z_MIN_SIGMA); }

static void vector_weights_equal_scalar_ones(void **state)
{
    (void)state;
    static const struct soft_z softs[] = {{8, 5}, {0, 5}, {0.01f, 1}, {0, 0}, {100, 1e6f}};
    const struct rng rng = rng_make(2, "test", "behind");
    for (uint64_t i = 0; i < 4000; i++) {
        const struct soft_z *soft = &softs[i % 5];
        float z[8], sigma[8], unsure[8], z_c[8], sigma_c[8], unsure_c[8], p_c[8], w[8], weight[8];
        for (uint64_t k = 0; k < 8; k++) {
            const double scale = pow(10, 12 * rng_uniform(&rng, i, 8 * k) - 6);
            z[k] = (float)(scale * (1 + rng_uniform(&rng, i, 8 * k + 1)));
            z_c[k] = i % 7 == 0 ? z[k] : (float)(scale * (1 + rng_uniform(&rng, i, 8 * k + 2)));
            sigma[k] = i % 11 == 0 ? 0 : (float)(0.1 * rng_uniform(&rng, i, 8 * k + 3));
            sigma_c[k] = (float)(0.1 * rng_uniform(&rng, i, 8 * k + 4));
            unsure[k] = known(sigma[k]) * z[k];
            unsure_c[k] = known(sigma_c[k]) * z_c[k];
            p_c[k] = (float)rng_uniform(&rng, i, 8 * k + 5);
            w[k] = (float)rng_uniform(&rng, i, 8 * k + 6);
        }
        f32x8_store(weight, soft_z_behind8(soft, f32x8_load(w), f32x8_load(z), f32x8_load(unsure), f32x8_load(z_c),
                                           f32x8_load(unsure_c), f32x8_load(p_c)));
        for (int k = 0; k < 8; k++) {
            const float rho = soft_z_rho(soft, z[k], sigma[k], z_c[k], sigma_c[k]);
            const float hidden = p_c[k] * (1 - soft_z_weight(z[k] - z_c[k], 0.1f * rho, rho));
            assert_near(weight[k], fminf(w[k], 1 - hidden), 1e-5);
            assert_true(weight[k] >= 0);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- merging */

static struct soft_z_fragment fragment(float red, float green, float blue, float alpha, float z)
{
    return (struct soft_z_fragment){
        .rgba = {red * alpha, green * alpha, blue * alpha, alpha}, .z = z, .sigma = 0.01f, .blend = 1, .vote = 1};
}

static const struct soft_z narrow = {3, 10};

static void a_single_fragment_is_unchanged(void **state)
{
    (void)state;
    static const float alphas[] = {1, 0.5f, 0.03f, 1e-6f, 1e-20f};
    for (int i = 0; i < 5; i++) {
        struct soft_z_fragment f = fragment(0.25f, 0.5f, 4, alphas[i], 7);
        float rgba[4], z;
        f.blend = 1e-6f;
        f.vote = 0.05f;
        soft_z_merge(&narrow, &f, 1, rgba, &z);
        assert_near(rgba[0], 0.25, 1e-5);
        assert_near(rgba[1], 0.5, 1e-5);
        assert_near(rgba[2], 4, 1e-4);
        assert_near(rgba[3], 1, 0);
        assert_near(z, 7, 1e-5);
    }
}

static void agreeing_views_are_averaged_as_square_roots(void **state)
{
    (void)state;
    struct soft_z_fragment f[2] = {fragment(1, 0, 0.25f, 1, 6), fragment(0, 0.16f, 0.25f, 1, 6.02f)};
    float rgba[4], z;

    f[0].blend = 0.6f;
    f[1].blend = 0.4f;
    soft_z_merge(&narrow, f, 2, rgba, &z);
    assert_near(rgba[0], 0.36, 1e-6);
    assert_near(rgba[1], 0.4 * 0.4 * 0.16, 1e-6);
    assert_near(rgba[2], 0.25, 1e-6);
    assert_near(z, 6.01, 1e-5); /* without blending weights */
}

static void a_single_wrong_near_view_is_outvoted(void **state)
{
    (void)state;
    for (int wrong = 0; wrong < 8; wrong++) {
        struct soft_z_fragment f[8];
        float rgba[4], z;
        for (int i = 0; i < 8; i++) {
            f[i] = i == wrong ? fragment(1, 0, 0, 1, 3) : fragment(0, 0, 1, 1, 6);
            f[i].blend = 0.125f;
        }
        soft_z_merge(&narrow, f, 8, rgba, &z);
        /* supports (1 / 8)^2 and (7 / 7.3)^2: 1/400 of the square roots is red */
        assert_true(rgba[0] < 1e-5f && rgba[2] > 0.99f);
        assert_near(z, 6, 0.01);
        f[wrong].z = 9; /* behind, it is hidden completely */
        soft_z_merge(&narrow, f, 8, rgba, &z);
        assert_true(rgba[0] < 1e-5f && rgba[2] > 0.99f);
        assert_near(z, 6, 1e-5);
    }
}

static void votes_are_narrower_than_the_z_buffer(void **state)
{
    (void)state;
    const struct soft_z soft = {SOFT_Z_WIDTHS, 10};
    const double u = hypot(0.01 / 4, 0.01 / 5), dz = 1.0 / 4 - 1.0 / 5;
    const double rho = 2 * SOFT_Z_WIDTHS * u, vote_rho = 2 * 12 * u;
    const double w = (double)soft_z_weight((float)dz, (float)(0.1 * rho), (float)rho);
    const double agree = (double)soft_z_weight((float)dz, (float)(0.1 * vote_rho), (float)vote_rho);
    assert_true(w > 0.9 && agree < 0.3);
    /* two views each: against the near surface what is behind it, against the far one 0.3 of what is in front */
    const double near = pow((1 + agree) / 2, 2), far = pow((1 + agree) / (1 + agree + 0.3 * (1 - agree)), 2);
    const double part = near / (near + w * far);
    struct soft_z_fragment f[4];
    float rgba[4], z;

    for (int i = 0; i < 4; i++) f[i] = i % 2 ? fragment(0, 0, 1, 1, 5) : fragment(1, 0, 0, 1, 4);
    soft_z_merge(&soft, f, 4, rgba, &z);
    assert_near(rgba[0], part * part, 1e-5);
    assert_near(rgba[2], (1 - part) * (1 - part), 1e-5);
    assert_near(z, (part * agree * 4 + (1 - part) * 5) / (part * agree + 1 - part),
                1e-4); /* of the far one, it counts more */
}

static void what_covers_a_part_of_the_pixel_does_not_hide(void **state)
{
    (void)state;
    /* One view has a silhouette in the pixel, red in front of blue; the other has its own a pixel further, all blue.
     * Red has 0.6 for, and against it the 0.6 that it leaves too little. Blue of the second view has 1.4 for, 0.3 times
     * 0.6 against. */
    const double red = 0.6 * pow(0.5, 2), blue = 0.4, other = pow(1.4 / 1.58, 2), own = red + blue, sum = own + other;
    struct soft_z_fragment f[3] = {fragment(1, 0, 0, 0.6f, 3), fragment(0, 0, 1, 0.4f, 6), fragment(0, 0, 1, 1, 6)};
    float rgba[4], z;

    f[1].front_alpha = 0.6f;
    soft_z_merge(&narrow, f, 3, rgba, &z);
    assert_near(rgba[0], pow(own * sqrt(red / own) / sum, 2), 1e-5);
    assert_near(rgba[2], pow((own * sqrt(blue / own) + other) / sum, 2), 1e-5);
    assert_near(z, 6, 1e-5);
}

/* A silhouette through the pixel, in `views` views: `part` of it red and near, the rest blue and far. */
static void rim(struct soft_z_fragment *f, int views, float part)
{
    for (int i = 0; i < views; i++) {
        f[2 * i] = fragment(1, 0, 0, part, 3);
        f[2 * i + 1] = fragment(0, 0, 1, 1 - part, 6);
        f[2 * i + 1].front_alpha = part;
    }
}

static void a_silhouette_that_views_agree_on_keeps_its_coverage(void **state)
{
    (void)state;
    static const float parts[] = {0.5f, 0.1f, 0.25f, 0.75f, 0.99f};
    for (int views = 1; views <= 6; views++)
        for (int i = 0; i < 5; i++) {
            struct soft_z_fragment f[12];
            float rgba[4], z;
            rim(f, views, parts[i]);
            soft_z_merge(&narrow, f, 2 * views, rgba, &z);
            assert_near(rgba[0], parts[i], 1e-5);
            assert_near(rgba[1], 0, 0);
            assert_near(rgba[2], 1 - parts[i], 1e-5);
            assert_near(rgba[3], 1, 0);
            assert_true(z >= 3 && z <= 6);
        }
}

static void tiny_alphas_give_a_finite_opaque_pixel(void **state)
{
    (void)state;
    static const float alphas[] = {1e-3f, 1e-6f, 1e-12f, 1e-20f};
    for (int i = 0; i < 4; i++) {
        struct soft_z_fragment f[SOFT_Z_MAX_FRAGMENTS];
        float rgba[4], z;
        for (int k = 0; k < SOFT_Z_MAX_FRAGMENTS; k++) f[k] = fragment(0.5f, 0.25f, 0, alphas[i], 3 + (float)(k % 3));
        soft_z_merge(&narrow, f, SOFT_Z_MAX_FRAGMENTS, rgba, &z);
        assert_near(rgba[0], 0.5, 1e-4);
        assert_near(rgba[1], 0.25, 1e-4);
        assert_near(rgba[3], 1, 0);
        assert_true(z > 2.99f && z < 5.01f);
    }
}

static void the_order_of_views_does_not_matter(void **state)
{
    (void)state;
    struct soft_z_fragment f[6] = {fragment(1, 0, 0, 0.5f, 3),    fragment(0, 1, 0, 0.5f, 6),
                                   fragment(0, 0, 1, 1, 5.8f),    fragment(1, 1, 0, 1, 3.1f),
                                   fragment(0, 1, 1, 0.7f, 2.5f), fragment(1, 0, 1, 0.3f, 6.1f)};
    float rgba[4], z, other[4], other_z;

    f[1].front_alpha = 0.5f;
    f[5].front_alpha = 0.7f;
    soft_z_merge(&narrow, f, 6, rgba, &z);
    const struct soft_z_fragment turned[6] = {f[4], f[5], f[3], f[2], f[0], f[1]};
    soft_z_merge(&narrow, turned, 6, other, &other_z);
    for (int k = 0; k < 4; k++) assert_near(rgba[k], other[k], 1e-6);
    assert_near(z, other_z, 1e-5);
}

static void with_width_0_the_whole_depth_range_is_one_surface(void **state)
{
    (void)state;
    const struct soft_z thesis = {0, 100};
    const struct soft_z_fragment f[2] = {fragment(1, 0, 0, 1, 3), fragment(0, 0, 1, 1, 6)};
    float rgba[4], z;

    soft_z_merge(&thesis, f, 2, rgba, &z);
    assert_near(rgba[0], 0.25, 1e-6);
    assert_near(rgba[2], 0.25, 1e-6);
    assert_near(z, 4.5, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_follow_equation_3_1),
        cmocka_unit_test(the_width_combines_two_uncertainties),
        cmocka_unit_test(samples_are_blended_by_weight_alpha_and_depth),
        cmocka_unit_test(with_a_width_inverse_depths_are_compared),
        cmocka_unit_test(a_far_unsure_surface_does_not_show_through),
        cmocka_unit_test(a_view_enters_without_a_jump),
        cmocka_unit_test(vector_presences_equal_scalar_ones),
        cmocka_unit_test(vector_cosines_equal_scalar_ones),
        cmocka_unit_test(vector_weights_equal_scalar_ones),
        cmocka_unit_test(a_single_fragment_is_unchanged),
        cmocka_unit_test(agreeing_views_are_averaged_as_square_roots),
        cmocka_unit_test(a_single_wrong_near_view_is_outvoted),
        cmocka_unit_test(votes_are_narrower_than_the_z_buffer),
        cmocka_unit_test(what_covers_a_part_of_the_pixel_does_not_hide),
        cmocka_unit_test(a_silhouette_that_views_agree_on_keeps_its_coverage),
        cmocka_unit_test(tiny_alphas_give_a_finite_opaque_pixel),
        cmocka_unit_test(the_order_of_views_does_not_matter),
        cmocka_unit_test(with_width_0_the_whole_depth_range_is_one_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
