/* linear_picture.c - true pictures seen through other cameras, and what a picture's file excludes. */
#include "stages/evaluate/truth/linear_picture.h"

#include <math.h>

#include "common/image/exr.h"
#include "common/image/photo.h"
#include "tests/unit/scratch.h"

static const struct mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/* A picture whose radiance is a linear function of the tangents x / z and y / z of the ray. */
static struct image tangents(const struct camera *c)
{
    struct image im = {0};
    struct err err = ERR_INIT;
    assert_ok(image_init(&im, c->width, c->height, 3, &err), err);
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            struct vec3 ray;
            assert_true(camera_unproject(c, x + 0.5, y + 0.5, &ray));
            image_at(&im, x, y)[0] = (float)(2 + ray.x / ray.z);
            image_at(&im, x, y)[1] = (float)(2 + ray.y / ray.z);
            image_at(&im, x, y)[2] = 7;
        }
    return im;
}

static void the_same_camera_sees_the_same_values(void **state)
{
    (void)state;
    const struct camera c = {CAMERA_PINHOLE, 30, 20, {18, 18, 14.2, 9.7}};
    const struct picture_map map = {c, c, same};
    struct image truth = tangents(&c), seen = {0};
    struct err err = ERR_INIT;
    int32_t index[600];
    assert_ok(picture_of_truth(&seen, &truth, &map, &err), err);
    picture_true_pixels(index, 30, 20, &map);
    for (int i = 0; i < 600; i++) {
        assert_true(seen.data[4 * i + 3] == 1 && index[i] == i);
        for (int k = 0; k < 3; k++) assert_true(fabsf(seen.data[4 * i + k] - truth.data[3 * i + k]) < 1e-5f);
    }
    image_release(&seen);
    image_release(&truth);
}

static void another_lens_and_a_turned_camera_see_the_same_rays(void **state)
{
    (void)state;
    const struct camera wide = {CAMERA_PINHOLE, 400, 300, {150, 150, 200, 150}};
    const struct camera small = {CAMERA_PINHOLE, 20, 15, {15, 15, 10, 7.5}};
    const double a = 0.3;
    /* the picture's axes are turned about y: true = R picture */
    const struct picture_map map = {small, wide, {{{cos(a), 0, sin(a)}, {0, 1, 0}, {-sin(a), 0, cos(a)}}}};
    struct image truth = tangents(&wide), seen = {0};
    struct err err = ERR_INIT;
    int outside = 0;
    assert_ok(picture_of_truth(&seen, &truth, &map, &err), err);
    for (int y = 0; y < 15; y++)
        for (int x = 0; x < 20; x++) {
            struct vec3 ray;
            assert_true(camera_unproject(&small, x + 0.5, y + 0.5, &ray));
            ray = mat3_apply(map.true_from_picture, ray);
            const float *p = image_at(&seen, x, y);
            outside += p[3] == 0;
            if (p[3] == 0) continue;
            assert_true(fabs(p[0] - 2 - ray.x / ray.z) < 0.004 && fabs(p[1] - 2 - ray.y / ray.z) < 0.004);
        }
    assert_true(outside < 60); /* none but the turned-away columns */
    image_release(&seen);
    image_release(&truth);
}

static void a_truth_of_another_size_is_the_same_picture(void **state)
{
    (void)state;
    const struct camera c = {CAMERA_PINHOLE, 30, 20, {18, 18, 15, 10}};
    const struct camera half = {CAMERA_PINHOLE, 15, 10, {9, 9, 7.5, 5}};
    const struct picture_map map = {c, c, same};
    struct image truth = tangents(&half), seen = {0};
    struct err err = ERR_INIT;
    int32_t index[600];
    assert_ok(picture_of_truth(&seen, &truth, &map, &err), err);
    picture_true_pixels(index, 15, 10, &map);
    assert_int_equal(index[0], 0);
    assert_int_equal(index[599], 149);
    assert_int_equal(index[30 * 11 + 7], 15 * 5 + 3);
    struct vec3 ray;
    assert_true(camera_unproject(&c, 10.5, 8.5, &ray));
    assert_true(fabs(image_at(&seen, 10, 8)[0] - 2 - ray.x / ray.z) < 1e-5);
    image_release(&seen);
    image_release(&truth);
}

static void files_say_what_is_excluded(void **state)
{
    (void)state;
    static const char *const names[] = {"R", "G", "B", "A", "hole"};
    struct exr_image im = {0};
    struct linear_picture p;
    struct err err = ERR_INIT;
    char path[FILE_PATH];
    assert_ok(exr_image_init(&im, 2, 2, &err), err);
    for (int k = 0; k < 5; k++) {
        struct exr_plane *plane;
        assert_ok(exr_add_plane(&im, names[k], EXR_HALF, &plane, &err), err);
        for (int i = 0; i < 4; i++) plane->f[i] = k == 4 ? i == 3 : k == 3 ? i != 2 : i == 1 ? 1 : 0.25f;
    }
    assert_ok(exr_set_attribute(&im, "remodel:radiometry", "approximate", &err), err);
    assert_ok(exr_write(&im, scratch_path("p.exr"), NULL, &err), err);
    exr_image_release(&im);
    assert_true(linear_picture_find(path, scratch_path(""), "p"));
    assert_false(linear_picture_find(path, scratch_path(""), "q"));
    assert_ok(linear_picture_read(&p, scratch_path("p.exr"), &err), err);
    static const uint8_t known[] = {1, 0, 0, 1}, hole[] = {0, 0, 0, 1}; /* clipped at white; outside; a hole */
    assert_memory_equal(p.known, known, 4);
    assert_memory_equal(p.hole, hole, 4);
    assert_false(p.encoded);
    assert_true(p.rgb.data[0] == 0.25f);
    linear_picture_release(&p);

    const unsigned char white[12] = {255, 255, 255, 188, 188, 188, 0, 0, 0, 0, 0, 0};
    assert_ok(png_write(scratch_path("w.png"), white, 2, 2, 3, &err), err);
    assert_ok(linear_picture_read(&p, scratch_path("w.png"), &err), err);
    assert_true(p.encoded && fabsf(p.rgb.data[0] - 1) < 1e-6f && fabsf(p.rgb.data[3] - 0.5029f) < 1e-3f);
    linear_picture_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_camera_sees_the_same_values),
        cmocka_unit_test(another_lens_and_a_turned_camera_see_the_same_rays),
        cmocka_unit_test(a_truth_of_another_size_is_the_same_picture),
        cmocka_unit_test(files_say_what_is_excluded),
    };
    return cmocka_run_group_tests_name("linear_picture", tests, scratch_make, scratch_remove);
}
