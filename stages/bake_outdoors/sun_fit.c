/* sun_fit.c - the sun's direction and size from the edges of its patches.
 *
 * Overview. At the edge of a patch the sun's disk rises behind the window's edge, so that the light grows over a width
 * that the disk's size decides. Each square sees a share v of the disk. Of a pair of squares, which have nearly the
 * same light otherwise, the logarithm of the quotient should be log((1 + q v_a) / (1 + q v_b)), with q the sun's light
 * over the other light. Direction and radius are those with the least sum of absolute deviations over all pairs, each
 * cut off at CUT; q is the best of a list for each tile, since it depends on the angle to the surface.
 *
 * Mathematics. The sum is nearly smooth in the direction, with a rough surface from texture. It is evaluated on a grid
 * of GRID x GRID directions around the best one so far, and a quadratic in two variables is fitted to it; its minimum
 * is the next direction, and the grid shrinks. The interval comes from leaving out one part of space in turn [Efron
 * 1982, the jackknife]: the sums of each part are kept, so that no ray is traced again.
 *
 * Source: none for this form. */
#include "stages/bake_outdoors/sun_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

enum { GRID = 5, PLACES = GRID * GRID, PARTS = 8, DISK = 12, ROUNDS = 3, QUOTIENTS = 13 };
static const double CUT = 1.2;      /* of a logarithm */
static const double GRAZING = 0.05; /* cosine: surfaces that the sun only grazes count as unlit */
static const double WIDEST = 0.8;   /* degrees between neighbours of the first grid */
static const double PART = 12;      /* squares: the side of a part */
static const double quotients[QUOTIENTS] = {0, 0.1, 0.2, 0.35, 0.5, 0.75, 1, 1.5, 2.5, 4, 7, 12, 20};
static const double radii[] = {0.27, 0.5, 0.75, 1, 1.25, 1.5, 2, 2.5};

struct vec3 sun_aside(struct vec3 d, double angle, double degrees)
{
    const struct vec3 side = fabs(d.z) < 0.999 ? vec3_normalize(vec3_make(-d.y, d.x, 0)) : vec3_make(1, 0, 0);
    const struct vec3 up = vec3_cross(d, side);
    const double t = tan(degrees * DEGREE);
    return vec3_normalize(vec3_add(d, vec3_add(vec3_scale(side, t * cos(angle)), vec3_scale(up, t * sin(angle)))));
}

/* Evenly spread points of a disk [Vogel 1979]. */
static struct vec3 disk_direction(struct vec3 d, double radius, int k)
{
    return sun_aside(d, k * 2.399963229728653, radius * sqrt((k + 0.5) / DISK));
}

void sun_shares(float *share, const struct atlas_squares *texels, const struct model_rays *model, struct vec3 direction,
                double radius)
{
    struct vec3 disk[RAY_PACKET * ((DISK + RAY_PACKET - 1) / RAY_PACKET)], from[RAY_PACKET];
    double reach[RAY_PACKET];
    for (int k = 0; k < DISK; k++) disk[k] = disk_direction(direction, radius, k);
    for (int k = 0; k < RAY_PACKET; k++) reach[k] = INFINITY;
    for (int i = 0; i < texels->count; i++) {
        const struct atlas_square *t = &texels->list[i];
        share[i] = 0;
        if (!(vec3_dot(t->normal, direction) > GRAZING)) continue;
        int seen = 0;
        for (int k = 0; k < RAY_PACKET; k++) from[k] = vec3_add(t->at, vec3_scale(t->normal, 4 * model->rays.epsilon));
        for (int first = 0; first < DISK; first += RAY_PACKET) {
            const int count = DISK - first < RAY_PACKET ? DISK - first : RAY_PACKET;
            const unsigned active = (1u << count) - 1;
            seen +=
                count - __builtin_popcount(ray_scene_blocked_packet(&model->rays, from, disk + first, reach, active));
        }
        share[i] = (float)seen / DISK;
    }
}

/* ----------------------------------------------------------------------------------------------- sums of deviations */

