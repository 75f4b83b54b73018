/* group_fit.h - how bright groups of light are by measurements in states of switches. */
#ifndef REMODEL_LEVELS_GROUP_FIT_H
#define REMODEL_LEVELS_GROUP_FIT_H

#include "common/base/err.h"

/* lx = sum of light[group] x factor[group], with a relative standard error. */
struct group_measurement {
    double *light;     /* of each group, as photographed, in lx; owned by the caller */
    double lux, other; /* measured; that no group of the photographs brings, in lx */
    double error;
    double deviation; /* of what the factors give, in standard errors; set by the fit */
};

struct group_factor {
    double factor, low, high; /* 95 % */
    int measurements;         /* in which it brings at least a tenth of the light */
};

/* What a photo in another state shows of a patch, over what the textures show, which were photographed with all groups:
 * the photo's exposure times sum(weights light factor) / sum(light factor). */
struct group_quotient {
    const double *light;   /* of each group, as photographed, in any unit; not owned */
    const double *weights; /* of each group in the photo's state; not owned */
    double quotient;
};

/* A photo, and how it is exposed, times as the photos of the textures. */
struct group_photo {
    const struct group_quotient *patches; /* not owned */
    int count;
    double known;            /* its exposure, to 5 %; 0: unknown */
    double exposure, misfit; /* set by the fit; median of what patches are off by, relative */
};

/* Each factor is 1 before anything is measured, within `spread` (a standard deviation). ST_NOMEM. */
enum status group_fit(struct group_factor *factors, int groups, struct group_measurement *m, int count, double spread,
                      struct err *err);
/* The same with photos; error: of a patch's quotient, relative, beside the fit's own robustness. */
enum status group_fit_photos(struct group_factor *factors, int groups, struct group_measurement *m, int count,
                             struct group_photo *photos, int photo_count, double error, double spread, struct err *err);

#endif
