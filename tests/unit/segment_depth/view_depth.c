/* view_depth.c - the whole stage on photographs of synthetic scenes, easy and hard. */
#include "tests/unit/segment_depth/whole.h"

static struct result made; /* of a test with SCENE_TEST; the scene is empty before it */

static int begin_scene(void **state)
{
    (void)state;
    start();
    return 0;
}

static int end_scene(void **state)
{
    (void)state;
    layered_depth_release(&made.depth);
    made = (struct result){0};
    return 0;
}
#define SCENE_TEST(f) cmocka_unit_test_setup_teardown(f, begin_scene, end_scene)

static void find_depth(int cameras, int points)
{
    place_cameras(cameras);
    scene_points(&scene, points);
    must_work(&made);
}

/* -------------------------------------------------------------------------------------- easy scenes */

static void a_facing_wall_is_found(void **state)
{
    (void)state;
    for (int points = 0; points < 2; points++) {
        struct result r = {0};
        start();
        scene_wall(&scene, 0, 0, 5, 9, 9, 0);
        place_cameras(3);
        scene_points(&scene, points * 150);
        must_work(&r);
        assert_int_equal(r.neighbour_count, 2);
        assert_true(fraction_correct(&r.depth, -1, 0.01) > 0.97);
        assert_true(mean_confidence(&r.depth) > 0.7);
        layered_depth_release(&r.depth);
    }
}

static void a_slanted_wall_is_found(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 5, 9, 9, 0.5);
    find_depth(3, 150);
    assert_true(fraction_correct(&made.depth, -1, 0.02) > 0.97);
}

static void a_floor_is_found(void **state)
{
    (void)state;
    struct painted_surface *floor = scene_surface(&scene, vec3_make(0, 1, 7));
    floor->across = vec3_make(15, 0, 0);
    floor->down = vec3_make(0, 0, 7);
    scene_wall(&scene, 0, 0, 12, 20, 20, 0)->cell = 0.6;
    find_depth(5, 300);
    assert_true(fraction_correct(&made.depth, 0, 0.02) > 0.95);
    assert_true(fraction_correct(&made.depth, 1, 0.02) > 0.9);
}

/* Before a wall, with a few pebbles on it that show where it is. */
static void a_blank_lawn_lies_on_the_ground(void **state)
{
    (void)state;
    struct painted_surface *lawn = scene_surface(&scene, vec3_make(0, 1.2, 6));
    lawn->across = vec3_make(15, 0, 0);
    lawn->down = vec3_make(0, 0, 6);
    lawn->contrast = 0;
    scene_wall(&scene, 0, -3.8, 11, 15, 5, 0);
    place_cameras(5);
    scene_points(&scene, 350);
    for (int i = 0; i < 40; i++)
        scene_point(&scene, vec3_make(4 * scene_hash(i, 1, 1) - 2, 1.2, 4 + 7 * scene_hash(i, 1, 2)), 31);
    must_work(&made);
    if (getenv("VERDICT")) print_message("  lawn %.3f\n", fraction_correct(&made.depth, 0, 0.03));
    assert_true(fraction_correct(&made.depth, 0, 0.03) > 0.9);
}

static void a_ball_is_found(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 7, 12, 12, 0)->cell = 0.35;
    scene_surface(&scene, vec3_make(0.1, 0, 5))->radius = 1;
    scene.surfaces[1].colour[0] = 0.15f;
    scene.surfaces[1].cell = 0.2;
    find_depth(5, 300);
    assert_true(fraction_correct(&made.depth, 0, 0.01) > 0.95);
    assert_true(fraction_correct(&made.depth, 1, 0.02) > 0.9);
}

