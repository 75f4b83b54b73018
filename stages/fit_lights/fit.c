/* fit.c - lamps and materials by robust least squares [Colburn 2014, 5.3.3].
 *
 * Overview. A point of a Lambertian material has the radiance L = k_d (E + sum over lamps of S_j D_j): E is its
 * indirect irradiance, D_j that of lamp j with radiance 1. E and D_j are known; k_d of each material and S_j of each
 * lamp are not. One lit and one unlit point determine them (5.5); more points make an overdetermined system.
 *
 * Mathematics. Reflectance varies from point to point by factors, and so does the error of E. So the residuals are
 * those of logarithms, r = log L - log k_d - log(E + sum S_j D_j). Their covariance (fit_texture.c) is that of the
 * material's variation, and of noise. Then log k_d is a weighted mean of a material's points and drops out [Golub
 * 1973]. Left are log S_j per colour, which keeps S positive, and the square root of an exponent. Levenberg-Marquardt
 * (Ceres) solves for these; the covariance is renewed in rounds. A lamp whose picture is not saturated adds log S - log
 * of the radiance that it shows.
 *
 * What differs from the source: points, colours and lamps are fitted together, by logarithms and robustly; neighbours
 * vary together; what views show of a lamp counts, too. */
#include "stages/fit_lights/fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/ceres_least_squares.h"
#include "common/math/weighted.h"
#include "stages/fit_lights/fit_errors.h"
#include "stages/fit_lights/fit_texture.h"

enum { ROUNDS = 8, ESTIMATES = 4 /* rounds that estimate how materials vary */, ITERATIONS = 100 };
#define MIN_SHARE 1e-3 /* difference in the lamp's share of the light by which lit points must differ from others */

/* ----------------------------------------------------------------------------------------- what cannot be solved */

static enum status check_points(const struct light_fit *f, struct err *err)
{
    for (int i = 0; i < f->point_count; i++) {
        const struct fit_point *p = &f->points[i];
        if (p->kind == POINT_UNLIT && !(fmin(p->indirect[0], fmin(p->indirect[1], p->indirect[2])) > 0))
            return err_set(
                err, ST_DATA,
                "%s: no indirect light reaches this unlit point, so nothing can be learned from its radiance; "
                "choose another point.",
                p->place);
    }
    return ST_OK;
}

/* Whether a point tells of a lamp: a lit one that was marked for it, or any unlit one of its material. */
static bool concerns(const struct light_fit *f, int point, int lamp, bool lit)
{
    const struct fit_point *p = &f->points[point];
    return p->kind == (lit ? POINT_LIT : POINT_UNLIT) &&
           (lit ? p->lamp == lamp : p->material == f->lamps[lamp].material);
}

static const char *place_of(const struct light_fit *f, int lamp, bool lit)
{
    for (int i = 0; i < f->point_count; i++)
        if (concerns(f, i, lamp, lit)) return f->points[i].place;
    return "";
}

/* The light at a point without that of one lamp. */
static double other_light(const struct problem *p, int point, int colour, int lamp)
{
    return fit_irradiance(p, point, colour) -
           p->f->lamps[lamp].radiance[colour] * p->direct[lamp * p->f->point_count + point];
}

