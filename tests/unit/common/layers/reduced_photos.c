/* reduced_photos.c - frames that show photos smaller than they are. */
#include "tests/unit/common/layers/formula_scene.h"

#define WALL   4.0
#define MARGIN 12 /* px of the frame, which the photo's border fades */

struct board { /* a wall of one segment in one view */
    struct view view;
    struct camera_set set;
    struct layer_scene layers;
};

static float checker(int x, int y) { return (x + y) % 2 ? 1 : 0; }
static float noise(int x, int y)
{
    const uint32_t h = ((uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u) * 2654435761u;
    return (float)(h >> 8) / (float)(1 << 24);
}

/* hole: a square of the photo has no depth. */
static void board_make(struct board *b, float (*colour)(int x, int y), bool hole)
{
    struct layered_depth d = {0};
    struct err err = ERR_INIT;
    *b = (struct board){.view = view_at(0, 0, 0)};
    assert_int_equal(layered_depth_init(&d, W, H, &err), ST_OK);
    d.segment_count = 1;
    d.segments = calloc(1, sizeof *d.segments);
    d.segments[0] = (struct depth_segment){.id = 1, .plane = {0, 0, 1 / WALL}, .sigma = 0.01, .confidence = 1};
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const size_t p = (size_t)(y * W + x);
            if (hole && x >= 70 && x < 90 && y >= 50 && y < 70) continue;
            for (int c = 0; c < 3; c++) d.interior.rgba[4 * p + (size_t)c] = colour(x, y);
            d.interior.rgba[4 * p + 3] = 1;
            d.interior.z[p] = (float)WALL;
            d.interior.id[p] = 1;
            d.segments[0].pixels++;
        }
    b->set.views = &b->view;
    b->set.view_count = 1;
    if (layer_scene_init(&b->layers, &b->set, &d, &err)) fail_msg("%s", err.text);
}

static void board_render(struct rendered_frame *f, const struct board *b, double x, double z, bool offline)
{
    const struct layer_render_options options = {.offline = offline, .soft_z = SOFT_Z_WIDTHS};
    const struct view novel = view_at(x, 0, z);
    struct err err = ERR_INIT;
    if (layer_render(f, &b->layers, &novel, &options, &err)) fail_msg("%s", err.text);
}

/* Camera position from which the wall is `times` smaller than in its photo. */
static double back(double times) { return WALL * (1 - times); }

/* Whether the pixel shows the inside of the photo, when that is shown `times` smaller. */
static bool inside(int x, int y, double times)
{
    return fabs(x + 0.5 - W / 2.0) < W / 2.0 / times - MARGIN / times - 2 &&
           fabs(y + 0.5 - H / 2.0) < H / 2.0 / times - MARGIN / times - 2;
}

static void fine_texture_becomes_its_mean(void **state)
{
    const bool offline = *(const bool *)*state;
    struct board b;
    struct rendered_frame f = {0};
    board_make(&b, checker, false);
    for (double times = 3; times < 9; times += 0.7) {
        board_render(&f, &b, 0.013, back(times), offline);
        int shown = 0;
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++)
                if (inside(x, y, times)) {
                    assert_near(f.rgba[4 * (y * W + x)], 0.5, 1e-3);
                    shown++;
                }
        assert_true(shown > 50);
    }
    layer_scene_release(&b.layers);
    rendered_frame_release(&f);
}

/* The mean change of the shown pixels' colour for a shift of half a pixel, with the texture's deviation as unit. */
static double shimmer(const struct board *b, double times, bool offline)
{
    struct rendered_frame f = {0}, g = {0};
    double sum = 0;
    int count = 0;
    board_render(&f, b, 0, back(times), offline);
    board_render(&g, b, 0.5 * WALL * times / FOCAL, back(times), offline);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            if (inside(x, y, times)) {
                sum += fabs((double)f.rgba[4 * (y * W + x)] - (double)g.rgba[4 * (y * W + x)]);
                count++;
            }
    rendered_frame_release(&f);
    rendered_frame_release(&g);
    assert_true(count > 0);
    return sum / count / sqrt(1.0 / 12);
}

static void noise_does_not_shimmer(void **state)
{
    const bool offline = *(const bool *)*state;
    struct board b;
    board_make(&b, noise, false);
    /* independent samples of the texture would change by 2 / sqrt(pi) = 1.13 deviations */
    assert_true(shimmer(&b, 4, offline) < 0.25);
    assert_true(shimmer(&b, 6, offline) < 0.15);
    layer_scene_release(&b.layers);
}

