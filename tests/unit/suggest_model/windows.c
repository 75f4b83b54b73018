/* windows.c - windows in pictures and depth, made by rays, of a wall with a window, or with something like it. */
#include "stages/suggest_model/windows.h"

#include "tests/unit/scratch.h"

#include "common/base/rng.h"

/* metres: a room of 5 x 4 x 2.6 whose south wall, y = 0, is examined */
enum { VIEWS = 6, SIDE = 160 };
static const double WIDE = 5, DEEP = 4, HIGH = 2.6, REVEAL = 0.25, YARD = 9, SOFA = 0.6;
static const double RECT[4] = {1.5, 0.9, 3.2, 2.2}; /* begin, foot, end, top */
static const double WALL_LIGHT = 0.2, SKY = 4, GROUND = 1.2;

enum thing { WALL, WINDOW, POSTER, SUN, SLANTED_SUN, GLOW, MIRROR, DARK_WINDOW };
struct room {
    enum thing thing;
    bool bar;          /* in the middle of the window, 6 cm wide, at the wall's depth */
    double picture[4]; /* a dark rectangle on the wall; empty: none */
    double sofa[4];    /* a rectangle that hides what lies behind it; empty: no sofa */
};
struct sample {
    double z, light; /* depth from a camera that looks along -y */
    bool matched;
};

static bool is_in(const double rect[4], double x, double z)
{
    return x > rect[0] && x < rect[2] && z > rect[1] && z < rect[3];
}

/* Where the ray leaves the room's mirror image, y in [-DEEP, 0]; t: in units of the depth. */
static double leave_mirror(struct vec3 c, struct vec3 d)
{
    double t = (c.y + DEEP) / -d.y;
    if (d.x > 0) t = fmin(t, (WIDE - c.x) / d.x);
    if (d.x < 0) t = fmin(t, c.x / -d.x);
    if (d.z > 0) t = fmin(t, (HIGH - c.z) / d.z);
    if (d.z < 0) t = fmin(t, c.z / -d.z);
    return t;
}

/* What a ray from c along d (with d.y = -1, so that its parameter is depth) meets. */
static struct sample look(const struct room *room, struct vec3 c, struct vec3 d)
{
    const double before = c.y - SOFA, at = c.y;
    if (is_in(room->sofa, c.x + before * d.x, c.z + before * d.z)) return (struct sample){before, 0.1, true};
    const double x = c.x + at * d.x, z = c.z + at * d.z;
    if (is_in(room->picture, x, z)) return (struct sample){at, 0.2 * WALL_LIGHT, true};
    if (room->bar && fabs(x - (RECT[0] + RECT[2]) / 2) < 0.03) return (struct sample){at, WALL_LIGHT, true};
    if (room->thing == GLOW) { /* of a lamp close to the wall */
        const double far = hypot(x - 2.3, z - 1.5), glow = 20 / (1 + 16 * far * far);
        return (struct sample){at, (1 + glow) * WALL_LIGHT, glow < 1};
    }
    if (room->thing == WALL || !is_in(RECT, x, z)) return (struct sample){at, WALL_LIGHT, true};
    if (room->thing == SLANTED_SUN && fabs(x - 2.35 + 0.8 * (z - 1.55)) > 0.3)
        return (struct sample){at, WALL_LIGHT, true};
    switch (room->thing) {
    case POSTER:
        return (struct sample){at, 6 * WALL_LIGHT, true};
    case SUN: /* too bright to match, like a window that is blown out; its depth is that of the wall around it */
    case SLANTED_SUN:
        return (struct sample){at, 40 * WALL_LIGHT, false};
    case MIRROR: /* of a room that is brighter than this wall */
        return (struct sample){leave_mirror(c, d), 5 * WALL_LIGHT, true};
    default:
        break;
    }
    const double light = room->thing == DARK_WINDOW ? 0.02 : 1;
    double out = at + REVEAL;
    if (is_in(RECT, c.x + out * d.x, c.z + out * d.z)) {
        out = at + YARD;
        return (struct sample){out, light * (d.z > 0 ? SKY : GROUND), d.z < 0};
    }
    if (d.x) out = fmin(out, ((d.x > 0 ? RECT[2] : RECT[0]) - c.x) / d.x);
    if (d.z) out = fmin(out, ((d.z > 0 ? RECT[3] : RECT[1]) - c.z) / d.z);
    return (struct sample){out, light * 3 * WALL_LIGHT, true};
}

