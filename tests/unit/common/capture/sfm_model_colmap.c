/* sfm_model_colmap.c - models in COLMAP's text format: reading, writing without loss, errors. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/capture/sfm_model.h"

static const char cameras_ok[] =
    "# cameras\n7 SIMPLE_RADIAL 640 480 500 320 240 -0.1\n3 PINHOLE 800 600 510 520 400 300\n";
static const char images_ok[] = "# Image list\n"
                                "5 1 0 0 0 0.5 0 2 7 b one.jpg\n"
                                "10.5 20.25 9 30 40 -1 50 60 4\n"
                                "2 0 0 2 0 1 2 3 3 a.jpg\n"
                                "1 2 4 3 4 9\n"
                                "8 1 0 0 0 0 0 0 3 c.jpg\n"
                                "\n";
static const char points_ok[] = "9 1 2 3 255 0 128 0.75 5 0 2 1\n4 -1 -2 3.5 1 2 3 -1 2 0 5 2\n";

static void write_model(const char *cameras, const char *images, const char *points)
{
    scratch_write("cameras.txt", cameras);
    scratch_write("images.txt", images);
    scratch_write("points3D.txt", points);
}

static void check_example(const struct sfm_model *m)
{
    assert_int_equal(m->camera_count, 2);
    assert_int_equal(m->image_count, 3);
    assert_int_equal(m->point_count, 2);
    assert_string_equal(m->images[0].name, "a.jpg");
    assert_string_equal(m->images[1].name, "b one.jpg");
    assert_int_equal(m->images[1].id, 5);
    assert_int_equal(m->cameras[m->images[1].camera_idx].id, 7);
    assert_int_equal(m->images[2].observation_count, 0);
    assert_true(m->images[0].cam_from_world.rotation.y == 1); /* normalised from length 2 */
    assert_true(m->images[1].observations[0].v == 20.25 && m->images[1].observations[1].point_id == -1);
    assert_int_equal(m->points[0].id, 4);
    assert_true(m->points[0].error == -1 && m->points[1].error == 0.75);
    assert_int_equal(m->points[1].rgb[2], 128);
    assert_int_equal(m->points[1].track[0].image_idx, 1); /* by image, not by id */
    assert_int_equal(m->points[1].track[0].observation_idx, 0);
    assert_int_equal(m->points[1].track[1].image_idx, 0);
}

static void images_are_read_in_order_of_name(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err = ERR_INIT;
    write_model(cameras_ok, images_ok, points_ok);
    assert_ok(sfm_model_read_text(&m, scratch, NULL, &err), err);
    check_example(&m);
    sfm_model_release(&m);
    sfm_model_release(&m);
    sfm_model_release(NULL);
}

/* CRLF line ends, and a file that ends before the blank second line of the last image. */
static void crlf_and_a_missing_last_line_are_accepted(void **state)
{
    (void)state;
    const char *texts[] = {cameras_ok, images_ok, points_ok}, *names[] = {"cameras.txt", "images.txt", "points3D.txt"};
    struct sfm_model m;
    struct err err = ERR_INIT;
    for (int i = 0; i < 3; i++) {
        char text[1024];
        size_t n = 0, size = strlen(texts[i]) - (i == 1);
        for (size_t k = 0; k < size; k++) {
            if (texts[i][k] == '\n') text[n++] = '\r';
            text[n++] = texts[i][k];
        }
        scratch_write_bytes(names[i], text, n);
    }
    assert_ok(sfm_model_read_text(&m, scratch, NULL, &err), err);
    check_example(&m);
    sfm_model_release(&m);
}

