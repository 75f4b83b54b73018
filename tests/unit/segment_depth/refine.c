/* refine.c - planes that start a step off, or facing the camera, on photographs of slanted walls. */
#include "stages/segment_depth/refine.h"

#include "stages/segment_depth/smooth.h"
#include "tests/unit/segment_depth/scene.h"

#include "common/parallel.h"

enum { W = 140, H = 100, FOCAL = 140, MOST_SEGMENTS = 600 };

struct bench {
    struct scene scene;
    struct gamma_image reference;
    struct segmentation segments;
    struct matcher matcher;
    struct point_evidence points;
    float *weights;
    struct segment_params params;
    double least, most, step;
};

static struct bench b; /* large; zeroed by start() */

/* Three views in a row of a wall that leans, blank if `contrast` is 0; no points. */
static void start(double lean, double contrast)
{
    struct image photo = {0};
    struct err err = ERR_INIT;
    const struct seen_points none = {0};
    memset(&b, 0, sizeof b);
    b.params = (struct segment_params)SEGMENT_PARAMS_DEFAULT;
    scene_wall(&b.scene, 0, 0, 4, 6, 6, lean)->contrast = contrast;
    for (int i = 0; i < 3; i++) scene_view(&b.scene, W, H, FOCAL, i == 1 ? 0.5 : i == 2 ? -0.5 : 0, 0, 0, 0);
    b.least = 0.15;
    b.most = 0.45;
    b.step = 1 / (FOCAL * 0.5);
    for (int k = 0; k < 3; k++) {
        struct gamma_image g = {0};
        assert_int_equal(scene_photo(&b.scene, k, &photo, &err), ST_OK);
        assert_int_equal(gamma_image_make(k ? &g : &b.reference, &photo, 1, &err), ST_OK);
        image_release(&photo);
        if (k) {
            assert_int_equal(matcher_add(&b.matcher, &b.scene.set, 0, k, &none, 0.25, &b.reference, &g, &err), ST_OK);
            gamma_image_release(&g);
            continue;
        }
        assert_int_equal(oversegment(&b.segments, &b.reference, 64, 8, &err), ST_OK);
        assert_int_equal(matcher_init(&b.matcher, &b.segments, &b.reference, &err), ST_OK);
    }
    assert_int_equal(point_evidence_make(&b.points, &b.segments, &none, b.least, b.most, b.step, &b.params, &err),
                     ST_OK);
    b.weights = touch_weights(&b.segments, 64);
    assert_non_null(b.weights);
    assert_true(b.segments.count < MOST_SEGMENTS);
}

static void finish(void)
{
    free(b.weights);
    point_evidence_release(&b.points);
    matcher_release(&b.matcher);
    segmentation_release(&b.segments);
    gamma_image_release(&b.reference);
}

static double truth(double u, double v)
{
    int surface;
    return 1 / scene_depth(&b.scene, &b.scene.views[0], u, v, &surface);
}

/* As a sweep leaves them: constant, and up to a step off. */
static void start_planes(struct plane *planes)
{
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        planes[i] = (struct plane){0, 0, truth(g->cx, g->cy) + b.step * (2 * scene_hash(i, 0, 0) - 1)};
    }
}

static void refine(struct plane *planes)
{
    struct err err = ERR_INIT;
    if (refine_planes(planes, &b.matcher, &b.points, b.weights, &b.params, &err)) fail_msg("%s", err.text);
}

/* Mean error in steps at the segments' centroids, of those away from the frame. */
static double mean_error(const struct plane *planes)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (g->cx < 25 || g->cx > W - 25) continue;
        sum += fabs(plane_at(planes[i], g->cx, g->cy) - truth(g->cx, g->cy)) / b.step;
        count++;
    }
    return sum / count;
}

static void a_leaning_wall_is_found_to_a_fraction_of_a_step(void **state)
{
    (void)state;
    static struct plane planes[MOST_SEGMENTS];
    for (int free_slant = 0; free_slant < 2; free_slant++) {
        double mean_a = 0, mean_b = 0;
        start(0.4, 0.8);
        if (free_slant) b.params.slant = 0;
        start_planes(planes);
        assert_true(mean_error(planes) > 0.4);
        refine(planes);
        assert_true(mean_error(planes) < 0.05);
        const double a = truth(70.5, 50) - truth(69.5, 50);
        for (int i = 0; i < b.segments.count; i++) {
            mean_a += planes[i].a / b.segments.count;
            mean_b += planes[i].b / b.segments.count;
        }
        assert_true(mean_a / a > (free_slant ? 0.85 : 0.4) &&
                    mean_a / a < 1.1); /* leaning is not worth its price to all */
        assert_near(mean_b / a, 0, 0.1);
        finish();
    }
}

static void a_facing_wall_stays_constant(void **state)
{
    (void)state;
    static struct plane planes[MOST_SEGMENTS];
    int constant = 0;
    start(0, 0.8);
    start_planes(planes);
    refine(planes);
    assert_true(mean_error(planes) < 0.05);
    for (int i = 0; i < b.segments.count; i++) constant += fabs(planes[i].a) + fabs(planes[i].b) < 0.02 * b.step;
    assert_true(constant > 0.8 * b.segments.count);
    finish();
}

static void no_pass_changes_nothing(void **state)
{
    (void)state;
    static struct plane planes[MOST_SEGMENTS], before[MOST_SEGMENTS];
    start(0.4, 0.8);
    b.params.passes = 0;
    start_planes(planes);
    memcpy(before, planes, sizeof planes);
    refine(planes);
    assert_memory_equal(planes, before, sizeof planes);
    finish();
}

static void planes_keep_to_the_depths_even_on_a_blank_wall(void **state)
{
    (void)state;
    static struct plane planes[MOST_SEGMENTS];
    start(0.4, 0);
    b.params.passes = 12;
    b.params.slant = 0;
    for (int i = 0; i < b.segments.count; i++) planes[i] = (struct plane){0, 0, i % 2 ? b.least : b.most};
    refine(planes);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        for (int k = 0; k < 4; k++) {
            const double d = plane_at(planes[i], k & 1 ? g->x1 + 1 : g->x0, k & 2 ? g->y1 + 1 : g->y0);
            assert_true(d >= 0.7 * b.least - 1e-12 && d <= 1.3 * b.most + 1e-12);
        }
    }
    finish();
}

static void threads_do_not_change_a_plane(void **state)
{
    (void)state;
    static struct plane planes[2][MOST_SEGMENTS];
    start(0.4, 0.8);
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        start_planes(planes[k]);
        refine(planes[k]);
    }
    parallel_set_threads(0);
    assert_memory_equal(planes[0], planes[1], (size_t)b.segments.count * sizeof planes[0][0]);
    finish();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_leaning_wall_is_found_to_a_fraction_of_a_step),
        cmocka_unit_test(a_facing_wall_stays_constant),
        cmocka_unit_test(no_pass_changes_nothing),
        cmocka_unit_test(planes_keep_to_the_depths_even_on_a_blank_wall),
        cmocka_unit_test(threads_do_not_change_a_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
