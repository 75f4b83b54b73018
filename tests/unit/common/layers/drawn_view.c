/* drawn_view.c - the segments that tiles get, compared bit by bit with projecting each segment alone. */
#include "common/layers/drawn_view.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/rng.h"
#include "common/layers/soft_z.h"

enum { W = 90, H = 60, SIDE = 5, COLUMNS = W / SIDE, ROWS = H / SIDE, SEGMENTS = COLUMNS * ROWS };
enum { TARGET_W = 300, TARGET_H = 53, TILES = 3 * 4 };

static const struct quat straight = {1, 0, 0, 0};

static struct quat turned(double x, double y, double z)
{
    const double q = 1 / sqrt(1 + x * x + y * y + z * z);
    return (struct quat){q, q * x, q * y, q * z};
}

static struct view camera(int width, int height, double focal, struct vec3 center, struct quat turn)
{
    struct view v = {.name = "v", .width = width, .height = height, .fx = focal, .fy = 1.1 * focal};
    v.cx = 0.5 * width - 1;
    v.cy = 0.5 * height + 1.5;
    v.cam_from_world = mat3_from_quat(turn);
    v.center = center;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, center), -1);
    return v;
}

static struct view view_make(struct vec3 center, struct quat turn) { return camera(W, H, 80, center, turn); }
static struct view novel_make(struct vec3 center, struct quat turn)
{
    return camera(TARGET_W, TARGET_H, 250, center, turn);
}

struct sheet { /* a view of square segments of random planes, numbered at random */
    struct layered_depth depth;
    struct layer_view packed;
    struct drawn_view drawn;
    struct drawn_tile tile;
};

/* slope: of 1/z across a segment's width, relative to 1/z. */
static void sheet_make(struct sheet *s, uint64_t seed, double slope)
{
    const struct rng rng = rng_make(seed, "test", "sheet");
    uint32_t number[SEGMENTS];
    struct err err = ERR_INIT;

    assert_int_equal(layered_depth_init(&s->depth, W, H, &err), ST_OK);
    s->depth.segment_count = SEGMENTS + 2; /* two without texels */
    s->depth.segments = calloc(SEGMENTS + 2, sizeof *s->depth.segments);
    for (uint32_t i = 0; i < SEGMENTS; i++) number[i] = i;
    for (uint32_t i = SEGMENTS - 1; i > 0 && seed % 2; i--) {
        const uint32_t k = (uint32_t)(rng_uniform(&rng, i, 9) * (i + 1)), swapped = number[i];
        number[i] = number[k];
        number[k] = swapped;
    }
    for (uint32_t i = 0; i < SEGMENTS + 2; i++) {
        struct depth_segment *d = &s->depth.segments[i < SEGMENTS ? number[i] : i];
        const double u = (i % COLUMNS + 0.5) * SIDE, v = (double)(i / COLUMNS) * SIDE + 0.5 * SIDE;
        const double inverse = 0.25 * exp(2 * rng_uniform(&rng, i, 0) - 1);
        d->sigma = 0.02 * rng_uniform(&rng, i, 3);
        for (int k = 0; k < 2; k++)
            d->plane[k] = (2 * rng_uniform(&rng, i, 1 + (uint64_t)k) - 1) * slope * inverse / SIDE;
        d->plane[2] = inverse - d->plane[0] * u - d->plane[1] * v;
        if (i % 37 == 5) d->plane[2] = -1; /* no depth */
        d->id = (uint32_t)(d - s->depth.segments) + 1;
    }
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const size_t p = (size_t)(y * W + x);
            s->depth.interior.id[p] = number[y / SIDE * COLUMNS + x / SIDE] + 1;
            for (int c = 0; c < 4; c++) s->depth.interior.rgba[4 * p + (size_t)c] = 1;
        }
    assert_int_equal(layer_view_pack(&s->packed, &s->depth, "v", &err), ST_OK);
}

/* Keeps the buffers of `drawn` and `tile`. */
static void sheet_clear(struct sheet *s)
{
    layered_depth_release(&s->depth);
    layer_view_release(&s->packed);
}

static void sheet_release(struct sheet *s)
{
    sheet_clear(s);
    drawn_view_release(&s->drawn);
    drawn_tile_release(&s->tile);
}

