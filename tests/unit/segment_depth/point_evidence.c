/* point_evidence.c - the cost of planes through, near and off sparse points. */
#include "stages/segment_depth/point_evidence.h"

#include "tests/unit/segment_depth/scene.h"

enum { W = 64, H = 48, SEGMENTS = 48 };

static const double min_inverse_z = 0.1, max_inverse_z = 0.5, step = 0.01;
/* the test's own weights, large enough to matter: */
static const double weight = 0.3, near_weight = 0.05, far_weight = 0.04;

/* A uniform grey picture with square segments of 8 x 8 pixels; the upper half is brighter if `halves`. */
static void cut(struct segmentation *s, bool halves)
{
    struct image im;
    struct gamma_image g;
    struct err err = ERR_INIT;
    assert_int_equal(image_init(&im, W, H, 4, &err), ST_OK);
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 4; c++) im.data[4 * i + c] = c == 3 ? 1 : halves && i < W * H / 2 ? 0.6f : 0.1f;
    assert_int_equal(gamma_image_make(&g, &im, (struct tone){1, 0.5}, &err), ST_OK);
    *s = (struct segmentation){0};
    assert_int_equal(oversegment(s, &g, 64, 8, &err), ST_OK);
    assert_int_equal(s->count, SEGMENTS);
    gamma_image_release(&g);
    image_release(&im);
}

static void make(struct point_evidence *e, const struct segmentation *s, struct observed_point *points, int count)
{
    const struct segment_params params = {.points = weight, .nearest_points = near_weight, .far_bias = far_weight};
    const struct observed_points seen = {points, count};
    struct err err = ERR_INIT;
    if (point_evidence_make(e, s, &seen, min_inverse_z, max_inverse_z, step, &params, &err)) fail_msg("%s", err.text);
}

static double cost_of(const struct point_evidence *e, const struct segmentation *s, int segment, double inverse_z)
{
    const struct plane p = {0, 0, inverse_z};
    return point_evidence_cost(e, segment, p, s->segments[segment].cx, s->segments[segment].cy);
}

static double cheapest(const struct point_evidence *e, const struct segmentation *s, int segment)
{
    double best = min_inverse_z;
    for (double d = min_inverse_z; d <= max_inverse_z; d += 0.001)
        if (cost_of(e, s, segment, d) < cost_of(e, s, segment, best)) best = d;
    return best;
}

static void points_inside_a_segment_fix_its_depth(void **state)
{
    (void)state;
    struct segmentation s;
    struct point_evidence e;
    struct observed_point one = {0, 20.5, 12.5, 0.3}, many[9];
    cut(&s, false);
    const int segment = s.label[12 * W + 20];
    make(&e, &s, &one, 1);
    assert_near(cheapest(&e, &s, segment), 0.3, 0.002);
    const double held = cost_of(&e, &s, segment, 0.3 + 5 * step) - cost_of(&e, &s, segment, 0.3);
    assert_near(held, 0.5 * weight + near_weight + far_weight * 5 * step / (max_inverse_z - min_inverse_z), 1e-6);
    point_evidence_release(&e);
    for (int i = 0; i < 9; i++) many[i] = (struct observed_point){i, 17 + 0.7 * i, 10 + 0.5 * i, 0.3};
    many[4].inverse_z = 0.45; /* an outlier */
    make(&e, &s, many, 9);
    assert_near(cheapest(&e, &s, segment), 0.3, 0.002);
    assert_true(cost_of(&e, &s, segment, 0.3 + 5 * step) - cost_of(&e, &s, segment, 0.3) > 1.2 * held);
    /* a slanted plane through the points costs as little */
    for (int i = 0; i < 9; i++) many[i].inverse_z = 0.3 + 0.002 * (many[i].u - s.segments[segment].cx);
    point_evidence_release(&e);
    make(&e, &s, many, 9);
    const struct plane slanted = {0.002, 0, 0.3 - 0.002 * s.segments[segment].cx};
    assert_true(point_evidence_cost(&e, segment, slanted, s.segments[segment].cx, s.segments[segment].cy) <
                cost_of(&e, &s, segment, 0.3) - 0.02);
    point_evidence_release(&e);
    oversegment_release(&s);
}

static void a_segment_without_points_uses_points_nearby_in_place_and_colour(void **state)
{
    (void)state;
    struct segmentation s;
    struct point_evidence e;
    struct observed_point points[32];
    cut(&s, true);
    for (int i = 0; i < 32;
         i++) /* the bright half is near, with points on the left; the dark one far, with points on the right */
        points[i] = (struct observed_point){i, i % 8 + (i < 16 ? 20.5 : 56.5), (i / 8 * 11) + 2, i < 16 ? 0.4 : 0.15};
    make(&e, &s, points, 32);
    assert_near(cheapest(&e, &s, s.label[4 * W + 4]), 0.4, 0.02);
    assert_near(cheapest(&e, &s, s.label[20 * W + 60]), 0.4, 0.02); /* points of the dark half are closer */
    assert_near(cheapest(&e, &s, s.label[44 * W + 20]), 0.15, 0.02);
    point_evidence_release(&e);
    oversegment_release(&s);
}

static void the_farthest_of_several_nearby_depths_is_preferred(void **state)
{
    (void)state;
    struct segmentation s;
    struct point_evidence e;
    struct observed_point points[8];
    cut(&s, false);
    for (int i = 0; i < 8; i++) points[i] = (struct observed_point){i, 8.0 * i + 4, 4, i % 2 ? 0.45 : 0.2};
    make(&e, &s, points, 8);
    assert_near(cheapest(&e, &s, s.label[30 * W + 30]), 0.2, 0.002);
    point_evidence_release(&e);
    oversegment_release(&s);
}

static void without_points_far_depths_are_slightly_preferred(void **state)
{
    (void)state;
    struct segmentation s;
    struct point_evidence e;
    struct observed_point outside[] = {{0, -1, 5, 0.3}, {1, 5, 48, 0.3}, {2, 64, 5, 0.3}, {3, 1e9, -1e9, 0.3}};
    cut(&s, false);
    for (int count = 0; count <= 4; count += 4) { /* points outside the picture are ignored */
        make(&e, &s, outside, count);
        for (int i = 0; i < SEGMENTS; i++) {
            assert_near(cost_of(&e, &s, i, min_inverse_z), 0, 1e-12);
            assert_near(cost_of(&e, &s, i, max_inverse_z) - cost_of(&e, &s, i, min_inverse_z), far_weight, 1e-12);
            assert_near(cost_of(&e, &s, i, 9), cost_of(&e, &s, i, max_inverse_z), 1e-12);
        }
        point_evidence_release(&e);
        point_evidence_release(&e);
    }
    point_evidence_release(NULL);
    oversegment_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_inside_a_segment_fix_its_depth),
        cmocka_unit_test(a_segment_without_points_uses_points_nearby_in_place_and_colour),
        cmocka_unit_test(the_farthest_of_several_nearby_depths_is_preferred),
        cmocka_unit_test(without_points_far_depths_are_slightly_preferred),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
