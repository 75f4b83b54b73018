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

/* Each factor is 1 before anything is measured, within `spread` (a standard deviation). ST_NOMEM. */
enum status group_fit(struct group_factor *factors, int groups, struct group_measurement *m, int count, double spread,
                      struct err *err);

#endif
