/* sky_basis.h - the light of many skies at many places as sums of few parts. */
#ifndef REMODEL_SKY_BASIS_H
#define REMODEL_SKY_BASIS_H

#include <stddef.h>

#include "common/base/err.h"

/* value(place, sky) = level[place] sum_k parts[k * places + place] mixes[sky * count + k]. Owned. */
struct sky_basis {
    float *level, *parts;
    double *mixes;
    int places, skies, count;
};

/* values[sky * places + place], 0 or more. Parts are added until each value is right to `tolerance` of itself, or of a
 * twentieth of what the place's and the sky's means let expect, if that is more; there are at most SKY_PARTS. The
 * caller releases b in each case. ST_NOMEM. */
enum { SKY_PARTS = 32 };
enum status sky_basis_make(struct sky_basis *b, const float *values, int places, int skies, double tolerance,
                           struct err *err);
void sky_basis_release(struct sky_basis *b);

#endif
