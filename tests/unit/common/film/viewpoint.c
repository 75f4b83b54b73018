/* viewpoint.c - tests of the hole measure H against sums by hand, and of the validity of viewpoints. */
#include "common/film/viewpoint.h"

#include "common/base/parallel.h"
#include "tests/unit/scratch.h"
#include "tests/unit/wall_scene.h"

/* ---------------------------------------------------------------------------------------------------------------- H */

static double h_of(const uint8_t *hole, int width, int height)
{
    float *scratch_row = malloc((size_t)width * (size_t)height * sizeof *scratch_row);
    struct err err = ERR_INIT;
    double h = -1;
    assert_non_null(scratch_row);
    assert_ok(hole_measure(&h, hole, width, height, scratch_row, &err), err);
    free(scratch_row);
    return h;
}

static uint8_t *no_hole(int width, int height)
{
    uint8_t *hole = calloc((size_t)width * (size_t)height, 1);
    assert_non_null(hole);
    return hole;
}

static double rectangle_hole(int width, int height, int x0, int y0, int wide, int high)
{
    uint8_t *hole = no_hole(width, height);
    for (int y = y0; y < y0 + high; y++)
        for (int x = x0; x < x0 + wide; x++) hole[y * width + x] = 1;
    const double h = h_of(hole, width, height);
    free(hole);
    return h;
}

static double square_hole(int width, int height, int side)
{
    return rectangle_hole(width, height, width / 3, height / 3, side, side);
}

