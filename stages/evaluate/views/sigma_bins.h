/* sigma_bins.h - whether the stated uncertainty of depth is right at each of its sizes. */
#ifndef REMODEL_SIGMA_BINS_H
#define REMODEL_SIGMA_BINS_H

#include <stdint.h>

#include "common/base/err.h"

enum { SIGMA_BINS = 5 };

struct sigma_level; /* of pixels with about the same sigma */

/* Errors of many pixels by their sigma, in little memory. */
struct sigma_bins {
    struct sigma_level *levels; /* owned */
    uint64_t pixels;
};

/* A fifth of the pixels. */
struct sigma_bin {
    double most;      /* its largest sigma, to 1 % */
    double within[2]; /* share of its pixels with an error of at most one and two sigmas, 0 .. 1 */
};

enum status sigma_bins_init(struct sigma_bins *b, struct err *err);
/* sigma and error: at least 0. */
void sigma_bins_add(struct sigma_bins *b, double sigma, double error);
/* Divides the pixels by sigma into bins of as many pixels each, the smallest sigmas first. Pixels whose sigma is the
 * same to 1 % are not told apart: where a border of bins falls among them, both get their parts of them. b->pixels > 0.
 */
void sigma_bins_get(const struct sigma_bins *b, struct sigma_bin bins[SIGMA_BINS]);
void sigma_bins_release(struct sigma_bins *b);

#endif
