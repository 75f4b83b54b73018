/* face_light.c - see face_light.h.
 *
 * Overview. A few rectangles on one or two walls see a narrow range of light, so that texture, and the errors of
 * indirect light there, pass for light of a lamp. Over all photographed faces the share of a lamp runs from a tenth,
 * at the top of walls, to nine tenths, and each wall's error is its own. So every square of every face is evidence:
 * the reflectance of a face is the same in the light and beside it, whatever it is.
 *
 * Mathematics. Square i of face f has radiance L_i, irradiance E_i from all but the lamps, and D_ij from lamp j of
 * radiance 1. The residuals
 *     r_i = log L_i - log(E_i + sum over j of S_j D_ij) - m_f
 * have Student's t distribution with FREEDOM degrees and a width of the face, so that prints, rugs, pictures and
 * patches of sun count little, and a face of boards counts less than a plain one. S, the means m and the widths are
 * those of the greatest likelihood, by iteratively reweighted least squares [Lange 1989]: the means are eliminated,
 * each step of log S solves the normal equations, and widths follow from the weighted squares. It begins with lamps
 * that give as much light as all else where they shine most, and with wide distributions, so that hardly any square
 * is left out before the lamps are about right. Each colour is fitted alone.
 *
 * Errors. The errors of indirect light differ from face to face, so the standard errors are a jackknife over faces,
 * made wider for so few of them (the quantile of Student's t distribution over that of the normal one), and never
 * below that of independent squares. A lamp that only one face shows is unknown.
 *
 * Limits. A face of which one part is of another material, just where a lamp shines, is believed; the other faces and
 * the jackknife say so. Ceilings above lamps tell nothing. */
#include "stages/fit_lights/face_light.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/cholesky.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"

enum { LEAST_SQUARES = 20, LEAST_FACES = 3, STEPS = 60, FEW_STEPS = 25, MEANS = 3, WIDE_STEPS = 10 };
#define FREEDOM     2.0
#define WIDE        0.3     /* the width at the start: a factor of 1.35 */
#define LEAST_WIDTH 0.03    /* of a face */
#define LARGEST     0.5     /* step of a logarithm */
#define SMALLEST    1e-4    /* step that ends the fit */
#define RIDGE       1e-6    /* of the squares' weights: what a lamp without light at any square is held by */
#define USUAL       0.98    /* of the squares of lit faces are lit less */
#define DARKEST     (-13.0) /* logarithm of radiance: squares below it are black */
#define LEAST_ERROR 0.02
#define MOST_ERROR  0.5 /* standard error of the logarithm of a radiance that is still known */

struct face {
    int first, end; /* of the squares that count */
    double middle, width, weight;
};

struct fit {
    const struct face_light *l;
    int colour, count, face_count; /* count: of squares on lit faces */
    int *squares;                  /* [count] of faces, one after the other */
    struct face *faces;
    double *logs, *known;                 /* [count] of the colour */
    double *residuals, *weights, *slopes; /* [count]; slopes: [lamp][count] */
    double *x;                            /* [lamp] logarithm of the radiance */
    double *normal, *step;                /* [lamp][lamp], [lamp] */
    struct weighted *scratch;             /* [count] */
};

static double factor_of(const struct fit *f, int lamp, int i)
{
    return f->l->factors[(size_t)lamp * (size_t)f->l->squares->count + (size_t)f->squares[i]];
}

/* ------------------------------------------------------------------------------------------------------ the squares */

static bool counts(const struct face_light *l, int i)
{
    const struct atlas_square *s = &l->squares->list[i];
    bool count = true;
    for (int c = 0; c < 3; c++) count &= l->known[i][c] > 0 && (double)s->level[c] > DARKEST;
    return count;
}

static bool is_lit(const struct face_light *l, int i)
{
    bool lit = false;
    for (int k = 0; k < l->lamp_count; k++) lit |= l->factors[(size_t)k * (size_t)l->squares->count + (size_t)i] > 0;
    return lit;
}

/* Lists the squares of faces that lamps light; a face with few of them tells nothing. */
static void list_squares(struct fit *f)
{
    const struct atlas_squares *s = f->l->squares;
    for (int first = 0, end = 0; first < s->count; first = end) {
        bool lit = false;
        const int before = f->count;
        for (; end < s->count && s->list[end].tile == s->list[first].tile; end++) {
            if (!counts(f->l, end)) continue;
            lit |= is_lit(f->l, end);
            f->squares[f->count++] = end;
        }
        if (lit && f->count - before >= LEAST_SQUARES)
            f->faces[f->face_count++] = (struct face){.first = before, .end = f->count};
        else
            f->count = before;
    }
}

static void set_colour(struct fit *f, int colour)
{
    f->colour = colour;
    for (int i = 0; i < f->count; i++) {
        f->logs[i] = (double)f->l->squares->list[f->squares[i]].level[colour];
        f->known[i] = f->l->known[f->squares[i]][colour];
    }
}

/* ---------------------------------------------------------------------------------------------------------- the fit */

