/* plane_match.c - the matching cost of a segment on a plane. Most of the stage's time is spent in neighbour_cost().
 *
 * A plane 1/z = a u + b v + c maps the segment to a neighbour by the homography H = base + shift (a b c). A pixel's
 * cost in a neighbour is the sum of weighted truncated differences
 *   sum over channels k of weight_k min(limit_k, |feature_k(pixel) - feature_k(H pixel)|)
 * of colours and gradients, as in [Bleyer 2011]; the segment's is the weighted mean over the pixels that the neighbour
 * sees. Costs are normalized so that 0 is a good match of this view and 1 a chance one (match_calibrate()), and
 * clamped to [MATCH_BEST, MATCH_WORST]. The neighbours' costs are sorted and averaged with weights that fall by
 * RANK_WEIGHT: the segment may be occluded in the worse ones. Only the best `ranks` count, and after match_select() a
 * segment is compared with no others.
 *
 * A texture element has 2 x FEATURE_CHANNELS bytes, those of a pixel and of the pixel below. 32 bytes from one address
 * hold the four corners of a bilinear sample: _mm256_maddubs_epi16 weighs them in vertical pairs, and the two columns
 * are added. Sums are integers; the weight of the validity channel lifts an invalid pixel over every other cost. */
#include "stages/segment_depth/plane_match.h"

#include <immintrin.h>
#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "stages/segment_depth/match_features.h"

/* Truncations (in grey levels) and weights, tuned on pairs of known disparity. Gradients weigh more than colours. */
enum { COLOUR_LIMIT = 16, FINE_LIMIT = 14, COARSE_LIMIT = 14 };
enum { COLOUR_WEIGHT = 10, FINE_WEIGHT = 50, COARSE_WEIGHT = 20, VALID_WEIGHT = 1000 };
enum {
    WORST = FEATURE_UNIT *
            (3 * COLOUR_LIMIT * COLOUR_WEIGHT + 2 * FINE_LIMIT * FINE_WEIGHT + 2 * COARSE_LIMIT * COARSE_WEIGHT),
    INVISIBLE_COST = WORST + 1,
};

/* Costs of a neighbour that the segment is out of view of, or occluded in; and the weight of a neighbour relative to
 * that of the next better one. MATCH_WORST limits the other costs, since texture on a blank wall must not match better
 * than on other texture. */
#define OUT_OF_VIEW_COST 0.4f
#define OCCLUDED_COST    0.67f
#define RANK_WEIGHT      0.6

/* Contrast of good to chance matches that a neighbour must have: of the best neighbour's (with less, it shows something
 * else, or nothing), and in any case, for pictures without any texture. */
#define MIN_RELATIVE_CONTRAST 0.25
#define MIN_CONTRAST          0.05

/* Weighted truncated differences of two pixels, one per 128-bit lane, summed over pairs of channels. at: offsets of the
 * upper left corners, in halves of a texture element; corners: the corners' weights, which sum to FEATURE_UNIT, the
 * left column's in bytes 0 and 1. */
