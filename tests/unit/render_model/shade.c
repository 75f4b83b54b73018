/* shade.c - look-ups in tiles: bilinear sums, bounds, several tiles, the nearest texel. */
#include "stages/render_model/shade_tiles.h"

#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"

enum { SIDE = 40, STRIDE = SIDE + 2 };

/* A tile with texels of a formula, some of them missing. */
struct made_tile {
    uint16_t texels[STRIDE * STRIDE * 4 + 8];
    uint8_t made[STRIDE * STRIDE];
    struct shade_tile tile;
};

static float value_at(int x, int y, int channel) { return (float)(x * x + 3 * y + channel); }

static void make_tile(struct made_tile *m, bool (*exists)(int x, int y), float more, enum picture_made made)
{
    memset(m, 0, sizeof *m);
    m->tile = (struct shade_tile){{1, 0, 0.5}, {0, 1, 0.5}, {0, 0, 1}, SIDE, SIDE, STRIDE, m->texels, m->made, false};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int at = (y + 1) * STRIDE + x + 1;
            if (exists && !exists(x, y)) continue;
            m->made[at] = (uint8_t)made;
            for (int c = 0; c < 4; c++) m->texels[4 * at + c] = half_from_float(c < 3 ? value_at(x, y, c) + more : 1);
        }
}

/* Looks up the eight pixels from (8 column, row) on. */
static unsigned find(struct texels *t, struct tile_lanes *list, int *count, const struct shade_tile *tiles, int given,
                     int column, int row)
{
    *count = tile_lanes_make(list, tiles, given, 0, 0, 64);
    return tile_texels_find(t, list, *count, 0xff, (float)row, (float)(8 * column));
}

/* The bilinear sum over texels that exist; false: there is none. */
static bool wanted_value(float *value, double x, double y, bool (*exists)(int x, int y), int channel)
{
    const double px = floor(x * 256 + 0.5) / 256 - 0.5, py = floor(y * 256 + 0.5) / 256 - 0.5; /* steps of 1/256 */
    double sum = 0, total = 0;
    for (int k = 0; k < 4; k++) {
        const int ix = (int)floor(px) + (k & 1), iy = (int)floor(py) + (k >> 1);
        const double weight =
            (k & 1 ? px - floor(px) : 1 - px + floor(px)) * (k >> 1 ? py - floor(py) : 1 - py + floor(py));
        if (ix < 0 || iy < 0 || ix >= SIDE || iy >= SIDE || (exists && !exists(ix, iy))) continue;
        sum += weight * value_at(ix, iy, channel);
        total += weight;
    }
    *value = (float)(sum / total);
    return total > 0;
}

static bool with_holes(int x, int y) { return (x / 3 + y / 4) % 3 != 0; }

static void look_ups_are_bilinear_over_the_texels_that_exist(void **state)
{
    (void)state;
    static struct made_tile m;
    struct tile_lanes list[1];
    struct texels t;
    for (int holes = 0; holes < 2; holes++) {
        int found_all = 0;
        make_tile(&m, holes ? with_holes : NULL, 0, MADE_ORIGINAL);
        m.tile.x = (struct linear){0.61, 0.13, -3.07};
        m.tile.y = (struct linear){-0.09, 0.72, 1.33};
        m.tile.w = (struct linear){0.004, -0.003, 1.1};
        for (int row = 0; row < 64; row++)
            for (int column = 0; column < 8; column++) {
                int count;
                const unsigned found = find(&t, list, &count, &m.tile, 1, column, row);
                for (int k = 0; k < 8; k++) {
                    const int px = 8 * column + k;
                    const double w = linear_at(&m.tile.w, px, row);
                    const double x = linear_at(&m.tile.x, px, row) / w, y = linear_at(&m.tile.y, px, row) / w;
                    const double edge = fmin(fmin(x, SIDE - x), fmin(y, SIDE - y));
                    float wanted;
                    if (fabs(edge) < 1e-4) continue;
                    const bool there = edge > 0 && wanted_value(&wanted, x, y, holes ? with_holes : NULL, 0);
                    assert_int_equal(found >> k & 1, there);
                    if (!there) continue;
                    assert_true(fabsf(((float *)&t.rgba[k])[0] - wanted) < 0.4f); /* 1/256 texel of slope 80 */
                    assert_true(((float *)&t.rgba[k])[3] == 1);
                    found_all++;
                }
            }
        assert_true(found_all > 800);
    }
}

