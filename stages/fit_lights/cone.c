/* cone.c - a cone's half angle, bracketed on a grid and refined [Colburn 2014, 5.6a].
 *
 * Overview. Along a line across the edge of a cone, the radiance is k_d (E + S D(beta)), where D falls to 0 at the
 * edge. The half angle beta is that for which the residuals are least. The objective is a step: where no place changes
 * sides it is flat, so a descent finds nothing. A grid over the angles of the lines brackets the least value; golden
 * section refines it there. Below the spacing of the grid the objective is smooth, because the lamp has a size: between
 * the places that see all of it and none of it through the cone lies a penumbra, in which the pixels of several views
 * lie.
 *
 * Mathematics. For each photo of a line, and each colour, L ~ a E + b D(beta) with free a, b >= 0 while S is unknown,
 * and L ~ a (E + S D(beta)) when it is known: k_d is that of the line and of the photo, so that neither a gradient of
 * the material nor the exposure shifts the edge. Residuals are relative to the radiance and to noise and texture. The
 * cost is that of the Cauchy function, so that the border of a poster that crosses the line counts little.
 *
 * The standard error is that of clusters: sum over lines of the squared slope of their cost, over the square of the
 * curvature of the whole. With one line the photos are the clusters.
 *
 * What differs from the source: it compares k_d with a fixed value along one line by a plain search. */
#include "stages/fit_lights/cone.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/numbers.h"

enum { GRID = 96, GOLDEN_STEPS = 40, ROUNDS = 3 };
#define CAUCHY   2.385
#define MIN_GAIN 0.02 /* part of the cost without any step that the step must explain */

struct step {
    double e, d, l, variance; /* variance: of the residual */
};

/* The least weighted squares of l ~ a e + b d, a, b >= 0, or of l ~ a e if `alone`. */
static void fit_step(double *a, double *b, const struct step *s, const double *weight, int n, bool alone)
{
    double ee = 0, ed = 0, dd = 0, le = 0, ld = 0;
    for (int i = 0; i < n; i++) {
        const double w = weight[i] / s[i].variance;
        ee += w * s[i].e * s[i].e;
        ed += w * s[i].e * s[i].d;
        dd += w * s[i].d * s[i].d;
        le += w * s[i].l * s[i].e;
        ld += w * s[i].l * s[i].d;
    }
    const double det = ee * dd - ed * ed;
    *b = !alone && det > 1e-12 * ee * dd ? fmax(0, (ld * ee - le * ed) / det) : 0;
    *a = ee > 0 ? fmax(0, (le - *b * ed) / ee) : 0;
}

/* The cost of one colour of a trace, robust. */
static double step_cost(const struct step *s, double *weight, int n, bool alone)
{
    double a, b, cost = 0;
    for (int i = 0; i < n; i++) weight[i] = 1;
    for (int round = 0; round < ROUNDS; round++) {
        fit_step(&a, &b, s, weight, n, alone);
        cost = 0;
        for (int i = 0; i < n; i++) {
            const double r = (s[i].l - a * s[i].e - b * s[i].d) / (CAUCHY * sqrt(s[i].variance));
            weight[i] = 1 / (1 + r * r);
            cost += log1p(r * r);
        }
    }
    return cost;
}

struct search {
    struct cone_fit *f;
    double **direct; /* [line][place], at the present beta */
    struct step *steps;
    double *weight;
};

static double trace_cost(const struct search *s, int trace)
{
    const struct cone_fit *f = s->f;
    const struct cone_trace *t = &f->traces[trace];
    const struct cone_line *line = &f->lines[t->line];
    double cost = 0;
    for (int c = 0; c < 3; c++) {
        int n = 0;
        for (int i = 0; i < line->places; i++) {
            const double l = t->radiance[i][c], d = s->direct[t->line][i];
            if (!(l > 0)) continue;
            const double relative = t->sigma[i] * t->sigma[i] + f->texture * f->texture + 1e-8;
            s->steps[n++] = (struct step){line->indirect[i][c] + (f->has_radiance ? f->radiance[c] * d : 0),
                                          f->has_radiance ? 0 : d, l, relative * l * l};
        }
        cost += step_cost(s->steps, s->weight, n, f->has_radiance);
    }
    return cost;
}

static void set_beta(const struct search *s, double beta)
{
    const struct cone_fit *f = s->f;
    for (int k = 0; k < f->line_count; k++)
        for (int i = 0; i < f->lines[k].places; i++) s->direct[k][i] = f->direct(f->ctx, k, i, beta);
}

static double whole_cost(const struct search *s, double beta)
{
    double cost = 0;
    set_beta(s, beta);
    for (int t = 0; t < s->f->trace_count; t++) cost += trace_cost(s, t);
    return cost;
}

/* The angles that the lines span. */
static void span(const struct cone_fit *f, double *low, double *high)
{
    *low = INFINITY;
    *high = 0;
    for (int k = 0; k < f->line_count; k++)
        for (int i = 0; i < f->lines[k].places; i++) {
            *low = fmin(*low, f->lines[k].angle[i]);
            *high = fmax(*high, f->lines[k].angle[i]);
        }
    *low = fmax(*low, 0.1 * DEGREE);
    *high = fmin(*high, 89.9 * DEGREE);
}

