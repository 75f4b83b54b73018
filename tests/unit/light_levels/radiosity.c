/* Light in groups against closed forms: form factors, a closed room, a window under uniform and overcast skies, the
 * photographed state, threads. */
#include "stages/light_levels/colours.h"

#include "common/base/parallel.h"
#include "common/daylight/sky_luminance.h"
#include "common/math/numbers.h"
#include "tests/unit/box_solids.h"

/* A room of 4 x 4 x 3 m whose walls are 2 mm thick, with a hole of 2 x 1.5 m in the wall y = 0. */
#define THIN 0.002
static const struct box boxes[] = {
    {"walls", "floor", {-THIN, -THIN, -THIN}, {4 + THIN, 4 + THIN, 0}, false},
    {"walls", "ceiling", {-THIN, -THIN, 3}, {4 + THIN, 4 + THIN, 3 + THIN}, false},
    {"walls", "west", {-THIN, -THIN, 0}, {0, 4 + THIN, 3}, false},
    {"walls", "east", {4, -THIN, 0}, {4 + THIN, 4 + THIN, 3}, false},
    {"walls", "north", {0, 4, 0}, {4, 4 + THIN, 3}, false},
    {"walls", "below", {0, -THIN, 0}, {4, 0, 1}, false},
    {"walls", "above", {0, -THIN, 2.5}, {4, 0, 3}, false},
    {"walls", "left", {0, -THIN, 1}, {1, 0, 2.5}, false},
    {"walls", "right", {3, -THIN, 1}, {4, 0, 2.5}, false},
};
static const struct box closed[] = {ROOM_OUTSIDE, ROOM_INSIDE};

static void assert_near(double found, double wanted, double tolerance)
{
    if (!(fabs(found - wanted) <= tolerance)) fail_msg("found %.9g, wanted %.9g +- %g", found, wanted, tolerance);
}

struct room {
    struct model_field field;
    struct lamp lamp;
    struct field_lamp ready;
    struct daylight opening;
    struct light_groups groups;
    struct light_patches patches;
    struct light_rows rows;
    struct patch_colour *colours;
    struct radiosity light;
};

static char window_name[] = "hole", lamp_name[] = "spot";

static void start(struct room *r, const struct box *list, int count)
{
    *r = (struct room){.field.model = make_rays(list, count)};
    struct model_field *f = &r->field;
    f->atlas.ids = f->model.ids;
    f->atlas.first = calloc((size_t)f->model.ids + 1, sizeof *f->atlas.first);
    f->reach = 0.01;
}

/* A lamp of radiance 100 in the ceiling of the closed room. */
static void add_lamp(struct room *r)
{
    r->lamp = (struct lamp){.name = lamp_name,
                            .shape = LAMP_DISK,
                            .centre = {0.5, 0.3, 2},
                            .normal = {0, 0, -1},
                            .x = {0.3, 0, 0},
                            .y = {0, 0.3, 0},
                            .radius = 0.3,
                            .radiance = {100, 100, 100},
                            .beta = PI / 2};
    r->ready = (struct field_lamp){.lamp = &r->lamp};
    r->field.lights = (struct light_list){.lamps = &r->lamp, .lamp_count = 1};
    r->field.lamps = &r->ready;
}

/* A sky of radiance 1 on all sides, seen through the hole. */
static void add_sky(struct room *r)
{
    struct err err = ERR_INIT;
    r->opening = (struct daylight){
        .name = window_name, .centre = {2, 0, 1.75}, .x = {1, 0, 0}, .y = {0, 0, 0.75}, .normal = {0, 1, 0}};
    r->field.lights = (struct light_list){.openings = &r->opening, .opening_count = 1};
    assert_ok(outdoors_init(&r->field.outdoors, 16, &err), err);
    for (int i = 0; i < 3 * 16 * 32; i++) r->field.outdoors.rgb[i] = 1;
    assert_ok(field_sky_find(&r->field.sky, &r->field.outdoors, &err), err);
}

static void trace(struct room *r, int patches, int rays, double reflectance)
{
    struct err err = ERR_INIT;
    assert_ok(groups_make(&r->groups, &r->field, true, &err), err);
    assert_ok(patches_make(&r->patches, &r->field, patches, NULL, NULL, &err), err);
    struct row_place *places = calloc((size_t)r->patches.count, sizeof *places);
    for (int i = 0; i < r->patches.count; i++)
        places[i] = (struct row_place){r->patches.list[i].origins, r->patches.list[i].origin_count};
    assert_ok(rows_trace(&r->rows, &r->groups, &r->patches, places, r->patches.count, rays, 1, "patches", &err), err);
    free(places);
    r->colours = calloc((size_t)r->patches.count, sizeof *r->colours);
    for (int i = 0; i < r->patches.count; i++) r->colours[i].reflectance = rgb_grey(reflectance);
}

static void solve(struct room *r)
{
    struct err err = ERR_INIT;
    radiosity_release(&r->light);
    assert_ok(radiosity_solve(&r->light, &r->rows, r->colours, r->groups.rest, 1e-6, &err), err);
}

static void release(struct room *r)
{
    radiosity_release(&r->light);
    rows_release(&r->rows);
    patches_release(&r->patches);
    groups_release(&r->groups);
    free(r->colours);
    free(r->field.atlas.first);
    outdoors_release(&r->field.outdoors);
    model_rays_release(&r->field.model);
}

/* Irradiance at a row from all groups of [first, end), green. */
static double sum_groups(const struct room *r, const struct light_rows *at, int row, int first, int end)
{
    float *found = calloc(3 * (size_t)at->groups, sizeof *found);
    double sum = 0;
    radiosity_gather(found, at, row, &r->light);
    for (int g = first; g < end; g++) sum += (double)found[3 * g + 1];
    free(found);
    return sum;
}

static struct light_rows rows_at(const struct room *r, const struct gather_point *points, int count, int rays)
{
    struct row_place places[8];
    struct light_rows rows;
    struct err err = ERR_INIT;
    for (int i = 0; i < count; i++) places[i] = (struct row_place){&points[i], 1};
    assert_ok(rows_trace(&rows, &r->groups, &r->patches, places, count, rays, 1000000, "points", &err), err);
    return rows;
}

/* ------------------------------------------------------------------------------------------------------------------ */

static void form_factors_sum_to_one_and_areas_to_the_rooms(void **state)
{
    struct room r;
    double area = 0;
    (void)state;
    start(&r, boxes, sizeof boxes / sizeof *boxes);
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
    start(&r, closed, 2);
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
    start(&r, boxes, sizeof boxes / sizeof *boxes);
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

static void patches_of_the_sky_sum_to_the_photographed_sky_with_all_reflections(void **state)
{
    static const struct gather_point points[] = {{{1, 1, 0.75}, {0, 0, 1}}, {{3, 3, 0.1}, {0, 0, 1}}};
    struct room r;
    (void)state;
    start(&r, boxes, sizeof boxes / sizeof *boxes);
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
    start(&r, closed, 2);
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

static void threads_change_no_bit(void **state)
{
    struct room r[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(k ? 3 : 1);
        start(&r[k], boxes, sizeof boxes / sizeof *boxes);
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
        cmocka_unit_test(a_window_gives_the_sky_component_of_the_closed_form),
        cmocka_unit_test(patches_of_the_sky_sum_to_the_photographed_sky_with_all_reflections),
        cmocka_unit_test(photographs_give_the_reflectance_back),
        cmocka_unit_test(threads_change_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
