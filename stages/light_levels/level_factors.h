/* level_factors.h - how bright lamps and windows of the photographs are, by what somebody measured in states of
 * switches, and by photos in such states.
 *
 * factors.txt has the lines
 *
 *   remodel-light-factors 1
 *   scale LX LOW HIGH                          of the photographs' unit; 0 0 0: it is not known
 *   lamp|window NAME FACTOR LOW HIGH COUNT     of what the photographs show; COUNT: measurements and
 *                                              photos that it matters in
 *   rest FACTOR LOW HIGH COUNT                 of what no lamp and no window explains */
#ifndef REMODEL_LEVELS_LEVEL_FACTORS_H
#define REMODEL_LEVELS_LEVEL_FACTORS_H

#include "common/daylight/lux_scale.h"
#include "stages/light_levels/group_fit.h"
#include "stages/light_levels/level_sums.h"
#include "stages/light_levels/other_light.h"
#include "stages/light_levels/sensors.h"

/* {0} is the empty state: nothing is known, and factors are 1. Owned. */
struct level_factors {
    struct lux_interval scale;
    struct group_factor *list; /* of lamps, the rest, windows */
    int count;
    double *of_groups; /* of the groups of light that the photographs show */
};

/* What the factors come from. */
struct factor_sources {
    const struct level_light *light;
    const struct level_points *points;
    const struct sensors *sensors;
    const struct state_list *states;
    const struct levels_params *params;
    const struct other_light *photos; /* in other light; the fit says how well they go with it */
    struct lux_interval scale;        /* 0: unknown, and then the measurements give it */
};

/* Without lines `measured` and `photo` the factors stay empty. ST_DATA: a place that places.txt does not have, or a
 * state without light of the photographs. The caller releases f in each case. */
enum status level_factors_make(struct level_factors *f, const struct factor_sources *from, struct err *err);
void level_factors_release(struct level_factors *f);

enum status level_factors_write(const struct level_factors *f, const struct light_groups *groups, const char *path,
                                const struct provenance *prov, struct err *err);
/* Lamps and windows that an edit took away are left out, and those that it made have the factor 1. */
enum status level_factors_read(struct level_factors *f, const struct light_groups *groups, const char *path,
                               struct provenance *prov, struct err *err);

#endif
