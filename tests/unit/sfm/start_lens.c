/* start_lens.c - the lens that COLMAP starts from. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/sfm/start_lens.h"

static void photos_share_a_lens_if_size_and_exif_agree(void **state)
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
    strcpy(p.single_camera, "yes"); /* the user decides */
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

static void frames_of_one_clip_share_a_lens(void **state)
{
    (void)state;
    char ids[3][12] = {"a", "b", "c"}, files[3][20] = {"walk_f000000.png", "walk_f000012.png", "room_f000003.png"};
    struct photo_record photos[3];
    for (int i = 0; i < 3; i++)
        photos[i] = (struct photo_record){.id = ids[i], .file = files[i], .info = {.width = 640, .height = 480}};
    struct photo_list list = {photos, 2};
    struct sfm_params p = SFM_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    bool single = false;
    assert_ok(sfm_single_camera(&single, &list, &p, &err), err);
    assert_true(single);
    list.count = 3; /* another clip */
    assert_ok(sfm_single_camera(&single, &list, &p, &err), err);
    assert_false(single);
    strcpy(files[2], "c.png"); /* a photo */
    assert_ok(sfm_single_camera(&single, &list, &p, &err), err);
    assert_false(single);
}

static void pngs_start_from_the_focal_length_in_exif(void **state)
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
    strcpy(files[1], "b.jpg"); /* COLMAP reads its EXIF */
    sfm_png_lens(text, &list, &p);
    assert_string_equal(text, "");
    sfm_png_lens(text, &(struct photo_list){0}, &p);
    assert_string_equal(text, "");
}

/* The parameters given to COLMAP follow r = 2 f sin(theta / 2), from EXIF and from camera_params. */
static void an_equisolid_lens_becomes_opencv_fisheye_parameters(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photos_share_a_lens_if_size_and_exif_agree),
        cmocka_unit_test(frames_of_one_clip_share_a_lens),
        cmocka_unit_test(pngs_start_from_the_focal_length_in_exif),
        cmocka_unit_test(an_equisolid_lens_becomes_opencv_fisheye_parameters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
