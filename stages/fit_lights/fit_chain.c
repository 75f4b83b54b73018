/* fit_chain.c - intervals by a Markov chain over all solutions that explain the marks.
 *
 * Overview. A fit's curvature at its best solution says how sure it is only if everything else is known: how a material
 * varies, which marks are off, whether a lamp is dim. Here nothing is known. A chain of solutions is drawn, each as
 * often as it is likely [Hastings 1970], and an interval holds 95 % of them. Where a lamp gives little of the light, or
 * has no unlit mark, the interval is lopsided and wide; if marks contradict each other, it holds what either says.
 *
 * Mathematics. With the logarithms y = log L - log(E + sum S_j D_j) of the points of a material (fit.c),
 *
 *     y = u + Z e + t,  u ~ N(usual, ALBEDO_DEVIATION^2),  e_m ~ N(0, tau^2 / w_m),  t ~ N(0, v R(length, grain)),
 *
 * where Z assigns points to marks and to walls (fit_texture.c); the e of walls have one variance, that of errors of E.
 * w_m ~ Gamma(MARK_FREEDOM / 2) makes the offsets of marks a t distribution; v, tau^2 and the variance of walls have
 * scaled inverse chi-squared distributions about what is assumed, and R is one of TEXTURE_KINDS. Given w, the variances
 * and R, everything is linear: with R = F F^T, W = F^-1 [Z 1] and z = F^-1 y the likelihood of S, without u and e, is
 *
 *     log p = 1/2 b^T P^-1 b - z.z / 2 v,  b = W^T z / v,  P = W^T W / v + diag(1 / variances).
 *
 * Steps: each log S by Metropolis' rule, its step adapted at the beginning; then u and e from their normal
 * distribution; then w, tau^2 and v from theirs, and R by Metropolis' rule, given u and e [Gelfand 1990]. Colours vary
 * together: each has its own S, u, e, but they count as one sample of w, tau, v, R and exponents. Errors of E by
 * factors, which change S by these factors, are drawn, too: one of all E and one of E about each lamp.
 *
 * The prior of S is flat in log S, and flat in S where the lamp would give less than a hundredth of the light. */
#include "stages/fit_lights/fit_chain.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/rng.h"
#include "common/base/sort.h"
#include "common/math/cholesky.h"
#include "common/math/numbers.h"
#include "stages/fit_lights/fit_block.h"

enum {
    BEGIN = 4 /* one draw in so many is made before the first that counts */,
    ADAPT = 50 /* draws between two changes of the steps */,
    SWEEPS = 2
};
#define WANTED 0.4 /* of the steps are taken */

struct chain {
    struct problem *p;
    struct fit_block *blocks;
    int block_count;
    int count; /* of draws */
    struct rng rng;
    uint64_t drawn;       /* numbers */
    double *step, *least; /* of each unknown */
    int *taken, *tried;
    double *weights, tau2;      /* w of each mark */
    double scale, *lamp_scales; /* logarithms of the factors of all E, and of E about each lamp */
    double *draws;              /* [unknown + 3 materials][draw] */
    double *sums, *squares;     /* of marks' offsets */
    double *weight_sums, tau2_sum, wall_sum, *variance_sums;
    int *kind_counts; /* [material][kind] */
};

/* --------------------------------------------------------------------------------------------------------- numbers */

static double uniform(struct chain *c) { return rng_uniform(&c->rng, c->drawn++, 0); }

static double gauss(struct chain *c) /* [Box 1958] */
{
    const double r = sqrt(-2 * log(1 - uniform(c)));
    return r * cos(2 * PI * uniform(c));
}

/* Of the Gamma distribution with a shape of at least 1 and the scale 1 [Marsaglia 2000]. */
static double gamma_number(struct chain *c, double shape)
{
    const double d = shape - 1.0 / 3, k = 1 / sqrt(9 * d);
    for (;;) {
        const double x = gauss(c), v = 1 + k * x, v3 = v * v * v;
        if (v > 0 && log(1 - uniform(c)) < 0.5 * x * x + d - d * v3 + d * log(v3)) return d * v3;
    }
}

static double inverse_chi_squared(struct chain *c, double freedom, double squares)
{
    return 0.5 * squares / gamma_number(c, 0.5 * freedom);
}