struct fitting {
    const struct atlas_squares *texels;
    const struct model_rays *model;
    uint8_t *parts;     /* of each pair; owned */
    float *differences; /* of each pair: the logarithm of a to b; owned */
    double sign;        /* -1: the sun makes dark */
};

/* The deviations of a part's pairs, at one place of the grid; and of its pairs if there were no sun. */
struct sums {
    double with[PARTS], without[PARTS];
};

static double expected_of(const struct atlas_pair *p, const float *share, double quotient)
{
    return log((1 + quotient * (double)share[p->a]) / (1 + quotient * (double)share[p->b]));
}

static double left_of(const struct fitting *f, int pair, const float *share, double quotient)
{
    return (double)f->differences[pair] - expected_of(&f->texels->pairs[pair], share, quotient);
}

static double cut(double x) { return fmin(fabs(x), CUT); }

/* Adds the pairs from first to end, all of one tile, with the quotient that suits them best. */
static void add_tile(struct sums *s, const struct fitting *f, const float *share, int first, int end)
{
    double best[PARTS] = {0}, none[PARTS] = {0}, least = INFINITY;
    for (int q = 0; q < QUOTIENTS; q++) {
        double sums[PARTS] = {0}, total = 0;
        for (int i = first; i < end; i++) {
            const struct atlas_pair *p = &f->texels->pairs[i];
            const double a = (double)share[p->a], b = (double)share[p->b];
            if (a == b) continue;
            const double expected = f->sign * log((1 + quotients[q] * a) / (1 + quotients[q] * b));
            const double deviation = cut((double)f->differences[i] - expected);
            sums[f->parts[i]] += deviation;
            total += deviation;
        }
        if (q == 0) memcpy(none, sums, sizeof none);
        if (!(total < least)) continue;
        least = total;
        memcpy(best, sums, sizeof best);
    }
    for (int k = 0; k < PARTS; k++) {
        s->with[k] += best[k];
        s->without[k] += none[k];
    }
}

static void add_pairs(struct sums *s, const struct fitting *f, const float *share)
{
    const struct atlas_squares *t = f->texels;
    *s = (struct sums){{0}, {0}};
    for (int first = 0, i = 0; i < t->pair_count; i++) {
        const int tile = t->list[t->pairs[first].a].tile;
        if (i + 1 < t->pair_count && t->list[t->pairs[i + 1].a].tile == tile) continue;
        add_tile(s, f, share, first, i + 1);
        first = i + 1;
    }
}

/* What a sun gains: how much smaller the deviations are than without it. */
static double gain_of(const struct sums *s, int left_out)
{
    double gain = 0;
    for (int k = 0; k < PARTS; k++) gain += k == left_out ? 0 : s->without[k] - s->with[k];
    return gain;
}

/* --------------------------------------------------------------------------------------------------------- the grid */

struct grid {
    const struct fitting *fit;
    struct vec3 middle;
    double step, radius;
    float *shares; /* a thread's own part of it has texels->count elements */
    struct sums sums[PLACES];
};

static struct vec3 grid_direction(const struct grid *g, double x, double y)
{
    return sun_aside(g->middle, atan2(y, x), g->step * hypot(x, y));
}

static void sum_range(void *ctx, size_t begin, size_t end, int thread)
{
    struct grid *g = ctx;
    float *share = g->shares + (size_t)thread * (size_t)(g->fit->texels->count + 1);
    for (size_t i = begin; i < end; i++) {
        const int x = (int)(i % GRID) - GRID / 2, y = (int)(i / GRID) - GRID / 2;
        sun_shares(share, g->fit->texels, g->fit->model, grid_direction(g, x, y), g->radius);
        add_pairs(&g->sums[i], g->fit, share);
    }
}