/* The picture and the depth of a camera at `at` that looks south. */
static void take(struct view *view, struct image *picture, struct layered_depth *depth, const struct room *room,
                 struct vec3 at, const struct rng *rng)
{
    struct err err = ERR_INIT;
    *view = (struct view){.name = "v", .width = SIDE, .height = SIDE, .fx = 80, .fy = 80, .cx = 80, .cy = 80};
    view->cam_from_world = (struct mat3){{{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}}};
    view->center = at;
    view->translation = vec3_scale(mat3_apply(view->cam_from_world, at), -1);
    assert_ok(image_init(picture, SIDE, SIDE, 4, &err), err);
    assert_ok(layered_depth_init(depth, SIDE, SIDE, &err), err);
    depth->segments = calloc(2, sizeof *depth->segments);
    assert_non_null(depth->segments);
    depth->segment_count = 2;
    depth->segments[0] = (struct depth_segment){.id = 1, .confidence = 0.8};
    depth->segments[1] = (struct depth_segment){.id = 2, .confidence = 0};
    for (int v = 0; v < SIDE; v++)
        for (int u = 0; u < SIDE; u++) {
            const struct vec3 d = vec3_make(-(u + 0.5 - view->cx) / view->fx, -1, -(v + 0.5 - view->cy) / view->fy);
            const uint64_t i = (uint64_t)(v * SIDE + u);
            const struct sample s = look(room, at, d);
            const double light = s.light * exp(0.2 * (rng_uniform(rng, i, 0) - 0.5));
            float *rgba = image_at(picture, u, v);
            for (int c = 0; c < 3; c++) rgba[c] = (float)light;
            rgba[3] = 1;
            depth->interior.z[i] = (float)(s.z * (1 + 0.02 * (rng_uniform(rng, i, 1) - 0.5)));
            depth->interior.id[i] = s.matched ? 1 : 2;
        }
}

/* Points on the room's walls, floor and ceiling. */
static void make_scene(struct occupancy *o)
{
    const double low[3] = {0, 0, 0}, high[3] = {WIDE, DEEP, HIGH}, step = 0.05;
    struct point_cloud cloud = {.points = calloc(60000, sizeof *cloud.points)};
    struct err err = ERR_INIT;
    assert_non_null(cloud.points);
    for (double x = step / 2; x < WIDE; x += step)
        for (double y = step / 2; y < DEEP; y += step)
            for (double z = step / 2; z < HIGH; z += step) {
                const bool edge = x < step || x > WIDE - step || y > DEEP - step || z < step || z > HIGH - step;
                if (edge) cloud.points[cloud.count++].position = vec3_make(x, y, z);
            }
    assert_true(cloud.count < 60000);
    assert_ok(raster_occupancy_make(o, &cloud, low, high, 0.13, &err), err);
    point_cloud_release(&cloud);
}

/* The wall's S is -x: for a viewer inside, it increases to the right. */
static const struct wall_line SOUTH = {{0, 1}, 0};

static struct suggested_opening mirrored(struct suggested_opening o)
{
    const double begin = o.begin;
    o.begin = -o.end;
    o.end = -begin;
    return o;
}

