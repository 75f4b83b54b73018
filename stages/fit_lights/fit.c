/* fit.c - lamps and materials by robust least squares [Colburn 2014, 5.3.3].
 *
 * Overview. A point of a Lambertian material has the radiance L = k_d (E + sum over lamps of S_j D_j): E is its
 * indirect irradiance, D_j that of lamp j with radiance 1. E and D_j are known; k_d of each material and S_j of each
 * lamp are not. One lit and one unlit point determine them (5.5); more points make an overdetermined system. Marks are
 * evidence: any of them may be on another material or in shade, and a lamp need not have an unlit one, because E and D
 * also differ between lit places.
 *
 * Mathematics. Reflectance varies from point to point by factors, and so does the error of E. So the residuals are
 * those of logarithms, r = log L - log(E + sum S_j D_j) - log of a usual k_d. Their covariance (fit_texture.c) is that
 * of what albedos are usual, which the points of a material share, of the offsets of marks, of the material's
 * variation, and of noise. Left are log S_j per colour, which keeps S positive, and the square root of an exponent.
 * Levenberg-Marquardt (Ceres) solves for these from the best of a grid of radiances; the covariance is renewed in
 * rounds. A lamp whose picture is not saturated adds log S - log of the radiance that it shows; a saturated one that,
 * where S is less. From this solution a Markov chain (fit_chain.c) goes on to all others that explain the marks, which
 * gives intervals, how materials vary and which marks are off; a last descent uses these.
 *
 * What differs from the source: points, colours and lamps are fitted together, by logarithms and robustly; neighbours
 * vary together; what views show of a lamp counts, too. Nothing is refused: what is not known has a wide interval. */
#include "stages/fit_lights/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/math/ceres_least_squares.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "stages/fit_lights/fit_chain.h"
#include "stages/fit_lights/fit_texture.h"

enum {
    ROUNDS = 8,
    ESTIMATES = 4, /* rounds that estimate how materials vary */
    ITERATIONS = 100,
    START_ROUNDS = 3,
    START_STEPS = 48
};
#define START_STEP 1.4

/* ------------------------------------------------------------------------------------------------------- the start */

/* Sets `middle` to the median logarithm of k_d of a material in one colour, at the present radiances. False: it has no
 * points. */
static bool find_middle(const struct problem *p, int material, int colour, struct weighted *scratch, double *middle)
{
    const struct light_fit *f = p->f;
    size_t n = 0;
    for (int i = 0; i < f->point_count; i++)
        if (f->points[i].material == material) scratch[n++] = (struct weighted){p->logs[3 * i + colour], 1};
    *middle = weighted_percentile(scratch, n, 0.5);
    return n > 0;
}

/* How badly the present radiances explain a colour, whatever some marks show. */
static double start_cost(struct problem *p, int colour, struct weighted *scratch)
{
    const struct light_fit *f = p->f;
    const double scale = fmax(2 * f->texture, 0.02);
    double sum = 0, middle;
    fit_set_logs(p);
    for (int m = 0; m < f->material_count; m++) {
        if (!find_middle(p, m, colour, scratch, &middle)) continue;
        const double unusual = (middle - fit_usual_log_k_d()) / ALBEDO_DEVIATION;
        sum += unusual * unusual;
        for (int i = 0; i < f->point_count; i++) {
            const double r = (p->logs[3 * i + colour] - middle) / scale;
            if (f->points[i].material == m) sum += log1p(r * r);
        }
    }
    for (int l = 0; l < f->lamp_count; l++) {
        const double s = f->lamps[l].radiance[colour];
        const double off = f->lamps[l].fit ? fit_seen_residual(&f->lamps[l], colour, s) : 0;
        const double lit = f->lamps[l].fit ? fit_lit_residual(&f->lamps[l], colour, s) : 0;
        sum += off * off + lit * lit;
    }
    return sum;
}

/* The radiance with the least cost on a grid of factors of START_STEP, one lamp and colour after the other; some
 * rounds, as lamps light each other's points. */
