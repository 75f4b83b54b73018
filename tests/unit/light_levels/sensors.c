/* sensors.c - points of work planes and floors: what stands in them and over them, and how high they are where a metre
 * is a guess. */
#include "tests/unit/level_room.h"

#include "stages/light_levels/sensors.h"

/* A room of 4 x 4 x 1.9 m with a table, and a cupboard that goes through the work plane. */
static const struct box furnished[] = {{"walls", "out", {-1, -1, -1}, {5, 5, 3}, false},
                                       {"walls", "ceiling", {0, 0, 0}, {4, 4, 1.9}, true},
                                       {"table", "top", {0.9, 0.9, 0.65}, {3.1, 2.1, 0.7}, false},
                                       {"cupboard", "body", {2.8, 2.8, 0}, {3.9, 3.9, 1.5}, false}};
static char room_name[] = "hall";
static struct model_room_corner corners[] = {{.x = 0, .y = 0}, {.x = 4, .y = 0}, {.x = 4, .y = 4}, {.x = 0, .y = 4}};
static struct model_room hall = {
    .name = room_name, .ceiling = {{1.9, 0, 0}}, .ceilings = 1, .corners = corners, .corner_count = 4};

static struct sensors sensors_of(const struct room *r, const struct model_metre *metre)
{
    const struct model_plan plan = {.rooms = &hall, .room_count = 1};
    const struct place_list places = {.count = 0};
    const struct levels_params params = LEVELS_PARAMS_DEFAULT;
    struct sensors s;
    struct err err = ERR_INIT;
    assert_ok(sensors_make(&s, &r->field, &plan, &places, &params, metre, &err), err);
    return s;
}

/* Of the 7 x 7 points of the lattice 4 lie in the cupboard, and on the floor 15 below the table. */
static void points_below_furniture_are_told_apart_and_those_inside_left_out(void **state)
{
    static const enum sensor_kind kinds[] = {SENSOR_WORK_PLANE, SENSOR_FLOOR, SENSOR_FLOOR_COVERED};
    static const int counts[] = {45, 30, 15};
    struct room r;
    (void)state;
    start(&r, furnished, 4);
    struct sensors s = sensors_of(&r, &(struct model_metre){1, 1, 1, false});
    assert_int_equal(s.area_count, 3);
    for (int k = 0; k < 3; k++) {
        assert_int_equal(s.areas[k].kind, kinds[k]);
        assert_int_equal(s.areas[k].count, counts[k]);
        assert_near(s.points[s.areas[k].first].at.z, k ? 0.01 : 0.75, 1e-12);
    }
    for (int i = 0; i < s.areas[2].count; i++) {
        const struct vec3 at = s.points[s.areas[2].first + i].at;
        assert_true(at.x > 0.9 && at.x < 3.1 && at.y > 0.9 && at.y < 2.1);
    }
    assert_string_equal(sensor_kind_word(SENSOR_FLOOR_COVERED), "floor-covered");
    sensors_release(&s);
    release(&r);
}

/* Half a unit a metre: planes 0.375 units up, and at both ends of the guess; points a quarter of a unit apart. */
static void a_guessed_metre_sets_heights_and_distances(void **state)
{
    struct room r;
    (void)state;
    start(&r, furnished, 2);
    struct sensors s = sensors_of(&r, &(struct model_metre){0.5, 0.4, 0.6, true});
    static const double heights[] = {0.375, 0.3, 0.45, 0.005};
    assert_int_equal(s.area_count, 4);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(s.areas[k].count, 15 * 15);
        assert_near(s.areas[k].step, 0.25, 1e-12);
        assert_near(s.points[s.areas[k].first].at.z, heights[k], 1e-12);
    }
    assert_int_equal(s.areas[1].kind, SENSOR_WORK_PLANE_LOW);
    assert_int_equal(s.areas[2].kind, SENSOR_WORK_PLANE_HIGH);
    assert_int_equal(s.areas[3].kind, SENSOR_FLOOR);
    sensors_release(&s);
    release(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_below_furniture_are_told_apart_and_those_inside_left_out),
        cmocka_unit_test(a_guessed_metre_sets_heights_and_distances),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
