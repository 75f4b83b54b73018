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
    f32x8 separation[SOFT_Z_MAX_FRAGMENTS][BLOCKS]; /* 1 - w of whole fragments and others */
    f32x8 apart[SOFT_Z_MAX_FRAGMENTS][BLOCKS];      /* 1 - w of each pair by the width of votes */
    int count, blocks;
};

static float clamp_one(float x) { return x < 1 ? x : 1; }

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
static f32x8 separation8(const struct fragment_merge *m, const struct soft_z *s, int i, int block, f32x8 dz)
{
    const f32x8 one = f32x8_all(1), zero = {0};
    const f32x8 rho = soft_z_rho8(s, f32x8_load(m->square + 8 * block) + m->square[i]);
    const f32x8 w = soft_z_weight8(soft_z_over8(f32x8_abs(dz), rho), rho);
    return one - f32x8_max(zero, f32x8_min(one, w));
}

/* The separation of all pairs, and the support of each fragment. */
static void find_support(struct fragment_merge *m, const struct soft_z *s)
{
    const f32x8 one = f32x8_all(1), zero = {0};
    const struct soft_z votes = vote_width(s);

    for (int i = 0; i < m->count; i++) {
        const f32x8 leaves = f32x8_all(1 - m->front_alpha[i] - m->alpha[i]);
        const f32x8 front = f32x8_all(m->front_alpha[i]);
        f32x8 pro = zero, contra = zero;
        for (int b = 0; b < m->blocks; b++) {
            const f32x8 dz = f32x8_load(m->order + 8 * b) - m->order[i];
            const i32x8 farther = dz > zero;
            const f32x8 alpha = f32x8_load(m->alpha + 8 * b), vote = f32x8_load(m->vote + 8 * b);
            const f32x8 more = f32x8_max(zero, alpha - f32x8_if(farther, leaves, front));
            const f32x8 part = f32x8_if(farther, one, f32x8_all(AGAINST_IN_FRONT));
            const f32x8 apart = m->apart[i][b] = separation8(m, &votes, i, b, dz);
            if (m->alpha[i] >= WHOLE) m->separation[i][b] = separation8(m, s, i, b, dz);
            pro += vote * alpha * (one - apart);
            contra += part * vote * (more * apart);
        }
        const float sum = f32x8_sum(pro), part = sum / (sum + f32x8_sum(contra) + 1e-30f);
        m->support[i] = part * part;
    }
}

/* The part of fragment i that fragments in front of it hide. */
static float hidden_part(const struct fragment_merge *m, int i)
{
    if (!(m->alpha[i] >= WHOLE)) return 0;
    f32x8 max = {0};
    for (int b = 0; b < m->blocks; b++) {
        const i32x8 in_front = f32x8_load(m->z + 8 * b) < m->z[i];
        const f32x8 hides = f32x8_load(m->presence + 8 * b) * m->separation[i][b];
        max = f32x8_max(max, f32x8_where(in_front, hides));
    }
    return f32x8_largest(max);
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
        f32x8 sum = {0}, z_sum = sum;
        for (int b = 0; b < m->blocks; b++) {
            const f32x8 w = 1 - m->apart[i][b];
            const f32x8 part = f32x8_load(m->weight + 8 * b) * w;
            sum += part;
            z_sum += part * f32x8_load(m->z + 8 * b);
        }
        const float weight = f32x8_sum(sum);
        if (!(weight > max)) continue;
        max = weight;
        z = f32x8_sum(z_sum) / weight;
    }
    return z;
}

void soft_z_merge(const struct soft_z *s, const struct soft_z_fragment *f, int count, float rgba[4], float *z)
{
    const struct soft_z votes = vote_width(s);
    const bool agree = one_surface(&votes, f, count);
    float sum = 0, own_sum = 0, z_sum = 0, z_weight = 0;
    f32x4 color = {0}, own = color; /* own: of the fragment's view */
    struct fragment_merge m;

    if (!agree) merge_prepare(&m, s, f, count);
    for (int i = 0; i < count; i++) {
        const float alpha = f[i].rgba[3], left = agree ? 1 : 1 - hidden_part(&m, i);
        const float seen = left <= 0 ? 0 : alpha < left ? alpha : left;
        const float visible = seen * (agree ? 1 : m.support[i]), weight = f[i].blend * visible;
        const float present = visible * clamp_one(f[i].blend / SOFT_Z_FULL_BLEND);
        const f32x4 straight = f32x4_max((f32x4){0}, f32x4_load(f[i].rgba)) / alpha;
        own += weight * straight;
        own_sum += weight;
        if (i + 1 == count || !(f[i + 1].front_alpha > 0)) {
            const f32x4 mean = own * (own_sum > 0 ? 1 / own_sum : 0);
            color += own_sum * f32x4_sqrt(mean);
            sum += own_sum;
            own = (f32x4){0};
            own_sum = 0;
        }
        z_sum += present * f[i].z;
        z_weight += present;
        if (!agree) m.weight[i] = present;
    }
    const f32x4 mean = color * (sum > 0 ? 1 / sum : 0);
    f32x4_store(rgba, mean * mean);
    rgba[3] = sum > 0;
    *z = !agree ? merged_depth(&m) : z_weight > 0 ? z_sum / z_weight : 0;
}
