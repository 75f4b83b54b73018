/* True depths of planes: rays and axes, lenses and turns, jumps, and which pixels the other camera cannot see. */
#include "stages/evaluate/true_depth.h"

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

static void rays_become_depth_along_the_views_axis(void **state)
{
    struct true_photo p = photo_of(&fisheye, true);
    struct lens lens = {.camera = fisheye, .view_from_photo = {1, 0, 0, 0}};
    struct camera square = {CAMERA_PINHOLE, 20, 20, {10, 10, 10, 10}};
    struct view v = view_of(&square);
    struct vec3 ray;
    (void)state;
    for (int i = 0; i < 3600; i++) { /* a wall at z = 2 before the photo, one at x = -3 to its left */
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

static void no_depth_lies_between_two_sides_of_a_jump(void **state)
{
    struct true_photo p = photo_of(&pinhole, false);
    struct camera larger = {
        CAMERA_PINHOLE, 3 * W, 3 * H, {30, 30, 3 * W / 2.0, 3 * H / 2.0}}; /* photo of 3x the truth */
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
        if (i % 57 < 2 && i / 57 < 2) continue;     /* where the truth has none */
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

/* A wall at 4 with a post at 2 before it in columns 18..21; the other camera stands 0.96 to the right. There the post is
 * shifted by 4.8 px and the wall by 2.4 px: the wall's columns 0 and 1 leave the picture, and those whose centres come to
 * lie in columns 13..16 stand behind the post: 15, 16 and 17. */
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
    /* with itself in its place everything is seen, with nobody nothing is */
    others[0] = &a;
    assert_ok(true_occlusion(hidden, &a, points, others, 1, &err), err);
    for (int i = 0; i < W * H; i++) assert_int_equal(hidden[i], 0);
    assert_ok(true_occlusion(hidden, &a, points, others, 0, &err), err);
    for (int i = 0; i < W * H; i++) assert_int_equal(hidden[i], 1);
    free(a.depth);
    free(depth);
}

static void what_the_post_hides_by_forward_warping(void **state)
{
    uint8_t columns[W];
    (void)state;
    occluded_columns(columns, false);
    for (int x = 0; x < W; x++) assert_int_equal(columns[x], x <= 1 || (x >= 15 && x <= 17));
}

/* The other photo's depth is looked at in 3x3 pixels, so that column 15, beside the post's edge there, is seen. */
static void what_the_post_hides_by_the_others_depth(void **state)
{
    uint8_t columns[W];
    (void)state;
    occluded_columns(columns, true);
    for (int x = 0; x < W; x++) assert_int_equal(columns[x], x <= 1 || x == 16 || x == 17);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_become_depth_along_the_views_axis),
        cmocka_unit_test(no_depth_lies_between_two_sides_of_a_jump),
        cmocka_unit_test(what_the_post_hides_by_forward_warping),
        cmocka_unit_test(what_the_post_hides_by_the_others_depth),
    };
    return cmocka_run_group_tests_name("true_depth", tests, NULL, NULL);
}