static void start_lamps(struct problem *p, struct weighted *scratch)
{
    struct light_fit *f = p->f;
    for (int l = 0; l < f->lamp_count; l++)
        for (int c = 0; f->lamps[l].fit && c < 3; c++)
            f->lamps[l].radiance[c] = fmax(fit_least_radiance(p, l, c), 1e-12);
    for (int round = 0; round < START_ROUNDS; round++)
        for (int u = 0; u < p->unknown_count; u++) {
            const int l = p->unknowns[u].lamp, c = p->unknowns[u].colour;
            if (c == 3) continue;
            double *s = &f->lamps[l].radiance[c], least = INFINITY, best = *s;
            *s = fmax(fit_least_radiance(p, l, c), 1e-12);
            for (int k = 0; k < START_STEPS; k++, *s *= START_STEP) {
                const double cost = start_cost(p, c, scratch);
                if (!(cost < least)) continue;
                least = cost;
                best = *s;
            }
            *s = best;
        }
}

/* The variances of points that lie far from the median of their material at the start. */
static void start_excess(struct problem *p, struct weighted *scratch)
{
    const struct light_fit *f = p->f;
    memset(p->excess, 0, (size_t)f->point_count * sizeof *p->excess);
    fit_set_logs(p);
    for (int c = 0; c < 3; c++)
        for (int m = 0; m < f->material_count; m++) {
            double middle;
            if (!find_middle(p, m, c, scratch, &middle)) continue;
            for (int i = 0; i < f->point_count; i++) {
                const double off = (p->logs[3 * i + c] - middle) / 2;
                if (f->points[i].material == m) p->excess[i] += off * off / 3;
            }
        }
}

/* ----------------------------------------------------------------------------------------------------- the solution */

static void begin_covariance(struct problem *p)
{
    struct light_fit *f = p->f;
    f->wall_variance = f->irradiance_error * f->irradiance_error + 1e-12;
    for (int m = 0; m < f->material_count; m++) {
        f->materials[m].deviation = f->texture;
        f->materials[m].length = 0;
        f->materials[m].grain = 1;
    }
    for (int m = 0; m < f->mark_count; m++) f->marks[m].variance = f->texture * f->texture + 1e-8;
}

static enum status descend(struct problem *p, struct err *err)
{
    const struct least_squares problem = {p->unknown_count, fit_residual_count(p), fit_evaluate, p, ITERATIONS};
    double x[MAX_UNKNOWNS];
    if (fit_texture_set_covariance(p, err)) return err->status;
    fit_get_unknowns(p, x);
    if (p->unknown_count && ceres_least_squares(&problem, x, err)) return err->status;
    fit_set_unknowns(p, x);
    return ST_OK;
}

static enum status solve(struct problem *p, struct weighted *scratch, struct err *err)
{
    begin_covariance(p);
    start_lamps(p, scratch);
    start_excess(p, scratch);
    for (int round = 0; round < ROUNDS; round++) {
        if (descend(p, err)) return err->status;
        fit_texture_set_marks(p);
        fit_texture_set_excess(p);
        if (round < ESTIMATES) fit_texture_estimate(p);
    }
    return descend(p, err);
}

/* The best solution with what the chain found of materials and marks, if it is among the middle half of the chain's. */
static enum status refine(struct problem *p, struct err *err)
{
    if (descend(p, err)) return err->status;
    for (int l = 0; l < p->f->lamp_count; l++) {
        struct fit_lamp *lamp = &p->f->lamps[l];
        for (int c = 0; lamp->fit && c < 3; c++)
            lamp->radiance[c] = clamp(lamp->radiance[c], lamp->middle[0][c], lamp->middle[1][c]);
    }
    fit_set_residuals(p);
    return ST_OK;
}

