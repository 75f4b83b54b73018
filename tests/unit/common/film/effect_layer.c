/* effect_layer.c - tests of the interpolation of boxes: place, size, fall-off and axes over time. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/film/effect_layer.h"

#define ROOT_HALF 0.70710678118654752

static void assert_close(double a, double b) { assert_true(fabs(a - b) < 1e-12); }

static void assert_vec3(struct vec3 a, struct vec3 b) { assert_close(vec3_length(vec3_sub(a, b)), 0); }

/* A box that moves, grows, softens and turns by a right angle about z, from 1 s to 3 s. */
static struct effect_box two_boxes[] = {
    {.time = 1, .low = {0, 0, 0}, .high = {2, 1, 1}, .falloff = 0},
    {.time = 3, .low = {4, -2, 0}, .high = {10, 1, 1}, .falloff = 0.5, .box_from_world = {3, 0, 0, 3}},
};

static void a_box_is_linear_between_its_keys_and_held_outside(void **state)
{
    (void)state;
    const struct effect_layer l = {.region = EFFECT_INSIDE, .boxes = two_boxes, .box_count = 2};
    struct effect_box b;
    for (int i = 0; i < 5; i++) { /* before, at the first, between, at the last, after */
        const double time = i < 4 ? i : 99, t = fmin(fmax((time - 1) / 2, 0), 1);
        effect_layer_box(&l, time, &b);
        assert_true(b.time == time);
        assert_vec3(b.low, vec3_make(4 * t, -2 * t, 0));
        assert_vec3(b.high, vec3_make(2 + 8 * t, 1, 1));
        assert_close(b.falloff, 0.5 * t);
        assert_close(b.box_from_world.w * sin(t * M_PI / 4), b.box_from_world.z * cos(t * M_PI / 4));
        assert_true(b.box_from_world.x == 0 && b.box_from_world.y == 0);
    }
}

static void axes_turn_by_the_shorter_way(void **state)
{
    (void)state;
    struct effect_box boxes[] = {{.high = {1, 1, 1}, .box_from_world = {1, 0, 0, 0}},
                                 {.time = 1, .high = {1, 1, 1}, .box_from_world = {-ROOT_HALF, 0, -ROOT_HALF, 0}}};
    const struct effect_layer l = {.region = EFFECT_INSIDE, .boxes = boxes, .box_count = 2};
    struct effect_box b;
    effect_layer_box(&l, 1.0 / 3, &b); /* 30 of 90 degrees about y */
    assert_close(b.box_from_world.w, cos(M_PI / 12));
    assert_close(b.box_from_world.y, sin(M_PI / 12));
    boxes[1].box_from_world = boxes[0].box_from_world = (struct quat){0};
    effect_layer_box(&l, 0.5, &b);
    assert_false(effect_box_is_turned(&b));
}

static void a_cubic_box_is_smooth_and_keeps_its_size(void **state)
{
    (void)state;
    const struct effect_layer two = {
        .region = EFFECT_INSIDE, .curve = EFFECT_CUBIC, .boxes = two_boxes, .box_count = 2};
    /* monotone curves of this box's corners would change places before 1 s: one is at rest there, one is not */
    struct effect_box boxes[] = {
        {.time = 0, .low = {0, 0, 0}, .high = {0, 1, 1}, .falloff = 1},
        {.time = 1, .low = {1, 0, 0}, .high = {1, 1, 1}, .falloff = 2, .box_from_world = {cos(0.1), 0, 0, sin(0.1)}},
        {.time = 2, .low = {1, 0, 0}, .high = {9, 1, 1}, .falloff = 4, .box_from_world = {cos(0.4), 0, 0, sin(0.4)}},
        {.time = 4, .low = {1, 0, 0}, .high = {9, 1, 1}, .falloff = 4, .box_from_world = {cos(0.4), 0, 0, sin(0.4)}},
    };
    const struct effect_layer l = {.region = EFFECT_INSIDE, .curve = EFFECT_CUBIC, .boxes = boxes, .box_count = 4};
    struct effect_box b, before;

    effect_layer_box(&two, 1.5, &b); /* a quarter of the time, level at both ends: 3 t^2 - 2 t^3 = 5/32 of the way */
    const double way = 5 / 32.0;
    assert_close(b.low.x, 4 * way);
    assert_close(b.high.x, 2 + 8 * way);
    assert_close(b.falloff, 0.5 * way);
    assert_close(atan2(b.box_from_world.z, b.box_from_world.w), way * M_PI / 4);

    for (int i = 1; i < 3; i++) { /* no jump of speed at a knot, of the fall-off and of the angle */
        double falloff[2], angle[2];
        for (int k = 0; k < 2; k++) {
            effect_layer_box(&l, i + (k ? 1e-6 : -1e-6), &b);
            falloff[k] = b.falloff;
            angle[k] = 2 * atan2(b.box_from_world.z, b.box_from_world.w);
        }
        assert_true(fabs(falloff[0] + falloff[1] - 2 * boxes[i].falloff) < 1e-10);
        assert_true(fabs(angle[0] + angle[1] - (i == 1 ? 0.4 : 1.6)) < 1e-10);
    }
    effect_layer_box(&l, 0, &before);
    for (int i = 1; i <= 400; i++) {
        effect_layer_box(&l, i / 100.0, &b);
        assert_true(b.low.x <= b.high.x && b.falloff >= before.falloff && b.falloff <= 4);
        assert_true(quat_angle(before.box_from_world, b.box_from_world) < 0.02);
        before = b;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_linear_between_its_keys_and_held_outside),
        cmocka_unit_test(axes_turn_by_the_shorter_way),
        cmocka_unit_test(a_cubic_box_is_smooth_and_keeps_its_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
