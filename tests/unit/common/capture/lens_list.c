/* lens_list.c - lenses.txt: round trip and errors. */
#include "tests/unit/scratch.h"

#include "common/capture/lens_list.h"

static void a_list_round_trips(void **state)
{
    (void)state;
    char names[3][16] = {"a", "b@0", "b@1"};
    struct lens lenses[] = {
        {names[0], names[0], {CAMERA_SIMPLE_RADIAL, 640, 480, {500.1, 320, 240, -1.0 / 3}}, {1, 0, 0, 0}},
        {names[1], names[0], {CAMERA_OPENCV_FISHEYE, 2000, 1000, {6, 7, 8, 9, 1e-9, 2, 3, 4}}, {1, 0, 0, 0}},
        {names[2],
         names[0],
         {CAMERA_PINHOLE, 64, 48, {60, 61, 32, 24}},
         {0.70710678118654752, 0, -0.70710678118654752, 0}},
    };
    struct lens_list list = {lenses, 3}, back;
    struct err err = ERR_INIT;
    const char *path = scratch_path("lenses.txt");
    assert_ok(lens_list_write(&list, path, NULL, &err), err);
    assert_ok(lens_list_read(&back, path, NULL, &err), err);
    assert_int_equal(back.count, 3);
    for (int i = 0; i < 3; i++) {
        assert_string_equal(back.lenses[i].view, lenses[i].view);
        assert_string_equal(back.lenses[i].photo, lenses[i].photo);
        assert_int_equal(back.lenses[i].camera.model, lenses[i].camera.model);
        assert_int_equal(back.lenses[i].camera.height, lenses[i].camera.height);
        assert_memory_equal(back.lenses[i].camera.params, lenses[i].camera.params, sizeof lenses[i].camera.params);
        assert_memory_equal(&back.lenses[i].view_from_photo, &lenses[i].view_from_photo, sizeof(struct quat));
        assert_int_equal(lens_list_find(&back, lenses[i].view), i);
    }
    assert_int_equal(lens_list_find(&back, "b"), -1);
    lens_list_release(&back);
    lens_list_release(&back);
    lens_list_release(NULL);
}

static void errors_name_the_line(void **state)
{
    (void)state;
#define HEAD "remodel-lenses 1\n"
#define GOOD "a a SIMPLE_PINHOLE 4 3 5 2 1.5 turn 1 0 0 0\n"
    static const struct {
        const char *text, *message;
    } bad[] = {
        {"", "a line \"remodel-lenses ...\""},
        {"remodel-views 1\n", "found \"remodel-views\""},
        {"remodel-lenses 2\n", "found \"2\""},
        {HEAD, "a line for each view"},
        {HEAD GOOD GOOD, "lenses.txt:3: found view a after a"},
        {HEAD "a a DIVISION 4 3 5 2 1.5 turn 1 0 0 0\n", "found \"DIVISION\""},
        {HEAD "a a SIMPLE_PINHOLE 4 3 0 2 1.5 turn 1 0 0 0\n", "focal length is 0"},
        {HEAD "a a SIMPLE_PINHOLE 4 3 5 2 1.5 turned 1 0 0 0\n", "found \"turned\""},
        {HEAD "a a SIMPLE_PINHOLE 4 3 5 2 1.5 turn 1 0 0 1\n", "a turn of length 1.41"},
        {HEAD "a a SIMPLE_PINHOLE 4 3 5 2 1.5 turn 1 0 0\n", "end of the line"},
        {HEAD "a a SIMPLE_PINHOLE 4 3 5 2 1.5 turn 1 0 0 0 0\n", "wanted the end of the line"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct lens_list list;
        struct err err = ERR_INIT;
        assert_int_not_equal(lens_list_read(&list, scratch_write("lenses.txt", bad[i].text), NULL, &err), ST_OK);
        assert_err(err, ST_DATA, bad[i].message);
        assert_null(list.lenses);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_list_round_trips),
        cmocka_unit_test(errors_name_the_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
