/* Whole photographs: the files and their contents, equal bytes for any number of threads, errors in the dark. */
#include "tests/unit/simulate/worlds.h"

#include "common/base/parallel.h"
#include "common/capture/sfm_model.h"
#include "common/image/exr.h"
#include "common/image/photo.h"
#include "stages/simulate/photos.h"
#include "stages/simulate/scene_truth.h"

#define SCENE                                                                                    \
    "texture t plaster 0.2 0.3 1 0.6 0.5 0.4\nmaterial m lambert t\nmaterial g phong t 0.2 10\n" \
    "room r 0 0 5 4 0 2.5 g m\nwall s 0 0 5 0 0 2.5 0.2 m\nwall e 5 0 5 4 0 2.5 0.2 m\n"         \
    "wall n 5 4 0 4 0 2.5 0.2 m\nwall w 0 4 0 0 0 2.5 0.2 m\nwindow o s 1.5 3.5 0.8 2.2\n"       \
    "lamp l quad 2 2 2.4 0 0.5 0 0.5 0 0 9 9 9\nsun -80 40 2 500 450 400\npanorama 1 2 2 2 1 1 1\n"
#define SHOOT                                                                                                       \
    "remodel-shoot 1\nlens p pinhole 60 40 40 40 30 20\nlens f equisolid 60 40 26 30 20\n"                          \
    "exposure 0.004\nexposure 0.016 4 200\nsensor 30000 6 60 1\nphoto a p 4 3 1.2 4 0 1.2\nphoto b f 1 3 1 5 1 1\n" \
    "reference r f 2.5 -0.05 1.5 2.5 -4 1.5\nreference-exposure 0.001 8 100 1000\n"

static const struct simulate_params params = {
    .samples = 4, .scale = 1, .seed = 1, .truth = "yes", .irradiance_points = 5, .irradiance_samples = 4096};

static void make_all(const char *out, const struct world *w, const struct shoot *s)
{
    struct err err = ERR_INIT;
    struct provenance prov = {.stage = "simulate", .version = "0"};
    assert_ok(truth_write(w, s, scratch, out, &params, &prov, &err), err);
    const struct picture_job job = {s, out, &params, &prov};
    for (int i = 0; i < s->photo_count; i++) assert_ok(photo_make(&job, w, &s->photos[i], &err), err);
}

static const char *const files[] = {
    "photos/a_e0.jpg",      "photos/a_e1.jpg",    "photos/b_e0.jpg", "photos/b_e1.jpg",   "lri/r.jpg",
    "lri/exposures.txt",    "truth/hdr/a.exr",    "truth/hdr/b.exr", "truth/depth/a.exr", "truth/ids/b.exr",
    "truth/cameras.txt",    "truth/images.txt",   "truth/faces.txt", "truth/scene.txt",   "truth/irradiance.txt",
    "truth/lri/images.txt", "truth/points3D.txt", "photos.mk",
};

static void check_photo(const char *out)
{
    struct photo_info info;
    struct err err = ERR_INIT;
    char path[600];
    snprintf(path, sizeof path, "%s/photos/a_e1.jpg", out);
    assert_ok(photo_read_info(&info, path, &err), err);
    assert_true(info.width == 60 && info.height == 40 && info.iso == 200);
    assert_near(info.seconds, 0.016, 1e-6);
    assert_near(info.f_number, 4, 1e-6);
    assert_near(info.focal_mm, 24, 1e-6);
    assert_string_equal(info.make, "remodel");
    assert_string_equal(info.model, "p");
}

