/* relit_error.c - see relit_error.h. Sums are in the order of the pixels. */
#include "stages/evaluate/light/relit_error.h"

#include <math.h>

#include "common/image/image.h"
#include "common/image/luminance.h"

void relit_changes_keep(uint8_t *mask, const float *before, const float *after, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double a = luminance_precise(before + 3 * i), b = luminance_precise(after + 3 * i);
        if (!(a > 0) || !(b > 0) || !(fabs(b - a) > RELIT_CHANGE * a)) mask[i] = 0;
    }
}

void relit_encoded_error_add(struct encoded_error *e, const struct radiance_pixels *p)
{
    for (size_t i = 0; i < p->count; i++) {
        if ((p->mask && !p->mask[i]) || !(p->truth[4 * i + 3] > 0)) continue;
        for (size_t c = 0; c < 3; c++) {
            const double found = srgb_from_linear((float)(p->scale * (double)p->found[3 * i + c] / p->clip));
            const double truth = srgb_from_linear((float)((double)p->truth[4 * i + c] / p->clip));
            e->square += (found - truth) * (found - truth);
            e->samples++;
        }
    }
}

bool relit_encoded_error_psnr(const struct encoded_error *e, double *psnr)
{
    if (!e->samples) return false;
    *psnr = 10 * log10((double)e->samples / fmax(e->square, 1e-10 * (double)e->samples));
    return true;
}

void relit_change_apply(float *picture, const float *before, const float *after, const uint8_t *mask, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!mask[i]) continue;
        const float *a = before + 3 * i, *b = after + 3 * i;
        const double all = luminance_precise(b) / luminance_precise(a);
        for (size_t c = 0; c < 3; c++) picture[3 * i + c] *= (float)(a[c] > 0 ? (double)b[c] / (double)a[c] : all);
    }
}

void relit_quotient_errors_add(struct quantiles *errors, const float *quotient, const float *before, const float *after,
                               const uint8_t *mask, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!mask[i]) continue;
        const float *q = quotient + 3 * i, *a = before + 3 * i;
        const float lit[3] = {q[0] * a[0], q[1] * a[1], q[2] * a[2]};
        const double wanted = luminance_precise(after + 3 * i);
        quantiles_add(errors, (float)fmin(fabs(luminance_precise(lit) - wanted) / wanted, 1e30));
    }
}
