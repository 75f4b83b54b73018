/* exemplar_fill.c - holes in pictures of known content. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "stages/render_views/exemplar_fill.h"

static const struct exemplar_depth depth_of_scene = {{3, 10}, 0.01f};
static const struct exemplar_params usual = EXEMPLAR_PARAMS_DEFAULT;

static const float white[3] = {0.8f, 0.7f, 0.6f}, black[3] = {0.05f, 0.1f, 0.2f}, red[3] = {0.9f, 0, 0};

static void frame_make(struct rendered_frame *f, int w, int h)
{
    struct err err = ERR_INIT;
    memset(f, 0, sizeof *f);
    assert_ok(rendered_frame_resize(f, w, h, true, &err), err);
    memset(f->rgba, 0, (size_t)w * (size_t)h * 4 * sizeof *f->rgba);
    memset(f->z, 0, (size_t)w * (size_t)h * sizeof *f->z);
    memset(f->hole, 1, (size_t)w * (size_t)h);
}

static void put(struct rendered_frame *f, int x, int y, const float rgb[3], float z)
{
    const size_t p = (size_t)y * (size_t)f->width + (size_t)x;
    memcpy(f->rgba + 4 * p, rgb, 3 * sizeof *rgb);
    f->rgba[4 * p + 3] = 1;
    f->z[p] = z;
    f->hole[p] = 0;
}

static void cut(struct rendered_frame *f, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t p = (size_t)y * (size_t)f->width + (size_t)x;
            memset(f->rgba + 4 * p, 0, 4 * sizeof *f->rgba);
            f->z[p] = 0;
            f->hole[p] = 1;
        }
}

static struct exemplar_stats fill(struct rendered_frame *f)
{
    struct exemplar_stats stats;
    struct err err = ERR_INIT;
    assert_ok(exemplar_fill(f, NULL, &depth_of_scene, 6, &usual, &stats, &err), err);
    return stats;
}

static bool is_color(const struct rendered_frame *f, int x, int y, const float rgb[3])
{
    return !memcmp(f->rgba + 4 * ((size_t)y * (size_t)f->width + (size_t)x), rgb, 3 * sizeof *rgb);
}

static void assert_whole(const struct rendered_frame *f)
{
    for (size_t p = 0; p < (size_t)f->width * (size_t)f->height; p++) {
        for (size_t k = 0; k < 3; k++) assert_true(isfinite(f->rgba[4 * p + k]) && f->rgba[4 * p + k] >= 0);
        assert_true(f->rgba[4 * p + 3] == 1);
        assert_true(isfinite(f->z[p]) && f->z[p] >= 0);
    }
    assert_true(f->unfilled_fraction == 0);
}

/* Stripes 4 px wide, vertical, horizontal or diagonal. */
static const float *stripe(int kind, int x, int y)
{
    return ((kind == 0 ? x : kind == 1 ? y : x + y) / 4) % 2 ? white : black;
}

static void stripes_continue_across_a_hole(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        struct rendered_frame f;
        frame_make(&f, 96, 80);
        for (int y = 0; y < 80; y++)
            for (int x = 0; x < 96; x++) put(&f, x, y, stripe(kind, x, y), 5);
        cut(&f, 30, 25, 62, 53);
        const struct exemplar_stats s = fill(&f);
        assert_int_equal(s.holes, 1);
        assert_int_equal(s.classified, 0);
        assert_int_equal(s.no_patch, 0);
        assert_int_equal(s.empty, 32 * 28);
        for (int y = 0; y < 80; y++)
            for (int x = 0; x < 96; x++) {
                if (!is_color(&f, x, y, stripe(kind, x, y))) fail_msg("kind %d, pixel %d %d", kind, x, y);
                assert_float_equal(f.z[y * 96 + x], 5, 1e-4);
            }
        assert_whole(&f);
        rendered_frame_release(&f);
    }
}

