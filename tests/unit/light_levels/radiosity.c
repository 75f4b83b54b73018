/* Light in groups against closed forms: form factors, a closed room, a window under uniform and overcast skies, the
 * photographed state, threads. */
#include "tests/unit/level_room.h"

#include "common/base/parallel.h"
#include "common/daylight/sky_luminance.h"
#include "stages/light_levels/colours.h"

/* ------------------------------------------------------------------------------------------------------------------ */

static void form_factors_sum_to_one_and_areas_to_the_rooms(void **state)
{
    struct room r;
    double area = 0;
    (void)state;
    start(&r, room_with_hole, ROOM_BOXES);
    add_sky(&r);
    trace(&r, 400, 64, 0.5);
    for (int i = 0; i < r.rows.count; i++) {
        double sum = (double)r.rows.rows[i].away;
        for (int k = 0; k < r.rows.rows[i].count; k++) sum += (double)r.rows.rows[i].entries[k].share;
        assert_near(sum, 1, 1e-5);
    }
    for (int i = 0; i < r.patches.count; i++)
        if (r.patches.list[i].origins[0].at.z > -THIN / 2 && r.patches.list[i].area > 0.001)
            area += r.patches.list[i].area;
    assert_near(area, 2 * 16 + 4 * 12 - 3, 0.2); /* the hole's rim is 7 m x 2 mm */
    release(&r);
}

/* In a closed room of one reflectance light bounces until it is absorbed: mean E = flux / (area (1 - rho)). */
static void a_closed_room_keeps_the_energy_of_its_lamp(void **state)
{
    static const double reflectances[] = {0, 0.5, 0.9};
    struct room r;
    (void)state;
    start(&r, closed_room, 2);
    add_lamp(&r);
    trace(&r, 600, 256, 0);
    for (int k = 0; k < 3; k++) {
        double flux = 0, area = 0;
        for (int i = 0; i < r.patches.count; i++) r.colours[i].reflectance = rgb_grey(reflectances[k]);
        solve(&r);
        for (int i = 0; i < r.patches.count; i++) {
            flux += r.patches.list[i].area * sum_groups(&r, &r.rows, i, 0, 1);
            area += r.patches.list[i].area;
        }
        assert_near(area, 6 * 16, 1e-6);
        const double sent = PI * 100 * PI * 0.09;
        assert_near(flux / area / (sent / (area * (1 - reflectances[k]))), 1, 0.01);
    }
    release(&r);
}

/* A thin wall stands under the middle of a lamp that lies on the ceiling, or a centimetre above it: each side has the
 * light of half the lamp. */
static void a_wall_under_a_lamp_hides_the_part_beyond_it(void **state)
{
    static const struct box divided[] = {
        ROOM_OUTSIDE, ROOM_INSIDE, {"across", "across", {-0.001, -2, -2}, {0.001, 2, 2}, false}};
    static const struct gather_point points[] = {{{-1, 0.2, -1.99}, {0, 0, 1}}, {{1, -0.3, 0}, {-1, 0, 0}}};
    (void)state;
    for (int above = 0; above < 2; above++) {
        struct room r;
        start(&r, divided, 3);
        r.field.reach = 0.05;
        add_lamp(&r);
        r.lamp.shape = LAMP_QUAD;
        r.lamp.centre = vec3_make(0, 0, 2 + 0.01 * above);
        r.lamp.x = vec3_make(0, -0.5, 0);
        r.lamp.y = vec3_make(0.5, 0, 0);
        trace(&r, 50, 16, 0);
        struct light_rows rows = rows_at(&r, points, 2, 16);
        for (int i = 0; i < 2; i++) {
            struct lamp half = r.lamp;
            half.centre.x = i ? 0.25 : -0.25;
            half.y = vec3_make(0.25, 0, 0);
            const double wanted = lamp_irradiance(&half, points[i].at, points[i].normal).g;
            assert_near((double)rows.direct[3 * (size_t)r.groups.count * (size_t)i + 1] / wanted, 1, 0.01);
        }
        rows_release(&rows);
        release(&r);
    }
}

