/* noise.h - noise of a linear sample: var(v) = photon v + read^2, v = 1 being white.
 *
 * What rounding to 8 bits adds has nearly the same form, since the steps of tone curves grow with the light; it is in
 * what is measured, and added to what is given. */
#ifndef REMODEL_HDR_NOISE_H
#define REMODEL_HDR_NOISE_H

#include "common/image/response.h"
#include "stages/hdr_merge/merge_params.h"

struct noise {
    double photon, read2; /* variance at white without reading; variance of reading */
};

struct brackets;

/* electrons at white and electrons of reading, and the steps of photos of so many bits. */
struct noise noise_given(const struct merge_params *params, const struct response *r, int bits);

/* From how neighbouring exposures differ where both are well exposed: robust, by level of light, so that edges and
 * small shifts do not count. False: too few such samples; *noise is left alone. The same for any number of threads. */
enum status noise_measure(struct noise *noise, bool *measured, const struct brackets *b, struct err *err);

#endif
