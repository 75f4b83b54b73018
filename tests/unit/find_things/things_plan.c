/* things_plan.c - things on the plan: boxes, names that do not hide each other, what hangs dashed. */
#include "stages/find_things/things_plan.h"

#include "tests/unit/scratch.h"

static struct thing thing_of(const char *name, enum thing_support support, double x0, double y0, double x1, double y1)
{
    return (struct thing){.name = (char *)name, .support = support, .low = {x0, y0, 0}, .high = {x1, y1, 1}};
}

/* The caller frees the text. */
static char *plan_of(struct thing *things, int count, const struct model_plan *plan)
{
    const struct thing_list list = {things, count};
    const char *path = scratch_path("plan.svg");
    struct err err = ERR_INIT;
    assert_ok(things_plan_write(&list, plan, path, &err), err);
    return scratch_read(path);
}

static struct model_room_corner corners[] = {
    {.x = -3, .y = -2}, {.x = 3, .y = -2}, {.x = 3, .y = 2}, {.x = -3, .y = 2}};
static struct model_room hall = {.name = (char *)"hall", .corners = corners, .corner_count = 4};
static const struct model_plan one_room = {.rooms = &hall, .room_count = 1};

static void things_are_boxes_with_names(void **state)
{
    struct thing things[] = {thing_of("a < b", THING_ON_FLOOR, -3, -2, -1, -1),
                             thing_of("lamp", THING_ON_CEILING, 0, 0, 1, 1),
                             thing_of("shelf", THING_ON_WALL, 1, 1.5, 2, 2)};
    char *text = plan_of(things, 3, &one_room);
    (void)state;
    assert_contains(text, "<path class=\"room\"");
    assert_contains(text, ">hall</text>");
    /* 1000 px are 6 model units and 8 % on either side; y is up */
    assert_contains(text, "<path class=\"thing\" d=\"M68.97 643.68L356.32 643.68L356.32 500.00L68.97 500.00Z\"/>");
    assert_contains(text, "<path class=\"thing hung high\" d=\"M500.00 356.32L");
    assert_contains(text, "<path class=\"thing hung\" d=\"");
    assert_contains(text, ">a &lt; b</text>");
    assert_contains(text, "class=\"label high\"");
    assert_true(strstr(text, "thing hung high") < strstr(text, "\"thing\"")); /* drawn below it */
    free(text);
}

static void names_keep_apart(void **state)
{
    struct thing things[] = {thing_of("table", THING_ON_FLOOR, -1, -1, 1, 1),
                             thing_of("lamp", THING_ON_CEILING, -1, -1, 1, 1),
                             thing_of("vase", THING_ON_FLOOR, -1, -1, 1, 1)};
    char *text = plan_of(things, 3, &one_room);
    (void)state;
    assert_contains(text, "x=\"500.00\" y=\"360.82\">table<");
    assert_contains(text, "x=\"500.00\" y=\"375.82\">vase<");
    assert_contains(text, "x=\"500.00\" y=\"345.82\">lamp<");
    free(text);
}

static void a_sheet_holds_things_outside_of_rooms(void **state)
{
    struct thing far = thing_of("far", THING_ON_FLOOR, 8, -1, 9, 1);
    const struct model_plan nothing = {0};
    char *text = plan_of(&far, 1, &one_room);
    (void)state;
    /* 1000 px are 12 model units and 8 % on either side */
    assert_contains(text, "<path class=\"thing\" d=\"M859.20 ");
    free(text);
    text = plan_of(&far, 1, &nothing);
    assert_contains(text, ">far</text>");
    assert_lacks(text, "nan");
    free(text);
    text = plan_of(NULL, 0, &nothing);
    assert_contains(text, "</svg>");
    assert_lacks(text, "nan");
    assert_lacks(text, "inf");
    free(text);
}

static void a_path_that_cannot_be_written_is_named(void **state)
{
    const struct thing_list none = {0};
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("file", "");
    assert_int_not_equal(things_plan_write(&none, &one_room, scratch_path("file/plan.svg"), &err), ST_OK);
    assert_contains(err.text, "file");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(things_are_boxes_with_names),
        cmocka_unit_test(names_keep_apart),
        cmocka_unit_test(a_sheet_holds_things_outside_of_rooms),
        cmocka_unit_test(a_path_that_cannot_be_written_is_named),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
