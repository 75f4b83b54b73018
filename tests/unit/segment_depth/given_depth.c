/* given_depth.c - planes of given depth, from a formula with noise, holes and outliers, alone and together with matched
 * segments. */
#include "tests/unit/scratch.h"
#include "tests/unit/segment_depth/whole.h"

#include "stages/segment_depth/given_depth.h"

/* The given depth of a pixel; z is the truth. */
typedef double (*giver)(int x, int y, double z);
static giver gives;

static enum status given_z(void *ctx, int view_idx, float **z, struct err *err)
{
    const struct view *v = &scene.views[view_idx];
    (void)ctx, (void)err;
    *z = NULL;
    if (view_idx) return ST_OK;
    assert_non_null(*z = calloc((size_t)v->width * (size_t)v->height, sizeof **z));
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            int at;
            const double truth = scene_depth(&scene, v, x + 0.5, y + 0.5, &at);
            (*z)[y * v->width + x] = (float)gives(x, y, at < 0 ? 0 : truth);
        }
    return ST_OK;
}

static double all(int x, int y, double z) { return (void)x, (void)y, z; }
static double left_half(int x, int y, double z) { return (void)y, x < W / 2 ? z : 0; }
static double one_in_20(int x, int y, double z) { return (x + 7 * y) % 20 == 0 ? z : 0; }
static double one_in_3(int x, int y, double z) { return (x + y) % 3 == 0 ? z : 0; }
static double with_a_hole(int x, int y, double z) { return hypot(x - W / 4.0, y - H / 2.0) < 15 ? 0 : z; }
static double twice_as_far(int x, int y, double z) { return (void)x, (void)y, 2 * z; }

static double noisy(int x, int y, double z)
{
    const double n = scene_hash(x, y, 1), stray = scene_hash(x, y, 2);
    return stray < 0.1 ? z * (0.3 + 3 * n) : z * (1 + 0.01 * (n - 0.5));
}

static void must_work_given(struct result *r, giver g)
{
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    const struct view_source source = {.read = scene_photo, .ctx = &scene, .read_given = given_z};
    struct err err = ERR_INIT;
    gives = g;
    assert_ok(view_depth(&r->depth, r->neighbours, &r->neighbour_count, &scene.set, 0, &source, &params, &err), err);
    check_invariants(&r->depth);
}

/* A slanted wall, and a card in front of it. */
static void wall_and_card(int views)
{
    start();
    scene_wall(&scene, 0, 0, 7, 15, 15, 0.4)->cell = 0.35;
    scene_wall(&scene, 0.1, 0.1, 4, 0.8, 0.7, 0)->colour[0] = 0.1f;
    place_cameras(views);
}

/* -------------------------------------------------------------------------------------------------- a single view */

static void a_single_photo_with_depth_has_layers(void **state)
{
    (void)state;
    struct result r = {0};
    wall_and_card(1);
    must_work_given(&r, all);
    assert_int_equal(r.neighbour_count, 0);
    assert_true(fraction_correct(&r.depth, 0, 1e-4) > 0.98);
    assert_true(fraction_correct(&r.depth, 1, 1e-4) > 0.98);
    assert_true(mean_confidence(&r.depth) > 0.9);
    int boundary = 0;
    for (int i = 0; i < W * H; i++) boundary += r.depth.boundary.id[i] > 0;
    assert_true(boundary > 20); /* the card's edge is split into layers */
    layered_depth_release(&r.depth);
}

static void samples_in_a_third_of_the_pixels_are_enough(void **state)
{
    (void)state;
    struct result r = {0};
    wall_and_card(1);
    must_work_given(&r, one_in_3);
    assert_true(fraction_correct(&r.depth, 0, 1e-3) > 0.97 && fraction_correct(&r.depth, 1, 1e-3) > 0.97);
    layered_depth_release(&r.depth);
}

