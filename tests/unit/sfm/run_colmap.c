/* run_colmap.c - what is decided before COLMAP runs and read from its log afterwards; COLMAP itself is not needed. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/sfm/run_colmap.h"

static void lens_parameters_must_fit_the_model(void **state)
{
    (void)state;
    static const struct {
        const char *model, *params, *refine, *words; /* words NULL: good */
    } cases[] = {
        {"SIMPLE_RADIAL", "", "yes", NULL},
        {"SIMPLE_RADIAL", "500,320,240,-0.1", "yes", NULL},
        {"PINHOLE", "500, 510, 320, 2.4e2", "no", NULL},
        {"OPENCV_FISHEYE", "500,500,320,240,0,0,0,0", "no", NULL},
        {"SIMPLE_RADIAL", "", "no", "needs the lens"},
        {"SIMPLE_RADIAL", "500,320,240", "yes", "wanted the 4 numbers of SIMPLE_RADIAL"},
        {"PINHOLE", "500,500,320,240,0", "yes", "wanted the 4 numbers of PINHOLE"},
        {"PINHOLE", "500,500,320,", "yes", "wanted the 4 numbers"},
        {"PINHOLE", "500 500 320 240", "yes", "wanted the 4 numbers"},
        {"PINHOLE", "500,0,320,240", "yes", "focal length is 0"},
        {"PINHOLE", "500,nan,320,240", "yes", "parameter 2"},
        {"EQUISOLID", "", "yes", NULL},
        {"EQUISOLID", "426.7", "no", NULL},
        {"EQUISOLID", "426.7,480,320", "yes", NULL},
        {"EQUISOLID", "", "no", "needs the lens"},
        {"EQUISOLID", "0", "yes", "focal length is 0"},
        {"EQUISOLID", "426.7,480", "yes", "wanted F or F,CX,CY of EQUISOLID"},
        {"EQUISOLID", "426.7,426.7,480,320,0,0,0,0", "yes", "wanted F or F,CX,CY of EQUISOLID"},
        {"EQUISOLID", "wide", "yes", "wanted F or F,CX,CY of EQUISOLID"},
        {"PINHOLE", "1,2,3,4,5,6,7,8,9,10,11,12,13,14", "yes", "wanted the 4 numbers"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct sfm_params p = SFM_PARAMS_DEFAULT;
        struct err err = ERR_INIT;
        snprintf(p.camera_model, sizeof p.camera_model, "%s", cases[i].model);
        snprintf(p.camera_params, sizeof p.camera_params, "%s", cases[i].params);
        snprintf(p.refine_camera, sizeof p.refine_camera, "%s", cases[i].refine);
        if (cases[i].words) {
            assert_int_equal(sfm_params_check(&p, &err), ST_USAGE);
            assert_err(err, ST_USAGE, cases[i].words);
        } else {
            assert_ok(sfm_params_check(&p, &err), err);
        }
    }
}