static inline __m256i pair_differences(const uint8_t *texture, const int *at, const int *corners,
                                       const int16_t *reference)
{
    const __m256i columns = _mm256_set_m128i(_mm_set1_epi16(0x0302), _mm_set1_epi16(0x0100));
    const __m256i limit =
        _mm256_setr_epi16(FEATURE_UNIT * COLOUR_LIMIT, FEATURE_UNIT * COLOUR_LIMIT, FEATURE_UNIT * COLOUR_LIMIT,
                          FEATURE_UNIT * FINE_LIMIT, FEATURE_UNIT * FINE_LIMIT, FEATURE_UNIT * COARSE_LIMIT,
                          FEATURE_UNIT * COARSE_LIMIT, 32767, FEATURE_UNIT * COLOUR_LIMIT, FEATURE_UNIT * COLOUR_LIMIT,
                          FEATURE_UNIT * COLOUR_LIMIT, FEATURE_UNIT * FINE_LIMIT, FEATURE_UNIT * FINE_LIMIT,
                          FEATURE_UNIT * COARSE_LIMIT, FEATURE_UNIT * COARSE_LIMIT, 32767);
    const __m256i weight =
        _mm256_setr_epi16(COLOUR_WEIGHT, COLOUR_WEIGHT, COLOUR_WEIGHT, FINE_WEIGHT, FINE_WEIGHT, COARSE_WEIGHT,
                          COARSE_WEIGHT, VALID_WEIGHT, COLOUR_WEIGHT, COLOUR_WEIGHT, COLOUR_WEIGHT, FINE_WEIGHT,
                          FINE_WEIGHT, COARSE_WEIGHT, COARSE_WEIGHT, VALID_WEIGHT);
    __m256i p = _mm256_maddubs_epi16(
        _mm256_loadu_si256((const __m256i *)(texture + (size_t)(unsigned)at[0] * FEATURE_CHANNELS)),
        _mm256_shuffle_epi8(_mm256_set1_epi32(corners[0]), columns));
    __m256i q = _mm256_maddubs_epi16(
        _mm256_loadu_si256((const __m256i *)(texture + (size_t)(unsigned)at[1] * FEATURE_CHANNELS)),
        _mm256_shuffle_epi8(_mm256_set1_epi32(corners[1]), columns));
    __m256i sample = _mm256_add_epi16(_mm256_permute2x128_si256(p, q, 0x20), _mm256_permute2x128_si256(p, q, 0x31));
    /* saturating: the padding's validity is far below any sample's */
    __m256i difference = _mm256_abs_epi16(_mm256_subs_epi16(sample, _mm256_loadu_si256((const __m256i *)reference)));
    return _mm256_madd_epi16(_mm256_min_epi16(difference, limit), weight);
}

/* A plane's homography into a neighbour, and the neighbour's size, in vectors. */
struct warp8 {
    __m256 h[3][3];
    __m256 right, bottom, max_u, max_v;
    __m256i stride;
    const uint8_t *texture;
};

static inline struct warp8 warp_make(const struct match_neighbour *n, struct plane plane)
{
    const double slope[3] = {plane.a, plane.b, plane.c};
    const __m256 half = _mm256_set1_ps(0.5f);
    struct warp8 w = {.right = _mm256_set1_ps((float)(n->width - 1)),
                      .bottom = _mm256_set1_ps((float)(n->height - 1)),
                      .stride = _mm256_set1_epi32(n->width + 1),
                      .texture = n->texture};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) w.h[i][j] = _mm256_set1_ps((float)(n->base[i][j] + n->shift[i] * slope[j]));
    w.max_u = _mm256_add_ps(w.right, half);
    w.max_v = _mm256_add_ps(w.bottom, half);
    return w;
}

/* Costs of eight pixels, times WORST, and the mask of those that the neighbour sees; lanes in the order of pixels
 * 0 2 4 6 | 1 3 5 7. False: it sees none. reference: the pixels' features. */
