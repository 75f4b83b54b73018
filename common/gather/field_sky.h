/* field_sky.h - bright light in a picture of the outdoors: where an estimator has to look. */
#ifndef REMODEL_GATHER_FIELD_SKY_H
#define REMODEL_GATHER_FIELD_SKY_H

#include "common/gather/light_field.h"
#include "common/texture/outdoors.h"

enum { MAX_SUNS = 8 };

struct field_sky {
    double median, bright;         /* luminance: the median over the sphere; what counts as bright is above this */
    struct emitter suns[MAX_SUNS]; /* the brightest first */
    int sun_count;
};

/* Finds the suns: connected pixels more than 20 times as bright as the median. A sun's cone holds them and the pixels
 * that the interpolation around them reaches. Of more than MAX_SUNS those that light most are kept. ST_NOMEM. */
enum status field_sky_find(struct field_sky *s, const struct outdoors *o, struct err *err);

/* The mean luminance of what lies outside of a plane with a unit normal that points indoors, weighted by the cosine,
 * the suns left out. */
double field_sky_mean(const struct field_sky *s, const struct outdoors *o, struct vec3 normal);

#endif
