/* wall_plan.c - walls and openings of a model against those of a truth: errors are the known shifts. */
#include "stages/evaluate/truth/wall_plan.h"

#include "tests/unit/scratch.h"

/* Two rooms, x 0..5 and 5.15..8.65, y 0..4; `off` moves the south wall outwards, and the door along its wall. */
static struct measured_plan model(double off, struct err *err)
{
    char text[4096];
    struct measured_plan plan = {0};
    snprintf(
        text, sizeof text,
        "remodel-plan 1\n"
        "wall south normal 0 1 at %.17g thickness 0.25 from 0 to 8.65 foot 0 top 2.6 start corner west end corner e\n"
        "wall partition normal -1 0 at -5 thickness 0.15 from 0 to 4 foot 0 top 2.6 start meets n end meets s\n"
        "wall slant normal 0.6 0.8 at 90 thickness 0.15 from 0 to 4 foot 0 top 2.6 start free end free\n"
        "wall east normal -1 0 at -8.65 thickness 0.25 from 0 to 4 foot 0 top 2.6 start free end free\n"
        "wall north normal 0 -1 at -4 thickness 0.25 from 0 to 8.65 foot 0 top 2.6 start free end free\n"
        "wall west normal 1 0 at 0 thickness 0.25 from 0 to 4 foot 0 top 2.6 start free end free\n"
        "passage door on partition from %.17g 0 to %.17g 2.1 open\n"
        "window sunny on south from 1.5 0.9 to 3.3 2.2 closed\n"
        "window odd on slant from 1 1 to 2 2 closed\n"
        "room living floor 0 ceiling 2.6 0 0 south 5 %.17g partition 5 4 north 0 4 west 0 %.17g\n"
        "room study floor 0 ceiling 2.6 0 0 south 8.65 %.17g east 8.65 4 north 5.15 4 partition 5.15 %.17g\n"
        "box b 0 0 0 1 1 1 turn 0\n",
        -off, 1.6 + off, 2.5 + off, -off, -off, -off, -off);
    assert_ok(wall_plan_read(&plan, scratch_write("plan.txt", text), PLAN_FROM_MODEL, err), *err);
    assert_int_equal(plan.faces.count, 8);
    assert_int_equal(plan.openings.count, 2); /* the window in the angled wall is left out */
    assert_int_equal(plan.rooms.count, 2);
    return plan;
}

static const char *const FRAMED = "yaw_degrees 23\nt 3 1 0.8\nliving 0 0 0 5 4 2.6\nstudy 5.15 0 0 8.65 4 2.6\n"
                                  "partition x 5 5.15\ndoor y 1.6 2.5 top 2.1\nwindow_south x 1.5 3.3 z 0.9 2.2\n"
                                  "window_east y 1.4 2.4 z 0.9 2\nexterior_wall_thickness 0.25\nlamp centre 1 2 3\n";
static const char *const DESCRIBED = "remodel-scene 1\nroom living 0 0 5.075 4 0 2.6 f c\n"
                                     "wall south -0.125 -0.125 8.775 -0.125 0 2.6 0.25 white\n"
                                     "wall east 8.775 -0.125 8.775 4.125 0 2.6 0.25 white\n"
                                     "wall north 8.775 4.125 -0.125 4.125 0 2.6 0.25 white\n"
                                     "wall west -0.125 4.125 -0.125 -0.125 0 2.6 0.25 white\n"
                                     "wall partition 5.075 0 5.075 4 0 2.6 0.15 white\n"
                                     "opening door partition 1.6 2.5 0 2.1\nwindow sunny south 1.625 3.425 0.9 2.2\n"
                                     "window light east 1.525 2.525 0.9 2\n";

