/* layer_visibility.c - the two nearest surfaces of a view in each pixel, in any drawing order. */
#include "common/layers/layer_visibility.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { W = 96, H = 16, SURFACES = 5 };

static const double depths[SURFACES] = {6, 4.5, 3, 2.2, 8}; /* of matted strips of the view, from left to right */
static const double edges[SURFACES - 1] = {30.5, 44.25, 60.5, 78.75};

static struct view view_at(double x)
{
    struct view v = {.name = "v", .width = W, .height = H, .fx = 60, .fy = 60, .cx = W / 2.0, .cy = H / 2.0};
    v.cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    v.center = vec3_make(x, 0, 0);
    v.translation = vec3_make(-x, 0, 0);
    return v;
}

struct strips {
    struct layered_depth depth;
    struct layer_view packed;
    struct drawn_view drawn;
    struct drawn_tile segments;
    struct tile_visibility visibility;
    struct view_samples front, behind;
};

/* Strip k is segment order[k] + 1, of colour (k, 1, 0). slope: of 1/z along x. */
static void strips_make(struct strips *s, const int *order, double slope)
{
    struct err err = ERR_INIT;
    memset(s, 0, sizeof *s);
    assert_int_equal(layered_depth_init(&s->depth, W, H, &err), ST_OK);
    s->depth.segment_count = SURFACES;
    s->depth.segments = calloc(SURFACES, sizeof *s->depth.segments);
    for (int k = 0; k < SURFACES; k++) {
        struct depth_segment *d = &s->depth.segments[order[k]];
        const double middle = ((k ? edges[k - 1] : 0) + (k + 1 < SURFACES ? edges[k] : W)) / 2;
        *d = (struct depth_segment){.id = (uint32_t)order[k] + 1, .sigma = 0.01};
        d->plane[0] = slope / depths[k];
        d->plane[2] = 1 / depths[k] - d->plane[0] * middle;
    }
    for (int p = 0; p < W * H; p++) {
        int n = 0;
        for (int k = 0; k < SURFACES; k++) {
            const double from = fmax(p % W, k ? edges[k - 1] : 0),
                         to = fmin(p % W + 1, k + 1 < SURFACES ? edges[k] : W);
            const float part = (float)(to - from);
            if (!(part > 0)) continue;
            struct layer *l = n++ ? &s->depth.boundary : &s->depth.interior;
            l->id[p] = (uint32_t)order[k] + 1;
            l->rgba[4 * p] = (float)k * part;
            l->rgba[4 * p + 1] = l->rgba[4 * p + 3] = part;
        }
    }
    assert_int_equal(layer_view_pack(&s->packed, &s->depth, "v", &err), ST_OK);
}

static void strips_release(struct strips *s)
{
    layered_depth_release(&s->depth);
    layer_view_release(&s->packed);
    drawn_view_release(&s->drawn);
    drawn_tile_release(&s->segments);
}

static void draw(struct strips *s, const struct view *novel)
{
    const struct view view = view_at(0);
    struct err err = ERR_INIT;
    assert_int_equal(drawn_view_prepare(&s->drawn, &s->depth, &s->packed, &view, novel, &err), ST_OK);
    assert_int_equal(s->drawn.tile_count, 1);
    for (int i = 0; i < TILE_PIXELS; i++) {
        s->visibility.inverse_front[i] = s->visibility.inverse_behind[i] = 0;
        s->visibility.front[i] = s->visibility.behind[i] = VISIBLE_NONE;
    }
    for (int y = 0; y < TILE_HEIGHT; y++) {
        s->visibility.first[y] = 0;
        s->visibility.last[y] = W - 1;
    }
    assert_int_equal(visibility_draw(&s->visibility, &s->segments, &s->drawn, 0, &err), ST_OK);
    for (size_t i = 0; i < TILE_PIXELS; i += 8)
        if (i % TILE_STRIDE < W)
            visibility_sample8(&s->front, &s->behind, &s->visibility, &s->segments, &s->packed, i, 0, 0);
}

