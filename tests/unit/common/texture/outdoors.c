/* outdoors.c - look-ups by direction, and the file. */
#include "common/texture/outdoors.h"

#include "tests/unit/scratch.h"

#include "common/image/exr.h"
#include "common/light/sky.h"
#include "common/math/numbers.h"

/* A picture whose colours are those of a linear function of the direction: red x, green y, blue z, plus 2. */
static void make_linear(struct outdoors *o, int height)
{
    struct err err = ERR_INIT;
    assert_ok(outdoors_init(o, height, &err), err);
    for (int y = 0; y < o->height; y++)
        for (int x = 0; x < o->width; x++) {
            const struct vec3 d = outdoors_direction(o, x + 0.5, y + 0.5);
            float *p = o->rgb + 3 * ((size_t)y * (size_t)o->width + (size_t)x);
            p[0] = (float)(2 + d.x), p[1] = (float)(2 + d.y), p[2] = (float)(2 + d.z);
            o->source[(size_t)y * (size_t)o->width + (size_t)x] = OUTDOORS_PHOTO;
        }
}

/* The largest error of a look-up, over directions between two elevations, in degrees. */
static double largest_error(const struct outdoors *o, double low, double high)
{
    double largest = 0;
    for (int i = 0; i <= 60; i++)
        for (int k = 0; k < 500; k++) {
            const double e = DEGREE * (low + (high - low) * i / 60), a = 2 * PI * (k + 0.3) / 500;
            const struct vec3 d = {cos(e) * cos(a), cos(e) * sin(a), sin(e)};
            float rgb[3];
            assert_int_equal(outdoors_sample(rgb, o, vec3_scale(d, 7)), OUTDOORS_PHOTO);
            largest = fmax(largest, fmax(fabs((double)rgb[0] - 2 - d.x),
                                         fmax(fabs((double)rgb[1] - 2 - d.y), fabs((double)rgb[2] - 2 - d.z))));
        }
    return largest;
}

static void a_look_up_agrees_with_the_function_that_made_the_picture(void **state)
{
    (void)state;
    struct outdoors o = {0};
    make_linear(&o, 64);
    /* bilinear interpolation between samples h radians apart is off by h^2 / 8 of the second derivative in each axis */
    const double step = PI / 64, bound = step * step / 4 + 1e-6;
    assert_true(largest_error(&o, -80, 80) < bound);
    assert_true(largest_error(&o, 80, 90) < bound);
    assert_true(largest_error(&o, -90, -80) < bound);
    outdoors_release(&o);
}

static void azimuth_wraps_around_at_minus_x(void **state)
{
    (void)state;
    struct outdoors o = {0};
    float left[3], right[3];
    make_linear(&o, 32);
    outdoors_sample(left, &o, vec3_make(-1, 1e-9, 0.2));
    outdoors_sample(right, &o, vec3_make(-1, -1e-9, 0.2));
    for (int c = 0; c < 3; c++) assert_true(fabsf(left[c] - right[c]) < 1e-5f);
    outdoors_sample(left, &o, vec3_make(-1, 0.0, 0.2)); /* atan2 is +pi, and -pi */
    outdoors_sample(right, &o, vec3_make(-1, -0.0, 0.2));
    for (int c = 0; c < 3; c++) assert_true(fabsf(left[c] - right[c]) < 1e-5f);
    outdoors_release(&o);
}

static void a_pole_has_one_colour_from_every_side(void **state)
{
    (void)state;
    struct outdoors o = {0};
    make_linear(&o, 32);
    for (int sign = -1; sign <= 1; sign += 2) {
        float pole[3], near[3];
        outdoors_sample(pole, &o, vec3_make(0, 0, sign));
        for (int k = 0; k < 16; k++) {
            const double a = 2 * PI * k / 16;
            outdoors_sample(near, &o, vec3_make(1e-7 * cos(a), 1e-7 * sin(a), sign));
            for (int c = 0; c < 3; c++) assert_true(fabsf(near[c] - 2 - (c == 2 ? (float)sign : 0)) < 0.01f);
        }
        assert_true(fabsf(pole[2] - 2 - (float)sign) < 0.01f);
    }
    outdoors_release(&o);
}

static void columns_count_azimuth_from_x_towards_y_and_rows_run_downwards(void **state)
{
    (void)state;
    struct outdoors o = {.width = 64, .height = 32};
    const struct vec3 ahead = outdoors_direction(&o, 32, 16), left = outdoors_direction(&o, 48, 16);
    const struct vec3 up = outdoors_direction(&o, 5, 0);
    assert_true(vec3_length(vec3_sub(ahead, vec3_make(1, 0, 0))) < 1e-12);
    assert_true(vec3_length(vec3_sub(left, vec3_make(0, 1, 0))) < 1e-12);
    assert_true(vec3_length(vec3_sub(up, vec3_make(0, 0, 1))) < 1e-12);
}

