/* merge.h - linear radiance from photographs of one view in several exposures (brackets).
 *
 * Photos are linearised by the sRGB curve; a sample v of exposure t says radiance v / t. Exposures are relative: at
 * exposure 1 radiance 1 is white. */
#ifndef REMODEL_MERGE_H
#define REMODEL_MERGE_H

#include <stdint.h>

#include "common/image.h"
#include "common/param.h"
#include "common/photo.h"

/* name, type, default, least, most, unit, help */
#define MERGE_PARAMS(X)                                                              \
    X(saturated, double, 0.95, 0.1, 1, "",                                           \
      "part of white, linear, from which a sample counts for nothing; less counts "  \
      "fully below 0.8 of it")                                                       \
    X(dark, double, 0.001, 0, 0.1, "",                                               \
      "part of white, linear, up to which a sample counts for nothing; more counts " \
      "fully above 3 of it")

struct merge_params {
    MERGE_PARAMS(PARAM_FIELD)
};
#define MERGE_PARAMS_DEFAULT        \
    {                               \
        MERGE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param merge_param_table[];

enum { MERGE_MOST = 64 }; /* exposures of a view */

/* Marks of a pixel: what its exposures cannot tell. */
enum {
    MERGE_BRIGHT = 1, /* a colour saturates even in the shortest exposure: its radiance is at least what stands there */
    MERGE_DARK = 2,   /* a colour is dark even in the longest exposure that does not saturate: nearly only noise */
};

/* radiance: R G B, empty on entry, the caller releases it; marks: w * h bytes, the caller's, or NULL. photos are of one
 * size (else ST_DATA), exposures 1e-12 to
 * 1e12 (else ST_DATA) and ascending, 1 to MERGE_MOST of them. Results are finite and not negative. The same bits for any number of
 * threads. */
enum status merge_brackets(struct image *radiance, uint8_t *marks, const struct photo *photos, const double *exposures,
                           int count, const struct merge_params *params, struct err *err);

/* How much more light an exposure seems to have had than the one before it, from the samples that are well exposed in
 * both, and how much more its exposure states; of the pair that agrees least. pair 0: there is none to compare. */
struct exposure_agreement {
    int pair; /* this exposure and the one before it */
    double stated, seen;
    size_t samples;
};
void merge_agreement(struct exposure_agreement *worst, const struct photo *photos, const double *exposures, int count);

#endif