/* A window's lower corner at the height of a horizontal point, D in front of it: W to one side, H up. Irradiance of a
 * sky of luminance 1 (first), and of one of sin(altitude) (second), the inner integral in closed form. */
static void window_light(double to[2], double d, double w, double h)
{
    enum { STEPS = 2000 };
    to[0] = to[1] = 0;
    for (int i = 0; i < STEPS; i++) {
        const double z = h * (i + 0.5) / STEPS, a2 = d * d + z * z, a = sqrt(a2), r2 = a2 + w * w;
        to[0] += d * z * (w / (2 * a2 * r2) + atan(w / a) / (2 * a2 * a)) * h / STEPS;
        to[1] += d * z * z * w * (3 * a2 + 2 * w * w) / (3 * a2 * a2 * r2 * sqrt(r2)) * h / STEPS;
    }
}

/* The same of the hole of the room, from a point of the plane x = 2. */
static void hole_light(double to[2], double y, double z)
{
    double upper[2], lower[2];
    window_light(upper, y, 1, 2.5 - z);
    window_light(lower, y, 1, 1 - z);
    for (int k = 0; k < 2; k++) to[k] = 2 * (upper[k] - (z < 1 ? lower[k] : 0));
}

static void a_window_gives_the_sky_component_of_the_closed_form(void **state)
{
    static const struct gather_point points[] = {
        {{2, 1, 0.75}, {0, 0, 1}}, {{2, 2, 0.75}, {0, 0, 1}}, {{2, 3.5, 0.75}, {0, 0, 1}}};
    struct room r;
    (void)state;
    start(&r, room_with_hole, ROOM_BOXES);
    add_sky(&r);
    trace(&r, 100, 16, 0); /* black: the sky alone */
    solve(&r);
    struct light_rows rows = rows_at(&r, points, 3, 8192);
    const struct sky_luminance sky = sky_of_type(SKY_TRADITIONAL, vec3_make(0, 0, 1), 10000, 0, 0);
    double luminance[146];
    sky_patch_luminances(luminance, &r.groups.patches, &sky);
    for (int i = 0; i < 3; i++) {
        const float *d = rows.direct + 3 * (size_t)r.groups.count * (size_t)i;
        double truth[2], overcast = 0;
        hole_light(truth, points[i].at.y, points[i].at.z);
        for (int k = 1; k < r.groups.patches.count; k++)
            overcast += luminance[k] * (double)d[3 * groups_patch(&r.groups, 0, k)];
        assert_near((double)d[3 * r.groups.sky] / truth[0], 1, 0.005);
        /* L = 9 E / (7 pi) (1 + 2 sin) / 3 */
        const double closed_form = 9 * 10000 / (7 * PI) * (truth[0] + 2 * truth[1]) / 3;
        assert_near(overcast / closed_form, 1, 0.02);
    }
    rows_release(&rows);
    release(&r);
}

/* Sanity: the internally reflected component of the daylight factor by the split-flux formula of the Building Research
 * Station, 0.85 W / (A (1 - R)) (39 R + 5 R) per cent without obstructions; a rule of thumb, right to a third. */
