/* The edge of an old patch of sun: the photograph has it beside where it is computed. */
#include "stages/relight/penumbra.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "tests/unit/common/light/near.h"

enum { WIDTH = 160, HEIGHT = 120, PIXELS = WIDTH * HEIGHT };
static const double REST = 1, SUN = 1.5; /* irradiance without the sun, and from it */

/* A floor in which each pixel has its own albedo. */
struct floor {
    uint8_t kind[PIXELS];
    int face[PIXELS];
    float quotient[PIXELS][4], was[PIXELS][4], matt[PIXELS][3];
    double albedo[PIXELS], left[PIXELS]; /* left: log of what should be 1 after the division, before the fit */
    struct irradiance before[PIXELS];
    struct pixels pixels;
    struct penumbra_stats stats;
};

/* A patch of sun with a rim `half` wide on either side, about a slanted rectangle. */
struct patch {
    double shift, half; /* px, to the lit side */
};

static double ramp(double t, double half) { return 0.5 + 0.5 * sin(clamp(t / half, -1, 1) * PI / 2); }

static double seen_part(const struct patch *p, int x, int y)
{
    static const double angle = 0.3;
    const double u = cos(angle) * (x - 80) + sin(angle) * (y - 60), v = cos(angle) * (y - 60) - sin(angle) * (x - 80);
    return ramp(42 - p->shift - fabs(u), p->half) * ramp(28 - p->shift - fabs(v), p->half);
}

static double noise(int i)
{
    const struct rng rng = rng_make(7, "test", "noise");
    uint32_t bits[4];
    rng_block(&rng, 0, (uint64_t)i, bits);
    return bits[0] * 0x1p-32 - 0.5;
}

/* Boards with dark joints. */
static double albedo_at(int x, int y, double texture)
{
    const int board = y / 11;
    const double joint = y % 11 ? 1 : 0.6;
    return 0.4 * exp(texture * (0.3 * noise(board) + 0.2 * noise(1000 + y * WIDTH + x) + log(joint)));
}

static struct floor *make_floor(const struct patch *computed, const struct patch *photographed, double texture)
{
    struct floor *f = calloc(1, sizeof *f);
    assert_non_null(f);
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        const double before = REST + SUN * seen_part(computed, x, y);
        const double light = photographed ? REST + SUN * seen_part(photographed, x, y) : REST;
        f->kind[i] = PIXEL_TEXTURE;
        f->albedo[i] = albedo_at(x, y, texture);
        f->before[i].value = rgb_grey(before);
        for (int k = 0; k < 3; k++) {
            f->matt[i][k] = (float)(f->albedo[i] * light / PI);
            f->quotient[i][k] = (float)(REST / before);
        }
        f->quotient[i][3] = RELIT_SURE;
        f->left[i] = log(light / before);
    }
    memcpy(f->was, f->quotient, sizeof f->was);
    f->pixels = (struct pixels){WIDTH, HEIGHT, .kind = f->kind, .face = f->face};
    return f;
}

static void fit(struct floor *f)
{
    const struct relight_params params = RELIGHT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    assert_ok(penumbra_fit(f->quotient, &f->stats, f->matt, f->before, &f->pixels, &params, &err), err);
}

/* Log of what is left of the patch at a pixel: 0 if the relit floor has the light without the sun. */
static double left_at(const struct floor *f, int i)
{
    return log((double)f->matt[i][1] * (double)f->quotient[i][1] * PI / (f->albedo[i] * REST));
}

struct outline {
    double most, mean_square[2]; /* now, and before the fit */
    double most_before;
};

/* corners: within so many pixels of a corner of the patch counts apart. */
static struct outline outline_of(const struct floor *f, bool corners)
{
    struct outline o = {0};
    for (int i = 0; i < PIXELS; i++) {
        const double angle = 0.3, x = i % WIDTH - 80, y = i / WIDTH - 60;
        const double u = fabs(cos(angle) * x + sin(angle) * y), v = fabs(cos(angle) * y - sin(angle) * x);
        const bool is_corner = fabs(u - 42) < 12 && fabs(v - 28) < 12;
        const double left = left_at(f, i);
        if (is_corner != corners) continue;
        o.most = fmax(o.most, fabs(left));
        o.most_before = fmax(o.most_before, fabs(f->left[i]));
        o.mean_square[0] += left * left / PIXELS;
        o.mean_square[1] += f->left[i] * f->left[i] / PIXELS;
    }
    return o;
}

