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
    struct progress shown;
    struct colmap_progress p;
    const char *log = scratch_write("log", "a.jpg - b.jpg\n");
    progress_start(&shown, "verifying", 3, "pairs");
    colmap_progress_start(&p, &shown, log, " - ", false);
    append(log, "a.jpg - c.jpg\nb.jpg");
    colmap_progress_tick(&p);
    assert_int_equal(p.count, 1); /* not the line of an earlier run */
    append(log, " - c.jpg\nb.jpg - d.jpg\n");
    colmap_progress_tick(&p);
    colmap_progress_tick(&p);
    assert_int_equal(p.count, 3);
    progress_end(&shown);
}

static void the_largest_number_of_placed_photos_counts(void **state)
{
    (void)state;
    struct progress shown;
    struct colmap_progress p;
    const char *log = scratch_write("log", "");
    progress_start(&shown, "placing photos", 9, "photos");
    colmap_progress_start(&p, &shown, log, "Registering image #", true);
    append(log, "Registering image #7 (3)\n  => Image sees 182 / 766 points\nRegistering image #2 (4)\n");
    append(log, "Registering image #9 (2)\n"); /* another model */
    colmap_progress_tick(&p);
    assert_int_equal(p.count, 4);
    progress_end(&shown);
}

static void a_missing_log_is_no_progress(void **state)
{
    (void)state;
    struct progress shown;
    struct colmap_progress p;
    progress_start(&shown, "verifying", 3, "pairs");
    colmap_progress_start(&p, &shown, "/nowhere/log", " - ", false);
    colmap_progress_tick(&p);
    assert_int_equal(p.count, 0);
    progress_end(&shown);
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
