/* colmap_log.c - what is read from COLMAP's logs; COLMAP itself is not needed. */
#include "tests/unit/scratch.h"

#include "stages/sfm/colmap_log.h"
#include "stages/sfm/colmap_matches.h"

static void the_mapper_log_counts_connected_pictures(void **state)
{
    (void)state;
    assert_int_equal(colmap_log_connected(scratch_write("log", "Loading images... 11 in 0.000s (connected 9)\n")), 9);
    assert_int_equal(colmap_log_connected(scratch_write("log", "nothing of that\n")), -1);
}

static void the_last_line_is_told_without_severity_and_place(void **state)
{
    (void)state;
    char line[200];
    const char *failed = "I1104 12:49:10.112521 24337 mapper.cc:225] Loading database\n"
                         "F0803 16:06:44.333153 3969870 reconstruction.cc:182] Check failed: a <= b (2 vs. 1)\n"
                         "*** Check failure stack trace: ***\n    @     0x7f4db95df1c3  google::LogMessage::Fail()\n";
    colmap_log_last_line(line, sizeof line, scratch_write("log", failed));
    assert_string_equal(line, "Check failed: a <= b (2 vs. 1)");
    colmap_log_last_line(line, sizeof line,
                         scratch_write("log",
                                       "E20251114 16:04:38.468699 1930356 option_manager.cc:976] Failed to parse "
                                       "options - unrecognised option '--x'.\n"));
    assert_string_equal(line, "Failed to parse options - unrecognised option '--x'.");
    colmap_log_last_line(line, sizeof line, scratch_write("log", "Images 3 of 4\n  I am no prefix] of a line\n\n"));
    assert_string_equal(line, "I am no prefix] of a line");
}

static void photos_with_few_features_are_listed(void **state)
{
    (void)state;
    char ids[3][2] = {"a", "b", "c"}, files[3][8] = {"a.jpg", "b.jpg", "c.jpg"}, text[100];
    struct photo_record photos[3] = {
        {.id = ids[0], .file = files[0]}, {.id = ids[1], .file = files[1]}, {.id = ids[2], .file = files[2]}};
    const struct photo_list list = {photos, 3};
    const int features[] = {12, -1, 500};
    colmap_list_poor(text, sizeof text, features, &list);
    assert_string_equal(text, "a.jpg (12), b.jpg (unreadable)");
    colmap_list_poor(text, 50, features, &list);
    assert_string_equal(text, "a.jpg (12) and 1 more");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mapper_log_counts_connected_pictures),
        cmocka_unit_test(the_last_line_is_told_without_severity_and_place),
        cmocka_unit_test(photos_with_few_features_are_listed),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
