/* room_heights.c - rooms of different heights: each is compared with the true room that it lies in. */
#include "stages/evaluate/model/room_heights.h"

#include <math.h>

#include "tests/unit/scratch.h"

static void each_room_has_its_own_height(void **state)
{
    (void)state;
    struct measured_part truth[] = {{"a", "", {{0, 0, 0}, {5, 4, 2.6}}}, {"b", "", {{8, 4, 0.4}, {5, 0, 3.4}}}};
    struct measured_part model[] = {{"x", "", {{6.5, 2, 0.37}, {6.5, 2, 3.45}}},
                                    {"y", "", {{2, 2, 0.01}, {2, 2, 2.58}}},
                                    {"z", "", {{12, 2, 0}, {12, 2, 2.6}}}};
    const struct measured_parts found = {model, 3}, wanted = {truth, 2};
    const struct room_height_errors e = room_heights_compare(&found, &wanted);
    assert_int_equal(e.rooms, 2);
    assert_int_equal(e.outside, 1);
    assert_true(fabs(e.floor - 0.03) < 1e-12 && fabs(e.ceiling - 0.05) < 1e-12);
}

static void the_middle_of_a_model_room_is_that_of_its_area(void **state)
{
    (void)state;
    struct measured_plan plan;
    struct err err = ERR_INIT;
    /* a sloping ceiling: 2 + x / 2, and corners that are not spread evenly */
    assert_ok(
        wall_plan_read(&plan,
                       scratch_write("plan.txt",
                                     "remodel-plan 1\n"
                                     "wall s normal 0 1 at 0 thickness 1 from 0 to 1 foot 0 top 2 start free end free\n"
                                     "room r floor 0.5 ceiling 2 0.5 0 s 0 0 s 1 0 s 4 0 s 4 2 s 0 2\n"),
                       PLAN_FROM_MODEL, &err),
        err);
    assert_int_equal(plan.rooms.count, 1);
    const struct vec3 *at = plan.rooms.parts[0].at;
    assert_true(fabs(at[0].x - 2) < 1e-12 && fabs(at[0].y - 1) < 1e-12 && at[0].z == 0.5);
    assert_true(fabs(at[1].z - 3) < 1e-12);
    wall_plan_release(&plan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_room_has_its_own_height),
        cmocka_unit_test(the_middle_of_a_model_room_is_that_of_its_area),
    };
    return cmocka_run_group_tests_name("room_heights", tests, scratch_make, scratch_remove);
}
