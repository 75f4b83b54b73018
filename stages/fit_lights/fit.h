/* fit.h - radiance of lamps and reflectance of materials, from the radiance of points that lamps light and do not
 * light. */
#ifndef REMODEL_FIT_LIGHTS_FIT_H
#define REMODEL_FIT_LIGHTS_FIT_H

#include "common/base/err.h"
#include "stages/fit_lights/light_fit.h"

enum { FIT_DRAWS = 3200 /* determine intervals to about a tenth of their width */, FIT_FEW_DRAWS = 800 };

/* Fills what is to be found: radiances, exponents, k_d; with `draws` also errors, intervals and the offsets of marks.
 * Nothing that is marked is an error; what it does not determine has wide intervals. At most MAX_FIT_POINTS points. */
enum status fit_solve(struct light_fit *f, struct err *err);

#endif
