/* level_interval.c - see level_interval.h. Errors are taken as independent and lognormal. */
#include "stages/light_levels/level_interval.h"

#include <math.h>

static double square(double v) { return v * v; }

void level_interval_variance(double variance[2], struct level_origin of, const struct lux_interval *scale,
                             const struct model_metre *metre)
{
    for (int k = 0; k < 2; k++) {
        variance[k] = 0;
        if (scale->scale > 0 && of.photographs)
            variance[k] += square(log(k ? scale->high / scale->scale : scale->scale / scale->low) / LIGHT_NORMAL_95);
        if (metre->guessed && of.planned)
            variance[k] +=
                square(2 * log(k ? metre->high / metre->units : metre->units / metre->low) / LIGHT_NORMAL_95);
    }
}

void level_interval(double ends[2], struct level_origin of, const struct levels_params *params,
                    const struct light_errors *errors, const struct lux_interval *scale,
                    const struct model_metre *metre)
{
    double variance[2];
    level_interval_variance(variance, of, scale, metre);
    for (int k = 0; k < 2; k++) {
        double worst = params->sky_error;
        for (int i = 0; of.photographs && i < errors->count; i++)
            worst = fmax(worst, k ? errors->of[i].bright : errors->of[i].dark);
        variance[k] += square(params->error) + square(worst);
        ends[k] = exp((k ? LIGHT_NORMAL_95 : -LIGHT_NORMAL_95) * sqrt(variance[k]));
    }
}
