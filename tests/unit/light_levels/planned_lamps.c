/* planned_lamps.c - planned lamps against closed forms: a point of a black room, a panel overhead, a closed room of one
 * reflectance, a box in the way; how long a metre is where no scale is known; errors of states.txt. */
#include "tests/unit/level_room.h"

#include "common/model/model_metre.h"
#include "stages/light_levels/state_list.h"

/* 500 cd down, 100 cd at 60 degrees and 0 at 90, linear between; at 90 degrees around half as much as along x. */
#define SPOT                                                                                                      \
    "IESNA:LM-63-2002\n[LUMINAIRE] Spot\nTILT=NONE\n1 -1 1 3 3 1 2 0 0 0\n1 1 12\n0 60 90\n0 90 180\n500 100 0\n" \
    "500 50 0\n500 100 0\n"

static void read_states(struct state_list *l, const char *text, struct err *err)
{
    state_list_read(l, scratch_write("states.txt", text), NULL, err);
}

static struct state_list states_of(const char *text)
{
    struct state_list l;
    struct err err = ERR_INIT;
    read_states(&l, text, &err);
    assert_ok(err.status, err);
    return l;
}

/* A panel that shines as a matt surface does: I = 1000 cos. */
static void write_panel(double width, double length)
{
    static char text[20000];
    int n = snprintf(text, sizeof text, "IESNA91\nTILT=NONE\n1 -1 1 91 1 1 2 %g %g 0\n1 1 0\n", width, length);
    for (int a = 0; a <= 90; a++) n += snprintf(text + n, sizeof text - (size_t)n, "%d\n", a);
    n += snprintf(text + n, sizeof text - (size_t)n, "0\n");
    for (int a = 0; a <= 90; a++)
        n += snprintf(text + n, sizeof text - (size_t)n, "%.12f\n", 1000 * fmax(cos(a * DEGREE), 0));
    scratch_write("panel.ies", text);
}

static void trace_planned(struct room *r, const struct planned_lamps *lamps, double metre, int patches, int rays)
{
    struct err err = ERR_INIT;
    assert_ok(groups_make(&r->groups, &r->field, false, &err), err);
    groups_add_planned(&r->groups, lamps, metre);
    assert_ok(patches_make(&r->patches, &r->field, patches, NULL, NULL, &err), err);
    struct row_place *places = calloc((size_t)r->patches.count, sizeof *places);
    for (int i = 0; i < r->patches.count; i++)
        places[i] = (struct row_place){r->patches.list[i].origins, r->patches.list[i].origin_count};
    assert_ok(rows_trace(&r->rows, &r->groups, &r->patches, places, r->patches.count, rays, 1, "patches", &err), err);
    free(places);
    r->colours = calloc((size_t)r->patches.count, sizeof *r->colours);
}

/* E = I(theta) cos / r^2 at points below, beside and behind, of lamps that are aimed, turned and coloured. */
static void a_point_of_a_black_room_has_the_inverse_square(void **state)
{
    static const struct gather_point points[] = {
        {{0, 0, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 0, 1}}, {{0, 1, 0}, {0, 0, 1}}};
    struct room r;
    (void)state;
    scratch_write("spot.ies", SPOT);
    struct state_list l = states_of("remodel-states 1\nlamp down ies spot.ies at 0 0 2\n"
                                    "lamp turned ies spot.ies at 0 0 2 turn 90 colour 2 1 1\n"
                                    "lamp aimed ies spot.ies at 0 0 2 aim 1 0 -2\n"
                                    "lamp up ies spot.ies at 0 0 2 aim 0 0 1\n");
    assert_int_equal(l.planned.count, 4);
    start(&r, closed_room, 2);
    trace_planned(&r, &l.planned, 1, 50, 16);
    struct light_rows rows = rows_at(&r, points, 3, 16);
    const double theta = atan(0.5) / DEGREE, far = 500 - 400 * theta / 60, half = 500 - 450 * theta / 60;
    const double cosine = 2 / sqrt(5), wanted[4][3] = {
                                           {500 / 4.0, far * cosine / 5, half * cosine / 5},
                                           {500 / 4.0, half * cosine / 5, far * cosine / 5},
                                           {far / 4, 500 * cosine / 5, -1},
                                           {0, 0, 0},
                                       };
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 3; i++) {
            const float *d = rows.direct + 3 * ((size_t)r.groups.count * (size_t)i + (size_t)(r.groups.planned + k));
            const struct rgb e = rgb_make((double)d[0], (double)d[1], (double)d[2]);
            if (wanted[k][i] < 0) continue;
            assert_near(rgb_luminance(e), wanted[k][i], 1e-4 * wanted[k][i]);
            if (k == 1) assert_near(e.r, 2 * e.g, 1e-3);
        }
    rows_release(&rows);
    release(&r);
    state_list_release(&l);
}

