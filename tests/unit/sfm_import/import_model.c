/* import_model.c - models of a made-up scene with known cameras: matching by name, errors computed anew, rectified
 * pixels. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/capture/camera_set.h"
#include "common/capture/photo_match.h"
#include "stages/sfm_import/import_model.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

enum { PHOTOS = 4, POINTS = 300 };

static const struct camera radial = {CAMERA_SIMPLE_RADIAL, 640, 480, {520, 320, 240, -0.12}};
static const struct camera fisheye = {CAMERA_OPENCV_FISHEYE, 1000, 1000, {320, 320, 500, 500}};

/* Photos p0 .. p3 in files "p0.jpg" .. */
static void make_photos(struct photo_list *list, const struct camera *lens)
{
    list->photos = calloc(PHOTOS, sizeof *list->photos);
    list->count = PHOTOS;
    for (int i = 0; i < PHOTOS; i++) {
        struct photo_record *r = &list->photos[i];
        r->id = malloc(32);
        r->file = malloc(32);
        snprintf(r->id, 32, "p%d", i);
        snprintf(r->file, 32, "p%d.jpg", i);
        snprintf(r->hash, sizeof r->hash, "%032d", i);
        r->info.width = lens->width;
        r->info.height = lens->height;
    }
}

/* Cameras in a row along x, points in front of them (around them for the fisheye), observed exactly. */
static void make_model(struct sfm_model *m, const struct camera *lens)
{
    struct rng rng = rng_make(11, "import", "test");
    *m = (struct sfm_model){0};
    m->cameras = calloc(1, sizeof *m->cameras);
    m->images = calloc(PHOTOS, sizeof *m->images);
    m->points = calloc(POINTS, sizeof *m->points);
    m->camera_count = 1;
    m->image_count = PHOTOS;
    m->cameras[0] = (struct sfm_camera){1, *lens};
    for (int i = 0; i < PHOTOS; i++) {
        double a = 0.03 * (i - 1.5);
        m->images[i] = (struct sfm_image){.id = 10 + i, .cam_from_world = {{cos(a), 0, sin(a), 0}, {0.4 * i, 0, 0.1}}};
        m->images[i].name = malloc(32);
        snprintf(m->images[i].name, 32, "p%d.jpg", i);
        m->images[i].observations = calloc(POINTS, sizeof(struct sfm_observation));
    }
    for (int i = 0; i < POINTS; i++) {
        double r[3];
        for (int k = 0; k < 3; k++) r[k] = rng_uniform(&rng, (uint64_t)i, (uint64_t)k) * 2 - 1;
        bool around = lens->model == CAMERA_OPENCV_FISHEYE;
        struct sfm_point p = {.id = 2 * i + 5, .rgb = {1, 2, (uint8_t)i}, .error = 0.1};
        p.position = around ? vec3_scale(vec3_normalize(vec3_make(r[0], r[1], r[2])), 6 + r[0])
                            : vec3_make(r[0] * 3, r[1] * 2, 6 + r[2]);
        p.track = calloc(PHOTOS, sizeof *p.track);
        for (int k = 0; k < PHOTOS; k++) {
            struct sfm_image *im = &m->images[k];
            double u, v;
            if (!camera_project(lens, pose_apply(&im->cam_from_world, p.position), &u, &v) || u < 0 || v < 0 ||
                u > lens->width || v > lens->height)
                continue;
            p.track[p.track_count++] = (struct sfm_track){k, im->observation_count};
            im->observations[im->observation_count++] = (struct sfm_observation){u, v, p.id};
        }
        m->points[m->point_count++] = p;
    }
}

static void rename_image(struct sfm_model *m, int image, const char *name)
{
    free(m->images[image].name);
    m->images[image].name = strdup(name);
}

static const struct import_params defaults = IMPORT_PARAMS_DEFAULT;

/* Every observation of the result lies where its view's pinhole camera sees the point. */
static void check_pixels(const struct imported *in, double tolerance)
{
    for (int i = 0; i < in->model.point_count; i++) {
        const struct sfm_point *p = &in->model.points[i];
        assert_true(i == 0 || p[-1].id < p->id);
        assert_true(p->track_count >= 2);
        for (int k = 0; k < p->track_count; k++) {
            const struct sfm_image *im = &in->model.images[p->track[k].image_idx];
            const struct camera *c = &in->model.cameras[im->camera_idx].camera;
            const struct sfm_observation *o = &im->observations[p->track[k].observation_idx];
            double u = 0, v = 0;
            assert_true(camera_project(c, pose_apply(&im->cam_from_world, p->position), &u, &v));
            assert_true(o->point_id == p->id && hypot(u - o->u, v - o->v) <= tolerance);
            assert_true(o->u >= 0 && o->v >= 0 && o->u <= c->width && o->v <= c->height);
        }
    }
}