/* Solves a x = b by elimination with pivots; a is 6 x 6. False: it is singular. */
static bool solve(double x[6], double a[6][7])
{
    for (int k = 0; k < 6; k++) {
        int pivot = k;
        for (int r = k + 1; r < 6; r++)
            if (fabs(a[r][k]) > fabs(a[pivot][k])) pivot = r;
        if (!(fabs(a[pivot][k]) > 1e-12)) return false;
        for (int c = 0; c < 7; c++) {
            const double t = a[k][c];
            a[k][c] = a[pivot][c];
            a[pivot][c] = t;
        }
        for (int r = k + 1; r < 6; r++) {
            const double factor = a[r][k] / a[k][k];
            for (int c = k; c < 7; c++) a[r][c] -= factor * a[k][c];
        }
    }
    for (int k = 5; k >= 0; k--) {
        x[k] = a[k][6];
        for (int c = k + 1; c < 6; c++) x[k] -= a[k][c] * x[c];
        x[k] /= a[k][k];
    }
    return true;
}

/* The top of the quadratic through the gains, in steps from the middle; the best place where it has none close by. */
static void find_top(double top[2], const struct grid *g, int left_out)
{
    double a[6][7] = {{0}}, p[6];
    int best = 0;
    for (int i = 0; i < PLACES; i++) {
        const double x = i % GRID - GRID / 2, y = i / GRID - GRID / 2, gain = gain_of(&g->sums[i], left_out);
        const double row[7] = {1, x, y, x * x, x * y, y * y, gain};
        for (int r = 0; r < 6; r++)
            for (int c = 0; c < 7; c++) a[r][c] += row[r] * row[c];
        if (gain > gain_of(&g->sums[best], left_out)) best = i;
    }
    top[0] = best % GRID - GRID / 2;
    top[1] = best / GRID - GRID / 2;
    if (!solve(p, a)) return;
    const double det = 4 * p[3] * p[5] - p[4] * p[4];
    if (!(p[3] < 0 && det > 0)) return;
    const double x = (p[4] * p[2] - 2 * p[5] * p[1]) / det, y = (p[4] * p[1] - 2 * p[3] * p[2]) / det;
    if (fabs(x) > GRID / 2 || fabs(y) > GRID / 2) return;
    top[0] = x;
    top[1] = y;
}

static void look_around(struct grid *g) { parallel_for(PLACES, 1, sum_range, g); }

static void choose_radius(struct grid *g)
{
    struct grid one = *g;
    double most = -INFINITY;
    for (size_t k = 0; k < sizeof radii / sizeof *radii; k++) {
        struct sums s;
        sun_shares(one.shares, g->fit->texels, g->fit->model, g->middle, radii[k]);
        add_pairs(&s, g->fit, one.shares);
        if (!(gain_of(&s, -1) > most)) continue;
        most = gain_of(&s, -1);
        g->radius = radii[k];
    }
}

static void find_error(struct sun_fit *f, const struct grid *g, const double top[2])
{
    double sum = 0;
    for (int k = 0; k < PARTS; k++) {
        double other[2];
        find_top(other, g, k);
        sum += (other[0] - top[0]) * (other[0] - top[0]) + (other[1] - top[1]) * (other[1] - top[1]);
    }
    f->error = 1.96 * g->step * sqrt((PARTS - 1.0) / PARTS * sum);
}

static void measure_gain(struct sun_fit *f, struct grid *g, struct fitting *fit)
{
    double contrast = 0, gain[2];
    for (int k = 0; k < 2; k++) {
        struct sums s;
        fit->sign = k ? -1 : 1;
        sun_shares(g->shares, fit->texels, fit->model, f->direction, f->radius);
        add_pairs(&s, fit, g->shares);
        gain[k] = gain_of(&s, -1);
        contrast = 0;
        for (int p = 0; p < PARTS; p++) contrast += s.without[p];
    }
    f->gain = contrast > 0 ? gain[0] / contrast : 0;
    f->chance = contrast > 0 ? gain[1] / contrast : 0;
}

static void climb(struct sun_fit *f, struct grid *g, struct fitting *fit)
{
    double top[2];
    g->middle = f->direction;
    g->step = WIDEST;
    g->radius = radii[0];
    for (int round = 0; round < ROUNDS; round++) {
        choose_radius(g);
        look_around(g);
        find_top(top, g, -1);
        if (round + 1 == ROUNDS) find_error(f, g, top);
        g->middle = grid_direction(g, top[0], top[1]);
        if (round + 2 < ROUNDS) g->step /= 2;
    }
    f->direction = g->middle;
    choose_radius(g);
    f->radius = g->radius;
    measure_gain(f, g, fit);
}