/* A lamp that is turned by an angle is turned by that angle, however it is aimed. */
static void a_turn_is_about_the_axis(void **state)
{
    static const char *const aims[] = {"0 0 -1", "1 0 0", "-1 0 0", "0 1 0", "1 0 -1", "1 2 -0.5", "0 0 1", "1 1 3"};
    (void)state;
    scratch_write("spot.ies", SPOT);
    for (size_t i = 0; i < sizeof aims / sizeof *aims; i++)
        for (int turn = 0; turn <= 90; turn += 15) {
            char text[300];
            snprintf(text, sizeof text,
                     "remodel-states 1\nlamp a ies spot.ies at 0 0 2 aim %s\n"
                     "lamp b ies spot.ies at 0 0 2 aim %s turn %d\n",
                     aims[i], aims[i], turn);
            struct state_list l = states_of(text);
            const struct planned_lamp *a = &l.planned.list[0], *b = &l.planned.list[1];
            const struct vec3 swept = vec3_cross(a->along, b->along);
            assert_near(vec3_length(b->along), 1, 1e-12);
            assert_near(vec3_dot(b->along, b->down), 0, 1e-12);
            assert_near(vec3_dot(a->along, b->along), cos(turn * DEGREE), 1e-12);
            if (b->down.z < 0) assert_near(vec3_dot(swept, b->down), -sin(turn * DEGREE), 1e-12); /* from above */
            if (b->down.z > 0) assert_near(vec3_dot(swept, b->down), sin(turn * DEGREE), 1e-12);
            state_list_release(&l);
        }
}

/* A panel of luminance 1000 / area close overhead: pi L times the form factor of a rectangle from below its middle. */
static void a_panel_close_overhead_has_the_light_of_its_area(void **state)
{
    static const struct gather_point points[] = {{{0, 0, 1.5}, {0, 0, 1}}};
    struct room r;
    (void)state;
    write_panel(0.6, 1.2);
    struct state_list l = states_of("remodel-states 1\nlamp panel ies panel.ies at 0 0 2\n");
    start(&r, closed_room, 2);
    trace_planned(&r, &l.planned, 1, 50, 16);
    struct light_rows rows = rows_at(&r, points, 1, 16);
    const double a = 0.6 / 0.5, b = 0.3 / 0.5, u = a / sqrt(1 + a * a), v = b / sqrt(1 + b * b);
    const double form = 4 / (2 * PI) * (u * atan(b / sqrt(1 + a * a)) + v * atan(a / sqrt(1 + b * b)));
    const double found = (double)rows.direct[3 * r.groups.planned + 1];
    /* 64 places: the sum is within 2 % of the integral */
    assert_near(found / (PI * 1000 / 0.72 * form), 1, 0.02);
    assert_true(found < 0.75 * 1000 / 0.25); /* far from what a point of light would give */
    rows_release(&rows);
    release(&r);
    state_list_release(&l);
}

/* In a closed room of one reflectance the mean illuminance is flux / (area (1 - rho)), whatever the photometry. */
static void a_closed_room_keeps_the_lumens_of_its_lamps(void **state)
{
    static const double reflectances[] = {0, 0.5, 0.8};
    struct room r;
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("spot.ies", SPOT);
    write_panel(0.6, 0.6);
    struct state_list l = states_of("remodel-states 1\nlamp spot ies spot.ies at 0.5 0.3 2 aim 0.2 -0.1 -1 turn 30\n"
                                    "lamp panel ies panel.ies at -0.3 0 1.9\n");
    start(&r, closed_room, 2);
    trace_planned(&r, &l.planned, 1, 600, 256);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < r.patches.count; i++) r.colours[i].reflectance = rgb_grey(reflectances[k]);
        radiosity_release(&r.light);
        assert_ok(radiosity_solve(&r.light, &r.rows, r.colours, r.groups.rest, 1e-6, &err), err);
        for (int n = 0; n < 2; n++) {
            double flux = 0, area = 0;
            for (int i = 0; i < r.patches.count; i++) {
                const int g = r.groups.planned + n;
                flux += r.patches.list[i].area * sum_groups(&r, &r.rows, i, g, g + 1);
                area += r.patches.list[i].area;
            }
            const double lumens = photometry_lumens(&l.planned.list[n].web);
            assert_near(flux / area / (lumens / (area * (1 - reflectances[k]))), 1, 0.01);
        }
    }
    release(&r);
    state_list_release(&l);
}

/* The same room drawn in units of 20 cm has the same lx, if a metre is 5 of them; and a box hides the lamp. */
static void lux_do_not_depend_on_the_models_unit(void **state)
{
    static const struct box large[] = {{"room", "out", {-12, -12, -2}, {12, 12, 22}, false},
                                       {"room", "in", {-10, -10, 0}, {10, 10, 20}, true},
                                       {"box", "shelf", {-4, -4, 4}, {-2, 4, 5}, false}};
    static const struct gather_point points[] = {{{5, 0, 0}, {0, 0, 1}}, {{-5, 0, 0}, {0, 0, 1}}};
    struct room r;
    (void)state;
    scratch_write("spot.ies", SPOT);
    struct state_list l = states_of("remodel-states 1\nlamp spot ies spot.ies at 0 0 10\n");
    start(&r, large, 3);
    trace_planned(&r, &l.planned, 5, 50, 16);
    struct light_rows rows = rows_at(&r, points, 2, 16);
    const double theta = atan(0.5) / DEGREE, cosine = 2 / sqrt(5);
    assert_near((double)rows.direct[3 * r.groups.planned + 1], (500 - 400 * theta / 60) * cosine / 5, 1e-3);
    assert_true(rows.direct[3 * (r.groups.count + r.groups.planned) + 1] == 0);
    rows_release(&rows);
    release(&r);
    state_list_release(&l);
}

