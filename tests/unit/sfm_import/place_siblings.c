/* place_siblings.c - pictures without a pose get that of their panorama, or of their multi-lens camera. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/capture/panorama_name.h"
#include "stages/sfm_import/place_siblings.h"

enum { MAX = 8 };

struct picture {
    const char *name;
    bool placed;
    struct pose pose;
};

/* A model of the placed pictures, in which they have the cameras 0, 1, ...; and a list of all. */
struct set {
    struct sfm_model model;
    struct photo_list photos;
};

static struct pose pose_at(struct quat rotation, struct vec3 centre)
{
    return (struct pose){rotation, vec3_scale(mat3_apply(mat3_from_quat(rotation), centre), -1)};
}

static struct set make(const struct picture *pictures, int count)
{
    struct set s = {0};
    s.model.images = calloc(MAX, sizeof *s.model.images);
    s.model.cameras = calloc(MAX, sizeof *s.model.cameras);
    s.photos.photos = calloc(MAX, sizeof *s.photos.photos);
    for (int i = 0; i < count; i++) {
        struct photo_record *photo = &s.photos.photos[s.photos.count++];
        photo->id = strndup(pictures[i].name, strlen(pictures[i].name) - 4);
        photo->file = strdup(pictures[i].name);
        if (!pictures[i].placed) continue;
        s.model.images[s.model.image_count] = (struct sfm_image){
            .id = 10 + i,
            .cam_from_world = pictures[i].pose,
            .camera_idx = s.model.image_count,
            .name = strdup(pictures[i].name),
        };
        s.model.cameras[s.model.camera_count++] = (struct sfm_camera){
            i + 1, {.model = CAMERA_PINHOLE, .width = 100, .height = 100, .params = {50, 50, 50, 50}}};
        s.model.image_count++;
    }
    return s;
}

static void release(struct set *s)
{
    sfm_model_release(&s->model);
    photo_list_release(&s->photos);
}

static const struct sfm_image *image_called(const struct set *s, const char *name)
{
    for (int i = 0; i < s->model.image_count; i++)
        if (!strcmp(s->model.images[i].name, name)) return &s->model.images[i];
    return NULL;
}

static void place(struct set *s, struct split_size split)
{
    struct err err = ERR_INIT;
    assert_ok(place_siblings(&s->model, &s->photos, split, &err), err);
}

static void assert_pose(const struct set *s, const struct picture *p)
{
    const struct sfm_image *image = image_called(s, p->name);
    assert_non_null(image);
    assert_true(quat_angle(image->cam_from_world.rotation, p->pose.rotation) < 1e-7);
    assert_true(vec3_length(vec3_sub(pose_center(&image->cam_from_world), pose_center(&p->pose))) < 1e-12);
}

static struct quat some_turn(double a) { return quat_normalize((struct quat){1, 0.3 * a, -0.7 * a, 0.2}); }

static void views_of_a_panorama_are_placed(void **state)
{
    const struct quat body = some_turn(1);
    const struct vec3 centre = {1, 2, -3};
    struct picture views[3] = {{.name = "hall_yaw000.png"}, {.name = "hall_yaw120.png"}, {.name = "hall_yaw300.png"}};
    (void)state;
    for (int i = 0, yaw; i < 3; i++) {
        panorama_name_read(&yaw, views[i].name);
        views[i].pose = pose_at(quat_multiply(panorama_name_turn(yaw), body), centre);
    }
    views[1].placed = true;
    struct set s = make(views, 3);
    place(&s, (struct split_size){0});
    assert_int_equal(s.model.image_count, 3);
    for (int i = 0; i < 3; i++) assert_pose(&s, &views[i]);
    for (int i = 0; i < 3; i++) assert_int_equal(s.model.images[i].camera_idx, 0);
    assert_string_equal(s.model.images[0].name, "hall_yaw120.png"); /* what was there keeps its number */
    assert_true(s.model.images[1].id > 11 && s.model.images[2].id > s.model.images[1].id);
    release(&s);
}

static void a_panorama_without_a_placed_view_stays_out(void **state)
{
    struct picture views[3] = {
        {.name = "hall_yaw000.png", .placed = true, .pose = pose_at(some_turn(1), (struct vec3){1, 0, 0})},
        {.name = "attic_yaw060.png"},
        {.name = "hall.png"}};
    (void)state;
    struct set s = make(views, 3);
    place(&s, (struct split_size){0});
    assert_int_equal(s.model.image_count, 1);
    release(&s);
}

/* Two captures of two lenses; one picture of the second is not placed. */
static struct set two_captures(struct picture *pictures)
{
    const struct quat mount = some_turn(0.2);
    const struct vec3 beside = {0.06, 0.01, -0.02};
    const char *names[4] = {"a_c1r1.png", "a_c2r1.png", "b_c1r1.png", "b_c2r1.png"};
    for (int i = 0; i < 4; i++) {
        const struct quat body = some_turn(1 + i / 2);
        const struct vec3 centre = {i / 2 * 3, i / 2, 1};
        const struct vec3 off = mat3_apply(mat3_transpose(mat3_from_quat(body)), beside);
        pictures[i] = (struct picture){names[i], i != 3,
                                       i % 2 ? pose_at(quat_multiply(mount, body), vec3_add(centre, off))
                                             : pose_at(body, centre)};
    }
    return make(pictures, 4);
}

static void a_lens_is_placed_beside_another(void **state)
{
    struct picture pictures[4];
    struct set s = two_captures(pictures);
    (void)state;
    place(&s, (struct split_size){2, 1});
    assert_int_equal(s.model.image_count, 4);
    assert_pose(&s, &pictures[3]);
    assert_int_equal(image_called(&s, "b_c2r1.png")->camera_idx, 1); /* of the same lens, not of the same photo */
    release(&s);
}

static void lenses_that_move_place_nothing(void **state)
{
    struct picture pictures[4];
    struct set s = two_captures(pictures);
    (void)state;
    place(&s, (struct split_size){0});
    assert_int_equal(s.model.image_count, 3);
    release(&s);
}

static void a_lens_without_its_like_stays_out(void **state)
{
    struct picture pictures[4];
    struct set s = two_captures(pictures);
    (void)state;
    free(s.model.images[--s.model.image_count].name); /* of b nothing is placed */
    place(&s, (struct split_size){2, 1});
    assert_int_equal(s.model.image_count, 2);
    release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_of_a_panorama_are_placed),
        cmocka_unit_test(a_panorama_without_a_placed_view_stays_out),
        cmocka_unit_test(a_lens_is_placed_beside_another),
        cmocka_unit_test(lenses_that_move_place_nothing),
        cmocka_unit_test(a_lens_without_its_like_stays_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
