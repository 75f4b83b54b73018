/* noise_model.c - noise of a sensor of known electrons, and of quantization.
 *
 * A pixel that collects n electrons has the photon noise sqrt(n); reading it adds read_noise electrons. In units of
 * white, that is var(v) = v / electrons + (read_noise / electrons)^2. A step s of quantization adds s^2 / 12. Near
 * black the steps are nearly constant and add to the constant part. In the brighter half of the samples s^2 / v is
 * nearly constant, so there they add to the photon part. */
#include "common/image/noise_model.h"

#include <math.h>

struct noise noise_given(double electrons, double read_noise, const struct response *r, int bits)
{
    struct noise n = {1 / electrons, pow(read_noise / electrons, 2), 1};
    if (bits == 32) return n;
    const double levels = bits == 16 ? 65535 : 255;
    /* the mean step near black, and the mean of step^2 / light over the brighter half of the samples */
    double near_black = 0, per_light = 0;
    for (int i = 0; i < RESPONSE_LEVELS - 1; i++) {
        const float from = (float)i / (RESPONSE_LEVELS - 1), to = (float)(i + 1) / (RESPONSE_LEVELS - 1);
        const double light = (double)response_light(r, 1, to),
                     step = (light - (double)response_light(r, 1, from)) * (RESPONSE_LEVELS - 1) / levels;
        if (i < 8) near_black += step / 8;
        if (i >= RESPONSE_LEVELS / 2 && light > 0) per_light += step * step / light / (RESPONSE_LEVELS / 2 - 1);
    }
    n.photon += per_light / 12;
    n.read2 += near_black * near_black / 12;
    return n;
}