/* Of a lamp's radiance: the prior, what views show of the lamp, and what all faces tell of it. */
static double prior(const struct chain *c, int unknown)
{
    const struct unknown u = c->p->unknowns[unknown];
    const struct fit_lamp *l = &c->p->f->lamps[u.lamp];
    const double s = l->radiance[u.colour],
                 off = fit_seen_residual(l, u.colour, s * exp(c->scale + c->lamp_scales[u.lamp])),
                 lit = fit_lit_residual(l, u.colour, s); /* of the same indirect light */
    return log(s / (s + c->least[unknown])) - 0.5 * (off * off + lit * lit);
}

/* ----------------------------------------------------------------------------------------------------------- steps */

static bool lights(const struct problem *p, int lamp, const struct fit_block *b)
{
    for (int i = 0; i < b->s.count; i++)
        if (p->direct[lamp * p->f->point_count + b->s.points[i]] > 0) return true;
    return false;
}

static void move_radiance(struct chain *c, int unknown)
{
    const struct unknown u = c->p->unknowns[unknown];
    double *s = &c->p->f->lamps[u.lamp].radiance[u.colour], before = *s, gain = -prior(c, unknown);
    *s = exp(clamp(log(before) + c->step[unknown] * gauss(c), -60, 60));
    gain += prior(c, unknown);
    for (int k = 0; k < c->block_count; k++) {
        struct fit_block *b = &c->blocks[k];
        b->touched = b->counts && lights(c->p, u.lamp, b);
        if (b->touched) gain += fit_block_try(b, u.colour);
    }
    c->tried[unknown]++;
    if (!(log(1 - uniform(c)) < gain)) {
        *s = before;
        return;
    }
    c->taken[unknown]++;
    for (int k = 0; k < c->block_count; k++)
        if (c->blocks[k].touched) fit_block_keep(&c->blocks[k], u.colour);
}

/* The light of a lamp at the points, for a change of its exponent that leaves its light there. */
static double mean_direct(const struct problem *p, int lamp)
{
    double sum = 0;
    for (int i = 0; i < p->f->point_count; i++) sum += p->direct[lamp * p->f->point_count + i];
    return sum;
}

static void set_exponent(struct chain *c, int unknown, double root)
{
    struct fit_lamp *l = &c->p->f->lamps[c->p->unknowns[unknown].lamp];
    const double before = mean_direct(c->p, c->p->unknowns[unknown].lamp);
    l->exponent = fmin(root * root, 1000);
    fit_set_direct(c->p, c->p->unknowns[unknown].lamp);
    const double after = mean_direct(c->p, c->p->unknowns[unknown].lamp);
    for (int k = 0; k < 3 && before > 0 && after > 0; k++) l->radiance[k] *= before / after;
}

static double all_likely(const struct chain *c)
{
    double sum = 0;
    for (int k = 0; k < c->block_count; k++)
        for (int i = 0; i < 3; i++) sum += c->blocks[k].counts ? c->blocks[k].likely[i] : 0;
    return sum / 3;
}

static void renew_all(struct chain *c)
{
    for (int k = 0; k < c->block_count; k++)
        if (c->blocks[k].counts) fit_block_renew(&c->blocks[k], c->weights, c->tau2);
}

static void move_exponent(struct chain *c, int unknown)
{
    struct fit_lamp *l = &c->p->f->lamps[c->p->unknowns[unknown].lamp];
    const struct fit_lamp kept = *l;
    const double root = sqrt(l->exponent), before = all_likely(c);
    set_exponent(c, unknown, fabs(root + c->step[unknown] * gauss(c)));
    renew_all(c);
    c->tried[unknown]++;
    if (log(1 - uniform(c)) < all_likely(c) - before) {
        c->taken[unknown]++;
        return;
    }
    *l = kept;
    fit_set_direct(c->p, c->p->unknowns[unknown].lamp);
    renew_all(c);
}

static double prior_of_lamps(const struct chain *c, int lamp)
{
    double sum = 0;
    for (int u = 0; u < c->p->unknown_count; u++)
        if (c->p->unknowns[u].colour < 3 && (lamp < 0 || c->p->unknowns[u].lamp == lamp)) sum += prior(c, u) / 3;
    return sum;
}

/* An error of E by a factor, which changes the radiance that explains the marks by that factor, so it shows only where
 * views show lamps. lamp: of E about it; -1: of all E. */
