/* irradiance_ratio.c - see irradiance_ratio.h. Sums are in the order of the pixels. */
#include "stages/evaluate/light/irradiance_ratio.h"

#include <math.h>

#include "common/image/luminance.h"

enum status ratio_error_init(struct ratio_error *e, struct err *err)
{
    *e = (struct ratio_error){0};
    return quantiles_init(&e->errors, err);
}

void ratio_error_add(struct ratio_error *e, const struct ratio_pixels *p)
{
    for (size_t i = 0; i < p->count; i++) {
        const float *a = p->before + 3 * i, *b = p->after + 3 * i;
        const float *before = p->true_before + 3 * i, *after = p->true_after + 3 * i;
        if ((p->mask && !p->mask[i]) || !(luminance_precise(before) > 0) || !(luminance_precise(after) > 0)) continue;
        if (!p->known[i] || !(luminance_precise(a) > 0)) {
            e->missing++;
            continue;
        }
        const double ratio = luminance_precise(b) / luminance_precise(a),
                     wanted = luminance_precise(after) / luminance_precise(before);
        for (int c = 0; c < 3; c++) {
            const double lit = (a[c] > 0 ? (double)b[c] / a[c] : ratio) * before[c];
            e->square += (lit - after[c]) * (lit - after[c]);
            e->change += ((double)before[c] - after[c]) * ((double)before[c] - after[c]);
            e->reference += (double)after[c] * after[c];
        }
        quantiles_add(&e->errors, (float)fmin(fabs(ratio - wanted) / wanted, 1e30));
        e->pixels++;
    }
}

void ratio_error_release(struct ratio_error *e)
{
    quantiles_release(&e->errors);
    *e = (struct ratio_error){0};
}