static struct open_pixels all_open(int tile)
{
    struct open_pixels open = {.x = tile % 3 * TILE_WIDTH, .y = tile / 3 * TILE_HEIGHT};
    open.box = (struct pixel_box){open.x, open.y, open.x + TILE_WIDTH - 1, open.y + TILE_HEIGHT - 1};
    if (open.box.x1 >= TARGET_W) open.box.x1 = TARGET_W - 1;
    if (open.box.y1 >= TARGET_H) open.box.y1 = TARGET_H - 1;
    for (int y = 0; y <= open.box.y1 - open.y; y++)
        for (int x = 0; x <= open.box.x1 - open.x; x++) open.row[y][x / 64] |= (uint64_t)1 << x % 64;
    return open;
}

/* Few open pixels: about one of `rare`. */
static struct open_pixels some_open(int tile, const struct rng *rng, uint64_t seed, double rare)
{
    struct open_pixels open = all_open(tile);
    struct pixel_box box = {TARGET_W, TARGET_H, -1, -1};
    for (int y = open.box.y0; y <= open.box.y1; y++)
        for (int x = open.box.x0; x <= open.box.x1; x++) {
            if (rng_uniform(rng, seed, (uint64_t)(y * TARGET_W + x)) * rare > 1) {
                open.row[y - open.y][(x - open.x) / 64] &= ~((uint64_t)1 << (x - open.x) % 64);
                continue;
            }
            box.x0 = x < box.x0 ? x : box.x0;
            box.x1 = x > box.x1 ? x : box.x1;
            box.y0 = y < box.y0 ? y : box.y0;
            box.y1 = y > box.y1 ? y : box.y1;
        }
    open.box = box;
    return open;
}

static bool any_open(const struct open_pixels *open, int x0, int y0, int x1, int y1)
{
    for (int y = y0 > open->box.y0 ? y0 : open->box.y0; y <= y1 && y <= open->box.y1; y++)
        for (int x = x0 > open->box.x0 ? x0 : open->box.x0; x <= x1 && x <= open->box.x1; x++)
            if (open->row[y - open->y][(x - open->x) / 64] >> (x - open->x) % 64 & 1) return true;
    return false;
}

static void form_is(const float form[3], const double row[3], double x, double y)
{
    assert_true(form[0] == (float)(row[0] * x + row[1] * y + row[2]));
    assert_true(form[1] == (float)row[0] && form[2] == (float)row[1]);
}

static void segment_is(const struct drawn_segment *s, const struct projected_segment *p, const struct depth_segment *d)
{
    const double x = p->x0 + 0.5, y = p->y0 + 0.5;
    assert_true(s->id == d->id && s->x0 == p->x0 && s->y0 == p->y0 && s->x1 == p->x1 && s->y1 == p->y1);
    assert_true(s->u0 == (float)p->u0 && s->v0 == (float)p->v0 && s->u1 == (float)p->u1 && s->v1 == (float)p->v1);
    form_is(s->u, p->from_target[0], x, y);
    form_is(s->v, p->from_target[1], x, y);
    form_is(s->w, p->from_target[2], x, y);
    form_is(s->inverse_z, p->inverse_z, x, y);
    assert_true(s->surface_gap == (float)(JOIN_SIGMAS * M_SQRT2 * fmax(d->sigma, SOFT_Z_MIN_SIGMA)));
}

/* Checks the segments of a tile; returns their number. */
static int check_tile(struct sheet *s, const struct view_relation *relation, int tile, const struct open_pixels *open)
{
    struct err err = ERR_INIT;
    int n = 0;
    assert_int_equal(drawn_tile_project(&s->tile, &s->drawn, tile, open, &err), ST_OK);
    for (int i = 0; i < s->depth.segment_count; i++) { /* in the order of the list */
        const struct depth_segment *d = &s->depth.segments[i];
        struct projected_segment p;
        if (!segment_project(&p, relation, d, &s->packed.shapes[i])) continue;
        if (!any_open(open, p.x0, p.y0, p.x1, p.y1)) continue;
        if (n >= s->tile.count) fail_msg("segment %d is not in tile %d", i, tile);
        const uint32_t at = s->tile.order[n++];
        assert_true(at < (uint32_t)s->tile.count);
        segment_is(&s->tile.segments[at], &p, d);
        assert_true(s->tile.sigmas[at] == fmaxf((float)d->sigma, SOFT_Z_MIN_SIGMA));
    }
    assert_int_equal(n, s->tile.count);
    return n;
}