/* Photo a looks south and level: the wall's inner face has a depth of 2.9 m wherever it is visible. */
static void check_surfaces(const char *out, const struct world *w)
{
    struct exr_image depth = {0}, ids = {0};
    struct err err = ERR_INIT;
    char path[600];
    snprintf(path, sizeof path, "%s/truth/depth/a.exr", out);
    assert_ok(exr_read(&depth, path, NULL, 0, &err), err);
    assert_string_equal(exr_attribute(&depth, "remodel:depth"), "z");
    assert_near(exr_find(&depth, "Z")->f[20 * 60 + 32], 2.9, 1e-6);
    assert_near(exr_find(&depth, "Z")->f[14 * 60 + 36], 2.9, 1e-6);
    snprintf(path, sizeof path, "%s/truth/ids/b.exr", out);
    assert_ok(exr_read(&ids, path, NULL, 0, &err), err);
    snprintf(path, sizeof path, "%s/truth/depth/b.exr", out);
    exr_image_release(&depth);
    assert_ok(exr_read(&depth, path, NULL, 0, &err), err);
    assert_string_equal(exr_attribute(&depth, "remodel:depth"), "ray");
    /* a fisheye ray of the written length ends on the face with the written id */
    struct shoot s;
    assert_ok(shoot_read(&s, scratch, 1, NULL, &err), err);
    const struct camera_view view = render_view_make(&s, &s.photos[1]);
    int sky = 0;
    for (int i = 0; i < 60 * 40; i++) {
        const uint32_t id = exr_find(&ids, "id")->u[i];
        struct path_ray ray;
        if (!id) {
            sky++;
            assert_true(exr_find(&depth, "Z")->f[i] == 0);
            continue;
        }
        const struct scene_face *f = &w->geometry.faces[id - 1];
        assert_true(render_view_ray(&view, i % 60 + 0.5, i / 60 + 0.5, &ray));
        const struct vec3 p = vec3_add(ray.from, vec3_scale(ray.direction, exr_find(&depth, "Z")->f[i]));
        assert_true(fabs(vec3_dot(vec3_sub(p, f->origin), f->normal)) < 1e-5);
    }
    assert_true(sky > 5 && sky < 600);
    shoot_release(&s);
    exr_image_release(&depth);
    exr_image_release(&ids);
}

static void check_texts(const char *out)
{
    struct sfm_model m = {0};
    struct err err = ERR_INIT;
    char path[600];
    snprintf(path, sizeof path, "%s/truth", out);
    assert_ok(sfm_model_read_text(&m, path, NULL, &err), err);
    assert_true(m.image_count == 2 && m.camera_count == 2 && m.point_count == 0);
    assert_string_equal(m.images[1].name, "b.jpg");
    assert_int_equal(m.cameras[m.images[1].camera_idx].camera.model, CAMERA_OPENCV_FISHEYE);
    sfm_model_release(&m);
    snprintf(path, sizeof path, "%s/photos.mk", out);
    assert_file_text(path,
                     "SHOTS := a b r\nTRUE_VIEWS := a b\nWITNESSES :=\n"
                     "SHOT_a := truth/depth/a.exr truth/ids/a.exr truth/hdr/a.exr photos/a_e0.jpg photos/a_e1.jpg\n"
                     "SHOT_b := truth/depth/b.exr truth/ids/b.exr truth/hdr/b.exr photos/b_e0.jpg photos/b_e1.jpg\n"
                     "SHOT_r := lri/r.jpg\n");
    snprintf(path, sizeof path, "%s/lri/exposures.txt", out);
    assert_file_text(path, "# file seconds f-number iso neutral-density-factor\nr.jpg 0.001 8 100 1000\n");
}

static void photos_and_truth_do_not_depend_on_threads(void **state)
{
    struct shoot s;
    struct err err = ERR_INIT;
    char one[300], two[300];
    (void)state;
    struct world w = world_from(SCENE);
    scratch_write("cameras.txt", SHOOT);
    assert_ok(shoot_read(&s, scratch, 1, NULL, &err), err);
    snprintf(one, sizeof one, "%s/one", scratch);
    snprintf(two, sizeof two, "%s/two", scratch);
    parallel_set_threads(1);
    make_all(one, &w, &s);
    parallel_set_threads(2);
    make_all(two, &w, &s);
    parallel_set_threads(0);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[600];
        struct stat a, b;
        snprintf(path, sizeof path, "%s/%s", one, files[i]);
        FILE *x = fopen(path, "rb");
        if (stat(path, &a)) fail_msg("%s was not written", path);
        snprintf(path, sizeof path, "%s/%s", two, files[i]);
        FILE *y = fopen(path, "rb");
        if (stat(path, &b) || a.st_size != b.st_size) fail_msg("%s differs in size", files[i]);
        assert_true(x && y);
        for (int c; (c = getc(x)) != EOF;)
            if (c != getc(y)) fail_msg("%s differs between one and two threads", files[i]);
        fclose(x);
        fclose(y);
    }
    check_photo(one);
    check_surfaces(one, &w);
    check_texts(one);
    shoot_release(&s);
    path_world_release(&w);
}

