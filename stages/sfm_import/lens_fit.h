/* lens_fit.h - whether a lens model fits: its reprojection residuals by distance from the picture's centre. */
#ifndef REMODEL_LENS_FIT_H
#define REMODEL_LENS_FIT_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

/* One observation. Lengths in px. */
struct lens_residual {
    double radius; /* distance from the picture's centre in half diagonals: 0 centre, 1 corner */
    double error;  /* length of the residual, finite */
    double radial; /* its component away from the centre */
};

struct lens_fit {
    bool measured;     /* enough observations; if false all other members are 0 */
    double middle;     /* median error within a quarter of rim_radius */
    double rim;        /* median error in the outermost ring that has enough observations */
    double rim_radius; /* outer radius of that ring */
    double bias;       /* the median radial component, of the ring where its magnitude is largest */
    double bias_radius;
};

/* ST_NOMEM. */
enum status lens_fit_measure(struct lens_fit *fit, const struct lens_residual *residuals, size_t count,
                             struct err *err);

/* Verdicts; diagonal: of the pictures, in px. Both are false if the fit was not measured. */
bool lens_fit_grows(const struct lens_fit *fit, double diagonal);
bool lens_fit_is_biased(const struct lens_fit *fit, double diagonal);

#endif
