/* Pictures, days and places of light levels: isolines of a cone, one range of colours, values between patches, hours of
 * days, marks in photographs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/false_colour.h"
#include "common/math/numbers.h"
#include "stages/light_levels/level_days.h"
#include "stages/light_levels/level_lines.h"
#include "stages/light_levels/level_scale.h"
#include "stages/light_levels/patch_values.h"
#include "stages/light_levels/place_marks.h"
#include "tests/unit/box_solids.h"

static void assert_near(double found, double wanted, double tolerance)
{
    if (!(fabs(found - wanted) <= tolerance)) fail_msg("found %.9g, wanted %.9g +- %g", found, wanted, tolerance);
}

/* --------------------------------------------------------------------------------------------------------- isolines */

enum { SIDE = 41, STEP = 4 };

/* exp(r / 20 px) around the middle; the surface changes at column `cut`. */
static char *lines_of_cone(double level, int cut)
{
    float values[SIDE * SIDE];
    int surface[SIDE * SIDE];
    const struct level_grid grid = {SIDE, SIDE, STEP, values, surface};
    struct err err = ERR_INIT;
    char *text = NULL;
    size_t size;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double x = STEP * (i % SIDE - SIDE / 2), y = STEP * (double)(i / SIDE) - STEP * (double)(SIDE / 2);
        values[i] = (float)exp(hypot(x, y) / 20);
        surface[i] = i % SIDE >= cut;
    }
    FILE *to = open_memstream(&text, &size);
    assert_non_null(to);
    assert_ok(level_lines_put(to, &grid, level, &err), err);
    fclose(to);
    return text;
}

static int count_of(const char *text, const char *word)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, word)); at++) count++;
    return count;
}

static void isolines_of_a_cone_are_one_ring_with_its_number(void **state)
{
    (void)state;
    char *text = lines_of_cone(exp(2), SIDE); /* 40 px from the middle */
    int points = 0, used;
    double x, y;
    assert_int_equal(count_of(text, "class=\"level\""), 1);
    assert_true(count_of(text, "class=\"number\"") >= 1);
    assert_non_null(strstr(text, ">7.38906<"));
    const char *at = strstr(text, "class=\"level\" d=\"M");
    assert_non_null(at);
    for (at += strlen("class=\"level\" d=\"M"); sscanf(at, "%lf %lf%n", &x, &y, &used) == 2; points++) {
        assert_near(hypot(x - STEP * (SIDE / 2), y - STEP * (SIDE / 2)), 40, 0.3);
        at += used;
        at += *at == 'L' || *at == ' ';
    }
    assert_true(points > 40);
    free(text);
}

static void isolines_end_where_the_surface_does(void **state)
{
    (void)state;
    char *text = lines_of_cone(exp(2), SIDE / 2); /* the ring is cut twice */
    assert_int_equal(count_of(text, "class=\"level\""), 2);
    free(text);
    text = lines_of_cone(1e6, SIDE);
    assert_string_equal(text, "");
    free(text);
}

/* ---------------------------------------------------------------------------------------------------------- colours */

static void a_unit_has_one_range_and_rising_colours(void **state)
{
    (void)state;
    const struct level_scale lx = level_scale_of("lx", 0), relative = level_scale_of("relative", 0);
    double before = -1;
    assert_near(level_scale_place(&lx, 10), 0, 1e-12);
    assert_near(level_scale_place(&lx, 10000), 1, 1e-12);
    assert_near(level_scale_place(&lx, 100), 1.0 / 3, 1e-12);
    assert_near(level_scale_place(&lx, 0), 0, 0);
    assert_near(level_scale_place(&relative, 1), 0.5, 1e-12);
    assert_near(lx.lines[0], 10, 1e-9);
    assert_near(lx.lines[lx.line_count - 1], 10000, 1e-6);
    assert_near(level_scale_of("%", 1).high, 100, 1e-9);
    char text[32];
    assert_string_equal(level_scale_number(text, 15523), "15500");
    assert_string_equal(level_scale_number(text, 999.6), "1000");
    assert_string_equal(level_scale_number(text, 0.01234), "0.0123");
    for (double v = 10; v <= 10000; v *= 1.2) { /* grey prints keep the order */
        unsigned char c[3];
        level_scale_colour(&lx, v, c);
        const double light = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        assert_true(light > before);
        before = light;
    }
}

/* ---------------------------------------------------------------------------------------------------------- patches */

static const struct box closed[] = {ROOM_OUTSIDE, ROOM_INSIDE};

