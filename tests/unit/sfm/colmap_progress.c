/* colmap_progress.c - progress read from logs that COLMAP is writing. */
#include "tests/unit/scratch.h"

#include "stages/sfm/colmap_progress.h"

static void append(const char *path, const char *text)
{
    FILE *f = fopen(path, "a");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void lines_are_counted_once_they_are_whole(void **state)
{
    (void)state;
    struct colmap_progress p;
    const char *log = scratch_write("log", "a.jpg - b.jpg\n");
    colmap_progress_start(&p, log, " - ", false, "verifying", 3, "pairs");
    append(log, "a.jpg - c.jpg\nb.jpg");
    colmap_progress_tick(&p);
    assert_int_equal(p.count, 1); /* not the line of an earlier run */
    append(log, " - c.jpg\nb.jpg - d.jpg\n");
    colmap_progress_tick(&p);
    colmap_progress_tick(&p);
    assert_int_equal(p.count, 3);
    colmap_progress_end(&p);
}

static void the_largest_number_of_placed_photos_counts(void **state)
{
    (void)state;
    struct colmap_progress p;
    const char *log = scratch_write("log", "");
    colmap_progress_start(&p, log, "Registering image #", true, "placing photos", 9, "photos");
    append(log, "Registering image #7 (3)\n  => Image sees 182 / 766 points\nRegistering image #2 (4)\n");
    append(log, "Registering image #9 (2)\n"); /* another model */
    colmap_progress_tick(&p);
    assert_int_equal(p.count, 4);
    colmap_progress_end(&p);
}

static void a_missing_log_is_no_progress(void **state)
{
    (void)state;
    struct colmap_progress p;
    colmap_progress_start(&p, "/nowhere/log", " - ", false, "verifying", 3, "pairs");
    colmap_progress_tick(&p);
    assert_int_equal(p.count, 0);
    colmap_progress_end(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_are_counted_once_they_are_whole),
        cmocka_unit_test(the_largest_number_of_placed_photos_counts),
        cmocka_unit_test(a_missing_log_is_no_progress),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