static inline __attribute__((always_inline)) bool costs8(const struct warp8 *w, __m256 x, __m256 y,
                                                         const int16_t *reference, __m256i *cost, __m256i *mask)
{
    const __m256 half = _mm256_set1_ps(0.5f), zero = _mm256_setzero_ps(), small = _mm256_set1_ps(1e-9f);
    const __m256 low = _mm256_set1_ps(-0.5f);
    __m256 p[3];
    for (int k = 0; k < 3; k++)
        p[k] = _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(w->h[k][0], x), _mm256_mul_ps(w->h[k][1], y)), w->h[k][2]);
    __m256 inverse = _mm256_div_ps(_mm256_set1_ps(1), p[2]);
    __m256 u = _mm256_sub_ps(_mm256_mul_ps(p[0], inverse), half);
    __m256 v = _mm256_sub_ps(_mm256_mul_ps(p[1], inverse), half);
    __m256 visible = _mm256_and_ps(
        _mm256_cmp_ps(p[2], small, _CMP_GT_OQ),
        _mm256_and_ps(_mm256_and_ps(_mm256_cmp_ps(u, low, _CMP_GE_OQ), _mm256_cmp_ps(u, w->max_u, _CMP_LE_OQ)),
                      _mm256_and_ps(_mm256_cmp_ps(v, low, _CMP_GE_OQ), _mm256_cmp_ps(v, w->max_v, _CMP_LE_OQ))));
    if (_mm256_testz_ps(visible, visible)) return false;
    u = _mm256_min_ps(_mm256_max_ps(u, zero), w->right); /* NaN becomes 0: max returns its second operand */
    v = _mm256_min_ps(_mm256_max_ps(v, zero), w->bottom);
    __m256i column = _mm256_cvttps_epi32(u), row = _mm256_cvttps_epi32(v);
    const __m256 unit = _mm256_set1_ps(FEATURE_UNIT), fv = _mm256_sub_ps(v, _mm256_cvtepi32_ps(row));
    const __m256 fu = _mm256_mul_ps(_mm256_sub_ps(u, _mm256_cvtepi32_ps(column)), unit);
    /* rounded so that the corners' weights sum to FEATURE_UNIT; the upper left one may be -1 */
    const __m256i lower_right = _mm256_cvtps_epi32(_mm256_mul_ps(fu, fv));
    const __m256i upper_right = _mm256_sub_epi32(_mm256_cvtps_epi32(fu), lower_right);
    const __m256i lower_left = _mm256_sub_epi32(_mm256_cvtps_epi32(_mm256_mul_ps(fv, unit)), lower_right);
    const __m256i upper_left = _mm256_sub_epi32(
        _mm256_set1_epi32(FEATURE_UNIT), _mm256_add_epi32(_mm256_add_epi32(lower_right, upper_right), lower_left));
    const __m256i low_byte = _mm256_set1_epi32(255);
    _Alignas(32) int at[8], corners[8];
    _mm256_store_si256((__m256i *)at,
                       _mm256_slli_epi32(_mm256_add_epi32(_mm256_mullo_epi32(row, w->stride), column), 1));
    _mm256_store_si256(
        (__m256i *)corners,
        _mm256_or_si256(_mm256_or_si256(_mm256_and_si256(upper_left, low_byte), _mm256_slli_epi32(lower_left, 8)),
                        _mm256_or_si256(_mm256_slli_epi32(upper_right, 16), _mm256_slli_epi32(lower_right, 24))));
    __asm__(""
            : "+m"(at), "+m"(corners)); /* keeps them in memory: loading them one by one is faster than extracting
                                           lanes */
    __m256i q[4];
    for (int k = 0; k < 4; k++)
        q[k] = pair_differences(w->texture, at + 2 * k, corners + 2 * k,
                                reference + (ptrdiff_t)(2 * k) * FEATURE_CHANNELS);
    /* the order of lanes does not matter to integer sums, but it does to mask and weight */
    *cost = _mm256_hadd_epi32(_mm256_hadd_epi32(q[0], q[1]), _mm256_hadd_epi32(q[2], q[3]));
    *mask = _mm256_permutevar8x32_epi32(_mm256_castps_si256(visible), _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7));
    *mask = _mm256_and_si256(*mask, _mm256_cmpgt_epi32(_mm256_set1_epi32(INVISIBLE_COST), *cost));
    return true;
}

/* Raw mean cost of the pixels [begin, end) in one neighbour, 0 .. 1; *seen: how many of them it sees. */
static float neighbour_cost(const struct matcher *m, const struct match_neighbour *n, int begin, int end,
                            struct plane plane, int *seen)
{
    const struct warp8 warp = warp_make(n, plane);
    __m256i sum = _mm256_setzero_si256(), count = sum, weight_sum = sum;
    for (int i = begin; i < end; i += 8) {
        __m256i cost, mask;
        if (!costs8(&warp, _mm256_load_ps(m->x + i), _mm256_load_ps(m->y + i),
                    m->features + (size_t)i * FEATURE_CHANNELS, &cost, &mask))
            continue;
        const __m256i weight = _mm256_load_si256((const __m256i *)(m->weight + i));
        sum = _mm256_add_epi32(sum, _mm256_mullo_epi32(_mm256_srli_epi32(_mm256_and_si256(mask, cost), 8), weight));
        weight_sum = _mm256_add_epi32(weight_sum, _mm256_and_si256(mask, weight));
        count = _mm256_sub_epi32(count, mask);
    }
    _Alignas(32) uint32_t sums[8];
    _Alignas(32) int counts[8], weights[8];
    _mm256_store_si256((__m256i *)weights, weight_sum);
    _mm256_store_si256((__m256i *)sums, sum);
    _mm256_store_si256((__m256i *)counts, count);
    int64_t total = 0, all = 0;
    *seen = 0;
    for (int k = 0; k < 8; k++) {
        total += sums[k];
        *seen += counts[k];
        all += weights[k];
    }
    return all > 0 ? (float)((double)total * 256 / ((double)WORST * (double)all))
                   : 1; /* a pixel's weight is at least 1 */
}

