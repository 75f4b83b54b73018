/* quotients.h - quotients of light that are sure: without noise, and 1 where the change may be an error. */
#ifndef REMODEL_RELIGHT_QUOTIENTS_H
#define REMODEL_RELIGHT_QUOTIENTS_H

#include "stages/relight/pixels.h"
#include "stages/relight/relight_params.h"

/* How far a pixel's quotient can be trusted: the channel A of the picture of quotients. */
#define RELIT_SURE    1.0f
#define RELIT_BOUNDED 0.5f /* the rule of light_quotient.c applied, or there was no light before */
#define RELIT_NONE    0.0f /* no surface of the model: its light stays */

/* quotient: R G B and A of each pixel; error: the relative standard error of each. Quotients of exactly 1
 * without an error, and of 0, stay. Same bits for any number of threads. ST_NOMEM. */
enum status quotients_settle(float (*quotient)[4], const float *error, const struct pixels *p,
                             const struct relight_params *params, struct err *err);

#endif
