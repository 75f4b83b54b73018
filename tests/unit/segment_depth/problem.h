/* problem.h - an energy on photographs of a scene, for the tests of refine and expand. */
#ifndef REMODEL_TESTS_SEGMENT_PROBLEM_H
#define REMODEL_TESTS_SEGMENT_PROBLEM_H

#include "stages/segment_depth/plane_problem.h"
#include "stages/segment_depth/smooth.h"
#include "tests/unit/segment_depth/scene.h"

enum { W = 140, H = 100, FOCAL = 140, MAX_SEGMENTS = 600 };

struct bench {
    struct scene scene;
    struct gamma_image reference;
    struct segmentation segments;
    struct matcher matcher;
    struct point_evidence points;
    float *weights;
    struct segment_params params;
    struct plane_problem problem;
};

static struct bench b; /* large; zeroed by bench_empty() */

static inline void bench_empty(void)
{
    memset(&b, 0, sizeof b);
    b.params = (struct segment_params)SEGMENT_PARAMS_DEFAULT;
    b.params.best_neighbours = MAX_NEIGHBOURS;
}

/* Three views in a row, half a unit apart, the first in the middle. */
static inline void bench_views(void)
{
    for (int i = 0; i < 3; i++) scene_view(&b.scene, W, H, FOCAL, i == 1 ? 0.5 : i == 2 ? -0.5 : 0, 0, 0, 0);
}

/* The problem of the first view, without points; the scene has its surfaces and views. */
static inline void bench_make(double min_inverse_z, double max_inverse_z)
{
    struct image photo = {0};
    struct err err = ERR_INIT;
    const struct observed_points none = {0};
    const double step = 1 / (FOCAL * 0.5);
    struct tone tone = {1, 0.5};
    for (int k = 0; k < b.scene.set.view_count; k++) {
        struct gamma_image g = {0};
        assert_int_equal(scene_photo(&b.scene, k, &photo, &err), ST_OK);
        assert_int_equal(gamma_image_make(k ? &g : &b.reference, &photo, tone, &err), ST_OK);
        image_release(&photo);
        if (k) {
            assert_int_equal(matcher_add(&b.matcher, &b.scene.set, 0, k, &none, 0.25, &b.reference, &g, &err), ST_OK);
            gamma_image_release(&g);
            continue;
        }
        assert_int_equal(oversegment(&b.segments, &b.reference, 64, 8, &err), ST_OK);
        assert_int_equal(matcher_init(&b.matcher, &b.segments, &b.reference, &b.params, &err), ST_OK);
    }
    assert_int_equal(match_calibrate(&b.matcher, min_inverse_z, max_inverse_z, &err), ST_OK);
    assert_int_equal(
        point_evidence_make(&b.points, &b.segments, &none, min_inverse_z, max_inverse_z, step, &b.params, &err), ST_OK);
    b.weights = smooth_border_weights(&b.segments, 64);
    assert_non_null(b.weights);
    assert_true(b.segments.count < MAX_SEGMENTS);
    b.problem = (struct plane_problem){.view = &b.scene.views[0],
                                       .down = {0, 1, 0},
                                       .m = &b.matcher,
                                       .points = &b.points,
                                       .weights = b.weights,
                                       .params = &b.params,
                                       .slant = problem_slant(&b.params),
                                       .min_inverse_z = min_inverse_z,
                                       .max_inverse_z = max_inverse_z,
                                       .step = step};
}

static inline void bench_release(void)
{
    free(b.weights);
    point_evidence_release(&b.points);
    matcher_release(&b.matcher);
    oversegment_release(&b.segments);
    gamma_image_release(&b.reference);
}

/* 1/z of the first view. */
static inline double bench_truth(double u, double v)
{
    int surface;
    return 1 / scene_depth(&b.scene, &b.scene.views[0], u, v, &surface);
}

/* The energy of all segments and borders; `rough`: from every fourth pixel. */
static inline double bench_energy(const struct plane *planes, bool rough)
{
    struct plane_problem p = b.problem;
    double sum = 0;
    p.rough = rough;
    for (int i = 0; i < b.segments.count; i++) {
        sum += (double)problem_unary_cost(&p, i, planes[i], INFINITY);
        for (int t = b.segments.first_border[i]; t < b.segments.first_border[i + 1]; t++) {
            const int j = b.segments.borders[t].other;
            if (j > i) sum += problem_pairwise_cost(&p, i, t, planes[i], planes[j]);
        }
    }
    return sum;
}

#endif