static enum status prepare(struct fitting *fit, struct err *err)
{
    const struct atlas_squares *t = fit->texels;
    const size_t count = (size_t)t->pair_count + 1;
    const double size = PART * t->side;
    fit->parts = malloc(count);
    fit->differences = malloc(count * sizeof *fit->differences);
    if (!fit->parts || !fit->differences) return err_nomem(err, "pairs", count * 5);
    for (int i = 0; i < t->pair_count; i++) {
        const struct atlas_square *a = &t->list[t->pairs[i].a], *b = &t->list[t->pairs[i].b];
        const int64_t x = (int64_t)floor(a->at.x / size), y = (int64_t)floor(a->at.y / size);
        const int64_t z = (int64_t)floor(a->at.z / size);
        fit->parts[i] = (uint8_t)((uint64_t)(x + 3 * y + 5 * z) % PARTS);
        fit->differences[i] = (a->level[0] - b->level[0] + a->level[1] - b->level[1] + a->level[2] - b->level[2]) / 3;
    }
    return ST_OK;
}

/* The share of the pairs' contrast that a direction explains after another one has explained what it can. */
static double rest_of(const struct fitting *fit, const float *known, const float *share)
{
    const struct atlas_squares *t = fit->texels;
    double with = 0, without = 0, all = 0;
    for (int first = 0, end; first < t->pair_count; first = end) {
        const int tile = t->list[t->pairs[first].a].tile;
        double least = INFINITY, rest = INFINITY, now = 0, q_known = 0;
        for (end = first; end < t->pair_count && t->list[t->pairs[end].a].tile == tile; end++) continue;
        for (int q = 0; q < QUOTIENTS; q++) {
            double total = 0;
            for (int i = first; i < end; i++) total += cut(left_of(fit, i, known, quotients[q]));
            if (total < least) least = total, q_known = quotients[q];
        }
        for (int q = 0; q < QUOTIENTS; q++) {
            double total = 0;
            for (int i = first; i < end; i++) {
                const struct atlas_pair *p = &t->pairs[i];
                if (share[p->a] == share[p->b]) continue;
                const double left = left_of(fit, i, known, q_known);
                total += cut(left - expected_of(p, share, quotients[q]));
                if (q) continue;
                now += cut(left);
                all += cut((double)fit->differences[i]);
            }
            rest = fmin(rest, total);
        }
        with += rest;
        without += now;
    }
    return all > 0 ? (without - with) / all : 0;
}

enum status sun_fit_rest(double *gain, const struct sun_fit *known, const struct sun_fit *other,
                         const struct atlas_squares *texels, const struct model_rays *model, struct err *err)
{
    struct fitting fit = {.texels = texels, .model = model, .sign = 1};
    const size_t count = (size_t)texels->count + 1;
    float *shares = malloc(2 * count * sizeof *shares);
    if (!shares) err_nomem(err, "squares", 2 * count * sizeof *shares);
    if (!err->status && !prepare(&fit, err)) {
        sun_shares(shares, texels, model, known->direction, known->radius);
        sun_shares(shares + count, texels, model, other->direction, other->radius);
        *gain = rest_of(&fit, shares, shares + count);
    }
    free(shares);
    free(fit.parts);
    free(fit.differences);
    return err->status;
}

enum status sun_fit_edges(struct sun_fit *f, const struct atlas_squares *texels, const struct model_rays *model,
                          struct err *err)
{
    struct fitting fit = {.texels = texels, .model = model, .sign = 1};
    struct grid g = {.fit = &fit};
    const size_t size = (size_t)parallel_threads() * (size_t)(texels->count + 1);
    g.shares = malloc(size * sizeof *g.shares);
    if (!g.shares) err_nomem(err, "squares", size * sizeof *g.shares);
    if (!err->status && !prepare(&fit, err)) climb(f, &g, &fit);
    free(g.shares);
    free(fit.parts);
    free(fit.differences);
    return err->status;
}
