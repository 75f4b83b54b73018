/* cameras.txt: lenses against closed forms, poses, the noise of the sensor, and error messages. */
#include "tests/unit/simulate/worlds.h"

#include "common/base/parallel.h"
#include "stages/simulate/sensor.h"
#include "stages/simulate/shoot_file.h"

#define HEAD  "remodel-shoot 1\nlens p pinhole 640 480 500 510 320 240\n"
#define REST  "exposure 0.01\nsensor 30000 5 60 1\n"
#define PHOTO "photo a p 0 0 0 1 0 0\n"

static void assert_invalid(const char *text, const char *words)
{
    struct shoot s;
    struct err err = ERR_INIT;
    scratch_write("cameras.txt", text);
    if (!shoot_read(&s, scratch, 1, NULL, &err)) fail_msg("no error, expected: %s", words);
    assert_err(err, ST_DATA, words);
    assert_contains(err.text, "cameras.txt");
}

static void errors_name_line_found_and_expected_word(void **state)
{
    (void)state;
    assert_invalid("", "is empty");
    assert_invalid("remodel-shoot x\n", ":1: found \"x\"");
    assert_invalid("remodel-scene 1\n", "wanted remodel-shoot");
    assert_invalid(HEAD "camera a\n", ":3: found \"camera\", wanted one of lens, exposure");
    assert_invalid(HEAD "lens p pinhole 640 480 500 500 320 240\n", "no other lens has");
    assert_invalid(HEAD "lens q fish 640 480 500 320 240\n", "pinhole or equisolid");
    assert_invalid(HEAD "lens q pinhole 0 480 500 500 320 240\n", "a width in pixels");
    assert_invalid(HEAD "lens q pinhole 640 480 0 500 320 240\n", "a focal length");
    assert_invalid(HEAD "lens q pinhole 640 480 500 500 641 240\n", "principal point's x");
    assert_invalid(HEAD "lens q equisolid 640 480 200 320 240\n", ":3: found \"a corner 400.0 px off the axis\"");
    assert_invalid(HEAD "exposure 0\n", ":3: found \"0\", wanted an exposure time");
    assert_invalid(HEAD "exposure 1 8\n", ":3: found the end of the line, wanted an ISO speed");
    assert_invalid(HEAD "sensor 1 1 1 1\n", "a full well");
    assert_invalid(HEAD REST "sensor 100 1 1 1\n", "a second sensor");
    assert_invalid(HEAD "quality 101\n", "a JPEG quality");
    assert_invalid(HEAD REST "photo a q 0 0 0 1 0 0\n", ":5: found \"q\", wanted the name of a lens above");
    assert_invalid(HEAD REST PHOTO PHOTO, ":6: found \"a\", wanted a name that no other photo has");
    assert_invalid(HEAD REST "photo a p 0 0 0 0 0 0\n", "another point to look at");
    assert_invalid(HEAD REST "photo a p 0 0 0 1 0 0 tilt 3\n", "found \"tilt\", wanted roll, sun, exposure");
    assert_invalid(HEAD REST "photo a p 0 0 0 1 0 0 exposure 1\n", ":5: found \"1\", wanted the number of an exposure");
    assert_invalid(HEAD "photo a p 0 0 0 1 0 0 exposure 0\n", "wanted an exposure line above");
    assert_invalid(HEAD REST "photo a p 0 0 0 1 0 0 sun 20 91\n", "the sun's elevation");
    assert_invalid(HEAD REST "witness a p 0 0 0 1 0 0 exposure 0\n", "found \"exposure\", wanted roll, sun or the end");
    assert_invalid(HEAD REST "witness a p 0 0 0 1 0 0\n", "is incomplete; add a line: photo");
    assert_invalid(HEAD REST PHOTO "witness a p 0 0 0 1 0 0\n", "found \"a\", wanted a name that no other");
    assert_invalid(HEAD REST "photo -a p 0 0 0 1 0 0\n", "letters, digits");
    assert_invalid(HEAD PHOTO "exposure 1\n", "is incomplete; add a line: sensor");
    assert_invalid(HEAD PHOTO "sensor 30000 5 60 1\n", "is incomplete; add a line: exposure");
    assert_invalid(HEAD REST "reference a p 0 0 0 1 0 0\n", "is incomplete; add a line: photo");
}

