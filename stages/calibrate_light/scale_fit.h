/* scale_fit.h - one scale for a scene, from the exposures of its photos or from measurements. */
#ifndef REMODEL_SCALE_FIT_H
#define REMODEL_SCALE_FIT_H

#include "common/capture/photo_list.h"
#include "common/daylight/lux_scale.h"
#include "stages/calibrate_light/calibrate_params.h"

/* The exposure at which 1 in a view of this photo is white: seconds x ISO / (f-number^2 x filter). 0: unknown, since
 * the record lacks one of them. */
double scale_exposure(const struct photo_record *r);

/* From exposures above 0, whose order changes. count 0: all is 0. */
struct lux_interval scale_of_exposures(double *exposures, int count, const struct calibrate_params *p);

/* From value, light and expected of at least one measurement; sets deviation and off of each. */
struct lux_interval scale_of_measurements(struct lux_measurement *m, int count, const struct calibrate_params *p);

#endif