/* A card in front of a wall: in each row the depth changes at the card's edge. */
static void a_depth_edge_is_found_within_two_pixels(void **state)
{
    (void)state;
    int rows = 0, near = 0;
    scene_wall(&scene, 0, 0, 7, 12, 12, 0)->cell = 0.35;
    struct painted_surface *card = scene_wall(&scene, 0.1, 0.1, 4, 0.8, 0.7, 0);
    card->colour[0] = 0.12f;
    card->cell = 0.2;
    find_depth(5, 300);
    assert_true(fraction_correct(&made.depth, 0, 0.02) > 0.97 && fraction_correct(&made.depth, 1, 0.01) > 0.97);
    for (int y = 0; y < H; y++) {
        int surface, edges[2] = {-1, -1}, found[2] = {-1, -1};
        for (int x = 1; x < W; x++) {
            scene_depth(&scene, &scene.views[0], x + 0.5, y + 0.5, &surface);
            if (surface == 1 && edges[0] < 0) edges[0] = x;
            if (surface == 1) edges[1] = x;
            if (made.depth.interior.z[y * W + x] < 5.5f && found[0] < 0) found[0] = x;
            if (made.depth.interior.z[y * W + x] < 5.5f) found[1] = x;
        }
        for (int k = 0; k < 2 && edges[0] >= 0; k++) {
            near += abs(edges[k] - found[k]) <= 2;
            rows++;
        }
    }
    assert_true(rows > 80 && near >= 0.95 * rows);
}

/* --------------------------------------------------------------------------------------------------- hard cases */

/* A blank panel in front of a textured wall, or a blank part of it, gets the depth of its surroundings. */
static void a_blank_wall_gets_the_depth_of_its_frame(void **state)
{
    (void)state;
    for (int points = 0; points < 2; points++) {
        struct result r = {0};
        start();
        scene_wall(&scene, 0, 0, 5, 9, 9, 0.2);
        scene_wall(&scene, 0, 0, 5 - 1e-4, 0.9, 0.7, 0.2)->contrast = 0;
        place_cameras(5);
        scene_points(&scene, points * 200);
        must_work(&r);
        assert_true(fraction_correct(&r.depth, 0, 0.02) > 0.95);
        assert_true(fraction_correct(&r.depth, 1, 0.03) > 0.9);
        layered_depth_release(&r.depth);
    }
}

static void an_entirely_blank_wall_has_a_depth_without_confidence(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 5, 30, 30, 0)->contrast = 0;
    place_cameras(3);
    must_work(&made);
    assert_true(mean_confidence(&made.depth) < 0.3);
}

/* Vertical stripes repeat every 0.31 in the world, 10 px: less than the disparity between the views. Points decide
 * which stripes correspond. */
static void a_repeated_pattern_is_resolved_by_points(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    scene.surfaces[0].period = 0.31;
    place_cameras(3);
    for (int i = 0; i < 60; i++) /* points on the wall */
        scene_point(&scene, vec3_make(5 * scene_hash(i, 0, 0) - 2.5, 3.5 * scene_hash(i, 0, 1) - 1.75, 5), 7);
    for (int i = 0; i < 12; i++) /* and some far and near ones, to widen the depth range */
        scene_point(&scene, vec3_make(scene_hash(i, 0, 0), -1.4, i % 2 ? 3 : 9), 7);
    must_work(&made);
    assert_true(fraction_correct(&made.depth, -1, 0.02) > 0.9);
}

static void a_repeated_pattern_without_points_has_low_confidence(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    scene.surfaces[0].period = 0.31;
    place_cameras(2);
    must_work(&made);
    assert_true(mean_confidence(&made.depth) < 0.5);
}

static void a_photo_twice_as_bright_matches(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) { /* twice, half; with and without points */
        struct result r = {0};
        start();
        scene_wall(&scene, 0, 0, 5, 9, 9, 0.2);
        place_cameras(3);
        scene.gain[1] = k % 2 ? 2 : 0.5;
        scene_points(&scene, k / 2 * 150);
        must_work(&r);
        assert_true(fraction_correct(&r.depth, -1, 0.01) > 0.93);
        layered_depth_release(&r.depth);
    }
}