static void a_known_sky_is_found_again(void **state)
{
    (void)state;
    const struct sky_params params = {.has_panorama = true,
                                      .panorama = {.seed = 5, .sky = {1, 1.2, 1.6}, .ground = {0.3, 0.28, 0.2}}};
    struct outdoors o = {0};
    struct err err = ERR_INIT;
    struct sky sky;
    double error = 0;
    int count = 0;
    sky_init(&sky, &params);
    assert_ok(outdoors_init(&o, 256, &err), err);
    for (int y = 0; y < o.height; y++)
        for (int x = 0; x < o.width; x++) {
            const struct rgb c = sky_radiance(&sky, outdoors_direction(&o, x + 0.5, y + 0.5));
            float *p = o.rgb + 3 * ((size_t)y * (size_t)o.width + (size_t)x);
            p[0] = (float)c.r, p[1] = (float)c.g, p[2] = (float)c.b;
        }
    for (int k = 0; k < 2000; k++) { /* above the skyline, where it is smooth */
        const double e = DEGREE * (40 + 49.0 * k / 2000), a = 2.399963 * k;
        const struct vec3 d = {cos(e) * cos(a), cos(e) * sin(a), sin(e)};
        const struct rgb truth = sky_radiance(&sky, d);
        float rgb[3];
        outdoors_sample(rgb, &o, d);
        error += fabs((double)rgb[1] / (double)truth.g - 1);
        count++;
    }
    assert_true(error / count < 0.01);
    outdoors_release(&o);
}

static void nothing_is_known_of_an_empty_picture(void **state)
{
    (void)state;
    const struct outdoors o = {0};
    float rgb[3] = {1, 2, 3};
    assert_int_equal(outdoors_sample(rgb, &o, vec3_make(1, 2, 3)), OUTDOORS_GUESSED);
    assert_true(rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0);
}

static void a_picture_is_read_back_as_it_was_written(void **state)
{
    (void)state;
    struct outdoors o = {0}, again = {0};
    struct err err = ERR_INIT;
    assert_ok(outdoors_init(&o, 8, &err), err);
    for (int i = 0; i < 3 * 8 * 16; i++) o.rgb[i] = (float)i / 4; /* exact in half */
    for (int i = 0; i < 8 * 16; i++) o.source[i] = (uint8_t)(i % 3);
    assert_ok(outdoors_write(&o, scratch_path("o.exr"), NULL, &err), err);
    assert_ok(outdoors_read(&again, scratch_path("o.exr"), NULL, &err), err);
    assert_int_equal(again.width, 16);
    assert_memory_equal(again.rgb, o.rgb, 3 * 8 * 16 * sizeof(float));
    assert_memory_equal(again.source, o.source, 8 * 16);
    outdoors_release(&o);
    outdoors_release(&again);
    outdoors_release(&again); /* idempotent */
}

/* Writes a picture of these planes and reads it. */
static void read_made(struct err *err, int width, int height, float red, uint32_t source, enum exr_type type)
{
    static const char *const names[] = {"R", "G", "B", "A", "source"};
    struct exr_image im = {0};
    struct outdoors o = {0};
    struct err made = ERR_INIT;
    assert_ok(exr_image_init(&im, width, height, &made), made);
    for (int k = 0; k < 5; k++) {
        struct exr_plane *plane;
        assert_ok(exr_add_plane(&im, names[k], k == 4 ? type : EXR_HALF, &plane, &made), made);
        if (k == 0) plane->f[3] = red;
        if (k == 4 && plane->u) plane->u[2] = source;
    }
    assert_ok(exr_write(&im, scratch_path("made.exr"), NULL, &made), made);
    *err = (struct err)ERR_INIT;
    outdoors_read(&o, scratch_path("made.exr"), NULL, err);
    assert_null(o.rgb);
    exr_image_release(&im);
}

static void a_wrong_file_is_refused_with_a_sentence(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct outdoors o = {0};
    read_made(&err, 4, 4, 0, 0, EXR_UINT);
    assert_err(err, ST_DATA, "4 x 4 px, wanted a width of twice the height");
    read_made(&err, 4, 2, -1, 0, EXR_UINT);
    assert_err(err, ST_DATA, "pixel (3, 0) has R G B -1 0 0");
    read_made(&err, 4, 2, 0, 3, EXR_UINT);
    assert_err(err, ST_DATA, "source 3");
    read_made(&err, 4, 2, 0, 0, EXR_HALF);
    assert_err(err, ST_DATA, "channel source has the wrong type");
    err = (struct err)ERR_INIT;
    outdoors_read(&o, scratch_path("none.exr"), NULL, &err);
    assert_err(err, ST_IO, "none.exr");
    err = (struct err)ERR_INIT;
    outdoors_init(&o, 0, &err);
    assert_err(err, ST_DATA, "0 rows");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_look_up_agrees_with_the_function_that_made_the_picture),
        cmocka_unit_test(azimuth_wraps_around_at_minus_x),
        cmocka_unit_test(a_pole_has_one_colour_from_every_side),
        cmocka_unit_test(columns_count_azimuth_from_x_towards_y_and_rows_run_downwards),
        cmocka_unit_test(a_known_sky_is_found_again),
        cmocka_unit_test(nothing_is_known_of_an_empty_picture),
        cmocka_unit_test(a_picture_is_read_back_as_it_was_written),
        cmocka_unit_test(a_wrong_file_is_refused_with_a_sentence),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
