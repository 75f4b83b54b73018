/* fit.h - radiance of lamps and reflectance of materials, from the radiance of points that lamps light and do not
 * light. */
#ifndef REMODEL_FIT_LIGHTS_FIT_H
#define REMODEL_FIT_LIGHTS_FIT_H

#include "common/base/err.h"
#include "stages/fit_lights/light_fit.h"

/* Fills what is to be found. ST_DATA with the reason: no indirect light, points that are lit alike, points of different
 * materials, too few points. */
enum status fit_solve(struct light_fit *f, struct err *err);

#endif