static void noise_and_outliers_do_not_bend_planes(void **state)
{
    (void)state;
    struct result r = {0};
    wall_and_card(3);
    must_work_given(&r, noisy);
    assert_true(fraction_correct(&r.depth, 0, 0.005) > 0.97 && fraction_correct(&r.depth, 1, 0.005) > 0.97);
    assert_true(mean_confidence(&r.depth) > 0.5 && mean_confidence(&r.depth) < 0.95);
    layered_depth_release(&r.depth);
}

/* Nothing can be matched: segments without given depth inherit it. */
static void a_hole_inherits_the_depth_around_it(void **state)
{
    (void)state;
    struct result r = {0};
    start();
    scene_wall(&scene, 0, 0, 7, 15, 15, 0.4);
    place_cameras(1);
    must_work_given(&r, with_a_hole);
    assert_true(fraction_correct(&r.depth, 0, 0.02) > 0.97);
    double worst = 0;
    for (int i = 0; i < r.depth.segment_count; i++) worst = fmax(worst, 1 - r.depth.segments[i].confidence);
    assert_true(worst > 0.9); /* with low confidence */
    layered_depth_release(&r.depth);
}

static void too_sparse_depth_alone_is_refused(void **state)
{
    (void)state;
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    const struct view_source source = {.read = scene_photo, .ctx = &scene, .read_given = given_z};
    struct result r = {0};
    struct err err = ERR_INIT;
    wall_and_card(1);
    gives = one_in_20;
    assert_int_equal(view_depth(&r.depth, r.neighbours, &r.neighbour_count, &scene.set, 0, &source, &params, &err),
                     ST_DATA);
    assert_err(err, ST_DATA, "view a has no neighbour");
    assert_contains(err.text, "too sparse");
    assert_null(r.depth.segments);
}

/* ---------------------------------------------------------------------------------------- with matched segments */

static void given_and_matched_halves_agree(void **state)
{
    (void)state;
    struct result r = {0};
    wall_and_card(5);
    scene_points(&scene, 200);
    must_work_given(&r, left_half);
    assert_int_equal(r.neighbour_count, 4);
    assert_true(fraction_correct(&r.depth, 0, 0.02) > 0.95 && fraction_correct(&r.depth, 1, 0.02) > 0.95);
    int good = 0, count = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W / 2 - 8; x++) {
            int at;
            const double z = scene_depth(&scene, &scene.views[0], x + 0.5, y + 0.5, &at);
            if (at_jump(x, y)) continue;
            good += fabs((double)r.depth.interior.z[y * W + x] / z - 1) < 1e-4;
            count++;
        }
    assert_true(good > 0.97 * count);
    layered_depth_release(&r.depth);
}

/* Even if the pictures match better elsewhere, in later rounds, and where neighbours see through it. */
static void given_depth_is_kept(void **state)
{
    (void)state;
    static struct rounds before;
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    memset(&before, 0, sizeof before);
    start();
    scene_wall(&scene, 0, 0, 5, 12, 12, 0.2);
    place_cameras(3);
    scene_points(&scene, 200);
    before.scene = &scene;
    gives = twice_as_far;
    for (int round = 0; round < 2; round++) {
        const struct view_source source = {
            .read = rounds_photo, .read_depth = round ? rounds_depth : NULL, .ctx = &before, .read_given = given_z};
        struct layered_depth now[3] = {{0}};
        for (int k = 0; k < 3; k++) {
            int neighbours[MAX_NEIGHBOURS], count;
            struct err err = ERR_INIT;
            assert_ok(view_depth(&now[k], neighbours, &count, &scene.set, k, &source, &params, &err), err);
        }
        for (int k = 0; k < 3; k++) {
            layered_depth_release(&before.depth[k]);
            before.depth[k] = now[k];
        }
        for (int i = 0; i < W * H; i++) {
            int at;
            const double z = scene_depth(&scene, &scene.views[0], i % W + 0.5, i / W + 0.5, &at);
            assert_near((double)now[0].interior.z[i] / (2 * z), 1, 2e-4);
        }
        assert_true(fraction_correct(&now[1], -1, 0.02) > (round ? 0 : 0.97)); /* without given depth */
    }
    for (int k = 0; k < 3; k++) layered_depth_release(&before.depth[k]);
}