static enum status refuse_edge(const struct cone_fit *f, double low, double high, bool at_low, struct err *err)
{
    return err_set(
        err, ST_DATA,
        "%s: the lines of the lamp %s show no edge of its cone between %.1f and %.1f degrees: %s; draw the line "
        "across the edge, or give beta.",
        f->lines[0].place, f->lamp, low / DEGREE, high / DEGREE,
        at_low ? "they are dark all along, as if beta were 0 or less than that"
               : "they are lit all along, as if beta were 90 or more than that");
}

static enum status bracket(const struct search *s, double *low, double *high, struct err *err)
{
    const struct cone_fit *f = s->f;
    const double from = *low, step = (*high - *low) / GRID;
    double least = INFINITY, dark;
    int best = 0;
    for (int i = 0; i <= GRID; i++) {
        const double cost = whole_cost(s, from + i * step);
        if (cost < least) {
            least = cost;
            best = i;
        }
    }
    dark = whole_cost(s, 0);
    if (f->reach <= 0 && (best <= 1 || best >= GRID - 1)) return refuse_edge(f, *low, *high, best <= 1, err);
    if (f->reach <= 0 && !(least < (1 - MIN_GAIN) * dark))
        return err_set(
            err, ST_DATA,
            "%s: the lines of the lamp %s show no step in their radiance, so the edge of its cone is not on them.",
            f->lines[0].place, f->lamp);
    *low = from + fmax(0, best - 1) * step;
    *high = from + fmin(GRID, best + 1) * step;
    return ST_OK;
}

static double refine(const struct search *s, double low, double high)
{
    const double ratio = 0.6180339887498949;
    double a = high - ratio * (high - low), b = low + ratio * (high - low);
    double fa = whole_cost(s, a), fb = whole_cost(s, b);
    for (int i = 0; i < GOLDEN_STEPS && high - low > 1e-6; i++) {
        if (fa < fb) {
            high = b;
            b = a;
            fb = fa;
            a = high - ratio * (high - low);
            fa = whole_cost(s, a);
        } else {
            low = a;
            a = b;
            fa = fb;
            b = low + ratio * (high - low);
            fb = whole_cost(s, b);
        }
    }
    return 0.5 * (low + high);
}

static int cluster_of(const struct cone_fit *f, int trace) { return f->line_count > 1 ? f->traces[trace].line : trace; }

static double find_error(const struct search *s, double beta)
{
    const struct cone_fit *f = s->f;
    const double h = 0.25 * DEGREE, most = 10 * DEGREE;
    const int clusters = f->line_count > 1 ? f->line_count : f->trace_count;
    double *slope = calloc((size_t)clusters + 1, sizeof *slope), curve = 0, squares = 0;
    if (!slope) return most;
    for (int side = -1; side <= 1; side++) {
        set_beta(s, beta + side * h);
        for (int t = 0; t < f->trace_count; t++) {
            const double cost = trace_cost(s, t);
            slope[cluster_of(f, t)] += side * cost / (2 * h);
            curve += (side ? 1 : -2) * cost / (h * h);
        }
    }
    for (int k = 0; k < clusters; k++) squares += slope[k] * slope[k];
    free(slope);
    if (!(curve > 0)) return most;
    if (clusters == 1) return fmin(most, 0.5 * h); /* one line in one photo: as far as a place tells */
    return fmin(most, sqrt(squares * clusters / (clusters - 1)) / curve);
}

static enum status solve(struct search *s, struct err *err)
{
    struct cone_fit *f = s->f;
    double low, high;
    span(f, &low, &high);
    if (f->reach > 0) {
        low = fmax(low, f->beta - f->reach);
        high = fmin(high, f->beta + f->reach);
    }
    if (!(high > low)) return refuse_edge(f, low, high, true, err);
    if (bracket(s, &low, &high, err)) return err->status;
    f->beta = refine(s, low, high);
    f->error = find_error(s, f->beta);
    return ST_OK;
}

enum status cone_fit_solve(struct cone_fit *f, struct err *err)
{
    int most = 1;
    if (!f->line_count || !f->trace_count)
        return err_set(err, ST_DATA,
                       "the lamp %s has no line that a view shows unsaturated, so its beta cannot be fitted.", f->lamp);
    struct search s = {.f = f, .direct = calloc((size_t)f->line_count, sizeof *s.direct)};
    for (int k = 0; s.direct && k < f->line_count; k++) {
        most = f->lines[k].places > most ? f->lines[k].places : most;
        s.direct[k] = calloc((size_t)f->lines[k].places + 1, sizeof **s.direct);
        if (!s.direct[k]) err_nomem(err, "a line", (size_t)f->lines[k].places);
    }
    s.steps = calloc((size_t)most, sizeof *s.steps);
    s.weight = calloc((size_t)most, sizeof *s.weight);
    if (!err->status && (!s.direct || !s.steps || !s.weight)) err_nomem(err, "lines", (size_t)most * sizeof *s.steps);
    if (!err->status) solve(&s, err);
    for (int k = 0; s.direct && k < f->line_count; k++) free(s.direct[k]);
    free(s.direct);
    free(s.steps);
    free(s.weight);
    return err->status;
}
