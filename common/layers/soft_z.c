/* soft_z.c - see soft_z.h. */
#include "common/layers/soft_z.h"

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

#define AGAINST_BEFORE 0.3f  /* what a fragment in front of another speaks against it */
#define STANDING_WHOLE 0.25f /* a fragment of this standing hides wholly */
#define BLOCKS         (SOFT_Z_MERGE_MOST / 8)

/* A pixel's fragments, eight a vector; what is beyond the last one votes for nothing and hides nothing. */
struct merge {
    float z[SOFT_Z_MERGE_MOST], square[SOFT_Z_MERGE_MOST]; /* square: of the uncertainty */
    float vote[SOFT_Z_MERGE_MOST], alpha[SOFT_Z_MERGE_MOST], before[SOFT_Z_MERGE_MOST];
    float standing[SOFT_Z_MERGE_MOST], there[SOFT_Z_MERGE_MOST], weight[SOFT_Z_MERGE_MOST];
    __m256 apart[SOFT_Z_MERGE_MOST][BLOCKS]; /* 1 - w of each pair */
    int count, blocks;
};

static float at_most_one(float x) { return x < 1 ? x : 1; }

static float sum8(__m256 v)
{
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
    const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps(two, two, 1)));
}

static float most8(__m256 v)
{
    const __m128 four = _mm_max_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
    const __m128 two = _mm_max_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
}

/* Whether all fragments are so near each other that none hides or speaks against another. */
static bool one_surface(const struct soft_z *s, const struct soft_z_fragment *f, int count)
{
    float least = f[0].z, most = f[0].z, sure = f[0].uncertainty;
    for (int i = 1; i < count; i++) {
        least = f[i].z < least ? f[i].z : least;
        most = f[i].z > most ? f[i].z : most;
        sure = f[i].uncertainty < sure ? f[i].uncertainty : sure;
    }
    const float rho = s->widths > 0 ? 2 * s->widths * (float)M_SQRT2 * sure : s->range;
    return most - least <= 0.1f * rho;
}

/* 1 - w of fragment i and eight others. */
static __m256 apart8(const struct merge *m, const struct soft_z *s, int i, int block, __m256 dz)
{
    const __m256 one = _mm256_set1_ps(1), zero = _mm256_setzero_ps(), sign = _mm256_set1_ps(-0.0f);
    const __m256 rho =
        soft_z_rho8(s, _mm256_add_ps(_mm256_loadu_ps(m->square + 8 * block), _mm256_set1_ps(m->square[i])));
    const __m256 w = soft_z_weight8(soft_z_over8(_mm256_andnot_ps(sign, dz), rho), rho);
    return _mm256_sub_ps(one, _mm256_max_ps(zero, _mm256_min_ps(one, w)));
}

/* How far apart all pairs are, and every fragment's standing. */
static void standings(struct merge *m, const struct soft_z *s)
{
    const __m256 one = _mm256_set1_ps(1), zero = _mm256_setzero_ps();

    for (int i = 0; i < m->count; i++) {
        const __m256 leaves = _mm256_set1_ps(1 - m->before[i] - m->alpha[i]), before = _mm256_set1_ps(m->before[i]);
        __m256 pro = zero, contra = zero;
        for (int b = 0; b < m->blocks; b++) {
            const __m256 dz = _mm256_sub_ps(_mm256_loadu_ps(m->z + 8 * b), _mm256_set1_ps(m->z[i]));
            const __m256 farther = _mm256_cmp_ps(dz, zero, _CMP_GT_OQ);
            const __m256 alpha = _mm256_loadu_ps(m->alpha + 8 * b), vote = _mm256_loadu_ps(m->vote + 8 * b);
            const __m256 more = _mm256_max_ps(zero, _mm256_sub_ps(alpha, _mm256_blendv_ps(before, leaves, farther)));
            const __m256 part = _mm256_blendv_ps(_mm256_set1_ps(AGAINST_BEFORE), one, farther);
            const __m256 apart = apart8(m, s, i, b, dz);
            m->apart[i][b] = apart;
            pro = _mm256_add_ps(pro, _mm256_mul_ps(_mm256_mul_ps(vote, alpha), _mm256_sub_ps(one, apart)));
            contra = _mm256_add_ps(contra, _mm256_mul_ps(_mm256_mul_ps(part, vote), _mm256_mul_ps(more, apart)));
        }
        const float sum = sum8(pro), part = sum / (sum + sum8(contra) + 1e-30f);
        m->standing[i] = part * part;
    }
}

