/* quantiles.h - quantiles of many numbers in little memory. */
#ifndef REMODEL_QUANTILES_H
#define REMODEL_QUANTILES_H

#include <stdint.h>

#include "common/base/err.h"

/* A histogram of non-negative numbers with bins of 2^-11 of the value: memory does not grow with the pixels. */
struct quantiles {
    uint64_t *bins; /* owned */
    uint64_t count;
};
enum status quantiles_init(struct quantiles *q, struct err *err);
void quantiles_add(struct quantiles *q, float value);
void quantiles_merge(struct quantiles *to, const struct quantiles *from); /* adds `from` to `to` */
/* The minimum value that at least `share` of the numbers do not exceed, to 2^-12 of itself. count > 0. */
double quantiles_get(const struct quantiles *q, double share);
void quantiles_release(struct quantiles *q);

#endif
