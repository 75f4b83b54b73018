/* sun_light.h - how much light the sun gives, from how much brighter its patches are than what is beside them. */
#ifndef REMODEL_SUN_LIGHT_H
#define REMODEL_SUN_LIGHT_H

#include "stages/bake_outdoors/sun_fit.h"
#include "stages/bake_outdoors/sun_indoors.h"

struct sun_light {
    struct rgb irradiance; /* of a surface that faces the sun */
    double error;          /* relative: half the width of its interval of 95 % */
    double lamps;          /* share of the light beside its patches that comes from fitted lamps */
    int places;            /* at which it was measured; 0: at none, and irradiance is 0 */
};

/* texels: squares close to the edges of the patches of a sun of this direction and radius (degrees); in: the outdoors
 * without it. ST_NOMEM. */
enum status sun_light_measure(struct sun_light *l, const struct sun_indoors *in, const struct atlas_squares *texels,
                              struct vec3 direction, double radius, struct err *err);

#endif
