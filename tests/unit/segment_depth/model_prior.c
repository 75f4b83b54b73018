/* model_prior.c - what a view is expected to see of a room that is modelled, and what may stand before it. */
#include "stages/segment_depth/model_prior.h"

#include "common/math/numbers.h"
#include "stages/segment_depth/before_model.h"
#include "stages/segment_depth/smooth.h"
#include "tests/unit/box_solids.h"

enum { W = 80, H = 60, CELL = 10, ACROSS = W / CELL, COUNT = ACROSS * (H / CELL), VIEWS = 3 };
enum { FIRST = 2 * ACROSS + 3, SECOND = FIRST + 1 }; /* two segments in the middle */

static const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"glass/w", "pane", {-1, -1, 1.9}, {0, 1, 1.95}, false}};
static const struct model_axes same_frame = {.rotation = {1, 0, 0, 0}, .scale = 1};
static const double thing = 1.25; /* depth of what stands before the wall, which is 2 away */

static struct segment segments[COUNT];
static int pixel[W * H], label[W * H];
static struct border borders[COUNT * 4];
static int first_border[COUNT + 1];
static struct view views[VIEWS];
static double confidence_before;  /* of the neighbours' depth */
static int thing_ends;            /* the neighbours show the thing left of this column, and the wall from there on */
static struct plane found[COUNT]; /* planes of furniture_sweep_find() */

/* A grid of square segments. */
static struct segmentation grid(void)
{
    int count = 0;
    for (int i = 0; i < COUNT; i++) {
        const int x = i % ACROSS, y = i / ACROSS;
        segments[i] = (struct segment){.first = i * CELL * CELL,
                                       .pixels = CELL * CELL,
                                       .cx = (x + 0.5) * CELL,
                                       .cy = (y + 0.5) * CELL,
                                       .x0 = x * CELL,
                                       .y0 = y * CELL,
                                       .x1 = x * CELL + CELL - 1,
                                       .y1 = y * CELL + CELL - 1};
        for (int k = 0; k < CELL * CELL; k++) {
            pixel[i * CELL * CELL + k] = (y * CELL + k / CELL) * W + x * CELL + k % CELL;
            label[pixel[i * CELL * CELL + k]] = i;
        }
        first_border[i] = count;
        if (x) borders[count++] = (struct border){i - 1, CELL, 0, (float)(x * CELL), (float)segments[i].cy, 0};
        if (x < ACROSS - 1)
            borders[count++] = (struct border){i + 1, CELL, 0, (float)(x * CELL + CELL), (float)segments[i].cy, 0};
    }
    first_border[COUNT] = count;
    return (struct segmentation){.width = W,
                                 .height = H,
                                 .count = COUNT,
                                 .label = label,
                                 .pixel = pixel,
                                 .segments = segments,
                                 .first_border = first_border,
                                 .borders = borders};
}

/* What the first view is expected to see. */
static void expect_of(struct plane_prior *prior, const struct box *list, int box_count, const struct segmentation *s)
{
    struct model_rays model = make_rays(list, box_count);
    struct view_trace trace = {0};
    struct err err = ERR_INIT;
    assert_ok(view_trace(&trace, &model, &same_frame, &views[0], &err), err);
    assert_ok(model_prior_make(prior, &trace, 1, &views[0], s, &err), err);
    view_trace_release(&trace);
    model_rays_release(&model);
}

static void expect(struct plane_prior *prior, int box_count, const struct segmentation *s)
{
    views[0] = view_at(vec3_make(0, 0, 0), 0, 0, W, H, 40);
    expect_of(prior, boxes, box_count, s);
}

/* Of the room of side 4 about the camera. */
static double truth(double u, double v) { return fmax(0.5, fmax(fabs(u - W / 2.0), fabs(v - H / 2.0)) / 40 / 2); }

static void segments_are_expected_on_the_faces_that_they_show(void **state)
{
    (void)state;
    const struct segmentation s = grid();
    struct plane_prior prior;
    expect(&prior, 2, &s);
    assert_int_equal(prior.count, 1); /* the wall ahead fills the view */
    for (int i = 0; i < COUNT; i++) {
        assert_int_equal(prior.expected[i], 0);
        assert_true(fabs(plane_at(prior.planes[0], segments[i].cx, segments[i].cy) -
                         truth(segments[i].cx, segments[i].cy)) < 1e-9);
    }
    plane_prior_release(&prior);
}

