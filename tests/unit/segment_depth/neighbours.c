/* neighbours.c - choice of neighbours and depth range for cameras around a patch of points. */
#include "stages/segment_depth/neighbours.h"

#include "tests/unit/segment_depth/scene.h"

enum { ALL = 63 };

static struct scene scene; /* zeroed by start(); large */

/* The view itself, 160 x 120, at the origin. */
static void start(void)
{
    memset(&scene, 0, sizeof scene);
    scene_view(&scene, 160, 120, 160, 0, 0, 0, 0);
}

static int at(double x, double y, double z)
{
    scene_view(&scene, 160, 120, 160, x, y, z, 0);
    return scene.set.view_count - 1;
}

/* Points about (0, 0, 10), to be added after the views. */
static void patch(int count, unsigned mask)
{
    for (int i = 0; i < count; i++)
        scene_point(&scene,
                    vec3_make(4 * scene_hash(i, 0, 0) - 2, 3 * scene_hash(i, 0, 1) - 1.5, 9.5 + scene_hash(i, 0, 2)),
                    mask);
}

static int choose(int neighbours[MAX_NEIGHBOURS], int max_count, struct err *err)
{
    struct observed_points seen;
    int count = -1;
    *err = (struct err)ERR_INIT;
    assert_int_equal(neighbours_find_points(&seen, &scene.set, 0, err), ST_OK);
    const enum status st = neighbours_choose(neighbours, &count, &scene.set, 0, &seen, max_count, err);
    assert_int_equal(st, count ? ST_OK : ST_DATA);
    for (int i = 0; i < count; i++) {
        assert_in_range(neighbours[i], 1, scene.set.view_count - 1);
        for (int k = 0; k < i; k++) assert_int_not_equal(neighbours[i], neighbours[k]);
    }
    neighbours_release_points(&seen);
    return count;
}

static void small_and_large_angles_are_avoided(void **state)
{
    (void)state;
    int n[MAX_NEIGHBOURS];
    struct err err;
    start();
    at(0.02, 0, 0); /* a tenth of a degree */
    at(12, 0, 0);   /* 50 degrees */
    const int left = at(-1.4, 0, 0), right = at(1.5, 0, 0);
    patch(60, ALL);
    assert_int_equal(choose(n, 16, &err), 2); /* the others add almost nothing */
    assert_int_equal(n[0] + n[1], left + right);
    assert_int_equal(choose(n, 1, &err), 1);
}

static void at_most_the_requested_number_is_chosen(void **state)
{
    (void)state;
    int n[MAX_NEIGHBOURS];
    struct err err;
    start();
    for (int i = 0; i < 5; i++) at(1.5 * cos(i), 1.5 * sin(i), 0);
    patch(60, ALL);
    for (int k = 1; k <= 7; k++) assert_int_equal(choose(n, k, &err), k < 5 ? k : 5);
}

static void the_second_neighbour_adds_a_direction(void **state)
{
    (void)state;
    int n[MAX_NEIGHBOURS];
    struct err err;
    start();
    at(1.5, 0, 0);
    at(1.55, 0, 0);
    const int above = at(0, -1, 0);
    patch(60, ALL);
    assert_int_equal(choose(n, 2, &err), 2);
    assert_true(n[0] == above || n[1] == above);
}

/* A corner of the view with few points gets a neighbour, though others share many more points elsewhere; also if the
 * view observed none of the corner's points. */
static void neighbours_cover_the_whole_view(void **state)
{
    (void)state;
    for (int own = 0; own < 2; own++) {
        int n[MAX_NEIGHBOURS];
        struct err err;
        start();
        const int many[3] = {at(1.5, 0, 0), at(0, 1.2, 0), at(-1.3, 0.2, 0)}, few = at(1, 1, 0);
        patch(200, 1u | 1u << many[0] | 1u << many[1] | 1u << many[2]);
        for (int i = 0; i < 60; i++) /* to the right of them */
            scene_point(&scene, vec3_make(2.6 + 2.2 * scene_hash(i, 1, 0), 3 * scene_hash(i, 1, 1) - 1.5, 10),
                        (unsigned)own | 1u << few);
        const int count = choose(n, own ? 2 : 3, &err);
        bool found = false;
        for (int k = 0; k < count; k++) found = found || n[k] == few;
        assert_true(found);
    }
}

