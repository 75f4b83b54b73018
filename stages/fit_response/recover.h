/* recover.h - the curve by which samples follow light, from exposures of the same places. */
#ifndef REMODEL_FIT_RECOVER_H
#define REMODEL_FIT_RECOVER_H

#include <stddef.h>

#include "common/response.h"
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

/* How much the light ratio of neighbouring exposures varies with the level of light, as a part of it: 0 for the right
 * curve, also where exposures are not quite what is stated, for that is the same at all levels. samples: how many pairs
 * told; too few give 0. */
struct response_evidence {
    double spread;
    size_t pairs;
};
enum status response_judge(struct response_evidence *e, const struct response *r, const struct places *p,
                           struct err *err);

/* Least squares. ST_DATA: too little to go by. */
enum status response_recover(struct response *r, const struct places *p, struct err *err);

/* What params ask for. told: a sentence for the user about what was decided and why. */
enum { RESPONSE_TOLD = 320 };
enum status response_decide(struct response *r, char told[RESPONSE_TOLD], const struct places *p,
                            const struct fit_params *params, struct err *err);

#endif
