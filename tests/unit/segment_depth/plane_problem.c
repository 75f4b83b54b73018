/* plane_problem.c - the energy's terms are those of the header, and its pairwise terms are a metric. */
#include "stages/segment_depth/plane_problem.h"

#include "tests/unit/segment_depth/problem.h"

#include "common/base/parallel.h"

static void start(void)
{
    bench_empty();
    scene_wall(&b.scene, 0, 0, 4, 6, 6, 0.3);
    bench_views();
    bench_make(0.15, 0.45);
}

/* Random planes: similar, distant, slanted, equal. */
static struct plane draw(int i, int k)
{
    const double size = b.problem.step * pow(10, 3 * scene_hash(i, k, 1) - 1);
    struct plane p = {0, 0, 0.3 + size * (2 * scene_hash(i, k, 2) - 1)};
    if (i % 3) p.a = size / W * (2 * scene_hash(i, k, 3) - 1);
    if (i % 3) p.b = size / H * (2 * scene_hash(i, k, 4) - 1);
    return k > 0 && i % 7 == 0 ? draw(i, k - 1) : p;
}

static int twin(int segment, int border)
{
    const int j = b.segments.borders[border].other;
    for (int t = b.segments.first_border[j]; t < b.segments.first_border[j + 1]; t++)
        if (b.segments.borders[t].other == segment) return t;
    fail_msg("segment %d touches %d but not the other way round", segment, j);
    return -1;
}

static void the_pairwise_term_is_a_metric(void **state)
{
    (void)state;
    int truncated = 0, count = 0;
    start();
    for (int i = 0; i < b.segments.count; i++)
        for (int t = b.segments.first_border[i]; t < b.segments.first_border[i + 1]; t++, count++) {
            const int j = b.segments.borders[t].other, back = twin(i, t);
            const struct plane p = draw(count, 0), q = draw(count, 1), r = draw(count, 2);
            const double pq = problem_pairwise_cost(&b.problem, i, t, p, q),
                         qr = problem_pairwise_cost(&b.problem, i, t, q, r);
            const double slant = 2 * b.params.slant * b.segments.borders[t].length / (2 * sqrt(64));
            const double max_cost = b.params.smoothness * (double)b.weights[t] + slant;
            assert_near(problem_pairwise_cost(&b.problem, i, t, p, p), 0, 0);
            assert_true(pq <= problem_pairwise_bound(&b.problem, t));
            assert_true(pq >= 0 && pq <= max_cost);
            assert_near(problem_pairwise_cost(&b.problem, i, t, q, p), pq, 1e-15);
            assert_near(problem_pairwise_cost(&b.problem, j, back, q, p), pq,
                        1e-12); /* from the other side of the border */
            assert_true(problem_pairwise_cost(&b.problem, i, t, p, r) <= pq + qr + 1e-12);
            truncated += pq >= max_cost - slant - 1e-12;
        }
    assert_true(count > 500 && truncated > 20 && truncated < count / 2);
    bench_release();
}

/* Constant planes n steps apart cost min(n / jump, 1) of the weight. */
static void the_pairwise_term_is_linear_up_to_the_jump(void **state)
{
    (void)state;
    start();
    b.params.jump = 8;
    for (int t = 0; t < b.segments.first_border[1]; t++)
        for (int n = -20; n <= 20; n++) {
            const struct plane p = {0, 0, 0.3}, q = {0, 0, 0.3 + n * b.problem.step};
            assert_near(problem_pairwise_cost(&b.problem, 0, t, p, q),
                        b.params.smoothness * (double)b.weights[t] * fmin(abs(n) / 8.0, 1), 1e-9);
        }
    bench_release();
}

/* A slanted plane pays for its borders with other planes, by their length; nothing for those within it. */
static void a_slanted_plane_pays_along_its_outline_only(void **state)
{
    (void)state;
    start();
    for (int t = 0; t < b.segments.first_border[b.segments.count]; t += 3) {
        const struct border *border = &b.segments.borders[t];
        const double u = (double)border->u, v = (double)border->v, slope = 1e-9; /* the gap itself costs nothing */
        const struct plane flat = {0, 0, 0.3}, up = {slope, 0, 0.3 - slope * u}, down = {0, slope, 0.3 - slope * v};
        const double share = border->length / (2 * sqrt(64));
        int i = 0;
        while (b.segments.first_border[i + 1] <= t) i++;
        assert_near(problem_pairwise_cost(&b.problem, i, t, up, up), 0, 0);
        assert_near(problem_pairwise_cost(&b.problem, i, t, up, flat), share * b.params.slant, 1e-5);
        assert_near(problem_pairwise_cost(&b.problem, i, t, down, up), share * 2 * b.params.slant, 1e-5);
    }
    bench_release();
}

