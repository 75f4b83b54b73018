/* outdoors_guess.c - what no picture shows: sky, ground, what is solid, and the sun's disk. */
#include "stages/bake_outdoors/outdoors_guess.h"

#include "tests/unit/scratch.h"

#include "common/base/parallel.h"
#include "common/image/luminance.h"
#include "common/math/numbers.h"
#include "stages/bake_outdoors/outdoors_sun.h"

static struct vec3 from_angles(double azimuth, double elevation)
{
    const double a = azimuth * DEGREE, e = elevation * DEGREE;
    return vec3_make(cos(e) * cos(a), cos(e) * sin(a), sin(e));
}

static struct sky_fit guess(struct outdoors *o, const struct vec3 *to_sun)
{
    struct sky_fit sky;
    struct err err = ERR_INIT;
    assert_ok(outdoors_guess(o, to_sun, &sky, &err), err);
    return sky;
}

static size_t pixel_at(const struct outdoors *o, double azimuth, double elevation)
{
    const int x = (int)((azimuth + 180) / 360 * o->width), y = (int)((90 - elevation) / 180 * o->height);
    return (size_t)y * (size_t)o->width + (size_t)x;
}

static double luminance_at(const struct outdoors *o, double azimuth, double elevation)
{
    return (double)luminance_of(o->rgb + 3 * pixel_at(o, azimuth, elevation));
}

/* A sky of 3, ground of 0.5; known: columns from `first` to `last` of rows from `top` to `bottom`. */
static void make_known(struct outdoors *o, int first, int last, int top, int bottom)
{
    struct err err = ERR_INIT;
    assert_ok(outdoors_init(o, 64, &err), err);
    for (int y = top; y < bottom; y++)
        for (int x = first; x < last; x++) {
            const size_t at = (size_t)y * (size_t)o->width + (size_t)x;
            o->source[at] = OUTDOORS_PHOTO;
            for (size_t c = 0; c < 3; c++) o->rgb[3 * at + c] = y < 32 ? 3 : 0.5f;
        }
    guess(o, NULL);
}

static void guesses_are_sky_above_the_horizon_and_ground_below(void **state)
{
    (void)state;
    struct outdoors o = {0};
    make_known(&o, 10, 50, 25, 40);
    for (int i = 0; i < o.width * o.height; i++)
        assert_true(fabsf(o.rgb[3 * i] / (i / o.width < 32 ? 3 : 0.5f) - 1) < 1e-4f);
    outdoors_release(&o);
}

static void a_side_of_the_horizon_that_nothing_shows_takes_the_other_side(void **state)
{
    (void)state;
    struct outdoors o = {0};
    make_known(&o, 120, 128, 10, 20);
    for (int i = 0; i < o.width * o.height; i++) assert_true(fabsf(o.rgb[3 * i] / 3 - 1) < 1e-4f);
    outdoors_release(&o);
}

static void guesses_join_what_is_known_across_azimuth_pi(void **state)
{
    (void)state;
    struct outdoors o = {0};
    struct err err = ERR_INIT;
    assert_ok(outdoors_init(&o, 64, &err), err);
    for (int y = 20; y < 30; y++)
        for (int x = 0; x < 100; x++) { /* bright in the first columns, dark in the last ones */
            const size_t at = (size_t)y * (size_t)o.width + (size_t)x;
            o.source[at] = OUTDOORS_PHOTO;
            for (size_t c = 0; c < 3; c++) o.rgb[3 * at + c] = x < 50 ? 4 : 1;
        }
    guess(&o, NULL);
    const float *row = o.rgb + 3 * (size_t)25 * (size_t)o.width;
    assert_true(row[3 * 127] > 2.5f && row[3 * 101] < 1.6f); /* the column before 0 is like column 0 */
    for (int x = 100; x < 128; x++) assert_true(row[3 * x] > 0.9f && row[3 * x] < 4.4f);
    outdoors_release(&o);
}

/* -------------------------------------------------------------------------------------------------- a standard sky */

/* What two windows show: azimuths from -40 to 40 and from 100 to 150 degrees, elevations from -20 to 35. */
static bool in_windows(struct vec3 d)
{
    const double azimuth = atan2(d.y, d.x) / DEGREE, elevation = asin(d.z) / DEGREE;
    return elevation > -20 && elevation < 35 && (fabs(azimuth) < 40 || (azimuth > 100 && azimuth < 150));
}

