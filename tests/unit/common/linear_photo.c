/* linear_photo.c - photos of one exposure and of several become the same kind of picture. */
#include "common/linear_photo.h"

#include "tests/unit/scratch.h"

#include <math.h>

#include "common/exr.h"

static void one_exposure_is_decoded(void **state)
{
    char id[] = "a", file[] = "rgb8.png";
    const struct photo_record record = {.id = id, .file = file};
    struct image im = {0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    char radiometry[RADIOMETRY_SIZE];
    (void)state;
    assert_ok(linear_photo_read(&im, radiometry, "tests/fuzz/corpus/photo", &record, &prov, &err), err);
    assert_string_equal(radiometry, "approximate");
    assert_true(im.width == 7 && im.height == 5 && im.channels == 3);
    /* red is 16 x of 255: by the sRGB curve 48 is 0.0296 */
    assert_true(im.data[0] == 0 && fabsf(im.data[3 * 3] - 0.02956f) < 1e-4f);
    assert_int_equal(prov.count, 1);
    assert_string_equal(prov.inputs[0].name, "photos/rgb8.png");
    provenance_release(&prov);
    image_release(&im);
}

static void several_are_what_was_merged(void **state)
{
    char id[] = "b", file[] = "b1.jpg";
    const struct photo_record record = {.id = id, .file = file, .bracket_count = 2};
    const float rgba[] = {2, 4, 8, 1, -1, 0.5f, 0.25f, 1};
    const float expected[] = {2, 4, 8, 0, 0.5f, 0.25f}; /* nothing is darker than black */
    struct exr_image exr;
    struct image im = {0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    char radiometry[RADIOMETRY_SIZE];
    (void)state;
    assert_ok(exr_init_rgba(&exr, rgba, 2, 1, &err), err);
    assert_ok(exr_set_attribute(&exr, "remodel:radiometry", "exact", &err), err);
    assert_ok(exr_write(&exr, scratch_path("b.exr"), NULL, &err), err);
    exr_image_release(&exr);
    assert_ok(linear_photo_read(&im, radiometry, scratch, &record, &prov, &err), err);
    assert_string_equal(radiometry, "exact");
    assert_true(im.width == 2 && im.height == 1 && im.channels == 3);
    for (int i = 0; i < 6; i++) assert_true(im.data[i] == expected[i]);
    assert_string_equal(prov.inputs[0].name, "hdr/b.exr");
    provenance_release(&prov);
    image_release(&im);
}

static void what_cannot_be_read_is_told(void **state)
{
    char gone_id[] = "c", gone_file[] = "c.jpg", whole_id[] = "d";
    const struct photo_record gone = {.id = gone_id, .file = gone_file}, whole = {.id = whole_id, .bracket_count = 2};
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image exr;
    struct image im = {0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    char radiometry[RADIOMETRY_SIZE];
    (void)state;
    linear_photo_read(&im, radiometry, scratch, &gone, &prov, &err);
    assert_err(err, ST_IO, "c.jpg");
    err = (struct err)ERR_INIT;
    assert_ok(exr_image_init(&exr, 2, 1, &err), err);
    for (int c = 0; c < 3; c++) assert_ok(exr_add_plane(&exr, names[c], EXR_UINT, NULL, &err), err);
    assert_ok(exr_write(&exr, scratch_path("d.exr"), NULL, &err), err);
    exr_image_release(&exr);
    linear_photo_read(&im, radiometry, scratch, &whole, &prov, &err);
    assert_err(err, ST_DATA, "integers");
    provenance_release(&prov);
    image_release(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_exposure_is_decoded),
        cmocka_unit_test(several_are_what_was_merged),
        cmocka_unit_test(what_cannot_be_read_is_told),
    };
    return cmocka_run_group_tests_name("linear_photo", tests, scratch_make, scratch_remove);
}
