/* noise_model.c - noise of a sensor of known electrons, and of quantization.
 *
 * A pixel that collects n electrons has the photon noise sqrt(n); reading it adds read_noise electrons. In units of
 * white, that is var(v) = v / electrons + (read_noise / electrons)^2. An error of samples by
 * k steps s of the curve is one by k s of the light; quantization has k^2 = 1/12. Near black the steps are nearly
 * constant and add to the constant part. In the brighter half of the samples s^2 / v is nearly constant, so there they
 * add to the photon part. */
#include "common/image/noise_model.h"

#include <math.h>

struct noise noise_of_samples(double variance, const struct response *r, int bits)
{
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
    return (struct noise){per_light * variance, near_black * near_black * variance, 1};
}

struct noise noise_given(double electrons, double read_noise, const struct response *r, int bits)
{
    struct noise n = {1 / electrons, pow(read_noise / electrons, 2), 1};
    if (bits == 32) return n;
    const struct noise steps = noise_of_samples(1.0 / 12, r, bits);
    n.photon += steps.photon;
    n.read2 += steps.read2;
    return n;
}