static void one_lens_only_where_photos_are_alike(void **state)
{
    (void)state;
    char ids[2][2] = {"a", "b"}, files[2][8] = {"a.jpg", "b.jpg"};
    struct photo_record photos[2] = {
        {.id = ids[0], .file = files[0], .info = {.width = 640, .height = 480, .focal_mm = 35, .make = "M"}},
        {.id = ids[1], .file = files[1], .info = {.width = 640, .height = 480, .focal_mm = 35, .make = "M"}},
    };
    struct photo_list list = {photos, 2};
    struct sfm_params p = SFM_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    bool single = false;
    assert_ok(sfm_single_camera(&single, &list, &p, &err), err);
    assert_true(single);
    photos[1].info.focal_mm = 50; /* zoomed */
    assert_ok(sfm_single_camera(&single, &list, &p, &err), err);
    assert_false(single);
    strcpy(p.single_camera, "yes"); /* the user knows better */
    assert_ok(sfm_single_camera(&single, &list, &p, &err), err);
    assert_true(single);
    photos[1].info.focal_mm = 35;
    strcpy(p.single_camera, "no");
    assert_ok(sfm_single_camera(&single, &list, &p, &err), err);
    assert_false(single);
    photos[1].info.width = 480;
    photos[1].info.height = 640;
    strcpy(p.single_camera, "auto");
    assert_ok(sfm_single_camera(&single, &list, &p, &err), err);
    assert_false(single);
    strcpy(p.single_camera, "yes");
    assert_int_equal(sfm_single_camera(&single, &list, &p, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "\"b.jpg\" 480 x 640 px");
}

static void pngs_bring_the_lens_of_their_exif(void **state)
{
    (void)state;
    char ids[2][2] = {"a", "b"}, files[2][8] = {"a.png", "b.PNG"}, text[SFM_LENS_TEXT];
    struct photo_record photos[2] = {
        {.id = ids[0], .file = files[0], .info = {.width = 640, .height = 480, .focal35_mm = 70}},
        {.id = ids[1], .file = files[1], .info = {.width = 640, .height = 480, .focal35_mm = 70}},
    };
    struct photo_list list = {photos, 2};
    struct sfm_params p = SFM_PARAMS_DEFAULT;
    sfm_png_lens(text, &list, &p);
    assert_string_equal(text, "1280,320,240,0");
    struct err err = ERR_INIT;
    for (int m = 0; m < CAMERA_MODEL_COUNT; m++) { /* as many numbers as the model has */
        strcpy(p.camera_model, camera_model_name(m));
        sfm_png_lens(text, &list, &p);
        strcpy(p.camera_params, text);
        assert_ok(sfm_params_check(&p, &err), err);
    }
    photos[1].info.focal35_mm = 0;
    sfm_png_lens(text, &list, &p);
    assert_string_equal(text, "");
    photos[1].info.focal35_mm = 70;
    strcpy(files[1], "b.jpg"); /* COLMAP reads that itself */
    sfm_png_lens(text, &list, &p);
    assert_string_equal(text, "");
    sfm_png_lens(text, &(struct photo_list){0}, &p);
    assert_string_equal(text, "");
}

/* The numbers that COLMAP gets are those of r = 2 f sin(theta / 2), wherever the focal length comes from. */
static void an_equisolid_lens_is_written_as_opencv_fisheye(void **state)
{
    (void)state;
    char ids[2][2] = {"a", "b"}, files[2][8] = {"a.jpg", "b.jpg"}, text[SFM_LENS_TEXT];
    struct photo_record photos[2] = {
        {.id = ids[0], .file = files[0], .info = {.width = 960, .height = 640, .focal35_mm = 16}},
        {.id = ids[1], .file = files[1], .info = {.width = 960, .height = 640, .focal35_mm = 16}},
    };
    const struct photo_list list = {photos, 2};
    struct sfm_params p = SFM_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    strcpy(p.camera_model, "EQUISOLID");
    static const struct {
        const char *given;
        double focal, cx, cy;
    } cases[] = {{"", 1280 / 3.0, 480, 320}, {"500", 500, 480, 320}, {"500,470.5,330.25", 500, 470.5, 330.25}};
    for (int i = 0; i < 3; i++) {
        struct camera c = {CAMERA_OPENCV_FISHEYE, 960, 640, {0}};
        strcpy(p.camera_params, cases[i].given);
        assert_ok(sfm_params_check(&p, &err), err);
        assert_ok(sfm_equisolid_lens(text, &list, &p, &err), err);
        char *at = text;
        for (int k = 0; k < 8; k++, at++) {
            c.params[k] = strtod(at, &at);
            assert_true(*at == (k < 7 ? ',' : '\0'));
        }
        for (double degrees = 0; degrees <= 90; degrees += 5) {
            const double theta = degrees * M_PI / 180;
            double u, v;
            assert_true(camera_project(&c, (struct vec3){sin(theta), 0, cos(theta)}, &u, &v));
            assert_true(fabs(u - cases[i].cx - 2 * cases[i].focal * sin(theta / 2)) < 1e-3);
            assert_true(fabs(v - cases[i].cy) < 1e-9);
        }
    }
    *p.camera_params = '\0';
    photos[1].info.focal35_mm = 0;
    assert_int_equal(sfm_equisolid_lens(text, &list, &p, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "EXIF of photo \"b.jpg\" does not state it");
    assert_contains(err.text, "Set camera_params = F in pixels");
    assert_contains(err.text, "times 960");
    err = (struct err)ERR_INIT;
    photos[1].info.focal35_mm = 24;
    assert_int_equal(sfm_equisolid_lens(text, &list, &p, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "\"a.jpg\" and \"b.jpg\" differ in focal length");
    err = (struct err)ERR_INIT;
    strcpy(p.camera_params, "500");
    photos[1].info.width = 640;
    assert_int_equal(sfm_equisolid_lens(text, &list, &p, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "differ in size");
}

static void features_are_counted_from_the_log(void **state)
{
    (void)state;
    const char *log =
        "WARNING: ...\n\nProcessed file [1/3]\n  Name:            b.jpg\n"
        "  ERROR: Failed to read image file format.\nProcessed file [2/3]\n  Name:            c.png\n"
        "  Dimensions:      300 x 300\n  Features:        0\nProcessed file [3/3]\n  Name:            a.jpg\n"
        "  Features:        2113\nElapsed time: 0.007 [minutes]\n";
    struct feature_counts c;
    struct err err = ERR_INIT;
    assert_ok(feature_counts_read(&c, scratch_write("log", log), &err), err);
    assert_int_equal(c.count, 3);
    assert_string_equal(c.list[0].name, "b.jpg");
    assert_int_equal(c.list[0].features, -1);
    assert_int_equal(c.list[1].features, 0);
    assert_int_equal(c.list[2].features, 2113);
    feature_counts_release(&c);
    feature_counts_release(&c);
    feature_counts_release(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lens_parameters_must_fit_the_model),
        cmocka_unit_test(one_lens_only_where_photos_are_alike),
        cmocka_unit_test(pngs_bring_the_lens_of_their_exif),
        cmocka_unit_test(an_equisolid_lens_is_written_as_opencv_fisheye),
        cmocka_unit_test(features_are_counted_from_the_log),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
