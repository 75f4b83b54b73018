/* model_plan.c - plan.txt: what is read is what was written; damaged lines are refused. */
#include "common/model/model_plan.h"

#include <math.h>

#include "tests/unit/scratch.h"

#define WALLS                                                                                          \
    "remodel-plan 1\n"                                                                                 \
    "wall s normal 0 1 at -0.5 thickness 0.25 from 0 to 5 foot 0 top 2.6 start corner e end free\n"    \
    "wall e normal -1 0 at -5 thickness 0.15 from -0.5 to 4 foot 0.1 top 2.5 start meets s end free\n" \
    "wall slant normal 0.6 0.8 at 4 thickness 0.15 from 0 to 4 foot 0 top 2.6 start free end free\n"

static void a_plan_is_read_whole(void **state)
{
    (void)state;
    struct model_plan plan;
    struct vec3 c[2];
    struct err err = ERR_INIT;
    assert_ok(
        model_plan_read(&plan,
                        scratch_write("plan.txt", WALLS
                                      "passage door on e from 1.5 0 to 2.5 2.1 open\n"
                                      "window sunny on s from 1 0.9 to 3 2.2 closed\n"
                                      "door odd on slant from 1 0 to 2 2 closed\n"
                                      "room a floor 0.1 ceiling 2.6 0.1 0 s 5 -0.5 e 5 4 gone 0 -0.5\n"
                                      "gable a ceiling 3.2 -0.1 0\n"
                                      "skylight sky on a from 1 2 to 2 3 closed\nhatch down on a from 3 1 to 4 2 open\n"
                                      "box b 0 0 0 1 2 3 turn 30\nlamp is of a later version\n"),
                        NULL, &err),
        err);
    assert_int_equal(plan.wall_count, 3);
    assert_int_equal(plan.walls[1].ends[0], MODEL_WALL_MEETS);
    assert_string_equal(plan.walls[1].neighbours[0], "s");
    assert_null(plan.walls[1].neighbours[1]);
    assert_true(plan.walls[1].foot == 0.1 && plan.walls[1].top == 2.5 && plan.walls[0].thickness == 0.25);
    assert_int_equal(plan.opening_count, 3);
    assert_int_equal(plan.openings[0].kind, MODEL_PASSAGE);
    assert_true(!plan.openings[0].closed && plan.openings[1].closed);
    assert_true(model_opening_corners(&plan, 0, c));
    assert_true(c[0].x == 5 && c[0].y == 1.5 && c[0].z == 0 && c[1].x == 5 && c[1].y == 2.5 && c[1].z == 2.1);
    assert_true(model_opening_corners(&plan, 1, c));
    assert_true(c[0].x == 1 && c[0].y == -0.5 && c[1].x == 3 && c[1].z == 2.2);
    assert_false(model_opening_corners(&plan, 2, c));
    assert_int_equal(plan.rooms[0].corner_count, 3);
    assert_int_equal(plan.rooms[0].corners[1].wall, 1);
    assert_int_equal(plan.rooms[0].corners[2].wall, -1); /* a wall that was removed */
    assert_string_equal(plan.rooms[0].corners[2].wall_name, "gone");
    assert_true(plan.rooms[0].floor == 0.1 && plan.rooms[0].ceilings == 2);
    assert_true(fabs(model_room_ceiling(&plan.rooms[0], 1, 0) - 2.7) < 1e-12);
    assert_true(fabs(model_room_ceiling(&plan.rooms[0], 5, 0) - 2.7) < 1e-12);
    assert_int_equal(plan.slot_count, 2);
    assert_true(plan.slots[0].skylight && plan.slots[0].closed && plan.slots[0].high[1] == 3);
    assert_true(!plan.slots[1].skylight && !plan.slots[1].closed && plan.slots[1].low[0] == 3);
    assert_true(plan.boxes[0].turn == 30 && plan.boxes[0].high.z == 3);
    model_plan_release(&plan);
    assert_null(plan.walls);
}

static void damaged_lines_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *error;
    } cases[] = {
        {"remodel-model 1\n", ":1: found \"remodel-model\""},
        {"remodel-plan 0\n", ":1: found"},
        {WALLS "window w on north from 1 0 to 2 2 open\n", ":5: found \"north\", wanted the name of a wall on a line"},
        {WALLS "room r floor 0 ceiling 2 0 0 s 1 1 e 2 2\n", "wanted a room of three corners or more"},
        {"remodel-plan 1\nwall a normal 1 1 at 0 thickness 1 from 0 to 1 foot 0 top 2 start free end free\n",
         "wanted a wall with a normal of length 1"},
        {"remodel-plan 1\nwall a normal 1 0 at 0 thickness 1 from 0 to 1 foot 0 top 2 start far end free\n",
         ":2: found \"far\", wanted free, corner or meets"},
        {"remodel-plan 1\nbox b 0 0 0 1 1\n", ":2: found"},
        {"remodel-plan 2\ngable a ceiling 1 0 0\n", ":2: found \"a\", wanted the name of a room on a line above"},
        {WALLS "room r floor 0 ceiling 2 0 0 s 1 1 e 2 2 s 0 2\ngable r ceiling 1 0 0\ngable r ceiling 1 0 0\n",
         ":7: found \"r\", wanted a room without a gable"},
        {WALLS "door d on s from 0 0 to 1 2 ajar\n", ":5: found \"ajar\", wanted open or closed"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct model_plan plan;
        struct err err = ERR_INIT;
        assert_int_equal(model_plan_read(&plan, scratch_write("plan.txt", cases[i].text), NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i].error);
        assert_int_equal(plan.wall_count + plan.room_count, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plan_is_read_whole),
        cmocka_unit_test(damaged_lines_are_refused),
    };
    return cmocka_run_group_tests_name("model_plan", tests, scratch_make, scratch_remove);
}
