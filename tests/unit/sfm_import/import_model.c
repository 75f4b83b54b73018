/* import_model.c - models of a made-up scene with known cameras: matching by name, recomputed errors, rectified pixels,
 * warnings about the lens. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/capture/camera_set.h"
#include "common/capture/photo_match.h"
#include "stages/sfm_import/choose_model.h"
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

static const struct sfm_import_params defaults = SFM_IMPORT_PARAMS_DEFAULT;

/* Every observation of the result is at the reprojected point in its view's pinhole camera. */
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

struct fixture {
    struct sfm_model model;
    struct photo_list photos;
    struct imported out;
    struct err err;
};

static struct fixture made_of(const struct camera *lens)
{
    struct fixture f = {.err = ERR_INIT};
    make_model(&f.model, lens);
    make_photos(&f.photos, lens);
    return f;
}

static void release(struct fixture *f)
{
    import_release(&f->out);
    sfm_model_release(&f->model);
    photo_list_release(&f->photos);
}

static void an_exact_model_is_imported_without_loss(void **state)
{
    (void)state;
    struct fixture f = made_of(&radial);
    assert_ok(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), f.err);
    assert_int_equal(f.out.stats.registered, PHOTOS);
    assert_int_equal(f.out.stats.dropped, 0);
    assert_true(f.out.stats.mean_error < 1e-9 && f.out.stats.median_error < 1e-9);
    assert_near(f.out.stats.stated_error, 0.1, 1e-12);
    assert_int_equal(f.out.model.image_count, PHOTOS);
    assert_true(f.out.model.point_count > POINTS / 2);
    check_pixels(&f.out, 1e-8);
    for (int i = 0; i < PHOTOS; i++) {
        assert_int_equal(f.out.model.images[i].id, i + 1);
        assert_int_equal(f.out.model.cameras[i].id, i + 1);
        assert_int_equal(f.out.model.cameras[i].camera.model, CAMERA_PINHOLE);
        assert_memory_equal(f.out.lenses.lenses[i].camera.params, radial.params, sizeof radial.params);
        assert_memory_equal(&f.out.model.images[i].cam_from_world, &f.model.images[i].cam_from_world,
                            sizeof(struct pose));
    }

    /* a camera set reads what was written; writing again gives the same bytes */
    struct camera_set set;
    struct lens_list lenses;
    char folder[300];
    snprintf(folder, sizeof folder, "%s/views", scratch);
    assert_ok(import_write(&f.out, folder, NULL, &f.err), f.err);
    char *first = scratch_read(scratch_path("views/images.txt"));
    assert_ok(import_write(&f.out, folder, NULL, &f.err), f.err);
    assert_file_text(scratch_path("views/images.txt"), first);
    assert_file_text(scratch_path("views/views.mk"), "VIEWS := p0 p1 p2 p3\n");
    assert_ok(camera_set_read(&set, folder, NULL, &f.err), f.err);
    assert_ok(lens_list_read(&lenses, scratch_path("views/lenses.txt"), NULL, &f.err), f.err);
    assert_int_equal(set.view_count, PHOTOS);
    assert_int_equal(set.model.point_count, f.out.model.point_count);
    assert_int_equal(lenses.count, PHOTOS);
    free(first);
    lens_list_release(&lenses);
    camera_set_release(&set);
    import_release(&f.out);
    import_release(&f.out);
    import_release(NULL);
    release(&f);
}

static void image_names_are_matched_to_photos(void **state)
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

