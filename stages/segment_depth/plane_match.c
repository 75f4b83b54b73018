/* plane_match.c - the matching cost of a segment on a plane. Most of the stage's time is spent in neighbour_cost().
 *
 * A plane 1/z = a u + b v + c maps the segment to a neighbour by the homography H = base + shift (a b c). A pixel's
 * cost in a neighbour is the sum of weighted truncated differences
 *   sum over channels k of weight_k min(limit_k, |feature_k(pixel) - feature_k(H pixel)|)
 * of colours and gradients, as in [Bleyer 2011]; the segment's is the weighted mean over the pixels that the neighbour
 * sees. Costs are normalized so that 0 is a good match of this view and 1 a chance one (match_calibrate()), and
 * clamped to [MATCH_BEST, MATCH_WORST]. The neighbours' costs are sorted and averaged with weights that fall by
 * RANK_WEIGHT (match_rank(), match_evidence()): the segment may be occluded in the worse ones. Only the best
 * `best_neighbours` count, and after match_select() a segment is compared with no others.
 *
 * A texture element has 2 x FEATURE_CHANNELS bytes, those of a pixel and of the pixel below. 32 bytes from one address
 * hold the four corners of a bilinear sample: i16x16_weigh_u8() weighs them in vertical pairs, and the two columns
 * are added. Sums are integers; the weight of the validity channel lifts an invalid pixel over every other cost. */
#include "stages/segment_depth/plane_match.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "common/math/lanes.h"
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

/* The two columns of a bilinear sample, left and right in the halves, each summed over the vertical pairs. at: offset
 * of the upper left corner, in halves of a texture element; corners: their weights, which sum to FEATURE_UNIT, the left
 * column's in the lower bytes. */
static inline i16x16 weighted_columns(const uint8_t *texture, int at, int corners)
{
    const i16x16 pairs = (i16x16)i32x8_all(corners);
    const i16x16 weights = __builtin_shufflevector(pairs, pairs, 0, 0, 0, 0, 0, 0, 0, 0, 9, 9, 9, 9, 9, 9, 9, 9);
    return i16x16_weigh_u8(u8x32_load(texture + (size_t)(unsigned)at * FEATURE_CHANNELS), (u8x32)weights);
}

#define TWICE(...)               \
    {                            \
        __VA_ARGS__, __VA_ARGS__ \
    }

/* Weighted truncated differences of two pixels, one in each half, summed over pairs of channels. */
static inline i32x8 pair_differences(const uint8_t *texture, const int *at, const int *corners,
                                     const int16_t *reference)
{
    const i16x16 limit = TWICE(FEATURE_UNIT * COLOUR_LIMIT, FEATURE_UNIT * COLOUR_LIMIT, FEATURE_UNIT * COLOUR_LIMIT,
                               FEATURE_UNIT * FINE_LIMIT, FEATURE_UNIT * FINE_LIMIT, FEATURE_UNIT * COARSE_LIMIT,
                               FEATURE_UNIT * COARSE_LIMIT, 32767);
    const i16x16 weight = TWICE(COLOUR_WEIGHT, COLOUR_WEIGHT, COLOUR_WEIGHT, FINE_WEIGHT, FINE_WEIGHT, COARSE_WEIGHT,
                                COARSE_WEIGHT, VALID_WEIGHT);
    const i16x16 p = weighted_columns(texture, at[0], corners[0]), q = weighted_columns(texture, at[1], corners[1]);
    const i16x16 sample = i16x16_lows(p, q) + i16x16_highs(p, q);
    /* saturating: the padding's validity is far below any sample's */
    const i16x16 difference = i16x16_abs(i16x16_subtract(sample, i16x16_load(reference)));
    return i32x8_weigh_i16(i16x16_min(difference, limit), weight);
}

/* A plane's homography into a neighbour, and the neighbour's size, in vectors. */
struct warp8 {
    f32x8 h[3][3];
    f32x8 right, bottom, max_u, max_v;
    int stride;
    const uint8_t *texture;
};

static inline struct warp8 warp_make(const struct match_neighbour *n, struct plane plane)
{
    const double slope[3] = {plane.a, plane.b, plane.c};
    struct warp8 w = {.right = f32x8_all((float)(n->width - 1)),
                      .bottom = f32x8_all((float)(n->height - 1)),
                      .stride = n->width + 1,
                      .texture = n->texture};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) w.h[i][j] = f32x8_all((float)(n->base[i][j] + n->shift[i] * slope[j]));
    w.max_u = w.right + 0.5f;
    w.max_v = w.bottom + 0.5f;
    return w;
}