static void a_camera_that_moves_back_crosses_levels_smoothly(void **state)
{
    const bool offline = *(const bool *)*state;
    struct board b;
    struct rendered_frame f = {0}, g = {0};
    board_make(&b, checker, false);
    for (double times = 1.3; times < 5; times += 0.1) { /* level 0 begins at sqrt(2), level 1 at 2 sqrt(2) */
        board_render(&f, &b, 0.1, back(times), offline);
        board_render(&g, &b, 0.1, back(times + 1e-4), offline);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++)
                if (inside(x, y, times)) assert_near(f.rgba[4 * (y * W + x)], g.rgba[4 * (y * W + x)], 0.06);
    }
    layer_scene_release(&b.layers);
    rendered_frame_release(&f);
    rendered_frame_release(&g);
}

static void a_photo_shown_larger_is_looked_up_as_it_is(void **state)
{
    const bool offline = *(const bool *)*state;
    struct board b;
    struct rendered_frame f = {0};
    board_make(&b, checker, false);
    board_render(&f, &b, 0, 0, offline);
    for (int y = MARGIN; y < H - MARGIN; y++)
        for (int x = MARGIN; x < W - MARGIN; x++) assert_near(f.rgba[4 * (y * W + x)], checker(x, y), 2e-3);
    layer_scene_release(&b.layers);
    rendered_frame_release(&f);
}

static void texels_without_depth_do_not_darken_their_surroundings(void **state)
{
    const bool offline = *(const bool *)*state;
    struct board b;
    struct rendered_frame f = {0};
    board_make(&b, checker, true);
    board_render(&f, &b, 0, back(3), offline);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const float *rgba = f.rgba + 4 * (y * W + x);
            if (!inside(x, y, 3) || !(rgba[3] >= 1)) continue;
            const double u = (x + 0.5 - W / 2.0) * 3 + W / 2.0, v = (y + 0.5 - H / 2.0) * 3 + H / 2.0;
            if (u > 68 && u < 92 && v > 48 && v < 72) continue; /* the cells beside the hole are not filtered */
            assert_near(rgba[0], 0.5, 0.13); /* beside the hole a level has odd numbers of black and white texels */
        }
    layer_scene_release(&b.layers);
    rendered_frame_release(&f);
}

static void photos_of_a_few_pixels_are_rendered(void **state)
{
    const bool offline = *(const bool *)*state;
    static const int sizes[][2] = {{1, 1}, {2, 9}, {3, 3}, {5, 4}};
    for (int k = 0; k < 4; k++) {
        struct layered_depth d = {0};
        struct layer_scene layers;
        struct rendered_frame f = {0};
        struct view view = view_at(0, 0, 0), novel = view_at(0, 0, -30);
        struct camera_set set = {.views = &view, .view_count = 1};
        const struct layer_render_options options = {.offline = offline, .soft_z = SOFT_Z_WIDTHS};
        struct err err = ERR_INIT;
        view.width = sizes[k][0];
        view.height = sizes[k][1];
        view.cx = 0.5 * view.width;
        view.cy = 0.5 * view.height;
        assert_int_equal(layered_depth_init(&d, view.width, view.height, &err), ST_OK);
        d.segment_count = 1;
        d.segments = calloc(1, sizeof *d.segments);
        d.segments[0] = (struct depth_segment){.id = 1, .plane = {0, 0, 0.25}, .sigma = 0.01};
        for (int p = 0; p < view.width * view.height; p++) {
            for (int c = 0; c < 4; c++) d.interior.rgba[4 * p + c] = 1;
            d.interior.z[p] = 4;
            d.interior.id[p] = 1;
            d.segments[0].pixels++;
        }
        if (layer_scene_init(&layers, &set, &d, &err)) fail_msg("%s", err.text);
        novel.cx += 0.2;
        if (layer_render(&f, &layers, &novel, &options, &err)) fail_msg("%s", err.text);
        frame_is_finite(&f);
        layer_scene_release(&layers);
        rendered_frame_release(&f);
    }
}

static bool fast = false, offline = true;
#define BOTH(test) \
    {#test " (fast)", test, NULL, NULL, &fast}, { #test " (offline)", test, NULL, NULL, &offline }

int main(void)
{
    const struct CMUnitTest tests[] = {
        BOTH(fine_texture_becomes_its_mean),
        BOTH(noise_does_not_shimmer),
        BOTH(a_camera_that_moves_back_crosses_levels_smoothly),
        BOTH(a_photo_shown_larger_is_looked_up_as_it_is),
        BOTH(texels_without_depth_do_not_darken_their_surroundings),
        BOTH(photos_of_a_few_pixels_are_rendered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
