/* lux_marks.c - reader of lux.txt. */
#include "stages/calibrate_light/lux_marks.h"

#include "tests/unit/scratch.h"

static enum status read_text(struct lux_marks *m, const char *lines, struct err *err)
{
    char text[1024];
    snprintf(text, sizeof text, "remodel-lux 1\n%s", lines);
    return lux_marks_read(m, scratch_write("lux.txt", text), NULL, err);
}

static void statements_give_marks(void **state)
{
    struct lux_marks m;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(read_text(&m,
                        "illuminance desk 420 in IMG_1 1200 900.5 within 3\n"
                        "# a comment\n"
                        "illuminance \"the floor\" 150 on floor\n"
                        "luminance wall 35.5 in IMG_2 20 30 26 34\n"
                        "luminance spot 3.5 in IMG_2 20 30 within 10\n",
                        &err),
              err);
    assert_int_equal(m.count, 4);
    const struct lux_mark *d = m.items;
    assert_true(d->kind == LUX_ILLUMINANCE && d->value == 420 && d->pixels == 1 && d->within == 0.03 && d->line == 2);
    assert_string_equal(d->view, "IMG_1");
    assert_true(d->pixel[0] == 1200 && d->pixel[1] == 900.5 && !d->face);
    assert_string_equal(d[1].name, "the floor");
    assert_string_equal(d[1].face, "floor");
    assert_true(!d[1].view && d[1].within == -1 && d[1].pixels == 0);
    assert_true(d[2].kind == LUX_LUMINANCE && d[2].pixels == 2 && d[2].pixel[3] == 34);
    assert_true(d[3].pixels == 1 && d[3].within == 0.1);
    lux_marks_release(&m);
    lux_marks_release(&m);
}

static void fails(const char *lines, const char *expected)
{
    struct lux_marks m;
    struct err err = ERR_INIT;
    assert_int_equal(read_text(&m, lines, &err), ST_DATA);
    if (!strstr(err.text, expected)) fail_msg("%s\nwanted: %s", err.text, expected);
    assert_true(!m.items && !m.path);
}

static void errors_say_what_is_wanted(void **state)
{
    (void)state;
    fails("", "wanted a line \"illuminance ...\" or \"luminance ...\"");
    fails("lux desk 4 in a 1 2\n", "lux.txt:2: found \"lux\", wanted illuminance (lx) or luminance (cd/m2)");
    fails("illuminance desk 0 in a 1 2\n", "found \"0\", wanted an illuminance in lx");
    fails("illuminance desk 4 at a 1 2\n", "found \"at\", wanted \"in\" and a photo, or \"on\" and a face");
    fails("luminance wall 4 on floor\n", "found \"on\", wanted \"in\" and a photo");
    fails("illuminance a 4 in b 1 2 3 4\n", "found \"3\", wanted \"within\" and a percentage, or the end of the line");
    fails("illuminance a 4 in b 1 2 within 200\n", "wanted the meter's error in per cent, a number from 0 to 100");
    fails("luminance a 4 in b 1 2 3\n", "wanted a pixel's y");
    fails("luminance a 4 in b 1 2\nilluminance a 4 on floor\n", ":3: found \"a\", wanted a name of its own");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statements_give_marks),
        cmocka_unit_test(errors_say_what_is_wanted),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