static void reflected_daylight_agrees_with_the_split_flux_formula(void **state)
{
    static const double reflectances[] = {0.3, 0.5, 0.7};
    struct gather_point points[8];
    struct room r;
    (void)state;
    for (int i = 0; i < 8; i++)
        points[i] = (struct gather_point){{0.8 + 0.8 * (i % 4), i < 4 ? 1.5 : 3, 0.75}, {0, 0, 1}};
    start(&r, room_with_hole, ROOM_BOXES);
    add_sky(&r);
    trace(&r, 400, 128, 0.5);
    struct light_rows rows = rows_at(&r, points, 8, 1024);
    const struct sky_luminance sky = sky_of_type(SKY_TRADITIONAL, vec3_make(0, 0, 1), 10000, 0, 0.1);
    double luminance[146];
    sky_patch_luminances(luminance, &r.groups.patches, &sky);
    for (int k = 0; k < 3; k++) {
        const double rho = reflectances[k], formula = 0.85 * 3 / (80 * (1 - rho)) * 44 * rho;
        double reflected = 0;
        for (int i = 0; i < r.patches.count; i++) r.colours[i].reflectance = rgb_grey(rho);
        solve(&r);
        for (int i = 0; i < 8; i++)
            for (int p = 0; p < r.groups.patches.count; p++) {
                const int g = groups_patch(&r.groups, 0, p);
                const double direct = (double)rows.direct[3 * ((size_t)r.groups.count * (size_t)i + (size_t)g) + 1];
                reflected += 100 * luminance[p] * (sum_groups(&r, &rows, i, g, g + 1) - direct) / 10000 / 8;
            }
        assert_near(reflected / formula, 1, 0.35);
    }
    rows_release(&rows);
    release(&r);
}

static void patches_of_the_sky_sum_to_the_photographed_sky_with_all_reflections(void **state)
{
    static const struct gather_point points[] = {{{1, 1, 0.75}, {0, 0, 1}}, {{3, 3, 0.1}, {0, 0, 1}}};
    struct room r;
    (void)state;
    start(&r, room_with_hole, ROOM_BOXES);
    add_sky(&r);
    trace(&r, 400, 128, 0.7);
    solve(&r);
    struct light_rows rows = rows_at(&r, points, 2, 1024);
    for (int i = 0; i < 2; i++) {
        const double sky = sum_groups(&r, &rows, i, r.groups.sky, r.groups.sky + r.groups.windows_count);
        const double parts = sum_groups(&r, &rows, i, r.groups.patch, r.groups.beam);
        assert_true(sky > 0.01);
        assert_near(parts / sky, 1, 1e-4);
    }
    rows_release(&rows);
    release(&r);
}

/* The photographs of a solved room give the reflectances that it was solved with. */
static void photographs_give_the_reflectance_back(void **state)
{
    struct room r;
    struct err err = ERR_INIT;
    (void)state;
    start(&r, closed_room, 2);
    add_lamp(&r);
    trace(&r, 300, 128, 0);
    for (int i = 0; i < r.patches.count; i++)
        r.colours[i].reflectance = rgb_make(0.2 + 0.001 * i, 0.5, 0.7 - 0.001 * i);
    solve(&r);
    struct photographed_patch *found = calloc((size_t)r.patches.count, sizeof *found);
    for (int i = 0; i < r.patches.count; i++) {
        const float *b = r.light.radiance + 3 * (size_t)r.groups.count * (size_t)i;
        r.patches.list[i].radiance = rgb_make((double)b[0], (double)b[1], (double)b[2]);
        r.patches.list[i].photographed = 1;
    }
    assert_ok(colours_of_photographs(found, &r.patches, &r.rows, &r.groups, &err), err);
    for (int i = 0; i < r.patches.count; i++) {
        assert_true(found[i].known);
        assert_near(found[i].colour.reflectance.r, 0.2 + 0.001 * i, 1e-4);
        assert_near(found[i].colour.reflectance.g, 0.5, 1e-4);
        assert_near(found[i].colour.reflectance.b, 0.7 - 0.001 * i, 1e-4);
    }
    /* a patch that shines by itself takes the reflectance of its face, and keeps the rest */
    r.patches.list[5].radiance = rgb_grey(1000);
    assert_ok(colours_of_photographs(found, &r.patches, &r.rows, &r.groups, &err), err);
    assert_false(found[5].known);
    assert_near(found[5].colour.reflectance.g, 0.5, 0.01);
    assert_near(found[5].colour.rest.g + 0.5 * found[5].before.g / PI, 1000, 10);
    free(found);
    release(&r);
}