/* Random values of very different magnitudes; writing twice gives the same bytes. */
static void writing_and_reading_keeps_every_bit(void **state)
{
    (void)state;
    enum { IMAGES = 5, POINTS = 200 };
    struct rng rng = rng_make(3, "sfm_model", "test");
    struct sfm_model m = {0}, n, o;
    struct err err = ERR_INIT;
    char a[300], b[300];
    m.cameras = calloc(CAMERA_MODEL_COUNT, sizeof *m.cameras);
    m.images = calloc(IMAGES, sizeof *m.images);
    m.points = calloc(POINTS, sizeof *m.points);
    m.camera_count = CAMERA_MODEL_COUNT;
    m.image_count = IMAGES;
    m.point_count = POINTS;
    for (int i = 0; i < CAMERA_MODEL_COUNT; i++) {
        m.cameras[i] = (struct sfm_camera){i + 10, {(enum camera_model)i, 100 + i, 200, {0}}};
        for (int k = 0; k < camera_model_params((enum camera_model)i); k++)
            m.cameras[i].camera.params[k] = rng_uniform(&rng, 1, (uint64_t)(i * 100 + k)) * pow(10, k - 6);
    }
    for (int i = 0; i < IMAGES; i++) {
        struct sfm_image *im = &m.images[i];
        double q[4], n2 = 0;
        for (int k = 0; k < 4; k++) {
            q[k] = rng_uniform(&rng, 2, (uint64_t)(i * 4 + k)) - 0.5;
            n2 += q[k] * q[k];
        }
        n2 = sqrt(n2);
        im->id = 100 - i;
        im->camera_idx = i;
        im->name = malloc(32);
        snprintf(im->name, 32, "view %d.exr", i);
        im->cam_from_world.rotation = (struct quat){q[0] / n2, q[1] / n2, q[2] / n2, q[3] / n2};
        im->cam_from_world.translation = vec3_make(q[0] * 1e-9, q[1] * 1e9, 1.0 / 3);
        im->observations = calloc(POINTS, sizeof *im->observations);
        im->observation_count = POINTS;
    }
    for (int i = 0; i < POINTS; i++) {
        struct sfm_point *p = &m.points[i];
        p->id = 3 * i + 1;
        p->position =
            vec3_make(rng_uniform(&rng, 3, (uint64_t)i) * 1e-30, -rng_uniform(&rng, 4, (uint64_t)i), i * 1e20);
        p->error = rng_uniform(&rng, 5, (uint64_t)i);
        p->track = calloc(IMAGES, sizeof *p->track);
        p->track_count = IMAGES;
        for (int k = 0; k < IMAGES; k++) {
            m.images[k].observations[i] =
                (struct sfm_observation){rng_uniform(&rng, 6, (uint64_t)(i * 9 + k)) * 1e3, -0.0, p->id};
            p->track[k] = (struct sfm_track){IMAGES - 1 - k, i};
        }
    }
    snprintf(a, sizeof a, "%s/a", scratch);
    snprintf(b, sizeof b, "%s/b", scratch);
    assert_ok(sfm_model_write_text(&m, a, NULL, &err), err);
    assert_ok(sfm_model_read_text(&n, a, NULL, &err), err);
    assert_ok(sfm_model_write_text(&n, b, NULL, &err), err);
    assert_ok(sfm_model_read_text(&o, b, NULL, &err), err);
    const char *names[] = {"cameras.txt", "images.txt", "points3D.txt"};
    for (int i = 0; i < 3; i++) {
        char path[400];
        snprintf(path, sizeof path, "%s/%s", a, names[i]);
        char *text = scratch_read(path);
        snprintf(path, sizeof path, "%s/%s", b, names[i]);
        assert_file_text(path, text);
        free(text);
    }
    for (int i = 0; i < CAMERA_MODEL_COUNT; i++)
        assert_memory_equal(m.cameras[i].camera.params, n.cameras[i].camera.params, sizeof n.cameras[i].camera.params);
    for (int i = 0; i < IMAGES; i++) {
        assert_memory_equal(&m.images[i].cam_from_world, &n.images[i].cam_from_world, sizeof(struct pose));
        assert_memory_equal(m.images[i].observations, n.images[i].observations,
                            POINTS * sizeof(struct sfm_observation));
    }
    for (int i = 0; i < POINTS; i++) {
        assert_memory_equal(&m.points[i].position, &n.points[i].position, sizeof(struct vec3));
        assert_memory_equal(m.points[i].track, n.points[i].track, IMAGES * sizeof(struct sfm_track));
    }
    sfm_model_release(&m);
    sfm_model_release(&n);
    sfm_model_release(&o);
}

