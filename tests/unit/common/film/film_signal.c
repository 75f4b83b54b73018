/* film_signal.c - light has the signals and code values of BT.2100; colours keep their place; chroma lies on the left
 * column. */
#include "common/film/film_signal.h"

#include <math.h>

#include "tests/unit/scratch.h"

static void pq_has_the_published_values(void **state)
{
    (void)state;
    assert_true(film_pq_from_light(10000) == 1);
    assert_float_equal(film_pq_from_light(0), 0, 1e-6);
    /* [ITU 2023, table 1] in per cent, and the light of half the signal */
    assert_float_equal(film_pq_from_light(203), 0.5807, 5e-5);
    assert_float_equal(film_pq_from_light(100), 0.5081, 5e-5);
    assert_float_equal(film_pq_from_light(1000), 0.7518, 5e-5);
    assert_float_equal(film_pq_from_light(92.2457), 0.5, 1e-6);
}

static void hlg_has_the_published_values(void **state)
{
    (void)state;
    assert_float_equal(film_hlg_from_light(1000), 1, 1e-6);
    assert_float_equal(film_hlg_from_light(203), 0.75, 2e-4);
    /* E = 1/12 is half the signal; the display shows it as E^1.2 of its peak */
    assert_float_equal(film_hlg_from_light(1000 * pow(1 / 12.0, 1.2)), 0.5, 1e-6);
    assert_true(film_hlg_from_light(0) == 0);
}

/* Codes of a flat picture of 4 x 4 pixels. */
static void flat_codes(int codes[3], const char *name, float r, float g, float b)
{
    const struct film_format *format = film_format_find(name);
    struct image picture = {0};
    struct err err = ERR_INIT;
    uint16_t out[64];
    assert_ok(image_init(&picture, 4, 4, 3, &err), err);
    for (int i = 0; i < 16; i++) picture.data[3 * i] = r, picture.data[3 * i + 1] = g, picture.data[3 * i + 2] = b;
    assert_true(film_format_bytes(format, 4, 4) <= sizeof out);
    assert_ok(film_format_signal(format, &picture, 10000, out, &err), err);
    const int chroma = 8 / format->chroma_rows;
    for (int i = 1; i < 16; i++) assert_int_equal(out[i], out[0]);
    for (int i = 1; i < chroma; i++) assert_int_equal(out[16 + i], out[16]);
    codes[0] = out[0], codes[1] = out[16], codes[2] = out[16 + chroma];
    image_release(&picture);
}

static void codes_lie_within_the_narrow_range(void **state)
{
    (void)state;
    static const char *const names[] = {"av1", "prores", "hlg", "pq"};
    int codes[3];
    for (int i = 0; i < 4; i++) {
        flat_codes(codes, names[i], 0, 0, 0);
        assert_true(codes[0] == 64 && codes[1] == 512 && codes[2] == 512);
        flat_codes(codes, names[i], 1e9F, 1e9F, 1e9F); /* clipped */
        assert_true(codes[0] == 940 && codes[1] == 512 && codes[2] == 512);
        flat_codes(codes, names[i], NAN, -1, NAN);
        assert_true(codes[0] == 64 && codes[1] == 512 && codes[2] == 512);
    }
    /* red of BT.709 in sRGB: Y' = 0.2126, Cr = 0.5 */
    flat_codes(codes, "av1", 1, 0, 0);
    assert_int_equal(codes[0], lround(64 + 876 * 0.2126));
    assert_int_equal(codes[1], lround(512 - 896 * 0.2126 / 1.8556));
    assert_int_equal(codes[2], 960);
}

/* The red of BT.709 is inside BT.2020: its light there follows from the chromaticities. */
static void colours_of_films_in_pq_are_those_of_bt2020(void **state)
{
    (void)state;
    int codes[3];
    const double r = film_pq_from_light(203 * 0.6274039), g = film_pq_from_light(203 * 0.0690973),
                 b = film_pq_from_light(203 * 0.0163914), y = 0.2627 * r + 0.6780 * g + 0.0593 * b;
    flat_codes(codes, "pq", 1, 0, 0);
    assert_int_equal(codes[0], lround(64 + 876 * y));
    assert_int_equal(codes[1], lround(512 + 896 * (b - y) / 1.8814));
    assert_int_equal(codes[2], lround(512 + 896 * (r - y) / 1.4746));
}

/* A single blue column: chroma samples lie on even columns, with weights 1 2 1. */
static void chroma_lies_on_the_left_column(void **state)
{
    (void)state;
    const struct film_format *format = film_format_find("prores");
    struct err err = ERR_INIT;
    int whole[3];
    flat_codes(whole, "prores", 0, 0, 1);
    for (int column = 2; column < 4; column++) {
        struct image picture = {0};
        uint16_t out[16 * 4];
        assert_ok(image_init(&picture, 8, 2, 3, &err), err);
        for (int y = 0; y < 2; y++) image_at(&picture, column, y)[2] = 1;
        assert_ok(film_format_signal(format, &picture, 1000, out, &err), err);
        const double full = whole[1] - 512;
        const double wanted[4] = {0, column == 2 ? full / 2 : full / 4, column == 2 ? 0 : full / 4, 0};
        for (int x = 0; x < 4; x++) assert_true(fabs(out[16 + x] - 512 - wanted[x]) <= 1);
        image_release(&picture);
    }
}

static void formats_have_names(void **state)
{
    (void)state;
    assert_null(film_format_find("vhs"));
    assert_string_equal(film_format_find("prores")->ending, "mov");
    assert_int_equal(film_format_bytes(film_format_find("h264"), 4, 2), 24);
    assert_int_equal(film_format_bytes(film_format_find("pq"), 4, 2), 24);
    assert_int_equal(film_format_bytes(film_format_find("prores"), 4, 2), 32);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pq_has_the_published_values),
        cmocka_unit_test(hlg_has_the_published_values),
        cmocka_unit_test(codes_lie_within_the_narrow_range),
        cmocka_unit_test(colours_of_films_in_pq_are_those_of_bt2020),
        cmocka_unit_test(chroma_lies_on_the_left_column),
        cmocka_unit_test(formats_have_names),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