static double disk_hole(int width, int height, double radius)
{
    uint8_t *hole = no_hole(width, height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            hole[y * width + x] = hypot(x + 0.5 - 0.5 * width, y + 0.5 - 0.5 * height) < radius;
    const double h = h_of(hole, width, height);
    free(hole);
    return h;
}

/* In a square hole the nearest valid pixel is straight across the nearest side: rings of d = 1, 2, 3. */
static void h_of_a_square_is_a_sum_over_rings(void **state)
{
    (void)state;
    const double pixels = 1200.0 * 800;
    assert_float_equal(square_hole(1200, 800, 1), 1 / pixels, 1e-15);
    assert_float_equal(square_hole(1200, 800, 2), 4 / pixels, 1e-15);
    assert_float_equal(square_hole(1200, 800, 3), (8 + 8) / pixels, 1e-15);
    assert_float_equal(square_hole(1200, 800, 5), (16 + 8 * 8 + 27) / pixels, 1e-15);
    assert_float_equal(square_hole(1200, 800, 6), (20 + 12 * 8 + 4 * 27) / pixels, 1e-15);
    /* portrait, and a tenth of the size: d counts ten times, a pixel a hundred times */
    assert_float_equal(square_hole(800, 1200, 5), 107 / pixels, 1e-15);
    assert_float_equal(square_hole(120, 80, 5), 107 * 1000 / (120.0 * 80), 1e-12);
}

static void h_of_a_strip_at_the_border_counts_from_one_side(void **state)
{
    (void)state;
    enum { WIDE = 600, HIGH = 400, STRIP = 20 };
    /* each row: 1 + 8 + ... + 20^3 = (20 * 21 / 2)^2; d counts twice at 1200 px */
    assert_float_equal(rectangle_hole(WIDE, HIGH, 0, 0, STRIP, HIGH), 8.0 * 210 * 210 / WIDE, 1e-9);
}

/* The integral of (R - r)^3 2 pi r is pi R^5 / 10. */
static void h_of_a_disk_is_its_integral(void **state)
{
    (void)state;
    const double h = disk_hole(1200, 800, 300), wanted = M_PI * pow(300, 5) / 10 / (1200.0 * 800);
    assert_float_equal(h / wanted, 1, 0.01);
}

static void h_does_not_depend_on_the_resolution(void **state)
{
    (void)state;
    const double whole = disk_hole(1200, 800, 240);
    for (int part = 2; part <= 5; part++)
        assert_float_equal(disk_hole(1200 / part, 800 / part, 240.0 / part) / whole, 1, 0.03);
    assert_float_equal(disk_hole(2400, 1600, 480) / whole, 1, 0.03);
}

static void h_is_0_without_holes_and_infinite_without_pixels(void **state)
{
    (void)state;
    uint8_t hole[30 * 20] = {0};
    assert_true(h_of(hole, 30, 20) == 0);
    memset(hole, 1, sizeof hole);
    assert_true(h_of(hole, 30, 20) == INFINITY);
    hole[0] = 0; /* one valid pixel: large but finite */
    assert_true(isfinite(h_of(hole, 30, 20)) && h_of(hole, 30, 20) > 1e4);
}

static void one_large_hole_is_worse_than_two_small_ones(void **state)
{
    (void)state;
    assert_true(square_hole(300, 200, 14) > 2 * square_hole(300, 200, 10)); /* about the same area */
}

/* ------------------------------------------------------------------------------------------------------- viewpoints */

struct fixture {
    struct wall_scene f;
    struct scene_points points;
    struct shot_setup shot;
    struct viewpoint_test test;
};

/* Three views in a row in front of a wall with a box; the film has the views' lens. */
static void set_up(struct fixture *x)
{
    struct err err = ERR_INIT;
    *x = (struct fixture){.shot = {.up = {0, -1, 0}, .axis_z = {0, 0, 1}, .centroid = {0, 0, 10}, .near_limit = 3}};
    for (int i = 0; i < 3; i++) add_straight(&x->f, i - 1, 0, 0);
    finish(&x->f, wall_and_box, 2);
    assert_ok(scene_points_collect(&x->points, &x->f.scene, &err), err);
    x->test = (struct viewpoint_test){
        .scene = &x->f.scene, .points = &x->points, .shot = &x->shot, .limits = {2, 0.03, 1000}};
}

static void tear_down(struct fixture *x)
{
    viewpoint_test_release(&x->test);
    viewpoint_test_release(&x->test);
    scene_points_release(&x->points);
    layer_scene_release(&x->f.scene);
}

static struct view moved(const struct fixture *x, double right, double down, double forward)
{
    struct view v = x->f.views[1];
    v.center = vec3_add(v.center, vec3_make(right, down, forward));
    v.translation = vec3_scale(v.center, -1);
    return v;
}

static struct viewpoint measure(struct fixture *x, struct view camera)
{
    struct viewpoint v;
    struct err err = ERR_INIT;
    bool valid = true;
    assert_ok(viewpoint_measure(&v, &x->test, &camera, &err), err);
    assert_ok(viewpoint_is_valid(&valid, &x->test, &camera, &err), err);
    assert_true(valid == v.valid);
    assert_true(v.h >= 0 && v.holes >= 0 && v.holes <= 1 && v.outside >= 0 && v.outside <= 1 + 1e-6 && v.near >= 0 &&
                v.near <= 1);
    return v;
}

static void a_view_is_a_valid_viewpoint(void **state)
{
    (void)state;
    struct fixture x;
    set_up(&x);
    const struct viewpoint v = measure(&x, x.f.views[1]);
    assert_true(v.valid && v.h == 0 && v.holes == 0 && v.near == 0);
    assert_true(v.outside < 1e-6);
    tear_down(&x);
}

static void holes_outside_and_near_each_invalidate_a_viewpoint(void **state)
{
    (void)state;
    struct fixture x;
    set_up(&x);
    /* 1.5 up: 24 of 120 rows show a part of the wall at 10 that no view saw. The wall behind the box at 6, 64 columns
     * less 10.7 on each side that the other two views see, appears in 1.5 * 160 (1/6 - 1/10) = 16 rows. */
    struct viewpoint v = measure(&x, moved(&x, 0, -1.5, 0));
    assert_false(v.valid);
    assert_float_equal(v.outside, 0.2, 0.02); /* measured in 64 x 48 px */
    assert_float_equal(v.holes, 0.2 + (64 - 21.3) * 16 / (W * H), 0.005);
    x.test.limits.max_outside = 1;
    assert_false(measure(&x, moved(&x, 0, -1.5, 0)).valid);
    x.test.limits.max_h = 1e9;
    assert_true(measure(&x, moved(&x, 0, -1.5, 0)).valid);
    x.test.limits.max_outside = 0.1;
    assert_false(measure(&x, moved(&x, 0, -1.5, 0)).valid);
    x.test.limits = (struct viewpoint_limits){2, 0.03, 1000};
    /* the box at 6 is nearer than 3 */
    assert_true(measure(&x, moved(&x, 0, 0, 2.9)).near == 0);
    v = measure(&x, moved(&x, 0, 0, 3.1));
    assert_true(v.near > 0.1 && !v.valid && v.h < 2 && v.outside < 0.03);
    tear_down(&x);
}

static void h_must_be_below_its_limit(void **state)
{
    (void)state;
    struct fixture x;
    set_up(&x);
    x.test.limits.max_outside = 1;
    const struct view camera = moved(&x, 0.2, -0.4, 0);
    const double h = measure(&x, camera).h;
    assert_true(h > 0);
    x.test.limits.max_h = h;
    assert_false(measure(&x, camera).valid);
    x.test.limits.max_h = h * (1 + 1e-9);
    assert_true(measure(&x, camera).valid);
    tear_down(&x);
}

static void a_camera_that_sees_nothing_has_infinite_h(void **state)
{
    (void)state;
    struct fixture x;
    set_up(&x);
    struct view away = x.f.views[1];
    away.cam_from_world = (struct mat3){{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
    away.translation = vec3_make(0, 0, 0);
    struct viewpoint v = measure(&x, away);
    assert_true(!v.valid && isinf(v.h) && v.holes == 1 && v.outside == 1 && v.near == 1);
    away = x.f.views[1];
    away.fx = away.fy = 0; /* the camera of an end whose rule cannot be met */
    v = measure(&x, away);
    assert_true(!v.valid && isinf(v.h) && v.holes == 1 && v.outside == 1 && v.near == 1);
    tear_down(&x);
}

static void smaller_pictures_give_nearly_the_same_h(void **state)
{
    (void)state;
    struct fixture x;
    set_up(&x);
    const struct view camera = moved(&x, 0, -1.5, 0);
    const double whole = measure(&x, camera).h;
    x.test.limits.side = 80;
    assert_float_equal(measure(&x, camera).h / whole, 1, 0.15); /* a strip of 24 or 12 px */
    tear_down(&x);
}

static void all_are_valid_if_each_is(void **state)
{
    (void)state;
    enum { COUNT = 5 };
    struct fixture x;
    struct view cameras[COUNT];
    struct err err = ERR_INIT;
    bool all = false;
    set_up(&x);
    for (int threads = 1; threads <= 3; threads += 2) {
        parallel_set_threads(threads);
        for (int bad = -1; bad < COUNT; bad++) { /* none, or one of them */
            for (int i = 0; i < COUNT; i++) cameras[i] = moved(&x, 0, i == bad ? -1.5 : 0, 0.02 * i);
            x.test.renders = 0;
            assert_ok(viewpoints_are_valid(&all, cameras, COUNT, &x.test, &err), err);
            assert_true(all == (bad < 0));
            if (bad < 0) assert_int_equal(x.test.renders, COUNT);
            if (bad == 0 && threads == 1) assert_int_equal(x.test.renders, 0); /* too much of it is outside */
        }
        assert_ok(viewpoints_are_valid(&all, cameras, 0, &x.test, &err), err);
        assert_true(all);
    }
    parallel_set_threads(0);
    tear_down(&x);
}

static void near_points_are_counted_as_single_projections_count_them(void **state)
{
    (void)state;
    struct fixture x;
    int some = 0;
    set_up(&x);
    const size_t count = x.points.count;
    for (int i = 0; i < 40; i++) {
        struct view camera = moved(&x, 0.2 * (i % 7) - 0.6, 0.1 * (i % 5) - 0.2, 0.3 * i);
        double near = 0, total = 0;
        if (i % 3 == 2) camera.cam_from_world = (struct mat3){{{0.6, 0, -0.8}, {0, 1, 0}, {0.8, 0, 0.6}}};
        camera.translation = vec3_scale(mat3_apply(camera.cam_from_world, camera.center), -1);
        x.points.count = count - (size_t)(i % 4); /* any remainder of four */
        x.shot.near_limit = 1 + 0.2 * i;
        for (size_t k = 0; k < x.points.count; k++) {
            double u = -1, v = -1;
            const double z = view_project(&camera, x.points.points[k].position, &u, &v);
            if (!(z > 0) || u < 0 || u > camera.width || v < 0 || v > camera.height) continue;
            total += x.points.points[k].weight;
            if (z < x.shot.near_limit) near += x.points.points[k].weight;
        }
        assert_true(measure(&x, camera).near == (total > 0 ? near / total : 1));
        some += near > 0 && near < total;
    }
    assert_true(some > 3);
    tear_down(&x);
}

static void any_thread_count_gives_the_same_measures(void **state)
{
    (void)state;
    enum { COUNT = 12 };
    struct fixture x;
    struct view cameras[COUNT];
    struct viewpoint one[COUNT], three[COUNT];
    struct err err = ERR_INIT;
    set_up(&x);
    for (int i = 0; i < COUNT; i++) cameras[i] = moved(&x, 0.3 * i - 1.5, 0.1 * (i % 4), 0.2 * (i % 3));
    parallel_set_threads(1);
    assert_ok(viewpoints_measure(one, cameras, COUNT, &x.test, &err), err);
    assert_int_equal(x.test.renders, COUNT);
    parallel_set_threads(3);
    assert_ok(viewpoints_measure(three, cameras, COUNT, &x.test, &err), err);
    for (int i = 0; i < COUNT; i++) {
        const struct viewpoint v = measure(&x, cameras[i]);
        assert_true(one[i].h == three[i].h && one[i].holes == three[i].holes && one[i].outside == three[i].outside);
        assert_true(one[i].near == three[i].near && one[i].valid == three[i].valid);
        assert_true(one[i].h == v.h && one[i].outside == v.outside && one[i].valid == v.valid);
    }
    assert_ok(viewpoints_measure(one, cameras, 0, &x.test, &err), err);
    tear_down(&x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(h_of_a_square_is_a_sum_over_rings),
        cmocka_unit_test(h_of_a_strip_at_the_border_counts_from_one_side),
        cmocka_unit_test(h_of_a_disk_is_its_integral),
        cmocka_unit_test(h_does_not_depend_on_the_resolution),
        cmocka_unit_test(h_is_0_without_holes_and_infinite_without_pixels),
        cmocka_unit_test(one_large_hole_is_worse_than_two_small_ones),
        cmocka_unit_test(a_view_is_a_valid_viewpoint),
        cmocka_unit_test(holes_outside_and_near_each_invalidate_a_viewpoint),
        cmocka_unit_test(h_must_be_below_its_limit),
        cmocka_unit_test(a_camera_that_sees_nothing_has_infinite_h),
        cmocka_unit_test(smaller_pictures_give_nearly_the_same_h),
        cmocka_unit_test(all_are_valid_if_each_is),
        cmocka_unit_test(near_points_are_counted_as_single_projections_count_them),
        cmocka_unit_test(any_thread_count_gives_the_same_measures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
