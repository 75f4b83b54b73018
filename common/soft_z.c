/* soft_z.c - see soft_z.h. */
#include "common/soft_z.h"

#include <math.h>
#include <stdbool.h>

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

#define AGAINST_BEFORE 0.3f  /* what a fragment in front of another speaks against it */
#define STANDING_WHOLE 0.25f /* a fragment of this standing hides wholly */

static float merge_rho(const struct soft_z *s, const struct soft_z_fragment *a, const struct soft_z_fragment *b)
{
    if (!(s->widths > 0)) return s->range;
    return 2 * s->widths * sqrtf(a->uncertainty * a->uncertainty + b->uncertainty * b->uncertainty);
}

static float at_most_one(float x) { return x < 1 ? x : 1; }

/* Whether all fragments are so near each other that none hides or speaks against another. */
static bool one_surface(const struct soft_z *s, const struct soft_z_fragment *f, int count)
{
    float least = f[0].z, most = f[0].z, sure = f[0].uncertainty;
    for (int i = 1; i < count; i++) {
        least = fminf(least, f[i].z);
        most = fmaxf(most, f[i].z);
        sure = fminf(sure, f[i].uncertainty);
    }
    const float rho = s->widths > 0 ? 2 * s->widths * (float)M_SQRT2 * sure : s->range;
    return most - least <= 0.1f * rho;
}

static void standings(const struct soft_z *s, const struct soft_z_fragment *f, int count, float *standing)
{
    for (int i = 0; i < count; i++) {
        float pro = 0, contra = 1e-6f;
        for (int c = 0; c < count; c++) {
            const float rho = merge_rho(s, &f[i], &f[c]), dz = f[c].z - f[i].z;
            const float w = soft_z_weight(fabsf(dz), 0.1f * rho, rho), vote = f[c].vote * f[c].rgba[3];
            pro += vote * w;
            contra += (dz > 0 ? 1 : AGAINST_BEFORE) * vote * (1 - w);
        }
        const float part = pro / (pro + contra);
        standing[i] = part * part;
    }
}

void soft_z_merge(const struct soft_z *s, const struct soft_z_fragment *f, int count, float rgba[4], float *z)
{
    float standing[SOFT_Z_MERGE_MOST], color[3] = {0}, sum = 0, z_sum = 0, z_weight = 0;
    const bool agree = one_surface(s, f, count);

    if (!agree) standings(s, f, count, standing);
    for (int i = 0; i < count; i++) {
        float hidden = 0;
        for (int c = 0; !agree && c < count; c++) {
            if (!(f[c].z < f[i].z)) continue;
            const float rho = merge_rho(s, &f[i], &f[c]);
            const float there = at_most_one(f[c].blend * standing[c] / SOFT_Z_BLEND_WHOLE) *
                                at_most_one(standing[c] / STANDING_WHOLE) * (f[c].before + f[c].rgba[3]);
            hidden = fmaxf(hidden, there * (1 - soft_z_weight(f[i].z - f[c].z, 0.1f * rho, rho)));
        }
        const float alpha = f[i].rgba[3], seen = fminf(alpha, fmaxf(0, 1 - hidden));
        const float there = seen * (agree ? 1 : standing[i]), weight = f[i].blend * there;
        for (int k = 0; k < 3; k++) color[k] += weight * sqrtf(fmaxf(0, f[i].rgba[k] / alpha));
        sum += weight;
        z_sum += there * at_most_one(f[i].blend / SOFT_Z_BLEND_WHOLE) * f[i].z;
        z_weight += there * at_most_one(f[i].blend / SOFT_Z_BLEND_WHOLE);
    }
    for (int k = 0; k < 3; k++) rgba[k] = sum > 0 ? color[k] / sum * (color[k] / sum) : 0;
    rgba[3] = sum > 0;
    *z = z_weight > 0 ? z_sum / z_weight : 0;
}
