/* recover.h - recovers the response curve of a camera from bracketed exposures. */
#ifndef REMODEL_FIT_RECOVER_H
#define REMODEL_FIT_RECOVER_H

#include <stddef.h>

#include "common/image/response.h"
#include "stages/fit_response/fit_params.h"

enum { RECOVER_MAX_EXPOSURES = 64 }; /* exposures of a view; longer ones are ignored */

struct patch_sample {
    int exposure; /* index in its view, 0 the shortest */
    double time;  /* ln of the exposure */
    float rgb[3]; /* mean sample, [0, 1]; negative: do not use */
};

/* Patches of the scene, each sampled in several exposures. */
struct patches {
    struct patch_sample *samples; /* grouped by patch, exposures ascending; owned */
    int *counts;                  /* samples of each patch; owned */
    size_t count, sample_count;
};

/* Adds patches of a view: 3 x 3 pixels on a grid that are uniform in all exposures; samples are their means. photos: of
 * one size, with samples; exposures ascending. Fewer than two photos or 3 x 3 pixels add nothing. ST_NOMEM. */
enum status recover_add_patches(struct patches *p, const struct photo *photos, const double *exposures, int count,
                                int max_patches, struct err *err);
void recover_release_patches(struct patches *p);

/* Chooses the response curve according to params. summary: the choice and the reason, for the log. ST_DATA: the patches
 * do not determine a curve. */
enum { RESPONSE_SUMMARY = 320 };
enum status recover_decide(struct response *r, char summary[RESPONSE_SUMMARY], const struct patches *p,
                           const struct fit_params *params, struct err *err);

#endif