/* A standard sky whose zenith is `zenith` times its distribution, in a colour; ground of 0.3. */
static void see_sky(struct outdoors *o, int type, struct vec3 to_sun, double houses)
{
    static const double colour[3] = {0.8, 1, 1.3};
    struct err err = ERR_INIT;
    assert_ok(outdoors_init(o, 256, &err), err);
    for (int y = 0; y < o->height; y++)
        for (int x = 0; x < o->width; x++) {
            const size_t at = (size_t)y * (size_t)o->width + (size_t)x;
            const struct vec3 d = outdoors_direction(o, x + 0.5, y + 0.5);
            const double elevation = asin(d.z) / DEGREE;
            const bool solid = elevation < houses && elevation > 0;
            if (!in_windows(d)) continue;
            o->source[at] = OUTDOORS_PHOTO;
            for (size_t c = 0; c < 3; c++)
                o->rgb[3 * at + c] = d.z < 0 ? 0.3f : solid ? 0.2f : (float)(colour[c] * sky_standard(type, d, to_sun));
        }
}

static void a_clear_sky_seen_through_two_windows_is_continued(void **state)
{
    (void)state;
    const struct vec3 to_sun = from_angles(60, 35);
    struct outdoors o = {0};
    see_sky(&o, 12, to_sun, 0);
    const struct sky_fit sky = guess(&o, &to_sun);
    assert_int_equal(sky.type, 12);
    assert_true(sky.misfit < 1e-3);
    for (int azimuth = -179; azimuth < 180; azimuth += 7)
        for (int elevation = 2; elevation < 90; elevation += 3) {
            const size_t at = pixel_at(&o, azimuth, elevation);
            const struct vec3 d = outdoors_direction(&o, (double)(at % 512) + 0.5, (double)(at / 512) + 0.5);
            const double truth = sky_standard(12, d, to_sun);
            /* close to the sun nothing is guessed as bright as it is; 0.979: luminance of the sky's colour */
            if (0.979 * truth < 0.98 * sky.brightest)
                assert_true(fabs((double)o.rgb[3 * at + 1] / truth - 1) < 0.03);
            else
                assert_true((double)luminance_of(o.rgb + 3 * at) < 1.3 * sky.brightest);
        }
    outdoors_release(&o);
}

static void the_zenith_is_never_brighter_than_the_sky_that_is_seen(void **state)
{
    (void)state;
    struct outdoors o = {0};
    see_sky(&o, 1, from_angles(0, 90), 0); /* overcast: the true zenith is brighter than all that is seen */
    const struct sky_fit sky = guess(&o, NULL);
    assert_true(luminance_at(&o, 0, 89) < 1.001 * sky.brightest);
    assert_true(luminance_at(&o, 0, 89) > 0.8 * sky.brightest);
    outdoors_release(&o);
}

static void there_is_no_edge_where_what_is_seen_ends(void **state)
{
    (void)state;
    const struct vec3 to_sun = from_angles(60, 35);
    struct outdoors o = {0};
    see_sky(&o, 9, to_sun, 8);
    guess(&o, &to_sun);
    for (int y = 1; y < o.height; y++)
        for (int x = 0; x < o.width; x++) {
            const size_t at = (size_t)y * (size_t)o.width + (size_t)x, above = at - (size_t)o.width;
            const size_t right = at - (size_t)x + (size_t)((x + 1) % o.width);
            const double here = (double)luminance_of(o.rgb + 3 * at);
            if (!o.source[at] != !o.source[above] && fabs(y - 128.0) > 8)
                assert_true(fabs(log(here / (double)luminance_of(o.rgb + 3 * above))) < 0.08);
            if (!o.source[at] != !o.source[right] && y < 100)
                assert_true(fabs(log(here / (double)luminance_of(o.rgb + 3 * right))) < 0.08);
        }
    outdoors_release(&o);
}

