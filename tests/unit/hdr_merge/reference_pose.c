/* reference_pose.c - a reference image keeps its picture when its pose moves to the scene's frame. */
#include "stages/hdr_merge/reference_pose.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "common/capture/lens_list.h"
#include "common/capture/photo_list.h"
#include "common/model/model_axes.h"
#include "tests/unit/scratch.h"

enum { PHOTOS = 5 };

static const struct similarity other = {
    /* model from scene */
    2.5,
    {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}},
    {10, -4, 3},
};

static struct pose turned_at(double x, double y, double z, double degrees)
{
    const double a = degrees * M_PI / 360;
    const struct quat q = {cos(a), 0.6 * sin(a), 0, 0.8 * sin(a)};
    return (struct pose){q, vec3_scale(mat3_apply(mat3_from_quat(q), vec3_make(x, y, z)), -1)};
}

/* Photo i of the scene. */
static struct pose photo_pose(int i) { return turned_at(i, 0.3 * i * i, i % 2 ? 0.4 : -0.2, 25 * i); }

/* The camera in the frame of the model: the same rays. */
static struct pose in_model(const struct pose *p)
{
    const struct mat3 turn = mat3_multiply(mat3_from_quat(p->rotation), mat3_transpose(other.rotation));
    const struct vec3 center =
        vec3_add(vec3_scale(mat3_apply(other.rotation, pose_center(p)), other.scale), other.translation);
    return (struct pose){quat_from_mat3(turn), vec3_scale(mat3_apply(turn, center), -1)};
}

static void write_pose(FILE *to, int id, const struct pose *p, const char *name)
{
    fprintf(to, "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 %s\n\n", id, p->rotation.w, p->rotation.x,
            p->rotation.y, p->rotation.z, p->translation.x, p->translation.y, p->translation.z, name);
}

/* The scene's views and records, in scratch. The views are turned against their photos. */
static void write_scene(void)
{
    const struct quat turn = {cos(0.2), 0, sin(0.2), 0};
    mkdir(scratch_path("views"), 0777);
    mkdir(scratch_path("records"), 0777);
    scratch_write("views/cameras.txt", "1 PINHOLE 60 40 50 50 30 20\n");
    scratch_write("views/points3D.txt", "");
    FILE *images = fopen(scratch_path("views/images.txt"), "w"), *list = fopen(scratch_path("records/list.txt"), "w"),
         *lens = fopen(scratch_path("views/lenses.txt"), "w");
    assert_true(images && list && lens);
    fputs("remodel-lenses 1\n", lens);
    for (int i = 0; i < PHOTOS; i++) {
        const struct pose photo = photo_pose(i);
        const struct mat3 view = mat3_multiply(mat3_from_quat(turn), mat3_from_quat(photo.rotation));
        const struct pose p = {quat_from_mat3(view), mat3_apply(mat3_from_quat(turn), photo.translation)};
        char name[32], id[16], file[32];
        struct photo_record record = {
            .id = id, .file = file, .info = {.width = 60, .height = 40, .bits = 8, .orientation = 1}};
        struct err err = ERR_INIT;
        snprintf(id, sizeof id, "p%d", i);
        snprintf(file, sizeof file, "p%d.jpg", i);
        snprintf(name, sizeof name, "p%d.exr", i);
        snprintf(record.hash, sizeof record.hash, "0123456789abcdef0123456789abcdef");
        write_pose(images, i + 1, &p, name);
        fprintf(lens, "p%d p%d PINHOLE 60 40 50 50 30 20 turn %.17g %.17g %.17g %.17g\n", i, i, turn.w, turn.x, turn.y,
                turn.z);
        fprintf(list, "p%d \"p%d.jpg\"\n", i, i);
        assert_ok(photo_record_write(&record, scratch_path("records"), &err), err);
    }
    assert_true(!fclose(images) && !fclose(list) && !fclose(lens));
}

struct model { /* of `count` photos of the scene and one reference image, the last */
    struct sfm_camera camera;
    struct sfm_image images[PHOTOS + 1];
    char names[PHOTOS + 1][32];
    struct sfm_model m;
};

static void make_model(struct model *m, int count, const struct pose *reference)
{
    *m = (struct model){.camera = {1, {CAMERA_PINHOLE, 60, 40, {50, 50, 30, 20}}}};
    for (int i = 0; i <= count; i++) {
        const struct pose p = i < count ? photo_pose(i) : *reference;
        snprintf(m->names[i], sizeof m->names[i], i < count ? "p%d.jpg" : "sky.jpg", i);
        m->images[i] = (struct sfm_image){.id = i + 1, .cam_from_world = in_model(&p), .name = m->names[i]};
    }
    m->m = (struct sfm_model){.cameras = &m->camera, .images = m->images, .camera_count = 1, .image_count = count + 1};
}

