/* suggest.c - plans suggested from synthetic points of two rooms with furniture and a doorway, of known dimensions. */
#include "stages/suggest_model/suggest.h"

#include "tests/unit/scratch.h"

#include "common/base/rng.h"

enum { POINTS = 600000, VIEWS = 24 };
/* metres: rooms of 5 x 4 and 3 x 4, a wall of 0.2 between them with a doorway, a window to a yard in the south */
static const double X[4] = {0, 5, 5.2, 8.2}, DEPTH = 4, HIGH = 2.6, DOOR[2] = {1.5, 2.4}, DOOR_TOP = 2.1;
static const double WINDOW[4] = {1.5, 0.9, 3.2, 2.2};

struct synthetic {
    struct point_cloud cloud;
    struct view views[VIEWS];
};

static double gauss(const struct rng *rng, uint64_t i, uint64_t k)
{
    return sqrt(-2 * log(1 - rng_uniform(rng, i, k))) * cos(2 * M_PI * rng_uniform(rng, i, k + 1));
}

/* The i-th point of the scene's surfaces; false: it is in a hole. */
static bool surface_point(struct vec3 *p, struct vec3 *n, const struct rng *rng, uint64_t i, bool doorway)
{
    const double u = rng_uniform(rng, i, 0), v = rng_uniform(rng, i, 1);
    const int room = i & 1 ? 1 : 0;
    const double low = X[2 * room], high = X[2 * room + 1], x = low + u * (high - low), y = v * DEPTH, z = v * HIGH;
    const bool hole = x > WINDOW[0] && x < WINDOW[2] && z > WINDOW[1] && z < WINDOW[3];
    const bool door = doorway && u * DEPTH > DOOR[0] && u * DEPTH < DOOR[1] && z < DOOR_TOP;
    switch ((i / 2) % 8) {
    case 0:
        *p = vec3_make(x, y, 0), *n = vec3_make(0, 0, 1);
        return true;
    case 1:
        *p = vec3_make(x, y, HIGH), *n = vec3_make(0, 0, -1);
        return true;
    case 2:
        *p = vec3_make(x, 0, z), *n = vec3_make(0, 1, 0);
        return !hole;
    case 3:
        *p = vec3_make(x, DEPTH, z), *n = vec3_make(0, -1, 0);
        return true;
    case 4:
        *p = vec3_make(low, u * DEPTH, z), *n = vec3_make(1, 0, 0);
        return !room || !door;
    case 5:
        *p = vec3_make(high, u * DEPTH, z), *n = vec3_make(-1, 0, 0);
        return room || !door;
    case 6: /* a cupboard in front of the west wall, a table */
        *p = room ? vec3_make(6 + u, 1 + v, 0.75) : vec3_make(0.45, 0.5 + 1.5 * u, 1.9 * v);
        *n = room ? vec3_make(0, 0, 1) : vec3_make(1, 0, 0);
        return true;
    default: /* a fence in the yard */
        *p = vec3_make(-2 + 9 * u, -3, 3 * v), *n = vec3_make(0, 1, 0);
        return true;
    }
}

/* The k-th of four views in all directions. */
static void look_around(struct view *view, struct vec3 at, int k)
{
    const double a = k * M_PI / 2, c = cos(a), s = sin(a);
    *view = (struct view){.name = "v", .width = 400, .height = 400, .fx = 180, .fy = 180, .cx = 200, .cy = 200};
    view->cam_from_world = (struct mat3){{{s, -c, 0}, {0, 0, -1}, {c, s, 0}}};
    view->center = at;
    view->translation = vec3_scale(mat3_apply(view->cam_from_world, at), -1);
}

static void make(struct synthetic *m, bool doorway, uint64_t seed)
{
    const struct rng rng = rng_make(seed, "suggest", "made");
    *m = (struct synthetic){.cloud = {.points = calloc(POINTS, sizeof *m->cloud.points)}};
    assert_non_null(m->cloud.points);
    for (uint64_t i = 0; i < POINTS; i++) {
        struct vec3 p, n;
        if (!surface_point(&p, &n, &rng, i, doorway)) continue;
        if (rng_uniform(&rng, i, 9) < 0.02)
            p = vec3_make(8.2 * rng_uniform(&rng, i, 10), 4 * rng_uniform(&rng, i, 11), 2);
        const double noise = 0.01;
        p = vec3_add(p, vec3_make(noise * gauss(&rng, i, 2), noise * gauss(&rng, i, 4), noise * gauss(&rng, i, 6)));
        n = vec3_normalize(vec3_add(n, vec3_make(0.1 * gauss(&rng, i, 12), 0.1 * gauss(&rng, i, 14), 0)));
        m->cloud.points[m->cloud.count++] = (struct cloud_point){
            .position = p, .normal = {(float)n.x, (float)n.y, (float)n.z}, .views = 6, .confidence = 1};
    }
    for (int v = 0; v < VIEWS; v++) { /* six positions with four views each */
        static const double PLACES[6][2] = {{1.2, 1}, {2.5, 2}, {4, 3}, {4, 1.2}, {6, 2}, {7.4, 3}};
        look_around(&m->views[v], vec3_make(PLACES[v / 4][0], PLACES[v / 4][1], 1.4), v % 4);
    }
}

