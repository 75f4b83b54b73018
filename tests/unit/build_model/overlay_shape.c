/* overlay_shape.c - which photos of an edit may show other edges than those of the unedited model. */
#include "stages/build_model/picture/overlay_shape.h"

#include <math.h>

#include "tests/unit/box_solids.h"

static const struct box bare[] = {ROOM_OUTSIDE, ROOM_INSIDE};
static const struct box renamed[] = {{"walls", "outer", {-3, -3, -3}, {3, 3, 3}, false},
                                     {"walls", "inner", {-2, -2, -2}, {2, 2, 2}, true}};
/* A box on the wall at z = 2, a pane, and the room with one wall moved. */
static const struct box with_box[] = {
    ROOM_OUTSIDE, ROOM_INSIDE, {"box", "box", {-0.5, -0.5, 1.5}, {0.5, 0.5, 1.9}, false}};
static const struct box with_pane[] = {
    ROOM_OUTSIDE, ROOM_INSIDE, {"glass/box", "box", {-0.5, -0.5, 1.5}, {0.5, 0.5, 1.9}, false}};
static const struct box moved[] = {ROOM_OUTSIDE, {"walls", "in", {-2, -2, -2}, {2, 2, 1.5}, true}};

/* A photo from the room's middle, turned about y: 0 looks at z = 2. */
static struct photo_camera look(double turn, double focal)
{
    const struct view v = view_at(vec3_make(0, 0, 0), turn, 0, 400, 300, focal);
    return (struct photo_camera){
        {CAMERA_PINHOLE, 400, 300, {focal, focal, 200, 150}}, v.cam_from_world, v.translation, v.center, 0};
}

static bool differs(const struct box *a, int in_a, const struct box *b, int in_b, const struct photo_camera *camera)
{
    const struct box *boxes[2] = {a, b};
    const int counts[2] = {in_a, in_b};
    struct solid_mesh meshes[2];
    struct overlay_shape shapes[2] = {{0}};
    struct err err = ERR_INIT;
    for (int k = 0; k < 2; k++) {
        meshes[k] = make_boxes(boxes[k], counts[k]);
        assert_ok(overlay_shape_make(&shapes[k], &meshes[k], &err), err);
    }
    const bool found = overlay_shape_differs(&meshes[0], &shapes[0], &meshes[1], &shapes[1], camera);
    assert_int_equal(overlay_shape_differs(&meshes[1], &shapes[1], &meshes[0], &shapes[0], camera), found);
    for (int k = 0; k < 2; k++) {
        overlay_shape_release(&shapes[k]);
        solid_mesh_release(&meshes[k]);
    }
    return found;
}

static void hash_of(char hash[HASH_TEXT], const struct box *boxes, int count)
{
    struct solid_mesh mesh = make_boxes(boxes, count);
    struct overlay_shape shape = {0};
    struct err err = ERR_INIT;
    assert_ok(overlay_shape_make(&shape, &mesh, &err), err);
    assert_ok(overlay_shape_hash(hash, &shape, &err), err);
    overlay_shape_release(&shape);
    solid_mesh_release(&mesh);
}

static void the_hash_is_of_faces_and_not_of_names(void **state)
{
    char hashes[5][HASH_TEXT];
    (void)state;
    hash_of(hashes[0], bare, 2);
    hash_of(hashes[1], renamed, 2);
    hash_of(hashes[2], with_box, 3);
    hash_of(hashes[3], with_pane, 3);
    hash_of(hashes[4], moved, 2);
    assert_string_equal(hashes[0], hashes[1]);
    for (int i = 1; i < 5; i++)
        for (int k = i + 1; k < 5; k++) assert_string_not_equal(hashes[i], hashes[k]);
}

static void a_photo_that_looks_away_from_a_new_box_shows_no_difference(void **state)
{
    (void)state;
    /* the box is within atan(0.5 sqrt(2) / 1.5) = 25.3 degrees of +z; half of a photo's diagonal is 32 degrees */
    for (int degrees = 0; degrees <= 180; degrees += 5) {
        const struct photo_camera camera = look(degrees * M_PI / 180, 400);
        const bool found = differs(bare, 2, with_box, 3, &camera);
        if (degrees <= 50) assert_true(found);  /* it is in the picture, or near it */
        if (degrees >= 65) assert_false(found); /* 25.3 + 32 + 2 degrees, and what 48 planes leave of a cone */
        assert_false(differs(bare, 2, renamed, 2, &camera));
    }
}

static void a_wall_that_reaches_into_the_photo_is_a_difference(void **state)
{
    (void)state;
    const struct photo_camera at_it = look(0, 400), beside = look(M_PI / 3, 400), away = look(M_PI, 400);
    assert_true(differs(bare, 2, moved, 2, &at_it));
    assert_true(differs(bare, 2, moved, 2, &beside));
    assert_true(
        differs(bare, 2, moved, 2, &away)); /* the walls at its sides became shorter, and reach behind the camera */
}

static void a_lens_as_wide_as_a_half_space_may_show_everything(void **state)
{
    (void)state;
    struct photo_camera away = look(M_PI, 400);
    away.lens = (struct camera){CAMERA_OPENCV_FISHEYE, 400, 300, {150, 150, 200, 150}}; /* 95 degrees at its corners */
    assert_true(differs(bare, 2, with_box, 3, &away));
    assert_false(differs(bare, 2, renamed, 2, &away));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hash_is_of_faces_and_not_of_names),
        cmocka_unit_test(a_photo_that_looks_away_from_a_new_box_shows_no_difference),
        cmocka_unit_test(a_wall_that_reaches_into_the_photo_is_a_difference),
        cmocka_unit_test(a_lens_as_wide_as_a_half_space_may_show_everything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
