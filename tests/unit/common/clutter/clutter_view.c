/* Which texels of a view's layers stand in front of the model. The model's depths are given, not traced. */
#include "tests/unit/scratch.h"

#include "common/clutter/clutter_view.h"

enum { W = 120, H = 60, EDGE = 60 };

struct given {
    struct layered_depth depth;
    struct view_ids ids;
};

/* One segment, 1/z = a u + c, before a model of which nothing is said yet; all its pixels count as clutter. */
static void give(struct given *g, double a, double c, double confidence)
{
    struct err err = ERR_INIT;
    *g = (struct given){0};
    assert_ok(layered_depth_init(&g->depth, W, H, &err), err);
    assert_ok(view_ids_init(&g->ids, W, H, &err), err);
    g->depth.segments = calloc(1, sizeof *g->depth.segments);
    assert_non_null(g->depth.segments);
    g->depth.segment_count = 1;
    g->depth.segments[0] =
        (struct depth_segment){.id = 1, .plane = {a, 0, c}, .sigma = 0.002, .confidence = confidence, .pixels = W * H};
    for (int i = 0; i < W * H; i++) {
        g->depth.interior.id[i] = 1;
        g->depth.interior.z[i] = (float)(1 / (a * (i % W + 0.5) + c));
        for (int k = 0; k < 4; k++) g->depth.interior.rgba[4 * i + k] = 1;
        g->ids.id[i] = 1;
        g->ids.clutter[i] = 1;
    }
}

static struct clutter_view make(struct given *g)
{
    struct clutter_view v;
    struct err err = ERR_INIT;
    assert_ok(clutter_view_make(&v, &g->depth, &g->ids, NULL, "view", &err), err);
    view_ids_release(&g->ids);
    return v;
}

static bool is_kept(const struct clutter_view *v, int x, int y)
{
    return (v->layers.texels[(y + 1) * v->layers.stride + x + 1].id[0] & ~TEXEL_JOINED) != 0;
}

/* From the wall at depth 4 the segment comes to half of that. */
static void a_segment_of_clutter_and_wall_keeps_its_clutter(void **state)
{
    (void)state;
    struct given g;
    give(&g, 0.25 / W, 0.25, 1);
    for (int i = 0; i < W * H; i++) g.ids.z[i] = 4;
    g.depth.segments[0].sigma = 0.05;
    struct clutter_view v = make(&g);
    assert_false(is_kept(&v, 0, H / 2));
    assert_true(is_kept(&v, W - 1, H / 2));
    for (int x = 1; x < W; x++) assert_true(is_kept(&v, x, H / 2) >= is_kept(&v, x - 1, H / 2));
    clutter_view_release(&v);
}

/* A wall at depth 2 ends at EDGE, and beyond it is one at 4; the view's depth goes on at 2. */
static void see_wall_with_opening(struct given *g, double confidence)
{
    give(g, 0, 0.5, confidence);
    for (int i = 0; i < W * H; i++) g->ids.z[i] = i % W < EDGE ? 2 : 4;
}

static void depth_that_continues_the_wall_over_an_opening_is_no_clutter(void **state)
{
    (void)state;
    struct given g;
    see_wall_with_opening(&g, 0.05);
    struct clutter_view v = make(&g);
    for (int x = 0; x < W; x++) assert_false(is_kept(&v, x, H / 2));
    clutter_view_release(&v);
}

static void far_from_the_wall_s_end_sure_depth_is_clutter(void **state)
{
    (void)state;
    struct given g;
    see_wall_with_opening(&g, 1);
    struct clutter_view v = make(&g);
    for (int x = 0; x < EDGE + 30; x++) assert_false(is_kept(&v, x, H / 2));
    for (int x = EDGE + 35; x < W; x++) assert_true(is_kept(&v, x, H / 2));
    clutter_view_release(&v);
}

static void what_is_before_the_wall_and_its_opening_is_clutter(void **state)
{
    (void)state;
    struct given g;
    see_wall_with_opening(&g, 1);
    for (int i = 0; i < W * H; i++) g.depth.interior.z[i] = 1.5f;
    g.depth.segments[0].plane[2] = 1 / 1.5;
    struct clutter_view v = make(&g);
    for (int x = 0; x < W; x++) assert_true(is_kept(&v, x, H / 2));
    assert_int_equal(v.sight[W / 2].shows, 255);
    assert_int_equal(v.sight[W / 2].sure, 255);
    assert_float_equal(v.sight[W / 2].nearest, 1 / 1.5, 1e-6);
    clutter_view_release(&v);
}

static void outdoors_nothing_is_clutter(void **state)
{
    (void)state;
    struct given g;
    give(&g, 0, 0.5, 1);
    struct clutter_view v = make(&g); /* the model is nowhere */
    for (int x = 0; x < W; x++) assert_false(is_kept(&v, x, H / 2));
    clutter_view_release(&v);
}

static void an_id_without_segment_is_refused(void **state)
{
    (void)state;
    struct given g;
    struct clutter_view v;
    struct err err = ERR_INIT;
    give(&g, 0, 0.5, 1);
    g.depth.boundary.id[7] = 9;
    assert_int_equal(clutter_view_make(&v, &g.depth, &g.ids, NULL, "sofa", &err), ST_DATA);
    assert_non_null(strstr(err.text, "sofa"));
    assert_non_null(strstr(err.text, "segment 9"));
    view_ids_release(&g.ids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_segment_of_clutter_and_wall_keeps_its_clutter),
        cmocka_unit_test(depth_that_continues_the_wall_over_an_opening_is_no_clutter),
        cmocka_unit_test(far_from_the_wall_s_end_sure_depth_is_clutter),
        cmocka_unit_test(what_is_before_the_wall_and_its_opening_is_clutter),
        cmocka_unit_test(outdoors_nothing_is_clutter),
        cmocka_unit_test(an_id_without_segment_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
