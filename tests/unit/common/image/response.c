/* response.c - the sRGB curve, tables, and invalid files. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/image/response.h"

/* light = (sample + sample^3) / 2 in red, sample^2 in green, sample^3 in blue */
static const char *write_table(int lines)
{
    static char text[RESPONSE_LEVELS * 64];
    int n = sprintf(text, "# a comment\nremodel-response 1\ncurve table 256\n");
    for (int i = 0; i < lines; i++) {
        const double s = i / 255.0;
        n += sprintf(text + n, "%.9g %.9g %.9g\n", (s + s * s * s) / 2, s * s, s * s * s);
    }
    return scratch_write("response.txt", text);
}

static void srgb_is_the_default(void **state)
{
    const struct response r = {0};
    struct err err = ERR_INIT;
    (void)state;
    float *eight = response_tables(&r, 8, &err), *sixteen = response_tables(&r, 16, &err);
    assert_true(eight && sixteen);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < 256; i++) {
            assert_true(eight[256 * c + i] == linear_from_srgb((float)i / 255));
            assert_float_equal(sixteen[65536 * c + 257 * i], eight[256 * c + i], 1e-6);
        }
    free(eight);
    free(sixteen);
    struct response read;
    assert_ok(response_read(&read, scratch_write("srgb.txt", "remodel-response 1\ncurve srgb\n"), NULL, &err), err);
    assert_false(read.table);
}

static void a_table_is_interpolated(void **state)
{
    struct response r;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(response_read(&r, write_table(256), NULL, &err), err);
    assert_true(r.table);
    for (int i = 0; i <= 1000; i++) {
        const double s = i / 1000.0, light[3] = {(s + s * s * s) / 2, s * s, s * s * s};
        for (int c = 0; c < 3; c++) assert_float_equal(response_light(&r, c, (float)s), light[c], 2e-5);
    }
    float *tables = response_tables(&r, 16, &err);
    assert_non_null(tables);
    for (int i = 1; i < 65536; i++) assert_true(tables[i] >= tables[i - 1]);
    free(tables);
}

static void refused(const char *text, const char *words)
{
    struct response r;
    struct err err = ERR_INIT;
    assert_int_equal(response_read(&r, scratch_write("bad.txt", text), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
    assert_contains(err.text, "bad.txt:");
    assert_false(r.table);
}

static void invalid_curves_are_refused(void **state)
{
    struct response r;
    struct err err = ERR_INIT;
    (void)state;
    refused("# nothing\n", "wanted a line \"remodel-response");
    refused("remodel-response 2\ncurve srgb\n", "found \"2\"");
    refused("remodel-response 1\ncurve gamma\n", "wanted srgb or table");
    refused("remodel-response 1\ncurve table 7\n", "found \"7\"");
    refused("remodel-response 1\ncurve table 256\n0 0 0\n0.2 0.1 0\n0.1 0.2 0\n",
            "wanted a curve that does not fall (red)");
    refused("remodel-response 1\ncurve table 256\n0 0 -1\n", "wanted light");
    refused("remodel-response 1\ncurve srgb\nmore\n", "wanted the end of the file");
    assert_int_equal(response_read(&r, write_table(200), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "256 lines \"R G B\", not 200");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(srgb_is_the_default),
        cmocka_unit_test(a_table_is_interpolated),
        cmocka_unit_test(invalid_curves_are_refused),
    };
    return cmocka_run_group_tests_name("response", tests, scratch_make, scratch_remove);
}