void match_row(const struct matcher *m, int neighbour, struct plane plane, int x, int y, int count, float *costs)
{
    const struct warp8 warp = warp_make(&m->neighbours[neighbour], plane);
    const int16_t *reference = m->raster + ((size_t)y * (size_t)m->segments->width + (size_t)x) * FEATURE_CHANNELS;
    const __m256 lanes = _mm256_setr_ps(0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f);
    const __m256 scale = _mm256_set1_ps(1 / ((float)WORST * (m->chance_cost - m->good_cost)));
    const __m256 offset = _mm256_set1_ps(-m->good_cost / (m->chance_cost - m->good_cost));
    const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
    for (int i = 0; i < count; i += 8) {
        __m256i cost, mask;
        __m256 out = _mm256_set1_ps(MATCH_UNSEEN);
        if (costs8(&warp, _mm256_add_ps(_mm256_set1_ps((float)(x + i)), lanes), _mm256_set1_ps((float)y + 0.5f),
                   reference + (size_t)i * FEATURE_CHANNELS, &cost, &mask)) {
            const __m256 own = _mm256_add_ps(_mm256_mul_ps(_mm256_cvtepi32_ps(cost), scale), offset);
            out = _mm256_permutevar8x32_ps(_mm256_blendv_ps(out, own, _mm256_castsi256_ps(mask)), order);
        }
        _mm256_storeu_ps(costs + i, out);
    }
}

float match_rank(const struct matcher *m, const float *sorted, int count, int useful, float out_of_view)
{
    double sum = 0, total = 0, weight = 1;
    if (useful > m->ranks) useful = m->ranks;
    for (int k = 0; k < useful; k++, weight *= RANK_WEIGHT) {
        sum += weight * (double)(k < count ? sorted[k] : out_of_view);
        total += weight;
    }
    return useful ? (float)(sum / total) : out_of_view;
}

/* The segment's cost over all neighbours; one that sees less than half of the pixels does not see the segment. */
static inline float ranked_cost(const struct matcher *m, int segment, int pixels, struct plane plane, unsigned use,
                                unsigned occluded, unsigned *best)
{
    float costs[MAX_NEIGHBOURS];
    unsigned order[MAX_NEIGHBOURS];
    const int begin = m->first[segment],
              end = pixels < m->segments->segments[segment].pixels ? begin + pixels : m->first[segment + 1];
    const float out_of_view = m->out_of_view_cost ? m->out_of_view_cost[segment] : OUT_OF_VIEW_COST;
    int count = 0;
    int useful = 0;
    for (int k = 0; k < m->neighbour_count; k++) {
        int seen = pixels, at;
        if (!(use >> k & 1)) continue;
        useful++;
        float cost = m->occluded_cost ? m->occluded_cost[segment] : OCCLUDED_COST;
        if (!(occluded >> k & 1))
            cost = (neighbour_cost(m, &m->neighbours[k], begin, end, plane, &seen) - m->good_cost) /
                   (m->chance_cost - m->good_cost);
        if (2 * seen < pixels) continue;
        cost = fminf(fmaxf(cost, MATCH_BEST), MATCH_WORST);
        for (at = count++; at > 0 && costs[at - 1] > cost; at--) {
            costs[at] = costs[at - 1];
            order[at] = order[at - 1];
        }
        costs[at] = cost;
        order[at] = 1u << k;
    }
    for (int k = 0; best && k < count && k < m->ranks; k++) *best |= order[k];
    return match_rank(m, costs, count, useful, out_of_view);
}

unsigned match_neighbours_of(const struct matcher *m, int segment)
{
    return (m->use ? m->use[segment] : ~0u) & ~m->excluded;
}

float match_cost(const struct matcher *m, int segment, struct plane plane, unsigned occluded)
{
    return ranked_cost(m, segment, m->segments->segments[segment].pixels, plane, match_neighbours_of(m, segment),
                       occluded, NULL);
}

