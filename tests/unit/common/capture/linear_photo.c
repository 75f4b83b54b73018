/* linear_photo.c - photos of one exposure and merged photos as linear colour. */
#include "common/capture/linear_photo.h"

#include "tests/unit/scratch.h"

#include <math.h>

#include "common/image/exr.h"

struct reading {
    struct image im;
    char radiometry[RADIOMETRY_SIZE];
    struct provenance prov;
    struct err err;
};

static void read_photo(struct reading *r, const char *folder, const struct photo_record *record)
{
    *r = (struct reading){.err = ERR_INIT};
    linear_photo_read(&r->im, NULL, r->radiometry, folder, record, NULL, &r->prov, &r->err);
}

static void assert_read(const struct reading *r, const char *radiometry, int width, int height, const char *input)
{
    assert_ok(r->err.status, r->err);
    assert_string_equal(r->radiometry, radiometry);
    assert_true(r->im.width == width && r->im.height == height && r->im.channels == 3);
    assert_int_equal(r->prov.count, 1);
    assert_string_equal(r->prov.inputs[0].name, input);
}

static void release(struct reading *r)
{
    provenance_release(&r->prov);
    image_release(&r->im);
}

static void assert_rejected(const struct photo_record *record, enum status status, const char *message)
{
    struct reading r;
    read_photo(&r, scratch, record);
    assert_err(r.err, status, message);
    release(&r);
}

static void one_exposure_is_linearised(void **state)
{
    char id[] = "a", file[] = "rgb8.png";
    const struct photo_record record = {.id = id, .file = file};
    struct reading r;
    (void)state;
    read_photo(&r, "tests/fuzz/corpus/photo", &record);
    assert_read(&r, "approximate", 7, 5, "photos/rgb8.png");
    /* red is 16 x of 255; the sRGB curve maps 48 to 0.0296 */
    assert_true(r.im.data[0] == 0 && fabsf(r.im.data[3 * 3] - 0.02956f) < 1e-4f);
    release(&r);
}

static void several_exposures_are_read_from_the_merged_file(void **state)
{
    char id[] = "b", file[] = "b1.jpg";
    const struct photo_record record = {.id = id, .file = file, .bracket_count = 2};
    const float rgba[] = {2, 4, 8, 1, -1, 0.5f, 0.25f, 1};
    const float expected[] = {2, 4, 8, -1, 0.5f, 0.25f}; /* negative values, of colours outside of Rec.709, stay */
    struct exr_image exr;
    struct reading r;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(exr_init_rgba(&exr, rgba, 2, 1, &err), err);
    assert_ok(exr_set_attribute(&exr, "remodel:radiometry", "exact", &err), err);
    assert_ok(exr_write(&exr, scratch_path("b.exr"), NULL, &err), err);
    exr_image_release(&exr);
    read_photo(&r, scratch, &record);
    assert_read(&r, "exact", 2, 1, "b.exr");
    for (int i = 0; i < 6; i++) assert_true(r.im.data[i] == expected[i]);
    release(&r);
}

/* A grey pixel of half of white; the given noise of its colours; a saturated and a black pixel. */
static void noise_and_marks_of_one_exposure_are_assumed(void **state)
{
    const struct single_exposure assumed = {1000, 10, 0.9, 0.01};
    const struct photo photo = {.info = {.bits = 32}};
    const double squares = 0.2126 * 0.2126 + 0.7152 * 0.7152 + 0.0722 * 0.0722;
    struct image linear;
    struct photo_quality q = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(image_init(&linear, 3, 1, 3, &err), err);
    for (int c = 0; c < 3; c++) linear.data[c] = 0.5f;
    linear.data[3] = 0.9f; /* red alone */
    assert_ok(photo_quality_of_exposure(&q, &photo, &linear, &assumed, &err), err);
    assert_float_equal(q.variance[0], squares * (0.5 / 1000 + 1e-4), 1e-9);
    assert_int_equal(q.marks[0], 0);
    assert_float_equal(q.variance[1], 0.2126 * 0.9 * 0.2126 * 0.9, 1e-6); /* nothing is known but a bound */
    assert_int_equal(q.marks[1], PHOTO_BRIGHT);
    assert_true(q.variance[2] == 0 && photo_relative_sigma(q.variance[2], 0) == 1);
    assert_int_equal(q.marks[2], PHOTO_DARK);
    photo_quality_release(&q);
    image_release(&linear);
}

/* Saturated red of Display P3 has red above 1 and the others below 0, but only a saturated sample is clipped. */
static void colours_outside_of_rec709_are_not_clipped(void **state)
{
    static const struct chromaticities p3 = {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}};
    const struct single_exposure assumed = {1000, 10, 0.9, 0.01};
    uint16_t samples[9] = {240, 0, 0, 255, 0, 0, 128, 128, 128};
    struct photo photo = {.info = {.width = 3, .height = 1, .bits = 8}, .samples = samples};
    struct image linear = {0};
    struct photo_quality q = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(colour_space_from_primaries(&photo.space, &p3, 0, 8, "P3", &err), err);
    assert_ok(photo_to_linear(&linear, &photo, &err), err);
    assert_true(linear.data[0] > 1 && linear.data[1] < 0);
    assert_ok(photo_quality_of_exposure(&q, &photo, &linear, &assumed, &err), err);
    assert_int_equal(q.marks[0], PHOTO_DARK);
    assert_int_equal(q.marks[1], PHOTO_BRIGHT);
    assert_int_equal(q.marks[2], 0);
    for (int i = 0; i < 3; i++) assert_true(q.variance[i] > 0);
    photo_quality_release(&q);
    image_release(&linear);
    colour_space_release(photo.space);
}

