/* place_line.c - walls from lines and corners in photographs: pixels of a room whose walls are known, without any
 * points. */
#include "tests/unit/build_model/scripted.h"

#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "stages/build_model/place/place_line.h"

/* Two cameras in a room of 4 x 3: a fisheye that looks to the north-east and a pinhole that looks south. */
enum { FISH, PIN, PHOTOS };
static char fish[] = "fish", pin[] = "pin";
static struct lens lenses[PHOTOS] = {
    {fish, fish, {CAMERA_OPENCV_FISHEYE, 960, 640, {300, 300, 480, 320, -0.02, 0.001, 0, 0}}, {1, 0, 0, 0}},
    {pin, pin, {CAMERA_PINHOLE, 800, 600, {300, 300, 400, 300}}, {1, 0, 0, 0}}};
static const struct lens_list list = {lenses, PHOTOS}, no_lenses = {0};
static const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1, .metric = true, .ceiling = 2.5};
static struct view views[PHOTOS];
static const struct camera_set set = {.views = views, .view_count = PHOTOS}, no_views = {0};
static struct placer placer;
static const struct model_params params = MODEL_PARAMS_DEFAULT;

static int start(void **state)
{
    static const double places[PHOTOS][4] = {{1, 0.8, 1.5, 35}, {2.2, 2.6, 1.4, -90}}; /* x, y, z, heading */
    const struct placer_views known[2] = {{&set, &list}, {&no_views, &no_lenses}};
    struct err err = ERR_INIT;
    for (int i = 0; i < PHOTOS; i++) {
        const double *p = places[i], c = cos(p[3] * DEGREE), s = sin(p[3] * DEGREE);
        const struct camera *lens = &lenses[i].camera;
        struct view v = {.name = lenses[i].view, .width = lens->width, .height = lens->height};
        camera_focal(lens, &v.fx, &v.fy, &v.cx, &v.cy);
        v.cam_from_world = (struct mat3){{{s, -c, 0}, {0, 0, -1}, {c, s, 0}}};
        v.center = vec3_make(p[0], p[1], p[2]);
        v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
        views[i] = v;
    }
    return scratch_make(state) || place_init(&placer, known, &axes, NULL, &params, &err);
}

static int stop(void **state)
{
    place_release(&placer);
    return scratch_remove(state);
}

/* "VIEW X Y" of a point of the model, moved by some pixels. */
static const char *pixel(char text[80], int photo, double x, double y, double z, double dx, double dy)
{
    double u, v;
    assert_true(photo_camera_project(&placer.photos[photo].camera, vec3_make(x, y, z), &u, &v));
    snprintf(text, 80, "%.12g %.12g", u + dx, v + dy);
    return text;
}

static enum status apply(struct plan *plan, struct err *err, const char *fmt, ...) PRINTF_LIKE(3, 4);
static enum status apply(struct plan *plan, struct err *err, const char *fmt, ...)
{
    struct script script = {0};
    char text[4000] = "remodel-script 1\nset thickness 0.2\n";
    va_list args;
    va_start(args, fmt);
    vsnprintf(text + strlen(text), sizeof text - strlen(text), fmt, args);
    va_end(args);
    *err = (struct err)ERR_INIT;
    plan_begin(plan, &axes);
    if (!script_read(&script, scratch_write("model.txt", text), err)) plan_apply(plan, &script, false, &placer, err);
    script_release(&script);
    return err->status;
}

#define REFUSED(words, ...)                                             \
    do {                                                                \
        struct plan plan_;                                              \
        struct err err_;                                                \
        assert_int_not_equal(apply(&plan_, &err_, __VA_ARGS__), ST_OK); \
        assert_err(err_, ST_DATA, words);                               \
        plan_release(&plan_);                                           \
    } while (0)

/* A wall with the in face n p = c and the ends at S. */
static void assert_wall(const struct plan *plan, int at, double nx, double ny, double c, double s0, double s1,
                        double within)
{
    const struct plan_line in = plan_wall_face(&plan->walls[at], SIDE_IN),
                           out = plan_wall_face(&plan->walls[at], SIDE_OUT);
    double span[2];
    plan_wall_span(plan, at, span);
    assert_true(hypot(in.n[0] - nx, in.n[1] - ny) <= within && fabs(in.c - c) <= within);
    assert_true(fabs(span[0] - s0) <= within && fabs(span[1] - s1) <= within);
    assert_true(fabs(out.c + in.c - 0.2) < 1e-9); /* the body is behind the in face, away from the camera */
}