static void an_image_circle_ends_at_its_angle(void **state)
{
    struct shoot s;
    struct err err = ERR_INIT;
    struct vec3 ray;
    (void)state;
    /* the circle of 180 degrees touches the edges: 2 f sin(45 degrees) = 240 */
    scratch_write("cameras.txt", HEAD "lens d equisolid 480 480 169.705627 240 240 circle 180\n" REST PHOTO);
    assert_ok(shoot_read(&s, scratch, 1, NULL, &err), err);
    const struct shoot_lens *d = &s.lenses[1];
    assert_true(shoot_lens_ray(d, 479.9, 240, &ray));
    assert_true(fabs(ray.z) < 1e-3);
    assert_near(ray.x, 1, 1e-3);
    assert_true(shoot_lens_ray(d, 240 + 169.7, 240 - 169.7, &ray));
    assert_false(shoot_lens_ray(d, 240 + 169.8, 240 - 169.8, &ray));
    assert_false(shoot_lens_ray(d, 0.5, 0.5, &ray));
    shoot_release(&s);
    assert_invalid(HEAD "lens d equisolid 480 480 169.7 240 240\n", "a field of view below 240 degrees");
    assert_invalid(HEAD "lens d equisolid 480 480 169.7 240 240 circle 240\n", "the degrees across the image circle");
    assert_invalid(HEAD "lens d equisolid 480 480 169.7 240 240 disk\n", "found \"disk\"");
}

static void a_photo_may_have_its_own_sun_and_one_exposure(void **state)
{
    struct shoot s;
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("cameras.txt", HEAD "exposure 0.01\nexposure 0.04 4 200 10\nsensor 30000 5 60 7\n"
                                      "photo a p 1 2 3  1 2 4 sun 30 -5 roll 90 exposure 1\nphoto b p 1 2 3  3 2 3\n"
                                      "witness w p 1 2 3  3 2 3 sun 1 2\n");
    assert_ok(shoot_read(&s, scratch, 1, NULL, &err), err);
    const struct shoot_photo *a = &s.photos[0], *b = &s.photos[1], *w = &s.photos[2];
    assert_true(a->own_sun && a->sun_azimuth == 30 && a->sun_elevation == -5 && a->roll == 90);
    assert_true(shoot_exposures(&s, a).count == 1 && shoot_exposures(&s, a).list[0].seconds == 0.04);
    assert_true(!b->own_sun && shoot_exposures(&s, b).count == 2);
    assert_true(w->kind == SHOOT_WITNESS && w->own_sun && w->sun_elevation == 2);
    shoot_release(&s);
}

static void lenses_exposures_and_poses_are_read(void **state)
{
    struct shoot s;
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("cameras.txt",
                  HEAD "lens f equisolid 600 400 266.666 300 200\nexposure 0.01\nexposure 0.04 4 200 10\n"
                       "reference-exposure 0.001\nsensor 30000 5 60 7\nquality 80\n"
                       "photo a p 1 2 3  1 2 4\nphoto b f 1 2 3  3 2 3 roll 90\nreference r f 0 0 0 0 1 0\n");
    assert_ok(shoot_read(&s, scratch, 0.5, NULL, &err), err);
    assert_true(s.lens_count == 2 && s.photo_count == 3 && s.quality == 80 && s.sensor.seed == 7);
    assert_true(s.lenses[0].width == 320 && s.lenses[0].height == 240 && s.lenses[0].fy == 255 &&
                s.lenses[1].cx == 150);
    assert_near(s.lenses[1].fx, 133.333, 1e-9);
    const struct shoot_exposure_list photos = shoot_exposures(&s, &s.photos[0]),
                                     references = shoot_exposures(&s, &s.photos[2]);
    assert_true(photos.count == 2 && photos.list[0].f_number == 8 && photos.list[0].filter == 1);
    assert_true(photos.list[1].iso == 200 && photos.list[1].filter == 10);
    assert_true(references.count == 1 && references.list[0].seconds == 0.001);
    assert_true(shoot_find(&s, "b") == 1 && shoot_find(&s, "c") == -1);

    /* straight up: world y is up in the image, so world x points left */
    const struct pose *up = &s.photos[0].cam_from_world;
    const struct vec3 p = pose_apply(up, vec3_make(1.5, 2, 4)), c = pose_center(up);
    assert_true(fabs(c.x - 1) + fabs(c.y - 2) + fabs(c.z - 3) < 1e-12);
    assert_true(fabs(p.x + 0.5) < 1e-12 && fabs(p.y) < 1e-12 && fabs(p.z - 1) < 1e-12);
    /* along x, rolled clockwise by 90 degrees: up in the world is left in the image */
    const struct vec3 above = pose_apply(&s.photos[1].cam_from_world, vec3_make(2, 2, 3.5));
    assert_true(fabs(above.x + 0.5) < 1e-12 && fabs(above.y) < 1e-12 && fabs(above.z - 1) < 1e-12);
    shoot_release(&s);
    shoot_release(&s);
}