static void errors_are_the_known_shifts(void **state)
{
    (void)state;
    const struct {
        const char *text;
        enum measured_plan_kind kind;
    } truths[] = {{FRAMED, PLAN_FROM_SCENE_TRUTH}, {DESCRIBED, PLAN_FROM_SCENE}};
    for (int i = 0; i < 2; i++)
        for (double off = 0; off < 0.05; off += 0.03) {
            struct err err = ERR_INIT;
            struct measured_plan found = model(off, &err), truth = {0};
            struct wall_errors e = {0};
            assert_ok(wall_plan_read(&truth, scratch_write("truth.txt", truths[i].text), truths[i].kind, &err), err);
            assert_ok(wall_errors_find(&e, &found, &truth, 0.5, &err), err);
            assert_int_equal(e.faces.count, 8);
            assert_int_equal(e.openings.count, 2);
            assert_true(e.faces.errors[0] < 1e-9 && fabs(e.faces.errors[7] - off) < 1e-9);
            assert_true(e.openings.errors[0] < 1e-9 && fabs(e.openings.errors[1] - off) < 1e-9);
            assert_int_equal(e.extra, 0);
            assert_int_equal(e.missing, 1); /* the east window */
            if (off > 0) {
                assert_string_equal(e.faces.worst, "south");
                assert_string_equal(e.openings.worst, "door");
            }
            wall_errors_release(&e);
            wall_plan_release(&truth);
            wall_plan_release(&found);
        }
}

static void an_edge_of_a_removed_wall_is_no_face(void **state)
{
    (void)state;
    struct measured_plan plan;
    struct err err = ERR_INIT;
    assert_ok(
        wall_plan_read(&plan,
                       scratch_write("plan.txt",
                                     "remodel-plan 2\n"
                                     "wall s normal 0 1 at 0 thickness 1 from 0 to 1 foot 0 top 2 start free end free\n"
                                     "room r floor 0 ceiling 2 0 0 s 4 0 gone 4 2 s 0 2\n"),
                       PLAN_FROM_MODEL, &err),
        err);
    assert_int_equal(plan.faces.count, 2);
    assert_true(plan.faces.parts[1].at[0].x == 4 && plan.faces.parts[1].at[0].y == 2);
    wall_plan_release(&plan);
}

static void extra_and_missing_parts_are_counted(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct measured_plan found = model(0.6, &err), truth = {0};
    struct wall_errors e = {0};
    assert_ok(wall_plan_read(&truth, scratch_write("truth.txt", FRAMED), PLAN_FROM_SCENE_TRUTH, &err), err);
    assert_ok(wall_errors_find(&e, &found, &truth, 0.5, &err), err);
    assert_int_equal(e.extra, 4); /* the south walls of both rooms, the door, the window */
    assert_int_equal(e.missing, 3);
    assert_int_equal(e.faces.count, 6);
    wall_errors_release(&e);
    wall_plan_release(&truth);
    wall_plan_release(&found);
}

static void an_edit_changes_its_base(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct measured_plan plan = {0};
    scratch_write("scene.txt", DESCRIBED);
    const char *path =
        scratch_write("scene-e.txt", "remodel-scene 2\nbase scene.txt\ndrop partition chair\ndrop light\n"
                                     "wall across 6 0 6 4 0 2.6 0.12 white\nopening new across 1 2 0 2\n"
                                     "room loft 0 0 4 4 0 3 f c\n");
    assert_ok(wall_plan_read(&plan, path, PLAN_FROM_SCENE, &err), err);
    assert_int_equal(plan.faces.count, 10); /* both sides of south, east, north, west, across */
    assert_string_equal(plan.faces.parts[9].name, "across");
    assert_int_equal(plan.openings.count, 2); /* the partition's door went with it, the window by its name */
    assert_string_equal(plan.openings.parts[0].name, "sunny");
    assert_string_equal(plan.openings.parts[1].name, "new");
    assert_int_equal(plan.rooms.count, 2);
    wall_plan_release(&plan);
    /* the base may lie in the folder above, as beside an edited truth */
    assert_int_equal(mkdir(scratch_path("edited-e"), 0777), 0);
    path = scratch_write("edited-e/scene.txt", "remodel-scene 2\nbase scene.txt\ndrop south\n");
    assert_ok(wall_plan_read(&plan, path, PLAN_FROM_SCENE, &err), err);
    assert_int_equal(plan.faces.count, 8);
    assert_int_equal(plan.openings.count, 2); /* the door and the east window */
    wall_plan_release(&plan);
}