static void houses_do_not_darken_the_sky_and_stand_on_at_their_height(void **state)
{
    (void)state;
    const struct vec3 to_sun = from_angles(60, 35);
    struct outdoors o = {0};
    see_sky(&o, SKY_UNIFORM, to_sun, 10);
    const struct sky_fit sky = guess(&o, &to_sun);
    assert_int_equal(sky.type, SKY_UNIFORM);
    for (int azimuth = -175; azimuth < 180; azimuth += 10) {
        assert_true(fabs(luminance_at(&o, azimuth, 70) / sky.brightest - 1) < 0.01);
        assert_true(fabs(luminance_at(&o, azimuth, 20) / sky.brightest - 1) < 0.05);
        assert_true(fabs(luminance_at(&o, azimuth, 5) / 0.2 - 1) < 0.2);
        assert_true(fabs(luminance_at(&o, azimuth, -50) / 0.3 - 1) < 0.01);
    }
    outdoors_release(&o);
}

static void the_same_guess_for_any_number_of_threads(void **state)
{
    (void)state;
    struct outdoors o[2] = {{0}};
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        see_sky(&o[k], 7, from_angles(10, 50), 8);
        guess(&o[k], NULL);
    }
    parallel_set_threads(0);
    assert_memory_equal(o[0].rgb, o[1].rgb, (size_t)o[0].width * (size_t)o[0].height * 3 * sizeof(float));
    outdoors_release(&o[0]);
    outdoors_release(&o[1]);
}

/* --------------------------------------------------------------------------------------------------------- the disk */

/* Irradiance of a surface that faces a direction, from all that is brighter than 10. */
static double sum_of_disk(const struct outdoors *o, struct vec3 facing)
{
    double sum = 0;
    for (int y = 0; y < o->height; y++) {
        const double top = PI / 2 - PI * y / o->height, angle = (sin(top) - sin(top - PI / o->height)) * 2 * PI;
        for (int x = 0; x < o->width; x++) {
            const double radiance = (double)o->rgb[3 * ((size_t)y * (size_t)o->width + (size_t)x)];
            if (radiance > 10)
                sum += radiance * angle / o->width * vec3_dot(facing, outdoors_direction(o, x + 0.5, y + 0.5));
        }
    }
    return sum;
}

static void a_painted_sun_gives_its_irradiance(void **state)
{
    (void)state;
    static const double places[3][2] = {{-100, 38}, {179.9, 5}, {30, 89}};
    for (int k = 0; k < 3; k++) {
        struct outdoors o;
        struct err err = ERR_INIT;
        const struct vec3 d = from_angles(places[k][0], places[k][1]);
        assert_ok(outdoors_init(&o, 512, &err), err);
        assert_true(fabs(outdoors_paint_sun(&o, d, 1, rgb_grey(3)) - 1) < 1e-9);
        assert_true(fabs(sum_of_disk(&o, d) / 3 - 1) < 0.003);
        outdoors_release(&o);
    }
}

static void a_sun_that_is_too_bright_for_half_floats_is_wider(void **state)
{
    (void)state;
    struct outdoors o;
    struct err err = ERR_INIT;
    const struct vec3 d = from_angles(-100, 38);
    assert_ok(outdoors_init(&o, 1024, &err), err);
    assert_true(outdoors_paint_sun(&o, d, 0.27, rgb_grey(100)) > 1);
    assert_true(fabs(sum_of_disk(&o, d) / 100 - 1) < 0.01);
    for (int i = 0; i < o.width * o.height; i++) assert_true(o.rgb[3 * i] < 65504);
    outdoors_release(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(guesses_are_sky_above_the_horizon_and_ground_below),
        cmocka_unit_test(a_side_of_the_horizon_that_nothing_shows_takes_the_other_side),
        cmocka_unit_test(guesses_join_what_is_known_across_azimuth_pi),
        cmocka_unit_test(a_clear_sky_seen_through_two_windows_is_continued),
        cmocka_unit_test(the_zenith_is_never_brighter_than_the_sky_that_is_seen),
        cmocka_unit_test(there_is_no_edge_where_what_is_seen_ends),
        cmocka_unit_test(houses_do_not_darken_the_sky_and_stand_on_at_their_height),
        cmocka_unit_test(the_same_guess_for_any_number_of_threads),
        cmocka_unit_test(a_painted_sun_gives_its_irradiance),
        cmocka_unit_test(a_sun_that_is_too_bright_for_half_floats_is_wider),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