static void a_line_at_the_floor_or_the_ceiling_places_a_wall(void **state)
{
    struct plan plan;
    struct err err;
    char a[80], b[80];
    (void)state;
    for (int top = 0; top < 2; top++)
        for (int swapped = 0; swapped < 2; swapped++) { /* in either order */
            pixel(swapped ? b : a, FISH, 0.7, 3, 2.5 * top, 0, 0);
            pixel(swapped ? a : b, FISH, 3.2, 3, 2.5 * top, 0, 0);
            assert_ok(apply(&plan, &err, "wall north %s in fish %s %s\n", top ? "top" : "foot", a, b), err);
            assert_wall(&plan, 0, 0, -1, -3, 0.7, 3.2, 1e-6);
            assert_true(plan.walls[0].d[1] == 0); /* along the axis */
            plan_release(&plan);
        }
    pixel(a, FISH, 0.7, 3, 0.1, 0, 0); /* on a step, and under a ceiling of its own */
    pixel(b, FISH, 3.2, 3, 0.1, 0, 0);
    assert_ok(apply(&plan, &err, "wall north foot in fish %s %s foot 0.1\n", a, b), err);
    assert_wall(&plan, 0, 0, -1, -3, 0.7, 3.2, 1e-6);
    plan_release(&plan);
    pixel(a, FISH, 0.7, 3, 2.2, 0, 0);
    pixel(b, FISH, 3.2, 3, 2.2, 0, 0);
    assert_ok(apply(&plan, &err, "wall north top in fish %s %s top 2.2 thickness 0.2\n", a, b), err);
    assert_wall(&plan, 0, 0, -1, -3, 0.7, 3.2, 1e-6);
    plan_release(&plan);
}

/* Clicks with the error of `click`: the error of the position has the standard deviation that is stated, and it is
 * smaller than that of the mean of both ends. */
static void the_stated_error_is_that_of_clicks(void **state)
{
    enum { DRAWS = 2000 };
    const struct rng rng = rng_make(5, "place_line", "clicks");
    double sum = 0, plain = 0, stated = 0;
    (void)state;
    for (int i = 0; i < DRAWS; i++) {
        struct placed_corner q[2];
        struct placed_line line;
        struct err err = ERR_INIT;
        for (int k = 0; k < 2; k++) {
            double d[2], u, v;
            for (int n = 0; n < 2; n++)
                d[n] = params.click * sqrt(-2 * log(1 - rng_uniform(&rng, (uint64_t)i, (uint64_t)(8 * k + 2 * n)))) *
                       cos(2 * PI * rng_uniform(&rng, (uint64_t)i, (uint64_t)(8 * k + 2 * n + 1)));
            assert_true(
                photo_camera_project(&placer.photos[PIN].camera, vec3_make(k ? 4 : 3.9, k ? -3 : 1, 0), &u, &v));
            const struct script_corner at = {pin, u + d[0], v + d[1]};
            assert_ok(place_corner(&q[k], &placer, &at, 0, PLACE_ON_FLOOR, "m", 1, &err), err);
        }
        const double along[2] = {0.1 / 4, -1};
        const double length = hypot(along[0], along[1]), unit[2] = {along[0] / length, along[1] / length};
        assert_ok(place_line(&line, &placer, &q[0], &q[1], unit, false, "m", 1, &err), err);
        const double n[2] = {line.d[1], -line.d[0]}, truth = n[0] * 4 + n[1] * -3;
        sum += (line.c - truth) * (line.c - truth);
        const double mean = 0.5 * (n[0] * (q[0].p[0] + q[1].p[0]) + n[1] * (q[0].p[1] + q[1].p[1]));
        plain += (mean - truth) * (mean - truth);
        stated += line.error * line.error;
    }
    assert_true(fabs(sqrt(sum / stated) - 1) < 0.06);
    assert_true(sum < plain);
}