static void nothing_is_expected_in_an_opening(void **state)
{
    (void)state;
    const struct segmentation s = grid();
    struct plane_prior prior;
    int open = 0;
    expect(&prior, 3, &s);
    for (int i = 0; i < COUNT; i++) open += prior.expected[i] < 0;
    assert_true(open >= 6 && open <= 12); /* the pane covers 21 x 42 pixels */
    plane_prior_release(&prior);
}

/* The depth at which a segment is expected; 0: none. */
static double depth_of(const struct plane_prior *prior, int segment)
{
    const int k = prior->expected[segment];
    return k < 0 ? 0 : 1 / plane_at(prior->planes[k], segments[segment].cx, segments[segment].cy);
}

/* Two walls that meet, 2.5 high, no room. The camera looks along one of them, and then away. */
static void walls_without_a_room_have_a_floor_and_a_ceiling(void **state)
{
    (void)state;
    static const struct box walls[] = {{"walls", "ahead", {-3, 3, 0}, {3, 3.2, 2.5}, false},
                                       {"more", "left", {-3.2, -3, 0}, {-3, 3, 2.5}, false}};
    const struct segmentation s = grid();
    const struct vec3 eye = {0.5, 0, 1.2};
    struct plane_prior prior;
    for (int away = 0; away < 2; away++) {
        views[0] = view_at(eye, 0, PI / 2, W, H, 40);
        if (away) /* turned about the vertical */
            views[0].cam_from_world = (struct mat3){{{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}}};
        views[0].translation = vec3_scale(mat3_apply(views[0].cam_from_world, eye), -1);
        expect_of(&prior, walls, 2, &s);
        for (int i = 3; i < COUNT; i += ACROSS) {
            const double slope = (segments[i].cy - H / 2.0) / 40, level = slope < -0.5  ? (2.5 - eye.z) / -slope
                                                                          : slope > 0.5 ? eye.z / slope
                                                                          : away        ? 0
                                                                                        : 3;
            assert_true(fabs(depth_of(&prior, i) - level) < 1e-9);
        }
        plane_prior_release(&prior);
    }
}

static void a_sure_segment_gains_less(void **state)
{
    (void)state;
    static double sure[COUNT];
    const struct segmentation s = grid();
    struct plane_prior prior;
    expect(&prior, 2, &s);
    sure[FIRST] = 1;
    model_prior_weigh(&prior, 0.1, sure, &s);
    assert_true(prior.gain[SECOND] > 0.09f && prior.gain[SECOND] < 0.11f);
    assert_true(prior.gain[FIRST] < 0.5f * prior.gain[SECOND]);
    plane_prior_release(&prior);
}

static enum status read_thing(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    (void)ctx;
    (void)view_idx;
    *d = (struct layered_depth){.width = W, .height = H, .segment_count = 2};
    d->interior.id = calloc((size_t)W * H, sizeof *d->interior.id);
    d->segments = calloc(2, sizeof *d->segments);
    if (!d->interior.id || !d->segments) return err_nomem(err, "a depth map", 1);
    for (int i = 0; i < W * H; i++) d->interior.id[i] = i % W < thing_ends ? 1 : 2;
    d->segments[0] = (struct depth_segment){1, W * H, {0, 0, 1 / thing}, 0.01, confidence_before, 0};
    d->segments[1] = (struct depth_segment){2, W * H, {0, 0, 1 / 2.0}, 0.01, confidence_before, 0};
    return ST_OK;
}

/* All lies on the wall but two adjacent segments; `sure` is the confidence of the first. The neighbours' depth is that
 * of the thing up to column `ends`. Returns how many of the two stay; the second does not without the first. */
