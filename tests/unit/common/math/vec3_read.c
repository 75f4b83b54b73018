/* vec3_read.c - three coordinates of a line, and what is no coordinate. */
#include "common/math/vec3_read.h"

#include "tests/unit/scratch.h"

static struct textfile line_of(const char *text)
{
    struct textfile t = {0};
    struct err err = ERR_INIT;
    assert_ok(textfile_open(&t, scratch_write("points.txt", text), &err), err);
    assert_true(textfile_next(&t));
    return t;
}

static void coordinates_are_read_in_order(void **state)
{
    struct textfile t = line_of("1 -2.5 3e12");
    struct err err = ERR_INIT;
    struct vec3 v;
    (void)state;
    assert_ok(vec3_read(&t, "a point", &v, &err), err);
    assert_true(v.x == 1 && v.y == -2.5 && v.z == 3e12);
    assert_ok(textfile_end(&t, &err), err);
    textfile_release(&t);
}

typedef enum status (*reader)(struct textfile *t, const char *what, struct vec3 *v, struct err *err);

static void assert_refused(reader read, const char *text, const char *words)
{
    struct textfile t = line_of(text);
    struct err err = ERR_INIT;
    struct vec3 v;
    assert_int_equal(read(&t, "the centre", &v, &err), ST_DATA);
    assert_non_null(strstr(err.text, words));
    textfile_release(&t);
}

static void a_missing_coordinate_is_named(void **state)
{
    (void)state;
    assert_refused(vec3_read, "1 2", "the centre");
}

static void a_point_out_of_bounds_is_refused(void **state)
{
    (void)state;
    assert_refused(vec3_read_bounded, "0 1e9 1e9", "at most 1e9");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coordinates_are_read_in_order),
        cmocka_unit_test(a_missing_coordinate_is_named),
        cmocka_unit_test(a_point_out_of_bounds_is_refused),
    };
    return cmocka_run_group_tests_name("vec3_read", tests, scratch_make, scratch_remove);
}
