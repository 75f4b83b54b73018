/* suggest.c - plans suggested from synthetic points of known plans: two rooms with furniture and a doorway; two walls
 * only, an L, an angled wall, an open plan with a bay, clutter, with noise and stray points. */
#include "stages/suggest_model/suggest.h"

#include "tests/unit/scratch.h"

#include "stages/suggest_model/openings.h"
#include "stages/suggest_model/wall_joins.h"
#include "tests/unit/suggest_model/made_plan.h"

enum { POINTS = 600000, VIEWS = 24 };
/* metres: rooms of 5 x 4 and 3 x 4, a wall of 0.2 between them with a doorway, a window to a yard in the south */
static const double X[4] = {0, 5, 5.2, 8.2}, DEPTH = 4, HIGH = 2.6, DOOR[2] = {1.5, 2.4}, DOOR_TOP = 2.1;
static const double WINDOW[4] = {1.5, 0.9, 3.2, 2.2};

struct synthetic {
    struct point_cloud cloud;
    struct view views[VIEWS];
};

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

/* Suggests a plan with openings. */
static void suggest_all(struct suggestion *s, const struct point_cloud *cloud, const struct view *views, int view_count,
                        double height)
{
    const struct suggest_params params = SUGGEST_PARAMS_DEFAULT;
    struct sights sights;
    struct err err = ERR_INIT;
    assert_ok(sights_make(&sights, cloud, SUGGEST_CUBE * height, views, view_count, &err), err);
    assert_ok(suggest_plan(s, &sights, height, 0, &params, &err), err);
    sights_release(&sights);
    assert_ok(sights_make(&sights, cloud, 0.005 * height, views, view_count, &err), err);
    const struct opening_finder finder = {&sights, &params, height};
    for (int i = 0; i < s->wall_count; i++) assert_ok(openings_find(s, &finder, i, &err), err);
    sights_release(&sights);
    wall_joins_cut_openings(s, suggested_thickness(0, height), 0.04 * height);
}

static void suggest_made(struct suggestion *s, bool doorway, uint64_t seed)
{
    struct synthetic m;
    make(&m, doorway, seed);
    suggest_all(s, &m.cloud, m.views, VIEWS, HIGH);
    point_cloud_release(&m.cloud);
}

/* The longest wall with that face, whose inside is where the normal (nx, ny) points; S of no wall is asked. */
static int find_wall(const struct suggestion *s, double nx, double ny, double at, double within)
{
    int best = -1;
    for (int i = 0; i < s->wall_count; i++)
        for (int side = 0; side < (s->walls[i].between ? 2 : 1); side++) {
            const struct suggested_wall *w = &s->walls[i];
            const struct wall_line l = wall_side_line(w, side);
            if (l.n[0] * nx + l.n[1] * ny < 0.995 || fabs(l.at - at) > within) continue;
            if (best < 0 || w->end - w->begin > s->walls[best].end - s->walls[best].begin) best = i;
        }
    return best;
}

static const struct suggested_wall *wall_at(const struct suggestion *s, double nx, double ny, double at, double within)
{
    const int i = find_wall(s, nx, ny, at, within);
    if (i < 0) fail_msg("no wall has a face at %g along %g %g", at, nx, ny);
    return &s->walls[i];
}

static void assert_extent(const struct suggested_wall *w, const double a[2], const double b[2], double within)
{
    const double s[2] = {line_along(&w->line, a[0], a[1]), line_along(&w->line, b[0], b[1])};
    assert_float_equal(w->begin, fmin(s[0], s[1]), within);
    assert_float_equal(w->end, fmax(s[0], s[1]), within);
}

static void outer_walls_are_right(const struct suggestion *s)
{
    wall_at(s, 0, 1, 0, 0.05);
    wall_at(s, 1, 0, 0, 0.05);
    wall_at(s, 0, -1, -DEPTH, 0.05);
    wall_at(s, -1, 0, -X[3], 0.05);
}

static const struct suggested_wall *partition_of(const struct suggestion *s)
{
    const struct suggested_wall *w = wall_at(s, -1, 0, -X[1], 0.02);
    assert_true(w->between && !w->guessed);
    assert_float_equal(w->thickness, X[2] - X[1], 0.02);
    assert_extent(w, (const double[2]){X[1], 0}, (const double[2]){X[1], DEPTH}, 0.1);
    return w;
}

