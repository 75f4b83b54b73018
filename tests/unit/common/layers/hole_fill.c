/* hole_fill.c - holes between a near and a far side. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/layers/hole_fill.h"

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (double)(b)) <= (tolerance))

#define W 64
#define H 48

/* Red and near to the left of column `edge`, blue and far to the right. */
static void frame_paint(struct rendered_frame *f, int edge)
{
    for (int i = 0; i < W * H; i++) {
        float *c = f->rgba + 4 * (size_t)i;
        c[0] = i % W < edge;
        c[1] = 0;
        c[2] = 1 - c[0];
        c[3] = 1;
        f->z[i] = i % W < edge ? 2 : 8;
        f->hole[i] = 0;
    }
}

static void frame_cut(struct rendered_frame *f, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t p = (size_t)(y * W + x);
            for (int k = 0; k < 4; k++) f->rgba[4 * p + (size_t)k] = 0;
            f->z[p] = 0;
            f->hole[p] = 1;
        }
}

static struct rendered_frame frame_make(int edge)
{
    struct rendered_frame f = {.width = W, .height = H};
    f.rgba = calloc(W * H * 4, sizeof *f.rgba);
    f.z = calloc(W * H, sizeof *f.z);
    f.hole = calloc(W * H, 1);
    assert_true(f.rgba && f.z && f.hole);
    frame_paint(&f, edge);
    return f;
}

static void fill(struct rendered_frame *f, int diameter)
{
    const struct soft_z soft = {3, 6};
    struct err err = ERR_INIT;
    assert_int_equal(hole_fill(f, NULL, &soft, 0.01f, diameter, &err), ST_OK);
}

static void assert_blue(const struct rendered_frame *f, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t p = (size_t)(y * W + x);
            assert_near(f->rgba[4 * p], 0, 1e-6);
            assert_near(f->rgba[4 * p + 2], 1, 1e-6);
            assert_near(f->rgba[4 * p + 3], 1, 0);
            assert_near(f->z[p], 8, 1e-5);
        }
}

static void holes_are_filled_from_the_far_side(void **state)
{
    (void)state;
    struct rendered_frame f = frame_make(20);
    for (int width = 1; width <= 20; width++) { /* narrow and wide, beside the near surface, over the full height */
        frame_paint(&f, 20);
        frame_cut(&f, 20, 0, 20 + width, H);
        fill(&f, 6);
        assert_near(f.unfilled_fraction, 0, 0);
        assert_blue(&f, 20, 0, 20 + width, H);
        assert_near(f.rgba[4 * 19], 1, 0); /* known pixels do not change */
    }
    rendered_frame_release(&f);
}

static void borders_and_corners_are_filled(void **state)
{
    (void)state;
    struct rendered_frame f = frame_make(0);
    frame_cut(&f, 0, 0, W, 4);
    frame_cut(&f, 0, 0, 17, H);
    frame_cut(&f, W - 2, 0, W, H);
    fill(&f, 6);
    assert_blue(&f, 0, 0, W, H);
    rendered_frame_release(&f);
}

static void nothing_is_filled_with_diameter_0_or_without_known_pixels(void **state)
{
    (void)state;
    struct rendered_frame f = frame_make(20);
    frame_cut(&f, 30, 10, 40, 20);
    fill(&f, 0);
    assert_near(f.unfilled_fraction, 100.0 / (W * H), 1e-12);
    assert_near(f.rgba[4 * (12 * W + 32) + 3], 0, 0);

    frame_cut(&f, 0, 0, W, H);
    fill(&f, 6);
    assert_near(f.unfilled_fraction, 1, 0);
    for (int i = 0; i < W * H * 4; i++) assert_near(f.rgba[i], 0, 0);
    rendered_frame_release(&f);
}