static void a_tripod_gives_no_depth_but_an_error(void **state)
{
    (void)state;
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    for (int i = 0; i < 3; i++) scene_view(&scene, W, H, FOCAL, 0, 0, 0, 0.1 * i);
    scene_points(&scene, 100);
    assert_int_equal(depth_of(&made, &params, &err), ST_DATA);
    assert_non_null(strstr(err.text, "taken from different positions"));
    assert_null(made.depth.interior.z);

    start(); /* a tiny baseline, with points as structure from motion would then find them */
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    for (int i = 0; i < 3; i++) scene_view(&scene, W, H, FOCAL, 1e-4 * i, 0, 0, 0.1 * i);
    scene_points(&scene, 100);
    must_work(&made);
    assert_true(mean_confidence(&made.depth) < 0.3);
}

static void a_neighbour_that_faces_elsewhere_is_left_out(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    scene_view(&scene, W, H, FOCAL, 0, 0, 0, 0);
    scene_view(&scene, W, H, FOCAL, 0.3, 0, 0, 2);
    scene_view(&scene, W, H, FOCAL, 0.4, 0, 0, 0);
    scene_points(&scene, 150);
    must_work(&made);
    assert_int_equal(made.neighbour_count, 1);
    assert_int_equal(made.neighbours[0], 2);
}

/* By its pose the neighbour sees the wall, but its photo shows another scene. */
static void a_neighbour_with_a_wrong_picture_does_no_harm(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 5, 9, 9, 0.2);
    place_cameras(4);
    scene.gain[2] = 0; /* black */
    scene_points(&scene, 150);
    must_work(&made);
    assert_int_equal(made.neighbour_count, 3);
    assert_true(fraction_correct(&made.depth, -1, 0.01) > 0.93);
}

static void two_views_are_enough(void **state)
{
    (void)state;
    for (int points = 0; points < 2; points++) {
        struct result r = {0};
        start();
        scene_wall(&scene, 0, 0, 6, 12, 12, 0.3);
        struct painted_surface *card = scene_wall(&scene, 0.1, 0.1, 4, 0.8, 0.7, 0);
        card->colour[0] = 0.12f;
        place_cameras(2);
        scene_points(&scene, points * 150);
        must_work(&r);
        assert_true(fraction_correct(&r.depth, 0, 0.02) > 0.85); /* a strip on the left is in one photo only */
        assert_true(fraction_correct(&r.depth, 1, 0.02) > 0.95);
        layered_depth_release(&r.depth);
    }
}

static void one_view_is_an_error(void **state)
{
    (void)state;
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct result r = {0};
    struct err err = ERR_INIT;
    start();
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    place_cameras(1);
    assert_int_equal(depth_of(&r, &params, &err), ST_DATA);
    assert_non_null(strstr(err.text, "at least two views"));
}

static void tiny_and_narrow_photos_work(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {2, 1}, {1, 9}, {8, 8}, {3, 100}, {300, 2}, {17, 5}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int k = 0; k < 4; k++) { /* without points and with, in the full size and in half of it */
            struct segment_params params = SEGMENT_PARAMS_DEFAULT;
            struct result r = {0};
            struct err err = ERR_INIT;
            params.half_from = k < 2 ? 0 : 1e-9;
            start();
            scene_wall(&scene, 0, 0, 5, 90, 90, 0);
            for (int n = 0; n < 3; n++) scene_view(&scene, sizes[i][0], sizes[i][1], 20, 0.3 * n, 0.05 * n, 0, 0);
            scene_points(&scene, k % 2 * 60);
            if (depth_of(&r, &params, &err)) fail_msg("%s", err.text);
            check_invariants(&r.depth);
            assert_true(r.depth.segment_count >= 1 && r.depth.interior.z[0] > 0);
            layered_depth_release(&r.depth);
        }
}

