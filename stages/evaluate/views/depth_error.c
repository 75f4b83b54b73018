/* depth_error.c - errors of depths. */
#include "stages/evaluate/views/depth_error.h"

#include <math.h>

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

static void merge(struct depth_tally *to, const struct depth_tally *from)
{
    to->pixels += from->pixels;
    to->known += from->known;
    to->bad1 += from->bad1;
    to->bad2 += from->bad2;
    to->within2 += from->within2;
    quantiles_merge(&to->errors, &from->errors);
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
