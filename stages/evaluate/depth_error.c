/* depth_error.c - see depth_error.h.
 *
 * The bin of a number is the upper 20 bits of its float: sign, exponent and 11 bits of fraction. */
#include "stages/evaluate/depth_error.h"

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

void quantiles_release(struct quantiles *q)
{
    free(q->bins);
    *q = (struct quantiles){0};
}

enum status depth_errors_init(struct depth_errors *e, struct err *err)
{
    *e = (struct depth_errors){0};
    return quantiles_init(&e->all.errors, err) || quantiles_init(&e->visible.errors, err) ? err->status : ST_OK;
}

static void tally(struct depth_tally *t, double z, double truth, double focal_baseline)
{
    t->pixels++;
    if (!(z > 0)) {
        t->bad1++;
        t->bad2++;
        return;
    }
    double off = fabs(focal_baseline / z - focal_baseline / truth);
    t->known++;
    t->bad1 += off > 1;
    t->bad2 += off > 2;
    t->within2 += fabs(z - truth) <= 0.02 * truth;
    quantiles_add(&t->errors, (float)fmin(fabs(z - truth) / truth, 1e30));
}

void depth_errors_add(struct depth_errors *e, const float *z, const float *truth, const uint8_t *occluded, size_t count,
                      double focal_baseline)
{
    for (size_t i = 0; i < count; i++) {
        if (!(truth[i] > 0)) continue;
        tally(&e->all, z[i], truth[i], focal_baseline);
        if (!occluded || !occluded[i]) tally(&e->visible, z[i], truth[i], focal_baseline);
    }
}

static void merge_quantiles(struct quantiles *to, const struct quantiles *from)
{
    to->count += from->count;
    for (int i = 0; i < BINS; i++) to->bins[i] += from->bins[i];
}

static void merge(struct depth_tally *to, const struct depth_tally *from)
{
    to->pixels += from->pixels;
    to->known += from->known;
    to->bad1 += from->bad1;
    to->bad2 += from->bad2;
    to->within2 += from->within2;
    merge_quantiles(&to->errors, &from->errors);
}

void depth_errors_merge(struct depth_errors *to, const struct depth_errors *from)
{
    merge(&to->all, &from->all);
    merge(&to->visible, &from->visible);
}

void depth_errors_release(struct depth_errors *e)
{
    quantiles_release(&e->all.errors);
    quantiles_release(&e->visible.errors);
    *e = (struct depth_errors){0};
}

enum status sigma_errors_init(struct sigma_errors *e, struct err *err)
{
    enum status st = ST_OK;
    *e = (struct sigma_errors){0};
    for (int k = 0; !st && k < DEPTH_CLASSES; k++) st = quantiles_init(&e->classes[k].errors, err);
    return st;
}

void sigma_errors_add(struct sigma_errors *e, const float *z, const float *truth, const float *sigma,
                      const uint8_t *classes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(truth[i] > 0) || !(z[i] > 0) || classes[i] >= DEPTH_CLASSES) continue;
        struct sigma_tally *t = &e->classes[classes[i]];
        const double relative = fabs(1 - (double)z[i] / (double)truth[i]);
        const double error = relative > 0 ? fmin(relative / (double)sigma[i], 1e30) : 0; /* sigma may be 0 */
        for (int k = 0; k < 3; k++) t->within[k] += error <= k + 1;
        quantiles_add(&t->errors, (float)error);
    }
}

void sigma_tally_merge(struct sigma_tally *to, const struct sigma_tally *from)
{
    for (int k = 0; k < 3; k++) to->within[k] += from->within[k];
    merge_quantiles(&to->errors, &from->errors);
}

void sigma_errors_release(struct sigma_errors *e)
{
    for (int k = 0; k < DEPTH_CLASSES; k++) quantiles_release(&e->classes[k].errors);
}