/* The opening's sides in x or y. */
static void assert_opening(const struct suggestion *s, const struct suggested_opening *o, int axis,
                           const double want[4])
{
    double a[2], b[2];
    line_point(&s->walls[o->wall].line, o->begin, 0, a);
    line_point(&s->walls[o->wall].line, o->end, 0, b);
    assert_float_equal(fmin(a[axis], b[axis]), want[0], 0.1);
    assert_float_equal(fmax(a[axis], b[axis]), want[2], 0.1);
    assert_float_equal(o->foot, want[1], o->window ? 0.1 : 0);
    assert_float_equal(o->top, want[3], 0.1);
}

static void two_rooms_and_their_openings_are_found(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct suggestion s;
        suggest_made(&s, true, seed);
        outer_walls_are_right(&s);
        const struct suggested_wall *partition = partition_of(&s);
        assert_int_equal(s.wall_count, 5);
        assert_int_equal(s.room_count, 2);
        assert_true(s.rooms[0].closed && s.rooms[1].closed);
        assert_int_equal(s.opening_count, 2);
        const int first = s.openings[0].window ? 0 : 1;
        const struct suggested_opening *window = &s.openings[first], *door = &s.openings[1 - first];
        assert_true(window->window && !door->window);
        assert_ptr_equal(&s.walls[door->wall], partition);
        assert_opening(&s, door, 1, (const double[4]){DOOR[0], 0, DOOR[1], DOOR_TOP});
        assert_opening(&s, window, 0, (const double[4]){WINDOW[0], WINDOW[1], WINDOW[2], WINDOW[3]});
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
    for (int k = 0; k < 3; k++) {
        static const double TOPS[3] = {1.2, 1.6, 1.9};
        struct synthetic m;
        struct suggestion s;
        make(&m, false, 7 + (uint64_t)k);
        put_bookcases_before_the_partition(&m.cloud, TOPS[k], 0.3);
        suggest_all(&s, &m.cloud, m.views, VIEWS, HIGH);
        assert_int_equal(s.wall_count, 5);
        partition_of(&s);
        point_cloud_release(&m.cloud);
        suggest_release(&s);
    }
}

static void a_closed_wall_has_no_doorway(void **state)
{
    (void)state;
    struct suggestion s;
    suggest_made(&s, false, 4);
    outer_walls_are_right(&s);
    assert_int_equal(s.wall_count, 5);
    for (int i = 0; i < s.opening_count; i++) assert_true(s.openings[i].window);
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
    struct point_cloud cloud = {.points = calloc(POINTS, sizeof *cloud.points)};
    struct view *views = calloc(ROOMS * VIEWS_PER_ROOM, sizeof *views);
    struct suggestion s;
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
    suggest_all(&s, &cloud, views, ROOMS * VIEWS_PER_ROOM, HIGH);
    assert_int_equal(s.wall_count, 4 + ROOMS - 1);
    assert_int_equal(s.room_count, ROOMS);
    for (int i = 0; i < s.room_count; i++) assert_true(s.rooms[i].closed);
    suggest_release(&s);
    suggest_release(&s);
    free(views);
    free(cloud.points);
}

/* Without points, or with few, there is a plan without walls, and no error. */
static void nothing_is_found_without_points(void **state)
{
    (void)state;
    struct synthetic m;
    struct suggestion s;
    make(&m, true, 6);
    for (size_t count = 0; count <= 20; count += 10) {
        m.cloud.count = count;
        suggest_all(&s, &m.cloud, m.views, VIEWS, HIGH);
        assert_int_equal(s.wall_count, 0);
        suggest_release(&s);
    }
    point_cloud_release(&m.cloud);
}

/* ------------------------------------------------------------------------------------------------------- made plans */

static void suggest_plan_of(struct suggestion *s, const struct made_plan *p, uint64_t seed)
{
    struct point_cloud cloud = made_points(p, seed);
    assert_non_null(cloud.points);
    suggest_all(s, &cloud, p->views, p->view_count, p->high);
    point_cloud_release(&cloud);
}

/* Noise of 2 % of the distance, and a third of the points anywhere. */
static struct made_plan made(bool noisy)
{
    return (struct made_plan){
        .high = 2.5, .low = {-20, -20}, .most = {20, 20}, .noise = noisy ? 0.02 : 0.003, .stray = noisy ? 0.3 : 0};
}