static void texture_continues_to_the_border_of_the_frame(void **state)
{
    (void)state;
    struct rendered_frame f;
    frame_make(&f, 96, 96);
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 96; x++) put(&f, x, y, stripe(0, x, y), 5);
    cut(&f, 70, 60, 96, 96);
    fill(&f);
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 96; x++) assert_true(is_color(&f, x, y, stripe(0, x, y)));
    rendered_frame_release(&f);
}

/* A red disc at depth 4 in front of a checkered wall at depth 10; the disocclusion to its right is a hole. */
static void a_near_object_is_not_smeared_over_the_wall(void **state)
{
    (void)state;
    struct rendered_frame f;
    frame_make(&f, 128, 96);
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 128; x++) {
            const bool disc = hypot(x - 50, y - 48) < 24, hidden = hypot(x - 68, y - 48) < 24;
            if (disc)
                put(&f, x, y, red, 4 + 0.01f * (float)(y % 3));
            else if (!hidden)
                put(&f, x, y, (x / 4 + y / 4) % 2 ? white : black, 10);
        }
    const struct exemplar_stats s = fill(&f);
    assert_int_equal(s.classified, 1);
    assert_int_equal(s.no_patch, 0);
    size_t right = 0, filled = 0;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 128; x++) {
            if (!f.hole[y * 128 + x]) continue;
            assert_false(is_color(&f, x, y, red));
            assert_true(is_color(&f, x, y, white) || is_color(&f, x, y, black));
            assert_float_equal(f.z[y * 128 + x], 10, 1e-4);
            right += is_color(&f, x, y, (x / 4 + y / 4) % 2 ? white : black);
            filled++;
        }
    assert_int_equal(filled, s.empty);
    assert_true(right > filled * 4 / 5); /* the checks continue, except near the disc's curved edge */
    assert_whole(&f);
    rendered_frame_release(&f);
}

static void one_surface_has_no_depth_clusters(void **state)
{
    (void)state;
    struct rendered_frame f;
    frame_make(&f, 100, 100);
    for (int y = 0; y < 100; y++) /* a floor from depth 4 to 12 */
        for (int x = 0; x < 100; x++) put(&f, x, y, stripe(0, x, y), 4 + 0.08f * (float)y);
    cut(&f, 20, 30, 50, 70);
    const struct exemplar_stats s = fill(&f);
    assert_int_equal(s.classified, 0);
    for (int y = 30; y < 70; y++)
        for (int x = 20; x < 50; x++) {
            assert_true(f.z[y * 100 + x] > 4 + 0.08f * 28 && f.z[y * 100 + x] < 4 + 0.08f * 72);
            assert_true(is_color(&f, x, y, stripe(0, x, y)));
        }
    rendered_frame_release(&f);
}

static void the_border_lies_between_two_depth_clusters(void **state)
{
    (void)state;
    const struct rng rng = rng_make(3, "test", "rim");
    float z[400];
#define BORDER(count, value)                                     \
    (__extension__({                                             \
        for (int i = 0; i < (count); i++) z[i] = (float)(value); \
        exemplar_far_border(z, (count), 0.01f);                  \
    }))
    /* two depths: the midpoint in ln z; zeros are ignored */
    assert_float_equal(BORDER(100, i < 30 ? 2 : 8), 4, 1e-5);
    assert_float_equal(BORDER(100, i % 3 ? i % 3 == 1 ? 2 : 8 : 0), 4, 1e-5);
    assert_float_equal(BORDER(100, i < 30 ? 2e6 : 8e6), 4e6, 10);
    /* a slanted wall, one depth with errors, one depth, none */
    assert_true(BORDER(400, exp(i / 400.0)) == 0);
    assert_true(BORDER(400, 5 + 5 * (rng_uniform(&rng, (uint64_t)i, 0) + rng_uniform(&rng, (uint64_t)i, 1) - 1)) == 0);
    assert_true(BORDER(50, 3) == 0);
    assert_true(BORDER(50, 0) == 0);
    assert_true(BORDER(1, 7) == 0);
    assert_true(exemplar_far_border(z, 0, 0.01f) == 0);
    /* two depths closer than their errors */
    assert_true(BORDER(100, i % 2 ? 5 : 5.1) == 0);
    assert_true(BORDER(100, i % 2 ? 5 : 6) > 5);
    /* a few outliers are not a cluster; a near object in front of a floor is one */
    assert_true(BORDER(200, i < 3 ? 500 : 5 + 0.02 * (i % 9)) == 0);
    const float border = BORDER(200, i % 2 ? 2 : 5 + 0.01 * i);
    assert_true(border > 2.5 && border < 5);
#undef BORDER
}

