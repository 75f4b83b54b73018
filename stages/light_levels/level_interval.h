/* level_interval.h - how sure the mean illuminance of an area is, by the scale and the metre; and on the page of light
 * levels, which has no shares of groups, altogether. */
#ifndef REMODEL_LEVELS_LEVEL_INTERVAL_H
#define REMODEL_LEVELS_LEVEL_INTERVAL_H

#include <stdbool.h>

#include "common/daylight/lux_scale.h"
#include "common/model/model_metre.h"
#include "stages/light_levels/levels_params.h"
#include "stages/light_levels/light_errors.h"

/* What light is of. */
struct level_origin {
    bool photographs; /* some is in the photographs' unit */
    bool planned;     /* some is that of planned lamps */
};

/* The variance of a mean's logarithm to both sides: by the scale from the photographs' unit to cd/m2 (lux_scale.h),
 * which counts for light of the photographs alone, and by a guessed metre, with whose square planned lamps go. */
void level_interval_variance(double variance[2], struct level_origin of, const struct lux_interval *scale,
                             const struct model_metre *metre);

/* By what a mean is multiplied for the ends of its interval of 95 %: by these, the model's error, and that of the least
 * certain light: a sky that was not photographed, or, of the photographs', a group. */
void level_interval(double ends[2], struct level_origin of, const struct levels_params *params,
                    const struct light_errors *errors, const struct lux_interval *scale,
                    const struct model_metre *metre);

#endif