/* As much light as all else, at the squares that a lamp lights best. */
static void begin(struct fit *f)
{
    for (int k = 0; k < f->l->lamp_count; k++) {
        for (int i = 0; i < f->count; i++) f->scratch[i] = (struct weighted){factor_of(f, k, i) / f->known[i], 1};
        const double most = weighted_percentile(f->scratch, (size_t)f->count, USUAL);
        f->x[k] = most > 0 ? -log(most) : 0;
    }
}

/* Sets residuals, without the means of faces, and their slopes by log S. */
static void set_residuals(struct fit *f)
{
    const int lamps = f->l->lamp_count;
    for (int i = 0; i < f->count; i++) {
        double e = f->known[i];
        for (int k = 0; k < lamps; k++) {
            const double light = exp(f->x[k]) * factor_of(f, k, i);
            f->slopes[(size_t)k * (size_t)f->count + (size_t)i] = light;
            e += light;
        }
        for (int k = 0; k < lamps; k++) f->slopes[(size_t)k * (size_t)f->count + (size_t)i] /= e;
        f->residuals[i] = f->logs[i] - log(e);
    }
}

static double median_of(const struct fit *f, const struct face *face)
{
    size_t n = 0;
    for (int i = face->first; i < face->end; i++) f->scratch[n++] = (struct weighted){f->residuals[i], 1};
    return weighted_percentile(f->scratch, n, 0.5);
}

/* Sets the weights of a face's squares, as parts of that of a square in the middle; moves the mean with them. */
static void weigh(struct fit *f, struct face *face)
{
    for (int round = 0; round <= MEANS; round++) {
        double sum = 0, all = 0;
        for (int i = face->first; i < face->end; i++) {
            const double off = (f->residuals[i] - face->middle) / face->width;
            f->weights[i] = (FREEDOM + 1) / (FREEDOM + off * off);
            sum += f->weights[i] * f->residuals[i];
            all += f->weights[i];
        }
        if (round < MEANS) face->middle = sum / all;
    }
}

static void set_width(struct fit *f, struct face *face)
{
    double sum = 0;
    for (int i = face->first; i < face->end; i++) {
        const double off = f->residuals[i] - face->middle;
        sum += f->weights[i] * off * off;
    }
    face->width = fmax(sqrt(sum / (face->end - face->first)), LEAST_WIDTH);
}

/* Adds a face to the normal equations, its mean eliminated. */
static void add_face(struct fit *f, const struct face *face)
{
    const int lamps = f->l->lamp_count;
    const double precision = 1 / (face->width * face->width);
    double all = 0;
    for (int i = face->first; i < face->end; i++) all += f->weights[i];
    for (int a = 0; a < lamps; a++) {
        const double *slopes = f->slopes + (size_t)a * (size_t)f->count;
        double mean = 0;
        for (int i = face->first; i < face->end; i++) mean += f->weights[i] * slopes[i] / all;
        for (int i = face->first; i < face->end; i++) {
            const double own = precision * f->weights[i] * (slopes[i] - mean);
            f->step[a] += own * (f->residuals[i] - face->middle);
            for (int b = 0; b <= a; b++)
                f->normal[a * lamps + b] += own * f->slopes[(size_t)b * (size_t)f->count + (size_t)i];
        }
    }
}

/* Solves for a step, without the face `left_out`. Returns its largest element, or -1 if it has no solution. `normal`
 * then holds the factor. */
static double advance(struct fit *f, int left_out)
{
    const int lamps = f->l->lamp_count;
    double largest = 0, weight = 0;
    memset(f->normal, 0, (size_t)lamps * (size_t)lamps * sizeof *f->normal);
    memset(f->step, 0, (size_t)lamps * sizeof *f->step);
    for (int k = 0; k < f->face_count; k++) {
        if (k == left_out) continue;
        add_face(f, &f->faces[k]);
        weight += (f->faces[k].end - f->faces[k].first) / (f->faces[k].width * f->faces[k].width);
    }
    for (int a = 0; a < lamps; a++) f->normal[a * lamps + a] += RIDGE * weight;
    if (!cholesky_factor(f->normal, lamps)) return -1;
    cholesky_forward(f->normal, lamps, f->step);
    cholesky_backward(f->normal, lamps, f->step);
    for (int a = 0; a < lamps; a++) {
        const double step = clamp(f->step[a], -LARGEST, LARGEST);
        f->x[a] += step;
        largest = fmax(largest, fabs(step));
    }
    return largest;
}

/* Steps from the present radiances; false: they did not come to rest. */
static bool descend(struct fit *f, int left_out, int steps)
{
    double step = 1;
    set_residuals(f);
    for (int k = 0; k < f->face_count; k++) {
        f->faces[k].middle = median_of(f, &f->faces[k]);
        f->faces[k].width = WIDE;
    }
    for (int n = 0; n < steps && (n <= WIDE_STEPS || step > SMALLEST); n++) {
        for (int k = 0; k < f->face_count; k++) {
            weigh(f, &f->faces[k]);
            set_width(f, &f->faces[k]);
            weigh(f, &f->faces[k]);
        }
        step = advance(f, left_out);
        if (step < 0) return false;
        set_residuals(f);
    }
    return step < 100 * SMALLEST;
}