static void a_look_up_at_a_texels_centre_is_that_texel(void **state)
{
    (void)state;
    static struct made_tile m;
    struct tile_lanes list[1];
    struct texels t;
    make_tile(&m, NULL, 0, MADE_ORIGINAL);
    m.tile.w.origin = 1 + 3e-7; /* rounding */
    m.tile.x.origin += 1e-5;
    for (int column = 0; column < SIDE / 8; column++) {
        int count;
        assert_int_equal(find(&t, list, &count, &m.tile, 1, column, 7), 0xff);
        for (int k = 0; k < 8; k++)
            for (int c = 0; c < 3; c++)
                assert_true(((float *)&t.rgba[k])[c] ==
                            float_from_half(half_from_float(value_at(8 * column + k, 7, c))));
    }
}

static void pixels_with_w_of_zero_or_below_have_no_texel(void **state)
{
    (void)state;
    static struct made_tile m;
    struct tile_lanes list[1];
    struct texels t;
    int count;
    make_tile(&m, NULL, 0, MADE_ORIGINAL);
    m.tile.w = (struct linear){1, 0, -3}; /* 0 at column 3 */
    m.tile.x = (struct linear){5, 0, -15};
    m.tile.y = (struct linear){7, 0, -21}; /* 0 / 0 there, (5, 7) elsewhere */
    assert_int_equal(find(&t, list, &count, &m.tile, 1, 0, 0), 0xf0);
    m.tile.x = (struct linear){0, 0, 5}; /* x / 0: infinite */
    m.tile.y = (struct linear){0, 0, 5};
    assert_int_equal(find(&t, list, &count, &m.tile, 1, 0, 0), 0xf0);
    m.tile.w = (struct linear){0, 0, 0};
    assert_int_equal(find(&t, list, &count, &m.tile, 1, 0, 0), 0);
}

static bool left_half(int x, int y)
{
    (void)y;
    return x < SIDE / 2;
}

static void of_several_tiles_the_deepest_with_a_texel_is_taken(void **state)
{
    (void)state;
    static struct made_tile a, b, c;
    struct tile_lanes list[3];
    struct texels t;
    int count;
    make_tile(&a, left_half, 0, MADE_ORIGINAL);
    make_tile(&b, NULL, 10000, MADE_WARPED);
    b.tile.x.origin += 4; /* so column 35 is at its edge, and a's is deeper on the left */
    struct shade_tile tiles[3] = {a.tile, b.tile};
    assert_int_equal(find(&t, list, &count, tiles, 2, 1, 20), 0xff); /* columns 8 to 15 */
    for (int k = 0; k < 8; k++)                                      /* b is deeper: it looks 4 texels further in */
        assert_int_equal(texels_made(&t, list, k), MADE_WARPED);
    assert_int_equal(find(&t, list, &count, tiles, 2, 3, 20), 0xff); /* 24 to 31: a is deeper, but has no texel */
    for (int k = 0; k < 8; k++) assert_int_equal(texels_made(&t, list, k), MADE_WARPED);
    tiles[0].own = true;
    assert_int_equal(find(&t, list, &count, tiles, 2, 1, 20), 0xff);
    for (int k = 0; k < 8; k++) assert_int_equal(texels_made(&t, list, k), MADE_ORIGINAL);
    make_tile(&c, NULL, 0, MADE_SYNTHESISED);
    tiles[2] = c.tile;
    tiles[2].own = tiles[0].own = true;
    tiles[2].x.origin += 0.25;
    assert_int_equal(find(&t, list, &count, tiles, 3, 3, 20), 0xff);
    for (int k = 0; k < 8; k++) assert_int_equal(texels_made(&t, list, k), MADE_SYNTHESISED);
}

/* Two tiles of one picture, cut with a shared column: the look-up does not jump at the cut. */
static void tiles_that_share_a_border_texel_meet_without_a_step(void **state)
{
    (void)state;
    static struct made_tile left, right;
    struct tile_lanes list[2];
    struct texels t;
    int count;
    make_tile(&left, NULL, 0, MADE_ORIGINAL);
    make_tile(&right, NULL, 0, MADE_ORIGINAL);
    for (int y = 0; y < SIDE; y++) /* its column x is column x + SIDE - 1 of the picture */
        for (int x = 0; x < SIDE; x++)
            right.texels[4 * ((y + 1) * STRIDE + x + 1)] = half_from_float(value_at(x + SIDE - 1, y, 0));
    struct shade_tile tiles[2] = {left.tile, right.tile};
    for (int i = 0; i < 2; i++) tiles[i].x = (struct linear){0.11, 0, i ? 36.3 - (SIDE - 1) : 36.3};
    float before = 0;
    for (int px = 0; px < 56; px++) {
        if (px % 8 == 0) assert_int_equal(find(&t, list, &count, tiles, 2, px / 8, 5), 0xff);
        const float now = ((float *)&t.rgba[px % 8])[0];
        assert_true(!px || (now > before && now - before < 10.5f)); /* 0.11 texels of slope 2 x 43, and rounding */
        before = now;
    }
}