static void thread_counts_give_the_same_bits(void **state)
{
    (void)state;
    struct result r[2] = {{{0}, {0}, 0}};
    wall_and_card(3);
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(k ? 3 : 1);
        must_work_given(&r[k], noisy);
    }
    assert_int_equal(r[0].depth.segment_count, r[1].depth.segment_count);
    assert_memory_equal(r[0].depth.segments, r[1].depth.segments,
                        (size_t)r[0].depth.segment_count * sizeof *r[0].depth.segments);
    assert_memory_equal(r[0].depth.interior.z, r[1].depth.interior.z, W * H * sizeof(float));
    for (int k = 0; k < 2; k++) layered_depth_release(&r[k].depth);
}

/* ------------------------------------------------------------------------------------------------------- the fit */

enum { SIDE = 8 };
#define STEP 0.01

/* Segments of SIDE x SIDE pixels in a row. */
struct row {
    struct segmentation s;
    struct segment segments[4];
    int pixel[4 * SIDE * SIDE];
    float z[4 * SIDE * SIDE];
    struct given_depth g;
};

static void make_row(struct row *r)
{
    *r = (struct row){.s = {.width = 4 * SIDE, .height = SIDE, .count = 4}};
    r->s.segments = r->segments;
    r->s.pixel = r->pixel;
    for (int i = 0; i < 4; i++) {
        r->segments[i] = (struct segment){.first = i * SIDE * SIDE,
                                          .pixels = SIDE * SIDE,
                                          .cx = (i + 0.5) * SIDE,
                                          .cy = SIDE / 2.0,
                                          .x0 = i * SIDE,
                                          .x1 = (i + 1) * SIDE - 1,
                                          .y1 = SIDE - 1};
        for (int k = 0; k < SIDE * SIDE; k++) r->pixel[i * SIDE * SIDE + k] = k / SIDE * 4 * SIDE + i * SIDE + k % SIDE;
    }
}

static void fit_row(struct row *r)
{
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    assert_ok(given_depth_make(&r->g, &r->s, r->z, STEP, &params, &err), err);
}

static void give(struct row *r, int segment, int k, double inverse)
{
    r->z[r->pixel[segment * SIDE * SIDE + k]] = (float)(1 / inverse);
}

static void the_larger_surface_of_a_segment_gives_its_plane(void **state)
{
    (void)state;
    static struct row r;
    make_row(&r);
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double u = k % SIDE + 0.5, v = k / SIDE + 0.5;
        give(&r, 0, k, k % SIDE < 5 ? 0.5 : 1);                                  /* two parts of constant depth */
        give(&r, 1, k, k % SIDE < 3 ? 1 : 0.5 + 0.004 * (SIDE + u) + 0.002 * v); /* the larger part is slanted */
        give(&r, 2, k, 0.5 + (k % 2 ? 1e-5 : -1e-5));                            /* nearly constant */
        if (k < SIDE * SIDE / 8 - 1) give(&r, 3, k, 0.5);                        /* too few samples */
    }
    fit_row(&r);
    assert_true(r.g.known[0] && r.g.known[1] && r.g.known[2] && !r.g.known[3]);
    assert_int_equal(r.g.segments, 3);
    assert_int_equal(r.g.pixels, 3 * SIDE * SIDE + SIDE * SIDE / 8 - 1);
    assert_near(r.g.planes[0].a, 0, 0);
    assert_near(r.g.planes[0].c, 0.5, 1e-6);
    assert_near(r.g.quality[0], 5.0 / 8, 1e-3);
    assert_near(r.g.planes[1].a, 0.004, 1e-6);
    assert_near(r.g.planes[1].b, 0.002, 1e-6);
    assert_near(r.g.planes[1].c, 0.5, 1e-5);
    assert_near(r.g.residual[1], 0, 1e-6);
    assert_true(r.g.planes[2].a == 0 && r.g.planes[2].b == 0);
    assert_near(r.g.quality[2], 1, 0.01);
    given_depth_release(&r.g);
    given_depth_release(&r.g);
}

