/* soft_z.c - the soft z-buffer [Pulli 1997], [Colburn 2014, 3.6.1, eq. 3.1].
 *
 * Views reconstruct the same surface at slightly different depths. A hard z-buffer picks one of them arbitrarily and
 * flickers; the soft z-buffer gives a sample at distance dz behind the closest one the weight
 *
 *   w(dz) = 1                                               dz <= gamma
 *           1/2 (1 + cos(pi (dz - gamma) / (rho - 2 gamma)))  gamma < dz <= rho - gamma
 *           0                                               beyond;     gamma = rho / 10
 *
 * In the thesis rho is the scene's depth range. Here, with a width of k > 0 uncertainties, inverse depths take the
 * place of depths, because a match is as precise in 1/z everywhere: dz = 1/z_closest - 1/z. Two depths z_a, z_b of
 * relative uncertainties s_a, s_b have u = sqrt((s_a / z_a)^2 + (s_b / z_b)^2) and rho = 2 k u: the weight is 1/2 at dz
 * = k u and 0 from 1.8 k u on. In z, a far and unsure surface would show through all that is in front of it.
 *
 * soft_z_blend8 (fast renderer, one sample per view). Colour is weighted by blend x w x alpha and normalised; depth is
 * sum(w p z) / sum(w p), without blending weights. A view that enters or leaves must not make a jump, so a sample of
 * small blending weight or alpha hides others, and counts in the depth, only by its presence p:
 *   p = min(1, blend / 0.05) min(1, alpha / 0.5);  w_i = min over c closer than i of 1 - p_c (1 - w(z_i - z_c))
 * This is the formula above wherever every p is 1.
 *
 * soft_z_merge (offline renderer, all fragments of all views in one buffer [Colburn 2014, 3.6.2]). Beyond the thesis,
 * views vote, with a width of VOTE_WIDTHS. The support of a fragment is (for / (for + against))^2. For: the votes of
 * all fragments at its depth, its own included. Against: fragments behind it, by the alpha that they have in excess of
 * what it leaves free (their views look through it); and, by AGAINST_IN_FRONT, fragments in front of it, by the alpha
 * that they have in excess of what its own view has there. A fragment hides others and counts by its support; of
 * several in front of one, the one that hides most counts. A fragment that has only a part of the pixel lies at a
 * silhouette, whose place is unsure by about a pixel in each view: it neither hides nor is hidden, so that silhouettes
 * of several views are averaged.
 *
 * The fragments of one view are averaged linearly: they share the pixel's area. Colours of different views are averaged
 * as square roots: where views disagree, this mean is close to the perceived one, and a mean of radiances is too
 * bright. The depth is that of the surface of largest weight, as wide as votes, never a mean across a depth jump. */
#include "common/layers/soft_z.h"

#include <math.h>
#include <stdbool.h>

#include "common/math/lanes.h"

float soft_z_weight(float dz, float gamma, float rho)
{
    if (dz <= gamma) return 1;
    if (!(dz <= rho - gamma)) return 0;
    return 0.5f * (1 + cosf((float)M_PI * (dz - gamma) / (rho - 2 * gamma)));
}

static float known_sigma(float sigma) { return sigma > SOFT_Z_MIN_SIGMA ? sigma : SOFT_Z_MIN_SIGMA; }

float soft_z_rho(const struct soft_z *s, float z_a, float sigma_a, float z_b, float sigma_b)
{
    if (!(s->widths > 0)) return s->range;
    const float a = known_sigma(sigma_a) * z_a, b = known_sigma(sigma_b) * z_b;
    return 2 * s->widths * sqrtf(a * a + b * b);
}

#define VOTE_WIDTHS      12      /* depth uncertainties, but never more than the soft z-buffer's width */
#define AGAINST_IN_FRONT 0.3f    /* weight of the votes of fragments in front */
#define FULL_SUPPORT     0.25f   /* a fragment of this support hides completely */
#define WHOLE            0.9999f /* alpha from which on a fragment has the whole pixel */
#define BLOCKS           (SOFT_Z_MAX_FRAGMENTS / 8)

/* A pixel's fragments, in vectors of eight; the padding has vote, alpha and presence 0. */
struct fragment_merge {
    float z[SOFT_Z_MAX_FRAGMENTS], order[SOFT_Z_MAX_FRAGMENTS]; /* order: soft_z_order() */
    float square[SOFT_Z_MAX_FRAGMENTS];                         /* of the order's uncertainty */
    float vote[SOFT_Z_MAX_FRAGMENTS], alpha[SOFT_Z_MAX_FRAGMENTS], front_alpha[SOFT_Z_MAX_FRAGMENTS];
    float support[SOFT_Z_MAX_FRAGMENTS], presence[SOFT_Z_MAX_FRAGMENTS], weight[SOFT_Z_MAX_FRAGMENTS];
    __m256 separation[SOFT_Z_MAX_FRAGMENTS][BLOCKS]; /* 1 - w of whole fragments and others */
    __m256 apart[SOFT_Z_MAX_FRAGMENTS][BLOCKS];      /* 1 - w of each pair by the width of votes */
    int count, blocks;
};

