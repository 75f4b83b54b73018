/* soft_z.h - the soft z-buffer: surfaces that nearly agree in depth are blended [Colburn 2014, 3.6.1, eq. 3.1].
 *
 * Formulas are in soft_z.c. Depth is z along the novel camera's axis. */
#ifndef REMODEL_SOFT_Z_H
#define REMODEL_SOFT_Z_H

#include <immintrin.h>

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
static inline __m256 soft_z_presence8(__m256 blend, __m256 alpha)
{
    const __m256 one = _mm256_set1_ps(1);
    return _mm256_mul_ps(_mm256_min_ps(one, _mm256_mul_ps(blend, _mm256_set1_ps(1 / SOFT_Z_FULL_BLEND))),
                         _mm256_min_ps(one, _mm256_mul_ps(alpha, _mm256_set1_ps(1 / SOFT_Z_FULL_ALPHA))));
}

/* 1/2 (1 + cos(pi t)) for t in [0, 1], as 1/2 - 1/2 sin(pi (t - 1/2)): five terms of the series give 1e-6. */
static inline __m256 soft_z_fall8(__m256 t)
{
    static const float terms[] = {0.0821458866f, -0.599264529f, 2.55016404f, -5.16771278f, 3.14159265f};
    const __m256 s = _mm256_sub_ps(t, _mm256_set1_ps(0.5f)), s2 = _mm256_mul_ps(s, s);
    __m256 sum = _mm256_set1_ps(terms[0]);
    for (int i = 1; i < 5; i++) sum = _mm256_add_ps(_mm256_mul_ps(sum, s2), _mm256_set1_ps(terms[i]));
    return _mm256_sub_ps(_mm256_set1_ps(0.5f), _mm256_mul_ps(_mm256_set1_ps(0.5f), _mm256_mul_ps(sum, s)));
}

/* rho of pairs of depths; squares: the sums of the squares of their uncertainties. */
static inline __m256 soft_z_rho8(const struct soft_z *s, __m256 squares)
{
    if (!(s->widths > 0)) return _mm256_set1_ps(s->range);
    return _mm256_mul_ps(_mm256_set1_ps(2 * s->widths), _mm256_sqrt_ps(squares));
}

/* dz - gamma; and w of it, which may leave [0, 1] by the error of the series. */
static inline __m256 soft_z_over8(__m256 dz, __m256 rho)
{
    return _mm256_sub_ps(dz, _mm256_mul_ps(rho, _mm256_set1_ps(0.1f)));
}

static inline __m256 soft_z_weight8(__m256 over, __m256 rho)
{
    const __m256 length = _mm256_max_ps(_mm256_mul_ps(rho, _mm256_set1_ps(0.8f)), _mm256_set1_ps(1e-30f));
    const __m256 t = _mm256_min_ps(_mm256_set1_ps(1), _mm256_div_ps(over, length));
    return soft_z_fall8(_mm256_max_ps(_mm256_setzero_ps(), t));
}

/* min(w, weight of samples at z behind samples c of presence p_c); z and z_c are in soft_z_order(). */
static inline __m256 soft_z_behind8(const struct soft_z *s, __m256 w, __m256 z, __m256 uncertainty, __m256 z_c,
                                    __m256 uncertainty_c, __m256 p_c)
{
    const __m256 one = _mm256_set1_ps(1), zero = _mm256_setzero_ps();
    const __m256 rho = soft_z_rho8(
        s, _mm256_add_ps(_mm256_mul_ps(uncertainty, uncertainty), _mm256_mul_ps(uncertainty_c, uncertainty_c)));
    const __m256 over = soft_z_over8(_mm256_sub_ps(z, z_c), rho);
    if (!_mm256_movemask_ps(_mm256_cmp_ps(over, zero, _CMP_GT_OQ))) return w;
    const __m256 hidden = _mm256_mul_ps(p_c, _mm256_sub_ps(one, soft_z_weight8(over, rho)));
    return _mm256_max_ps(zero, _mm256_min_ps(w, _mm256_sub_ps(one, hidden)));
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
    __m256 weight[SOFT_Z_MAX_VIEWS], presence[SOFT_Z_MAX_VIEWS], order[SOFT_Z_MAX_VIEWS];
    __m256 uncertainty[SOFT_Z_MAX_VIEWS], visible[SOFT_Z_MAX_VIEWS];
    const __m256 least = _mm256_set1_ps(1e-12f); /* z is 0 where there is no sample */
    __m256 z_sum = _mm256_setzero_ps(), presence_sum = z_sum;
    float w[SOFT_Z_MAX_VIEWS][8];

    for (int k = 0; k < count; k++) {
        const __m256 z_k = _mm256_max_ps(least, _mm256_loadu_ps(views[k].z)), sigma = _mm256_loadu_ps(views[k].sigma);
        order[k] = s->widths > 0 ? _mm256_div_ps(_mm256_set1_ps(-1), z_k) : z_k;
        uncertainty[k] = _mm256_mul_ps(sigma, _mm256_andnot_ps(_mm256_set1_ps(-0.0f), order[k]));
        weight[k] = _mm256_loadu_ps(views[k].blend);
        presence[k] = soft_z_presence8(weight[k], _mm256_loadu_ps(views[k].alpha));
        visible[k] = _mm256_set1_ps(1);
    }
    for (int k = 0; k < count; k++)
        for (int c = 0; c < count; c++)
            if (c != k)
                visible[k] =
                    soft_z_behind8(s, visible[k], order[k], uncertainty[k], order[c], uncertainty[c], presence[c]);
    for (int k = 0; k < count; k++) {
        const __m256 part = _mm256_mul_ps(visible[k], presence[k]);
        z_sum = _mm256_add_ps(z_sum, _mm256_mul_ps(part, _mm256_loadu_ps(views[k].z)));
        presence_sum = _mm256_add_ps(presence_sum, part);
        _mm256_storeu_ps(w[k], _mm256_mul_ps(visible[k], weight[k]));
    }
    _mm256_storeu_ps(z, _mm256_div_ps(z_sum, _mm256_max_ps(presence_sum, _mm256_set1_ps(1e-30f))));
    for (int n = 0; n < 8; n++) {
        __m128 sum = _mm_setzero_ps();
        for (int k = 0; k < count; k++)
            sum = _mm_add_ps(sum, _mm_mul_ps(_mm_set1_ps(w[k][n]), _mm_loadu_ps(views[k].rgba[n])));
        const __m128 alpha = _mm_shuffle_ps(sum, sum, 0xFF);
        _mm_storeu_ps(rgba[n], _mm_div_ps(sum, _mm_max_ps(alpha, _mm_set1_ps(1e-30f))));
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