static void a_direction_may_be_given(void **state)
{
    struct plan plan;
    struct err err;
    char a[80], b[80];
    (void)state;
    pixel(a, FISH, 3.6, 1.2, 0, 0, 0); /* 0.4 to the side in 1.2: 18 degrees off y */
    pixel(b, FISH, 3.2, 2.4, 0, 0, 0);
    REFUSED("runs 18.4 degrees off the nearest axis", "wall w foot in fish %s %s\n", a, b);
    REFUSED("add the word angled", "wall w foot in fish %s %s\n", a, b);
    REFUSED("off the wall's direction", "wall w foot in fish %s %s along x\n", a, b);
    REFUSED("found both angled and along x", "wall w foot in fish %s %s along x angled\n", a, b);
    REFUSED("nothing is named other yet", "wall w foot in fish %s %s along other\n", a, b);
    assert_ok(apply(&plan, &err, "wall w foot in fish %s %s angled\n", a, b), err);
    const double n[2] = {-1.2 / hypot(1.2, 0.4), -0.4 / hypot(1.2, 0.4)};
    assert_wall(&plan, 0, n[0], n[1], n[0] * 3.6 + n[1] * 1.2, plan.walls[0].ends[END_START].s,
                plan.walls[0].ends[END_END].s, 1e-6);
    plan_release(&plan);
    /* of an angled wall */
    char c[80], d[80];
    pixel(c, FISH, 3.0, 1.2, 0, 0.5, 0);
    pixel(d, FISH, 2.6, 2.4, 0, 0, -0.5);
    assert_ok(apply(&plan, &err, "wall v foot in fish %s %s angled\nwall w foot in fish %s %s along v\n", a, b, c, d),
              err);
    assert_true(plan.walls[1].angled && plan.walls[0].d[0] == plan.walls[1].d[0] &&
                plan.walls[0].d[1] == plan.walls[1].d[1]);
    assert_true(fabs(plan.walls[0].c - plan.walls[1].c + 0.6 * 1.2 / hypot(1.2, 0.4)) < 0.02);
    plan_release(&plan);
}

static void lines_that_meet_no_floor_are_refused(void **state)
{
    char a[80], b[80];
    (void)state;
    pixel(a, FISH, 0.7, 3, 0, 0, 0);
    pixel(b, FISH, 3.2, 3, 1.6, 0, 0);
    REFUSED("can be no floor: it is at the horizon or above it", "wall w foot in fish %s %s\n", a, b);
    REFUSED("of fish there can be no floor", "wall w foot in fish %s %s\n", b, a);
    pixel(b, FISH, 3.2, 3, 1.4, 0, 0);
    pixel(a, FISH, 0.7, 3, 2.5, 0, 0);
    REFUSED("can be no ceiling: it is at the horizon or below it", "wall w top in fish %s %s\n", a, b);
    REFUSED("the pixel 961 20 is outside the picture of fish, which has 960 x 640 pixels",
            "wall w foot in fish 961 20 30 40\n");
    REFUSED("did you mean fish?", "wall w foot in fsh 96 20 30 40\n");
    REFUSED("found the pixel 30 40 of fish twice", "wall w foot in fish 30 40 30 40\n");
    REFUSED("not below the ceiling", "set ceiling 1.45\nwall w top in fish 430 40 30 40\n");
    REFUSED("the camera of fish is at height 1.5, not above the floor at 1.6",
            "wall w foot in fish 430 40 30 40 foot 1.6\n");
    REFUSED("\"in\"", "wall w foot fish 30 40 30 40\n");
    REFUSED("\"in VIEW\" or \"from\"", "box w foot in fish 30 40 30 40\n");
}

static void adjust_moves_a_wall_to_its_line(void **state)
{
    struct plan plan;
    struct err err;
    char a[80], b[80];
    (void)state;
    pixel(a, FISH, 0.7, 3, 2.5, 0, 0);
    pixel(b, FISH, 3.2, 3, 2.5, 0, 0);
    assert_ok(apply(&plan, &err, "wall north from 0 3.3 to 4 3.3\nadjust north top in fish %s %s\n", a, b), err);
    assert_wall(&plan, 0, 0, -1, -3, 0, 4, 1e-6);
    plan_release(&plan);
    REFUSED("shows wall north from behind", "wall north from 4 3 to 0 3\nadjust north top in fish %s %s\n", a, b);
    REFUSED("pillar is not a wall", "box pillar from 1 2 to 1.5 2.5\nadjust pillar foot in fish 430 40 30 40\n");
}

