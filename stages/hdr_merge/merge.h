/* merge.h - linear radiance from photographs of one view in several exposures (brackets).
 *
 * Photos are linearised by a response curve; a sample v of exposure t says radiance v / t. Exposures are relative: at
 * exposure 1 radiance 1 is white. */
#ifndef REMODEL_MERGE_H
#define REMODEL_MERGE_H

#include <stdint.h>

#include "common/image/image.h"
#include "common/image/response.h"
#include "stages/hdr_merge/merge_params.h"
#include "stages/hdr_merge/noise.h"

enum { MERGE_MOST = 64 }; /* exposures of a view */

/* Marks of a pixel: what its exposures cannot tell. */
enum {
    MERGE_BRIGHT = 1, /* a colour saturates even in the shortest exposure: its radiance is at least what stands there */
    MERGE_DARK = 2,   /* a colour is dark even in the longest exposure that does not saturate: nearly only noise */
};

/* Where an exposure shows what the picture shows: its pixel (x + dx, y + dy) is the picture's (x, y). */
struct shift {
    int dx, dy;
};

struct brackets {
    const struct photo *photos; /* of one size */
    const double *exposures;    /* ascending */
    int count;
    const struct response *response;
    const struct shift *shifts; /* NULL: none */
};

struct merged {
    struct image radiance; /* R G B; finite, not negative */
    uint8_t *marks;        /* a pixel; owned */
    float *variance;       /* a pixel's, of its luminance over the luminance's square; (0, 1]; owned */
};

/* m is {0} on entry; release it also after a failure. ST_DATA: photos of different sizes, exposures that are not 1e-12
 * to 1e12, not 1 to MERGE_MOST of them. The same bits for any number of threads. */
enum status merge_brackets(struct merged *m, const struct brackets *b, const struct noise *noise,
                           const struct merge_params *params, struct err *err);
void merged_release(struct merged *m);

/* How much more light an exposure seems to have had than the one before it, from the samples that are well exposed in
 * both, and how much more its exposure states; of the pair that agrees least. pair 0: there is none to compare. */
struct exposure_agreement {
    int pair; /* this exposure and the one before it */
    double stated, seen;
    size_t samples;
};
enum status merge_agreement(struct exposure_agreement *worst, const struct brackets *b, struct err *err);

#endif