static void two_walls_are_found_alone(void **state)
{
    (void)state;
    for (int noisy = 0; noisy < 2; noisy++) {
        struct made_plan p = made(noisy);
        struct suggestion s;
        made_line(&p, (const double[3][2]){{0, 4}, {0, 0}, {5, 0}}, 3, false);
        p.most[0] = p.most[1] = 4;
        p.low[0] = p.low[1] = 0;
        made_camera(&p, 2, 2);
        made_camera(&p, 3, 1.5);
        suggest_plan_of(&s, &p, 11);
        const struct suggested_wall *south = wall_at(&s, 0, 1, 0, 0.04), *west = wall_at(&s, 1, 0, 0, 0.04);
        assert_int_equal(s.wall_count, 2);
        assert_extent(south, (const double[2]){0, 0}, (const double[2]){5, 0}, 0.3);
        assert_extent(west, (const double[2]){0, 0}, (const double[2]){0, 4}, 0.3);
        assert_true(wall_joins_has(&s, (int)(south - s.walls), (int)(west - s.walls)));
        assert_true(south->confidence > 0.4 && west->confidence > 0.4);
        assert_true(s.doubt_count > 0); /* the sides that nobody saw */
        for (int i = 0; i < s.room_count; i++) assert_false(s.rooms[i].closed);
        suggest_release(&s);
    }
}

/* Only a quarter of the west wall has points, the rest is blank. It is a wall nonetheless, unless a camera that stands
 * behind it shows that it is none. */
static void a_wall_that_is_mostly_blank_is_found_unless_a_camera_is_behind(void **state)
{
    (void)state;
    for (int behind = 0; behind < 2; behind++) {
        struct made_plan p = made(false);
        struct suggestion s;
        made_line(&p, (const double[4][2]){{0, 0}, {5, 0}, {5, 4}, {0, 4}}, 4, false);
        made_wall(&p, 0, 1.5, 0, 2.5, 0, p.high);
        p.most[0] = 5, p.most[1] = 4;
        p.low[0] = p.low[1] = 0;
        made_camera(&p, 2, 2);
        made_camera(&p, 3, 1.5);
        if (behind) made_camera(&p, -0.5, 1);
        suggest_plan_of(&s, &p, 13);
        const int west = find_wall(&s, 1, 0, 0, 0.04);
        if (behind) { /* at most the part that has points, and what is beside it */
            assert_true(west < 0 || s.walls[west].end - s.walls[west].begin < 3);
        } else {
            assert_true(west >= 0 && s.walls[west].covered > 0.2 && s.walls[west].covered < 0.3);
            assert_extent(&s.walls[west], (const double[2]){0, 0}, (const double[2]){0, 4}, 0.3);
        }
        suggest_release(&s);
    }
}

static void an_l_shaped_room_is_found(void **state)
{
    (void)state;
    static const double L[6][2] = {{0, 0}, {6, 0}, {6, 2.5}, {3, 2.5}, {3, 5}, {0, 5}};
    for (int noisy = 0; noisy < 2; noisy++) {
        struct made_plan p = made(noisy);
        struct suggestion s;
        made_line(&p, L, 6, true);
        made_camera(&p, 1.5, 1.2);
        made_camera(&p, 4.5, 1.2);
        made_camera(&p, 1.5, 3.8);
        suggest_plan_of(&s, &p, 12);
        assert_int_equal(s.wall_count, 6);
        const double within = noisy ? 0.05 : 0.01;
        assert_extent(wall_at(&s, 0, 1, 0, within), L[0], L[1], 0.1);
        assert_extent(wall_at(&s, -1, 0, -6, within), L[1], L[2], 0.1);
        assert_extent(wall_at(&s, 0, -1, -2.5, within), L[2], L[3], 0.1);
        assert_extent(wall_at(&s, -1, 0, -3, within), L[3], L[4], 0.1);
        assert_extent(wall_at(&s, 0, -1, -5, within), L[4], L[5], 0.1);
        assert_extent(wall_at(&s, 1, 0, 0, within), L[5], L[0], 0.1);
        assert_int_equal(s.room_count, 1);
        assert_true(s.rooms[0].closed);
        assert_float_equal(s.rooms[0].area, 22.5, 0.5);
        suggest_release(&s);
    }
}

static void an_angled_wall_is_found(void **state)
{
    (void)state;
    static const double ROOM[5][2] = {{0, 0}, {5, 0}, {5, 2}, {3, 4}, {0, 4}};
    for (int noisy = 0; noisy < 2; noisy++) {
        struct made_plan p = made(noisy);
        struct suggestion s;
        made_line(&p, ROOM, 5, true);
        made_camera(&p, 1.5, 1.2);
        made_camera(&p, 3.5, 1.5);
        made_camera(&p, 1.8, 2.8);
        suggest_plan_of(&s, &p, 13);
        const struct suggested_wall *w = wall_at(&s, -M_SQRT1_2, -M_SQRT1_2, -7 * M_SQRT1_2, 0.05);
        assert_int_equal(s.wall_count, 5);
        assert_true(w->angled);
        assert_extent(w, ROOM[2], ROOM[3], 0.15);
        assert_true(s.room_count == 1 && s.rooms[0].closed);
        suggest_release(&s);
    }
}