static void images_that_are_not_photos_are_left_out(void **state)
{
    (void)state;
    struct fixture f = made_of(&radial);
    rename_image(&f.model, 0, "stranger.jpg");
    assert_ok(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), f.err);
    assert_int_equal(f.out.stats.registered, 3);
    assert_int_equal(f.out.stats.unregistered, 1);
    assert_int_equal(f.out.stats.unknown, 1);
    assert_string_equal(f.out.model.images[0].name, "p1.exr");
    check_pixels(&f.out, 1e-8);
    import_release(&f.out);

    rename_image(&f.model, 1, "also a stranger.jpg");
    rename_image(&f.model, 2, "and another.jpg");
    assert_int_equal(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), ST_DATA);
    assert_err(f.err, ST_DATA, "places only 1 of 4 photos, and depth needs at least 2");
    f.err = (struct err)ERR_INIT;
    rename_image(&f.model, 3, "the last.jpg");
    assert_int_equal(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), ST_DATA);
    assert_err(f.err, ST_DATA, "is named like a photo of the scene");
    f.err = (struct err)ERR_INIT;
    rename_image(&f.model, 0, "p0.jpg");
    rename_image(&f.model, 1, "other/p0.jpg");
    assert_int_equal(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), ST_DATA);
    assert_err(f.err, ST_DATA,
               "images \"p0.jpg\" and \"other/p0.jpg\" of the model are both named like photo \"p0.jpg\"");
    release(&f);
}

static void a_model_of_smaller_pictures_is_scaled(void **state)
{
    (void)state;
    struct fixture f = made_of(&radial);
    for (int i = 0; i < PHOTOS; i++) {
        f.photos.photos[i].info.width = 1920;
        f.photos.photos[i].info.height = 1440;
    }
    assert_ok(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), f.err);
    assert_true(f.out.stats.mean_error < 1e-9);
    assert_true(f.out.lenses.lenses[0].camera.params[0] == 3 * 520 && f.out.lenses.lenses[0].camera.params[2] == 720);
    check_pixels(&f.out, 1e-8);
    import_release(&f.out);

    /* rotated or cropped photos are rejected */
    f.photos.photos[2].info.width = 480;
    f.photos.photos[2].info.height = 640;
    assert_int_equal(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), ST_DATA);
    assert_err(f.err, ST_DATA, "camera for photo \"p2.jpg\" is 640 x 480 px, but the photo is 480 x 640 px");
    release(&f);
}

static void sizes_may_differ_by_rounding(void **state)
{
    (void)state;
    /* 1600 x 1202 shrunk to 1000 is 751.25 high, stored as 751 */
    struct camera lens = {CAMERA_PINHOLE, 1000, 751, {900, 900, 500, 375.5}};
    struct fixture f = made_of(&lens);
    for (int i = 0; i < PHOTOS; i++) {
        f.photos.photos[i].info.width = 1600;
        f.photos.photos[i].info.height = 1202;
    }
    assert_ok(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), f.err);
    assert_true(f.out.stats.mean_error < 1e-9);
    assert_near(f.out.lenses.lenses[0].camera.params[3], 601, 1e-9);
    import_release(&f.out);
    f.photos.photos[0].info.height = 1204;
    assert_int_equal(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), ST_DATA);
    release(&f);
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
    /* an observation 5 px off is dropped and its point kept; a point behind the cameras is dropped with all
     * observations */
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
    import_release(&out);
    import_release(&clean);

    /* nothing fits */
    for (int i = 0; i < POINTS; i++) m.points[i].position.z = -6;
    assert_int_equal(import_model(&out, &m, &photos, &defaults, &err), ST_DATA);
    assert_err(err, ST_DATA, "do not belong together");
    sfm_model_release(&m);
    photo_list_release(&photos);
}

static void a_fisheye_photo_becomes_five_views(void **state)
{
    (void)state;
    struct fixture f = made_of(&fisheye);
    int behind = 0;
    assert_ok(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), f.err);
    assert_true(f.out.stats.mean_error < 1e-9);
    assert_int_equal(f.out.model.image_count, 5 * PHOTOS);
    assert_string_equal(f.out.model.images[0].name, "p0@0.exr");
    assert_string_equal(f.out.lenses.lenses[7].view, "p1@2");
    assert_string_equal(f.out.lenses.lenses[7].photo, "p1");
    check_pixels(&f.out, 1e-8);
    for (int i = 0; i < f.out.model.image_count; i++) {
        struct vec3 a = pose_center(&f.out.model.images[i].cam_from_world),
                    b = pose_center(&f.model.images[i / 5].cam_from_world);
        assert_near(vec3_length(vec3_sub(a, b)), 0, 1e-12); /* one centre */
        if (i % 5) behind += f.out.model.images[i].observation_count;
    }
    assert_true(behind > 100);
    release(&f);
}

