/* lux_scale.c - lux/scale.txt comes back as it was written. */
#include "common/daylight/lux_scale.h"

#include "tests/unit/scratch.h"

static void what_is_written_is_read(void **state)
{
    char desk[] = "the desk", wall[] = "wall";
    struct lux_measurement list[2] = {{desk, LUX_ILLUMINANCE, 420, 1.25, 0.1, -0.03, false},
                                      {wall, LUX_LUMINANCE, 35, 0.2, 0.05, 1.5, true}};
    const struct lux_scale cases[3] = {
        {.is = {400.0 / 3, 100, 200}, .from = LUX_EXPOSURE, .photos = 7, .by_exposure = {400.0 / 3, 100, 200}},
        {.is = {330, 300, 360}, .from = LUX_MEASUREMENTS, .measurements = list, .count = 2},
        {.count = 0},
    };
    struct lux_scale again;
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < 3; i++) {
        assert_ok(lux_scale_write(&cases[i], scratch_path("scale.txt"), NULL, &err), err);
        assert_ok(lux_scale_read(&again, scratch_path("scale.txt"), NULL, &err), err);
        assert_memory_equal(&again.is, &cases[i].is, sizeof again.is);
        assert_memory_equal(&again.by_exposure, &cases[i].by_exposure, sizeof again.by_exposure);
        assert_int_equal(again.from, cases[i].from);
        assert_int_equal(again.photos, cases[i].photos);
        assert_int_equal(again.count, cases[i].count);
        for (int k = 0; k < again.count; k++) {
            const struct lux_measurement *a = &again.measurements[k], *b = &cases[i].measurements[k];
            assert_string_equal(a->name, b->name);
            assert_true(a->kind == b->kind && a->value == b->value && a->light == b->light && a->off == b->off);
            assert_true(a->expected == b->expected && a->deviation == b->deviation);
        }
        lux_scale_release(&again);
    }
}

static void fails(const char *text, const char *expected)
{
    struct lux_scale s;
    struct err err = ERR_INIT;
    assert_int_equal(lux_scale_read(&s, scratch_write("scale.txt", text), NULL, &err), ST_DATA);
    if (!strstr(err.text, expected)) fail_msg("%s\nwanted: %s", err.text, expected);
    assert_true(!s.measurements && !s.count);
}

#define HEAD "remodel-lux-scale 1\nscale 10\ninterval 5 20\n"
static void errors_name_the_line(void **state)
{
    (void)state;
    fails("remodel-lux-scale 1\nscale -1\n", ":2: found \"-1\", wanted a scale in cd/m2");
    fails("remodel-lux-scale 1\nscale 0\ninterval 0 0\nfrom exposure\n", ":4: found \"exposure\", wanted unknown");
    fails("remodel-lux-scale 1\nscale 10\ninterval 11 20\n", ":3: found \"11\", wanted the lower end");
    fails(HEAD "from guess\n", ":4: found \"guess\", wanted unknown, exposure or measurements");
    fails(HEAD "from measurements\nexposure 0 0 0 0\n", "wanted a line \"measurement ...\"");
    fails(HEAD "from exposure\nexposure 0 0 0 0\nmeasurement a heat 1 1 1 1 used\n", ":6: found \"heat\"");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(errors_name_the_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
