/* view_image.c - a view's picture on disk: round trip, errors, failed writes. (The camera attribute is tested in
 * exr.c.) */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/capture/view_image.h"
#include "common/image/exr.h"

static struct view make_view(int width, int height)
{
    return (struct view){.name = "IMG_1",
                         .width = width,
                         .height = height,
                         .fx = 50,
                         .fy = 60,
                         .cx = 8,
                         .cy = 7,
                         .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
}

static struct image make_image(int width, int height)
{
    struct image im;
    struct err err = ERR_INIT;
    assert_ok(image_init(&im, width, height, 4, &err), err);
    for (int i = 0; i < width * height * 4; i++) im.data[i] = (float)(i % 1999) / 1024; /* exact in half */
    return im;
}

static void assert_rejected(const struct view *view, enum status status, const char *message)
{
    struct image im;
    struct err err = ERR_INIT;
    assert_int_equal(view_image_read(&im, scratch, view, NULL, &err), status);
    assert_err(err, status, message);
    assert_contains(err.text, scratch_path("IMG_1.exr"));
    assert_true(!im.data && !im.width && !im.channels);
}

static void a_picture_round_trips(void **state)
{
    static const int sizes[][2] = {{17, 33}, {1, 1}, {2000, 1}, {1, 300}};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct view view = make_view(sizes[i][0], sizes[i][1]);
        struct image im = make_image(view.width, view.height), back;
        struct err err = ERR_INIT;
        assert_ok(view_image_write(&im, NULL, scratch_path("IMG_1.exr"), &view, NULL, "approximate", &err), err);
        assert_ok(view_image_read(&back, scratch, &view, NULL, &err), err);
        assert_true(back.width == view.width && back.height == view.height && back.channels == 4);
        assert_memory_equal(back.data, im.data, (size_t)view.width * (size_t)view.height * 4 * sizeof(float));
        image_release(&back);
        image_release(&back);
        image_release(&im);
    }
}

static void noise_and_marks_are_channels_that_colour_readers_ignore(void **state)
{
    enum { PIXELS = 5 };
    /* variance over the square of the luminance, and what is written: at most 1, to six binary digits */
    static const struct {
        float variance, sigma;
    } cases[PIXELS] = {{0.0001f, 0.01f}, {0.04f, 0.2f}, {1, 1}, {9, 1}, {0.25f, 0}};
    static const char *const names[] = {"sigma", "clipped"};
    const struct view view = make_view(PIXELS, 1);
    struct image im = make_image(PIXELS, 1), back;
    struct photo_quality q = {0};
    struct exr_image exr = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(photo_quality_init(&q, PIXELS, 1, &err), err);
    for (int i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 4; c++)
            im.data[4 * i + c] = i == PIXELS - 1 ? 0 : c == 3 ? 1 : 0.5f; /* the last: no photo */
        q.variance[i] = cases[i].variance / 4;
        q.marks[i] = (uint8_t)(i % 4);
    }
    assert_ok(view_image_write(&im, &q, scratch_path("IMG_1.exr"), &view, NULL, "exact", &err), err);
    assert_ok(exr_read(&exr, scratch_path("IMG_1.exr"), names, 2, &err), err);
    for (int i = 0; i < PIXELS; i++) {
        const float wanted = cases[i].sigma;
        assert_float_equal(exr_find(&exr, "sigma")->f[i], wanted, 0.016 * wanted);
        assert_float_equal(exr_find(&exr, "clipped")->f[i], i == PIXELS - 1 ? 0 : i % 4, 0);
    }
    assert_ok(view_image_read(&back, scratch, &view, NULL, &err), err);
    assert_memory_equal(back.data, im.data, PIXELS * 4 * sizeof(float));
    exr_image_release(&exr);
    photo_quality_release(&q);
    image_release(&back);
    image_release(&im);
}

static void colours_have_half_precision(void **state)
{
    static const float values[] = {1e-5F, 0.2F, 0.7F, 1 / 3.0F, 1.1F, 100.3F, 65504, 1e6F};
    struct view view = make_view(2, 1);
    struct image im = make_image(2, 1), back;
    struct err err = ERR_INIT;
    (void)state;
    memcpy(im.data, values, sizeof values);
    assert_ok(view_image_write(&im, NULL, scratch_path("IMG_1.exr"), &view, NULL, "approximate", &err), err);
    assert_ok(view_image_read(&back, scratch, &view, NULL, &err), err);
    for (int i = 0; i < 7; i++) assert_true(fabsf(back.data[i] - values[i]) <= fmaxf(values[i] / 2048, 3e-8F));
    assert_true(back.data[7] == 65504); /* the largest half */
    image_release(&back);
    image_release(&im);
}

