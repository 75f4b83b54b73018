/* colmap_log.c - what is read from COLMAP's logs; COLMAP itself is not needed. */
#include "tests/unit/scratch.h"

#include "stages/sfm/colmap_log.h"

static void feature_counts_come_from_the_log(void **state)
{
    (void)state;
    const char *log =
        "WARNING: ...\n\nProcessed file [1/3]\n  Name:            b.jpg\n"
        "  ERROR: Failed to read image file format.\nProcessed file [2/3]\n  Name:            c.png\n"
        "  Dimensions:      300 x 300\n  Features:        0\nProcessed file [3/3]\n  Name:            a.jpg\n"
        "  Features:        2113\nElapsed time: 0.007 [minutes]\n";
    struct feature_counts c;
    struct err err = ERR_INIT;
    assert_ok(colmap_counts_read(&c, scratch_write("log", log), &err), err);
    assert_int_equal(c.count, 3);
    assert_string_equal(c.list[0].name, "b.jpg");
    assert_int_equal(c.list[0].features, -1);
    assert_int_equal(c.list[1].features, 0);
    assert_int_equal(c.list[2].features, 2113);
    colmap_counts_release(&c);
    colmap_counts_release(&c);
    colmap_counts_release(NULL);
}

static void the_mapper_log_counts_connected_pictures(void **state)
{
    (void)state;
    assert_int_equal(colmap_log_connected(scratch_write("log", "Loading images... 11 in 0.000s (connected 9)\n")), 9);
    assert_int_equal(colmap_log_connected(scratch_write("log", "nothing of that\n")), -1);
}

static void photos_with_few_features_are_listed(void **state)
{
    (void)state;
    char ids[3][2] = {"a", "b", "c"}, files[3][8] = {"a.jpg", "b.jpg", "c.jpg"}, text[100];
    struct photo_record photos[3] = {
        {.id = ids[0], .file = files[0]}, {.id = ids[1], .file = files[1]}, {.id = ids[2], .file = files[2]}};
    const struct photo_list list = {photos, 3};
    char a[] = "a.jpg", c[] = "c.jpg";
    struct feature_count counts[] = {{a, 12}, {c, 500}};
    const struct feature_counts found = {counts, 2};
    colmap_counts_list_poor(text, sizeof text, &found, &list, 200);
    assert_string_equal(text, "a.jpg (12), b.jpg (unreadable)");
    colmap_counts_list_poor(text, 50, &found, &list, 600);
    assert_string_equal(text, "a.jpg (12) and 2 more");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feature_counts_come_from_the_log),
        cmocka_unit_test(the_mapper_log_counts_connected_pictures),
        cmocka_unit_test(photos_with_few_features_are_listed),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
