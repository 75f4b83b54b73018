/* thing_list.c - the list of things: what is read is what was written; damaged lines are refused. */
#include "common/model/thing_list.h"

#include "tests/unit/scratch.h"

#define HEAD  "remodel-things 3\n"
#define RUG   "thing rug floor 0 0 0.25 1 2 0.5 100 2 v05 0 0 1 1 0 1e-05 3\n"
#define SOFA  "thing sofa floor 0 0.5 0 2 1.25 0.75 3100 7 v03 10 20.5 300 200 0.5 0.25 2\n"
#define SIDES "sides 1 2 3 4 5 6 7 8 9 10 11 12 0 0 0 1e-05 0.5 2\n"

static void what_is_read_is_written_again(void **state)
{
    (void)state;
    static const char text[] =
        HEAD SOFA SIDES "thing \"old lamp\" ceiling -1 -1 2 -0.5 -0.5 2.5 100 1 \"v 04\" 0 0 1 1 0 1e-05 3\n"
                        "sides 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3\n"
                        "thing shelf wall 1e-05 0 0 1 1 1 5000000000 2 v05 0 0 1 1 0 1e-05 3\n"
                        "sides 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3\n"
                        "thing cloud none 0 0 0 1 1 1 1 1 v05 -1.5 0 1 1 1 1 1\n"
                        "sides 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\n";
    struct thing_list list;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    assert_ok(thing_list_read(&list, scratch_write("things.txt", text), &prov, &err), err);
    assert_int_equal(list.count, 4);
    const struct thing *t = &list.things[0];
    assert_string_equal(t->name, "sofa");
    assert_string_equal(t->view, "v03");
    assert_true(t->low.x == 0 && t->low.y == 0.5 && t->low.z == 0);
    assert_true(t->high.x == 2 && t->high.y == 1.25 && t->high.z == 0.75);
    assert_true(t->voxels == 3100 && t->views == 7);
    assert_true(t->rect[0] == 10 && t->rect[1] == 20.5 && t->rect[2] == 300 && t->rect[3] == 200);
    assert_true(t->radiance[0] == 0.5 && t->radiance[1] == 0.25 && t->radiance[2] == 2);
    assert_true(t->sides[0][0] == 1 && t->sides[3][2] == 12 && t->sides[5][1] == 0.5);
    assert_true(list.things[3].sides[4][2] == 1);
    for (int i = 0; i < 4; i++)
        assert_int_equal(list.things[i].support,
                         ((int[]){THING_ON_FLOOR, THING_ON_CEILING, THING_ON_WALL, THING_ON_NONE})[i]);
    assert_string_equal(thing_support_word(list.things[1].support), "ceiling");
    assert_true(list.things[2].voxels == 5000000000);
    assert_int_equal(thing_list_find(&list, "old lamp"), 1);
    assert_int_equal(thing_list_find(&list, "old"), -1);
    assert_int_equal(prov.count, 1);
    assert_string_equal(prov.inputs[0].name, "things.txt");
    assert_ok(thing_list_write(&list, scratch_path("again.txt"), NULL, &err), err);
    assert_file_text(scratch_path("again.txt"), text);
    provenance_release(&prov);
    thing_list_release(&list);
    assert_null(list.things);
    assert_int_equal(list.count, 0);
    thing_list_release(&list);
    thing_list_release(NULL);
}

static void a_list_may_be_empty(void **state)
{
    (void)state;
    struct thing_list list = {0};
    struct err err = ERR_INIT;
    assert_ok(thing_list_write(&list, scratch_path("empty.txt"), NULL, &err), err);
    assert_file_text(scratch_path("empty.txt"), HEAD);
    assert_ok(thing_list_read(&list, scratch_path("empty.txt"), NULL, &err), err);
    assert_int_equal(list.count, 0);
    assert_int_equal(thing_list_find(&list, "sofa"), -1);
}

static void a_thing_that_is_added_is_owned(void **state)
{
    (void)state;
    struct thing_list list = {0};
    struct thing t = {.name = strdup("a"), .view = strdup("v"), .views = 1}, half = {.name = strdup("b")};
    struct err err = ERR_INIT;
    assert_ok(thing_list_add(&list, &t, &err), err);
    assert_int_equal(list.count, 1);
    assert_string_equal(list.things[0].name, "a");
    assert_null(t.name);
    assert_null(t.view);
    assert_int_equal(thing_list_add(&list, &half, &err), ST_NOMEM); /* a text that could not be copied */
    assert_null(half.name);
    assert_int_equal(list.count, 1);
    thing_list_release(&list);
}