static void noise_fill(struct rendered_frame *f, int w, int h)
{
    const struct rng rng = rng_make(7, "test", "noise");
    frame_make(f, w, h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            float rgb[3];
            for (uint64_t k = 0; k < 3; k++) rgb[k] = (float)rng_uniform(&rng, (uint64_t)(y / 2 * w + x / 2), k);
            put(f, x, y, rgb, x < w / 2 ? 5 : 9);
        }
    for (int i = 0; i < 12; i++) {
        const int x = (int)(rng_u32(&rng, (uint64_t)i, 10) % (uint32_t)(w - 30)),
                  y = (int)(rng_u32(&rng, (uint64_t)i, 11) % (uint32_t)(h - 30));
        cut(f, x, y, x + 4 + i * 2, y + 26 - i);
    }
    cut(f, w - 40, h - 20, w, h);
}

static void any_thread_count_gives_the_same_bits_and_keeps_known_pixels(void **state)
{
    (void)state;
    struct rendered_frame f, g, open;
    noise_fill(&open, 300, 200);
    noise_fill(&f, 300, 200);
    noise_fill(&g, 300, 200);
    parallel_set_threads(1);
    const struct exemplar_stats one = fill(&f);
    parallel_set_threads(2);
    const struct exemplar_stats two = fill(&g);
    parallel_set_threads(0);
    assert_memory_equal(f.rgba, g.rgba, 300 * 200 * 16);
    assert_memory_equal(f.z, g.z, 300 * 200 * 4);
    assert_memory_equal(&one, &two, sizeof one);
    assert_true(one.holes > 5 && one.narrow > 0 && one.patches > 100);
    assert_whole(&f);
    for (size_t p = 0; p < 300 * 200; p++)
        if (!open.hole[p]) {
            assert_memory_equal(f.rgba + 4 * p, open.rgba + 4 * p, 16);
            assert_true(f.z[p] == open.z[p]);
        }
    rendered_frame_release(&f);
    rendered_frame_release(&g);
    rendered_frame_release(&open);
}

static void exposure_does_not_change_the_choice_of_patches(void **state)
{
    (void)state;
    struct rendered_frame f, g;
    noise_fill(&f, 200, 150);
    noise_fill(&g, 200, 150);
    for (size_t i = 0; i < 200 * 150 * 4; i++)
        if (i % 4 != 3) g.rgba[i] *= 1048576; /* a power of four, so that the square root is exact */
    fill(&f);
    fill(&g);
    for (size_t p = 0; p < 200 * 150; p++)
        for (size_t k = 0; k < 3; k++) assert_true(fabsf(g.rgba[4 * p + k] / 1048576 - f.rgba[4 * p + k]) <= 1e-6f);
    rendered_frame_release(&f);
    rendered_frame_release(&g);
}