/* Errors of two sample values: the sRGB curve has the slope 2.275 v^0.583, and all colours share the error. The noise
 * model has the slope in proportion to v^0.5, which deviates from that by up to a tenth over this range. */
static void errors_of_jpeg_are_shared_by_the_colours(void **state)
{
    const struct single_exposure assumed = {1e9, 0, 0.9, 0};
    const struct photo photo = {.info = {.bits = 32}, .jpeg_variance = 4};
    struct image linear;
    struct photo_quality q = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(image_init(&linear, 3, 1, 3, &err), err);
    for (int i = 0; i < 9; i++) linear.data[i] = 0.25f * (float)(1 + i / 3);
    assert_ok(photo_quality_of_exposure(&q, &photo, &linear, &assumed, &err), err);
    for (int i = 0; i < 3; i++) {
        const double wanted = 2 * 2.275 * pow(0.25 * (1 + i), 0.583) / 255;
        assert_float_equal(sqrt((double)q.variance[i]) / wanted, 1, 0.1);
    }
    photo_quality_release(&q);
    image_release(&linear);
}

static void noise_and_marks_of_merged_exposures_are_read(void **state)
{
    char id[] = "e";
    const struct photo_record record = {.id = id, .bracket_count = 2};
    const float rgba[] = {2, 2, 2, 1, 4, 4, 4, 1};
    struct exr_image exr;
    struct exr_plane *plane;
    struct image linear = {0};
    struct photo_quality q = {0};
    struct provenance prov = {0};
    char radiometry[RADIOMETRY_SIZE];
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(exr_init_rgba(&exr, rgba, 2, 1, &err), err);
    assert_ok(exr_add_plane(&exr, "variance", EXR_FLOAT, &plane, &err), err);
    plane->f[0] = 0.01f;
    plane->f[1] = 1;
    assert_ok(exr_add_plane(&exr, "clipped", EXR_UINT, &plane, &err), err);
    plane->u[1] = PHOTO_BRIGHT | PHOTO_DARK;
    assert_ok(exr_write(&exr, scratch_path("e.exr"), NULL, &err), err);
    exr_image_release(&exr);
    assert_ok(linear_photo_read(&linear, &q, radiometry, scratch, &record, NULL, &prov, &err), err);
    assert_float_equal(q.variance[0], 0.04, 1e-6);
    assert_float_equal(q.variance[1], 16, 1e-5);
    assert_true(q.marks[0] == 0 && q.marks[1] == (PHOTO_BRIGHT | PHOTO_DARK));
    image_release(&linear);
    photo_quality_release(&q);

    /* a file of another program, without these channels */
    assert_ok(exr_init_rgba(&exr, rgba, 2, 1, &err), err);
    assert_ok(exr_write(&exr, scratch_path("e.exr"), NULL, &err), err);
    exr_image_release(&exr);
    assert_int_equal(linear_photo_read(&linear, &q, radiometry, scratch, &record, NULL, &prov, &err), ST_DATA);
    assert_err(err, ST_DATA, "clipped");
    provenance_release(&prov);
}

static void unreadable_files_are_reported(void **state)
{
    char gone_id[] = "c", gone_file[] = "c.jpg", whole_id[] = "d";
    const struct photo_record gone = {.id = gone_id, .file = gone_file}, whole = {.id = whole_id, .bracket_count = 2};
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image exr;
    struct err err = ERR_INIT;
    (void)state;
    assert_rejected(&gone, ST_IO, "c.jpg");
    assert_ok(exr_image_init(&exr, 2, 1, &err), err);
    for (int c = 0; c < 3; c++) assert_ok(exr_add_plane(&exr, names[c], EXR_UINT, NULL, &err), err);
    assert_ok(exr_write(&exr, scratch_path("d.exr"), NULL, &err), err);
    exr_image_release(&exr);
    assert_rejected(&whole, ST_DATA, "integers");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_exposure_is_linearised),
        cmocka_unit_test(several_exposures_are_read_from_the_merged_file),
        cmocka_unit_test(noise_and_marks_of_one_exposure_are_assumed),
        cmocka_unit_test(colours_outside_of_rec709_are_not_clipped),
        cmocka_unit_test(errors_of_jpeg_are_shared_by_the_colours),
        cmocka_unit_test(noise_and_marks_of_merged_exposures_are_read),
        cmocka_unit_test(unreadable_files_are_reported),
    };
    return cmocka_run_group_tests_name("linear_photo", tests, scratch_make, scratch_remove);
}
