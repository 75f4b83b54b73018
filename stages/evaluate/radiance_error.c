/* radiance_error.c - see radiance_error.h. */
#include "stages/evaluate/radiance_error.h"

#include <math.h>

enum status relative_rms(double *rms, const float *found, const float *truth, size_t count, const uint8_t *mask,
                         uint8_t which, struct err *err)
{
    double off = 0, all = 0;
    for (size_t i = 0; i < count; i++) {
        if (mask && mask[i] != which) continue;
        for (size_t c = 3 * i; c < 3 * i + 3; c++) {
            double d = (double)found[c] - truth[c];
            off += d * d;
            all += (double)truth[c] * truth[c];
        }
    }
    if (!(all > 0)) return err_set(err, ST_DATA, "there is no true light to compare with.");
    *rms = sqrt(off / all);
    return ST_OK;
}

enum status texture_errors(double *seen, double *hidden, const float *found, const float *truth, const uint8_t *kinds,
                           size_t count, struct err *err)
{
    struct err none = ERR_INIT;
    *seen = *hidden = -1;
    enum status a = relative_rms(seen, found, truth, count, kinds, TEXEL_SEEN, &none);
    enum status b = relative_rms(hidden, found, truth, count, kinds, TEXEL_HIDDEN, &none);
    return a && b ? err_set(err, ST_DATA, "no texel has a true radiance to compare with.") : ST_OK;
}
