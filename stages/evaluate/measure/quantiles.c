/* quantiles.c - quantiles of many numbers in little memory.
 *
 * The bin of a number is the upper 20 bits of its float: sign, exponent and 11 bits of fraction. */
#include "stages/evaluate/measure/quantiles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BIN_SHIFT = 12, BINS = 1 << (31 - BIN_SHIFT) }; /* the sign is always 0 */

enum status quantiles_init(struct quantiles *q, struct err *err)
{
    *q = (struct quantiles){calloc(BINS, sizeof *q->bins), 0};
    return q->bins ? ST_OK : err_nomem(err, "a histogram", BINS * sizeof *q->bins);
}

void quantiles_add(struct quantiles *q, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    q->bins[bits >> BIN_SHIFT]++;
    q->count++;
}

double quantiles_get(const struct quantiles *q, double share)
{
    uint64_t target = (uint64_t)fmax(ceil(share * (double)q->count), 1), so_far = 0;
    uint32_t bin = 0, bits;
    float value;
    while ((so_far += q->bins[bin]) < target) bin++;
    if (bin == 0) return 0;
    bits = bin << BIN_SHIFT | 1u << (BIN_SHIFT - 1); /* the bin's middle */
    memcpy(&value, &bits, sizeof value);
    return value;
}

void quantiles_merge(struct quantiles *to, const struct quantiles *from)
{
    to->count += from->count;
    for (int i = 0; i < BINS; i++) to->bins[i] += from->bins[i];
}

void quantiles_release(struct quantiles *q)
{
    free(q->bins);
    *q = (struct quantiles){0};
}