static void errors_name_the_file_and_line(void **state)
{
    (void)state;
    static const struct {
        const char *cameras, *images, *points, *message;
    } bad[] = {
        {"1 DIVISION 640 480 500 500 320 240 0.9\n", images_ok, points_ok, "cameras.txt:1: found \"DIVISION\""},
        {"1 DIVISION 640 480 500 500 320 240 0.9\n", images_ok, points_ok, "OPENCV_FISHEYE"},
        {"7 PINHOLE 640 480 500 nan 320 240\n", images_ok, points_ok, "cameras.txt:1: found \"nan\""},
        {"7 PINHOLE 640 480 500 0 320 240\n", images_ok, points_ok, "focal length is 0"},
        {"7 PINHOLE 640 480 500 500 320\n", images_ok, points_ok, "cameras.txt:1: found the end of the line"},
        {"7 PINHOLE 640 0 500 500 320 240\n", images_ok, points_ok, "cameras.txt:1: found \"0\", wanted height"},
        {"7 SIMPLE_PINHOLE 9 9 9 9 9\n7 SIMPLE_PINHOLE 9 9 9 9 9\n", images_ok, points_ok,
         "cameras.txt:2: found camera 7 a second time (first on line 1)"},
        {cameras_ok, "", points_ok, "images.txt contains no image"},
        {cameras_ok, "1 0 0 0 0 0 0 0 3 a.jpg\n\n", "", "images.txt:1: found \"0 0 0 0\", wanted a quaternion"},
        {cameras_ok, "1 1 0 0 0 0 0 0 4 a.jpg\n\n", "", "images.txt:1: found \"camera 4\""},
        {cameras_ok, "1 1 0 0 0 0 0 0 3 a.jpg\n\n2 1 0 0 0 0 0 0 3 a.jpg\n\n", "",
         "images.txt:3: found image \"a.jpg\" a second time (first on line 1)"},
        {cameras_ok, "1 1 0 0 0 0 0 0 3 a.jpg\n\n1 1 0 0 0 0 0 0 3 b.jpg\n\n", "",
         "images.txt:3: found image 1 a second time (first on line 1)"},
        {cameras_ok, "1 1 0 0 0 0 0 0 3 a.jpg\n5 6\n", "", "images.txt:2: found the end of the line"},
        {cameras_ok, "1 1 0 0 0 0 0 0 3 a.jpg\n5 6 7\n", "", "images.txt:2: found that observation 0"},
        {cameras_ok, images_ok, "9 1 2 3 255 0 128 0.75 5 0 2 1\n4 -1 -2 3.5 1 2 3 -1 2 0\n", "in that point's track"},
        {cameras_ok, images_ok, "9 1 2 3 255 0 128 0.75 6 0\n", "points3D.txt:1: found \"image 6\""},
        {cameras_ok, images_ok, "9 1 2 3 255 0 128 0.75 5 3\n", "wanted one of that image's 3 observations"},
        {cameras_ok, images_ok, "9 1 2 3 255 0 128 0.75 5 1\n",
         "wanted an observation that images.txt assigns to point 9"},
        {cameras_ok, images_ok, "9 1 2 3 255 0 128 0.75 5 0 5 0\n", "wanted each observation once"},
        {cameras_ok, images_ok, "9 1 2 3 256 0 128 0.75\n", "points3D.txt:1: found \"256\""},
        {cameras_ok, images_ok, "9 1 2 3 5 0 128 0.75 5\n", "points3D.txt:1: found the end of the line"},
        {cameras_ok, "1 1 0 0 0 0 0 0 3 a.jpg\n\n", "8 1 1 1 0 0 0 0\n5 1 1 1 0 0 0 0\n8 1 1 1 0 0 0 0\n",
         "points3D.txt:3: found point 8 a second time (first on line 1)"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct sfm_model m;
        struct err err = ERR_INIT;
        write_model(bad[i].cameras, bad[i].images, bad[i].points);
        assert_int_not_equal(sfm_model_read_text(&m, scratch, NULL, &err), ST_OK);
        assert_err(err, ST_DATA, bad[i].message);
        assert_null(m.images);
        assert_null(m.points);
    }
}

static void a_missing_file_is_named(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err = ERR_INIT;
    write_model(cameras_ok, images_ok, points_ok);
    unlink(scratch_path("points3D.txt"));
    assert_int_equal(sfm_model_read_text(&m, scratch, NULL, &err), ST_IO);
    assert_contains(err.text, "points3D.txt");
}

static void image_names_with_line_breaks_are_rejected(void **state)
{
    (void)state;
    char bad[] = "a\nb.jpg";
    struct sfm_camera camera = {1, {CAMERA_SIMPLE_PINHOLE, 4, 3, {5, 2, 1.5}}};
    struct sfm_image image = {.id = 1, .cam_from_world.rotation.w = 1, .name = bad};
    struct sfm_model m = {.cameras = &camera, .images = &image, .camera_count = 1, .image_count = 1};
    struct err err = ERR_INIT;
    assert_int_equal(sfm_model_write_text(&m, scratch, NULL, &err), ST_DATA);
}

static void cameras_are_read_without_points(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err = ERR_INIT;
    scratch_write("cameras.txt", "1 PINHOLE 4 3 2 2 2 1.5\n");
    scratch_write("images.txt", "# a comment\n2 1 0 0 0 1 2 3 1 b.jpg\n0.5 0.5 7\n1 1 0 0 0 0 0 0 1 a.jpg\n\n");
    remove(scratch_path("points3D.txt"));
    assert_ok(sfm_model_read_cameras(&m, scratch, NULL, &err), err);
    assert_int_equal(m.image_count, 2);
    assert_string_equal(m.images[1].name, "b.jpg");
    assert_true(m.images[1].cam_from_world.translation.z == 3);
    assert_int_equal(m.images[1].observation_count, 0);
    assert_int_equal(m.point_count, 0);
    sfm_model_release(&m);
    remove(scratch_path("images.txt"));
    assert_int_equal(sfm_model_read_cameras(&m, scratch, NULL, &err), ST_IO);
    assert_err(err, ST_IO, "images.txt");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_are_read_in_order_of_name),
        cmocka_unit_test(crlf_and_a_missing_last_line_are_accepted),
        cmocka_unit_test(writing_and_reading_keeps_every_bit),
        cmocka_unit_test(errors_name_the_file_and_line),
        cmocka_unit_test(a_missing_file_is_named),
        cmocka_unit_test(image_names_with_line_breaks_are_rejected),
        cmocka_unit_test(cameras_are_read_without_points),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