static void furniture_is_what_is_switched_on(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct measured_plan plan = {0};
    scratch_write("scene.txt",
                  "remodel-scene 2\nquad poster 0 0 1  1 0 0  0 0 1  p\nfurniture on\nbox desk 0 0 0 1 1 1 m\n"
                  "quad row1 0 0 1  1 0 0  0 0 1  p\nfurniture off\nquad map 0 0 1  1 0 0  0 0 1  p\n");
    const char *path =
        scratch_write("scene-e.txt", "remodel-scene 2\nbase scene.txt\ndrop row1\nbox beam 0 0 2 1 1 3 m\n"
                                     "furniture on\nbox chair 0 0 0 1 1 1 m\n");
    assert_ok(wall_plan_read(&plan, path, PLAN_FROM_SCENE, &err), err);
    assert_int_equal(plan.furniture.count, 2);
    assert_true(wall_plan_has(&plan.furniture, "desk.top") && wall_plan_has(&plan.furniture, "chair.left"));
    assert_false(wall_plan_has(&plan.furniture, "desk") || wall_plan_has(&plan.furniture, "desks.top"));
    wall_plan_release(&plan);
}

static void broken_lines_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *error;
        enum measured_plan_kind kind;
    } cases[] = {
        {"remodel-plan 1\nwall a normal 0 1 in 3\n", ":2: found \"in\", wanted \"at\"", PLAN_FROM_MODEL},
        {"remodel-scene 2\nbase nowhere.txt\n", ":2: its base: ", PLAN_FROM_SCENE},
        {"remodel-scene 2\nbase ../scene.txt\n", "wanted the name of a file without its folder", PLAN_FROM_SCENE},
        {"remodel-scene 2\nbase\n", ":2:", PLAN_FROM_SCENE},
        {"wall a 1 1 1 1 0 2 0.3 m\n", "wanted a wall with a length", PLAN_FROM_SCENE},
        {"\nopening d nowhere 0 1 0 2\n", ":2: found \"nowhere\"", PLAN_FROM_SCENE},
        {"door y 1 2 top 2\n", "wanted a partition on a line above", PLAN_FROM_SCENE_TRUTH},
        {"partition z 1 2\n", "wanted x or y", PLAN_FROM_SCENE_TRUTH},
        {"window_south x 1 2 z 1 2\n", "wanted a room on a line above", PLAN_FROM_SCENE_TRUTH},
        {"a 0 0 0 1 1 1\nwindow_south y 1 2 z 1 2\n", "wanted the axis along its wall", PLAN_FROM_SCENE_TRUTH},
        {"a 1 0 0 0 1 1\n", "wanted a room with x0 < x1", PLAN_FROM_SCENE_TRUTH},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct measured_plan plan = {0};
        struct err err = ERR_INIT;
        assert_int_equal(wall_plan_read(&plan, scratch_write("plan.txt", cases[i].text), cases[i].kind, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i].error);
        assert_int_equal(plan.faces.count + plan.openings.count, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_the_known_shifts),         cmocka_unit_test(an_edge_of_a_removed_wall_is_no_face),
        cmocka_unit_test(extra_and_missing_parts_are_counted), cmocka_unit_test(an_edit_changes_its_base),
        cmocka_unit_test(furniture_is_what_is_switched_on),    cmocka_unit_test(broken_lines_are_refused),
    };
    return cmocka_run_group_tests_name("wall_plan", tests, scratch_make, scratch_remove);
}