/* A fourth of a segment's pixels, rounded up to groups of eight. */
static int rough_pixels(int pixels)
{
    const int part = (pixels / 4 + 7) / 8 * 8;
    return part < 8 ? (pixels < 8 ? pixels : 8) : part < pixels ? part : pixels;
}

float match_cost_rough(const struct matcher *m, int segment, struct plane plane, unsigned occluded)
{
    return ranked_cost(m, segment, rough_pixels(m->segments->segments[segment].pixels), plane,
                       match_neighbours_of(m, segment), occluded, NULL);
}

float match_cost_sweep(const struct matcher *m, int segment, struct plane plane, unsigned use, unsigned *best)
{
    if (best) *best = 0;
    return ranked_cost(m, segment, rough_pixels(m->segments->segments[segment].pixels), plane, use & ~m->excluded, 0,
                       best);
}

int match_evidence(const struct matcher *m, int segment, struct plane plane, unsigned occluded, float *cost)
{
    float costs[MAX_NEIGHBOURS];
    const int begin = m->first[segment], end = m->first[segment + 1], pixels = m->segments->segments[segment].pixels;
    int count = 0;
    for (int k = 0; k < m->neighbour_count; k++) {
        int seen, at;
        if ((m->excluded | occluded) >> k & 1) continue;
        const float raw = neighbour_cost(m, &m->neighbours[k], begin, end, plane, &seen);
        if (2 * seen < pixels) continue;
        const float own = fminf(fmaxf((raw - m->good_cost) / (m->chance_cost - m->good_cost), MATCH_BEST), MATCH_WORST);
        for (at = count++; at > 0 && costs[at - 1] > own; at--) costs[at] = costs[at - 1];
        costs[at] = own;
    }
    double sum = 0, total = 0, weight = 1;
    for (int k = 0; k < count && k < m->ranks; k++, weight *= RANK_WEIGHT) {
        sum += weight * (double)costs[k];
        total += weight;
    }
    *cost = count ? (float)(sum / total) : MATCH_WORST;
    return count;
}

struct selection {
    struct matcher *m;
    const struct plane *planes;
    const unsigned *occluded;
};

static void select_neighbours(void *ctx, size_t begin, size_t end, int thread)
{
    const struct selection *job = ctx;
    struct matcher *m = job->m;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const int pixels = rough_pixels(m->segments->segments[i].pixels);
        float costs[MAX_NEIGHBOURS];
        int order[MAX_NEIGHBOURS], count = 0;
        for (int k = 0; k < m->neighbour_count; k++) {
            int seen, at;
            if (m->excluded >> k & 1) continue;
            float cost = neighbour_cost(m, &m->neighbours[k], m->first[i], m->first[i] + pixels, job->planes[i], &seen);
            if (2 * seen < pixels) cost = 2;
            if (job->occluded && job->occluded[i] >> k & 1) cost = 3;
            for (at = count++; at > 0 && costs[at - 1] > cost; at--) {
                costs[at] = costs[at - 1];
                order[at] = order[at - 1];
            }
            costs[at] = cost;
            order[at] = k;
        }
        m->use[i] = 0;
        for (int n = 0; n < count && n < m->ranks; n++) m->use[i] |= 1u << order[n];
    }
}

enum status match_select(struct matcher *m, const struct plane *planes, const unsigned *occluded, struct err *err)
{
    if (m->neighbour_count <= m->ranks) return ST_OK;
    unsigned *use = malloc(((size_t)m->segments->count + 1) * sizeof *use);
    if (!use) return err_nomem(err, "neighbours of segments", (size_t)m->segments->count * sizeof *use);
    m->use = use;
    struct selection job = {m, planes, occluded};
    parallel_for((size_t)m->segments->count, 64, select_neighbours, &job);
    return ST_OK;
}

struct calibration {
    struct matcher *m;
    double min_inverse_z, max_inverse_z;
    int depths, least;  /* depths that are tried, and at how many of them a neighbour must see a segment */
    float *best, *mean; /* raw costs over depths, of each segment in each neighbour, or NOT_VISIBLE */
};
#define NOT_VISIBLE 2.0f
/* One of so many segments is measured in all neighbours, the others in the first that see them. */
#define ALL_NEIGHBOURS 8

