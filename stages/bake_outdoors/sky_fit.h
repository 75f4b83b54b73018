/* sky_fit.h - a standard sky that continues the sky that pictures show. */
#ifndef REMODEL_SKY_FIT_H
#define REMODEL_SKY_FIT_H

#include "common/base/err.h"
#include "common/daylight/sky_standard.h"

/* A piece of sky that some picture shows. */
struct sky_sample {
    struct vec3 direction; /* unit, z up */
    double level[3];       /* logarithms of the radiance */
    double weight;         /* solid angle */
};

struct sky_fit {
    int type;           /* of the standard's table, 1 to 15; 0: nothing was seen */
    struct vec3 to_sun; /* unit; counts for types that depend on it */
    double level[3];    /* logarithms of the radiance where the standard's distribution is 1 */
    double brightest;   /* luminance of the brightest sky that was seen, but for a twentieth of it */
    double misfit;      /* mean absolute deviation of the samples' logarithms */
};

/* Fits type, level and, if it is not given (NULL), the direction of the sun. Samples may be in any order; count 0 gives
 * type 0. ST_NOMEM. */
enum status sky_fit_samples(struct sky_fit *f, const struct sky_sample *samples, int count, const struct vec3 *to_sun,
                            struct err *err);

/* Logarithms of the fitted radiance in a unit direction, never brighter than the sky that was seen. */
void sky_fit_level(double level[3], const struct sky_fit *f, struct vec3 direction);

#endif