static void suggest_made(struct suggestion *s, bool doorway, uint64_t seed, double ceiling)
{
    const struct suggest_params params = SUGGEST_PARAMS_DEFAULT;
    struct synthetic m;
    struct err err = ERR_INIT;
    make(&m, doorway, seed);
    assert_ok(suggest_plan(s, &m.cloud, m.views, VIEWS, ceiling, &params, &err), err);
    point_cloud_release(&m.cloud);
}

static void assert_refused(const struct synthetic *m, const char *words)
{
    const struct suggest_params params = SUGGEST_PARAMS_DEFAULT;
    struct suggestion s;
    struct err err = ERR_INIT;
    assert_int_equal(suggest_plan(&s, &m->cloud, m->views, VIEWS, HIGH, &params, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
}

static void outer_walls_are_right(const struct suggestion *s)
{
    assert_float_equal(s->walls[0].face, 0, 0.05);
    assert_float_equal(s->walls[1].face, 0, 0.05);
    assert_float_equal(s->walls[2].face, DEPTH, 0.05);
    assert_float_equal(s->walls[3].face, X[3], 0.05);
}

static void two_rooms_and_their_openings_are_found(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct suggestion s;
        suggest_made(&s, true, seed, HIGH);
        outer_walls_are_right(&s);
        assert_int_equal(s.wall_count, 5);
        assert_int_equal(s.room_count, 2);
        assert_true(s.rooms[0].free && s.rooms[1].free);
        assert_float_equal(s.walls[4].face, X[1], 0.05);
        assert_float_equal(s.walls[4].thickness, X[2] - X[1], 0.05);
        assert_int_equal(s.opening_count, 2);
        const struct suggested_opening *window = &s.openings[0], *door = &s.openings[1];
        assert_true(window->window && window->wall == 0 && !door->window && door->wall == 4);
        assert_float_equal(door->begin, DOOR[0], 0.1);
        assert_float_equal(door->end, DOOR[1], 0.1);
        assert_float_equal(door->foot, 0, 0);
        assert_float_equal(door->top, DOOR_TOP, 0.1);
        assert_float_equal(window->begin, WINDOW[0], 0.1);
        assert_float_equal(window->end, WINDOW[2], 0.1);
        assert_float_equal(window->foot, WINDOW[1], 0.1);
        assert_float_equal(window->top, WINDOW[3], 0.1);
        suggest_release(&s);
    }
}

/* Bookcases in the second room hide the wall up to a height. */
static void put_bookcases_before_the_partition(struct point_cloud *cloud, double top, double depth)
{
    for (size_t i = 0; i < cloud->count; i++) {
        struct cloud_point *p = &cloud->points[i];
        if (p->normal[0] > 0.7f && fabs(p->position.x - X[2]) < 0.1 && p->position.z < top) p->position.x += depth;
    }
}

static void a_wall_behind_furniture_has_its_thickness(void **state)
{
    (void)state;
    const struct suggest_params params = SUGGEST_PARAMS_DEFAULT;
    for (int k = 0; k < 3; k++) {
        static const double TOPS[3] = {1.2, 1.6, 1.9};
        struct synthetic m;
        struct suggestion s;
        struct err err = ERR_INIT;
        make(&m, false, 7 + (uint64_t)k);
        put_bookcases_before_the_partition(&m.cloud, TOPS[k], 0.3);
        assert_ok(suggest_plan(&s, &m.cloud, m.views, VIEWS, HIGH, &params, &err), err);
        assert_int_equal(s.wall_count, 5);
        assert_float_equal(s.walls[4].face, X[1], 0.02);
        assert_float_equal(s.walls[4].thickness, X[2] - X[1], 0.02);
        assert_false(s.walls[4].guessed);
        point_cloud_release(&m.cloud);
        suggest_release(&s);
    }
}

static void a_closed_wall_has_no_doorway(void **state)
{
    (void)state;
    struct suggestion s;
    suggest_made(&s, false, 4, HIGH);
    outer_walls_are_right(&s);
    assert_int_equal(s.wall_count, 5);
    for (int i = 0; i < s.opening_count; i++) assert_int_equal(s.openings[i].wall, 0);
    suggest_release(&s);
}

static void the_ceiling_may_be_unknown(void **state)
{
    (void)state;
    struct suggestion s;
    suggest_made(&s, true, 5, 0);
    outer_walls_are_right(&s);
    assert_int_equal(s.room_count, 2);
    suggest_release(&s);
}

enum { ROOMS = 70, VIEWS_PER_ROOM = 4 };
static const double STEP = 0.1, WIDE = 1.5, BETWEEN = 0.15, SHORT = 2;

static void add_wall(struct point_cloud *cloud, int axis, int sign, double at, double begin, double end)
{
    for (double s = begin + STEP / 2; s < end; s += STEP)
        for (double z = STEP / 2; z < HIGH; z += STEP) {
            struct cloud_point *p = &cloud->points[cloud->count++];
            *p = (struct cloud_point){.views = 1, .confidence = 1};
            p->position = axis ? vec3_make(s, at, z) : vec3_make(at, s, z);
            p->normal[axis] = (float)sign;
        }
}

/* There is no limit on numbers: a row of rooms with more than 64 faces, walls and rooms. */
static void the_number_of_rooms_is_not_limited(void **state)
{
    (void)state;
    const struct suggest_params params = SUGGEST_PARAMS_DEFAULT;
    struct point_cloud cloud = {.points = calloc(POINTS, sizeof *cloud.points)};
    struct view *views = calloc(ROOMS * VIEWS_PER_ROOM, sizeof *views);
    struct suggestion s;
    struct err err = ERR_INIT;
    assert_non_null(cloud.points);
    assert_non_null(views);
    for (int room = 0; room < ROOMS; room++) {
        const double low = room * (WIDE + BETWEEN), high = low + WIDE;
        add_wall(&cloud, 0, 1, low, 0, SHORT);
        add_wall(&cloud, 0, -1, high, 0, SHORT);
        add_wall(&cloud, 1, 1, 0, low, high);
        add_wall(&cloud, 1, -1, SHORT, low, high);
        for (int k = 0; k < VIEWS_PER_ROOM; k++)
            look_around(&views[room * VIEWS_PER_ROOM + k], vec3_make(low + WIDE / 2, SHORT / 2, 1.3), k);
    }
    if (suggest_plan(&s, &cloud, views, ROOMS * VIEWS_PER_ROOM, HIGH, &params, &err)) fail_msg("%s", err.text);
    assert_int_equal(s.wall_count, 4 + ROOMS - 1);
    assert_int_equal(s.room_count, ROOMS);
    for (int i = 0; i < s.room_count; i++) assert_true(s.rooms[i].free);
    suggest_release(&s);
    suggest_release(&s);
    free(views);
    free(cloud.points);
}

static void points_that_do_not_enclose_a_room_are_refused(void **state)
{
    (void)state;
    struct synthetic m;
    make(&m, true, 6);
    const size_t count = m.cloud.count;
    m.cloud.count = 0;
    assert_refused(&m, "no points");
    m.cloud.count = 1;
    assert_refused(&m, "no wall");
    m.cloud.count = count;
    for (size_t i = 0; i < count; i++) /* there is no north wall */
        if (m.cloud.points[i].normal[1] < -0.5f) m.cloud.points[i].normal[1] *= -1;
    assert_refused(&m, "no wall was found on the +y side");
    assert_refused(&m, " of these along -y. Likely causes");
    for (size_t i = 0; i < count / 2; i++) m.cloud.points[i].position.x *= 100;
    assert_refused(&m, "times the ceiling's height, wanted at most 50");
    point_cloud_release(&m.cloud);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_rooms_and_their_openings_are_found),
        cmocka_unit_test(a_wall_behind_furniture_has_its_thickness),
        cmocka_unit_test(a_closed_wall_has_no_doorway),
        cmocka_unit_test(the_ceiling_may_be_unknown),
        cmocka_unit_test(the_number_of_rooms_is_not_limited),
        cmocka_unit_test(points_that_do_not_enclose_a_room_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