static void cameras_without_points_are_imported(void **state)
{
    (void)state;
    struct fixture f = made_of(&radial);
    for (int i = 0; i < f.model.point_count; i++) free(f.model.points[i].track);
    f.model.point_count = 0;
    for (int i = 0; i < PHOTOS; i++) f.model.images[i].observation_count = 0;
    assert_ok(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), f.err);
    assert_int_equal(f.out.model.image_count, PHOTOS);
    assert_int_equal(f.out.model.point_count, 0);
    assert_true(f.out.stats.mean_error == 0 && f.out.stats.stated_error == -1);
    release(&f);
}

/* Points of which no photo, or only one, has an observation are kept where no other points are: those in a frame. */
static void points_that_no_two_photos_observe_say_where_the_scene_is(void **state)
{
    (void)state;
    for (int tracks = 0; tracks < 2; tracks++) {
        struct fixture f = made_of(&radial);
        for (int i = 0; i < f.model.point_count; i++) f.model.points[i].track_count = tracks;
        f.model.points[0].position = vec3_make(0, 0, -6); /* behind all cameras */
        f.model.points[0].track_count = 0;
        assert_ok(import_model(&f.out, &f.model, &f.photos, &defaults, &f.err), f.err);
        assert_true(f.out.model.point_count > POINTS / 2 && f.out.model.point_count < POINTS);
        assert_int_equal(f.out.model.points[0].id, f.model.points[1].id);
        for (int i = 0; i < f.out.model.point_count; i++) assert_int_equal(f.out.model.points[i].track_count, 0);
        for (int i = 0; i < PHOTOS; i++) assert_int_equal(f.out.model.images[i].observation_count, 0);
        release(&f);
    }
}