static void no_pixel_that_looks_into_a_tile_is_left_out(void **state)
{
    (void)state;
    static struct made_tile m;
    const struct rng rng = rng_make(5, "tiles", "culling");
    int kept = 0, seen = 0;
    make_tile(&m, NULL, 0, MADE_ORIGINAL);
    for (int i = 0; i < 3000; i++) {
        struct linear *of[3] = {&m.tile.x, &m.tile.y, &m.tile.w};
        for (int k = 0; k < 9; k++) {
            const double random = rng_uniform(&rng, (uint64_t)i, (uint64_t)k) - 0.5;
            double *to = k % 3 == 0 ? &of[k / 3]->x : k % 3 == 1 ? &of[k / 3]->y : &of[k / 3]->origin;
            *to = random * (k / 3 == 2 ? 1 : 60) * (k % 3 == 2 ? 3 : 0.05);
        }
        bool inside = false;
        for (int p = 0; p < 64 * 64 && !inside; p++) {
            const double w = linear_at(&m.tile.w, p % 64, p / 64);
            const double x = linear_at(&m.tile.x, p % 64, p / 64) / w, y = linear_at(&m.tile.y, p % 64, p / 64) / w;
            inside = w > 0 && x >= 0 && y >= 0 && x <= SIDE && y <= SIDE;
        }
        const bool misses = shade_tile_misses(&m.tile, 0, 0, 63, 63);
        assert_false(misses && inside);
        kept += !misses;
        seen += inside;
    }
    assert_true(seen > 200 && kept < 2 * seen);
}

static bool few(int x, int y) { return (x * 7 + y * 13) % 29 == 0 && x > 5; }

static void the_nearest_texel_is_that_of_a_search_of_all(void **state)
{
    (void)state;
    static struct made_tile m;
    make_tile(&m, few, 0, MADE_WARPED);
    m.tile.x = (struct linear){1.7, 0, -20.3};
    m.tile.y = (struct linear){0, 1.9, -15.2};
    const struct tile_lanes list[1] = {
        {lanes_from(&m.tile.x, 0, 0), lanes_from(&m.tile.y, 0, 0), lanes_from(&m.tile.w, 0, 0), &m.tile, false}};
    for (int p = 0; p < 64 * 64; p++) {
        const double x = linear_at(&m.tile.x, p % 64, p / 64), y = linear_at(&m.tile.y, p % 64, p / 64);
        const double px = fmin(fmax(x, 0), SIDE), py = fmin(fmax(y, 0), SIDE);
        double least = INFINITY, second = INFINITY;
        float rgb[3], wanted = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            if (!few(i % SIDE, i / SIDE)) continue;
            const double away = hypot(i % SIDE + 0.5 - px, i / SIDE + 0.5 - py);
            if (away < least) {
                second = least, least = away;
                wanted = float_from_half(half_from_float(value_at(i % SIDE, i / SIDE, 0)));
            } else if (away < second)
                second = away;
        }
        assert_true(tile_texel_nearest(rgb, list, 1, p % 8, (float)(p / 64), (float)(p % 64 / 8 * 8)));
        if (second - least > 1e-4) assert_true(rgb[0] == wanted);
    }
    make_tile(&m, NULL, 0, MADE_NOTHING);
    float rgb[3];
    assert_false(tile_texel_nearest(rgb, list, 1, 0, 0, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(look_ups_are_bilinear_over_the_texels_that_exist),
        cmocka_unit_test(a_look_up_at_a_texels_centre_is_that_texel),
        cmocka_unit_test(pixels_with_w_of_zero_or_below_have_no_texel),
        cmocka_unit_test(of_several_tiles_the_deepest_with_a_texel_is_taken),
        cmocka_unit_test(tiles_that_share_a_border_texel_meet_without_a_step),
        cmocka_unit_test(no_pixel_that_looks_into_a_tile_is_left_out),
        cmocka_unit_test(the_nearest_texel_is_that_of_a_search_of_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