/* A camera at the origin with the frame's picture, and a photo of `w` x `h` px that begins at (x, y) of the frame. */
static const struct mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static struct view photo_at(int x, int y, int w, int h)
{
    return (struct view){
        .width = w, .height = h, .fx = 50, .fy = 50, .cx = W / 2 - x, .cy = H / 2 - y, .cam_from_world = identity};
}

static void fill_from(struct rendered_frame *f, const struct view *photos, int count)
{
    const struct view camera = photo_at(0, 0, W, H);
    const struct hole_photos known = {photos, count, &camera};
    const struct soft_z soft = {3, 6};
    struct err err = ERR_INIT;
    assert_int_equal(hole_fill(f, &known, &soft, 0.01f, 6, &err), ST_OK);
}

/* The part of the frame that the photo shows; beside each of the four edges `width` px are missing. */
static const int shown[4][4] = {{1, 0, W, H}, {0, 1, W, H}, {0, 0, W - 1, H}, {0, 0, W, H - 1}};

static void cut_edge(struct rendered_frame *f, int edge, int width)
{
    frame_cut(f, edge == 2 ? W - width : 0, edge == 3 ? H - width : 0, edge == 0 ? width : W, edge == 1 ? width : H);
}

static struct view photo_without_edge(int edge, int width)
{
    const int x0 = shown[edge][0] * width, y0 = shown[edge][1] * width;
    return photo_at(x0, y0, W - x0 - (W - shown[edge][2]) * width, H - y0 - (H - shown[edge][3]) * width);
}

/* A red near leaf, 30 px wide, across each edge of the frame in turn, before a blue far wall. */
static void paint_leaf(struct rendered_frame *f, int edge)
{
    frame_paint(f, 0);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int across = edge % 2 ? x - W / 2 : y - H / 2;
            const size_t p = (size_t)(y * W + x);
            if (across < -15 || across >= 15) continue;
            f->rgba[4 * p] = 1;
            f->rgba[4 * p + 2] = 0;
            f->z[p] = 2;
        }
}

/* Red beside the edge, `inside` px from the leaf's border. */
static float red_at_edge(const struct rendered_frame *f, int edge, int inside)
{
    const int x = edge == 0 ? 1 : edge == 2 ? W - 2 : W / 2 - 15 + inside;
    const int y = edge == 1 ? 1 : edge == 3 ? H - 2 : H / 2 - 15 + inside;
    return f->rgba[4 * (y * W + x)];
}

static void a_leaf_cut_by_any_edge_of_the_frame_continues(void **state)
{
    (void)state;
    for (int edge = 0; edge < 4; edge++)
        for (int width = 4; width <= 10; width += 6) { /* narrow and wide */
            struct rendered_frame f = frame_make(0);
            const struct view photo = photo_without_edge(edge, width), whole = photo_at(0, 0, W, H);
            paint_leaf(&f, edge);
            cut_edge(&f, edge, width);
            fill_from(&f, &photo, 1);
            assert_near(f.unfilled_fraction, 0, 0);
            assert_true(red_at_edge(&f, edge, 15) > 0.75f && red_at_edge(&f, edge, 2) > 0.5f); /* the pyramid blurs */
            /* a photo that shows these pixels does not show the leaf there: it ends, and the wall goes on */
            paint_leaf(&f, edge);
            cut_edge(&f, edge, width);
            fill_from(&f, &whole, 1);
            assert_true(red_at_edge(&f, edge, 2) < 0.1f);
            rendered_frame_release(&f);
        }
}

static void a_disocclusion_that_runs_to_the_edge_is_filled_from_the_far_side(void **state)
{
    (void)state;
    const struct view photo = photo_at(0, 0, W, H - 3); /* the hole's last rows are beyond it, most are not */
    for (int width = 3; width <= 20; width += 17) {
        struct rendered_frame f = frame_make(20);
        frame_cut(&f, 20, 0, 20 + width, H);
        fill_from(&f, &photo, 1);
        assert_blue(&f, 20, 0, 20 + width, H);
        rendered_frame_release(&f);
    }
}