/* The standard deviation of a material's points, robust, as a fraction of its reflectance. */
static double spread_of(const struct problem *p, int material, struct weighted *scratch)
{
    const struct light_fit *f = p->f;
    size_t n = 0;
    for (int c = 0; c < 3; c++) {
        size_t of_colour = 0;
        for (int i = 0; i < f->point_count; i++)
            if (f->points[i].material == material) scratch[n + of_colour++] = (struct weighted){p->logs[3 * i + c], 1};
        const double median = weighted_percentile(scratch + n, of_colour, 0.5);
        for (size_t i = n; i < n + of_colour; i++) scratch[i].value = fabs(scratch[i].value - median);
        n += of_colour;
    }
    return weighted_percentile(scratch, n, 0.75) / 1.1503;
}

/* -------------------------------------------------------------------------------------------------------------- all */

static void list_unknowns(struct problem *p)
{
    for (int l = 0; l < p->f->lamp_count; l++) {
        struct fit_lamp *lamp = &p->f->lamps[l];
        if (lamp->fit && p->unknown_count + 4 > MAX_UNKNOWNS) {
            log_warn("only %d lamps can be fitted together, so the lamp %s is not; give its radiance.",
                     MAX_UNKNOWNS / 4, lamp->name);
            lamp->fit = false;
        }
        for (int c = 0; lamp->fit && c < 3 + lamp->fit_exponent; c++)
            p->unknowns[p->unknown_count++] = (struct unknown){l, c};
    }
}

static enum status fit_all(struct problem *p, struct weighted *scratch, struct err *err)
{
    struct light_fit *f = p->f;
    for (int l = 0; l < f->lamp_count; l++) fit_set_direct(p, l);
    if (solve(p, scratch, err) || (f->draws > 0 && (fit_chain_run(p, err) || refine(p, err)))) return err->status;
    for (int m = 0; m < f->material_count; m++) f->materials[m].spread = spread_of(p, m, scratch);
    return ST_OK;
}

static void release(struct problem *p)
{
    free(p->direct);
    free(p->logs);
    free(p->excess);
    free(p->factor);
    free(p->ones);
    free(p->whitened);
    free(p->vector);
    free(p->next_excess);
}

static enum status reserve(struct problem *p, struct err *err)
{
    const size_t n = (size_t)p->f->point_count, square = n * n, marks = (size_t)p->f->mark_count;
    if (n > MAX_FIT_POINTS)
        return err_set(err, ST_DATA, "%zu points are marked for lamps, at most %d can be fitted.", n, MAX_FIT_POINTS);
    p->direct = calloc(n * (size_t)p->f->lamp_count + 1, sizeof *p->direct);
    p->logs = calloc(3 * n, sizeof *p->logs);
    p->excess = calloc(n, sizeof *p->excess);
    p->factor = calloc(square, sizeof *p->factor);
    p->ones = calloc(n * (size_t)p->f->material_count, sizeof *p->ones);
    p->whitened = calloc(3 * n, sizeof *p->whitened);
    p->vector = calloc(n, sizeof *p->vector);
    p->next_excess = calloc(n + marks, sizeof *p->next_excess);
    if (p->direct && p->logs && p->excess && p->factor && p->ones && p->whitened && p->vector && p->next_excess)
        return ST_OK;
    return err_nomem(err, "points of lamps", square * sizeof *p->factor);
}

enum status fit_solve(struct light_fit *f, struct err *err)
{
    struct problem p = {.f = f};
    for (int m = 0; m < f->material_count; m++) f->materials[m].lit = f->materials[m].unlit = 0;
    for (int i = 0; i < f->point_count; i++) {
        struct fit_material *m = &f->materials[f->points[i].material];
        m->lit += f->points[i].kind == POINT_LIT;
        m->unlit += f->points[i].kind == POINT_UNLIT;
    }
    list_unknowns(&p);
    if (!f->point_count) return ST_OK;
    reserve(&p, err);
    struct weighted *scratch = calloc(3 * (size_t)f->point_count, sizeof *scratch);
    if (!err->status && !scratch) err_nomem(err, "points of lamps", (size_t)f->point_count);
    if (!err->status) fit_all(&p, scratch, err);
    release(&p);
    free(scratch);
    return err->status;
}
