/* sigma_error.c - how well the stated uncertainty of depths covers their errors. */
#include "stages/evaluate/views/sigma_error.h"

#include <math.h>

enum status sigma_errors_init(struct sigma_errors *e, struct err *err)
{
    *e = (struct sigma_errors){0};
    for (int k = 0; !err->status && k < DEPTH_CLASSES; k++) quantiles_init(&e->classes[k].errors, err);
    return err->status;
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
    quantiles_merge(&to->errors, &from->errors);
}

void sigma_errors_release(struct sigma_errors *e)
{
    for (int k = 0; k < DEPTH_CLASSES; k++) quantiles_release(&e->classes[k].errors);
}
