/* radiosity.h - reflections between patches, for all groups of light together. */
#ifndef REMODEL_LEVELS_RADIOSITY_H
#define REMODEL_LEVELS_RADIOSITY_H

#include "stages/light_levels/rows.h"

/* What a patch does with light. */
struct patch_colour {
    struct rgb reflectance;
    struct rgb rest; /* radiance of the group `rest` */
};

struct radiosity {
    float *radiance; /* of each patch: radiance[(patch * groups + group) * 3 + channel]; owned */
    int rounds;      /* most rounds of a group */
};

/* Solves until a round changes no group of a patch by more than `tolerance` of the group's largest radiance. rest: the
 * number of that group. Same bits for any number of threads. The caller releases r in each case. ST_NOMEM. */
enum status radiosity_solve(struct radiosity *r, const struct light_rows *rows, const struct patch_colour *colours,
                            int rest, double tolerance, struct err *err);
void radiosity_release(struct radiosity *r);

/* The irradiance at a row of `at` from each group: to[group * 3 + channel]. */
void radiosity_gather(float *to, const struct light_rows *at, int row, const struct radiosity *r);

#endif