static float clamp_one(float x) { return x < 1 ? x : 1; }

static float max8(__m256 v)
{
    const __m128 four = _mm_max_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
    const __m128 two = _mm_max_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
}

/* Uncertainty of a fragment's soft_z_order(). */
static float order_uncertainty(const struct soft_z *s, const struct soft_z_fragment *f)
{
    return s->widths > 0 ? f->sigma / f->z : f->sigma * f->z;
}

/* The z-buffer's width, or that of votes if it is narrower. */
static struct soft_z vote_width(const struct soft_z *s)
{
    return (struct soft_z){s->widths < VOTE_WIDTHS ? s->widths : VOTE_WIDTHS, s->range};
}

/* Whether all fragments are within gamma of each other, so that none hides or votes against another. */
static bool one_surface(const struct soft_z *s, const struct soft_z_fragment *f, int count)
{
    float min = f[0].z, max = f[0].z, uncertainty = order_uncertainty(s, &f[0]);
    for (int i = 1; i < count; i++) {
        min = f[i].z < min ? f[i].z : min;
        max = f[i].z > max ? f[i].z : max;
        uncertainty = fminf(uncertainty, order_uncertainty(s, &f[i]));
    }
    const float rho = s->widths > 0 ? 2 * s->widths * (float)M_SQRT2 * uncertainty : s->range;
    return soft_z_order(s, max) - soft_z_order(s, min) <= 0.1f * rho;
}

/* 1 - w of fragment i and eight others. */
static __m256 separation8(const struct fragment_merge *m, const struct soft_z *s, int i, int block, __m256 dz)
{
    const __m256 one = _mm256_set1_ps(1), zero = _mm256_setzero_ps(), sign = _mm256_set1_ps(-0.0f);
    const __m256 rho =
        soft_z_rho8(s, _mm256_add_ps(_mm256_loadu_ps(m->square + 8 * block), _mm256_set1_ps(m->square[i])));
    const __m256 w = soft_z_weight8(soft_z_over8(_mm256_andnot_ps(sign, dz), rho), rho);
    return _mm256_sub_ps(one, _mm256_max_ps(zero, _mm256_min_ps(one, w)));
}

/* The separation of all pairs, and the support of each fragment. */
static void find_support(struct fragment_merge *m, const struct soft_z *s)
{
    const __m256 one = _mm256_set1_ps(1), zero = _mm256_setzero_ps();
    const struct soft_z votes = vote_width(s);

    for (int i = 0; i < m->count; i++) {
        const __m256 leaves = _mm256_set1_ps(1 - m->front_alpha[i] - m->alpha[i]);
        const __m256 front = _mm256_set1_ps(m->front_alpha[i]);
        __m256 pro = zero, contra = zero;
        for (int b = 0; b < m->blocks; b++) {
            const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(m->order + 8 * b), _mm256_set1_ps(m->order[i]));
            const __m256 farther = _mm256_cmp_ps(dz, zero, _CMP_GT_OQ);
            const __m256 alpha = _mm256_loadu_ps(m->alpha + 8 * b), vote = _mm256_loadu_ps(m->vote + 8 * b);
            const __m256 more = _mm256_max_ps(zero, _mm256_sub_ps(alpha, _mm256_blendv_ps(front, leaves, farther)));
            const __m256 part = _mm256_blendv_ps(_mm256_set1_ps(AGAINST_IN_FRONT), one, farther);
            const __m256 apart = m->apart[i][b] = separation8(m, &votes, i, b, dz);
            if (m->alpha[i] >= WHOLE) m->separation[i][b] = separation8(m, s, i, b, dz);
            pro = _mm256_add_ps(pro, _mm256_mul_ps(_mm256_mul_ps(vote, alpha), _mm256_sub_ps(one, apart)));
            contra = _mm256_add_ps(contra, _mm256_mul_ps(_mm256_mul_ps(part, vote), _mm256_mul_ps(more, apart)));
        }
        const float sum = lanes_sum(pro), part = sum / (sum + lanes_sum(contra) + 1e-30f);
        m->support[i] = part * part;
    }
}