static void the_model_with_most_photos_is_chosen(void **state)
{
    (void)state;
    struct sfm_model m, chosen;
    struct photo_list photos;
    struct err err = ERR_INIT;
    char *name = NULL;
    make_model(&m, &radial);
    make_photos(&photos, &radial);
    assert_ok(sfm_model_write_text(&m, scratch_path("sfm/1"), NULL, &err), err);
    rename_image(&m, 0, "stranger.jpg"); /* same number of images, fewer photos */
    assert_ok(sfm_model_write_text(&m, scratch_path("sfm/0"), NULL, &err), err);
    enum given_cameras given = GIVEN_MODEL;
    scratch_write("sfm/models.txt", "remodel-sfm 2\n0 colmap model\n1 colmap lens\n");
    assert_ok(import_choose(&chosen, &name, &given, scratch_path("sfm"), &photos, NULL, &err), err);
    assert_int_equal(given, GIVEN_LENS);
    assert_string_equal(name, "1");
    assert_string_equal(chosen.images[0].name, "p0.jpg");
    sfm_model_release(&chosen);
    free(name);
    scratch_write("sfm/models.txt", "remodel-sfm 1\n0 colmap\n1 colmap\n"); /* does not say what was given */
    assert_ok(import_choose(&chosen, &name, &given, scratch_path("sfm"), &photos, NULL, &err), err);
    assert_string_equal(name, "1");
    assert_int_equal(given, GIVEN_MODEL);
    sfm_model_release(&chosen);
    free(name);

    static const char *const bad[][2] = {{"remodel-sfm 3\n", "found \"3\""},
                                         {"remodel-sfm 2\n0 colmap poses\n", "found \"poses\""},
                                         {"remodel-sfm 2\n0 colmap\n", "wanted what was given"},
                                         {"remodel-sfm 1\n", "a line for each model"},
                                         {"remodel-sfm 1\n0 bundler\n", "found \"bundler\""},
                                         {"", "a line \"remodel-sfm ...\""}};
    for (int i = 0; i < 6; i++) {
        err = (struct err)ERR_INIT;
        scratch_write("sfm/models.txt", bad[i][0]);
        assert_int_not_equal(import_choose(&chosen, &name, &given, scratch_path("sfm"), &photos, NULL, &err), ST_OK);
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

static void changed_and_new_photos_are_named(void **state)
{
    (void)state;
    struct photo_list photos;
    char *output;
    make_photos(&photos, &radial);
    scratch_write("photos.txt", "# c\np0 00000000000000000000000000000000\np1 00000000000000000000000000000009\n"
                                "gone 1\np3 00000000000000000000000000000003\n");
    assert_int_equal(child_run(check_photos, &photos, &output), 0);
    assert_contains(output, "(SFM)");
    assert_contains(output, "changed since structure from motion ran: p1.jpg");
    assert_contains(output, "new since structure from motion ran: p2.jpg");
    free(output);
    photo_list_release(&photos);
}

/* Warnings of an import of a model that was made with the exact lens `made` and states the lens `stated`; EXIF of the
 * photos has the focal length focal35 for 35 mm film. */
struct lens_case {
    const struct camera *made, *stated;
    double focal35;
    int point_count; /* at most POINTS */
};

static int import_lens(void *ctx)
{
    const struct lens_case *c = ctx;
    struct fixture f = made_of(c->made);
    f.model.cameras[0].camera = *c->stated;
    for (int i = c->point_count; i < f.model.point_count; i++) free(f.model.points[i].track);
    f.model.point_count = c->point_count;
    for (int i = 0; i < PHOTOS; i++) f.photos.photos[i].info.focal35_mm = c->focal35;
    const enum status st = import_model(&f.out, &f.model, &f.photos, &defaults, &f.err);
    release(&f);
    return (int)st;
}

static void a_lens_model_that_does_not_fit_is_warned_about(void **state)
{
    (void)state;
    /* at the rim the model without distortion is 2 px off, in the middle nothing */
    static const struct camera bent = {CAMERA_SIMPLE_RADIAL, 640, 480, {520, 320, 240, -0.02}};
    static const struct camera straight = {CAMERA_PINHOLE, 640, 480, {520, 520, 320, 240}};
    static const struct {
        struct lens_case lens;
        const char *warning; /* NULL: none */
    } cases[] = {
        {{&bent, &straight, 0, POINTS},
         "the lens model PINHOLE does not fit: the residuals grow from 0.0 px in the middle to 2.0 px at the rim"},
        {{&bent, &straight, 0, POINTS},
         "Set [sfm] camera_model = EQUISOLID or OPENCV_FISHEYE for a fisheye lens, OPENCV or RADIAL for other lenses"},
        {{&bent, &straight, 0, 20}, NULL}, /* too few observations */
        {{&bent, &bent, 0, POINTS}, NULL},
        {{&radial, &radial, 35, POINTS}, NULL},
        {{&fisheye, &fisheye, 8, POINTS}, NULL},
        {{&bent, &bent, 8, POINTS}, NULL}, /* measured to fit up to the rim */
        {{&bent, &bent, 8, 20},
         "the lens model SIMPLE_RADIAL may not fit: EXIF of photo \"p0.jpg\" states a focal length of 8 mm"},
        {{&bent, &bent, 14, 20}, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct lens_case lens = cases[i].lens;
        char *output;
        assert_int_equal(child_run(import_lens, &lens, &output), 0);
        if (cases[i].warning)
            assert_contains(output, cases[i].warning);
        else
            assert_lacks(output, "lens model");
        free(output);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_exact_model_is_imported_without_loss),
        cmocka_unit_test(image_names_are_matched_to_photos),
        cmocka_unit_test(images_that_are_not_photos_are_left_out),
        cmocka_unit_test(a_model_of_smaller_pictures_is_scaled),
        cmocka_unit_test(sizes_may_differ_by_rounding),
        cmocka_unit_test(outliers_are_dropped),
        cmocka_unit_test(a_fisheye_photo_becomes_five_views),
        cmocka_unit_test(cameras_without_points_are_imported),
        cmocka_unit_test(points_that_no_two_photos_observe_say_where_the_scene_is),
        cmocka_unit_test(the_model_with_most_photos_is_chosen),
        cmocka_unit_test(a_lens_model_that_does_not_fit_is_warned_about),
        cmocka_unit_test(changed_and_new_photos_are_named),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
