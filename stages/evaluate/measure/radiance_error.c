/* radiance_error.c - errors of linear radiance; radiance_error.h defines them. Sums are in the order of the pixels. */
#include "stages/evaluate/measure/radiance_error.h"

#include <math.h>

#include "common/image/luminance.h"

enum status radiance_error_init(struct radiance_error *e, struct err *err)
{
    *e = (struct radiance_error){0};
    return quantiles_init(&e->errors, err);
}

void radiance_error_add(struct radiance_error *e, const struct radiance_pixels *p)
{
    for (size_t i = 0; i < p->count; i++) {
        double a[3], b[3];
        if (!(p->truth[4 * i + 3] > 0) || (p->mask && !p->mask[i])) continue;
        for (size_t c = 0; c < 3; c++) {
            a[c] = p->scale * p->found[3 * i + c];
            b[c] = p->truth[4 * i + c];
            if (p->clip > 0) a[c] = fmin(a[c], p->clip);
            if (p->clip > 0) b[c] = fmin(b[c], p->clip);
            e->square += (a[c] - b[c]) * (a[c] - b[c]);
            e->reference += b[c] * b[c];
        }
        e->pixels++;
        const double y = luminance_of_doubles(b);
        if (y > 0) quantiles_add(&e->errors, (float)fmin(fabs(luminance_of_doubles(a) - y) / y, 1e30));
    }
}

void radiance_ratios_add(struct quantiles *q, const struct radiance_pixels *p)
{
    for (size_t i = 0; i < p->count; i++) {
        const float *a = p->found + 3 * i, *b = p->truth + 4 * i;
        if (!(b[3] > 0) || (p->mask && !p->mask[i])) continue;
        const double found = luminance_of_doubles((double[]){a[0], a[1], a[2]}),
                     truth = luminance_of_doubles((double[]){b[0], b[1], b[2]});
        if (found > 0 && truth > 0) quantiles_add(q, (float)fmin(truth / found, 1e30));
    }
}

bool radiance_error_rms(const struct radiance_error *e, double *rms)
{
    if (!e->pixels || !(e->reference > 0)) return false;
    *rms = sqrt(e->square / e->reference);
    return true;
}

void radiance_error_release(struct radiance_error *e)
{
    quantiles_release(&e->errors);
    *e = (struct radiance_error){0};
}
