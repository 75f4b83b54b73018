/* soft_z.c - see soft_z.h. */
#include "common/soft_z.h"

#include <math.h>

float soft_z_weight(float dz, float gamma, float rho)
{
    if (dz <= gamma) return 1;
    if (!(dz <= rho - gamma)) return 0;
    return 0.5f * (1 + cosf((float)M_PI * (dz - gamma) / (rho - 2 * gamma)));
}

static float known_sigma(float sigma) { return sigma > SOFT_Z_SIGMA_LEAST ? sigma : SOFT_Z_SIGMA_LEAST; }

float soft_z_rho(const struct soft_z *s, float z_a, float sigma_a, float z_b, float sigma_b)
{
    if (!(s->widths > 0)) return s->range;
    const float a = known_sigma(sigma_a) * z_a, b = known_sigma(sigma_b) * z_b;
    return 2 * s->widths * sqrtf(a * a + b * b);
}

float soft_z_reach(const struct soft_z *s, float z, float sigma)
{
    return s->widths > 0 ? s->widths * known_sigma(sigma) * z : 0.1f * s->range;
}

static float presence(const struct soft_z_sample *s)
{
    const float blend = s->blend / SOFT_Z_BLEND_WHOLE, alpha = s->rgba[3] / SOFT_Z_ALPHA_WHOLE;
    return (blend < 1 ? blend : 1) * (alpha < 1 ? alpha : 1);
}

void soft_z_blend(const struct soft_z *s, const struct soft_z_sample *samples, int count, float rgba[4], float *z)
{
    float color[4] = {0}, z_sum = 0, w_sum = 0;

    for (int i = 0; i < count; i++) {
        const struct soft_z_sample *a = &samples[i];
        float w = 1;
        for (int c = 0; c < count; c++) {
            const struct soft_z_sample *b = &samples[c];
            if (!(b->z < a->z)) continue;
            const float rho = soft_z_rho(s, a->z, a->sigma, b->z, b->sigma);
            const float hidden = presence(b) * (1 - soft_z_weight(a->z - b->z, 0.1f * rho, rho));
            w = fminf(w, 1 - hidden);
        }
        const float there = w * presence(a);
        for (int k = 0; k < 4; k++) color[k] += a->blend * w * a->rgba[k];
        z_sum += there * a->z;
        w_sum += there;
    }
    for (int k = 0; k < 3; k++) rgba[k] = color[3] > 0 ? color[k] / color[3] : 0;
    rgba[3] = color[3] > 0;
    *z = w_sum > 0 ? z_sum / w_sum : 0;
}