/* A living room with a bay, and a kitchen beside it; the wall between them, 12 cm thick, leaves half of the width. */
static void an_open_plan_with_a_bay_is_found(void **state)
{
    (void)state;
    static const double PLAN[10][2] = {{0, 0},     {8, 0},     {8, 4}, {4, 4},   {3.4, 4},
                                       {2.8, 4.8}, {1.6, 4.8}, {1, 4}, {0.5, 4}, {0, 4}};
    for (int noisy = 0; noisy < 2; noisy++) {
        struct made_plan p = made(noisy);
        struct suggestion s;
        made_line(&p, PLAN, 10, true);
        made_box(&p, 4, 2, 4.12, 4, p.high);
        made_camera(&p, 1.5, 1.5);
        made_camera(&p, 2.2, 3.4);
        made_camera(&p, 3.2, 2.6);
        made_camera(&p, 5.5, 1.5);
        made_camera(&p, 6.5, 3);
        suggest_plan_of(&s, &p, 14);
        const double within = noisy ? 0.06 : 0.02;
        wall_at(&s, 0, 1, 0, within);
        wall_at(&s, 0, -1, -4, within);
        wall_at(&s, 1, 0, 0, within);
        wall_at(&s, -1, 0, -8, within);
        assert_extent(wall_at(&s, 0, -1, -4.8, within), PLAN[5], PLAN[6], 0.2);
        const struct suggested_wall *between = wall_at(&s, -1, 0, -4, within);
        assert_true(between->between);
        assert_float_equal(between->thickness, 0.12, 0.06);
        assert_extent(between, (const double[2]){4, 2}, (const double[2]){4, 4}, 0.2);
        wall_at(&s, -0.8, -0.6, -0.8 * 3.4 - 0.6 * 4, noisy ? 0.1 : 0.03);
        wall_at(&s, 0.8, -0.6, 0.8 * 1 - 0.6 * 4, noisy ? 0.1 : 0.03);
        assert_true(s.room_count == 1 && s.rooms[0].closed);
        suggest_release(&s);
    }
}

/* Boxes 0.4 m before the walls, up to 1.9 m, are no walls; the walls behind them are seen above. */
static void clutter_is_no_wall(void **state)
{
    (void)state;
    static const double ROOM[4][2] = {{0, 0}, {5, 0}, {5, 4}, {0, 4}};
    for (int noisy = 0; noisy < 2; noisy++) {
        struct made_plan p = made(noisy);
        struct suggestion s;
        made_line(&p, ROOM, 4, true);
        made_box(&p, 0, 0.8, 0.4, 3, 1.9);
        made_box(&p, 1, 3.6, 3.5, 4, 0.9);
        made_box(&p, 4.6, 1.5, 5, 2.5, 1.6);
        made_camera(&p, 1.5, 1.2);
        made_camera(&p, 3.5, 1.5);
        made_camera(&p, 2.5, 2.8);
        suggest_plan_of(&s, &p, 15);
        const double within = noisy ? 0.05 : 0.01;
        assert_int_equal(s.wall_count, 4);
        wall_at(&s, 0, 1, 0, within);
        wall_at(&s, 1, 0, 0, within);
        wall_at(&s, 0, -1, -4, within);
        wall_at(&s, -1, 0, -5, within);
        assert_true(s.room_count == 1 && s.rooms[0].closed);
        suggest_release(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_rooms_and_their_openings_are_found),
        cmocka_unit_test(a_wall_behind_furniture_has_its_thickness),
        cmocka_unit_test(a_closed_wall_has_no_doorway),
        cmocka_unit_test(the_number_of_rooms_is_not_limited),
        cmocka_unit_test(nothing_is_found_without_points),
        cmocka_unit_test(two_walls_are_found_alone),
        cmocka_unit_test(a_wall_that_is_mostly_blank_is_found_unless_a_camera_is_behind),
        cmocka_unit_test(an_l_shaped_room_is_found),
        cmocka_unit_test(an_angled_wall_is_found),
        cmocka_unit_test(an_open_plan_with_a_bay_is_found),
        cmocka_unit_test(clutter_is_no_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
