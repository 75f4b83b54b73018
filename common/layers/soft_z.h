/* soft_z.h - the soft z-buffer: surfaces that nearly agree in depth are blended [Colburn 2014, 3.6.1, eq. 3.1].
 *
 * Formulas are in soft_z.c. Depth is z along the novel camera's axis. */
#ifndef REMODEL_SOFT_Z_H
#define REMODEL_SOFT_Z_H

#include "common/math/lanes.h"

struct soft_z {
    float widths; /* k; 0: rho is `range` everywhere, as in the thesis */
    float range;  /* robust depth range of the scene: far - near */
};

/* Lower bound of relative uncertainties: no depth map is more precise, and rounding must not look like a depth jump. */
#define SOFT_Z_MIN_SIGMA 1e-3f

#define SOFT_Z_FULL_BLEND 0.05f /* a sample of this blending weight and ... */
#define SOFT_Z_FULL_ALPHA 0.5f  /* ... this alpha is fully present */

float soft_z_weight(float dz, float gamma, float rho);

/* rho of two depths with relative uncertainties sigma. */
float soft_z_rho(const struct soft_z *s, float z_a, float sigma_a, float z_b, float sigma_b);

/* What depths are compared by: with a width, -1/z, whose uncertainty is sigma / z; else z, whose uncertainty is sigma
 * z.
 */
static inline float soft_z_order(const struct soft_z *s, float z) { return s->widths > 0 ? -1 / z : z; }

/* The functions below handle eight pixels at a time, with depths in that order. */

/* Presence p of samples with these blending weights and alphas. */
static inline f32x8 soft_z_presence8(f32x8 blend, f32x8 alpha)
{
    const f32x8 one = f32x8_all(1);
    return f32x8_min(one, blend * (1 / SOFT_Z_FULL_BLEND)) * f32x8_min(one, alpha * (1 / SOFT_Z_FULL_ALPHA));
}

/* 1/2 (1 + cos(pi t)) for t in [0, 1], as 1/2 - 1/2 sin(pi (t - 1/2)): five terms of the series give 1e-6. */
static inline f32x8 soft_z_fall8(f32x8 t)
{
    static const float terms[] = {0.0821458866f, -0.599264529f, 2.55016404f, -5.16771278f, 3.14159265f};
    const f32x8 s = t - 0.5f, s2 = s * s;
    f32x8 sum = f32x8_all(terms[0]);
    for (int i = 1; i < 5; i++) sum = sum * s2 + terms[i];
    return 0.5f - 0.5f * (sum * s);
}

/* rho of pairs of depths; squares: the sums of the squares of their uncertainties. */
static inline f32x8 soft_z_rho8(const struct soft_z *s, f32x8 squares)
{
    if (!(s->widths > 0)) return f32x8_all(s->range);
    return 2 * s->widths * f32x8_sqrt(squares);
}

/* dz - gamma; and w of it, which may leave [0, 1] by the error of the series. */
static inline f32x8 soft_z_over8(f32x8 dz, f32x8 rho) { return dz - rho * 0.1f; }

static inline f32x8 soft_z_weight8(f32x8 over, f32x8 rho)
{
    const f32x8 length = f32x8_max(rho * 0.8f, f32x8_all(1e-30f));
    const f32x8 t = f32x8_min(f32x8_all(1), over / length);
    return soft_z_fall8(f32x8_max((f32x8){0}, t));
}

/* min(w, weight of samples at z behind samples c of presence p_c); z and z_c are in soft_z_order(). */
static inline f32x8 soft_z_behind8(const struct soft_z *s, f32x8 w, f32x8 z, f32x8 uncertainty, f32x8 z_c,
                                   f32x8 uncertainty_c, f32x8 p_c)
{
    const f32x8 one = f32x8_all(1), zero = {0};
    const f32x8 rho = soft_z_rho8(s, uncertainty * uncertainty + uncertainty_c * uncertainty_c);
    const f32x8 over = soft_z_over8(z - z_c, rho);
    if (!i32x8_any(over > zero)) return w;
    const f32x8 hidden = p_c * (one - soft_z_weight8(over, rho));
    return f32x8_max(zero, f32x8_min(w, one - hidden));
}