/* Suggests the windows of the south wall, in x; `before`, unless it is NULL, was found from points. */
static void suggest_made(struct suggestion *s, const struct room *room, const struct suggested_opening *before,
                         uint64_t seed)
{
    const struct suggest_params params = SUGGEST_PARAMS_DEFAULT;
    struct wall_raster raster;
    struct occupancy scene;
    struct err err = ERR_INIT;
    *s = (struct suggestion){.ceiling = HIGH};
    if (before) {
        s->openings = malloc(sizeof *s->openings);
        assert_non_null(s->openings);
        s->openings[s->opening_count++] = mirrored(*before);
    }
    make_scene(&scene);
    assert_ok(wall_raster_init(&raster, &SOUTH, -WIDE, 0, HIGH, params.window * HIGH, &err), err);
    for (int k = 0; k < VIEWS; k++) {
        struct view view;
        struct image picture;
        struct layered_depth depth;
        const struct rng rng = rng_make(seed, "windows", k % 2 ? "odd" : "even");
        take(&view, &picture, &depth, room, vec3_make(0.6 + 0.75 * k, 2 + 0.5 * (k % 3), 1.3 + 0.1 * (k % 2)), &rng);
        wall_raster_add(&raster, &view, &picture, &depth, 1, &scene);
        image_release(&picture);
        layered_depth_release(&depth);
    }
    assert_ok(windows_suggest(s, 0, &raster, &params, &err), err);
    for (int i = 0; i < s->opening_count; i++) s->openings[i] = mirrored(s->openings[i]);
    wall_raster_release(&raster);
    raster_occupancy_release(&scene);
}

static void assert_window(const struct suggestion *s, double begin, double foot, double end, double top)
{
    assert_int_equal(s->opening_count, 1);
    assert_true(s->openings[0].window);
    assert_int_equal(s->openings[0].wall, 0);
    assert_float_equal(s->openings[0].begin, begin, 0.06);
    assert_float_equal(s->openings[0].foot, foot, 0.06);
    assert_float_equal(s->openings[0].end, end, 0.06);
    assert_float_equal(s->openings[0].top, top, 0.06);
}

static void a_window_is_found(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct suggestion s;
        suggest_made(&s, &(struct room){.thing = WINDOW}, NULL, seed);
        assert_window(&s, RECT[0], RECT[1], RECT[2], RECT[3]);
        suggest_release(&s);
    }
}

static void a_window_with_a_bar_is_one_window(void **state)
{
    (void)state;
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = WINDOW, .bar = true}, NULL, 13);
    assert_window(&s, RECT[0], RECT[1], RECT[2], RECT[3]);
    suggest_release(&s);
}

static void a_dark_picture_beside_a_window_does_not_widen_it(void **state)
{
    (void)state;
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = WINDOW, .picture = {3.3, 0.7, 4, 2.4}}, NULL, 14);
    assert_window(&s, RECT[0], RECT[1], RECT[2], RECT[3]);
    suggest_release(&s);
}

/* An opening found from points is replaced, not doubled. */
static void a_window_found_from_points_is_corrected(void **state)
{
    (void)state;
    const struct suggested_opening rough = {.wall = 0, .begin = 1.7, .end = 3.1, .foot = 1, .top = 2, .window = true};
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = WINDOW}, &rough, 4);
    assert_window(&s, RECT[0], RECT[1], RECT[2], RECT[3]);
    suggest_release(&s);
}

static void assert_no_window(enum thing thing, uint64_t seed)
{
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = thing}, NULL, seed);
    assert_int_equal(s.opening_count, 0);
    suggest_release(&s);
}

static void a_bare_wall_has_no_window(void **state)
{
    (void)state;
    assert_no_window(WALL, 5);
}

static void a_bright_poster_is_no_window(void **state)
{
    (void)state;
    assert_no_window(POSTER, 6);
}

/* Blown out, it has the wall's depth. */
static void a_bright_rectangle_with_four_edges_is_a_window(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct suggestion s;
        suggest_made(&s, &(struct room){.thing = SUN}, NULL, seed);
        assert_window(&s, RECT[0], RECT[1], RECT[2], RECT[3]);
        assert_false(s.openings[0].doubtful);
        suggest_release(&s);
    }
}

/* A high sofa hides the fourth. */
static void a_bright_rectangle_with_three_edges_is_a_doubtful_window(void **state)
{
    (void)state;
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = SUN, .sofa = {0, 0, 5, 1.35}}, NULL, 16);
    assert_int_equal(s.opening_count, 1);
    assert_true(s.openings[0].doubtful);
    suggest_release(&s);
}