static void a_perfect_model_comes_through(void **state)
{
    (void)state;
    struct sfm_model m;
    struct photo_list photos;
    struct imported out;
    struct err err = ERR_INIT;
    make_model(&m, &radial);
    make_photos(&photos, &radial);
    assert_ok(import_model(&out, &m, &photos, &defaults, &err), err);
    assert_int_equal(out.stats.registered, PHOTOS);
    assert_int_equal(out.stats.dropped, 0);
    assert_true(out.stats.mean_error < 1e-9 && out.stats.median_error < 1e-9);
    assert_near(out.stats.stated_error, 0.1, 1e-12);
    assert_int_equal(out.model.image_count, PHOTOS);
    assert_true(out.model.point_count > POINTS / 2);
    check_pixels(&out, 1e-8);
    for (int i = 0; i < PHOTOS; i++) {
        assert_int_equal(out.model.images[i].id, i + 1);
        assert_int_equal(out.model.cameras[i].id, i + 1);
        assert_int_equal(out.model.cameras[i].camera.model, CAMERA_PINHOLE);
        assert_memory_equal(out.lenses.lenses[i].camera.params, radial.params, sizeof radial.params);
        assert_memory_equal(&out.model.images[i].cam_from_world, &m.images[i].cam_from_world, sizeof(struct pose));
    }

    /* what is written is what a camera set reads, and the same bytes each time */
    struct camera_set set;
    struct lens_list lenses;
    char folder[300];
    snprintf(folder, sizeof folder, "%s/views", scratch);
    assert_ok(imported_write(&out, folder, NULL, &err), err);
    char *first = scratch_read(scratch_path("views/images.txt"));
    assert_ok(imported_write(&out, folder, NULL, &err), err);
    assert_file_text(scratch_path("views/images.txt"), first);
    assert_file_text(scratch_path("views/views.mk"), "VIEWS := p0 p1 p2 p3\n");
    assert_ok(camera_set_read(&set, folder, &err), err);
    assert_ok(lens_list_read(&lenses, scratch_path("views/lenses.txt"), &err), err);
    assert_int_equal(set.view_count, PHOTOS);
    assert_int_equal(set.model.point_count, out.model.point_count);
    assert_int_equal(lenses.count, PHOTOS);
    free(first);
    lens_list_release(&lenses);
    camera_set_release(&set);
    imported_release(&out);
    imported_release(&out);
    imported_release(NULL);
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static void names_mean_photos(void **state)
{
    (void)state;
    struct photo_list photos;
    make_photos(&photos, &radial);
    assert_int_equal(photo_list_match(&photos, "p2.jpg"), 2);
    assert_int_equal(photo_list_match(&photos, "some/folder/p1.jpg"), 1);
    assert_int_equal(photo_list_match(&photos, "C:\\x\\p3.jpg"), 3);
    assert_int_equal(photo_list_match(&photos, "./p0"), 0);
    assert_int_equal(photo_list_match(&photos, "p0.JPG"), 0);
    assert_int_equal(photo_list_match(&photos, "p0.old.jpg"), -1);
    assert_int_equal(photo_list_match(&photos, "q.jpg"), -1);
    assert_int_equal(photo_list_match(&photos, "p"), -1);
    photo_list_release(&photos);
}

static void images_that_are_no_photos_are_left_out(void **state)
{
    (void)state;
    struct sfm_model m;
    struct photo_list photos;
    struct imported out;
    struct err err = ERR_INIT;
    make_model(&m, &radial);
    make_photos(&photos, &radial);
    rename_image(&m, 0, "stranger.jpg");
    assert_ok(import_model(&out, &m, &photos, &defaults, &err), err);
    assert_int_equal(out.stats.registered, 3);
    assert_int_equal(out.stats.unregistered, 1);
    assert_int_equal(out.stats.strangers, 1);
    assert_string_equal(out.model.images[0].name, "p1.exr");
    check_pixels(&out, 1e-8);
    imported_release(&out);

    rename_image(&m, 1, "also a stranger.jpg");
    rename_image(&m, 2, "and another.jpg");
    assert_int_equal(import_model(&out, &m, &photos, &defaults, &err), ST_DATA);
    assert_err(err, ST_DATA, "places only 1 of 4 photos, and depth needs at least 2");
    err = (struct err)ERR_INIT;
    rename_image(&m, 3, "the last.jpg");
    assert_int_equal(import_model(&out, &m, &photos, &defaults, &err), ST_DATA);
    assert_err(err, ST_DATA, "is named like a photo of the scene");
    err = (struct err)ERR_INIT;
    rename_image(&m, 0, "p0.jpg");
    rename_image(&m, 1, "other/p0.jpg");
    assert_int_equal(import_model(&out, &m, &photos, &defaults, &err), ST_DATA);
    assert_err(err, ST_DATA,
               "images \"p0.jpg\" and \"other/p0.jpg\" of the model are both named like photo \"p0.jpg\"");
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static void a_model_of_smaller_pictures_is_scaled(void **state)
{
    (void)state;
    struct sfm_model m;
    struct photo_list photos;
    struct imported out;
    struct err err = ERR_INIT;
    make_model(&m, &radial);
    make_photos(&photos, &radial);
    for (int i = 0; i < PHOTOS; i++) {
        photos.photos[i].info.width = 1920;
        photos.photos[i].info.height = 1440;
    }
    assert_ok(import_model(&out, &m, &photos, &defaults, &err), err);
    assert_true(out.stats.mean_error < 1e-9);
    assert_true(out.lenses.lenses[0].camera.params[0] == 3 * 520 && out.lenses.lenses[0].camera.params[2] == 720);
    check_pixels(&out, 1e-8);
    imported_release(&out);

    /* turned or cropped is not scaled */
    photos.photos[2].info.width = 480;
    photos.photos[2].info.height = 640;
    assert_int_equal(import_model(&out, &m, &photos, &defaults, &err), ST_DATA);
    assert_err(err, ST_DATA, "camera for photo \"p2.jpg\" is 640 x 480 px, but the photo is 480 x 640 px");
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static void a_size_that_rounding_explains_is_scaled(void **state)
{
    (void)state;
    /* 1600 x 1202 shrunk to 1000 is 751.25 high, stored as 751 */
    struct camera lens = {CAMERA_PINHOLE, 1000, 751, {900, 900, 500, 375.5}};
    struct sfm_model m;
    struct photo_list photos;
    struct imported out;
    struct err err = ERR_INIT;
    make_model(&m, &lens);
    make_photos(&photos, &lens);
    for (int i = 0; i < PHOTOS; i++) {
        photos.photos[i].info.width = 1600;
        photos.photos[i].info.height = 1202;
    }
    assert_ok(import_model(&out, &m, &photos, &defaults, &err), err);
    assert_true(out.stats.mean_error < 1e-9);
    assert_near(out.lenses.lenses[0].camera.params[3], 601, 1e-9);
    imported_release(&out);
    photos.photos[0].info.height = 1204;
    assert_int_equal(import_model(&out, &m, &photos, &defaults, &err), ST_DATA);
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static void outliers_are_dropped(void **state)
{
    (void)state;
    struct sfm_model m;
    struct photo_list photos;
    struct imported out, clean;
    struct err err = ERR_INIT;
    make_model(&m, &radial);
    make_photos(&photos, &radial);
    assert_ok(import_model(&clean, &m, &photos, &defaults, &err), err);
    /* one observation 5 px off: it goes, its point stays; a point behind the cameras: it goes with all it has */
    int full[2], n = 0;
    for (int i = 0; i < POINTS && n < 2; i++)
        if (m.points[i].track_count == PHOTOS) full[n++] = i;
    struct sfm_track *t = &m.points[full[0]].track[1];
    m.images[t->image_idx].observations[t->observation_idx].u += 5;
    m.points[full[1]].position.z = -6;
    assert_ok(import_model(&out, &m, &photos, &defaults, &err), err);
    assert_int_equal(out.stats.dropped, 1 + PHOTOS);
    assert_int_equal(out.stats.observations, clean.stats.observations);
    assert_int_equal(out.model.point_count, clean.model.point_count - 1);
    check_pixels(&out, 1e-8);
    assert_near(out.stats.mean_error, 5.0 / (double)(out.stats.observations - PHOTOS), 1e-6);
    imported_release(&out);
    imported_release(&clean);

    /* nothing fits: cameras and points do not belong together */
    for (int i = 0; i < POINTS; i++) m.points[i].position.z = -6;
    assert_int_equal(import_model(&out, &m, &photos, &defaults, &err), ST_DATA);
    assert_err(err, ST_DATA, "do not belong together");
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static void a_fisheye_scene_becomes_cubes(void **state)
{
    (void)state;
    struct sfm_model m;
    struct photo_list photos;
    struct imported out;
    struct err err = ERR_INIT;
    int behind = 0;
    make_model(&m, &fisheye);
    make_photos(&photos, &fisheye);
    assert_ok(import_model(&out, &m, &photos, &defaults, &err), err);
    assert_true(out.stats.mean_error < 1e-9);
    assert_int_equal(out.model.image_count, 5 * PHOTOS);
    assert_string_equal(out.model.images[0].name, "p0@0.exr");
    assert_string_equal(out.lenses.lenses[7].view, "p1@2");
    assert_string_equal(out.lenses.lenses[7].photo, "p1");
    check_pixels(&out, 1e-8);
    for (int i = 0; i < out.model.image_count; i++) {
        struct vec3 a = pose_center(&out.model.images[i].cam_from_world),
                    b = pose_center(&m.images[i / 5].cam_from_world);
        assert_near(vec3_length(vec3_sub(a, b)), 0, 1e-12); /* one centre */
        if (i % 5) behind += out.model.images[i].observation_count;
    }
    assert_true(behind > 100);
    imported_release(&out);
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static void cameras_without_points_come_through(void **state)
{
    (void)state;
    struct sfm_model m;
    struct photo_list photos;
    struct imported out;
    struct err err = ERR_INIT;
    make_model(&m, &radial);
    make_photos(&photos, &radial);
    for (int i = 0; i < m.point_count; i++) free(m.points[i].track);
    m.point_count = 0;
    for (int i = 0; i < PHOTOS; i++) m.images[i].observation_count = 0;
    assert_ok(import_model(&out, &m, &photos, &defaults, &err), err);
    assert_int_equal(out.model.image_count, PHOTOS);
    assert_int_equal(out.model.point_count, 0);
    assert_true(out.stats.mean_error == 0 && out.stats.stated_error == -1);
    imported_release(&out);
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static void the_largest_model_is_chosen(void **state)
{
    (void)state;
    struct sfm_model m, chosen;
    struct photo_list photos;
    struct err err = ERR_INIT;
    char *name = NULL;
    make_model(&m, &radial);
    make_photos(&photos, &radial);
    assert_ok(sfm_model_write_text(&m, scratch_path("sfm/1"), NULL, &err), err);
    rename_image(&m, 0, "stranger.jpg"); /* as many images, but fewer are photos */
    assert_ok(sfm_model_write_text(&m, scratch_path("sfm/0"), NULL, &err), err);
    scratch_write("sfm/models.txt", "remodel-sfm 1\n0 colmap\n1 colmap\n");
    assert_ok(import_choose(&chosen, &name, scratch_path("sfm"), &photos, &err), err);
    assert_string_equal(name, "1");
    assert_string_equal(chosen.images[0].name, "p0.jpg");
    sfm_model_release(&chosen);
    free(name);

    static const char *const bad[][2] = {{"remodel-sfm 2\n", "found \"2\""},
                                         {"remodel-sfm 1\n", "a line for each model"},
                                         {"remodel-sfm 1\n0 bundler\n", "found \"bundler\""},
                                         {"", "\"remodel-sfm 1\""}};
    for (int i = 0; i < 4; i++) {
        err = (struct err)ERR_INIT;
        scratch_write("sfm/models.txt", bad[i][0]);
        assert_int_not_equal(import_choose(&chosen, &name, scratch_path("sfm"), &photos, &err), ST_OK);
        assert_err(err, ST_DATA, bad[i][1]);
    }
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static int check_photos(void *photos)
{
    struct err err = ERR_INIT;
    return import_check_photos(scratch, photos, &err);
}

static void changed_photos_are_named(void **state)
{
    (void)state;
    struct photo_list photos;
    char *said;
    make_photos(&photos, &radial);
    scratch_write("photos.txt", "# c\np0 00000000000000000000000000000000\np1 00000000000000000000000000000009\n"
                                "gone 1\np3 00000000000000000000000000000003\n");
    assert_int_equal(child_run(check_photos, &photos, &said), 0);
    assert_contains(said, "make resfm");
    assert_contains(said, "changed since structure from motion ran: p1.jpg");
    assert_contains(said, "new since structure from motion ran: p2.jpg");
    free(said);
    photo_list_release(&photos);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_perfect_model_comes_through),
        cmocka_unit_test(names_mean_photos),
        cmocka_unit_test(images_that_are_no_photos_are_left_out),
        cmocka_unit_test(a_model_of_smaller_pictures_is_scaled),
        cmocka_unit_test(a_size_that_rounding_explains_is_scaled),
        cmocka_unit_test(outliers_are_dropped),
        cmocka_unit_test(a_fisheye_scene_becomes_cubes),
        cmocka_unit_test(cameras_without_points_come_through),
        cmocka_unit_test(the_largest_model_is_chosen),
        cmocka_unit_test(changed_photos_are_named),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