/* The part of fragment i that fragments in front of it hide. */
static float hidden_part(const struct fragment_merge *m, int i)
{
    if (!(m->alpha[i] >= WHOLE)) return 0;
    __m256 max = _mm256_setzero_ps();
    for (int b = 0; b < m->blocks; b++) {
        const __m256 in_front = _mm256_cmp_ps(_mm256_loadu_ps(m->z + 8 * b), _mm256_set1_ps(m->z[i]), _CMP_LT_OQ);
        const __m256 hides = _mm256_mul_ps(_mm256_loadu_ps(m->presence + 8 * b), m->separation[i][b]);
        max = _mm256_max_ps(max, _mm256_and_ps(in_front, hides));
    }
    return max8(max);
}

static void merge_prepare(struct fragment_merge *m, const struct soft_z *s, const struct soft_z_fragment *f, int count)
{
    m->count = count;
    m->blocks = (count + 7) / 8;
    for (int i = 0; i < 8 * m->blocks; i++) {
        const bool is = i < count;
        m->z[i] = is ? f[i].z : 0;
        m->order[i] = is ? soft_z_order(s, f[i].z) : 0;
        m->square[i] = is ? order_uncertainty(s, &f[i]) * order_uncertainty(s, &f[i]) : 0;
        m->vote[i] = is ? f[i].vote : 0;
        m->alpha[i] = is ? f[i].rgba[3] : 0;
        m->front_alpha[i] = is ? f[i].front_alpha : 0;
        m->presence[i] = m->weight[i] = 0;
    }
    find_support(m, s);
    for (int i = 0; i < count; i++)
        if (m->alpha[i] >= WHOLE)
            m->presence[i] =
                clamp_one(f[i].blend * m->support[i] / SOFT_Z_FULL_BLEND) * clamp_one(m->support[i] / FULL_SUPPORT);
}

/* Mean depth of the surface of largest weight, never across a depth jump. */
static float merged_depth(const struct fragment_merge *m)
{
    float max = 0, z = 0;
    for (int i = 0; i < m->count; i++) {
        __m256 sum = _mm256_setzero_ps(), z_sum = sum;
        for (int b = 0; b < m->blocks; b++) {
            const __m256 w = _mm256_sub_ps(_mm256_set1_ps(1), m->apart[i][b]);
            const __m256 part = _mm256_mul_ps(_mm256_loadu_ps(m->weight + 8 * b), w);
            sum = _mm256_add_ps(sum, part);
            z_sum = _mm256_add_ps(z_sum, _mm256_mul_ps(part, _mm256_loadu_ps(m->z + 8 * b)));
        }
        const float weight = lanes_sum(sum);
        if (!(weight > max)) continue;
        max = weight;
        z = lanes_sum(z_sum) / weight;
    }
    return z;
}

void soft_z_merge(const struct soft_z *s, const struct soft_z_fragment *f, int count, float rgba[4], float *z)
{
    const struct soft_z votes = vote_width(s);
    const bool agree = one_surface(&votes, f, count);
    float sum = 0, own_sum = 0, z_sum = 0, z_weight = 0;
    __m128 color = _mm_setzero_ps(), own = color; /* own: of the fragment's view */
    struct fragment_merge m;

    if (!agree) merge_prepare(&m, s, f, count);
    for (int i = 0; i < count; i++) {
        const float alpha = f[i].rgba[3], left = agree ? 1 : 1 - hidden_part(&m, i);
        const float seen = left <= 0 ? 0 : alpha < left ? alpha : left;
        const float visible = seen * (agree ? 1 : m.support[i]), weight = f[i].blend * visible;
        const float present = visible * clamp_one(f[i].blend / SOFT_Z_FULL_BLEND);
        const __m128 straight = _mm_div_ps(_mm_max_ps(_mm_setzero_ps(), _mm_loadu_ps(f[i].rgba)), _mm_set1_ps(alpha));
        own = _mm_add_ps(own, _mm_mul_ps(_mm_set1_ps(weight), straight));
        own_sum += weight;
        if (i + 1 == count || !(f[i + 1].front_alpha > 0)) {
            const __m128 mean = _mm_mul_ps(own, _mm_set1_ps(own_sum > 0 ? 1 / own_sum : 0));
            color = _mm_add_ps(color, _mm_mul_ps(_mm_set1_ps(own_sum), _mm_sqrt_ps(mean)));
            sum += own_sum;
            own = _mm_setzero_ps();
            own_sum = 0;
        }
        z_sum += present * f[i].z;
        z_weight += present;
        if (!agree) m.weight[i] = present;
    }
    const __m128 mean = _mm_mul_ps(color, _mm_set1_ps(sum > 0 ? 1 / sum : 0));
    _mm_storeu_ps(rgba, _mm_mul_ps(mean, mean));
    rgba[3] = sum > 0;
    *z = !agree ? merged_depth(&m) : z_weight > 0 ? z_sum / z_weight : 0;
}
