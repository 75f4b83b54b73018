/* sky_patches.c - Tregenza's and Reinhart's patches of the sky. */
#include "common/daylight/sky_patches.h"

#include "tests/unit/scratch.h"

#include "common/math/numbers.h"

static struct sky_patches made(int subdivision, double north)
{
    struct sky_patches s;
    struct err err = ERR_INIT;
    assert_int_equal(sky_patches_init(&s, subdivision, north, &err), ST_OK);
    return s;
}

static double distance(struct vec3 a, struct vec3 b) { return vec3_length(vec3_sub(a, b)); }

static void counts_are_those_of_tregenza_and_reinhart(void **state)
{
    (void)state;
    assert_int_equal(made(1, 0).count, 146);
    assert_int_equal(made(2, 0).count, 578);
    assert_int_equal(made(4, 0).count, 2306);
}

/* [Tregenza 1987], table 1, to the digits that it prints */
static void solid_angles_are_the_published_ones(void **state)
{
    static const double published[8] = {0.0435, 0.0416, 0.0474, 0.0407, 0.0429, 0.0445, 0.0455, 0.0344};
    static const int first[8] = {1, 31, 61, 85, 109, 127, 139, 145};
    const struct sky_patches s = made(1, 0);
    (void)state;
    for (int row = 0; row < 8; row++) {
        assert_int_equal(s.first[row], first[row]);
        assert_true(fabs(sky_patch_solid_angle(&s, first[row]) - published[row]) < 0.00006);
    }
}

static void the_sky_is_2_pi_and_lights_a_plane_by_pi(void **state)
{
    (void)state;
    for (int m = 1; m <= SKY_SUBDIVISION_MAX; m++) {
        const struct sky_patches s = made(m, 33);
        double angle = 0, projected = 0;
        for (int p = 1; p < s.count; p++) {
            angle += sky_patch_solid_angle(&s, p);
            projected += sky_patch_projected(&s, p);
        }
        assert_true(fabs(angle - 2 * PI) < 1e-12);
        assert_true(fabs(projected - PI) < 1e-12);
    }
}

static void a_patch_is_found_at_its_centre_and_everywhere_within(void **state)
{
    (void)state;
    for (int m = 1; m <= 4; m *= 2)
        for (int north = -90; north <= 450; north += 77) {
            const struct sky_patches s = made(m, north);
            for (int p = 0; p < s.count; p++) {
                assert_int_equal(sky_patch_at(&s, sky_patch_direction(&s, p)), p);
                for (int k = 0; k < 4; k++) {
                    const struct vec3 d = sky_patch_point(&s, p, k % 2 ? 0.999 : 0.001, k / 2 ? 0.999 : 0.001);
                    assert_true(fabs(vec3_length(d) - 1) < 1e-12);
                    assert_int_equal(sky_patch_at(&s, d), p);
                }
            }
        }
}

static void points_of_a_patch_have_its_mean_sine(void **state)
{
    const struct sky_patches s = made(2, 10);
    (void)state;
    for (int p = 1; p < s.count; p += 29) {
        double sum = 0;
        for (int k = 0; k < 100; k++) sum += sky_patch_point(&s, p, 0.5, (k + 0.5) / 100).z;
        assert_true(fabs(sum / 100 * sky_patch_solid_angle(&s, p) - sky_patch_projected(&s, p)) < 1e-12);
    }
}

static void the_first_patch_of_a_row_is_north_and_east_follows(void **state)
{
    /* north lies along y, so that east is x */
    const struct sky_patches s = made(1, 90);
    const double c = cos(6 * DEGREE), z = sin(6 * DEGREE);
    (void)state;
    assert_true(distance(sky_patch_direction(&s, 1), vec3_make(0, c, z)) < 1e-12);
    assert_true(distance(sky_patch_direction(&s, 2), vec3_make(c * sin(12 * DEGREE), c * cos(12 * DEGREE), z)) < 1e-12);
    assert_true(distance(sky_patch_direction(&s, 145), vec3_make(0, 0, 1)) < 1e-12);
    assert_int_equal(sky_patch_at(&s, vec3_make(-1, 0, 0)), 1 + 22 + 1); /* west: 22.5 patches of 12 degrees, to east */
    assert_int_equal(sky_patch_at(&s, vec3_make(0, 0, -1)), SKY_GROUND);
    assert_int_equal(sky_patch_at(&s, vec3_make(0, 1, 0)), 1);
    assert_int_equal(sky_patch_at(&s, vec3_make(0, 0, 1)), 145);
}

static void a_compass_turns_from_north_to_east(void **state)
{
    (void)state;
    assert_true(distance(sky_compass_direction(90, 90, 0), vec3_make(1, 0, 0)) < 1e-12);
    assert_true(distance(sky_compass_direction(0, 90, 0), vec3_make(0, -1, 0)) < 1e-12);
    assert_true(distance(sky_compass_direction(0, 180, 30), vec3_make(-sqrt(0.75), 0, 0.5)) < 1e-12);
}

static void a_subdivision_out_of_range_is_refused(void **state)
{
    struct sky_patches s;
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(sky_patches_init(&s, 0, 0, &err), ST_USAGE);
    assert_string_equal(err.text, "a subdivision of the sky of 0: wanted 1 to 8.");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_are_those_of_tregenza_and_reinhart),
        cmocka_unit_test(solid_angles_are_the_published_ones),
        cmocka_unit_test(the_sky_is_2_pi_and_lights_a_plane_by_pi),
        cmocka_unit_test(a_patch_is_found_at_its_centre_and_everywhere_within),
        cmocka_unit_test(points_of_a_patch_have_its_mean_sine),
        cmocka_unit_test(the_first_patch_of_a_row_is_north_and_east_follows),
        cmocka_unit_test(a_compass_turns_from_north_to_east),
        cmocka_unit_test(a_subdivision_out_of_range_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
