/* photometry.c - reader of IES files: intensities, symmetries and lumens against closed forms. */
#include "common/daylight/photometry.h"

#include <math.h>

#include "tests/unit/scratch.h"

#include "common/math/numbers.h"

static const struct vec3 down = {0, 0, -1}, along = {1, 0, 0};

static bool near(double a, double b, double part) { return fabs(a - b) <= part * fabs(b); }

static enum status read_text(struct photometry *p, const char *text, struct err *err)
{
    return photometry_read(p, scratch_write("lamp.ies", text), NULL, err);
}

static void isotropic_light_has_4_pi_times_its_intensity(void **state)
{
    struct photometry p;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(read_text(&p,
                        "IESNA:LM-63-2002\r\n[TEST] none\r\n[LUMCAT] G-1\r\n[LUMINAIRE] Globe 20\r\nTILT=NONE\r\n"
                        "1 1257 2 3 1 1 2 -0.2 0 0\r\n1 1 12\r\n0 90 180\r\n0\r\n50 50 50\r\n",
                        &err),
              err);
    assert_string_equal(p.name, "Globe 20");
    assert_int_equal(p.format, LM63_2002);
    assert_true(near(photometry_lumens(&p), 4 * PI * 100, 1e-12));
    assert_true(photometry_candela(&p, vec3_make(0.6, 0, 0.8), down, along) == 100);
    assert_true(p.width == -0.2 && p.watts == 12 && p.lumens_per_lamp == 1257);
    photometry_release(&p);
    photometry_release(&p);
}

static char *lambertian(int step)
{
    static char text[20000];
    int n = snprintf(text, sizeof text, "IESNA91\nTILT=NONE\n1 -1 1 %d 1 1 1 2 2 0\n0.5 2 0\n", 90 / step + 1);
    for (int a = 0; a <= 90; a += step) n += snprintf(text + n, sizeof text - (size_t)n, "%d\n", a);
    n += snprintf(text + n, sizeof text - (size_t)n, "0\n");
    for (int a = 0; a <= 90; a += step)
        n += snprintf(text + n, sizeof text - (size_t)n, "%.12f,", 1000 * fmax(cos(a * DEGREE), 0));
    return text;
}

static void lambertian_light_has_pi_times_its_intensity(void **state)
{
    struct photometry p;
    struct err err = ERR_INIT;
    (void)state;
    for (int step = 1; step <= 5; step += 4) { /* half the error of a chord: step^2 / 24 of it */
        assert_ok(read_text(&p, lambertian(step), &err), err);
        assert_true(near(photometry_lumens(&p), PI * 1000, 1.1 * step * DEGREE * step * DEGREE / 12));
        assert_true(photometry_candela(&p, vec3_make(0, 0, 1), down, along) == 0);
        assert_true(near(p.width, 2 * 0.3048, 1e-12));
        photometry_release(&p);
    }
}

/* Intensities that name their horizontal angle: 100 + angle. */
static void symmetries_repeat_and_reflect(void **state)
{
    static const struct {
        const char *angles;
        double at[8]; /* intensities at 10, 80, 100, 170, 190, 260, 280, 350 degrees */
    } cases[] = {
        {"2 1 1 2 0 0 0 1 1 0 0 90 0 100 100", {100, 100, 100, 100, 100, 100, 100, 100}},
        {"2 2 1 2 0 0 0 1 1 0 0 90 0 90 100 100 190 190", {110, 180, 180, 110, 110, 180, 180, 110}},
        {"2 2 1 2 0 0 0 1 1 0 0 90 0 180 100 100 280 280", {110, 180, 200, 270, 270, 200, 180, 110}},
        {"2 2 1 2 0 0 0 1 1 0 0 90 90 270 190 190 370 370", {270, 200, 200, 270, 290, 360, 360, 290}},
        {"2 2 1 2 0 0 0 1 1 0 0 90 0 360 100 100 460 460", {110, 180, 200, 270, 290, 360, 380, 450}},
        {"2 3 1 2 0 0 0 1 1 0 0 90 0 180 270 100 100 280 280 370 370", {110, 180, 200, 270, 290, 360, 340, 130}},
    };
    static const double angle[8] = {10, 80, 100, 170, 190, 260, 280, 350};
    (void)state;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct photometry p;
        struct err err = ERR_INIT;
        char text[256];
        double mean = 0;
        snprintf(text, sizeof text, "Lamp\nTILT=NONE\n1 -1 1 %s", cases[c].angles);
        assert_ok(read_text(&p, text, &err), err);
        for (int k = 0; k < 8; k++)
            if (!near(photometry_intensity(&p, 45, angle[k]), cases[c].at[k], 1e-9))
                fail_msg("case %zu, %g degrees: %g", c, angle[k], photometry_intensity(&p, 45, angle[k]));
        for (int k = 0; k < 3600; k++) mean += photometry_intensity(&p, 45, (k + 0.5) / 10) / 3600;
        assert_true(near(photometry_lumens(&p), 2 * PI * mean, 1e-9));
        /* a turn by whole circles is none */
        assert_true(near(photometry_intensity(&p, 45, -350), cases[c].at[0], 1e-9));
        photometry_release(&p);
    }
}