/* A pole 4 px wide, of another colour than the wall. */
static void a_thin_pole_is_found(void **state)
{
    (void)state;
    int found = 0;
    scene_wall(&scene, 0, 0, 7, 12, 12, 0)->cell = 0.35;
    struct painted_surface *pole = scene_wall(&scene, 0.05, 0, 4, 0.05, 3, 0);
    pole->colour[0] = pole->colour[1] = pole->colour[2] = 0.06f;
    find_depth(5, 300);
    assert_true(fraction_correct(&made.depth, 0, 0.02) > 0.95);
    for (int y = 0; y < H; y++) {
        const float *z = made.depth.interior.z + y * W;
        for (int x = 78; x < 86; x++)
            if (fabsf(z[x] - 4) < 0.2f) {
                found++;
                break;
            }
    }
    if (getenv("VERDICT")) print_message("  pole in %d rows\n", found);
    assert_true(found >= 0.8 * H);
}

static void white_and_black_photos_work(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        struct result r = {0};
        start();
        scene_wall(&scene, 0, 0, 5, 9, 9, 0);
        place_cameras(3);
        for (int i = 0; i < 3; i++)
            scene.gain[i] = k == 3 ? (i == 1) * 1000 : k % 2 ? 1000 : 0; /* all, or one of them */
        scene_points(&scene, k / 2 * 100);
        must_work(&r);
        assert_true(mean_confidence(&r.depth) < 0.3);
        layered_depth_release(&r.depth);
    }
}

/* A lamp with a clipped middle and a textured rim. */
static void an_overexposed_patch_gets_the_depth_of_its_rim(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    struct painted_surface *lamp = scene_wall(&scene, 0.2, 0.1, 5 - 1e-4, 0.5, 0.5, 0);
    for (int c = 0; c < 3; c++) lamp->colour[c] = 30;
    lamp->contrast = 0;
    find_depth(5, 200);
    assert_true(fraction_correct(&made.depth, 1, 0.02) > 0.9 && fraction_correct(&made.depth, 0, 0.02) > 0.95);
}

static void invalid_pixels_have_no_depth(void **state)
{
    (void)state;
    scene_wall(&scene, 0, 0, 5, 9, 9, 0.2);
    place_cameras(3);
    scene.holes = true;
    scene_points(&scene, 150);
    must_work(&made);
    assert_int_equal(made.depth.interior.id[H / 2 * W + W / 2], 0);
    int good = 0, count = 0;
    for (int i = 0; i < W * H; i++) {
        int surface;
        if (!made.depth.interior.id[i]) continue;
        good += fabs((double)made.depth.interior.z[i] /
                         scene_depth(&scene, scene.views, i % W + 0.5, i / W + 0.5, &surface) -
                     1) < 0.02;
        count++;
    }
    assert_true(count > 0.8 * W * H && good > 0.95 * count);
}

/* Without points the sweep starts almost at infinity, which a plane as steep as a floor crosses within a segment. */
static void a_steep_floor_without_points_has_no_depth_behind_the_camera(void **state)
{
    (void)state;
    struct result r = {0};
    start();
    struct painted_surface *floor = scene_surface(&scene, vec3_make(0, 0.3, 60));
    floor->across = vec3_make(150, 0, 0);
    floor->down = vec3_make(0, 0, 60);
    place_cameras(5);
    struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    for (int k = 0; k < 6; k++) {
        params.passes = k % 2 ? 0 : 4;
        params.segment_pixels = k < 2 ? 64 : k < 4 ? 300 : 2000;
        if (depth_of(&r, &params, &err)) fail_msg("%s", err.text);
        check_invariants(&r.depth);
        layered_depth_release(&r.depth);
    }
}

/* A different wall in each photo: planes are arbitrary, including horizontal ones across the horizon. */
static enum status unrelated_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    struct scene *s = ctx;
    s->surfaces[0].cell = view_idx ? 0.11 + 0.02 * view_idx : 0.2;
    const enum status st = scene_photo(ctx, view_idx, im, err);
    s->surfaces[0].cell = 0.2;
    return st;
}