/* Two segments on one slanted plane cost nothing; constant planes at those depths, or a fold at the border, do. */
static void a_slanted_surface_is_free_but_a_fold_costs(void **state)
{
    (void)state;
    start();
    for (int i = 0; i < b.segments.count; i += 5)
        for (int t = b.segments.first_border[i]; t < b.segments.first_border[i + 1]; t++) {
            const struct segment *g = &b.segments.segments[i], *h = &b.segments.segments[b.segments.borders[t].other];
            const double u = (double)b.segments.borders[t].u, v = (double)b.segments.borders[t].v;
            const double a = b.problem.step / 4 * (g->cx > h->cx ? 1 : -1), across = fabs(g->cx - h->cx);
            const struct plane slanted = {a, 0, 0.3 - a * u},
                               folded = {-a, 0, 0.3 + a * u}; /* they meet at the border */
            assert_near(problem_pairwise_cost(&b.problem, i, t, slanted, slanted), 0, 0);
            if (across < 3) continue;
            assert_true(problem_pairwise_cost(&b.problem, i, t, slanted, folded) > 0);
            assert_true(problem_pairwise_cost(&b.problem, i, t, (struct plane){0, 0, plane_at(slanted, g->cx, g->cy)},
                                              (struct plane){0, 0, plane_at(slanted, h->cx, h->cy)}) > 0);
            assert_near(plane_at(slanted, u, v), plane_at(folded, u, v), 1e-12);
        }
    bench_release();
}

/* At the centroid, and with wider limits at the corners of the bounding box with its margin. */
static void a_plane_outside_the_depth_range_is_forbidden(void **state)
{
    (void)state;
    const double low = PLANE_MIN_FACTOR * 0.15, high = PLANE_MAX_FACTOR * 0.45;
    int never = 0, count = 0;
    start();
    for (int i = 0; i < b.segments.count; i++)
        for (int k = 0; k < 12; k++, count++) {
            const struct segment *g = &b.segments.segments[i];
            struct plane p = {0.01 * (2 * scene_hash(i, k, 0) - 1), 0.01 * (2 * scene_hash(i, k, 1) - 1), 0};
            p.c = 0.5 * scene_hash(i, k, 2) + 0.05 - p.a * g->cx - p.b * g->cy;
            const double middle = plane_at(p, g->cx, g->cy), slack = 0.02 * (0.45 - 0.15);
            bool leaves = !(middle >= 0.15 - slack && middle <= 0.45 + slack);
            for (int y = g->y0 - 3; y <= g->y1 + 4; y++)
                for (int x = g->x0 - 3; x <= g->x1 + 4; x++)
                    leaves = leaves || !(plane_at(p, x, y) >= low && plane_at(p, x, y) <= high);
            const float cost = problem_unary_cost(&b.problem, i, p, INFINITY);
            assert_true(leaves ? cost >= PLANE_FORBIDDEN : cost < PLANE_FORBIDDEN / 100);
            never += leaves;
        }
    assert_true(never > count / 5 && never < 4 * count / 5);
    const struct plane no[] = {{NAN, 0, 0.3}, {0, INFINITY, 0.3}, {0, 0, NAN}, {0, 0, -INFINITY}, {1e300, -1e300, 0.3}};
    for (int k = 0; k < 5; k++) assert_true(problem_unary_cost(&b.problem, 7, no[k], INFINITY) >= PLANE_FORBIDDEN);
    bench_release();
}

/* size (match + points), slanted or not. */
static void the_unary_term_is_the_sum_of_its_parts(void **state)
{
    (void)state;
    start();
    b.params.slant = 0.125;
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        const struct plane flat = {0, 0, bench_truth(g->cx, g->cy)},
                           slanted = {1e-4, -1e-4, flat.c - 1e-4 * (g->cx - g->cy)};
        for (int rough = 0; rough < 2; rough++)
            for (int k = 0; k < 2; k++) {
                const struct plane p = k ? slanted : flat;
                const float match = rough ? match_cost_rough(&b.matcher, i, p, 0) : match_cost(&b.matcher, i, p, 0);
                const double points = point_evidence_cost(&b.points, i, p, g->cx, g->cy);
                b.problem.rough = rough;
                assert_near(problem_unary_cost(&b.problem, i, p, INFINITY), g->pixels / 64.0 * ((double)match + points),
                            1e-5);
            }
    }
    bench_release();
}

