/* cleared_box.c - floors below a box that an edit clears, against the floor that is known there. */
#include "tests/unit/common/texture/floor_views.h"

/* The floor has 64 x 64 texels. The box stands on its middle. Two cameras look down from its left and right, so that
 * their pixels lie on texels: what they show is exact, and what both of them miss is what the box stands on. */
enum { VIEWS = 2 };
static const double BOX_TOP = 0.5, BOX[2] = {1.5, 2.5}, RIM = 1.0 / 16;

/* The radiance of texel (x, y), x to the right and y down. */
typedef double floor_texel(int x, int y);

static double plain(int x, int y)
{
    (void)x, (void)y;
    return 0.4;
}

/* The light doubles from left to right. */
static double slope(int x, int y)
{
    (void)y;
    return 0.3 * exp2((double)x / SIZE);
}

/* Boards of 8 texels along y, whose shades differ. */
static double boards(int x, int y)
{
    static const double shades[4] = {0.2, 0.5, 0.3, 0.7};
    (void)y;
    return shades[x / 8 % 4];
}

/* Bricks of 8 x 4 texels with joints of one texel, each row shifted by half a brick. */
static double bricks(int x, int y)
{
    const int row = y / 4, in = (x + 4 * (row % 2)) % 8;
    return y % 4 == 0 || in == 0 ? 0.6 : 0.25;
}

/* Whether the box, or its rim, stands between a camera at (x, y) and a place of the floor. */
static bool is_hidden(double x, double y, double fx, double fy)
{
    double from = 0, to = BOX_TOP / HEIGHT; /* of the way from the floor to the camera: below the top */
    const double at[2] = {fx, fy}, step[2] = {x - fx, y - fy};
    for (int k = 0; k < 2; k++) {
        const double low = BOX[0] - RIM - at[k], high = BOX[1] + RIM - at[k];
        if (fabs(step[k]) < 1e-9) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        from = fmax(from, fmin(low / step[k], high / step[k]));
        to = fmin(to, fmax(low / step[k], high / step[k]));
    }
    return from <= to;
}

static void make_view(struct source_view *v, double x, double y, floor_texel *texel)
{
    floor_view(v, x, y);
    for (int i = 0; i < SIZE * SIZE; i++) {
        const double fx = x + (i % SIZE + 0.5 - 32) * HEIGHT / FOCAL, fy = y - (i / SIZE + 0.5 - 32) * HEIGHT / FOCAL;
        const bool hidden = is_hidden(x, y, fx, fy);
        v->id[i] = fx >= 0 && fy >= 0 && fx <= 4 && fy <= 4 ? ID : 0;
        v->state[i] = hidden ? SOURCE_HIDDEN : SOURCE_CLEAN;
        for (int k = 0; k < 3 && v->id[i]; k++) /* the box is orange */
            v->levels[0].rgba[4 * i + k] =
                hidden ? 0.8f - 0.3f * (float)k
                       : (float)texel((int)(fx * FOCAL / HEIGHT), (int)((4 - fy) * FOCAL / HEIGHT));
        v->levels[0].rgba[4 * i + 3] = 1;
    }
}

/* A tile of the whole floor, seen orthogonally. */
static struct bake_tile floor_tile(void)
{
    struct bake_tile t = {.view = -1, .side = HEIGHT / FOCAL};
    const double q = HEIGHT / FOCAL;
    const double m[3][4] = {{1 / q, 0, 0, 0}, {0, -1 / q, 0, SIZE}, {0, 0, 0, 1}};
    memcpy(t.matrix, m, sizeof m);
    t.raster = (struct surface_raster){SIZE, SIZE, {{q, 0, 0}, {0, -q, 4}, {0, 0, 0}, {0, 0, 1}}};
    return t;
}

/* Bakes the floor; returns the largest relative error of what views show and, in *filled, of what the box hides. */
static double clear_box(double *filled, floor_texel *texel, size_t most)
{
    static const char *const names[] = {"a", "b"};
    static const int groups[] = {0, 1};
    static const bool own[] = {false, false};
    const struct texture_params params = TEXTURE_PARAMS_DEFAULT;
    struct bake b = {.surfaces = &floor_only, .params = &params, .white = 1};
    struct source_view views[VIEWS];
    struct bake_totals totals;
    struct err err = ERR_INIT;
    double seen = 0;
    assert_ok(bake_add_tile(&b, floor_tile(), &err), err);
    memset(b.role, TEXEL_WANTED, SIZE * SIZE);
    assert_ok(bake_set_sources(&b, names, groups, own, VIEWS, &err), err);
    assert_ok(bake_list_texels(&b, &err), err);
    for (int i = 0; i < VIEWS; i++) {
        make_view(&views[i], 1 + 2 * i, 2, texel);
        bake_add_view(&b, &views[i], i);
    }
    assert_ok(bake_find_gains(&b, &err), err);
    bake_choose(&b);
    assert_ok(bake_composite(&b, &totals, &err), err);
    assert_in_range(totals.synthesised, 256, most); /* the foot of the box, its rim, and whole bricks beside it */
    *filled = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        for (int k = 0; k < 3; k++) {
            double *worst = b.made[i] == ATLAS_SYNTHESISED ? filled : &seen;
            *worst = fmax(*worst, fabs((double)b.rgb[3 * i + k] / texel(i % SIZE, i / SIZE) - 1));
        }
    for (int i = 0; i < VIEWS; i++) source_view_release(&views[i]);
    bake_release(&b);
    print_message("worst seen %.6f, filled %.6f\n", seen, *filled);
    return seen;
}

static void below_a_box_a_plain_floor_goes_on_exactly(void **state)
{
    double filled;
    (void)state;
    assert_true(clear_box(&filled, plain, 20 * 20) < 1e-5);
    assert_true(filled < 1e-5);
}

static void below_a_box_a_slope_of_light_goes_on(void **state)
{
    double filled;
    (void)state;
    assert_true(clear_box(&filled, slope, 20 * 20) < 1e-4);
    assert_true(filled < 1e-2);
}

static void below_a_box_boards_go_on_in_their_phase(void **state)
{
    double filled;
    (void)state;
    assert_true(clear_box(&filled, boards, 20 * 20) < 1e-4);
    assert_true(filled < 1e-4);
}

static void below_a_box_bricks_go_on_in_their_phase(void **state)
{
    double filled;
    (void)state;
    assert_true(clear_box(&filled, bricks, 36 * 36) < 1e-4);
    assert_true(filled < 1e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(below_a_box_a_slope_of_light_goes_on),
        cmocka_unit_test(below_a_box_boards_go_on_in_their_phase),
        cmocka_unit_test(below_a_box_bricks_go_on_in_their_phase),
        cmocka_unit_test(below_a_box_a_plain_floor_goes_on_exactly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