/* 1/z of strip k at pixel centre x of the novel camera, 0 where it has no coverage; *part: its alpha. */
static double strip_at(const struct strips *s, int segment, int k, const struct view *novel, double x, double *part)
{
    const double *p = s->depth.segments[segment].plane, b = novel->center.x;
    /* the view's u = x + fx b / z, 1/z = p0 u + p2 */
    const double inverse = (p[0] * x + p[2]) / (1 - p[0] * novel->fx * b);
    const double u = x + novel->fx * b * inverse - 0.5;
    const int i = (int)floor(u);
    *part = 0;
    for (int n = 0; n < 2; n++) {
        const int column = i + n;
        if (column < 0 || column >= W) continue;
        const double from = fmax(column, k ? edges[k - 1] : 0), to = fmin(column + 1, k + 1 < SURFACES ? edges[k] : W);
        *part += (n ? u - i : 1 - (u - i)) * fmax(0, to - from);
    }
    return inverse;
}

static const int orders[][SURFACES] = {
    {0, 1, 2, 3, 4}, {4, 3, 2, 1, 0}, {2, 0, 4, 1, 3}, {1, 3, 0, 4, 2}, {3, 4, 1, 0, 2}};

static void check_two_nearest(double slope)
{
    struct strips first, s;
    int rims = 0, covered = 0;
    for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
        strips_make(&s, orders[o], slope);
        for (int step = -8; step <= 8; step++) {
            const struct view novel = view_at(0.0837 * step + 0.031);
            draw(&s, &novel);
            for (int x = 2; x < W - 2; x++) {
                const size_t i = 7 * TILE_STRIDE + (size_t)x;
                double near = 0, next = 0, near_part = 0, next_part = 0, min_part = 1;
                for (int k = 0; k < SURFACES; k++) {
                    double part;
                    const double inverse = strip_at(&s, orders[o][k], k, &novel, x + 0.5, &part);
                    if (part > 0) min_part = fmin(min_part, part);
                    if (!(part > 0)) continue;
                    if (inverse > near) {
                        next = near;
                        next_part = near_part;
                        near = inverse;
                        near_part = part;
                    } else if (inverse > next) {
                        next = inverse;
                        next_part = part;
                    }
                }
                if (min_part < 1e-3) continue; /* too close for single precision */
                if (!(fabs((double)s.visibility.inverse_front[i] - near) <= 1e-5 * near))
                    fail_msg("1/z %g at %d from %g, wanted %g", (double)s.visibility.inverse_front[i], x,
                             novel.center.x, near);
                if (!(near > 0)) continue;
                const float *c = s.front.rgba[i], *b = s.behind.rgba[i];
                assert_true(fabs(1 / (double)s.front.z[i] - near) <= 1e-5 * near);
                assert_true(fabs((double)c[3] - near_part) < 2e-3); /* saturating: the front's alpha, then the rest */
                covered++;
                if (near_part > 0.999) {
                    assert_true(s.behind.alpha[i] < 2e-3f);
                    continue;
                }
                if (!(next > 0)) {
                    assert_true(s.behind.alpha[i] == 0);
                    continue;
                }
                rims++;
                assert_true(fabs((double)s.visibility.inverse_behind[i] - next) <= 1e-5 * next);
                assert_true(fabs(1 / (double)s.behind.z[i] - next) <= 1e-5 * next); /* not a mean of the two */
                assert_true(fabs((double)s.behind.alpha[i] - fmin(next_part, 1 - near_part)) < 2e-3);
                assert_true(fabs((double)b[1] - (double)b[3]) < 1e-3 && b[3] <= 1 - c[3] + 1e-5f);
            }
        }
        strips_release(&s);
    }
    if (!(rims > 200 && covered > 5000)) fail_msg("%d rims, %d covered", rims, covered);

    /* all orders give the same bits */
    for (int step = -8; step <= 8; step++) {
        const struct view novel = view_at(0.0837 * step + 0.031);
        strips_make(&first, orders[0], slope);
        draw(&first, &novel);
        for (size_t o = 1; o < sizeof orders / sizeof *orders; o++) {
            strips_make(&s, orders[o], slope);
            draw(&s, &novel);
            for (int y = 0; y < H; y++) {
                const size_t row = (size_t)y * TILE_STRIDE;
                assert_memory_equal(s.visibility.inverse_front + row, first.visibility.inverse_front + row,
                                    W * sizeof(float));
                assert_memory_equal(s.front.rgba + row, first.front.rgba + row, W * sizeof s.front.rgba[0]);
                assert_memory_equal(s.front.z + row, first.front.z + row, W * sizeof(float));
                assert_memory_equal(s.behind.alpha + row, first.behind.alpha + row, W * sizeof(float));
            }
            strips_release(&s);
        }
        strips_release(&first);
    }
}