static void the_outline_of_what_lies_flat_is_kept(void **state)
{
    (void)state;
    static const char text[] = HEAD RUG "sides 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3 0 1e-05 3\n"
                                        "flat 0 0 1 0.25 4 0 0 1 0.5 1 2 -0.10000000000000001 1\n" SOFA SIDES
                                        "thing sign wall 0 0 0 1 1 1 9 1 v05 0 0 1 1 1 1 1\n"
                                        "sides 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\n"
                                        "flat -0.59999999999999998 -0.80000000000000004 0 -2 3 0 0 1 0 1 1\n";
    struct thing_list list;
    struct err err = ERR_INIT;
    assert_ok(thing_list_read(&list, scratch_write("things.txt", text), NULL, &err), err);
    assert_int_equal(list.count, 3);
    const struct flat_outline *rug = &list.things[0].outline, *sign = &list.things[2].outline;
    assert_int_equal(rug->count, 4);
    assert_true(rug->normal.z == 1 && rug->offset == 0.25);
    const struct vec3 corner = flat_outline_corner(rug, 3);
    assert_true(corner.x == -0.1 && corner.y == 1 && corner.z == 0.25);
    assert_int_equal(list.things[1].outline.count, 0);
    assert_true(sign->count == 3 && sign->normal.y == -0.8 && sign->offset == -2);
    /* its normal is largest in y, so corners are X and Z */
    assert_float_equal(flat_outline_corner(sign, 1).y, (2 - 0.6) / 0.8, 1e-12);
    assert_true(flat_outline_corner(sign, 2).z == 1);
    assert_ok(thing_list_write(&list, scratch_path("again.txt"), NULL, &err), err);
    assert_file_text(scratch_path("again.txt"), text);
    thing_list_release(&list);
}

/* Half way between two sides what faces there has the mean of both; without a line of sides all have the thing's. */
static void sides_are_blended_by_where_a_surface_faces(void **state)
{
    struct thing_list list;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(thing_list_read(&list, scratch_write("things.txt", HEAD SOFA SIDES RUG), NULL, &err), err);
    const struct vec3 east = thing_radiance_of_side(&list.things[0], vec3_make(1, 0, 0));
    const struct vec3 between = thing_radiance_of_side(&list.things[0], vec3_make(sqrt(0.5), -sqrt(0.5), 0));
    const struct vec3 unknown = thing_radiance_of_side(&list.things[0], vec3_make(0, 0, 0));
    const struct vec3 rug = thing_radiance_of_side(&list.things[1], vec3_make(0, 0.6, -0.8));
    assert_true(east.x == 1 && east.y == 2 && east.z == 3);
    assert_float_equal(between.x, (1 + 10) / 2.0, 1e-12);
    assert_float_equal(between.z, (3 + 12) / 2.0, 1e-12);
    assert_true(unknown.x == 0.5 && unknown.y == 0.25 && unknown.z == 2);
    assert_float_equal(rug.z, 3, 1e-12);
    thing_list_release(&list);
}