static void move_scale(struct chain *c, double *scale, double deviation, int lamp)
{
    const double before = *scale, had = prior_of_lamps(c, lamp);
    *scale = deviation * gauss(c);
    if (!(log(1 - uniform(c)) < prior_of_lamps(c, lamp) - had)) *scale = before;
}

static void move_scales(struct chain *c)
{
    const struct light_fit *f = c->p->f;
    move_scale(c, &c->scale, f->irradiance_error, -1);
    for (int l = 0; l < f->lamp_count; l++)
        if (f->lamps[l].fit) move_scale(c, &c->lamp_scales[l], sqrt(f->wall_variance), l);
}

/* The offsets of marks and the mean of a colour. */
static void draw_offsets(struct chain *c, struct fit_block *b, int colour)
{
    double *e = b->offsets + (ptrdiff_t)colour * b->columns;
    memcpy(e, b->b + (ptrdiff_t)colour * b->columns, (size_t)b->columns * sizeof *e);
    cholesky_forward(b->precision, b->columns, e);
    for (int a = 0; a < b->columns; a++) e[a] += gauss(c);
    cholesky_backward(b->precision, b->columns, e);
}

static void move_texture(struct chain *c, struct fit_block *b)
{
    const int next = (int)(uniform(c) * TEXTURE_KINDS), n = b->s.count;
    double squares = 0, tried = 0;
    for (int k = 0; k < 3; k++) {
        squares += fit_block_squares(b, k, b->kind) / 3;
        if (b->usable[next]) tried += fit_block_squares(b, k, next) / 3;
    }
    const double gain = 0.5 * (b->determinants[b->kind] - b->determinants[next] + (squares - tried) / b->variance);
    const bool taken = log(1 - uniform(c)) < gain && b->usable[next];
    if (taken) {
        b->kind = next;
        squares = tried;
    }
    const double assumed = c->p->f->texture * c->p->f->texture + 1e-12;
    b->variance = inverse_chi_squared(c, TEXTURE_PRIOR + n, TEXTURE_PRIOR * assumed + squares);
}

static void draw_wall_variance(struct chain *c)
{
    struct light_fit *f = c->p->f;
    const double scale = f->irradiance_error * f->irradiance_error + 1e-12;
    double squares = TEXTURE_PRIOR * scale;
    int walls = 0;
    for (int k = 0; k < c->block_count; k++) {
        const struct fit_block *b = &c->blocks[k];
        for (int a = b->mark_count; b->counts && a + 1 < b->columns; a++) squares += fit_block_offset_square(b, a);
        walls += b->counts ? b->wall_count : 0;
    }
    f->wall_variance = inverse_chi_squared(c, TEXTURE_PRIOR + walls, squares);
}

static void draw_weights(struct chain *c)
{
    const double scale = MARK_SCALE * MARK_SCALE * c->p->f->texture * c->p->f->texture + 1e-12;
    double squares = TEXTURE_PRIOR * scale;
    int marks = 0;
    for (int k = 0; k < c->block_count; k++) {
        const struct fit_block *b = &c->blocks[k];
        for (int a = 0; b->counts && a < b->mark_count; a++) {
            const double e2 = fit_block_offset_square(b, a);
            double *w = &c->weights[b->marks[a]];
            *w = gamma_number(c, 0.5 * (MARK_FREEDOM + 1)) / (0.5 * (MARK_FREEDOM + e2 / c->tau2));
            squares += *w * e2;
            marks++;
        }
    }
    c->tau2 = inverse_chi_squared(c, TEXTURE_PRIOR + marks, squares);
}

static void adapt(struct chain *c)
{
    for (int u = 0; u < c->p->unknown_count; u++) {
        if (c->tried[u]) c->step[u] *= exp(2 * ((double)c->taken[u] / c->tried[u] - WANTED));
        c->step[u] = clamp(c->step[u], 1e-5, 5);
        c->taken[u] = c->tried[u] = 0;
    }
}

