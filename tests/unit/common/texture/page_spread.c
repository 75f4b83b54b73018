/* page_spread.c - missing texels take the nearest one of their tile, and no other tile's. */
#include "common/texture/page_spread.h"

#include "common/texture/radiance_median.h"
#include "tests/unit/scratch.h"

static void missing_texels_take_the_nearest_one(void **state)
{
    const struct atlas_tile tile = {.face = 1, .x = 1, .y = 1, .width = 5, .height = 2};
    struct atlas_page page = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(atlas_page_init(&page, 7, 4, &err), err);
    page.source[7 + 1] = ATLAS_VIEWS;
    page.rgb[3 * (7 + 1)] = 1;
    page.source[7 + 5] = ATLAS_SYNTHESISED;
    page.rgb[3 * (7 + 5)] = 2;
    assert_ok(page_spread(&page, &tile, &err), err);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 7; x++) {
            const bool inside = x >= 1 && x < 6 && y >= 1 && y < 3;
            const float red = page.rgb[3 * (7 * y + x)];
            if (x == 3 && inside) continue; /* as far from both */
            assert_float_equal(red, !inside ? 0 : x < 3 ? 1 : 2, 0);
        }
    assert_int_equal(page.source[7 + 2], ATLAS_NONE); /* what texels come from stays */
    atlas_page_release(&page);
}

static void a_new_surface_has_its_share_of_the_median_light(void **state)
{
    static const uint16_t halves[3][3] = {
        {0x3c00, 0x3800, 0}, {0x4000, 0x3800, 0}, {0x7bff, 0x3800, 0}}; /* 1 2 65504 */
    const float albedo[3] = {0.3f, 0.6f, 0.9f};
    struct radiance_median r;
    struct err err = ERR_INIT;
    float colour[3];
    (void)state;
    assert_ok(radiance_median_init(&r, &err), err);
    radiance_median_colour(colour, &r, albedo);
    assert_float_equal(colour[0], 0, 0); /* nothing is known */
    for (int i = 0; i < 3; i++) radiance_median_add(&r, halves[i]);
    radiance_median_colour(colour, &r, albedo);
    assert_float_equal(colour[0], 0.5f * 2, 1e-6f); /* a wall of albedo 0.6 sends out the median, 2 */
    assert_float_equal(colour[1], 0.5f, 1e-6f);
    assert_float_equal(colour[2], 0, 0);
    radiance_median_release(&r);
}

static void the_light_is_that_of_named_faces(void **state)
{
    int lit[] = {3, 5};
    const struct texture_rule all = {.lit_count = 0}, some = {.lit = lit, .lit_count = 2};
    (void)state;
    assert_true(radiance_median_wants(&all, 4));
    assert_true(radiance_median_wants(&some, 5));
    assert_false(radiance_median_wants(&some, 4));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_texels_take_the_nearest_one),
        cmocka_unit_test(a_new_surface_has_its_share_of_the_median_light),
        cmocka_unit_test(the_light_is_that_of_named_faces),
    };
    return cmocka_run_group_tests_name("page_spread", tests, NULL, NULL);
}