/* Checks all tiles, wholly open and with few open pixels; returns the number of segments in the former. */
static int check(struct sheet *s, const struct view *view, const struct view *novel, uint64_t seed)
{
    const struct rng rng = rng_make(seed, "test", "open");
    struct view_relation relation;
    struct err err = ERR_INIT;
    int sum = 0;

    segment_relation_make(&relation, view, novel);
    assert_int_equal(drawn_view_prepare(&s->drawn, &s->depth, &s->packed, view, novel, &err), ST_OK);
    assert_int_equal(s->drawn.tile_count, TILES);
    for (int tile = 0; tile < TILES; tile++) {
        const struct open_pixels open = all_open(tile), few = some_open(tile, &rng, seed, 300),
                                 none = some_open(tile, &rng, seed, 1e12);
        const int count = check_tile(s, &relation, tile, &open);
        assert_true(count == 0 || drawn_view_has_tile(&s->drawn, tile));
        assert_true(check_tile(s, &relation, tile, &few) <= count);
        assert_int_equal(check_tile(s, &relation, tile, &none), 0);
        sum += count;
    }
    return sum;
}

static void tiles_get_the_segments_of_the_single_projection(void **state)
{
    (void)state;
    const struct rng rng = rng_make(1, "test", "cameras");
    struct sheet s = {.depth = {0}};
    int seen = 0, sum = 0;
    for (uint64_t i = 0; i < 240; i++) {
        static const double slopes[] = {0, 0.05, 0.6, 3}; /* up to planes whose horizon crosses the segment */
        double r[12];
        for (uint64_t k = 0; k < 12; k++) r[k] = 2 * rng_uniform(&rng, i, k) - 1;
        sheet_make(&s, i, slopes[i % 4]);
        const double wide = i % 3 ? 0.2 : 2;
        const struct view view = view_make(vec3_make(r[0], r[1], r[2]), turned(0.3 * r[3], 0.3 * r[4], 0.3 * r[5]));
        const struct vec3 shift = vec3_make(2 * r[6], 2 * r[7], 4 * r[8]); /* among the segments, and beyond them */
        const struct view novel =
            novel_make(vec3_add(view.center, shift), turned(wide * r[9], wide * r[10], wide * r[11]));
        const int count = check(&s, &view, &novel, i);
        seen += count > 0;
        sum += count;
        sheet_clear(&s);
    }
    sheet_release(&s);
    if (!(seen > 100 && sum > 10000)) fail_msg("%d cameras see %d segments", seen, sum);
}

static void hard_cameras_get_the_same_segments(void **state)
{
    (void)state;
    const struct view view = view_make(vec3_make(0, 0, 0), straight);
    for (uint64_t i = 0; i < 4; i++) {
        struct sheet s = {.depth = {0}};
        sheet_make(&s, i, i < 2 ? 0 : 1);
        struct view novel = novel_make(vec3_make(0, 0, 0), straight); /* the same centre */
        assert_true(check(&s, &view, &novel, i) > 50);
        novel = novel_make(vec3_make(0, 0, -6), straight); /* far behind: the whole sheet is in the picture */
        assert_true(check(&s, &view, &novel, i) > SEGMENTS / 2);
        novel = novel_make(vec3_make(0, 0, 40), straight); /* in front of everything */
        check(&s, &view, &novel, i);
        for (int k = 0; k < SEGMENTS; k += 7) { /* in a segment's plane, and in the box of its group */
            const struct depth_segment *d = &s.depth.segments[k];
            const struct segment_shape *shape = &s.packed.shapes[k];
            const double inverse = d->plane[0] * shape->u + d->plane[1] * shape->v + d->plane[2];
            if (!(inverse > 0)) continue;
            novel = novel_make(view_unproject(&view, shape->u, shape->v, 1 / inverse), straight);
            check(&s, &view, &novel, i);
            novel = novel_make(view_unproject(&view, shape->u + 2, shape->v, 1.02 / inverse), turned(0.1, 1, 0));
            check(&s, &view, &novel, i);
        }
        sheet_release(&s);
    }
}