/* Costs of eight pixels, times WORST, and the mask of those that the neighbour sees; lanes in the order of pixels
 * 0 2 4 6 | 1 3 5 7. False: it sees none. reference: the pixels' features. */
static inline __attribute__((always_inline)) bool costs8(const struct warp8 *w, f32x8 x, f32x8 y,
                                                         const int16_t *reference, i32x8 *cost, i32x8 *mask)
{
    const f32x8 zero = {0};
    f32x8 p[3];
    for (int k = 0; k < 3; k++) p[k] = w->h[k][0] * x + w->h[k][1] * y + w->h[k][2];
    f32x8 inverse = 1 / p[2];
    f32x8 u = p[0] * inverse - 0.5f;
    f32x8 v = p[1] * inverse - 0.5f;
    i32x8 visible = (p[2] > 1e-9f) & (u >= -0.5f) & (u <= w->max_u) & (v >= -0.5f) & (v <= w->max_v);
    if (!i32x8_any(visible)) return false;
    u = f32x8_min(f32x8_max(u, zero), w->right); /* NaN becomes 0: max returns its second operand */
    v = f32x8_min(f32x8_max(v, zero), w->bottom);
    i32x8 column = i32x8_truncate(u), row = i32x8_truncate(v);
    const f32x8 fv = v - f32x8_from_i32(row);
    const f32x8 fu = (u - f32x8_from_i32(column)) * FEATURE_UNIT;
    /* rounded so that the corners' weights sum to FEATURE_UNIT; the upper left one may be -1 */
    const i32x8 lower_right = i32x8_round(fu * fv);
    const i32x8 upper_right = i32x8_round(fu) - lower_right;
    const i32x8 lower_left = i32x8_round(fv * FEATURE_UNIT) - lower_right;
    const i32x8 upper_left = FEATURE_UNIT - (lower_right + upper_right + lower_left);
    _Alignas(32) int at[8], corners[8];
    i32x8_store(at, i32x8_index(row, w->stride, column) << 1);
    i32x8_store(corners, (upper_left & 255) | (lower_left << 8) | (upper_right << 16) | (lower_right << 24));
    __asm__(""
            : "+m"(at), "+m"(corners)); /* keeps them in memory: loading them one by one is faster than extracting
                                           lanes */
    i32x8 q[4];
    for (int k = 0; k < 4; k++)
        q[k] = pair_differences(w->texture, at + 2 * k, corners + 2 * k,
                                reference + (ptrdiff_t)(2 * k) * FEATURE_CHANNELS);
    /* the order of lanes does not matter to integer sums, but it does to mask and weight */
    *cost = i32x8_add_pairs(i32x8_add_pairs(q[0], q[1]), i32x8_add_pairs(q[2], q[3]));
    *mask = i32x8_pick(visible, (i32x8){0, 2, 4, 6, 1, 3, 5, 7});
    *mask &= *cost < INVISIBLE_COST;
    return true;
}

/* Raw mean cost of the pixels [begin, end) in one neighbour, 0 .. 1; *seen: how many of them it sees. */
static float neighbour_cost(const struct matcher *m, const struct match_neighbour *n, int begin, int end,
                            struct plane plane, int *seen)
{
    const struct warp8 warp = warp_make(n, plane);
    i32x8 count = {0}, weight_sum = {0};
    u32x8 sum = {0};
    for (int i = begin; i < end; i += 8) {
        i32x8 cost, mask;
        if (!costs8(&warp, f32x8_load(m->x + i), f32x8_load(m->y + i), m->features + (size_t)i * FEATURE_CHANNELS,
                    &cost, &mask))
            continue;
        const i32x8 weight = i32x8_load(m->weight + i);
        sum += (u32x8)((mask & cost) >> 8) * (u32x8)weight;
        weight_sum += mask & weight;
        count -= mask;
    }
    int64_t total = 0, all = 0;
    *seen = 0;
    for (int k = 0; k < 8; k++) {
        total += sum[k];
        *seen += count[k];
        all += weight_sum[k];
    }
    return all > 0 ? (float)((double)total * 256 / ((double)WORST * (double)all))
                   : 1; /* a pixel's weight is at least 1 */
}