static void calibrate_segments(void *ctx, size_t begin, size_t end, int thread)
{
    const struct calibration *job = ctx;
    const struct matcher *m = job->m;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        int visible = 0;
        for (int k = 0; k < m->neighbour_count; k++) {
            const int pixels = rough_pixels(m->segments->segments[i].pixels);
            const size_t at = i * MAX_NEIGHBOURS + (size_t)k;
            double best = 1, sum = 0;
            int count = 0;
            job->best[at] = job->mean[at] = NOT_VISIBLE;
            if (visible >= m->ranks && i % ALL_NEIGHBOURS) continue;
            for (int d = 0; d < job->depths; d++) {
                const struct plane plane = {
                    0, 0, job->min_inverse_z + (job->max_inverse_z - job->min_inverse_z) * d / (job->depths - 1)};
                int seen;
                const double cost =
                    (double)neighbour_cost(m, &m->neighbours[k], m->first[i], m->first[i] + pixels, plane, &seen);
                if (2 * seen < pixels) continue;
                best = fmin(best, cost);
                sum += cost;
                count++;
            }
            if (count < job->least) continue;
            visible++;
            job->best[at] = (float)best;
            job->mean[at] = (float)(sum / count);
        }
    }
}

/* Means over segments [begin, end) and the neighbours in the bit set `use`. False if none of the segments is visible in
 * them. */
static bool mean_costs(const struct calibration *job, int begin, int end, unsigned use, double *good, double *chance)
{
    int count = 0;
    *good = *chance = 0;
    for (int i = begin; i < end; i++)
        for (int k = 0; k < job->m->neighbour_count; k++) {
            const size_t at = (size_t)i * MAX_NEIGHBOURS + (size_t)k;
            if (!(use >> k & 1) || !(job->best[at] < NOT_VISIBLE)) continue;
            *good += (double)job->best[at];
            *chance += (double)job->mean[at];
            count++;
        }
    if (!count) return false;
    *good /= count;
    *chance /= count;
    return true;
}

/* Whether a tenth of the segments is visible in some neighbour. */
static bool enough_visible(const struct calibration *job)
{
    int visible = 0;
    for (int i = 0; i < job->m->segments->count; i++)
        for (int k = 0; k < job->m->neighbour_count; k++)
            if (job->best[(size_t)i * MAX_NEIGHBOURS + (size_t)k] < NOT_VISIBLE) {
                visible++;
                break;
            }
    return 10 * visible >= job->m->segments->count;
}

enum status match_calibrate(struct matcher *m, double min_inverse_z, double max_inverse_z, struct err *err)
{
    const int count = m->segments->count;
    const size_t costs = (size_t)count * MAX_NEIGHBOURS + 1;
    struct calibration job = {.m = m,
                              .min_inverse_z = min_inverse_z,
                              .max_inverse_z = max_inverse_z,
                              .depths = 48,
                              .least = 24,
                              .best = malloc(costs * sizeof(float)),
                              .mean = malloc(costs * sizeof(float))};
    double good, chance, contrast[MAX_NEIGHBOURS] = {0}, max_contrast = 0;
    m->out_of_view_cost = malloc(((size_t)count + 1) * sizeof *m->out_of_view_cost);
    m->occluded_cost = malloc(((size_t)count + 1) * sizeof *m->occluded_cost);
    enum status st = job.best && job.mean && m->out_of_view_cost && m->occluded_cost
                         ? ST_OK
                         : err_nomem(err, "costs of segments", costs * 2 * sizeof(float));
    if (!st) parallel_for((size_t)count, 32, calibrate_segments, &job);
    if (!st && !enough_visible(&job)) { /* a strip of picture: most depths take it out of the neighbours' frames */
        job.depths = 192;
        job.least = 16;
        parallel_for((size_t)count, 32, calibrate_segments, &job);
    }
    for (int k = 0; !st && k < m->neighbour_count; k++) {
        if (mean_costs(&job, 0, count, 1u << k, &good, &chance)) contrast[k] = chance - good;
        max_contrast = fmax(max_contrast, contrast[k]);
    }
    m->excluded = 0;
    for (int k = 0; k < m->neighbour_count; k++)
        if (contrast[k] < MIN_RELATIVE_CONTRAST * max_contrast) m->excluded |= 1u << k;
    if (!st && mean_costs(&job, 0, count, ~m->excluded, &good, &chance)) {
        m->good_cost = (float)good;
        m->chance_cost = (float)fmax(chance, good + MIN_CONTRAST);
    }
    for (int i = 0; !st && i < count; i++) {
        m->out_of_view_cost[i] = OUT_OF_VIEW_COST;
        m->occluded_cost[i] = OCCLUDED_COST;
        if (!mean_costs(&job, i, i + 1, ~m->excluded, &good, &chance)) continue;
        const float best = ((float)good - m->good_cost) / (m->chance_cost - m->good_cost);
        const float spread = (float)(chance - good) / (m->chance_cost - m->good_cost);
        m->out_of_view_cost[i] = fminf(OUT_OF_VIEW_COST, best + OUT_OF_VIEW_COST * spread);
        m->occluded_cost[i] = fminf(OCCLUDED_COST, best + OCCLUDED_COST * spread);
    }
    free(job.best);
    free(job.mean);
    return st;
}