static void values_between_patches_are_linear(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct model_field field = {.model = make_rays(closed, 2)};
    struct light_patches p;
    int tried = 0;
    field.atlas.ids = field.model.ids;
    field.atlas.first = calloc((size_t)field.model.ids + 1, sizeof *field.atlas.first);
    assert_ok(patches_make(&p, &field, 600, NULL, NULL, &err), err);
    double *values = malloc((size_t)p.count * sizeof *values);
    assert_non_null(values);
    for (int i = 0; i < p.count; i++) {
        const struct patch_cells *c = &p.cells[p.list[i].face];
        for (int k = 0; k < c->columns * c->rows; k++)
            if (c->patch[k] == i)
                values[i] = 5 + 2 * (c->low[0] + c->step[0] * (k % c->columns + 0.5)) -
                            3 * (c->low[1] + c->step[1] * (k / c->columns + 0.5));
    }
    for (int i = 0; i < p.count; i++) {
        const struct patch_cells *c = &p.cells[p.list[i].face];
        const struct vec3 at = p.list[i].origins[0].at;
        const double u = (vec3_dot(c->u, at) - c->low[0]) / c->step[0];
        const double v = (vec3_dot(c->v, at) - c->low[1]) / c->step[1];
        if (!(u > 0.5 && v > 0.5 && u < c->columns - 0.5 && v < c->rows - 0.5)) continue;
        const double wanted = 5 + 2 * vec3_dot(c->u, at) - 3 * vec3_dot(c->v, at);
        assert_near(patch_values_at(&p, values, p.list[i].face, at), wanted, 1e-9);
        tried++;
    }
    assert_true(tried > 100);
    free(values);
    patches_release(&p);
    free(field.atlas.first);
    model_rays_release(&field.model);
}

/* ------------------------------------------------------------------------------------------------------------- days */

static void days_have_the_hours_of_sunlight(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    const struct state_list berlin = {.has_site = true, .site = {52.5, 13.4, 1}, .north = 90};
    struct sun_time date;
    struct level_days d;
    assert_ok(level_date_read(&date, "2026-05-01", &err), err);
    assert_ok(level_days_make(&d, &berlin, &date, 2, &err), err);
    assert_int_equal(d.day_count, 4);
    assert_int_equal(d.days[0].month, 5);
    /* by the almanac from 8:15 to 15:54 on 21 December and from 3:43 to 20:33 on 21 June, with refraction, which
     * makes up for seven minutes */
    const struct level_day *winter = &d.days[1], *summer = &d.days[3];
    assert_near(d.hours[winter->first].time.hour, 8.5, 0);
    assert_near(d.hours[winter->first + winter->count - 1].time.hour, 15.5, 0);
    assert_near(d.hours[summer->first].time.hour, 4, 0);
    assert_near(d.hours[summer->first + summer->count - 1].time.hour, 20, 0);
    for (int i = 0; i < d.hour_count; i++) assert_true(d.hours[i].sun.altitude > 0);
    level_days_release(&d);
    const struct state_list nowhere = {.north = 90};
    assert_ok(level_days_make(&d, &nowhere, NULL, 2, &err), err);
    assert_int_equal(d.hour_count, 0);
    level_days_release(&d);
}

static void dates_that_no_calendar_has_are_refused(void **state)
{
    (void)state;
    static const char *const wrong[] = {"2026-13-01", "2026-02-30", "today", "2026-12-21x", "12", ""};
    struct sun_time date;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct err err = ERR_INIT;
        assert_int_equal(level_date_read(&date, wrong[i], &err), ST_USAGE);
    }
    struct err err = ERR_INIT;
    assert_ok(level_date_read(&date, "12-21", &err), err);
    assert_int_equal(date.month, 12);
    assert_int_equal(date.day, 21);
}

/* ----------------------------------------------------------------------------------------------------------- places */

/* Two rooms of 4 x 3 m side by side, of which the second is 1 m lower. */
static void marks_are_where_their_ray_comes_to_their_height(void **state)
{
    (void)state;
    struct model_room_corner corners[2][4] = {{{.x = 0, .y = 0}, {.x = 4, .y = 0}, {.x = 4, .y = 3}, {.x = 0, .y = 3}},
                                              {{.x = 4, .y = 0}, {.x = 8, .y = 0}, {.x = 8, .y = 3}, {.x = 4, .y = 3}}};
    struct model_room rooms[2] = {{.floor = 0, .corners = corners[0], .corner_count = 4},
                                  {.floor = -1, .corners = corners[1], .corner_count = 4}};
    const struct model_plan plan = {.rooms = rooms, .room_count = 2};
    const struct vec3 from = {1, 1, 1.75};
    struct vec3 at;
    /* down by 1 m, over 2 m along x and 0.5 m along y */
    assert_true(place_mark_find(&at, &plan, from, vec3_make(2, 0.5, -1), 0.75));
    assert_near(at.x, 3, 1e-12);
    assert_near(at.y, 1.5, 1e-12);
    assert_near(at.z, 0.75, 1e-12);
    /* twice as flat: past the first room, and 0.75 m above the lower floor only 2 m down */
    assert_true(place_mark_find(&at, &plan, from, vec3_make(3, 0.1, -1), 0.75));
    assert_near(at.x, 7, 1e-12);
    assert_near(at.z, -0.25, 1e-12);
    assert_false(place_mark_find(&at, &plan, from, vec3_make(1, 0, 1), 0.75));
    assert_false(place_mark_find(&at, &plan, from, vec3_make(1, 0, 0), 0.75));
    assert_false(place_mark_find(&at, &plan, from, vec3_make(0, 5, -1), 0.75));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isolines_of_a_cone_are_one_ring_with_its_number),
        cmocka_unit_test(isolines_end_where_the_surface_does),
        cmocka_unit_test(a_unit_has_one_range_and_rising_colours),
        cmocka_unit_test(values_between_patches_are_linear),
        cmocka_unit_test(days_have_the_hours_of_sunlight),
        cmocka_unit_test(dates_that_no_calendar_has_are_refused),
        cmocka_unit_test(marks_are_where_their_ray_comes_to_their_height),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
