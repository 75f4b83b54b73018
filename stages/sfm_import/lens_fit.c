/* lens_fit.c - whether a lens model fits: its reprojection residuals by distance from the picture's centre.
 *
 * Bundle adjustment with a lens model that cannot bend as the lens does (SIMPLE_RADIAL on a fisheye) still ends with a
 * model: poses and points absorb part of the error, observations near the rim that do not fit are dropped. Two traces
 * remain. (1) The residuals grow towards the rim. (2) They have a systematic radial component, outwards in some rings
 * and inwards in others, which noise does not have.
 *
 * The pictures are divided into RINGS rings of equal width. (1) compares the median error of the outermost ring with at
 * least MIN_OBSERVATIONS with the median within a quarter of its radius. The standard error of a median of n lengths
 * with normally distributed components is median / (1.39 sqrt n), 13 % for n = 30, so that a ratio of 1.5 is nearly
 * four of them. (2) takes the ring with the largest median radial component, among those with at least MIN_BIASED
 * observations and one in MIN_BIASED_SHARE of all: a bias in the far corners alone costs little.
 *
 * The absolute thresholds keep models with tiny residuals silent. They grow with the picture, because the noise of
 * features does: large photos are scaled down before features are found. The thresholds were chosen on these models;
 * medians in px, middle -> rim, and the largest radial bias:
 *   fits:         kermit 0.22 -> 0.25, 0.03; fern 0.53 -> 0.57, 0.05; fountain 0.21 -> 0.16, 0.01;
 *                 bonsai 0.28 -> 0.54, 0.09;
 *                 loft (a fisheye) as OPENCV_FISHEYE 0.30 -> 0.29, 0.01; sceaux as OPENCV 0.25 -> 0.30, 0.01;
 *                 apartment (a fisheye) as EQUISOLID 0.28 -> 0.21, 0.03
 *   does not fit: apartment as SIMPLE_RADIAL 0.79 -> 1.41, 0.11, as SIMPLE_PINHOLE 0.74 -> 1.15, 0.13,
 *                 as OPENCV 0.72 -> 0.70, 0.28; sceaux as SIMPLE_RADIAL 0.31 -> 1.16, 0.10 */
#include "stages/sfm_import/lens_fit.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"

enum { RINGS = 10, MIN_OBSERVATIONS = 30, MIN_BIASED = 200, MIN_BIASED_SHARE = 20 };

static const double MIN_RATIO = 1.5;
static const double MIN_GROWTH = 0.4, MIN_GROWTH_DIAGONAL = 1.0 / 5000; /* px; of the diagonal. The larger one counts */
static const double MIN_BIAS = 0.2, MIN_BIAS_DIAGONAL = 1.0 / 6000;

static int ring_of(double radius) { return radius < 1 ? (int)(radius * RINGS) : RINGS - 1; }

/* Outermost ring with enough observations; -1: none. */
static int rim_ring(const size_t count[RINGS])
{
    int ring = RINGS - 1;
    while (ring >= 0 && count[ring] < MIN_OBSERVATIONS) ring--;
    return ring;
}

enum status lens_fit_measure(struct lens_fit *fit, const struct lens_residual *residuals, size_t count, struct err *err)
{
    size_t in_ring[RINGS] = {0}, n = 0;
    *fit = (struct lens_fit){0};
    for (size_t i = 0; i < count; i++) in_ring[ring_of(residuals[i].radius)]++;
    const int rim = rim_ring(in_ring);
    const double rim_radius = (rim + 1.0) / RINGS;
    if (rim < 2) return ST_OK;
    double *values = malloc(count * sizeof *values);
    if (!values) return err_nomem(err, "residuals", count * sizeof *values);
    for (size_t i = 0; i < count; i++)
        if (residuals[i].radius < rim_radius / 4) values[n++] = residuals[i].error;
    if (n >= MIN_OBSERVATIONS) {
        fit->measured = true;
        fit->rim_radius = rim_radius;
        fit->middle = sort_median(values, n);
    }
    for (int ring = 0; fit->measured && ring < RINGS; ring++) {
        const bool many = in_ring[ring] >= MIN_BIASED && in_ring[ring] * MIN_BIASED_SHARE >= count;
        if (ring != rim && !many) continue;
        n = 0;
        for (size_t i = 0; i < count; i++)
            if (ring_of(residuals[i].radius) == ring) values[n++] = residuals[i].error;
        if (ring == rim) fit->rim = sort_median(values, n);
        if (!many) continue;
        n = 0;
        for (size_t i = 0; i < count; i++)
            if (ring_of(residuals[i].radius) == ring) values[n++] = residuals[i].radial;
        const double bias = sort_median(values, n);
        if (fabs(bias) <= fabs(fit->bias)) continue;
        fit->bias = bias;
        fit->bias_radius = (ring + 0.5) / RINGS;
    }
    free(values);
    return ST_OK;
}

bool lens_fit_grows(const struct lens_fit *fit, double diagonal)
{
    return fit->measured && fit->rim >= MIN_RATIO * fit->middle &&
           fit->rim - fit->middle >= fmax(MIN_GROWTH, MIN_GROWTH_DIAGONAL * diagonal);
}

bool lens_fit_is_biased(const struct lens_fit *fit, double diagonal)
{
    return fit->measured && fabs(fit->bias) >= fmax(MIN_BIAS, MIN_BIAS_DIAGONAL * diagonal);
}