static void directions_turn_about_the_axis(void **state)
{
    struct photometry p;
    struct err err = ERR_INIT;
    (void)state;
    /* full range, 100 + angle; 90 degrees lie along down x along = (0, 0, -1) x (1, 0, 0) = (0, -1, 0) */
    assert_ok(read_text(&p, "a\nTILT=NONE\n1 -1 1 2 2 1 2 0 0 0 1 1 0 0 180 0 360 100 100 460 460", &err), err);
    assert_true(near(photometry_candela(&p, vec3_make(0, -1, 0), down, along), 190, 1e-9));
    assert_true(near(photometry_candela(&p, vec3_make(0, 1, 0), down, along), 370, 1e-9));
    photometry_release(&p);
}

static void tilted_lamps_shine_less(void **state)
{
    struct photometry p;
    struct err err = ERR_INIT;
    (void)state;
    for (int geometry = 1; geometry <= 3; geometry++) {
        char text[256];
        snprintf(text, sizeof text,
                 "a\nTILT=INCLUDE\n%d\n3\n0 90 180\n1 0.8 0.9\n1 -1 1 2 1 1 2 0 0 0 1 1 0\n0 180 0 9 9", geometry);
        assert_ok(read_text(&p, text, &err), err);
        assert_true(photometry_tilt(&p, 0) == 1);
        const double c = sqrt(0.5), at45 = photometry_candela(&p, down, vec3_make(c, 0, -c), vec3_make(c, 0, c));
        assert_true(near(at45, geometry == 2 ? 9 : 9 * 0.9, 1e-9));
        assert_true(near(photometry_tilt(&p, 180), geometry == 2 ? 1 : 0.9, 1e-12));
        photometry_release(&p);
    }
}

/* The ballast-lamp factor counts up to revision 1991; the ballast factor and the multiplier always. */
static void factors_follow_the_revision(void **state)
{
    static const struct {
        const char *first;
        double candela;
    } cases[] = {{"A lamp", 60}, {"IESNA91", 60}, {"IESNA:LM-63-1995", 20}, {"IES:LM-63-2019", 20}};
    (void)state;
    for (size_t c = 0; c < 4; c++) {
        struct photometry p;
        struct err err = ERR_INIT;
        char text[256];
        snprintf(text, sizeof text, "%s\nTILT=NONE\n1 -1 2 2 1 1 2 0 0 0\n0.5 3 7\n0 90\n0\n20 20\n", cases[c].first);
        assert_ok(read_text(&p, text, &err), err);
        assert_true(near(photometry_intensity(&p, 30, 0), cases[c].candela, 1e-12));
        assert_string_equal(p.name, c ? "" : "A lamp");
        photometry_release(&p);
    }
}

static void fails(const char *text, const char *expected)
{
    struct photometry p;
    struct err err = ERR_INIT;
    assert_int_equal(read_text(&p, text, &err), ST_DATA);
    if (!strstr(err.text, expected)) fail_msg("%s\nwanted: %s", err.text, expected);
    assert_true(!p.candela && !p.name && !p.vertical);
}

static void errors_say_what_to_do(void **state)
{
    (void)state;
    fails("", "found an empty file");
    fails("IESNA91\n[TEST]\n", "found the end of the file, wanted a line TILT=NONE or TILT=INCLUDE");
    fails("a\nTILT=lamp.tlt\n", ":2: found \"lamp.tlt\", wanted TILT=NONE or TILT=INCLUDE; copy the numbers");
    fails("a\nTILT=NONE\n1 -1 1 2 1 2 2 0 0 0\n1 1 0\n", ":3: found \"photometry of type B\", wanted type C");
    fails("a\nTILT=NONE\n1 -1 1 2 1 3 2 0 0 0\n1 1 0\n", ":3: found \"photometry of type A\", wanted type C");
    fails("a\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 0\n0 50 40\n", ":5: found \"40\", wanted vertical angles");
    fails("a\nTILT=NONE\n1 -1 1 2 2 1 2 0 0 0\n1 1 0\n0 90\n0 45\n", "found \"0 to 45\", wanted horizontal angles");
    fails("a\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n5 -5\n", ":7: found \"-5\", wanted an intensity");
    fails("a\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n5\n", "found the end of the file, wanted an intensity");
    fails("a\nTILT=NONE\n1 -1 1 2.5 1 1 2 0 0 0\n", "found \"2.5\", wanted a whole number");
    fails("a\nTILT=NONE\n1 -1 1 4000 4000 1 2 0 0 0\n", "wanted");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isotropic_light_has_4_pi_times_its_intensity),
        cmocka_unit_test(lambertian_light_has_pi_times_its_intensity),
        cmocka_unit_test(symmetries_repeat_and_reflect),
        cmocka_unit_test(directions_turn_about_the_axis),
        cmocka_unit_test(tilted_lamps_shine_less),
        cmocka_unit_test(factors_follow_the_revision),
        cmocka_unit_test(errors_say_what_to_do),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