void match_row(const struct matcher *m, int neighbour, struct plane plane, int x, int y, int count, float *costs)
{
    const struct warp8 warp = warp_make(&m->neighbours[neighbour], plane);
    const int16_t *reference = m->raster + ((size_t)y * (size_t)m->segments->width + (size_t)x) * FEATURE_CHANNELS;
    const f32x8 lanes = {0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f};
    const f32x8 scale = f32x8_all(1 / ((float)WORST * (m->chance_cost - m->good_cost)));
    const f32x8 offset = f32x8_all(-m->good_cost / (m->chance_cost - m->good_cost));
    const i32x8 order = {0, 4, 1, 5, 2, 6, 3, 7};
    for (int i = 0; i < count; i += 8) {
        i32x8 cost, mask;
        f32x8 out = f32x8_all(MATCH_UNSEEN);
        if (costs8(&warp, (float)(x + i) + lanes, f32x8_all((float)y + 0.5f), reference + (size_t)i * FEATURE_CHANNELS,
                   &cost, &mask)) {
            const f32x8 own = f32x8_from_i32(cost) * scale + offset;
            out = f32x8_pick(f32x8_if(mask, own, out), order);
        }
        f32x8_store(costs + i, out);
    }
}

float match_rank(const struct matcher *m, const float *sorted, int count, int useful, float out_of_view)
{
    double sum = 0, total = 0, weight = 1;
    if (useful > m->params->best_neighbours) useful = m->params->best_neighbours;
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
    for (int k = 0; best && k < count && k < m->params->best_neighbours; k++) *best |= order[k];
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
    for (int k = 0; k < count && k < m->params->best_neighbours; k++, weight *= RANK_WEIGHT) {
        sum += weight * (double)costs[k];
        total += weight;
    }
    *cost = count ? (float)(sum / total) : MATCH_WORST;
    return count;
}

double match_texture(const struct matcher *m, int segment)
{
    const int pixels = m->segments->segments[segment].pixels;
    const int16_t *at = m->features + (size_t)m->first[segment] * FEATURE_CHANNELS;
    double sum = 0;
    for (int i = 0; i < pixels; i++, at += FEATURE_CHANNELS)
        sum += hypot(at[3] / (double)FEATURE_UNIT - 128, at[4] / (double)FEATURE_UNIT - 128);
    return sum / pixels;
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
        for (int n = 0; n < count && n < m->params->best_neighbours; n++) m->use[i] |= 1u << order[n];
    }
}

enum status match_select(struct matcher *m, const struct plane *planes, const unsigned *occluded, struct err *err)
{
    if (m->neighbour_count <= m->params->best_neighbours) return ST_OK;
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
            if (visible >= m->params->best_neighbours && i % ALL_NEIGHBOURS) continue;
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
    if (!job.best || !job.mean || !m->out_of_view_cost || !m->occluded_cost)
        err_nomem(err, "costs of segments", costs * 2 * sizeof(float));
    if (!err->status) parallel_for((size_t)count, 32, calibrate_segments, &job);
    if (!err->status && !enough_visible(&job)) {
        /* a strip of picture: most depths take it out of the neighbours' frames */
        job.depths = 192;
        job.least = 16;
        parallel_for((size_t)count, 32, calibrate_segments, &job);
    }
    for (int k = 0; !err->status && k < m->neighbour_count; k++) {
        if (mean_costs(&job, 0, count, 1u << k, &good, &chance)) contrast[k] = chance - good;
        max_contrast = fmax(max_contrast, contrast[k]);
    }
    m->excluded = 0;
    for (int k = 0; k < m->neighbour_count; k++)
        if (contrast[k] < MIN_RELATIVE_CONTRAST * max_contrast) m->excluded |= 1u << k;
    if (!err->status && mean_costs(&job, 0, count, ~m->excluded, &good, &chance)) {
        m->good_cost = (float)good;
        m->chance_cost = (float)fmax(chance, good + MIN_CONTRAST);
    }
    for (int i = 0; !err->status && i < count; i++) {
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
    return err->status;
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
            for (int x = x0; x <= x1 + 3; x += 4) __builtin_prefetch(row + (size_t)x * 2 * FEATURE_CHANNELS);
        }
    }
}
