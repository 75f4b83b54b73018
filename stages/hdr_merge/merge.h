/* merge.h - merges photographs of one view in several exposures (brackets) into linear radiance.
 *
 * Photos are linearised by a response curve; a linear sample v at exposure t measures radiance v / t. Exposures are
 * relative: at exposure 1, radiance 1 is white. */
#ifndef REMODEL_MERGE_H
#define REMODEL_MERGE_H

#include <stdint.h>

#include "common/capture/photo_quality.h"
#include "common/image/image.h"
#include "common/image/response.h"
#include "stages/hdr_merge/bracket_noise.h"
#include "stages/hdr_merge/merge_params.h"

enum { MERGE_MAX_EXPOSURES = 64 }; /* exposures of a view */

/* Pixel (x + dx, y + dy) of the exposure shows the same point as (x, y) of the merged image. */
struct shift {
    int dx, dy;
};

/* The exposures of a view. */
struct brackets {
    const struct photo *photos; /* all of one size */
    const double *exposures;    /* ascending */
    int count;
    const struct response *response;
    const struct shift *shifts; /* NULL: no shifts */
};

struct merged {
    struct image radiance; /* R G B; finite, not negative */
    uint8_t *marks;        /* per pixel: PHOTO_BRIGHT, PHOTO_DARK; owned */
    float *variance;       /* per pixel: variance of the luminance over its square, (0, 1]; owned */
};

/* Merges the exposures; noise: the model of each one. m is {0} on entry; release it also after a failure. The result
 * does not depend on the number of threads. ST_DATA: photos of different sizes, an exposure outside 1e-12 to 1e12,
 * fewer than 1 or more than MERGE_MAX_EXPOSURES exposures. */
enum status merge_brackets(struct merged *m, const struct brackets *b, const struct noise *noise,
                           const struct merge_params *params, struct err *err);
void merge_release(struct merged *m);

/* The ratio of two neighbouring exposures, as stated and as measured on samples that are well exposed in both. */
struct exposure_agreement {
    int pair;                /* the later exposure; the other one is pair - 1. 0: none could be compared */
    double stated, measured; /* ratios */
    size_t samples;
};
/* Finds the pair that agrees worst. */
enum status merge_agreement(struct exposure_agreement *worst, const struct brackets *b, struct err *err);

#endif
