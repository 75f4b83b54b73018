/* revealed_error.c - what an edit reveals, and its error after one gain for each face. */
#include "stages/evaluate/render/revealed_error.h"

#include <math.h>
#include <string.h>

#include "common/image/image.h"
#include "tests/unit/scratch.h"

enum { N = 64 };

struct scene {
    uint32_t ids[2][N];
    float depths[2][N], found[3 * N], truth[4 * N];
    uint8_t mask[N];
};

/* Faces 1 and 2 before; after, face 2 is gone and shows 3 behind it. */
static void make(struct scene *s)
{
    for (int i = 0; i < N; i++) {
        s->ids[0][i] = i < 40 ? 1 : 2;
        s->ids[1][i] = i < 40 ? 1 : 3;
        s->depths[0][i] = i < 40 ? 3 : 2;
        s->depths[1][i] = i < 40 ? 3 : 4;
        for (int c = 0; c < 3; c++) {
            s->truth[4 * i + c] = 0.1F + 0.002F * (float)(i * (c + 1));
            s->found[3 * i + c] = s->truth[4 * i + c];
        }
        s->truth[4 * i + 3] = 1;
    }
}

static struct true_surface surface_of(const struct scene *s)
{
    return (struct true_surface){{s->ids[0], s->ids[1]}, {s->depths[0], s->depths[1]}};
}

static struct radiance_pixels pixels_of(const struct scene *s)
{
    return (struct radiance_pixels){s->found, s->truth, s->mask, N, 1, 1};
}

static void pixels_of_another_face_or_another_depth_are_revealed(void **state)
{
    struct scene s;
    (void)state;
    make(&s);
    s.depths[1][0] = 3.1F;  /* a face that moved */
    s.depths[1][1] = 3.01F; /* noise of the edge of a pixel */
    s.ids[1][63] = 0;       /* the outdoors */
    const struct true_surface surface = surface_of(&s);
    assert_int_equal(revealed_find(s.mask, &surface, N), 1 + 23);
    assert_int_equal(s.mask[0], 1);
    assert_int_equal(s.mask[1], 0);
    assert_int_equal(s.mask[40], 1);
    assert_int_equal(s.mask[63], 0);
}

static void a_gain_of_a_face_is_no_error(void **state)
{
    struct scene s;
    double psnr;
    (void)state;
    make(&s);
    memset(s.mask, 1, sizeof s.mask);
    for (int i = 0; i < 3 * N; i++) s.found[i] *= i < 3 * 40 ? 0.5F : 1.2F;
    const struct radiance_pixels p = pixels_of(&s);
    assert_true(revealed_psnr(&psnr, &p, s.ids[1]));
    assert_true(psnr > 90);
    /* but one gain for two faces is */
    uint32_t one[N] = {0};
    assert_true(revealed_psnr(&psnr, &p, one));
    assert_true(psnr < 30);
}

static void the_error_is_that_of_srgb(void **state)
{
    struct scene s;
    double psnr;
    (void)state;
    make(&s);
    memset(s.mask, 1, sizeof s.mask);
    for (int i = 0; i < N; i++)
        for (int c = 0; c < 3; c++) {
            s.truth[4 * i + c] = 0.5F;
            s.found[3 * i + c] = i % 2 ? 0.45F : 0.55F;
        }
    const struct radiance_pixels p = pixels_of(&s);
    assert_true(revealed_psnr(&psnr, &p, s.ids[1]));
    const double gain = 0.5 * (0.45 + 0.55) / (0.45 * 0.45 + 0.55 * 0.55);
    const double low = srgb_from_linear((float)(0.45 * gain)) - srgb_from_linear(0.5F);
    const double high = srgb_from_linear((float)(0.55 * gain)) - srgb_from_linear(0.5F);
    assert_true(fabs(psnr + 10 * log10((low * low + high * high) / 2)) < 0.01);
}

static void nothing_revealed_has_no_psnr(void **state)
{
    struct scene s;
    double psnr;
    (void)state;
    make(&s);
    memset(s.mask, 0, sizeof s.mask);
    const struct radiance_pixels p = pixels_of(&s);
    assert_false(revealed_psnr(&psnr, &p, s.ids[1]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_of_another_face_or_another_depth_are_revealed),
        cmocka_unit_test(a_gain_of_a_face_is_no_error),
        cmocka_unit_test(the_error_is_that_of_srgb),
        cmocka_unit_test(nothing_revealed_has_no_psnr),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