static void difficult_frames_are_filled_completely(void **state)
{
    (void)state;
    static const struct {
        int w, h, x, y; /* size; the known pixel */
    } cases[] = {{1, 2, 0, 1}, {2, 1, 0, 0}, {40, 3, 39, 0}, {3, 40, 1, 20}, {60, 50, 59, 49}, {64, 64, 30, 30}};
    struct rendered_frame f;

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) { /* all pixels but one are holes */
        frame_make(&f, cases[i].w, cases[i].h);
        put(&f, cases[i].x, cases[i].y, white, 3);
        fill(&f);
        assert_whole(&f);
        for (size_t p = 0; p < (size_t)f.width * (size_t)f.height; p++) {
            for (size_t k = 0; k < 3; k++) assert_float_equal(f.rgba[4 * p + k], white[k], 1e-4);
            assert_float_equal(f.z[p], 3, 1e-3);
        }
        rendered_frame_release(&f);
    }
    frame_make(&f, 1, 1); /* without a hole, and empty */
    put(&f, 0, 0, white, 3);
    fill(&f);
    assert_whole(&f);
    cut(&f, 0, 0, 1, 1);
    fill(&f);
    assert_true(f.unfilled_fraction == 1 && f.rgba[3] == 0);
    rendered_frame_release(&f);

    frame_make(&f, 20000, 16); /* a strip with a hole wider than the window */
    for (int y = 0; y < 16; y++)
        for (int x = 0; x < 20000; x++) put(&f, x, y, stripe(0, x, y), 5);
    cut(&f, 9000, 0, 9600, 16);
    assert_true(fill(&f).no_patch == 0);
    assert_whole(&f);
    rendered_frame_release(&f);

    frame_make(&f, 80,
               60); /* a grid of holes without any source patch; colours of any magnitude; no depth on the right */
    for (int y = 0; y < 60; y++)
        for (int x = 0; x < 80; x++) {
            const float rgb[3] = {x % 9 ? 1e8f : 0, 0, 1e-8f};
            put(&f, x, y, rgb, x < 40 ? 1e5f : 0);
        }
    cut(&f, 10, 10, 30, 50);
    cut(&f, 45, 5, 79, 55);
    for (int y = 0; y < 60; y++)
        for (int x = 0; x < 80; x++)
            if (x % 4 == 0 || y % 4 == 0) cut(&f, x, y, x + 1, y + 1);
    assert_true(fill(&f).no_patch > 0);
    assert_whole(&f);
    rendered_frame_release(&f);
}

static void any_patch_and_window_size_works(void **state)
{
    (void)state;
    static const int sizes[][2] = {{3, 8}, {4, 9}, {15, 8}, {15, 4096}, {9, 101}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const struct exemplar_params params = {sizes[i][0], sizes[i][1]};
        struct rendered_frame f;
        struct err err = ERR_INIT;
        noise_fill(&f, 200, 150);
        assert_ok(exemplar_fill(&f, NULL, &depth_of_scene, 1, &params, NULL, &err), err);
        assert_whole(&f);
        rendered_frame_release(&f);
    }
}

static void diameter_0_fills_nothing(void **state)
{
    (void)state;
    struct rendered_frame f;
    struct err err = ERR_INIT;
    frame_make(&f, 20, 20);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 20; x++) put(&f, x, y, white, 3);
    cut(&f, 5, 5, 15, 15);
    assert_ok(exemplar_fill(&f, NULL, &depth_of_scene, 0, &usual, NULL, &err), err);
    assert_float_equal(f.unfilled_fraction, 0.25, 1e-12);
    assert_true(f.rgba[4 * (10 * 20 + 10) + 3] == 0);
    rendered_frame_release(&f);
}