static void an_overhang_does_not_change_how_a_disocclusion_is_filled(void **state)
{
    (void)state;
    const struct view photo = photo_without_edge(2, 10);
    struct rendered_frame f = frame_make(20), g = frame_make(20);
    frame_cut(&f, 20, 10, 40, 38);
    frame_cut(&g, 20, 10, 40, 38);
    fill_from(&g, &photo, 1);
    frame_cut(&f, W - 10, 0, W, H);
    fill_from(&f, &photo, 1);
    assert_blue(&f, 20, 10, 40, 38);
    assert_blue(&g, 20, 10, 40, 38);
    rendered_frame_release(&f);
    rendered_frame_release(&g);
}

static void only_holes_mostly_beyond_every_photo_are_overhangs(void **state)
{
    (void)state;
    static uint8_t overhang[W * H];
    const struct view camera = photo_at(0, 0, W, H), half = photo_at(0, 0, W - 10, H), all = camera;
    struct view behind = camera;
    struct rendered_frame f = frame_make(20);
    struct err err = ERR_INIT;
    behind.cam_from_world.m[0][0] = behind.cam_from_world.m[2][2] = -1; /* looks away */
    const struct view both[2] = {half, all};
    frame_cut(&f, W - 10, 0, W, H);
    frame_cut(&f, 5, 5, 9, 9);
    const struct {
        struct hole_photos photos;
        int edge, inner;
    } cases[] = {{{&half, 1, &camera}, 1, 0},
                 {{&all, 1, &camera}, 0, 0},
                 {{both, 2, &camera}, 0, 0},
                 {{&behind, 1, &camera}, 1, 1},
                 {{NULL, 0, &camera}, 0, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(hole_find_overhang(overhang, &f, &cases[i].photos, &err), ST_OK);
        assert_int_equal(overhang[20 * W + W - 3], cases[i].edge);
        assert_int_equal(overhang[6 * W + 6], cases[i].inner);
        assert_int_equal(overhang[20 * W + 30], 0);
    }
    frame_cut(&f, 0, 0, W, H); /* nothing is known */
    assert_int_equal(hole_find_overhang(overhang, &f, &cases[0].photos, &err), ST_OK);
    for (int p = 0; p < W * H; p++) assert_int_equal(overhang[p], 0);
    rendered_frame_release(&f);
}

static void overhangs_have_the_same_bits_with_any_number_of_threads(void **state)
{
    (void)state;
    struct rendered_frame f[2];
    const struct view photo = photo_without_edge(0, 12);
    for (int i = 0; i < 2; i++) {
        f[i] = frame_make(20);
        paint_leaf(&f[i], 0);
        cut_edge(&f[i], 0, 12);
        frame_cut(&f[i], 40, 3, 60, 40);
        parallel_set_threads(i + 1);
        fill_from(&f[i], &photo, 1);
    }
    parallel_set_threads(0);
    assert_memory_equal(f[0].rgba, f[1].rgba, W * H * 16);
    assert_memory_equal(f[0].z, f[1].z, W * H * 4);
    rendered_frame_release(&f[0]);
    rendered_frame_release(&f[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holes_are_filled_from_the_far_side),
        cmocka_unit_test(borders_and_corners_are_filled),
        cmocka_unit_test(nothing_is_filled_with_diameter_0_or_without_known_pixels),
        cmocka_unit_test(a_leaf_cut_by_any_edge_of_the_frame_continues),
        cmocka_unit_test(a_disocclusion_that_runs_to_the_edge_is_filled_from_the_far_side),
        cmocka_unit_test(an_overhang_does_not_change_how_a_disocclusion_is_filled),
        cmocka_unit_test(only_holes_mostly_beyond_every_photo_are_overhangs),
        cmocka_unit_test(overhangs_have_the_same_bits_with_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
