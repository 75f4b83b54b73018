/* material_fit.h - the reflectance of a material from samples: Lambert, Phong or Ward. */
#ifndef REMODEL_MATERIAL_FIT_H
#define REMODEL_MATERIAL_FIT_H

#include <stdbool.h>

#include "stages/fit_materials/material_samples.h"

/* The unknowns: k_d of three channels (1/sr), the lobe's reflectance, ln s. Of Lambert the first three. */
enum { FIT_RED, FIT_GREEN, FIT_BLUE, FIT_GLOSS, FIT_LOG_S, FIT_UNKNOWNS };

struct interval {
    double low, high; /* 95 % */
};

struct material_fit {
    enum brdf_kind kind;
    double x[FIT_UNKNOWNS];
    double k_d[3], ks, shape; /* what x means; ks and shape are 0 for Lambert */
    struct interval k_d_range[3], ks_range, shape_range;
    bool gloss_known; /* the samples tell the lobe from the diffuse part */
    double scale;     /* residuals are about this many standard deviations; at least 1 */
    double cost;      /* sum of the robust losses of the samples */
    bool converged;
};

/* The mean loss grows as the logarithm beyond this many standard deviations of a sample (its three channels). */
#define FIT_CAUCHY 4.0

int fit_unknowns(enum brdf_kind kind);

/* The radiance of each row, and unless it is NULL its derivatives [row][fit_unknowns(kind)]. scratch: 6 count
 * numbers. */
void fit_predict(const struct material_samples *s, enum brdf_kind kind, const double *x, double *scratch,
                 double *predicted, double *jacobian);

/* Fits one model to the samples that `used` marks (NULL: all). ST_DATA: nothing to fit: no light, no samples. Only for
 * `fit->gloss_known` are ks and shape what the samples show. */
enum status material_fit(struct material_fit *fit, const struct material_samples *s, enum brdf_kind kind,
                         const bool *used, struct err *err);

/* The same from the solution of another fit of the same kind, at its scale: for a part of the samples. */
enum status material_fit_again(struct material_fit *fit, const struct material_fit *from,
                               const struct material_samples *s, const bool *used, struct err *err);

/* The robust loss of each sample, in units of variance times scale^2. */
enum status material_fit_losses(double *losses, const struct material_fit *fit, const struct material_samples *s,
                                double scale, struct err *err);

#endif