static void similar_scales_are_preferred(void **state)
{
    (void)state;
    int n[MAX_NEIGHBOURS];
    struct err err;
    start();
    at(7, 0, -20);                     /* 13 degrees, from three times the distance */
    const int beside = at(0.85, 0, 0); /* almost 5 */
    patch(60, ALL);
    choose(n, 1, &err);
    assert_int_equal(n[0], beside);
}

static void a_view_that_shares_no_points_comes_last(void **state)
{
    (void)state;
    int n[MAX_NEIGHBOURS];
    struct err err;
    start();
    at(1.5, 0, 0);
    const int seen_by = at(-0.4, 0, 0);
    patch(60, 1u | 1u << seen_by);
    assert_int_equal(choose(n, 4, &err), 2);
    assert_int_equal(n[0], seen_by);
    assert_int_equal(choose(n, 1, &err), 1);
    assert_int_equal(n[0], seen_by);
}

static void without_points_the_nearest_pose_is_chosen(void **state)
{
    (void)state;
    int n[MAX_NEIGHBOURS];
    struct err err;
    start();
    at(3, 0, 0);
    const int near = at(0.5, 0, 0);
    scene_view(&scene, 160, 120, 160, 0.1, 0, 0, 1.2); /* nearer, but facing away */
    assert_int_equal(choose(n, 4, &err), 2);
    assert_int_equal(n[0], near);
}

/* A few points tell how far the scene is, so that poses with a good angle to it come first. */
static void with_few_points_the_poses_that_show_most_are_chosen(void **state)
{
    (void)state;
    int n[MAX_NEIGHBOURS];
    struct err err;
    start();
    at(0.02, 0, 0); /* a tenth of a degree */
    const int wide = at(2, 0, 0);
    scene_view(&scene, 160, 120, 160, 0.1, 0, 0, 1.2); /* faces away */
    const int narrow = at(0.5, 0, 0);
    scene_view(&scene, 160, 120, 160, 0, 0, 30, 0); /* behind the scene */
    patch(7, ALL);
    assert_int_equal(choose(n, 4, &err), 2);
    assert_int_equal(n[0], wide);
    assert_int_equal(n[1], narrow);
}

static void a_view_without_neighbours_is_an_error(void **state)
{
    (void)state;
    int n[MAX_NEIGHBOURS];
    struct err err;
    for (int which = 0; which < 4; which++) {
        start();
        if (which == 1) scene_view(&scene, 160, 120, 160, 0, 0, 0, 0.1); /* a tripod: rotation only */
        if (which == 1) at(0, 0, 0);
        if (which >= 2) scene_view(&scene, 160, 120, 160, 1, 0, 0, 2.5); /* faces elsewhere */
        if (which != 2) patch(60, which == 3 ? 1 : ALL);
        assert_int_equal(choose(n, 4, &err), 0);
        assert_int_equal(err.status, ST_DATA);
        assert_non_null(strstr(err.text, "view a has no neighbour"));
        assert_non_null(strstr(err.text, which == 1 ? "none of the 2 other"
                                         : which    ? "none of the 1 other"
                                                    : "none of the 0 other"));
    }
}

static void observed_points_are_in_front_with_small_reprojection_error(void **state)
{
    (void)state;
    struct observed_points seen;
    struct err err = ERR_INIT;
    start();
    at(1, 0, 0);
    patch(6, ALL);
    scene.observations[0][1].u += 3;        /* observed elsewhere */
    scene.observations[0][2].point_id = -1; /* observation without a point */
    scene.observations[0][3].point_id = 5;  /* not in the list */
    scene.points[4].position.z = -7;        /* behind */
    scene.observations[0][5].v += 1.5;      /* a small error is accepted */
    assert_int_equal(neighbours_find_points(&seen, &scene.set, 0, &err), ST_OK);
    assert_int_equal(seen.count, 2);
    for (int i = 0; i < 2; i++) {
        const struct observed_point *p = &seen.points[i];
        const struct vec3 x = scene.points[p->point_idx].position;
        assert_int_equal(p->point_idx, i ? 5 : 0);
        assert_near(p->inverse_z, 1 / x.z, 1e-15);
        assert_near(p->u, 80 + 160 * x.x / x.z, 1e-9);
        assert_near(p->v, 60 + 160 * x.y / x.z, 1e-9);
    }
    neighbours_release_points(&seen);
    neighbours_release_points(&seen);
    neighbours_release_points(NULL);
    scene.set.model.image_count = 0; /* no points */
    assert_int_equal(neighbours_find_points(&seen, &scene.set, 0, &err), ST_OK);
    assert_int_equal(seen.count, 0);
    neighbours_release_points(&seen);
}