/* Outlines of a fifth to more than a half of the light become outlines of 2 %, on boards with dark joints. At corners,
 * which blur rounds off, seven eighths of the squares go. */
static void outline_of_an_old_patch_goes(void **state)
{
    static const struct patch computed = {0, 3};
    static const struct {
        struct patch photographed;
        double texture;
    } cases[] = {{{2.3, 4.2}, 0.2}, {{-2.3, 4.2}, 0.2}, {{3, 2}, 0.1}, {{-1.2, 3}, 0.2}, {{0, 5}, 0.2}};
    (void)state;
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        struct floor *f = make_floor(&computed, &cases[n].photographed, cases[n].texture);
        fit(f);
        const struct outline edge = outline_of(f, false), corner = outline_of(f, true);
        assert_true(edge.most_before > log(1.5) || n > 2);
        assert_true(edge.most < (n < 4 ? 0.021 : 0.025));
        assert_true(edge.mean_square[0] < edge.mean_square[1] / 49);
        assert_true(corner.mean_square[0] < corner.mean_square[1] / 8);
        assert_true(f->stats.fitted > 0.9 * f->stats.points);
        free(f);
    }
}

/* Where the photograph has no edge, nothing tells where the old one was. */
static void without_evidence_nothing_changes(void **state)
{
    static const struct patch computed = {0, 3};
    (void)state;
    for (int n = 0; n < 5; n++) {
        struct floor *f = make_floor(&computed, NULL, 0.5 * n);
        fit(f);
        assert_true(f->stats.points > 200);
        assert_int_equal(f->stats.fitted, 0);
        assert_memory_equal(f->quotient, f->was, sizeof f->was);
        free(f);
    }
}

/* The edges of a new patch, and of an old one that stays, are not the photograph's to tell. */
static void edges_that_are_new_or_stay_do_not_move(void **state)
{
    static const struct patch computed = {0, 3}, photographed = {2.3, 4.2};
    (void)state;
    for (int n = 0; n < 2; n++) {
        struct floor *f = make_floor(&computed, n ? &photographed : NULL, 0.3);
        for (int i = 0; i < PIXELS; i++)
            for (int k = 0; k < 3; k++) f->was[i][k] = f->quotient[i][k] = n ? 1.3f : 1 / f->quotient[i][k];
        for (int i = 0; i < PIXELS && !n; i++) f->before[i].value = rgb_grey(REST);
        fit(f);
        assert_int_equal(f->stats.points, 0);
        assert_memory_equal(f->quotient, f->was, sizeof f->was);
        free(f);
    }
}

static void a_right_edge_stays_bit_for_bit(void **state)
{
    static const struct patch patch = {0, 3};
    struct floor *f = make_floor(&patch, &patch, 0.2);
    (void)state;
    fit(f);
    assert_true(f->stats.points > 200);
    assert_int_equal(f->stats.fitted, 0);
    assert_memory_equal(f->quotient, f->was, sizeof f->was);
    free(f);
}

/* The photograph's edge lies further off than is allowed. */
static void a_shift_beyond_the_limit_is_left(void **state)
{
    static const struct patch computed = {0, 3}, photographed = {9, 3};
    struct floor *f = make_floor(&computed, &photographed, 0.1);
    (void)state;
    fit(f);
    assert_true(f->stats.points > 200);
    assert_memory_equal(f->quotient, f->was, sizeof f->was);
    free(f);
}

static void threads_do_not_change_a_bit(void **state)
{
    static const struct patch computed = {0, 3}, photographed = {2.3, 4.2};
    struct floor *f[2];
    (void)state;
    for (int n = 0; n < 2; n++) {
        f[n] = make_floor(&computed, &photographed, 0.3);
        parallel_set_threads(n ? 4 : 1);
        fit(f[n]);
    }
    parallel_set_threads(0);
    assert_memory_equal(f[0]->quotient, f[1]->quotient, sizeof f[0]->quotient);
    assert_true(memcmp(f[0]->quotient, f[0]->was, sizeof f[0]->was) != 0);
    free(f[0]);
    free(f[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outline_of_an_old_patch_goes),           cmocka_unit_test(without_evidence_nothing_changes),
        cmocka_unit_test(edges_that_are_new_or_stay_do_not_move), cmocka_unit_test(a_right_edge_stays_bit_for_bit),
        cmocka_unit_test(a_shift_beyond_the_limit_is_left),       cmocka_unit_test(threads_do_not_change_a_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