/* Whether a lamp's light differs between its lit points and the others. */
static enum status check_lamp(const struct problem *p, int lamp, struct err *err)
{
    const struct light_fit *f = p->f;
    const char *name = f->lamps[lamp].name;
    double most = 0, least = INFINITY;
    int lit = 0, unlit = 0;
    for (int i = 0; i < f->point_count; i++) {
        const double share = p->direct[lamp * f->point_count + i] / fmax(f->points[i].indirect[1], 1e-30);
        if (concerns(f, i, lamp, true)) {
            most = fmax(most, share);
            lit++;
        } else if (concerns(f, i, lamp, false)) {
            least = fmin(least, share);
            unlit++;
        }
    }
    if (!lit || !unlit)
        return err_set(
            err, ST_DATA,
            "the lamp %s has %d lit and %d unlit points that views show unsaturated, wanted one of each; add a line "
            "\"%s %s in VIEW X Y\".",
            name, lit, unlit, lit ? "unlit" : "lit", name);
    if (!(most > 0))
        return err_set(
            err, ST_DATA,
            "%s: no light of the lamp %s reaches its lit points: they are outside its cone, turned away, or the "
            "model hides it from them.",
            place_of(f, lamp, true), name);
    if (most - least < MIN_SHARE * most)
        return err_set(
            err, ST_DATA,
            "%s: the lamp %s gives its lit and unlit points the same irradiance, so its radiance cannot be told "
            "from the reflectance; choose unlit points outside its cone or in shadow.",
            place_of(f, lamp, true), name);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- the start */

/* The median k_d of the unlit points of a lamp's material. */
static double start_k_d(const struct problem *p, int lamp, int colour, struct weighted *scratch)
{
    const struct light_fit *f = p->f;
    size_t n = 0;
    for (int i = 0; i < f->point_count; i++)
        if (concerns(f, i, lamp, false))
            scratch[n++] = (struct weighted){f->points[i].radiance[colour] / fit_irradiance(p, i, colour), 1};
    return weighted_percentile(scratch, n, 0.5);
}

/* The median S of a lamp's lit points, given k_d; 0: they are no brighter. */
static double start_radiance(const struct problem *p, int lamp, int colour, double k_d, struct weighted *scratch)
{
    const struct light_fit *f = p->f;
    const double *direct = p->direct + (ptrdiff_t)lamp * f->point_count;
    size_t n = 0;
    for (int i = 0; i < f->point_count; i++)
        if (concerns(f, i, lamp, true) && direct[i] > 0)
            scratch[n++] = (struct weighted){
                (f->points[i].radiance[colour] / k_d - other_light(p, i, colour, lamp)) / direct[i], 1};
    const double s = weighted_percentile(scratch, n, 0.5);
    return s > 0 && isfinite(s) ? s : 0;
}

/* S of the lamps by (5.5), from medians, one lamp and colour after the other; some rounds, as lamps light each other's
 * points. ST_DATA: the lit points of a lamp are no brighter. */
static enum status start_lamps(struct problem *p, struct weighted *scratch, struct err *err)
{
    const struct light_fit *f = p->f;
    for (int round = 0; round < ROUNDS; round++)
        for (int l = 0; l < f->lamp_count; l++)
            for (int c = 0; f->lamps[l].fit && c < 3; c++)
                f->lamps[l].radiance[c] = start_radiance(p, l, c, start_k_d(p, l, c, scratch), scratch);
    for (int l = 0; l < f->lamp_count; l++) {
        struct fit_lamp *lamp = &f->lamps[l];
        const double best = fmax(lamp->radiance[0], fmax(lamp->radiance[1], lamp->radiance[2]));
        if (!lamp->fit) continue;
        if (!(best > 0))
            return err_set(
                err, ST_DATA,
                "%s: the lit points of the lamp %s are no brighter than its unlit points under the indirect light "
                "alone: the lamp is off, or they are of different materials.",
                place_of(f, l, true), lamp->name);
        for (int c = 0; c < 3; c++) lamp->radiance[c] = fmax(lamp->radiance[c], 0.01 * best);
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------- the solution */

static enum status solve(struct problem *p, struct err *err)
{
    const struct least_squares problem = {p->unknown_count, fit_residual_count(p), fit_evaluate, p, ITERATIONS};
    double x[MAX_UNKNOWNS];
    fit_get_unknowns(p, x);
    for (int m = 0; m < p->f->material_count; m++) {
        p->f->materials[m].deviation = p->f->texture;
        p->f->materials[m].length = 0;
        p->f->materials[m].grain = 1;
    }
    for (int round = 0; round < ROUNDS; round++) {
        if (fit_texture_set_covariance(p, err)) return err->status;
        if (p->unknown_count && ceres_least_squares(&problem, x, err)) return err->status;
        fit_set_unknowns(p, x);
        fit_texture_set_excess(p);
        if (round < ESTIMATES) fit_texture_estimate(p);
    }
    if (fit_texture_set_covariance(p, err)) return err->status;
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

static enum status check_spread(struct problem *p, struct weighted *scratch, struct err *err)
{
    for (int m = 0; m < p->f->material_count; m++) {
        struct fit_material *material = &p->f->materials[m];
        const char *place = "";
        for (int i = p->f->point_count - 1; i >= 0; i--)
            if (p->f->points[i].material == m) place = p->f->points[i].place;
        if (!(material->lit + material->unlit)) continue;
        material->spread = spread_of(p, m, scratch);
        if (material->spread > p->f->max_spread)
            return err_set(
                err, ST_DATA,
                "%s: the points of the material %s are not of one material: their reflectances differ by %.0f %%, at "
                "most %.0f %% are allowed (max_spread); choose points of one material.",
                place, material->name, 100 * material->spread, 100 * p->f->max_spread);
    }
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------------- all */

static enum status list_unknowns(struct problem *p, struct err *err)
{
    for (int l = 0; l < p->f->lamp_count; l++)
        for (int c = 0; p->f->lamps[l].fit && c < 3 + p->f->lamps[l].fit_exponent; c++) {
            if (p->unknown_count == MAX_UNKNOWNS)
                return err_set(err, ST_DATA,
                               "%d lamps are too many to be fitted together, at most %d; give the radiance of some.",
                               p->f->lamp_count, MAX_UNKNOWNS / 4);
            p->unknowns[p->unknown_count++] = (struct unknown){l, c};
        }
    return ST_OK;
}

static enum status fit_all(struct problem *p, struct weighted *scratch, double *jacobian, struct err *err)
{
    struct light_fit *f = p->f;
    for (int l = 0; l < f->lamp_count; l++) fit_set_direct(p, l);
    check_points(f, err);
    for (int l = 0; !err->status && l < f->lamp_count; l++)
        if (f->lamps[l].fit) check_lamp(p, l, err);
    if (!err->status && !start_lamps(p, scratch, err) && !solve(p, err)) check_spread(p, scratch, err);
    if (err->status) return err->status;
    fit_set_errors(p, jacobian);
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
    const size_t n = (size_t)p->f->point_count, square = n * n;
    if (n > MAX_FIT_POINTS)
        return err_set(err, ST_DATA,
                       "%s: %zu points are marked for lamps, at most %d can be fitted; lower [fit_lights] grid.",
                       p->f->points[0].place, n, MAX_FIT_POINTS);
    p->direct = calloc(n * (size_t)p->f->lamp_count + 1, sizeof *p->direct);
    p->logs = calloc(3 * n, sizeof *p->logs);
    p->excess = calloc(n, sizeof *p->excess);
    p->factor = calloc(square, sizeof *p->factor);
    p->ones = calloc(n * (size_t)p->f->material_count, sizeof *p->ones);
    p->whitened = calloc(3 * n, sizeof *p->whitened);
    p->vector = calloc(n, sizeof *p->vector);
    p->next_excess = calloc(n, sizeof *p->next_excess);
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
    if (list_unknowns(&p, err) || !f->point_count) return err->status;
    reserve(&p, err);
    struct weighted *scratch = calloc(3 * (size_t)f->point_count, sizeof *scratch);
    double *jacobian = calloc((size_t)fit_residual_count(&p) * (size_t)(p.unknown_count + 1), sizeof *jacobian);
    if (!err->status && (!scratch || !jacobian)) err_nomem(err, "points of lamps", (size_t)f->point_count);
    if (!err->status) fit_all(&p, scratch, jacobian, err);
    release(&p);
    free(scratch);
    free(jacobian);
    return err->status;
}