/* The picture of a camera at the origin from its pixel (x, y) on. */
static struct view photo_at(int x, int y, int w, int h)
{
    return (struct view){.width = w,
                         .height = h,
                         .fx = 80,
                         .fy = 80,
                         .cx = 48 - x,
                         .cy = 48 - y,
                         .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
}

/* A red bar at depth 4, 40 px wide, before a checkered wall at depth 10, across the edge 0 to 3: left, top, right,
 * bottom. The 14 px beside the edge are a hole. */
static void bar_fill(struct rendered_frame *f, int edge, const struct view *photo)
{
    const struct view camera = photo_at(0, 0, 96, 96);
    const struct hole_photos photos = {photo, 1, &camera};
    struct exemplar_stats stats;
    struct err err = ERR_INIT;

    frame_make(f, 96, 96);
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 96; x++) {
            const int across = edge % 2 ? x : y;
            if (across >= 28 && across < 68)
                put(f, x, y, red, 4);
            else
                put(f, x, y, (x / 4 + y / 4) % 2 ? white : black, 10);
        }
    cut(f, edge == 2 ? 82 : 0, edge == 3 ? 82 : 0, edge == 0 ? 14 : 96, edge == 1 ? 14 : 96);
    assert_ok(exemplar_fill(f, &photos, &depth_of_scene, 6, &usual, &stats, &err), err);
    assert_int_equal(stats.holes, 1);
    assert_int_equal(stats.overhangs + stats.classified, 1);
    assert_whole(f);
}

static int red_pixels(const struct rendered_frame *f)
{
    int count = 0;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 96; x++) count += f->hole[y * 96 + x] && is_color(f, x, y, red);
    return count;
}

static void a_leaf_cut_by_any_edge_of_the_frame_continues(void **state)
{
    (void)state;
    const struct view photos[4] = {photo_at(14, 0, 82, 96), photo_at(0, 14, 96, 82), photo_at(0, 0, 82, 96),
                                   photo_at(0, 0, 96, 82)};
    for (int edge = 0; edge < 4; edge++) {
        struct rendered_frame f;
        bar_fill(&f, edge, &photos[edge]);
        assert_in_range(red_pixels(&f), 14 * 36, 14 * 44);
        rendered_frame_release(&f);
    }
}

static void a_disocclusion_that_runs_to_the_edge_is_filled_from_the_far_side(void **state)
{
    (void)state;
    const struct view whole = photo_at(0, 0, 96, 96);
    for (int edge = 0; edge < 4; edge++) {
        struct rendered_frame f;
        bar_fill(&f, edge, &whole);
        assert_int_equal(red_pixels(&f), 0);
        rendered_frame_release(&f);
    }
}

static void overhangs_have_the_same_bits_with_any_number_of_threads(void **state)
{
    (void)state;
    const struct view photo = photo_at(0, 0, 82, 96);
    struct rendered_frame f[2];
    for (int i = 0; i < 2; i++) {
        parallel_set_threads(i + 1);
        bar_fill(&f[i], 2, &photo);
    }
    parallel_set_threads(0);
    assert_memory_equal(f[0].rgba, f[1].rgba, 96 * 96 * 16);
    assert_memory_equal(f[0].z, f[1].z, 96 * 96 * 4);
    rendered_frame_release(&f[0]);
    rendered_frame_release(&f[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stripes_continue_across_a_hole),
        cmocka_unit_test(texture_continues_to_the_border_of_the_frame),
        cmocka_unit_test(a_near_object_is_not_smeared_over_the_wall),
        cmocka_unit_test(one_surface_has_no_depth_clusters),
        cmocka_unit_test(the_border_lies_between_two_depth_clusters),
        cmocka_unit_test(any_thread_count_gives_the_same_bits_and_keeps_known_pixels),
        cmocka_unit_test(exposure_does_not_change_the_choice_of_patches),
        cmocka_unit_test(difficult_frames_are_filled_completely),
        cmocka_unit_test(any_patch_and_window_size_works),
        cmocka_unit_test(diameter_0_fills_nothing),
        cmocka_unit_test(a_leaf_cut_by_any_edge_of_the_frame_continues),
        cmocka_unit_test(a_disocclusion_that_runs_to_the_edge_is_filled_from_the_far_side),
        cmocka_unit_test(overhangs_have_the_same_bits_with_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