/* The corners of the room, clockwise from the north-east one, of those photos that show them. */
static const double corners[4][2] = {{4, 3}, {4, 0}, {0, 0}, {0, 3}};
static const int shown_in[4] = {FISH, FISH, PIN, FISH};

static void chain(char text[600], const char *names, int first, int step, int count, const char *rest)
{
    int n = snprintf(text, 600, "walls %s", names);
    for (int i = 0; i < count; i++) {
        const int at = (first + step * i + 8) % 4;
        char p[80];
        pixel(p, shown_in[at], corners[at][0], corners[at][1], 0, 0.3 * i, -0.2 * i);
        n += snprintf(text + n, 600 - (size_t)n, " corner in %s %s", shown_in[at] == FISH ? "fish" : "pin", p);
    }
    snprintf(text + n, 600 - (size_t)n, " %s\n", rest);
}

static void a_closed_chain_makes_a_room(void **state)
{
    struct plan plan;
    struct err err;
    char text[600];
    (void)state;
    for (int way = 0; way < 2; way++) { /* clockwise, and the other way round */
        struct solid_list solids = {0};
        chain(text, way ? "north west south east" : "east south west north", 0, way ? -1 : 1, 4, "closed");
        assert_ok(apply(&plan, &err, "%sroom hall north east south west\ndoor d on south from 1 0 to 2 2\n", text),
                  err);
        assert_int_equal(plan.wall_count, 4);
        static const double n[4][2] = {{-1, 0}, {0, 1}, {1, 0}, {0, -1}}, c[4] = {-4, 0, 0, -3};
        for (int i = 0; i < 4; i++) {
            const int at = way ? 3 - i : i; /* east south west north */
            const double to = at % 2 ? 4 : 3;
            assert_string_equal(plan.walls[i].name, ((const char *const[]){"east", "south", "west", "north"})[at]);
            assert_wall(&plan, i, n[at][0], n[at][1], c[at], 0, to, 0.03);
            assert_true(plan.walls[i].ends[0].kind == CORNER_END && plan.walls[i].ends[1].kind == CORNER_END);
        }
        assert_ok(layout_solids(&solids, &plan, &err), err);
        assert_true(inside(&solids, "walls", 3, -0.1, 1) && !inside(&solids, "walls", 2, 1.5, 1.2));
        assert_true(!inside(&solids, "walls", 1.5, -0.1, 1));
        drop(&plan, &solids);
    }
}

static void an_open_chain_has_its_inside_where_the_cameras_stand(void **state)
{
    struct plan plan;
    struct err err;
    char text[600];
    (void)state;
    for (int way = 0; way < 2; way++) {
        chain(text, way ? "east north" : "north east", way ? 1 : 3, way ? -1 : 1, 3, "thickness 0.2");
        assert_ok(apply(&plan, &err, "%s", text), err);
        assert_wall(&plan, way, 0, -1, -3, 0, 4, 0.03);
        assert_wall(&plan, !way, -1, 0, -4, 0, 3, 0.03);
        assert_int_equal(plan.walls[0].ends[way ? END_START : END_END].kind, CORNER_END);
        assert_int_equal(plan.walls[0].ends[way ? END_END : END_START].kind, FREE_END);
        plan_release(&plan);
    }
}

