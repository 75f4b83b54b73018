/* The edge of an old patch of sun: the photograph has it beside where it is computed. */
#include "stages/relight/penumbra.h"

#include <math.h>
#include <stdlib.h>

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

/* The aim: an outline of half the light becomes one of at most 2 %. */
static void outline_of_an_old_patch_goes(void **state)
{
    static const struct patch computed = {0, 3}, photographed = {2.3, 4.2};
    struct floor *f = make_floor(&computed, &photographed, 0.3);
    (void)state;
    fit(f);
    const struct outline edge = outline_of(f, false), corner = outline_of(f, true);
    printf("edges: %.3f -> %.4f, rms %.4f -> %.4f; corners: %.3f -> %.3f; %d of %d, %.2f px\n", edge.most_before,
           edge.most, sqrt(edge.mean_square[1]), sqrt(edge.mean_square[0]), corner.most_before, corner.most,
           f->stats.fitted, f->stats.points, f->stats.shift);
    assert_true(edge.most_before > log(1.5));
    assert_true(edge.most < 0.02);
    free(f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outline_of_an_old_patch_goes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
