/* recover.h - the curve by which samples follow light, from exposures of the same places. */
#ifndef REMODEL_FIT_RECOVER_H
#define REMODEL_FIT_RECOVER_H

#include <stddef.h>

#include "common/image/response.h"
#include "stages/fit_response/fit_params.h"

enum { RECOVER_MOST = 64 }; /* exposures of a place */

struct place_sample {
    int exposure; /* of its view, from 0, the shortest first */
    double time;  /* ln of the exposure */
    float rgb[3]; /* sample, [0, 1] */
};

struct places {
    struct place_sample *samples; /* owned; those of a place follow each other */
    int *counts;                  /* of each place; owned */
    size_t count, sample_count;
};

/* Adds places of a view: on a grid, where 3 x 3 pixels are alike in the exposure that shows them best; samples are
 * their means. photos: of one size, with samples; exposures ascending. */
enum status places_add(struct places *p, const struct photo *photos, const double *exposures, int count, int most,
                       struct err *err);
void places_release(struct places *p);

/* What params ask for. told: a sentence for the user about what was decided and why. */
enum { RESPONSE_TOLD = 320 };
enum status response_decide(struct response *r, char told[RESPONSE_TOLD], const struct places *p,
                            const struct fit_params *params, struct err *err);

#endif