/* Collinear samples, or a slope that would pass behind the camera, give a constant depth. */
static void samples_that_span_no_plane_give_a_constant_depth(void **state)
{
    (void)state;
    static struct row r;
    make_row(&r);
    for (int k = 0; k < SIDE; k++) {
        give(&r, 0, k * SIDE + 3, 0.5 + 0.01 * k);
        give(&r, 1, k, 0.5);
        give(&r, 2, k * SIDE + 0, 0.02 + 0.08 * 0);
        give(&r, 2, k * SIDE + 1, 0.02 + 0.08 * 1);
    }
    fit_row(&r);
    for (int i = 0; i < 3; i++) {
        assert_true(r.g.known[i]);
        assert_true(r.g.planes[i].a == 0 && r.g.planes[i].b == 0 && r.g.planes[i].c > 0);
    }
    given_depth_release(&r.g);
}

static void the_depth_range_excludes_outliers(void **state)
{
    (void)state;
    enum { N = 10000 };
    static float z[N];
    double min_inverse_z = 0, max_inverse_z = 0;
    memset(z, 0, sizeof z);
    assert_false(given_depth_range(&min_inverse_z, &max_inverse_z, z, N));
    for (int i = 0; i < N; i++) z[i] = i % 2 ? 0 : i % 100 == 0 ? 1e-6f : (float)(2 + 2.0 * i / N);
    assert_true(given_depth_range(&min_inverse_z, &max_inverse_z, z, N));
    assert_true(min_inverse_z > 0.2 && min_inverse_z < 0.26 && max_inverse_z > 0.49 && max_inverse_z < 0.6);
    min_inverse_z = 0.1;
    max_inverse_z = 3;
    assert_true(given_depth_range(&min_inverse_z, &max_inverse_z, z, N)); /* widens only */
    assert_true(min_inverse_z == 0.1 && max_inverse_z == 3);
    for (int i = 0; i < N; i++) z[i] = 4;
    min_inverse_z = max_inverse_z = 0;
    assert_true(given_depth_range(&min_inverse_z, &max_inverse_z, z, N) && min_inverse_z < 0.25 &&
                max_inverse_z > 0.25);
}

/* The ratio of units, with a third of the points outliers. */
static void wrong_units_are_detected_by_the_sparse_points(void **state)
{
    (void)state;
    enum { N = 30 };
    static float z[W * H];
    struct observed_point points[N + 1];
    struct observed_points seen = {points, N};
    for (int i = 0; i < W * H; i++) z[i] = i % 7 ? 1000.0f * (float)(2 + i % W) : 0;
    for (int i = 0; i < N; i++)
        points[i] = (struct observed_point){i, 3 * i + 0.5, 2 * i + 0.5, (i % 3 ? 1 : 5) / (2.0 + 3 * i)};
    assert_near(given_depth_ratio(z, W, H, &seen), 1000, 1e-3);
    points[N] = (struct observed_point){0, W, -1, 1};
    seen = (struct observed_points){points + N - 4, 5};
    assert_near(given_depth_ratio(z, W, H, &seen), 0, 0); /* too few */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_single_photo_with_depth_has_layers),
        cmocka_unit_test(samples_in_a_third_of_the_pixels_are_enough),
        cmocka_unit_test(noise_and_outliers_do_not_bend_planes),
        cmocka_unit_test(a_hole_inherits_the_depth_around_it),
        cmocka_unit_test(too_sparse_depth_alone_is_refused),
        cmocka_unit_test(given_and_matched_halves_agree),
        cmocka_unit_test(given_depth_is_kept),
        cmocka_unit_test(thread_counts_give_the_same_bits),
        cmocka_unit_test(the_larger_surface_of_a_segment_gives_its_plane),
        cmocka_unit_test(samples_that_span_no_plane_give_a_constant_depth),
        cmocka_unit_test(the_depth_range_excludes_outliers),
        cmocka_unit_test(wrong_units_are_detected_by_the_sparse_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
