/* light_quotient.h - by what a texel's radiance is multiplied when its irradiance changes [Colburn 2014, 5.5]. */
#ifndef REMODEL_LIGHT_QUOTIENT_H
#define REMODEL_LIGHT_QUOTIENT_H

#include <stdbool.h>

#include "common/light/colour.h"

#define LIGHT_ALBEDO_MAX 0.95

/* The quotient by channel for a surface of this radiance under the irradiance `before`, when it becomes `after`;
 * exactly 1 where they are equal. Never negative or NaN. *is_bounded (NULL: not asked for) is set to true where the
 * rule of light_quotient.c applied, and left alone elsewhere. */
struct rgb light_quotient(struct rgb before, struct rgb after, struct rgb radiance, bool *is_bounded);

/* pi L / E by channel; INFINITY where there is radiance without irradiance, 0 where there is neither. */
struct rgb light_albedo(struct rgb before, struct rgb radiance);

#endif