static void lens_rays_project_back_to_their_pixels(void **state)
{
    (void)state;
    const struct shoot_lens pinhole = {NULL, SHOOT_PINHOLE, 640, 480, 500, 510, 320, 240, 0};
    const struct shoot_lens fish = {NULL, SHOOT_EQUISOLID, 960, 640, 426.667, 426.667, 480, 320, 0};
    struct vec3 ray;
    double u, v;
    assert_true(shoot_lens_ray(&pinhole, 320 + 250, 240 - 102, &ray));
    assert_near(ray.x / ray.z, 0.5, 1e-12);
    assert_near(ray.y / ray.z, -0.2, 1e-12);
    assert_false(shoot_lens_project(&pinhole, vec3_make(0, 0, -1), &u, &v));
    /* r = 2 f sin(theta / 2) */
    assert_true(shoot_lens_ray(&fish, 480 + 2 * 426.667 * sin(0.6), 320, &ray));
    assert_near(atan2(ray.x, ray.z), 1.2, 1e-12);
    assert_false(shoot_lens_ray(&fish, 480 + 854, 320, &ray));

    const struct camera series = shoot_lens_camera(&fish);
    assert_int_equal(series.model, CAMERA_OPENCV_FISHEYE);
    for (int i = 0; i < 200; i++) {
        const double x = 960 * (i % 17 / 16.0), y = 640 * (i % 13 / 12.0);
        const struct shoot_lens *both[2] = {&pinhole, &fish};
        for (int k = 0; k < 2; k++) {
            assert_true(shoot_lens_ray(both[k], x, y, &ray));
            assert_near(vec3_length(ray), 1, 1e-12);
            assert_true(shoot_lens_project(both[k], vec3_scale(ray, 3), &u, &v));
            assert_true(fabs(u - x) < 1e-9 && fabs(v - y) < 1e-9);
            const struct camera c = shoot_lens_camera(both[k]);
            assert_true(camera_project(&c, ray, &u, &v));
            assert_true(fabs(u - x) < 1e-4 && fabs(v - y) < 1e-4); /* the series is truncated */
        }
    }
}

static void sensor_noise_has_its_mean_and_variance(void **state)
{
    (void)state;
    enum { SIDE = 200 };
    struct image im = {0};
    struct err err = ERR_INIT;
    const struct shoot_sensor sensor = {1000, 8, 50, 1};
    const struct shoot_exposure exposure = {0.02, 4, 200, 2}; /* 0.02 * 2 * 4 / 2: four times f/8, ISO 100 */
    const struct rng rng = rng_make(1, "test", "sensor");
    unsigned char *rgb = malloc(SIDE * SIDE * 3), *again = malloc(SIDE * SIDE * 3);
    assert_ok(image_init(&im, SIDE, SIDE, 3, &err), err);
    const double levels[3] = {0.02, 0.1, 0.3}; /* signals; the radiance is a quarter, because gain * seconds is 1 */
    for (int i = 0; i < SIDE * SIDE * 3; i++) im.data[i] = (float)(levels[i % 3] / 4);
    sensor_expose(rgb, &im, &sensor, &exposure, &rng);
    for (int c = 0; c < 3; c++) {
        double mean = 0, square = 0;
        for (int i = c; i < SIDE * SIDE * 3; i += 3) {
            const double x = (double)linear_from_srgb((float)rgb[i] / 255);
            mean += x / (SIDE * SIDE);
            square += x * x / (SIDE * SIDE);
        }
        /* at ISO 200, white is 500 electrons */
        const double variance = (levels[c] * 500 + 64) / (500.0 * 500);
        if (c) assert_near(mean, levels[c], 0.005); /* noise is clipped near black */
        if (c) assert_near(square - mean * mean, variance, 0.03);
        if (!c) assert_true(mean > levels[c] && mean < 1.3 * levels[c]);
    }
    parallel_set_threads(1);
    sensor_expose(again, &im, &sensor, &exposure, &rng);
    parallel_set_threads(0);
    assert_memory_equal(rgb, again, SIDE * SIDE * 3);

    /* almost no noise: the sRGB curve itself, and white above 1 */
    const struct shoot_sensor quiet = {1e9, 0, 1, 1};
    const struct shoot_exposure plain = {1, 8, 100, 1};
    for (int i = 0; i < SIDE * SIDE * 3; i++) im.data[i] = (float)i / 60000;
    sensor_expose(rgb, &im, &quiet, &plain, &rng);
    for (int i = 0; i < SIDE * SIDE * 3; i++)
        assert_true(fabs(rgb[i] - 255 * (double)srgb_from_linear(im.data[i])) < 0.6);
    assert_int_equal(rgb[SIDE * SIDE * 3 - 1], 255);
    image_release(&im);
    free(rgb);
    free(again);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_name_line_found_and_expected_word),
        cmocka_unit_test(lenses_exposures_and_poses_are_read),
        cmocka_unit_test(an_image_circle_ends_at_its_angle),
        cmocka_unit_test(a_photo_may_have_its_own_sun_and_one_exposure),
        cmocka_unit_test(lens_rays_project_back_to_their_pixels),
        cmocka_unit_test(sensor_noise_has_its_mean_and_variance),
    };
    return cmocka_run_group_tests_name("simulate shoot", tests, scratch_make, scratch_remove);
}