static void advance(struct chain *c)
{
    renew_all(c);
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int u = 0; u < c->p->unknown_count; u++)
            if (c->p->unknowns[u].colour < 3) move_radiance(c, u);
    for (int u = 0; u < c->p->unknown_count; u++)
        if (c->p->unknowns[u].colour == 3) move_exponent(c, u);
    move_scales(c);
    for (int k = 0; k < c->block_count; k++) {
        struct fit_block *b = &c->blocks[k];
        for (int i = 0; b->counts && i < 3; i++) draw_offsets(c, b, i);
        if (b->counts) move_texture(c, b);
    }
    draw_weights(c);
    draw_wall_variance(c);
}

/* --------------------------------------------------------------------------------------------------------- results */

static void record(struct chain *c, int draw)
{
    const struct light_fit *f = c->p->f;
    const int unknowns = c->p->unknown_count;
    for (int u = 0; u < unknowns; u++) {
        const struct fit_lamp *l = &f->lamps[c->p->unknowns[u].lamp];
        const int colour = c->p->unknowns[u].colour;
        c->draws[(ptrdiff_t)u * c->count + draw] =
            colour < 3 ? l->radiance[colour] * exp(c->scale + c->lamp_scales[c->p->unknowns[u].lamp]) : l->exponent;
    }
    for (int k = 0; k < c->block_count; k++) {
        const struct fit_block *b = &c->blocks[k];
        if (!b->counts) continue;
        for (int i = 0; i < 3; i++)
            c->draws[(ptrdiff_t)(unknowns + 3 * b->material + i) * c->count + draw] =
                exp(fit_usual_log_k_d() + b->offsets[i * b->columns + b->columns - 1] - c->scale);
        for (int a = 0; a < b->mark_count; a++) {
            double mean = 0;
            for (int i = 0; i < 3; i++) mean += b->offsets[i * b->columns + a] / 3;
            c->sums[b->marks[a]] += mean / c->count;
            c->squares[b->marks[a]] += mean * mean / c->count;
            c->weight_sums[b->marks[a]] += c->weights[b->marks[a]] / c->count;
        }
        c->variance_sums[b->material] += log(b->variance) / c->count;
        c->kind_counts[b->material * TEXTURE_KINDS + b->kind]++;
    }
    c->tau2_sum += log(c->tau2) / c->count;
    c->wall_sum += log(f->wall_variance) / c->count;
}

static double part(const struct chain *c, const double *sorted, double fraction)
{
    return sorted[(int)(fraction * (c->count - 1))];
}

static void set_lamps(struct chain *c)
{
    for (int u = 0; u < c->p->unknown_count; u++) {
        struct fit_lamp *l = &c->p->f->lamps[c->p->unknowns[u].lamp];
        const int colour = c->p->unknowns[u].colour;
        double *d = c->draws + (ptrdiff_t)u * c->count;
        sort_doubles(d, (size_t)c->count);
        const double error = (part(c, d, 0.975) - part(c, d, 0.025)) / (2 * 1.96);
        if (colour == 3) {
            l->exponent = part(c, d, 0.5);
            l->exponent_error = error;
            continue;
        }
        l->low[colour] = part(c, d, 0.025);
        l->high[colour] = part(c, d, 0.975);
        l->radiance_error[colour] = error;
        l->middle[0][colour] = part(c, d, 0.25);
        l->middle[1][colour] = part(c, d, 0.75);
        l->radiance[colour] = part(c, d, 0.5);
    }
}

static void set_materials(struct chain *c)
{
    for (int k = 0; k < c->block_count; k++) {
        const struct fit_block *b = &c->blocks[k];
        struct fit_material *m = &c->p->f->materials[b->material];
        const int *counts = c->kind_counts + (ptrdiff_t)b->material * TEXTURE_KINDS;
        int most = 0;
        if (!b->counts) continue;
        for (int i = 0; i < TEXTURE_KINDS; i++)
            if (counts[i] > counts[most]) most = i;
        m->deviation = exp(0.5 * c->variance_sums[b->material]);
        m->length = fit_texture_kind(most, b->s.longest).length;
        m->grain = fit_texture_kind(most, b->s.longest).grain;
        for (int i = 0; i < 3; i++) {
            double *d = c->draws + (ptrdiff_t)(c->p->unknown_count + 3 * b->material + i) * c->count;
            sort_doubles(d, (size_t)c->count);
            m->k_d[i] = part(c, d, 0.5);
            m->k_d_error[i] = (part(c, d, 0.975) - part(c, d, 0.025)) / (2 * 1.96);
        }
    }
}

