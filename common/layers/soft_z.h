/* soft_z.h - the soft z-buffer (thesis eq. 3.1): surfaces that nearly agree in depth share a pixel.
 *
 *   w(dz) = 1                                               dz <= gamma
 *           1/2 (1 + cos(pi (dz - gamma) / (rho - 2 gamma)))  gamma < dz <= rho - gamma
 *           0                                               beyond;     gamma = rho / 10
 *
 * The thesis has rho = the scene's depth range. Here, with a width of k > 0 uncertainties, two depths z_a, z_b of
 * relative uncertainties s_a, s_b have u = sqrt((s_a z_a)^2 + (s_b z_b)^2) and rho = 2 k u: the weight is 1/2 at dz
 * = k u and 0 from 1.8 k u on. */
#ifndef REMODEL_SOFT_Z_H
#define REMODEL_SOFT_Z_H

#include <immintrin.h>

struct soft_z {
    float widths; /* k; 0: rho is `range` everywhere, the thesis' */
    float range;  /* far - near of the scene, robust */
};

/* Uncertainties below this (relative) are taken for it: no depth map is that sure, and rounding is not a depth jump. */
#define SOFT_Z_SIGMA_LEAST 1e-3f

#define SOFT_Z_BLEND_WHOLE 0.05f /* a view with this blending weight is wholly present */
#define SOFT_Z_ALPHA_WHOLE 0.5f

float soft_z_weight(float dz, float gamma, float rho);

/* rho of two depths with their relative uncertainties. */
float soft_z_rho(const struct soft_z *s, float z_a, float sigma_a, float z_b, float sigma_b);

/* Eight pixels at a time. A depth's uncertainty is sigma z, sigma at least SOFT_Z_SIGMA_LEAST. */

/* p of samples with these blending weights and alphas. */
static inline __m256 soft_z_presence8(__m256 blend, __m256 alpha)
{
    const __m256 one = _mm256_set1_ps(1);
    return _mm256_mul_ps(_mm256_min_ps(one, _mm256_mul_ps(blend, _mm256_set1_ps(1 / SOFT_Z_BLEND_WHOLE))),
                         _mm256_min_ps(one, _mm256_mul_ps(alpha, _mm256_set1_ps(1 / SOFT_Z_ALPHA_WHOLE))));
}

/* 1/2 (1 + cos(pi t)) for t in [0, 1]: 1/2 - 1/2 sin(pi (t - 1/2)), whose series needs five terms for 1e-6. */
static inline __m256 soft_z_fall8(__m256 t)
{
    static const float terms[] = {0.0821458866f, -0.599264529f, 2.55016404f, -5.16771278f, 3.14159265f};
    const __m256 s = _mm256_sub_ps(t, _mm256_set1_ps(0.5f)), s2 = _mm256_mul_ps(s, s);
    __m256 sum = _mm256_set1_ps(terms[0]);
    for (int i = 1; i < 5; i++) sum = _mm256_add_ps(_mm256_mul_ps(sum, s2), _mm256_set1_ps(terms[i]));
    return _mm256_sub_ps(_mm256_set1_ps(0.5f), _mm256_mul_ps(_mm256_set1_ps(0.5f), _mm256_mul_ps(sum, s)));
}

/* rho of pairs of depths, by the sum of the squares of their uncertainties. */
static inline __m256 soft_z_rho8(const struct soft_z *s, __m256 squares)
{
    if (!(s->widths > 0)) return _mm256_set1_ps(s->range);
    return _mm256_mul_ps(_mm256_set1_ps(2 * s->widths), _mm256_sqrt_ps(squares));
}

/* dz - gamma, and w there; w leaves [0, 1] by the series' error. */
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

/* w of samples at z, no more than `w`, where samples c of presence p_c may hide them. */
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

/* What one view shows of eight pixels that lie side by side: pointers to the first one's. */
struct soft_z_samples8 {
    const float (*rgba)[4]; /* premultiplied */
    const float *alpha;     /* that of rgba */
    const float *z, *sigma; /* of its front surface; sigma relative */
    const float *blend;     /* the view's blending weight; 0: it shows nothing */
};

#define SOFT_Z_BLEND_MOST 19 /* views */