/* What of fragment i the fragments before it hide. */
static float hidden_part(const struct merge *m, int i)
{
    __m256 most = _mm256_setzero_ps();
    for (int b = 0; b < m->blocks; b++) {
        const __m256 before = _mm256_cmp_ps(_mm256_loadu_ps(m->z + 8 * b), _mm256_set1_ps(m->z[i]), _CMP_LT_OQ);
        const __m256 hides = _mm256_mul_ps(_mm256_loadu_ps(m->there + 8 * b), m->apart[i][b]);
        most = _mm256_max_ps(most, _mm256_and_ps(before, hides));
    }
    return most8(most);
}

static void merge_prepare(struct merge *m, const struct soft_z *s, const struct soft_z_fragment *f, int count)
{
    m->count = count;
    m->blocks = (count + 7) / 8;
    for (int i = 0; i < 8 * m->blocks; i++) {
        const bool is = i < count;
        m->z[i] = is ? f[i].z : 0;
        m->square[i] = is ? f[i].uncertainty * f[i].uncertainty : 0;
        m->vote[i] = is ? f[i].vote : 0;
        m->alpha[i] = is ? f[i].rgba[3] : 0;
        m->before[i] = is ? f[i].before : 0;
        m->there[i] = m->weight[i] = 0;
    }
    standings(m, s);
    for (int i = 0; i < count; i++)
        m->there[i] = at_most_one(f[i].blend * m->standing[i] / SOFT_Z_BLEND_WHOLE) *
                      at_most_one(m->standing[i] / STANDING_WHOLE) * (f[i].before + f[i].rgba[3]);
}

/* The mean of the depths of the surface that has most of the weight, never one across a jump. */
static float merged_depth(const struct merge *m)
{
    float most = 0, z = 0;
    for (int i = 0; i < m->count; i++) {
        __m256 sum = _mm256_setzero_ps(), z_sum = sum;
        for (int b = 0; b < m->blocks; b++) {
            const __m256 w = _mm256_sub_ps(_mm256_set1_ps(1), m->apart[i][b]);
            const __m256 part = _mm256_mul_ps(_mm256_loadu_ps(m->weight + 8 * b), w);
            sum = _mm256_add_ps(sum, part);
            z_sum = _mm256_add_ps(z_sum, _mm256_mul_ps(part, _mm256_loadu_ps(m->z + 8 * b)));
        }
        const float weight = sum8(sum);
        if (!(weight > most)) continue;
        most = weight;
        z = sum8(z_sum) / weight;
    }
    return z;
}

void soft_z_merge(const struct soft_z *s, const struct soft_z_fragment *f, int count, float rgba[4], float *z)
{
    const bool agree = one_surface(s, f, count);
    float sum = 0, own_sum = 0, z_sum = 0, z_weight = 0;
    __m128 color = _mm_setzero_ps(), own = color; /* own: of the view that the fragment is of */
    struct merge m;

    if (!agree) merge_prepare(&m, s, f, count);
    for (int i = 0; i < count; i++) {
        const float alpha = f[i].rgba[3], left = agree ? 1 : 1 - hidden_part(&m, i);
        const float seen = left <= 0 ? 0 : alpha < left ? alpha : left;
        const float there = seen * (agree ? 1 : m.standing[i]), weight = f[i].blend * there;
        const float present = there * at_most_one(f[i].blend / SOFT_Z_BLEND_WHOLE);
        const __m128 straight = _mm_div_ps(_mm_max_ps(_mm_setzero_ps(), _mm_loadu_ps(f[i].rgba)), _mm_set1_ps(alpha));
        own = _mm_add_ps(own, _mm_mul_ps(_mm_set1_ps(weight), straight));
        own_sum += weight;
        if (i + 1 == count || !(f[i + 1].before > 0)) {
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