static void unrelated_photos_give_valid_depths(void **state)
{
    (void)state;
    const struct view_source source = {.read = unrelated_photo, .ctx = &scene};
    static const int sizes[] = {64, 300, 2000};
    start();
    scene_wall(&scene, 0, 0, 5, 30, 30, 0)->cell = 0.2;
    place_cameras(3);
    for (int k = 0; k < 6; k++) {
        struct result r = {0};
        struct segment_params params = SEGMENT_PARAMS_DEFAULT;
        struct err err = ERR_INIT;
        params.slant = 0;
        params.passes = k % 2 ? 4 : 0;
        params.segment_pixels = sizes[k / 2];
        if (view_depth(&r.depth, r.neighbours, &r.neighbour_count, &scene.set, 0, &source, &params, &err))
            fail_msg("%s", err.text);
        check_invariants(&r.depth);
        layered_depth_release(&r.depth);
    }
}

static void extreme_parameters_work(void **state)
{
    (void)state;
    static const char *const sets[][6] = {
        {"planes=4", "passes=0", "smoothness=0", "slant=0", NULL},
        {"segment_pixels=100000", "planes=1024", "jump=1000", NULL},
        {"segment_pixels=16", "jump=1", "smoothness=100", "passes=8", NULL},
        {"points=0", "nearest_points=0", "far_bias=0", "matte=none", NULL},
        {"half_from=0.001", "half_pixels=8", "passes=0", NULL},
        {"half_from=0.001", "half_pixels=100000", "planes=4", NULL},
        {"points=10", "nearest_points=10", "far_bias=10", "neighbours=1", "compactness=0.1", NULL},
    };
    start();
    scene_wall(&scene, 0, 0, 7, 12, 12, 0.2);
    scene_wall(&scene, 0.1, 0.1, 4, 0.8, 0.7, 0)->colour[0] = 0.12f;
    place_cameras(3);
    scene_points(&scene, 150);
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
        struct result r = {0};
        struct segment_params params = SEGMENT_PARAMS_DEFAULT;
        struct err err = ERR_INIT;
        for (int k = 0; sets[i][k]; k++)
            assert_int_equal(params_set(segment_param_table, &params, sets[i][k], &err), ST_OK);
        if (depth_of(&r, &params, &err)) fail_msg("%s", err.text);
        check_invariants(&r.depth);
        layered_depth_release(&r.depth);
    }
}

static enum status broken_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    if (view_idx == 2) return err_set(err, ST_IO, "cannot read photo 2.");
    return scene_photo(ctx, view_idx, im, err);
}

static void an_unreadable_photo_is_an_error(void **state)
{
    (void)state;
    const struct view_source source = {.read = broken_photo, .ctx = &scene};
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct result r = {0};
    struct err err = ERR_INIT;
    start();
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    place_cameras(3);
    assert_int_equal(view_depth(&r.depth, r.neighbours, &r.neighbour_count, &scene.set, 0, &source, &params, &err),
                     ST_IO);
    assert_string_equal(err.text, "cannot read photo 2.");
    assert_null(r.depth.segments);
}

static void thread_counts_give_the_same_bits(void **state)
{
    (void)state;
    static struct result r[3];
    start();
    scene_wall(&scene, 0, 0, 7, 12, 12, 0.2);
    scene_surface(&scene, vec3_make(0.1, 0, 5))->radius = 1;
    place_cameras(5);
    scene_points(&scene, 200);
    for (int k = 0; k < 3; k++) {
        parallel_set_threads(k + 1);
        must_work(&r[k]);
    }
    parallel_set_threads(1);
    for (int k = 1; k < 3; k++) {
        const struct layered_depth *a = &r[0].depth, *b = &r[k].depth;
        assert_int_equal(a->segment_count, b->segment_count);
        assert_memory_equal(a->segments, b->segments, (size_t)a->segment_count * sizeof *a->segments);
        assert_memory_equal(a->interior.rgba, b->interior.rgba, sizeof(float) * 4 * W * H);
        assert_memory_equal(a->interior.z, b->interior.z, sizeof(float) * W * H);
        assert_memory_equal(a->interior.id, b->interior.id, sizeof(uint32_t) * W * H);
        assert_memory_equal(a->boundary.rgba, b->boundary.rgba, sizeof(float) * 4 * W * H);
        assert_memory_equal(a->boundary.z, b->boundary.z, sizeof(float) * W * H);
    }
    for (int k = 0; k < 3; k++) layered_depth_release(&r[k].depth);
}

