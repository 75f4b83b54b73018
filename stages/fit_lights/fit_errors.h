/* fit_errors.h - how sure the radiance of lamps and the reflectance of materials are. */
#ifndef REMODEL_FIT_LIGHTS_FIT_ERRORS_H
#define REMODEL_FIT_LIGHTS_FIT_ERRORS_H

#include "stages/fit_lights/fit_problem.h"

/* Sets the standard errors of lamps and materials. jacobian: room for a number per unknown and residual. */
void fit_set_errors(struct problem *p, double *jacobian);

#endif