static int settle(double sure, double neighbours_sure, int ends)
{
    const struct segmentation s = grid();
    const struct camera_set set = {.views = views, .view_count = VIEWS};
    const int neighbours[] = {1, 2};
    const struct previous_depth_source source = {read_thing, NULL};
    struct plane planes[COUNT];
    double confidence[COUNT] = {0};
    bool inherited[COUNT] = {false};
    struct scene_planes scene = {.count = 1, .known = 1};
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    float *weights = smooth_border_weights(&s, CELL * CELL);
    struct matcher m = {.segments = &s};
    struct cross_view cross = {0};
    struct plane_prior prior;
    struct err err = ERR_INIT;
    expect(&prior, 2, &s);
    views[1] = view_at(vec3_make(0.1, 0, 0), 0, 0, W, H, 40);
    views[2] = view_at(vec3_make(-0.1, 0, 0), 0, 0, W, H, 40);
    confidence_before = neighbours_sure;
    thing_ends = ends;
    scene_planes_set(&scene, 0, prior.planes[0]);
    assert_ok(cross_view_make(&cross, &s, &set, 0, neighbours, 2, 0.02, &source, &err), err);
    const struct plane_problem p = {.m = &m,
                                    .cross = &cross,
                                    .prior = &prior,
                                    .scene = &scene,
                                    .weights = weights,
                                    .params = &params,
                                    .step = 0.02};
    for (int i = 0; i < COUNT; i++) planes[i] = prior.planes[0];
    planes[FIRST] = planes[SECOND] = (struct plane){0, 0, 1 / thing};
    planes[0].c *= 1.01; /* a little off: the photos may know better */
    confidence[FIRST] = sure;
    const double slightly_off = planes[0].c;
    assert_ok(before_model_settle(planes, inherited, confidence, found, &p, &err), err);
    assert_true(planes[0].c == slightly_off && !inherited[0]);
    int stay = 0;
    for (int i = FIRST; i <= SECOND; i++) {
        const bool on_the_wall = memcmp(&planes[i], &prior.planes[0], sizeof planes[i]) == 0;
        assert_true(on_the_wall == inherited[i]);
        stay += !on_the_wall;
        assert_true(on_the_wall || i == FIRST || stay == 2);
    }
    free(weights);
    cross_view_release(&cross);
    plane_prior_release(&prior);
    return stay;
}

static void what_no_other_view_confirms_is_the_face_behind_it(void **state)
{
    (void)state;
    assert_int_equal(settle(0.9, 0.05, W), 0);
    assert_int_equal(settle(0, 0.9, W), 0);
}

/* Other pictures matched it there, although the other views' depth does not show it. */
static void a_thing_that_other_pictures_match_stays(void **state)
{
    (void)state;
    found[FIRST] = found[SECOND] = (struct plane){0, 0, 1 / thing};
    assert_int_equal(settle(0.9, 0.05, W), 2);
    found[FIRST] = found[SECOND] = (struct plane){0, 0, 1 / (0.9 * thing)}; /* it left that plane since */
    assert_int_equal(settle(0.9, 0.05, W), 0);
    memset(found, 0, sizeof found);
}

/* The second segment has no confidence of its own. */
static void a_thing_that_views_agree_on_stays_with_all_its_parts(void **state)
{
    (void)state;
    assert_int_equal(settle(0.9, 0.9, W), 2);
}

/* The second segment took the depth of the first, which the other views do not show there. */
static void a_strip_of_wall_beside_a_thing_goes_back_to_the_wall(void **state)
{
    (void)state;
    assert_int_equal(settle(0.9, 0.9, segments[SECOND].x0), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(segments_are_expected_on_the_faces_that_they_show),
        cmocka_unit_test(nothing_is_expected_in_an_opening),
        cmocka_unit_test(walls_without_a_room_have_a_floor_and_a_ceiling),
        cmocka_unit_test(a_sure_segment_gains_less),
        cmocka_unit_test(what_no_other_view_confirms_is_the_face_behind_it),
        cmocka_unit_test(a_thing_that_other_pictures_match_stays),
        cmocka_unit_test(a_thing_that_views_agree_on_stays_with_all_its_parts),
        cmocka_unit_test(a_strip_of_wall_beside_a_thing_goes_back_to_the_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