/* ------------------------------------------------------------------------------------------------------------------ */

static void a_metre_is_guessed_by_the_height_of_rooms(void **state)
{
    struct model_room_corner corners[] = {{.x = 0, .y = 0}, {.x = 4, .y = 0}, {.x = 4, .y = 4}, {.x = 0, .y = 4}};
    struct model_room rooms[3];
    struct model_metre m;
    struct err err = ERR_INIT;
    struct model_axes axes = {.scale = 1};
    (void)state;
    for (int i = 0; i < 3; i++) /* 15, 15.5 and 28 units high */
        rooms[i] = (struct model_room){.floor = -1,
                                       .ceiling = {{i == 2 ? 27 : 14 + 0.5 * i, 0, 0}},
                                       .ceilings = 1,
                                       .corners = corners,
                                       .corner_count = 4};
    const struct model_plan plan = {.rooms = rooms, .room_count = 3}, empty = {.room_count = 0};
    assert_ok(model_metre_find(&m, &axes, &plan, MODEL_METRE_ROOM, &err), err);
    assert_true(m.guessed);
    assert_near(m.units, 15.5 / 2.5, 1e-12);
    assert_near(m.low, 15.5 / 3.2, 1e-12);
    assert_near(m.high, 15.5 / 2.2, 1e-12);
    assert_ok(model_metre_find(&m, &axes, &empty, MODEL_METRE_ROOM, &err), err);
    assert_true(!m.guessed && m.units == 1);
    axes.metric = true;
    assert_ok(model_metre_find(&m, &axes, &plan, MODEL_METRE_ROOM, &err), err);
    assert_true(!m.guessed && m.units == 1 && m.low == 1 && m.high == 1);
}

static void assert_refused(const char *line, const char *words)
{
    struct state_list l;
    struct err err = ERR_INIT;
    char text[400];
    snprintf(text, sizeof text, "remodel-states 1\nlamp one ies spot.ies at 0 0 2\n%s\n", line);
    read_states(&l, text, &err);
    if (!err.status || !strstr(err.text, words)) fail_msg("%s: %s", line, err.text);
    state_list_release(&l);
}

static void errors_of_planned_lamps_name_file_and_line(void **state)
{
    (void)state;
    scratch_write("spot.ies", SPOT);
    scratch_write("tilted.ies", "IESNA91\nTILT=tilt.txt\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n1 1\n");
    scratch_write("dark.ies", "IESNA91\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n0 0\n");
    assert_refused("lamp one ies spot.ies at 1 0 2",
                   "states.txt:3: found \"one\", wanted a name that no lamp above has");
    assert_refused("lamp two ies tilted.ies at 1 0 2", "TILT=INCLUDE");
    assert_refused("lamp two ies tilted.ies at 1 0 2", "states.txt:3");
    assert_refused("lamp two ies none.ies at 1 0 2", "none.ies");
    assert_refused("lamp two ies dark.ies at 1 0 2", "an intensity above 0");
    assert_refused("lamp two ies ../spot.ies at 1 0 2", "without a folder");
    /* files that rules do not name, so that levels would not follow them */
    scratch_write("spot.IES", SPOT);
    scratch_write("my spot.ies", SPOT);
    assert_refused("lamp two ies spot.IES at 1 0 2", "FILE.ies, of letters");
    assert_refused("lamp two ies \"my spot.ies\" at 1 0 2", "FILE.ies, of letters");
    assert_refused("lamp two ies spot.ies at 1 0", "a coordinate");
    assert_refused("lamp two ies spot.ies at 1 0 2 aim 0 0 0", "straight down");
    assert_refused("lamp two ies spot.ies at 1 0 2 colour 0 0 0", "a number above 0");
    assert_refused("lamp two ies spot.ies at 1 0 2 tilt 3", "aim DX DY DZ");
    assert_refused("lamp -two ies spot.ies at 1 0 2", "a name of letters");
    assert_refused("lamp two 3", "ies");
    assert_refused("state off lamps off\nphoto IMG_1.jpg in off",
                   "states.txt:4: found \"IMG_1.jpg\", wanted the name of a photo, without the ending of its file");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_of_a_black_room_has_the_inverse_square),
        cmocka_unit_test(a_turn_is_about_the_axis),
        cmocka_unit_test(a_panel_close_overhead_has_the_light_of_its_area),
        cmocka_unit_test(a_closed_room_keeps_the_lumens_of_its_lamps),
        cmocka_unit_test(lux_do_not_depend_on_the_models_unit),
        cmocka_unit_test(a_metre_is_guessed_by_the_height_of_rooms),
        cmocka_unit_test(errors_of_planned_lamps_name_file_and_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