/* The state of a room whose lamp and sky have been multiplied, gathered as a whole by other rays, and more of them, is
 * the sum of the groups of the room as it was. */
static void sums_of_groups_are_a_full_gather_of_the_whole_state(void **state)
{
    static const struct gather_point points[] = {
        {{1, 1, 0.75}, {0, 0, 1}}, {{3, 3, 0.75}, {0, 0, 1}}, {{2, 3.99, 1.5}, {0, -1, 0}}, {{2, 2, 2.99}, {0, 0, -1}}};
    static const double factors[][2] = {{1, 1}, {0.3, 2.5}, {3, 0}, {0, 1.5}};
    struct room r[1 + 4];
    double lamp[4], sky[4];
    (void)state;
    for (int k = 0; k < 5; k++) {
        const double by[2] = {k ? factors[k - 1][0] : 1, k ? factors[k - 1][1] : 1};
        start(&r[k], room_with_hole, ROOM_BOXES);
        add_lamp(&r[k]);
        r[k].lamp.radiance = rgb_grey(8 * by[0]);
        r[k].lamp.centre = vec3_make(2.5, 1.5, 2.9);
        const struct light_list lamps = r[k].field.lights;
        add_sky(&r[k]);
        r[k].field.lights.lamps = lamps.lamps;
        r[k].field.lights.lamp_count = 1;
        for (int i = 0; i < 3 * 16 * 32; i++) r[k].field.outdoors.rgb[i] = (float)by[1];
        trace_with(&r[k], 500, k ? 1024 : 512, 0.6, k ? 77 : 1, false);
        solve(&r[k]);
        struct light_rows rows = rows_with(&r[k], points, 4, 8192, k ? 9000000 : 1000000);
        for (int i = 0; i < 4; i++) {
            const int first = r[k].groups.sky, end = first + r[k].groups.windows_count;
            if (!k) lamp[i] = sum_groups(&r[k], &rows, i, 0, 1), sky[i] = sum_groups(&r[k], &rows, i, first, end);
            const double sum = by[0] * lamp[i] + by[1] * sky[i];
            if (k) assert_near(sum / sum_groups(&r[k], &rows, i, 0, r[k].groups.count), 1, 0.005);
        }
        rows_release(&rows);
    }
    for (int k = 0; k < 5; k++) release(&r[k]);
}

static void threads_change_no_bit(void **state)
{
    struct room r[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(k ? 3 : 1);
        start(&r[k], room_with_hole, ROOM_BOXES);
        add_sky(&r[k]);
        trace(&r[k], 200, 64, 0.6);
        solve(&r[k]);
    }
    parallel_set_threads(0);
    assert_int_equal(r[0].patches.count, r[1].patches.count);
    const size_t values = 3 * (size_t)r[0].groups.count * (size_t)r[0].patches.count;
    assert_memory_equal(r[0].rows.direct, r[1].rows.direct, values * sizeof(float));
    assert_memory_equal(r[0].light.radiance, r[1].light.radiance, values * sizeof(float));
    for (int k = 0; k < 2; k++) release(&r[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(form_factors_sum_to_one_and_areas_to_the_rooms),
        cmocka_unit_test(a_closed_room_keeps_the_energy_of_its_lamp),
        cmocka_unit_test(a_wall_under_a_lamp_hides_the_part_beyond_it),
        cmocka_unit_test(a_window_gives_the_sky_component_of_the_closed_form),
        cmocka_unit_test(reflected_daylight_agrees_with_the_split_flux_formula),
        cmocka_unit_test(patches_of_the_sky_sum_to_the_photographed_sky_with_all_reflections),
        cmocka_unit_test(photographs_give_the_reflectance_back),
        cmocka_unit_test(sums_of_groups_are_a_full_gather_of_the_whole_state),
        cmocka_unit_test(threads_change_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