/* Blends the views' samples of eight pixels: colour by blend x w x alpha, normalised; depth sum(w z) / sum(w),
 * without blending weights. The closest sample decides w; but a sample that is hardly there - blend below 0.05, or
 * alpha below 0.5 - hides others in proportion only, and counts in the depth in proportion, so that a view that
 * enters or leaves does so without a jump:
 *   p = min(1, blend / 0.05) min(1, alpha / 0.5);  w_i = min over c closer than i of 1 - p_c (1 - w(z_i - z_c))
 * which is the formula above wherever every p is 1. rgba gets alpha 1, or is 0 with z 0 where no view shows anything.
 * Inlined, so that for a constant count all stays in registers. */
static inline __attribute__((always_inline)) void
soft_z_blend8(const struct soft_z *s, const struct soft_z_samples8 *views, int count, float (*rgba)[4], float *z)
{
    __m256 weight[SOFT_Z_BLEND_MOST], there[SOFT_Z_BLEND_MOST], depth[SOFT_Z_BLEND_MOST];
    __m256 unsure[SOFT_Z_BLEND_MOST], visible[SOFT_Z_BLEND_MOST];
    __m256 z_sum = _mm256_setzero_ps(), there_sum = z_sum;
    float w[SOFT_Z_BLEND_MOST][8];

    for (int k = 0; k < count; k++) {
        depth[k] = _mm256_loadu_ps(views[k].z);
        unsure[k] = _mm256_mul_ps(depth[k], _mm256_loadu_ps(views[k].sigma));
        weight[k] = _mm256_loadu_ps(views[k].blend);
        there[k] = soft_z_presence8(weight[k], _mm256_loadu_ps(views[k].alpha));
        visible[k] = _mm256_set1_ps(1);
    }
    for (int k = 0; k < count; k++)
        for (int c = 0; c < count; c++)
            if (c != k) visible[k] = soft_z_behind8(s, visible[k], depth[k], unsure[k], depth[c], unsure[c], there[c]);
    for (int k = 0; k < count; k++) {
        const __m256 part = _mm256_mul_ps(visible[k], there[k]);
        z_sum = _mm256_add_ps(z_sum, _mm256_mul_ps(part, depth[k]));
        there_sum = _mm256_add_ps(there_sum, part);
        _mm256_storeu_ps(w[k], _mm256_mul_ps(visible[k], weight[k]));
    }
    _mm256_storeu_ps(z, _mm256_div_ps(z_sum, _mm256_max_ps(there_sum, _mm256_set1_ps(1e-30f))));
    for (int n = 0; n < 8; n++) {
        __m128 sum = _mm_setzero_ps();
        for (int k = 0; k < count; k++)
            sum = _mm_add_ps(sum, _mm_mul_ps(_mm_set1_ps(w[k][n]), _mm_loadu_ps(views[k].rgba[n])));
        const __m128 alpha = _mm_shuffle_ps(sum, sum, 0xFF);
        _mm_storeu_ps(rgba[n], _mm_div_ps(sum, _mm_max_ps(alpha, _mm_set1_ps(1e-30f))));
    }
}

/* The offline renderer's: all fragments of all views in one soft z, and views that see otherwise speak against one. */
struct soft_z_fragment {
    float rgba[4];        /* premultiplied; alpha > 0: what is left of the pixel in its view, front to back */
    float z, uncertainty; /* uncertainty sigma z */
    float blend;          /* the view's blending weight */
    float vote;           /* what the view's word counts, up to 1 */
    float before;         /* alpha of what its view has in front of it */
};

#define SOFT_Z_MERGE_MOST 40 /* fragments */

/* The fragments of a view stand one after the other, front to back. A fragment's standing is (for / (for + against))^2:
 * for it speak the votes of all fragments at its depth, itself included, against it those behind it, by what they have
 * more of than it leaves them - their views look through it - and in part those before it, by what they have more of
 * than its own view has there. It hides others and counts by its standing; of what is hidden by the views in front, the
 * most counts, so that at a rim the part that the front leaves stays with what is behind. A view's own fragments are
 * averaged as they are: they share the pixel's area. Views' colours are averaged as square roots: a mean over views that
 * disagree is then about what the eye takes for their mean, where one of radiances is too bright. The
 * depth is that of the surface that counts most, never a mean across a jump. rgba gets alpha 1. */
void soft_z_merge(const struct soft_z *s, const struct soft_z_fragment *fragments, int count, float rgba[4], float *z);

#endif