/* Samples of one view in eight adjacent pixels: pointers to the first. */
struct soft_z_samples8 {
    const float (*rgba)[4]; /* premultiplied */
    const float *alpha;     /* copy of rgba's */
    const float *z, *sigma; /* of the front surface; sigma relative */
    const float *blend;     /* the view's blending weight; 0: no sample */
};

#define SOFT_Z_MAX_VIEWS 19 /* views */

/* Blends the views' samples of eight pixels. rgba gets alpha 1, or is 0 with z 0 where there is no sample. Inlined:
 * with a constant count all values stay in registers. */
static inline __attribute__((always_inline)) void
soft_z_blend8(const struct soft_z *s, const struct soft_z_samples8 *views, int count, float (*rgba)[4], float *z)
{
    f32x8 weight[SOFT_Z_MAX_VIEWS], presence[SOFT_Z_MAX_VIEWS], order[SOFT_Z_MAX_VIEWS];
    f32x8 uncertainty[SOFT_Z_MAX_VIEWS], visible[SOFT_Z_MAX_VIEWS];
    const f32x8 least = f32x8_all(1e-12f); /* z is 0 where there is no sample */
    f32x8 z_sum = {0}, presence_sum = z_sum;
    float w[SOFT_Z_MAX_VIEWS][8];

    for (int k = 0; k < count; k++) {
        const f32x8 z_k = f32x8_max(least, f32x8_load(views[k].z)), sigma = f32x8_load(views[k].sigma);
        order[k] = s->widths > 0 ? -1 / z_k : z_k;
        uncertainty[k] = sigma * f32x8_abs(order[k]);
        weight[k] = f32x8_load(views[k].blend);
        presence[k] = soft_z_presence8(weight[k], f32x8_load(views[k].alpha));
        visible[k] = f32x8_all(1);
    }
    for (int k = 0; k < count; k++)
        for (int c = 0; c < count; c++)
            if (c != k)
                visible[k] =
                    soft_z_behind8(s, visible[k], order[k], uncertainty[k], order[c], uncertainty[c], presence[c]);
    for (int k = 0; k < count; k++) {
        const f32x8 part = visible[k] * presence[k];
        z_sum += part * f32x8_load(views[k].z);
        presence_sum += part;
        f32x8_store(w[k], visible[k] * weight[k]);
    }
    f32x8_store(z, z_sum / f32x8_max(presence_sum, f32x8_all(1e-30f)));
    for (int n = 0; n < 8; n++) {
        f32x4 sum = {0};
        for (int k = 0; k < count; k++) sum += w[k][n] * f32x4_load(views[k].rgba[n]);
        const f32x4 alpha = __builtin_shufflevector(sum, sum, 3, 3, 3, 3);
        f32x4_store(rgba[n], sum / f32x4_max(alpha, f32x4_all(1e-30f)));
    }
}

/* A surface of a view in a pixel, for the offline renderer. */
struct soft_z_fragment {
    float rgba[4];     /* premultiplied; alpha > 0: its share of the pixel in its view, composited front to back */
    float z, sigma;    /* sigma: relative uncertainty, at least SOFT_Z_MIN_SIGMA */
    float blend;       /* the view's blending weight */
    float vote;        /* weight of the view's vote, up to 1 */
    float front_alpha; /* alpha of what is in front of it in its view */
};

#define SOFT_Z_MAX_FRAGMENTS 40 /* fragments */

/* Merges the fragments of all views in a pixel, 1 <= count <= SOFT_Z_MAX_FRAGMENTS. The fragments of a view are
 * adjacent, front to back. rgba gets alpha 1; *z is the depth of the dominant surface. See soft_z.c. */
void soft_z_merge(const struct soft_z *s, const struct soft_z_fragment *fragments, int count, float rgba[4], float *z);

#endif