static void set_marks(struct chain *c)
{
    for (int k = 0; k < c->block_count; k++) {
        const struct fit_block *b = &c->blocks[k];
        for (int a = 0; b->counts && a < b->mark_count; a++) {
            const int i = b->marks[a];
            struct fit_mark *m = &c->p->f->marks[i];
            m->off = c->sums[i];
            m->off_error = sqrt(fmax(c->squares[i] - c->sums[i] * c->sums[i], 0));
            m->variance = exp(c->tau2_sum) / fmax(c->weight_sums[i], 1e-12);
        }
    }
}

static enum status begin(struct chain *c, struct err *err)
{
    const struct light_fit *f = c->p->f;
    const size_t unknowns = (size_t)c->p->unknown_count, materials = (size_t)f->material_count;
    const size_t marks = (size_t)f->mark_count, rows = unknowns + 3 * materials;
    c->rng = rng_make(0, "fit_lights", "chain");
    c->blocks = calloc(materials + 1, sizeof *c->blocks);
    c->step = calloc(unknowns + 1, sizeof *c->step);
    c->least = calloc(unknowns + 1, sizeof *c->least);
    c->taken = calloc(unknowns + 1, sizeof *c->taken);
    c->tried = calloc(unknowns + 1, sizeof *c->tried);
    c->lamp_scales = calloc((size_t)f->lamp_count + 1, sizeof *c->lamp_scales);
    c->weights = calloc(marks + 1, sizeof *c->weights);
    c->draws = calloc(rows * (size_t)c->count + 1, sizeof *c->draws);
    c->sums = calloc(marks + 1, sizeof *c->sums);
    c->squares = calloc(marks + 1, sizeof *c->squares);
    c->weight_sums = calloc(marks + 1, sizeof *c->weight_sums);
    c->variance_sums = calloc(materials + 1, sizeof *c->variance_sums);
    c->kind_counts = calloc(materials * TEXTURE_KINDS + 1, sizeof *c->kind_counts);
    if (!c->blocks || !c->step || !c->least || !c->taken || !c->tried || !c->lamp_scales || !c->weights || !c->draws ||
        !c->sums || !c->squares || !c->weight_sums || !c->variance_sums || !c->kind_counts)
        return err_nomem(err, "solutions", rows * (size_t)c->count * sizeof *c->draws);
    for (int m = 0; m < f->material_count; m++)
        if (fit_block_make(&c->blocks[c->block_count++], c->p, m, err)) return err->status;
    c->tau2 = MARK_SCALE * MARK_SCALE * f->texture * f->texture + 1e-12;
    for (int m = 0; m < f->mark_count; m++) c->weights[m] = c->tau2 / fmax(f->marks[m].variance, 1e-12);
    for (int u = 0; u < c->p->unknown_count; u++) {
        const struct unknown k = c->p->unknowns[u];
        c->step[u] = 0.1;
        if (k.colour == 3) continue;
        c->least[u] = fit_least_radiance(c->p, k.lamp, k.colour);
        double *s = &c->p->f->lamps[k.lamp].radiance[k.colour];
        *s = clamp(*s, c->least[u], 1e6 * c->least[u] + 1e-30);
    }
    return ST_OK;
}

static void release(struct chain *c)
{
    for (int k = 0; k < c->block_count; k++) fit_block_release(&c->blocks[k]);
    free(c->blocks);
    free(c->step);
    free(c->least);
    free(c->taken);
    free(c->tried);
    free(c->lamp_scales);
    free(c->weights);
    free(c->draws);
    free(c->sums);
    free(c->squares);
    free(c->weight_sums);
    free(c->variance_sums);
    free(c->kind_counts);
}

enum status fit_chain_run(struct problem *p, struct err *err)
{
    struct chain c = {.p = p, .count = p->f->draws};
    if (!begin(&c, err)) {
        for (int i = 0; i < c.count / BEGIN; i++) {
            advance(&c);
            if (i % ADAPT == ADAPT - 1) adapt(&c);
        }
        for (int i = 0; i < c.count; i++) {
            advance(&c);
            record(&c, i);
        }
        set_lamps(&c);
        set_materials(&c);
        set_marks(&c);
        p->f->wall_variance = exp(c.wall_sum);
    }
    release(&c);
    return err->status;
}
