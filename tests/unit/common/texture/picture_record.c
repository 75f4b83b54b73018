/* picture_record.c - records of rendered pictures read back; faulty ones are refused with file and line. */
#include "common/texture/picture_record.h"

#include <math.h>

#include "tests/unit/scratch.h"

static void a_record_reads_back(void **state)
{
    const char *path = scratch_path("view.txt");
    struct picture_record record = {640, 480, 1.0 / 3, 12.5, {0}}, read;
    struct err err = ERR_INIT;
    (void)state;
    for (int k = 0; k < MADE_COUNT; k++) record.shares[k] = 100.0 / (k + 3);
    assert_ok(picture_record_write(&record, path, NULL, &err), err);
    assert_ok(picture_record_read(&read, path, NULL, &err), err);
    assert_true(read.width == 640 && read.height == 480);
    assert_true(fabs(read.exposure - record.exposure) < 1e-9);
    assert_true(fabs(read.changed - 12.5) < 1e-12);
    for (int k = 0; k < MADE_COUNT; k++) assert_true(fabs(read.shares[k] - record.shares[k]) < 1e-4);
}

static void a_kind_that_is_not_listed_has_no_pixels(void **state)
{
    struct picture_record read;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(picture_record_read(&read,
                                  scratch_write("view.txt", "remodel-picture 1\n# made by hand\nsize 4 3\nexposure 2\n"
                                                            "changed 0\nmade photo 100\n"),
                                  NULL, &err),
              err);
    assert_true(read.shares[MADE_PHOTO] > 99 && read.shares[MADE_COLOUR] < 1);
}

static void a_faulty_record_is_refused_with_its_line(void **state)
{
    static const char head[] = "remodel-picture 1\nsize 4 3\nexposure 2\nchanged 0\n";
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", "remodel-picture"},
        {"remodel-picture 2\n", "view.txt:1: "},
        {"remodel-picture 1\nsize 0 3\n", "view.txt:2: "},
        {"remodel-picture 1\nsize 4 3\nexposure 0\n", "view.txt:3: found \"0\", wanted an exposure above 0"},
        {"remodel-picture 1\nsize 4 3\nexposure nan\n", "view.txt:3: "},
        {"remodel-picture 1\nsize 4 3\nexposure 1\nchanged 101\n", "wanted a share in percent, a number from 0 to 100"},
        {"remodel-picture 1\nsize 4 3\nexposure 1\nchanged 1 1\n", "view.txt:4: "},
        {"made foto 1\n", "view.txt:5: found \"foto\", wanted a kind of pixel"},
        {"made photo -1\n", "wanted a share in percent, a number from 0 to 100"},
        {"made photo 50\nmade photo 50\n", "view.txt:6: found \"photo\", wanted each kind once"},
        {"kind photo 50\n", "made"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const bool whole = !cases[i].text[0] || !strncmp(cases[i].text, "remodel", 7);
        char text[256];
        struct picture_record read;
        struct err err = ERR_INIT;
        snprintf(text, sizeof text, "%s%s", whole ? "" : head, cases[i].text);
        assert_int_equal(picture_record_read(&read, scratch_write("view.txt", text), NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i].words);
        assert_int_equal(read.width, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_record_reads_back),
        cmocka_unit_test(a_kind_that_is_not_listed_has_no_pixels),
        cmocka_unit_test(a_faulty_record_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
