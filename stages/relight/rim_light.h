/* rim_light.h - light before an edit at places that the unedited model does not have: that of the rim around them. */
#ifndef REMODEL_RELIGHT_RIM_LIGHT_H
#define REMODEL_RELIGHT_RIM_LIGHT_H

#include "common/gather/irradiance.h"
#include "stages/relight/pixels.h"
#include "stages/relight/relight_params.h"

/* Sets the light before the edit, and the error of the quotient, of all pixels that show a new place; after: the light
 * after it. Other pixels keep theirs. Equal places get equal light in all pictures; same bits for any number of
 * threads. ST_NOMEM. */
enum status rim_light_fill(struct irradiance *before, float *error, const struct irradiance *after,
                           const struct pixels *p, const struct light_change *c, const struct relight_params *params,
                           struct err *err);

#endif