static void a_slanted_patch_of_sun_is_no_window(void **state)
{
    (void)state;
    assert_no_window(SLANTED_SUN, 7);
}

static void the_glow_of_a_lamp_is_no_window(void **state)
{
    (void)state;
    assert_no_window(GLOW, 15);
}

/* It is bright, and its depth is behind the wall. */
static void a_mirror_is_no_window(void **state)
{
    (void)state;
    assert_no_window(MIRROR, 8);
    const struct suggested_opening found = {.wall = 0, .begin = 1.5, .end = 3.2, .foot = 0.9, .top = 2.2};
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = MIRROR}, &found, 8);
    assert_int_equal(s.opening_count, 0);
    suggest_release(&s);
}

/* Views alone do not decide on a dark opening; one that points show stays where it was. */
static void a_dark_opening_is_left_to_the_points(void **state)
{
    (void)state;
    assert_no_window(DARK_WINDOW, 9);
    const struct suggested_opening found = {.wall = 0, .begin = 1.55, .end = 3.2, .foot = 0.9, .top = 2.2, .window = 1};
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = DARK_WINDOW}, &found, 9);
    assert_int_equal(s.opening_count, 1);
    assert_float_equal(s.openings[0].begin, 1.55, 0);
    suggest_release(&s);
}

static void an_opening_where_the_wall_is_solid_is_removed(void **state)
{
    (void)state;
    const struct suggested_opening found = {.wall = 0, .begin = 0.5, .end = 1.2, .foot = 0.9, .top = 2, .window = true};
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = WINDOW}, &found, 10);
    assert_window(&s, RECT[0], RECT[1], RECT[2], RECT[3]);
    suggest_release(&s);
}

/* A cupboard hides the lower left of the window: the visible parts of all sides still determine it. */
static void a_window_behind_furniture_has_all_its_sides(void **state)
{
    (void)state;
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = WINDOW, .sofa = {0, 0, 2.2, 1.3}}, NULL, 11);
    assert_window(&s, RECT[0], RECT[1], RECT[2], RECT[3]);
    suggest_release(&s);
}

/* A high sofa hides the whole lower half: the visible sides are right, and the window ends above the sofa's back. */
static void a_window_ends_where_furniture_hides_it(void **state)
{
    (void)state;
    struct suggestion s;
    suggest_made(&s, &(struct room){.thing = WINDOW, .sofa = {0, 0, 5, 1.35}}, NULL, 12);
    assert_int_equal(s.opening_count, 1);
    assert_true(s.openings[0].foot > RECT[1] && s.openings[0].foot < 1.55);
    assert_float_equal(s.openings[0].begin, RECT[0], 0.06);
    assert_float_equal(s.openings[0].end, RECT[2], 0.06);
    assert_float_equal(s.openings[0].top, RECT[3], 0.06);
    suggest_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_window_is_found),
        cmocka_unit_test(a_window_with_a_bar_is_one_window),
        cmocka_unit_test(a_dark_picture_beside_a_window_does_not_widen_it),
        cmocka_unit_test(a_window_found_from_points_is_corrected),
        cmocka_unit_test(a_bare_wall_has_no_window),
        cmocka_unit_test(a_bright_poster_is_no_window),
        cmocka_unit_test(a_bright_rectangle_with_four_edges_is_a_window),
        cmocka_unit_test(a_bright_rectangle_with_three_edges_is_a_doubtful_window),
        cmocka_unit_test(a_slanted_patch_of_sun_is_no_window),
        cmocka_unit_test(the_glow_of_a_lamp_is_no_window),
        cmocka_unit_test(a_mirror_is_no_window),
        cmocka_unit_test(a_dark_opening_is_left_to_the_points),
        cmocka_unit_test(an_opening_where_the_wall_is_solid_is_removed),
        cmocka_unit_test(a_window_behind_furniture_has_all_its_sides),
        cmocka_unit_test(a_window_ends_where_furniture_hides_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