/* A disc around the middle, with single pixels and a strip one pixel wide beside it. */
static enum status masked_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    const enum status st = scene_photo(ctx, view_idx, im, err);
    for (int y = 0; !st && y < im->height; y++)
        for (int x = 0; x < im->width; x++)
            if (hypot(x - im->width / 2, y - im->height / 2) > 50 && (x % 16 || y % 16) && x != im->width - 1)
                memset(image_at(im, x, y), 0, 4 * sizeof(float));
    return st;
}

static void planes_found_at_half_the_size_hold_for_all_pixels(void **state)
{
    (void)state;
    struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    params.half_from = 1e-6;
    for (int k = 0; k < 3; k++) { /* even and odd sizes, and a mask that leaves single pixels */
        photo_fn *photo = k == 2 ? masked_photo : scene_photo;
        const struct view_source source = {.read = photo, .ctx = &scene};
        static const double offsets[][2] = {{0, 0}, {0.4, 0}, {-0.4, 0}, {0, 0.4}, {0, -0.4}};
        struct result r = {0};
        struct err err = ERR_INIT;
        start();
        scene_wall(&scene, 0, 0, 7, 12, 12, 0.2);
        scene_wall(&scene, 0.1, 0.1, 4, 0.8, 0.7, 0)->colour[0] = 0.12f;
        for (int n = 0; n < 5; n++)
            scene_view(&scene, 2 * W + (k > 0), 2 * H + (k > 0), 2 * FOCAL, offsets[n][0], offsets[n][1], 0, 0);
        scene_points(&scene, 200);
        if (view_depth(&r.depth, r.neighbours, &r.neighbour_count, &scene.set, 0, &source, &params, &err))
            fail_msg("%s", err.text);
        must_be_sound_of(&r.depth, photo);
        if (k < 2) {
            assert_true(fraction_correct(&r.depth, 0, 0.01) > 0.97);
            assert_true(fraction_correct(&r.depth, 1, 0.02) > 0.97); /* 0.3 px of half the size */
            /* about as many as half the size has room for */
            assert_near(r.depth.segment_count / (double)(W * H / params.half_pixels), 1, 0.2);
        }
        layered_depth_release(&r.depth);
    }
}

static void views_below_the_size_are_not_halved(void **state)
{
    (void)state;
    struct result r[3];
    struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    memset(r, 0, sizeof r);
    start();
    scene_wall(&scene, 0, 0, 7, 12, 12, 0.2);
    place_cameras(3);
    for (int k = 0; k < 3; k++) {
        params.half_from = k == 0 ? 0 : k == 1 ? 1.001 * W * H * 1e-6 : 0.999 * W * H * 1e-6;
        if (depth_of(&r[k], &params, &err)) fail_msg("%s", err.text);
    }
    assert_memory_equal(r[0].depth.interior.z, r[1].depth.interior.z, sizeof(float) * W * H);
    assert_true(r[2].depth.segment_count < r[0].depth.segment_count / 2);
    for (int k = 0; k < 3; k++) layered_depth_release(&r[k].depth);
}