/* ------------------------------------------------------------------------------------------------------- the errors */

/* The quantile of 97.5 % of Student's t distribution over that of the normal one [Abramowitz 1964, 26.7.5]. */
static double few_faces(int faces)
{
    const double n = faces - 1, z2 = 1.96 * 1.96;
    return 1 + (z2 + 1) / (4 * n) + (5 * z2 * z2 + 16 * z2 + 3) / (96 * n * n);
}

/* The standard error of a lamp if squares were independent; the factor of the normal equations is at hand. */
static double formal_error(struct fit *f, int lamp)
{
    const int lamps = f->l->lamp_count;
    memset(f->step, 0, (size_t)lamps * sizeof *f->step);
    f->step[lamp] = 1;
    cholesky_forward(f->normal, lamps, f->step);
    double sum = 0;
    for (int a = 0; a < lamps; a++) sum += f->step[a] * f->step[a];
    return sqrt(sum);
}

/* Sets the variance of each lamp, from what leaving out each face makes of it; sums: room for each lamp. */
static void jackknife(struct fit *f, const double *best, double *sums, double *squares)
{
    const int lamps = f->l->lamp_count;
    const double n = f->face_count;
    memset(sums, 0, (size_t)lamps * sizeof *sums);
    memset(squares, 0, (size_t)lamps * sizeof *squares);
    for (int k = 0; k < f->face_count; k++) {
        memcpy(f->x, best, (size_t)lamps * sizeof *f->x);
        const bool rests = descend(f, k, FEW_STEPS);
        for (int a = 0; a < lamps; a++) {
            const double off = f->x[a] - best[a];
            sums[a] += off;
            squares[a] += off * off;
            if (!rests || formal_error(f, a) > MOST_ERROR) squares[a] = INFINITY; /* only one face shows it */
        }
    }
    const double wider = few_faces(f->face_count) * few_faces(f->face_count);
    for (int a = 0; a < lamps; a++) squares[a] = fmax(squares[a] - sums[a] * sums[a] / n, 0) * (n - 1) / n * wider;
}

static void fit_colour(struct face_lamp *lamps, struct fit *f, int colour, double *room)
{
    const int count = f->l->lamp_count;
    double *best = room, *formal = room + count, *sums = room + 2 * count, *squares = room + 3 * count;
    set_colour(f, colour);
    begin(f);
    const bool rests = descend(f, -1, STEPS);
    for (int a = 0; a < count; a++) {
        best[a] = f->x[a];
        formal[a] = rests ? formal_error(f, a) : INFINITY;
    }
    if (rests) jackknife(f, best, sums, squares);
    for (int a = 0; a < count; a++) {
        lamps[a].radiance[colour] = exp(clamp(best[a], -60, 60));
        lamps[a].error[colour] = rests ? fmax(fmax(sqrt(squares[a]), formal[a]), LEAST_ERROR) : INFINITY;
        lamps[a].is_known &= lamps[a].error[colour] < MOST_ERROR;
    }
}

/* -------------------------------------------------------------------------------------------------------------- all */

static void release(struct fit *f)
{
    free(f->squares);
    free(f->faces);
    free(f->logs);
    free(f->x);
    free(f->scratch);
}

static enum status reserve(struct fit *f, struct err *err)
{
    const size_t squares = (size_t)f->l->squares->count + 1, lamps = (size_t)f->l->lamp_count;
    const size_t numbers = squares * (4 + lamps);
    f->squares = calloc(squares, sizeof *f->squares);
    f->faces = calloc(squares, sizeof *f->faces);
    f->logs = calloc(numbers, sizeof *f->logs);
    f->x = calloc(6 * lamps + lamps * lamps, sizeof *f->x);
    f->scratch = calloc(squares, sizeof *f->scratch);
    if (!f->squares || !f->faces || !f->logs || !f->x || !f->scratch)
        return err_nomem(err, "squares of faces", numbers * sizeof *f->logs);
    f->known = f->logs + squares;
    f->residuals = f->known + squares;
    f->weights = f->residuals + squares;
    f->slopes = f->weights + squares;
    f->step = f->x + lamps;
    f->normal = f->step + 5 * lamps;
    return ST_OK;
}

enum status face_light_fit(struct face_lamp *lamps, const struct face_light *l, struct err *err)
{
    struct fit f = {.l = l};
    for (int k = 0; k < l->lamp_count; k++) lamps[k] = (struct face_lamp){0};
    if (!l->lamp_count || reserve(&f, err)) {
        release(&f);
        return err->status;
    }
    list_squares(&f);
    if (f.face_count >= LEAST_FACES) {
        for (int k = 0; k < l->lamp_count; k++) lamps[k].is_known = true;
        for (int c = 0; c < 3; c++) fit_colour(lamps, &f, c, f.step + l->lamp_count);
    }
    release(&f);
    return err->status;
}
