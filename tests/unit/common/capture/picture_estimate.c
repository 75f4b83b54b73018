/* picture_estimate.c - what processes take follows from the pixels of their pictures. */
#include "tests/unit/scratch.h"

#include "common/capture/picture_estimate.h"

static const struct picture_cost cost = {
    .process_seconds = 2, .seconds = 10, .process_mib = 100, .mib = 50, .bytes = 1e6};

/* Two views: of one and of three million pixels. */
static void write_views(void)
{
    scratch_write("cameras.txt", "1 PINHOLE 1000 1000 900 900 500 500\n2 PINHOLE 2000 1500 900 900 1000 750\n");
    scratch_write("images.txt", "1 1 0 0 0 0 0 0 1 a.exr\n\n2 1 0 0 0 1 0 0 2 b.exr\n\n");
    scratch_write("points3D.txt", "");
}

static void estimate(char *line, int size, const char *list)
{
    struct err err = ERR_INIT;
    write_views();
    const char *path = scratch_write("list", list);
    FILE *to = tmpfile();
    assert_non_null(to);
    assert_int_equal(picture_estimate_print(to, path, scratch, &cost, &err), ST_OK);
    rewind(to);
    assert_non_null(fgets(line, size, to));
    fclose(to);
}

static void pictures_of_a_process_add_up(void **state)
{
    (void)state;
    char line[200];
    /* 2 + 10 (1 + 3) = 42 s, 100 + 50 x 3 MiB, and 2 + 10 = 12 s */
    estimate(line, sizeof line, "process a b\nprocess a\n");
    assert_string_equal(line, "estimate 2 54.000 250 5000000 42.000\n");
}

static void unknown_pictures_have_the_mean_size(void **state)
{
    (void)state;
    char line[200];
    estimate(line, sizeof line, "process\nprocess 0001\n");
    assert_string_equal(line, "estimate 2 44.000 200 4000000 22.000\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_of_a_process_add_up),
        cmocka_unit_test(unknown_pictures_have_the_mean_size),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