static enum status find(struct pose *p, struct frame_agreement *a, const struct model *m, const char *views,
                        const char *axes, struct err *err)
{
    const struct merge_params params = MERGE_PARAMS_DEFAULT;
    const struct reference_frame frame = {
        .views = views, .records = views ? scratch_path("records") : NULL, .axes = axes};
    struct provenance prov = {0};
    *p = m->images[m->m.image_count - 1].cam_from_world;
    const enum status st = reference_pose_find(p, a, &m->m, "model", &frame, &params, &prov, err);
    provenance_release(&prov);
    return st;
}

static void assert_same_pose(const struct pose *p, const struct pose *wanted)
{
    const struct mat3 a = mat3_from_quat(p->rotation), b = mat3_from_quat(wanted->rotation);
    for (int i = 0; i < 9; i++) assert_float_equal(a.m[i / 3][i % 3], b.m[i / 3][i % 3], 1e-9);
    assert_float_equal(vec3_length(vec3_sub(p->translation, wanted->translation)), 0, 1e-9);
}

static void common_photos_give_the_pose_in_the_scene(void **state)
{
    const struct pose sky = turned_at(-2, 7, 1, 130);
    struct model m;
    struct pose p;
    struct frame_agreement a;
    struct err err = ERR_INIT;
    (void)state;
    write_scene();
    for (int count = 3; count <= PHOTOS; count++) {
        make_model(&m, count, &sky);
        assert_ok(find(&p, &a, &m, scratch_path("views"), NULL, &err), err);
        assert_same_pose(&p, &sky);
        assert_int_equal(a.photos, count);
        assert_true(a.errors.center_max < 1e-9 && a.errors.rotation_max < 1e-5 && a.extent > 0.9);
    }
}

static void a_pose_in_the_frame_of_the_room_is_moved(void **state)
{
    const struct pose sky = turned_at(-2, 7, 1, 130);
    const struct model_axes axes = {.rotation = quat_from_mat3(other.rotation),
                                    .translation = other.translation,
                                    .scale = other.scale,
                                    .metric = true};
    struct model m;
    struct pose p;
    struct frame_agreement a;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(model_axes_write(&axes, scratch_path("axes.txt"), NULL, &err), err);
    make_model(&m, 0, &sky);
    assert_ok(find(&p, &a, &m, NULL, scratch_path("axes.txt"), &err), err);
    assert_same_pose(&p, &sky);
    assert_int_equal(a.photos, 0);
}

static void a_pose_in_the_scenes_frame_is_kept(void **state)
{
    const struct pose sky = turned_at(-2, 7, 1, 130);
    struct model m;
    struct pose p;
    struct frame_agreement a;
    struct err err = ERR_INIT;
    (void)state;
    make_model(&m, 0, &sky);
    assert_ok(find(&p, &a, &m, NULL, NULL, &err), err);
    assert_same_pose(&p, &m.images[0].cam_from_world);
}

static void few_or_disagreeing_photos_are_refused(void **state)
{
    const struct pose sky = turned_at(-2, 7, 1, 130);
    struct model m;
    struct pose p;
    struct frame_agreement a;
    struct err err = ERR_INIT;
    (void)state;
    write_scene();
    make_model(&m, 2, &sky);
    assert_int_equal(find(&p, &a, &m, scratch_path("views"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "has 2 of the scene's photographs with a pose in");
    assert_contains(err.text, "LRI_FRAME = scene or model");

    /* a photo that the model names twice counts once */
    make_model(&m, 3, &sky);
    strcpy(m.names[2], "p1.jpg");
    err = (struct err)ERR_INIT;
    assert_int_equal(find(&p, &a, &m, scratch_path("views"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "has 2 of the scene's photographs");

    /* photos of another place */
    make_model(&m, PHOTOS, &sky);
    for (int i = 0; i < PHOTOS; i++) {
        const struct pose wrong = turned_at(i % 3, i % 2, 0.5 * i, -70 * i);
        m.images[i].cam_from_world = wrong;
    }
    err = (struct err)ERR_INIT;
    assert_int_equal(find(&p, &a, &m, scratch_path("views"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "the 5 photographs that model and");
    assert_contains(err.text, "disagree");

    /* all in one place */
    make_model(&m, 3, &sky);
    for (int i = 0; i < 3; i++) m.images[i].cam_from_world.translation = vec3_make(0, 0, 0);
    err = (struct err)ERR_INIT;
    assert_int_equal(find(&p, &a, &m, scratch_path("views"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "all in one place");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(common_photos_give_the_pose_in_the_scene),
        cmocka_unit_test(a_pose_in_the_frame_of_the_room_is_moved),
        cmocka_unit_test(a_pose_in_the_scenes_frame_is_kept),
        cmocka_unit_test(few_or_disagreeing_photos_are_refused),
    };
    return cmocka_run_group_tests_name("reference_pose", tests, scratch_make, scratch_remove);
}