static void radiometry_and_provenance_are_in_the_file(void **state)
{
    struct view view = make_view(5, 4);
    struct image im = make_image(5, 4);
    struct provenance prov = {.stage = "rectify", .version = "1.2.3"};
    struct exr_image exr;
    struct err err = ERR_INIT;
    char bytes[4096];
    (void)state;
    assert_ok(provenance_add_file(&prov, "photos/a b.jpg", scratch_write("a b.jpg", "words"), &err), err);
    assert_ok(view_image_write(&im, NULL, scratch_path("IMG_1.exr"), &view, &prov, "absolute", &err), err);
    assert_ok(exr_read(&exr, scratch_path("IMG_1.exr"), NULL, 0, &err), err);
    assert_string_equal(exr_attribute(&exr, "remodel:radiometry"), "absolute");
    assert_true(exr.has_world_to_camera);
    assert_int_equal(exr.count, 4);
    static const char *const names[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; c++) {
        assert_int_equal(exr_find(&exr, names[c])->type, EXR_HALF);
        for (int i = 0; i < 20; i++) assert_true(exr_find(&exr, names[c])->f[i] == im.data[4 * i + c]);
    }
    exr_image_release(&exr);
    FILE *fp = fopen(scratch_path("IMG_1.exr"), "rb");
    assert_non_null(fp);
    size_t size = fread(bytes, 1, sizeof bytes, fp);
    fclose(fp);
    assert_non_null(memmem(bytes, size, "rectify", 7));
    assert_non_null(memmem(bytes, size, "1.2.3", 5));
    assert_non_null(memmem(bytes, size, "\"photos/a b.jpg\" ", 17));
    image_release(&im);
    provenance_release(&prov);
}

static void pictures_of_another_size_are_rejected(void **state)
{
    struct view view = make_view(17, 33), wide = make_view(33, 17), narrow = make_view(16, 33);
    struct image im = make_image(17, 33), grey = {0};
    struct err err = ERR_INIT;
    (void)state;
    unlink(scratch_path("IMG_1.exr"));
    assert_rejected(&view, ST_IO, "cannot open");
    assert_ok(view_image_write(&im, NULL, scratch_path("IMG_1.exr"), &view, NULL, "approximate", &err), err);
    assert_rejected(&wide, ST_DATA, "has 17 x 33 pixels, but its camera 33 x 17; make the views again.");
    assert_rejected(&narrow, ST_DATA, "its camera 16 x 33");
    assert_int_equal(truncate(scratch_path("IMG_1.exr"), 700), 0);
    assert_rejected(&view, ST_DATA, "make it again");
    scratch_write("IMG_1.exr", "no picture");
    assert_rejected(&view, ST_DATA, "make it again");

    /* nor is one of another size written */
    assert_int_equal(view_image_write(&im, NULL, scratch_path("new/IMG_1.exr"), &wide, NULL, "approximate", &err),
                     ST_INTERNAL);
    assert_err(err, ST_INTERNAL, "a picture of 17 x 33 with 4 channels is not view IMG_1.");
    err = (struct err)ERR_INIT;
    assert_int_equal(view_image_write(&im, NULL, scratch_path("new/IMG_1.exr"), &narrow, NULL, "approximate", &err),
                     ST_INTERNAL);
    err = (struct err)ERR_INIT;
    assert_ok(image_init(&grey, 17, 33, 1, &err), err);
    assert_int_equal(view_image_write(&grey, NULL, scratch_path("new/IMG_1.exr"), &view, NULL, "approximate", &err),
                     ST_INTERNAL);
    assert_err(err, ST_INTERNAL, "with 1 channels");
    assert_int_equal(access(scratch_path("new"), F_OK), -1);
    image_release(&grey);
    image_release(&im);
}

static void missing_and_integer_channels_are_rejected(void **state)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    struct view view = make_view(3, 2);
    (void)state;
    for (int bad = 0; bad < 4; bad++)
        for (int integers = 0; integers < 2; integers++) {
            struct exr_image exr = {0};
            struct err err = ERR_INIT;
            char message[100];
            assert_ok(exr_image_init(&exr, 3, 2, &err), err);
            for (int c = 0; c < 4; c++)
                if (c != bad || integers)
                    assert_ok(exr_add_plane(&exr, names[c], c == bad ? EXR_UINT : EXR_FLOAT, NULL, &err), err);
            assert_ok(exr_write(&exr, scratch_path("IMG_1.exr"), NULL, &err), err);
            snprintf(message, sizeof message,
                     integers ? "channel %s contains integers, wanted half or float" : "no channel %s;", names[bad]);
            assert_rejected(&view, ST_DATA, message);
            exr_image_release(&exr);
        }
}

static void a_failed_write_keeps_the_old_picture(void **state)
{
    struct view view = make_view(17, 33);
    struct image im = make_image(17, 33), back;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(view_image_write(&im, NULL, scratch_path("keep/IMG_1.exr"), &view, NULL, "approximate", &err), err);
    im.data[4 * (20 * 17 + 3) + 1] = NAN;
    assert_int_equal(view_image_write(&im, NULL, scratch_path("keep/IMG_1.exr"), &view, NULL, "approximate", &err),
                     ST_DATA);
    assert_err(err, ST_DATA, "channel G holds NaN or infinity at pixel (3, 20)");
    err = (struct err)ERR_INIT;
    assert_ok(view_image_read(&back, scratch_path("keep"), &view, NULL, &err), err);
    assert_int_equal(count_entries(scratch_path("keep")), 1);
    image_release(&back);
    image_release(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_round_trips),
        cmocka_unit_test(noise_and_marks_are_channels_that_colour_readers_ignore),
        cmocka_unit_test(colours_have_half_precision),
        cmocka_unit_test(radiometry_and_provenance_are_in_the_file),
        cmocka_unit_test(pictures_of_another_size_are_rejected),
        cmocka_unit_test(missing_and_integer_channels_are_rejected),
        cmocka_unit_test(a_failed_write_keeps_the_old_picture),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