double match_shift(const struct matcher *m, double min_inverse_z, double max_inverse_z)
{
    enum { GRID = 7, STEPS = 8 };
    double largest = 0;
    for (int k = 0; k < m->neighbour_count; k++) {
        double paths[GRID * GRID];
        int count = 0;
        for (int g = 0; g < GRID * GRID; g++) {
            double u = (g % GRID + 0.5) / GRID * m->segments->width,
                   v = (double)(g / GRID + 0.5) / GRID * m->segments->height;
            double path = 0, pu = 0, pv = 0, nu, nv;
            bool had = false;
            for (int i = 0; i <= STEPS; i++) {
                bool has = match_project(&m->neighbours[k], u, v,
                                         min_inverse_z + (max_inverse_z - min_inverse_z) * i / STEPS, &nu, &nv);
                /* only inside the neighbour's frame: outside shifts grow without bound */
                has = has && nu >= 0 && nv >= 0 && nu <= m->neighbours[k].width && nv <= m->neighbours[k].height;
                if (had && has) path += hypot(nu - pu, nv - pv);
                had = has;
                pu = nu;
                pv = nv;
            }
            if (path > 0) paths[count++] = path;
        }
        if (!count) continue;
        sort_doubles(paths, (size_t)count);
        largest = fmax(largest, paths[count * 3 / 4]);
    }
    return largest;
}

#define MAX_PREFETCH 64 /* px: prefetching a larger segment would evict its own pixels from the cache */

void match_prefetch(const struct matcher *m, int segment, struct plane plane)
{
    const struct segment *g = &m->segments->segments[segment];
    const double d = plane_at(plane, g->cx, g->cy);
    const unsigned use = match_neighbours_of(m, segment);
    if (g->x1 - g->x0 > MAX_PREFETCH || g->y1 - g->y0 > MAX_PREFETCH) return;
    for (int k = 0; k < m->neighbour_count; k++) {
        const struct match_neighbour *n = &m->neighbours[k];
        double p[3];
        if (!(use >> k & 1)) continue;
        for (int i = 0; i < 3; i++)
            p[i] = n->base[i][0] * g->cx + n->base[i][1] * g->cy + n->base[i][2] + n->shift[i] * d;
        if (!(p[2] > 1e-9)) continue;
        const float u = (float)(p[0] / p[2]), v = (float)(p[1] / p[2]);
        if (!(u >= 0 && v >= 0 && u < (float)n->width && v < (float)n->height)) continue;
        const int half_h = (g->y1 - g->y0) / 2 + 1, half_w = (g->x1 - g->x0) / 2 + 1;
        const int y0 = clamp_int((int)v - half_h, 0, n->height - 1), y1 = clamp_int((int)v + half_h, 0, n->height - 1);
        const int x0 = clamp_int((int)u - half_w, 0, n->width - 1),
                  x1 = clamp_int((int)u + half_w + 1, 0, n->width - 1);
        for (int y = y0; y <= y1; y++) {
            const uint8_t *row = n->texture + ((size_t)y * (size_t)(n->width + 1)) * 2 * FEATURE_CHANNELS;
            for (int x = x0; x <= x1 + 3; x += 4)
                _mm_prefetch((const char *)(row + (size_t)x * 2 * FEATURE_CHANNELS), _MM_HINT_T0);
        }
    }
}