static bool range_of(double *min_inverse_z, double *max_inverse_z)
{
    bool guessed = false;
    struct observed_points seen;
    struct err err = ERR_INIT;
    const int neighbour = 1;
    assert_int_equal(neighbours_find_points(&seen, &scene.set, 0, &err), ST_OK);
    assert_int_equal(neighbours_depth_range(min_inverse_z, max_inverse_z, &guessed, &scene.set, 0, &neighbour, 1, &err),
                     ST_OK);
    neighbours_release_points(&seen);
    assert_true(*min_inverse_z > 0 && *min_inverse_z < *max_inverse_z && isfinite(*max_inverse_z));
    return guessed;
}

static void the_depth_range_contains_the_points(void **state)
{
    (void)state;
    for (int count = 8; count <= 200; count += 24) {
        double min_inverse_z, max_inverse_z;
        start();
        at(1, 0, 0);
        patch(count, ALL);
        assert_false(range_of(&min_inverse_z, &max_inverse_z));
        int outside = 0;
        for (int i = 0; i < count; i++) {
            const double d = 1 / scene.points[i].position.z;
            outside += d < min_inverse_z || d > max_inverse_z;
        }
        assert_int_equal(outside, 0);
        assert_true(1 / min_inverse_z < 12 && 1 / max_inverse_z > 8);
    }
}

static void outliers_do_not_widen_the_depth_range(void **state)
{
    (void)state;
    for (int count = 40; count <= 340; count += 100) {
        double min_inverse_z, max_inverse_z;
        start();
        at(1, 0, 0);
        patch(count, ALL);
        scene_point(&scene, vec3_make(0, 0, 0.01), 1);
        scene_point(&scene, vec3_make(0, 0, 1e6), 1);
        range_of(&min_inverse_z, &max_inverse_z);
        assert_true(1 / min_inverse_z < 12 && 1 / max_inverse_z > 8);
    }
}

static void points_at_one_depth_give_a_range_with_margins(void **state)
{
    (void)state;
    double min_inverse_z, max_inverse_z;
    start();
    at(1, 0, 0);
    for (int i = 0; i < 30; i++) scene_point(&scene, vec3_make(0.1 * i - 1.5, 0.1, 10), ALL);
    range_of(&min_inverse_z, &max_inverse_z);
    assert_true(min_inverse_z < 0.0975 && max_inverse_z > 0.1025);
}

/* A given model may have points that no view observes: they say where the scene is, but are no evidence. */
static void points_without_observations_give_the_depth_range(void **state)
{
    (void)state;
    double min_inverse_z, max_inverse_z;
    int n[MAX_NEIGHBOURS];
    struct err err;
    start();
    at(1, 0, 0);
    patch(100, 0);
    assert_false(range_of(&min_inverse_z, &max_inverse_z));
    assert_true(1 / min_inverse_z < 12 && 1 / min_inverse_z > 10 && 1 / max_inverse_z > 8);
    assert_int_equal(choose(n, 16, &err), 1);
}

static void without_points_the_depth_range_comes_from_the_baseline(void **state)
{
    (void)state;
    double min_inverse_z, max_inverse_z;
    start();
    at(0.5, 0, 0);
    assert_true(range_of(&min_inverse_z, &max_inverse_z));
    assert_near(160 * 0.5 * max_inverse_z, 40, 1e-9); /* a quarter of the picture */
    assert_true(160 * 0.5 * min_inverse_z < 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_and_large_angles_are_avoided),
        cmocka_unit_test(at_most_the_requested_number_is_chosen),
        cmocka_unit_test(the_second_neighbour_adds_a_direction),
        cmocka_unit_test(neighbours_cover_the_whole_view),
        cmocka_unit_test(similar_scales_are_preferred),
        cmocka_unit_test(a_view_that_shares_no_points_comes_last),
        cmocka_unit_test(without_points_the_nearest_pose_is_chosen),
        cmocka_unit_test(with_few_points_the_poses_that_show_most_are_chosen),
        cmocka_unit_test(a_view_without_neighbours_is_an_error),
        cmocka_unit_test(observed_points_are_in_front_with_small_reprojection_error),
        cmocka_unit_test(the_depth_range_contains_the_points),
        cmocka_unit_test(outliers_do_not_widen_the_depth_range),
        cmocka_unit_test(points_at_one_depth_give_a_range_with_margins),
        cmocka_unit_test(points_without_observations_give_the_depth_range),
        cmocka_unit_test(without_points_the_depth_range_comes_from_the_baseline),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