static void rounds_continue_from_half_the_size(void **state)
{
    (void)state;
    static struct layered_depth d[2];
    struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    params.half_from = 1e-6;
    start();
    scene_wall(&scene, 0, 0, 7, 12, 12, 0.2);
    scene_wall(&scene, 0.1, 0.1, 4, 0.8, 0.7, 0)->colour[0] = 0.12f;
    place_cameras(5);
    scene_points(&scene, 200);
    must_work_in_rounds(d, 1, &params);
    assert_true(fraction_correct(&d[1], -1, 0.01) > 0.95);
    for (int k = 0; k < 2; k++) layered_depth_release(&d[k]);
}

/* Photos that are stored sideways have their upper side at the left or right. */
static void upper_sides_of_photos_turn_the_proposals(void **state)
{
    (void)state;
    const struct vec3 ups[2][MAX_VIEWS] = {
        {{0, -1, 0}, {0, -1, 0}, {0, -1, 0}, {0, -1, 0}, {0, -1, 0}, {0, -1, 0}},
        {{-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}},
    };
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    struct result r[3];
    memset(r, 0, sizeof r);
    start();
    scene_wall(&scene, 0, 0, 6, 9, 9, 0.3);
    scene_wall(&scene, 0.3, 0.2, 4, 0.9, 0.8, -0.4);
    place_cameras(3);
    for (int k = 0; k < 3; k++) {
        const struct view_source source = {.read = scene_photo, .ctx = &scene, .ups = k ? ups[k - 1] : NULL};
        if (view_depth(&r[k].depth, r[k].neighbours, &r[k].neighbour_count, &scene.set, 0, &source, &params, &err))
            fail_msg("%s", err.text);
        check_invariants(&r[k].depth);
    }
    const size_t size = (size_t)(W * H) * sizeof(float);
    assert_memory_equal(r[0].depth.interior.z, r[1].depth.interior.z, size);
    assert_true(memcmp(r[0].depth.interior.z, r[2].depth.interior.z, size) != 0);
    for (int k = 0; k < 3; k++) layered_depth_release(&r[k].depth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_facing_wall_is_found),
        cmocka_unit_test(planes_found_at_half_the_size_hold_for_all_pixels),
        cmocka_unit_test(views_below_the_size_are_not_halved),
        cmocka_unit_test(rounds_continue_from_half_the_size),
        SCENE_TEST(a_slanted_wall_is_found),
        SCENE_TEST(a_floor_is_found),
        SCENE_TEST(a_blank_lawn_lies_on_the_ground),
        SCENE_TEST(a_ball_is_found),
        SCENE_TEST(a_depth_edge_is_found_within_two_pixels),
        cmocka_unit_test(a_blank_wall_gets_the_depth_of_its_frame),
        SCENE_TEST(an_entirely_blank_wall_has_a_depth_without_confidence),
        SCENE_TEST(a_repeated_pattern_is_resolved_by_points),
        SCENE_TEST(a_repeated_pattern_without_points_has_low_confidence),
        cmocka_unit_test(a_photo_twice_as_bright_matches),
        SCENE_TEST(a_tripod_gives_no_depth_but_an_error),
        SCENE_TEST(a_neighbour_that_faces_elsewhere_is_left_out),
        SCENE_TEST(a_neighbour_with_a_wrong_picture_does_no_harm),
        cmocka_unit_test(two_views_are_enough),
        cmocka_unit_test(one_view_is_an_error),
        cmocka_unit_test(tiny_and_narrow_photos_work),
        SCENE_TEST(a_thin_pole_is_found),
        cmocka_unit_test(white_and_black_photos_work),
        SCENE_TEST(an_overexposed_patch_gets_the_depth_of_its_rim),
        SCENE_TEST(invalid_pixels_have_no_depth),
        cmocka_unit_test(a_steep_floor_without_points_has_no_depth_behind_the_camera),
        cmocka_unit_test(unrelated_photos_give_valid_depths),
        cmocka_unit_test(extreme_parameters_work),
        cmocka_unit_test(an_unreadable_photo_is_an_error),
        cmocka_unit_test(thread_counts_give_the_same_bits),
        cmocka_unit_test(upper_sides_of_photos_turn_the_proposals),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
