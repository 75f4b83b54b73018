/* fit_chain.h - how sure the radiance of lamps and the reflectance of materials are. */
#ifndef REMODEL_FIT_LIGHTS_FIT_CHAIN_H
#define REMODEL_FIT_LIGHTS_FIT_CHAIN_H

#include "common/base/err.h"
#include "stages/fit_lights/fit_problem.h"

/* Sets the intervals and standard errors of lamps and materials, how materials vary, and the offsets of marks; from the
 * present solution, which becomes the chain's median. */
enum status fit_chain_run(struct problem *p, struct err *err);

#endif