/* Below by more than a tenth of the inverse depth; the ground alone may be much nearer than the range of depths. */
static void what_lies_below_the_ground_costs_more(void **state)
{
    (void)state;
    struct scene_planes scene = {.count = 1, .has_ground = true};
    int below = 0, count = 0;
    start();
    scene_planes_set(&scene, 0, plane_of_normal(b.problem.view, vec3_make(0, 1 / 1.2, 0)));
    const struct plane ground = scene.planes[0];
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        const double at = plane_at(ground, g->cx, g->cy);
        for (int k = 0; k < 5; k++, count++) {
            const struct plane p = {0, 0, 0.18 + 0.06 * k};
            b.problem.scene = NULL;
            const float alone = problem_unary_cost(&b.problem, i, p, INFINITY);
            b.problem.scene = &scene;
            const bool is_below = p.c < 0.9 * at;
            assert_near(problem_unary_cost(&b.problem, i, p, INFINITY), alone + (is_below ? 0.3 * g->pixels / 64 : 0),
                        1e-4);
            below += is_below;
        }
        if (at > 0.6 && at < 3)
            assert_true(problem_unary_cost(&b.problem, i, ground, INFINITY) < PLANE_FORBIDDEN / 100);
        scene.has_ground = false;
        if (at > 2) assert_true(problem_unary_cost(&b.problem, i, ground, INFINITY) >= PLANE_FORBIDDEN);
        scene.voted_ground = 1; /* votes found the same plane: it reaches as near */
        if (at > 0.6 && at < 3)
            assert_true(problem_unary_cost(&b.problem, i, ground, INFINITY) < PLANE_FORBIDDEN / 100);
        scene.voted_ground = 0;
        scene.has_ground = true;
    }
    assert_true(below > count / 40 && below < count / 2);
    bench_release();
}

/* The limit never changes costs up to it, and forbids planes that certainly cost more. */
static void planes_above_the_limit_are_not_matched(void **state)
{
    (void)state;
    enum { PLANES = 60 };
    start();
    const double step = (0.45 - 0.15) / (PLANES - 1);
    float *cost = malloc(sizeof *cost * PLANES * (size_t)b.segments.count);
    int given_up = 0, wrong = 0, count = 0;
    assert_non_null(cost);
    for (int i = 0; i < b.segments.count; i++)
        for (int k = 0; k < PLANES; k++)
            cost[i * PLANES + k] = match_cost(&b.matcher, i, (struct plane){0, 0, 0.15 + k * step}, 0);
    for (int swept = 0; swept < 2; swept++) {
        struct plane_problem p = b.problem;
        p.step = step;
        p.cost = swept ? cost : NULL;
        p.planes = PLANES;
        for (int i = 0; i < b.segments.count; i++)
            for (int k = 0; k < 8; k++, count++) {
                const struct segment *g = &b.segments.segments[i];
                const double slope = 2e-3 * (2 * scene_hash(i, k, 1) - 1);
                const struct plane plane = {slope, 0, 0.16 + 0.28 * scene_hash(i, k, 0) - slope * g->cx};
                const float full = problem_unary_cost(&p, i, plane, INFINITY);
                const float max_cost = (float)(2 * scene_hash(i, k, 2) - 0.5);
                const float screened = problem_unary_cost(&p, i, plane, max_cost);
                assert_true(screened >= PLANE_FORBIDDEN || screened == full);
                if (!swept) assert_true(screened == full || full > max_cost); /* an exact bound */
                given_up += swept && screened > full;
                wrong += swept && screened > full && full <= max_cost;
            }
    }
    assert_true(given_up > count / 20);
    assert_true(wrong < given_up / 100);
    free(cost);
    bench_release();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_pairwise_term_is_a_metric),
        cmocka_unit_test(the_pairwise_term_is_linear_up_to_the_jump),
        cmocka_unit_test(a_slanted_plane_pays_along_its_outline_only),
        cmocka_unit_test(a_slanted_surface_is_free_but_a_fold_costs),
        cmocka_unit_test(a_plane_outside_the_depth_range_is_forbidden),
        cmocka_unit_test(the_unary_term_is_the_sum_of_its_parts),
        cmocka_unit_test(what_lies_below_the_ground_costs_more),
        cmocka_unit_test(planes_above_the_limit_are_not_matched),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
