/* true_depth.c - true depths of planes: through lenses and rotations, at depth edges, and their occlusion. */
#include "stages/evaluate/truth/true_depth.h"

#include "tests/unit/scratch.h"

enum { W = 40, H = 12 };

static const struct camera pinhole = {CAMERA_PINHOLE, W, H, {10, 10, W / 2.0, H / 2.0}};
static const struct camera fisheye = {CAMERA_OPENCV_FISHEYE, 60, 60, {15, 15, 30, 30}};

static struct view view_of(const struct camera *c)
{
    struct view v = {.name = "v", .width = c->width, .height = c->height};
    camera_focal(c, &v.fx, &v.fy, &v.cx, &v.cy);
    return v;
}

static struct true_photo photo_of(const struct camera *c, bool along_ray)
{
    struct true_photo p = {.lens = *c, .pose = {{1, 0, 0, 0}, {0, 0, 0}}, .along_ray = along_ray};
    p.depth = calloc((size_t)c->width * (size_t)c->height, sizeof *p.depth);
    return p;
}

static struct vec3 points[3600];
static uint8_t hidden[3600], occluded[3600];
static float z[3600];

static void ray_lengths_become_depths_along_the_views_axis(void **state)
{
    struct true_photo p = photo_of(&fisheye, true);
    struct lens lens = {.camera = fisheye, .view_from_photo = {1, 0, 0, 0}};
    struct camera square = {CAMERA_PINHOLE, 20, 20, {10, 10, 10, 10}};
    struct view v = view_of(&square);
    struct vec3 ray;
    (void)state;
    for (int i = 0; i < 3600; i++) { /* a wall at z = 2 in front of the photo, another at x = -3 to its left */
        if (!camera_unproject(&fisheye, i % 60 + 0.5, i / 60 + 0.5, &ray)) continue;
        double front = ray.z > 0 ? 2 / ray.z : INFINITY, left = ray.x < 0 ? -3 / ray.x : INFINITY;
        if (fmin(front, left) < 100) p.depth[i] = (float)fmin(front, left);
    }
    true_points(points, &p);
    true_depth_in_view(z, occluded, &v, &lens, &p, points, hidden);
    for (int i = 0; i < 400; i++) assert_true(fabs(z[i] - 2) < 1e-5);

    lens.view_from_photo = (struct quat){sqrt(0.5), 0, sqrt(0.5), 0}; /* the view's z is the photo's -x */
    v.fx = v.fy = 40;
    true_depth_in_view(z, occluded, &v, &lens, &p, points, hidden);
    assert_true(fabs(z[10 * 20 + 10] - 3) < 1e-5);
    free(p.depth);
}

static void no_depth_is_between_the_sides_of_an_edge(void **state)
{
    struct true_photo p = photo_of(&pinhole, false);
    struct camera larger = {
        CAMERA_PINHOLE, 3 * W, 3 * H, {30, 30, 3 * W / 2.0, 3 * H / 2.0}}; /* the photo is 3x as large as the truth */
    struct lens lens = {.camera = larger, .view_from_photo = {1, 0, 0, 0}};
    struct camera between = {CAMERA_PINHOLE, 57, 17, {14, 14, 28.5, 8.5}};
    struct view v = view_of(&between);
    int near = 0, far = 0;
    (void)state;
    for (int i = 0; i < W * H; i++) p.depth[i] = i % W < 20 ? 1 : 5;
    p.depth[0] = 0;
    true_points(points, &p);
    for (int i = 0; i < W * H; i++) hidden[i] = i % W == 20;
    true_depth_in_view(z, occluded, &v, &lens, &p, points, hidden);
    for (int i = 0; i < 57 * 17; i++) {
        near += z[i] == 1;
        far += z[i] == 5;
        if (i % 57 < 2 && i / 57 < 2) continue;     /* the truth is unknown there */
        if (i % 57 == 28 || i % 57 == 56) continue; /* centres on the edges of the true pixels */
        assert_true(z[i] == (i % 57 < 28 ? 1 : 5));
    }
    assert_true(near > 300 && far > 300);
    assert_int_equal(z[0], 0); /* unknown stays unknown */
    assert_int_equal(occluded[0], 0);
    assert_int_equal(occluded[8 * 57 + 29], 1); /* pixel 29 is 29.5 of 57: 20.7 of the truth's 40 */
    assert_int_equal(occluded[8 * 57 + 31], 0);
    free(p.depth);
}

/* A wall at depth 4 with a post at depth 2 in columns 18..21; the other camera is 0.96 to the right. There the post is
 * shifted by 4.8 px and the wall by 2.4 px: the wall's columns 0 and 1 leave the picture, and columns 15, 16 and 17,
 * whose centres move into columns 13..16, are behind the post. */
static void occluded_columns(uint8_t columns[W], bool other_has_depth)
{
    struct true_photo a = photo_of(&pinhole, false), b = photo_of(&pinhole, false);
    const struct true_photo *others[] = {&b};
    struct err err = ERR_INIT;
    for (int i = 0; i < W * H; i++) {
        int x = i % W;
        a.depth[i] = x >= 18 && x <= 21 ? 2 : 4;
        b.depth[i] = x >= 13 && x <= 16 ? 2 : 4;
    }
    b.pose.translation = vec3_make(-0.96, 0, 0);
    float *depth = b.depth;
    if (!other_has_depth) b.depth = NULL;
    true_points(points, &a);
    assert_ok(true_occlusion(hidden, &a, points, others, 1, &err), err);
    for (int x = 0; x < W; x++) columns[x] = hidden[5 * W + x];
    /* the photo itself as the other one sees everything; with no other photo nothing is seen */
    others[0] = &a;
    assert_ok(true_occlusion(hidden, &a, points, others, 1, &err), err);
    for (int i = 0; i < W * H; i++) assert_int_equal(hidden[i], 0);
    assert_ok(true_occlusion(hidden, &a, points, others, 0, &err), err);
    for (int i = 0; i < W * H; i++) assert_int_equal(hidden[i], 1);
    free(a.depth);
    free(depth);
}

static void a_post_occludes_by_forward_warping(void **state)
{
    uint8_t columns[W];
    (void)state;
    occluded_columns(columns, false);
    for (int x = 0; x < W; x++) assert_int_equal(columns[x], x <= 1 || (x >= 15 && x <= 17));
}

/* The test uses 3 x 3 pixels of the other photo's depth, so that column 15, beside the edge of the post, is visible. */
static void a_post_occludes_by_the_other_photos_depth(void **state)
{
    uint8_t columns[W];
    (void)state;
    occluded_columns(columns, true);
    for (int x = 0; x < W; x++) assert_int_equal(columns[x], x <= 1 || x == 16 || x == 17);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ray_lengths_become_depths_along_the_views_axis),
        cmocka_unit_test(no_depth_is_between_the_sides_of_an_edge),
        cmocka_unit_test(a_post_occludes_by_forward_warping),
        cmocka_unit_test(a_post_occludes_by_the_other_photos_depth),
    };
    return cmocka_run_group_tests_name("true_depth", tests, NULL, NULL);
}
