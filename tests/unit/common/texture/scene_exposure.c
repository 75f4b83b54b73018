/* scene_exposure.c - the exposure of a scene: the median of its views in thirds of a stop; its file. */
#include "common/texture/scene_exposure.h"

#include <math.h>

#include "tests/unit/scratch.h"

static double of(int count, double a, double b, double c, double d)
{
    double list[4] = {a, b, c, d};
    return scene_exposure_of(list, count);
}

static void it_is_the_median_in_thirds_of_a_stop(void **state)
{
    (void)state;
    assert_true(of(0, 0, 0, 0, 0) == 1);
    assert_true(of(1, 1.1, 0, 0, 0) == 1); /* less than half of a step: the photographs as they are */
    assert_true(of(1, 1.2, 0, 0, 0) == exp2(1 / 3.0));
    assert_true(of(3, 8, 1, 1.05, 0) == 1);  /* one dark photograph */
    assert_true(of(3, 1.05, 8, 1, 0) == 1);  /* in any order */
    assert_true(of(4, 1, 4, 0.001, 9) == 2); /* between the two in the middle */
    assert_true(of(2, 0.25, 0.25, 0, 0) == 0.25);
    for (int k = -9; k < 9; k++) assert_true(fabs(of(1, exp2(k / 3.0), 0, 0, 0) / exp2(k / 3.0) - 1) < 1e-12);
}

static void the_file_reads_back_and_is_left_alone_if_it_is_the_same(void **state)
{
    const char *path = scratch_path("exposure.txt");
    const struct timespec old[2] = {{1000000, 0}, {1000000, 0}};
    struct err err = ERR_INIT;
    struct stat at;
    double read;
    (void)state;
    for (int k = 0; k < 3; k++) {
        const double exposure = k < 2 ? exp2(1 / 3.0) : 2;
        assert_ok(scene_exposure_write(exposure, path, NULL, &err), err);
        assert_ok(scene_exposure_read(&read, path, NULL, &err), err);
        assert_true(read == exposure);
        assert_int_equal(stat(path, &at), 0);
        assert_int_equal(at.st_mtime == 1000000, k == 1);
        assert_int_equal(utimensat(AT_FDCWD, path, old, 0), 0);
    }
}

static void a_faulty_file_is_refused_with_its_line(void **state)
{
    static const char *const cases[][2] = {
        {"", "remodel-exposure"},
        {"remodel-exposure 2\n", "exposure.txt:1: "},
        {"remodel-exposure 1\n", "exposure.txt:"},
        {"remodel-exposure 1\nexposure 0\n", "exposure.txt:2: found \"0\", wanted an exposure above 0"},
        {"remodel-exposure 1\nexposure nan\n", "exposure.txt:2: "},
        {"remodel-exposure 1\nexposure 1 2\n", "exposure.txt:2: "},
        {"remodel-exposure 1\nexposure 1\nexposure 1\n", "exposure.txt:3: "},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct err err = ERR_INIT;
        double read;
        assert_int_equal(scene_exposure_read(&read, scratch_write("exposure.txt", cases[i][0]), NULL, &err), ST_DATA);
        assert_non_null(strstr(err.text, cases[i][1]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_median_in_thirds_of_a_stop),
        cmocka_unit_test(the_file_reads_back_and_is_left_alone_if_it_is_the_same),
        cmocka_unit_test(a_faulty_file_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
