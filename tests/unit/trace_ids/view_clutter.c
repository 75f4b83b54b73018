/* Clutter of a wall 2 in front of the camera, by what the view's depth says. */
#include "tests/unit/trace_ids/room.h"
#include "tests/unit/whole_room.h"

enum { W = 60, H = 40 };

static struct seen see_wall(double z)
{
    const struct view v = view_at(vec3_make(0, 0, 0), 0, 0, W, H, 100);
    return see(&model, &v, z);
}

/* scale: model units per scene unit; a larger one makes the room smaller, and its furniture flatter */
static void judge_at_scale(struct seen *s, double scale)
{
    const struct trace_params params = TRACE_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    assert_ok(view_clutter_find(&s->ids, &s->trace, &s->depth, scale, &params, &err), err);
}

static void judge_again(struct seen *s) { judge_at_scale(s, 1); }

/* A rectangle of another segment. */
static void put(struct seen *s, int left, int top, int right, int bottom, uint32_t id, float z)
{
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++) {
            s->depth.interior.id[y * W + x] = id;
            s->depth.interior.z[y * W + x] = z;
        }
}

static void all_are(const struct seen *s, float wanted)
{
    for (int i = 0; i < W * H; i++) assert_float_equal(s->ids.clutter[i], wanted, 0);
}

static void the_wall_itself_is_clean(void **state)
{
    (void)state;
    struct seen s = see_wall(2);
    all_are(&s, 0);
    see_release(&s);
}

static void a_picture_on_the_wall_is_texture(void **state)
{
    (void)state;
    struct seen s = see_wall(1.96); /* 2 %: within the tolerance */
    all_are(&s, 0);
    see_release(&s);
}

static void depth_behind_the_model_is_no_clutter(void **state)
{
    (void)state;
    struct seen s = see_wall(50); /* the street behind a pane */
    all_are(&s, 0);
    see_release(&s);
}

static void furniture_is_clutter_with_its_rim(void **state)
{
    (void)state;
    const struct trace_params params = TRACE_PARAMS_DEFAULT;
    struct seen s = see_wall(2);
    put(&s, 20, 10, 40, 30, 2, 1.5f);
    judge_again(&s);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int dx = x < 20 ? 20 - x : x > 39 ? x - 39 : 0, dy = y < 10 ? 10 - y : y > 29 ? y - 29 : 0;
            const int away = dx > dy ? dx : dy;
            const bool by_a_side = (x >= 24 && x < 36) || (y >= 14 && y < 26); /* corners are rounded */
            if (away <= params.clutter_margin && by_a_side) assert_float_equal(s.ids.clutter[y * W + x], 1, 0);
            if (away > params.clutter_margin) assert_float_equal(s.ids.clutter[y * W + x], 0, 0);
        }
    see_release(&s);
}

static void the_boundary_layer_counts_too(void **state)
{
    (void)state;
    struct seen s = see_wall(2);
    for (int y = 10; y < 30; y++)
        for (int x = 20; x < 40; x++) {
            s.depth.boundary.id[y * W + x] = 2;
            s.depth.boundary.z[y * W + x] = 1.5f;
            s.depth.boundary.rgba[4 * (y * W + x) + 3] = 0.5f;
        }
    judge_again(&s);
    assert_float_equal(s.ids.clutter[20 * W + 30], 1, 0);
    assert_float_equal(s.ids.clutter[2 * W + 30], 0, 0);
    for (int i = 0; i < W * H; i++) s.depth.boundary.rgba[4 * i + 3] = 0.05f;
    judge_again(&s);
    assert_float_equal(s.ids.clutter[20 * W + 30], 0, 0);
    see_release(&s);
}

static void a_single_pixel_is_noise(void **state)
{
    (void)state;
    struct seen s = see_wall(2);
    put(&s, 30, 20, 31, 21, 2, 1.0f);
    judge_again(&s);
    assert_float_equal(s.ids.clutter[20 * W + 30], CLUTTER_UNSURE, 0);
    assert_float_equal(s.ids.clutter[20 * W + 31], 0, 0);
    see_release(&s);
}

static void little_confidence_counts_half(void **state)
{
    (void)state;
    struct seen s = see_wall(2);
    s.depth.segments[0].confidence = 0.05;
    judge_again(&s);
    all_are(&s, 0.25f);
    put(&s, 20, 10, 40, 30, 1, 1.0f);
    judge_again(&s);
    assert_float_equal(s.ids.clutter[20 * W + 30], 0.75f, 0);
    see_release(&s);
}

static void unknown_depth_is_unsure(void **state)
{
    (void)state;
    struct seen s = see_wall(2);
    put(&s, 0, 0, W, H, 1, 0);
    judge_again(&s);
    all_are(&s, CLUTTER_UNSURE);
    s.depth.segments[1].sigma = 1; /* agrees with anything */
    put(&s, 0, 0, W, H, 2, 2);
    judge_again(&s);
    all_are(&s, CLUTTER_UNSURE);
    see_release(&s);
}

static void pixels_that_the_view_lacks_are_clutter(void **state)
{
    (void)state;
    const struct trace_params params = TRACE_PARAMS_DEFAULT;
    struct seen s = see_wall(2);
    struct err err = ERR_INIT;
    put(&s, 0, 0, 10, H, 0, 0);
    judge_again(&s);
    assert_ok(view_jumps_find(&s.ids, &s.trace, &s.depth, &params, &err), err);
    assert_float_equal(s.ids.clutter[20 * W + 9], 1, 0);
    assert_float_equal(s.ids.clutter[20 * W + 9 + params.clutter_margin], 1, 0); /* and their rim */
    assert_float_equal(s.ids.clutter[20 * W + 10 + params.clutter_margin], 0, 0);
    assert_float_equal(s.ids.jump[20 * W + 9], 0, 0);
    assert_float_equal(s.ids.jump[20 * W + 10], 1, 0);
    assert_float_equal(s.ids.jump[20 * W + 15], 6, 0);
    see_release(&s);
}

/* Depth 2 % in front of the wall is within the tolerance. It shows the wall clean only if furniture would be farther
 * off. */
static void a_surface_is_clean_only_where_furniture_would_be_told_apart(void **state)
{
    (void)state;
    struct seen s = see_wall(0);
    const int middle = H / 2 * W + W / 2;
    for (int i = 0; i < W * H; i++) s.depth.interior.z[i] *= 0.98f;
    judge_at_scale(&s, 0.01);
    assert_true(s.ids.clutter[middle] < 0.01f);
    judge_at_scale(&s, 100);
    assert_true(fabsf(s.ids.clutter[middle] - CLUTTER_UNSURE) < 0.01f);
    see_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_wall_itself_is_clean),
        cmocka_unit_test(a_picture_on_the_wall_is_texture),
        cmocka_unit_test(depth_behind_the_model_is_no_clutter),
        cmocka_unit_test(furniture_is_clutter_with_its_rim),
        cmocka_unit_test(the_boundary_layer_counts_too),
        cmocka_unit_test(a_single_pixel_is_noise),
        cmocka_unit_test(little_confidence_counts_half),
        cmocka_unit_test(unknown_depth_is_unsure),
        cmocka_unit_test(pixels_that_the_view_lacks_are_clutter),
        cmocka_unit_test(a_surface_is_clean_only_where_furniture_would_be_told_apart),
    };
    return cmocka_run_group_tests(tests, make_model, release_model);
}