static void the_two_nearest_surfaces_are_kept_in_any_drawing_order(void **state)
{
    (void)state;
    check_two_nearest(0);
}

static void slanted_segments_are_sorted_per_pixel(void **state)
{
    (void)state;
    check_two_nearest(0.004); /* depth changes by a tenth across a strip */
    check_two_nearest(-0.004);
}

/* The surface behind gets the alpha that the front leaves; the depth is that of the surface with more alpha. */
static void surfaces_are_composited_front_to_back_with_saturating_alpha(void **state)
{
    (void)state;
    struct strips s;
    int rims = 0;
    strips_make(&s, orders[0], 0);
    for (int step = -8; step <= 8; step++) {
        const struct view novel = view_at(0.0837 * step + 0.031);
        draw(&s, &novel);
        static struct view_samples both;
        for (size_t x = 0; x < W; x++) {
            const size_t i = 7 * TILE_STRIDE + x;
            if (x % 8 == 0) visibility_sample8(&both, NULL, &s.visibility, &s.segments, &s.packed, i, 0, 0);
        }
        for (size_t x = 0; x < W; x++) {
            const size_t i = 7 * TILE_STRIDE + x;
            const float front = s.front.alpha[i], rest = s.behind.alpha[i];
            if (!(rest > 0) || front > 0.999f) continue;
            rims++;
            assert_true(fabsf(both.alpha[i] - front - rest) < 1e-5f && both.alpha[i] <= 1 + 1e-5f);
            for (int k = 0; k < 4; k++)
                assert_true(fabsf(both.rgba[i][k] - s.front.rgba[i][k] - s.behind.rgba[i][k]) < 1e-4f);
            assert_true(both.z[i] == (rest > front ? s.behind.z[i] : s.front.z[i]));
        }
    }
    assert_true(rims > 30);
    strips_release(&s);
}

static void coverage_alone_has_the_same_alpha_and_depth(void **state)
{
    (void)state;
    static struct view_samples all, cover;
    struct strips s;
    int split = 0, none = 0;
    for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
        strips_make(&s, orders[o], 0.004);
        for (int step = -8; step <= 8; step++) {
            const struct view novel = view_at(0.4837 * step + 0.031); /* the picture's border comes into view */
            draw(&s, &novel);
            memset(&all, 0xFF, sizeof all);
            memset(&cover, 0xFF, sizeof cover);
            for (size_t x = 0; x < W; x += 8) {
                const size_t i = 7 * TILE_STRIDE + x;
                visibility_sample8(&all, NULL, &s.visibility, &s.segments, &s.packed, i, 0, 0);
                visibility_cover8(&cover, &s.visibility, &s.segments, &s.packed, i, 0, 0);
                for (size_t k = i; k < i + 8; k++) {
                    assert_true(cover.alpha[k] == all.alpha[k] && cover.alpha[k] == all.rgba[k][3]);
                    assert_true(cover.z[k] == all.z[k] && cover.sigma[k] == all.sigma[k]);
                    split += all.alpha[k] > 0 && s.visibility.front[k] < VISIBLE_FULL;
                    none += !(all.alpha[k] > 0);
                }
            }
        }
        strips_release(&s);
    }
    assert_true(split > 100 && none > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_two_nearest_surfaces_are_kept_in_any_drawing_order),
        cmocka_unit_test(slanted_segments_are_sorted_per_pixel),
        cmocka_unit_test(surfaces_are_composited_front_to_back_with_saturating_alpha),
        cmocka_unit_test(coverage_alone_has_the_same_alpha_and_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