/* An edited scene with the same cameras. */
static void unedited_faces_keep_their_textures(void **state)
{
    struct shoot s;
    struct err err = ERR_INIT;
    char out[300], path[600];
    (void)state;
    struct world before = world_from(SCENE);
    struct world w =
        world_from("texture t plaster 0.2 0.3 1 0.6 0.5 0.4\nmaterial m lambert t\nmaterial g phong t 0.2 10\n"
                   "box new 0.5 0.5 0 1 1 1 m\nroom r 0 0 5 4 0 2.5 g m\nlamp l quad 2 2 2.4 0 0.5 0 0.5 0 0 9 9 9\n");
    scratch_write("cameras.txt", SHOOT);
    scratch_write("scene-bare.txt", "x");
    assert_ok(shoot_read(&s, scratch, 1, NULL, &err), err);
    snprintf(out, sizeof out, "%s/edited", scratch);
    const struct picture_job job = {&s, out, &params, NULL};
    assert_ok(photo_make_truth(&job, &w, &s.photos[0], "truth/edited-bare", &err), err);
    assert_ok(truth_write_edited(&w, &s, scratch, out, "bare", NULL, &err), err);
    const char *const made[] = {"hdr/a.exr", "depth/a.exr", "ids/a.exr", "scene.txt", "faces.txt", "images.txt"};
    for (int i = 0; i < 6; i++) {
        snprintf(path, sizeof path, "%s/truth/edited-bare/%s", out, made[i]);
        assert_int_equal(access(path, R_OK), 0);
    }
    assert_int_equal(before.geometry.faces[0].seed, w.geometry.faces[6].seed); /* r.floor */
    shoot_release(&s);
    path_world_release(&w);
    path_world_release(&before);
}

static void a_photo_without_light_is_an_error(void **state)
{
    struct shoot s;
    struct err err = ERR_INIT;
    (void)state;
    struct world w =
        world_from("texture t rgb 0.5 0.5 0.5\nmaterial m lambert t\nbox room 0 0 0 3 3 3 m\nsun 0 40 1 9 9 9\n");
    scratch_write("cameras.txt", "remodel-shoot 1\nlens p pinhole 6 4 4 4 3 2\nexposure 1\nsensor 30000 6 60 1\n"
                                 "photo a p 1 1 1 2 2 1\n");
    assert_ok(shoot_read(&s, scratch, 1, NULL, &err), err);
    const struct picture_job job = {&s, scratch, &params, NULL};
    assert_true(photo_make(&job, &w, &s.photos[0], &err));
    assert_err(err, ST_DATA, "no light reaches photo a");
    assert_int_not_equal(access(scratch_path("photos/a.jpg"), R_OK), 0);
    shoot_release(&s);
    path_world_release(&w);
}

/* One small lamp over a black floor: the irradiance has a closed form. */
static void irradiance_points_have_the_irradiance_of_a_small_lamp(void **state)
{
    struct shoot s;
    struct err err = ERR_INIT;
    struct irradiance_point points[20];
    (void)state;
    struct world w = world_from("texture t rgb 0 0 0\nmaterial m lambert t\nquad floor -4 -4 0 8 0 0 0 8 0 m\n"
                                "lamp l quad -0.05 -0.05 2 0 0.1 0 0.1 0 0 100 50 25\n");
    scratch_write("cameras.txt", "remodel-shoot 1\nlens p pinhole 60 40 40 40 30 20\nexposure 1\nsensor 30000 6 60 1\n"
                                 "photo a p 0 0 1.5 0.2 0.1 0\n");
    assert_ok(shoot_read(&s, scratch, 1, NULL, &err), err);
    assert_ok(truth_irradiance(points, 20, &w, &s, &params, &err), err);
    for (int i = 0; i < 20; i++) {
        const struct vec3 p = points[i].point;
        const double d2 = p.x * p.x + p.y * p.y + (2 - p.z) * (2 - p.z), c = (2 - p.z) / sqrt(d2);
        assert_near(p.z, 0.02, 1e-9);
        assert_near(points[i].normal.z, 1, 1e-9);
        assert_near(points[i].irradiance.r, 100 * 0.01 * c * c / d2, 0.005); /* a lamp this small is a point */
        assert_near(points[i].irradiance.b, points[i].irradiance.r / 4, 1e-9);
    }
    shoot_release(&s);
    path_world_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photos_and_truth_do_not_depend_on_threads),
        cmocka_unit_test(unedited_faces_keep_their_textures),
        cmocka_unit_test(a_photo_without_light_is_an_error),
        cmocka_unit_test(irradiance_points_have_the_irradiance_of_a_small_lamp),
    };
    return cmocka_run_group_tests_name("simulate photos", tests, scratch_make, scratch_remove);
}
