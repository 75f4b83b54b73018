/* point_grid.c - merging in a grid: weighted means, separate sides, order, size. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/fuse_points/point_grid.h"

static struct fused_sample at(double x, double y, double z, float confidence)
{
    return (struct fused_sample){{x, y, z}, {0, 0, -1}, {confidence, 1, 0}, confidence, 3};
}

static void add(struct point_grid *g, struct fused_sample s)
{
    struct err err = ERR_INIT;
    assert_ok(point_grid_add(g, &s, &err), err);
}

static void points(struct point_cloud *cloud, struct point_grid *g)
{
    struct err err = ERR_INIT;
    *cloud = (struct point_cloud){0};
    assert_ok(point_grid_points(cloud, g, &err), err);
    point_grid_release(g);
}

static void open_grid(struct point_grid *g, double edge)
{
    struct err err = ERR_INIT;
    assert_ok(point_grid_init(g, edge, &err), err);
}

static void a_point_is_the_mean_weighted_by_confidence(void **state)
{
    struct point_grid g;
    struct point_cloud cloud;
    (void)state;
    open_grid(&g, 0.5);
    add(&g, at(-0.4, 0.1, 2.1, 0.75f));
    struct fused_sample s = at(-0.2, 0.3, 2.3, 0.25f);
    s.normal = vec3_make(0, 0.6, -0.8);
    s.views = 5;
    add(&g, s);
    add(&g, at(0.1, 0.1, 2.1, 1)); /* the next cell */
    points(&cloud, &g);
    assert_int_equal(cloud.count, 2);
    const struct cloud_point *p = cloud.points;
    assert_true(fabs(p->position.x + 0.35) < 1e-12 && fabs(p->position.y - 0.15) < 1e-12 &&
                fabs(p->position.z - 2.15) < 1e-12);
    const double length = hypot(0.15, 0.95);
    assert_true(fabs((double)p->normal[1] - 0.15 / length) < 1e-6 && fabs((double)p->normal[2] + 0.95 / length) < 1e-6);
    assert_int_equal(p->views, 5);
    assert_true(fabs((double)p->confidence - 0.625) < 1e-6); /* 0.75^2 + 0.25^2 */
    assert_int_equal(p->color[1], 255);
    assert_true(fabs(cloud.points[1].position.x - 0.1) < 1e-12);
    point_cloud_release(&cloud);
}

static void two_sides_of_a_thin_object_stay_separate(void **state)
{
    struct point_grid g;
    struct point_cloud cloud;
    (void)state;
    open_grid(&g, 1);
    for (int i = 0; i < 4; i++) {
        struct fused_sample s = at(0.25, 0.25, i & 1 ? 0.75 : 0.25, 1);
        if (i & 1) s.normal.z = 1;
        add(&g, s);
    }
    points(&cloud, &g);
    assert_int_equal(cloud.count, 2);
    assert_true(cloud.points[0].position.z == 0.25 && cloud.points[1].position.z == 0.75);
    assert_true(cloud.points[0].normal[2] == -1 && cloud.points[1].normal[2] == 1);
    point_cloud_release(&cloud);
}

static void points_keep_the_order_of_their_first_samples(void **state)
{
    enum { SIDE = 60 };
    struct point_grid g;
    struct point_cloud cloud;
    (void)state;
    open_grid(&g, 0.01);
    for (int again = 0; again < 2; again++)
        for (int i = 0; i < SIDE * SIDE * SIDE; i++)
            add(&g, at(0.01 * (i % SIDE - 30) + 0.005, 0.01 * (i / SIDE % SIDE - 30) + 0.005,
                       0.01 * (i / SIDE / SIDE - 30) + 0.005, 0.5f));
    points(&cloud, &g);
    assert_int_equal(cloud.count, SIDE * SIDE * SIDE);
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        assert_true(fabs(cloud.points[i].position.x - (0.01 * (i % SIDE - 30) + 0.005)) < 1e-9);
        assert_true(fabs(cloud.points[i].position.z - (0.01 * (i / SIDE / SIDE - 30) + 0.005)) < 1e-9);
    }
    point_cloud_release(&cloud);
}

static void samples_beyond_the_grid_are_ignored(void **state)
{
    struct point_grid g;
    struct point_cloud cloud;
    (void)state;
    open_grid(&g, 0.01);
    add(&g, at(1e300, 0, 0, 1));
    add(&g, at(INFINITY, 0, 0, 1));
    add(&g, at(0, NAN, 0, 1));
    add(&g, at(1e9, -1e9, 0, 1)); /* far, but in a valid cell */
    add(&g, at(0, 0, 0, 0));      /* a sample without confidence is still a point */
    points(&cloud, &g);
    assert_int_equal(cloud.count, 2);
    assert_true(fabs(cloud.points[0].position.x - 1e9) < 1e-5);
    assert_true(cloud.points[1].confidence == 0);
    point_cloud_release(&cloud);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_is_the_mean_weighted_by_confidence),
        cmocka_unit_test(two_sides_of_a_thin_object_stay_separate),
        cmocka_unit_test(points_keep_the_order_of_their_first_samples),
        cmocka_unit_test(samples_beyond_the_grid_are_ignored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