static void damaged_lines_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *error;
    } cases[] = {
        {"", "found an empty file, wanted"},
        {"remodel-objects 1\n", "things.txt:1: found \"remodel-objects\""},
        {"remodel-things 4\n", "things.txt:1: found \"4\""},
        {HEAD SOFA "chair sofa\n", "things.txt:3: found \"chair\", wanted thing, sides or flat"},
        {HEAD "thing\n", "things.txt:2: found the end of the line, wanted name"},
        {HEAD "thing sofa\n", "things.txt:2: found the end of the line, wanted what it stands on"},
        {HEAD "thing sofa roof 0 0 0 1 1 1 1 1 v 0 0 1 1\n",
         "things.txt:2: found \"roof\", wanted floor, wall, ceiling or none"},
        {HEAD "thing sofa floor 0 0 x 1 1 1 1 1 v 0 0 1 1\n", "things.txt:2: found \"x\", wanted corner of the box"},
        {HEAD "thing sofa floor 0 0 nan 1 1 1 1 1 v 0 0 1 1\n", "things.txt:2: found \"nan\""},
        {HEAD "thing sofa floor 0 0 0 1 1\n", "things.txt:2: found the end of the line, wanted corner of the box"},
        {HEAD "thing sofa floor 0 0 0 1 0 1 1 1 v 0 0 1 1\n",
         "things.txt:2: found \"a box without size\", wanted a lower corner, then an upper one"},
        {HEAD "thing sofa floor 0 2 0 1 1 1 1 1 v 0 0 1 1\n", "things.txt:2: found \"a box without size\""},
        {HEAD "thing sofa floor 0 0 0 1 1 1 0 1 v 0 0 1 1\n", "things.txt:2: found \"0\", wanted voxels"},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1.5 1 v 0 0 1 1\n", "things.txt:2: found \"1.5\", wanted voxels"},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 -1 v 0 0 1 1\n", "things.txt:2: found \"-1\", wanted views"},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 1 v 3 0 1 1\n", "things.txt:2: found \"a rectangle without size\""},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 1 v 0 0 1 1 1 -1 1\n",
         "things.txt:2: found \"-1\", wanted mean radiance"},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 3000000000 v 0 0 1 1\n",
         "things.txt:2: found \"3000000000\", wanted views"},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 1\n", "things.txt:2: found the end of the line, wanted view"},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 1 v 0 0 1\n",
         "things.txt:2: found the end of the line, wanted edge of the rectangle"},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 1 v 0 0 inf 1\n", "things.txt:2: found \"inf\""},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 1 v 0 0 1 1 1 1\n",
         "things.txt:2: found the end of the line, wanted mean radiance"},
        {HEAD "thing sofa floor 0 0 0 1 1 1 1 1 v 0 0 1 1 1 1 1 7\n", "things.txt:2: found \"7\""},
        {HEAD "flat 0 0 1 0 3 0 0 1 0 1 1\n", "things.txt:2: found \"flat\", wanted a line \"thing\" before it"},
        {HEAD RUG "flat 0 0 1 0 3 0 0 1 0 1 1\nflat 0 0 1 0 3 0 0 1 0 1 1\n", "things.txt:4: found \"flat\""},
        {HEAD SIDES, "things.txt:2: found \"sides\", wanted a line \"thing\" before it"},
        {HEAD SOFA "sides 1 2 3\n", "things.txt:3: found the end of the line, wanted radiance of a side"},
        {HEAD SOFA "sides 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 -9\n", "things.txt:3: found \"-9\""},
        {HEAD RUG "flat 0 0 2 0 3 0 0 1 0 1 1\n", "things.txt:3: found \"2\", wanted a normal of length 1"},
        {HEAD RUG "flat 0 0 1 inf 3 0 0 1 0 1 1\n", "things.txt:3: found \"inf\""},
        {HEAD RUG "flat 0 0 1 0 2 0 0 1 0\n", "things.txt:3: found \"2\", wanted a number of corners"},
        {HEAD RUG "flat 0 0 1 0 3 0 0 1 0 1\n",
         "things.txt:3: found the end of the line, wanted coordinate of a corner"},
        {HEAD RUG "flat 0 0 1 0 3 0 0 1 0 1 1 0\n", "things.txt:3: found \"0\", wanted the end of the line"},
        {HEAD SOFA "# again\n" SOFA, "things.txt:4: found \"sofa\", wanted another name than those above"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct thing_list list;
        struct err err = ERR_INIT;
        assert_int_equal(thing_list_read(&list, scratch_write("things.txt", cases[i].text), NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i].error);
        assert_null(list.things);
        assert_int_equal(list.count, 0);
    }
}

static void a_name_with_a_line_break_is_not_written(void **state)
{
    (void)state;
    struct thing t = {.name = (char *)"a\nb", .view = (char *)"v", .views = 1};
    const struct thing_list list = {&t, 1};
    struct err err = ERR_INIT;
    assert_int_equal(thing_list_write(&list, scratch_path("broken.txt"), NULL, &err), ST_DATA);
    assert_int_equal(access(scratch_path("broken.txt"), F_OK), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_read_is_written_again),
        cmocka_unit_test(a_list_may_be_empty),
        cmocka_unit_test(a_thing_that_is_added_is_owned),
        cmocka_unit_test(the_outline_of_what_lies_flat_is_kept),
        cmocka_unit_test(sides_are_blended_by_where_a_surface_faces),
        cmocka_unit_test(damaged_lines_are_refused),
        cmocka_unit_test(a_name_with_a_line_break_is_not_written),
    };
    return cmocka_run_group_tests_name("thing_list", tests, scratch_make, scratch_remove);
}