static void a_view_of_other_things_costs_nothing(void **state)
{
    (void)state;
    struct sheet s = {.depth = {0}};
    struct err err = ERR_INIT;
    const struct view view = view_make(vec3_make(0, 0, 0), straight);
    const struct view away = novel_make(vec3_make(0, 0, 0), (struct quat){0, 0, 1, 0});
    const struct view beside = novel_make(vec3_make(40, 0, 0), straight);
    sheet_make(&s, 2, 0);
    assert_int_equal(drawn_view_prepare(&s.drawn, &s.depth, &s.packed, &view, &away, &err), ST_OK);
    assert_null(s.drawn.boxes);
    for (int tile = 0; tile < TILES; tile++) assert_false(drawn_view_has_tile(&s.drawn, tile));
    assert_int_equal(drawn_view_prepare(&s.drawn, &s.depth, &s.packed, &view, &beside, &err), ST_OK);
    assert_null(s.drawn.boxes);
    for (int tile = 0; tile < TILES; tile++) assert_false(drawn_view_has_tile(&s.drawn, tile));
    sheet_release(&s);
}

static void a_view_without_segments_is_empty(void **state)
{
    (void)state;
    const struct view view = view_make(vec3_make(0, 0, 0), straight), novel = novel_make(vec3_make(0, 0, 0), straight);
    for (int count = 0; count < 2; count++) { /* none; one that has no texels */
        struct sheet s = {.depth = {0}};
        struct err err = ERR_INIT;
        assert_int_equal(layered_depth_init(&s.depth, W, H, &err), ST_OK);
        s.depth.segments = calloc(1, sizeof *s.depth.segments);
        s.depth.segments[0] = (struct depth_segment){.id = 1, .plane = {0, 0, 0.25}, .sigma = 0.01};
        s.depth.segment_count = count;
        assert_int_equal(layer_view_pack(&s.packed, &s.depth, "v", &err), ST_OK);
        assert_int_equal(s.packed.group_count, 0);
        assert_int_equal(check(&s, &view, &novel, 1), 0);
        sheet_release(&s);
    }
}

static void planes_without_limits_do_not_hide_their_group(void **state)
{
    (void)state;
    const struct view view = view_make(vec3_make(0, 0, 0), straight);
    const struct view novel = novel_make(vec3_make(0.3, -0.1, 0.4), turned(0.05, 0.1, 0));
    struct sheet s = {.depth = {0}};
    struct err err = ERR_INIT;
    sheet_make(&s, 4, 0.05);
    const double bad[] = {1e300, INFINITY, NAN, 1e12, -1e300};
    struct layered_depth again; /* packing has freed the layers */
    assert_int_equal(layered_depth_init(&again, W, H, &err), ST_OK);
    for (size_t p = 0; p < W * H; p++) again.interior.id[p] = (uint32_t)(p / W / SIDE * COLUMNS + p % W / SIDE) + 1;
    again.segment_count = SEGMENTS;
    again.segments = calloc(SEGMENTS, sizeof *again.segments);
    memcpy(again.segments, s.depth.segments, SEGMENTS * sizeof *again.segments);
    for (int i = 3; i < SEGMENTS; i += 11) again.segments[i].plane[i % 3] = bad[i / 11 % 5];
    sheet_clear(&s);
    s.depth = again;
    assert_int_equal(layer_view_pack(&s.packed, &s.depth, "v", &err), ST_OK);
    assert_true(check(&s, &view, &novel, 4) > 50);
    sheet_release(&s);
}

static void a_box_is_open_where_one_of_its_pixels_is(void **state)
{
    (void)state;
    const struct rng rng = rng_make(2, "test", "boxes");
    int open_boxes = 0;
    for (uint64_t i = 0; i < 4000; i++) {
        const struct open_pixels open = some_open((int)(i % TILES), &rng, i, i % 2 ? 100 : 2000);
        double r[4];
        for (uint64_t k = 0; k < 4; k++) r[k] = rng_uniform(&rng, i, 1000000 + k);
        const int x0 = (int)(r[0] * TARGET_W) - 9, y0 = (int)(r[1] * TARGET_H) - 9;
        const int x1 = x0 + (int)(r[2] * 150), y1 = y0 + (int)(r[3] * 30);
        const bool is = any_open(&open, x0, y0, x1, y1);
        assert_true(open_pixels_any(&open, x0, y0, x1, y1) == is);
        open_boxes += is;
    }
    assert_true(open_boxes > 300 && open_boxes < 3000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_get_the_segments_of_the_single_projection),
        cmocka_unit_test(hard_cameras_get_the_same_segments),
        cmocka_unit_test(a_view_of_other_things_costs_nothing),
        cmocka_unit_test(a_view_without_segments_is_empty),
        cmocka_unit_test(planes_without_limits_do_not_hide_their_group),
        cmocka_unit_test(a_box_is_open_where_one_of_its_pixels_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