static void an_angled_chain_keeps_the_axes_of_its_other_walls(void **state)
{
    struct plan plan;
    struct err err;
    char p[4][80];
    (void)state;
    pixel(p[0], FISH, 1, 3, 0, 0, 0);
    pixel(p[1], FISH, 3, 3, 0, 0.4, 0.4);
    pixel(p[2], FISH, 4, 2, 0, 0, 0);
    pixel(p[3], FISH, 4, 0.5, 0, 0, 0);
    const char *line =
        "walls north bay east corner in fish %s corner in fish %s corner in fish %s corner in fish %s%s\n";
    REFUSED("wall bay: from pixel", line, p[0], p[1], p[2], p[3], "");
    assert_ok(apply(&plan, &err, line, p[0], p[1], p[2], p[3], " angled"), err);
    assert_true(!plan.walls[0].angled && plan.walls[1].angled && !plan.walls[2].angled);
    assert_true(fabs(plan.walls[0].c + 3) < 0.03 && plan.walls[0].d[0] == 1);
    assert_true(fabs(plan.walls[2].c + 4) < 0.03 && plan.walls[2].d[1] == -1);
    assert_true(fabs(plan.walls[1].d[0] - sqrt(0.5)) < 0.03 && fabs(plan.walls[1].d[1] + sqrt(0.5)) < 0.03);
    plan_release(&plan);
}

static void chains_that_do_not_close_are_refused(void **state)
{
    char text[600], p[5][80];
    (void)state;
    chain(text, "a b", 0, 1, 3, "closed");
    REFUSED("found 2 names and 3 corners", "%s", text);
    chain(text, "a b c", 0, 1, 3, "");
    REFUSED("or the word closed for a wall from the last corner to the first", "%s", text);
    chain(text, "a b c", 0, 1, 3, "closed"); /* a corner is missing */
    REFUSED("the room does not close: from its last corner, at pixel", "%s", text);
    chain(text, "a b c d", 0, 1, 5, ""); /* the first corner again */
    REFUSED("it is the first corner again, as near as clicks tell", "%s", text);
    chain(text, "a b", 0, 1, 2, "closed");
    REFUSED("found 2 corners, wanted 3 or more to close a room", "%s", text);
    chain(text, "a a", 0, 1, 3, "");
    REFUSED("the name a is used already", "%s", text);
    REFUSED("in a line \"walls NAME NAME", "walls a corner in fish 10 20\n");
    REFUSED("in a line \"walls NAME NAME", "walls a b\n");
    for (int i = 0; i < 3; i++) pixel(p[i], FISH, 1 + i, 3, 0, 0, 0);
    REFUSED("the walls before and after it run in one direction",
            "walls a b corner in fish %s corner in fish %s corner in fish %s\n", p[0], p[1], p[2]);
    REFUSED("the pixel 970 20 is outside the picture of fish", "walls a corner in fish 970 20 corner in fish %s\n",
            p[0]);
    REFUSED("can be no floor", "walls a corner in fish 480 200 corner in fish %s\n", p[0]);
    /* a wall crosses another one */
    static const double crossing[6][2] = {{1, 3}, {4, 3}, {4, 1}, {2, 1}, {2, 3.6}, {1, 3.6}};
    int n = snprintf(text, sizeof text, "walls a b c d e f");
    for (int i = 0; i < 6; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, " corner in fish %s",
                      pixel(p[0], FISH, crossing[i][0], crossing[i][1], 0, 0, 0));
    REFUSED("the room does not close: wall d, from pixel", "%s closed\n", text);
    REFUSED("crosses wall a, from pixel", "%s closed\n", text);
}

static void a_script_without_views_names_what_is_missing(void **state)
{
    (void)state;
    refused("remodel-script 1\nwall w foot in v1 1 2 3 4\n", NULL, "names the view v1, but no views are known");
    refused("remodel-script 1\nwalls w corner in v2 1 2 corner in v1 3 4\n", NULL, "names the view v2");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_at_the_floor_or_the_ceiling_places_a_wall),
        cmocka_unit_test(the_stated_error_is_that_of_clicks),
        cmocka_unit_test(a_direction_may_be_given),
        cmocka_unit_test(lines_that_meet_no_floor_are_refused),
        cmocka_unit_test(adjust_moves_a_wall_to_its_line),
        cmocka_unit_test(a_closed_chain_makes_a_room),
        cmocka_unit_test(an_open_chain_has_its_inside_where_the_cameras_stand),
        cmocka_unit_test(an_angled_chain_keeps_the_axes_of_its_other_walls),
        cmocka_unit_test(chains_that_do_not_close_are_refused),
        cmocka_unit_test(a_script_without_views_names_what_is_missing),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
