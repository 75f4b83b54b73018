/* pixel_planes.c - depth finer than segments: borders move to where the pictures want them [Yamaguchi 2014].
 *
 * A segment follows the colours of the view, so a border between two depths that have one colour lies somewhere within
 * a segment, and a twig narrower than a segment shares its plane. Here each pixel chooses among the planes of its own
 * segment and of those within RINGS borders, with the energy
 *   E(l) = sum over pixels p    match(p, P_l) + cross_view(segment, P_l)
 *        + SMOOTHNESS sum over q around p    w_pq min(1, |P_l(p) - P_l(q)(p)| / (JUMP steps)) / sum of w_pq
 * match is the cost of plane_match.h over a window, in which a pixel counts by its likeness to the one in the middle
 * [Yoon 2006] and, as in a segment, less beside an edge. Windows overlap, so that a segment's costs are computed once
 * per plane and neighbour for its surroundings, row by row. The choice begins with the segments and is repeated PASSES
 * times, all pixels at once, each with the choices of the pass before around it.
 *
 * What differs from the sources: planes are not fitted again to the pixels that moved; the window's weights and the
 * neighbours' rank are those of matching segments. */
#include "stages/segment_depth/pixel_planes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/lanes.h"
#include "stages/segment_depth/match_features.h"

#define RINGS          2
#define MAX_CANDIDATES 24
#define APART          0.5  /* steps: planes that differ less all over a segment are one candidate */
#define RADIUS         3    /* px: half width of the window; a row of it fits a vector */
#define NEAR_RADIUS    2    /* px: of the pixels that a choice is smooth with */
#define NEAR           24   /* how many these are */
#define COLOUR         10.0 /* grey levels by which a weight falls to 1/e */
#define SPACE          3.0  /* px by which a window's weight falls to 1/e */
#define NEAR_SPACE     2.0  /* px: the same of smoothness */
#define SMOOTHNESS     1.0
#define JUMP           4.0 /* steps */
#define PASSES         3

enum { WINDOW = 2 * RADIUS + 1, WINDOW_FLOATS = 8 * WINDOW, GREYS = 256 };

struct choice {
    const struct segmentation *s;
    const struct plane *planes;
    const struct plane_problem *p;
    int *first_candidate; /* count + 1 */
    int *candidates;      /* segments, the own one first */
    size_t *first_cost;   /* of segment i: its candidates' costs, pixel by pixel */
    float *costs;
    const int *label; /* of the pass before */
    int *next;
    float by_colour[GREYS];
    float by_place[WINDOW][8], near_by_place[NEAR]; /* by_place: columns beyond the window are 0 */
    int near_x[NEAR], near_y[NEAR];
    enum status *failed; /* of each thread */
};

/* Whether two planes differ by less than APART steps at all corners of a segment. */
static bool alike(const struct choice *c, const struct segment *g, int a, int b)
{
    for (int k = 0; k < 4; k++) {
        const double u = k & 1 ? g->x1 + 1 : g->x0, v = k & 2 ? g->y1 + 1 : g->y0;
        if (!(fabs(plane_at(c->planes[a], u, v) - plane_at(c->planes[b], u, v)) < APART * c->p->step)) return false;
    }
    return true;
}

/* Lists the segments whose planes the pixels of segment i may take; returns how many. */
static int list_candidates(const struct choice *c, int i, int list[MAX_CANDIDATES])
{
    const struct segmentation *s = c->s;
    const struct segment *g = &s->segments[i];
    int around[256], count = 0, seen = 0;
    list[count++] = around[seen++] = i;
    if (given_depth_has(c->p->given, i)) return count;
    for (int ring = 0, begin = 0, end = 1; ring < RINGS; ring++, begin = end, end = seen)
        for (int k = begin; k < end; k++)
            for (int t = s->first_border[around[k]]; t < s->first_border[around[k] + 1]; t++) {
                const int other = s->borders[t].other;
                bool known = seen == (int)(sizeof around / sizeof *around) || count == MAX_CANDIDATES;
                for (int n = 0; n < seen && !known; n++) known = around[n] == other;
                if (known) continue;
                around[seen++] = other;
                for (int n = 0; n < count && !known; n++) known = alike(c, g, list[n], other);
                if (!known && problem_allows(c->p, g, c->planes[other])) list[count++] = other;
            }
    return count;
}

static inline float colour_weight(const struct choice *c, const int16_t *a, const int16_t *b)
{
    const int red = abs(a[0] - b[0]), green = abs(a[1] - b[1]), blue = abs(a[2] - b[2]);
    const int most = red > green ? (red > blue ? red : blue) : green > blue ? green : blue;
    return c->by_colour[most / FEATURE_UNIT];
}

static const int16_t *features_of(const struct choice *c, size_t pixel)
{
    return c->p->m->raster + pixel * FEATURE_CHANNELS;
}

/* The weights of the window around a pixel, eight columns a row; returns their sum. */
static float window_weights(const struct choice *c, int pixel, float weights[WINDOW_FLOATS])
{
    const struct segmentation *s = c->s;
    const int px = pixel % s->width, py = pixel / s->width;
    const int16_t *own = features_of(c, (size_t)pixel);
    float sum = 0;
    memset(weights, 0, WINDOW_FLOATS * sizeof *weights);
    for (int j = 0; j < WINDOW; j++)
        for (int i = 0; i < WINDOW; i++) {
            const int x = px + i - RADIUS, y = py + j - RADIUS;
            if (x < 0 || y < 0 || x >= s->width || y >= s->height) continue;
            const size_t at = (size_t)y * (size_t)s->width + (size_t)x;
            weights[8 * j + i] =
                c->by_place[j][i] * (float)c->p->m->edge[at] * colour_weight(c, own, features_of(c, at));
            sum += weights[8 * j + i];
        }
    return sum;
}

/* Mean of a window's costs; false if less than half of its weight is seen. costs: of its upper left pixel. */
static inline bool window_mean(float *mean, const float *costs, size_t stride, const float *weights, float all)
{
    const f32x8 unseen = f32x8_all(MATCH_UNSEEN);
    f32x8 sum = {0}, total = sum;
    for (int j = 0; j < WINDOW; j++) {
        const f32x8 cost = f32x8_load(costs + (size_t)j * stride);
        const f32x8 weight = f32x8_where(cost < unseen, f32x8_load(weights + 8 * (size_t)j));
        sum += weight * cost;
        total += weight;
    }
    const float seen = f32x8_sum(total);
    if (!(2 * seen > all)) return false;
    *mean = fminf(fmaxf(f32x8_sum(sum) / seen, MATCH_BEST), MATCH_WORST);
    return true;
}

/* The surroundings of a segment: its bounding box and RADIUS more, and the rows of costs in one neighbour after the
 * other. */
struct surroundings {
    int x0, y0, width, height;
    size_t stride;
    float *costs;
    float *weights; /* of the windows, pixel by pixel */
    float *sums;
    size_t cost_room, weight_room;
};

static bool reserve_surroundings(struct surroundings *r, const struct segment *g, int neighbours)
{
    r->x0 = g->x0 - RADIUS;
    r->y0 = g->y0 - RADIUS;
    r->width = g->x1 - g->x0 + WINDOW;
    r->height = g->y1 - g->y0 + WINDOW;
    r->stride = ((size_t)r->width + 23) & ~(size_t)7; /* rows are written and read in eights */
    const size_t costs = r->stride * (size_t)r->height * (size_t)neighbours + 8, weights = (size_t)g->pixels;
    if (costs > r->cost_room) {
        free(r->costs);
        r->costs = malloc(costs * sizeof *r->costs);
        r->cost_room = r->costs ? costs : 0;
    }
    if (weights > r->weight_room) {
        free(r->weights);
        free(r->sums);
        r->weights = aligned_alloc(32, weights * WINDOW_FLOATS * sizeof *r->weights);
        r->sums = malloc(weights * sizeof *r->sums);
        r->weight_room = r->weights && r->sums ? weights : 0;
    }
    return r->cost_room >= costs && r->weight_room >= weights;
}

static float *costs_in(const struct surroundings *r, int neighbour)
{
    return r->costs + (size_t)neighbour * r->stride * (size_t)r->height;
}

/* The costs of the surroundings on a plane in the n-th neighbour that is used. */
static void match_surroundings(const struct choice *c, const struct surroundings *r, int n, int neighbour,
                               struct plane plane)
{
    const struct segmentation *s = c->s;
    const int left = r->x0 > 0 ? r->x0 : 0, right = r->x0 + r->width < s->width ? r->x0 + r->width : s->width;
    for (int y = r->y0 > 0 ? r->y0 : 0; y < r->y0 + r->height && y < s->height; y++)
        match_row(c->p->m, neighbour, plane, left, y, right - left,
                  costs_in(r, n) + (size_t)(y - r->y0) * r->stride + (left - r->x0));
}

/* The costs of segment i's pixels on one candidate's plane. */
static void candidate_costs(const struct choice *c, const struct surroundings *r, int i, struct plane plane,
                            float *costs)
{
    const struct matcher *m = c->p->m;
    const struct segment *g = &c->s->segments[i];
    const unsigned use = match_neighbours_of(m, i);
    unsigned occluded = 0;
    const float cross =
        c->p->cross ? (float)c->p->params->cross_view * cross_view_cost(c->p->cross, i, plane, &occluded) : 0;
    int neighbours[MAX_NEIGHBOURS], count = 0;
    for (int k = 0; k < m->neighbour_count; k++) {
        if (!(use >> k & 1)) continue;
        if (!(occluded >> k & 1)) match_surroundings(c, r, count, k, plane);
        neighbours[count++] = k;
    }
    for (int q = 0; q < g->pixels; q++) {
        const int pixel = c->s->pixel[g->first + q];
        const size_t corner =
            (size_t)(pixel / c->s->width - RADIUS - r->y0) * r->stride + (size_t)(pixel % c->s->width - RADIUS - r->x0);
        float sorted[MAX_NEIGHBOURS], cost;
        int seen = 0;
        for (int k = 0; k < count; k++) {
            cost = m->occluded_cost[i];
            if (!(occluded >> neighbours[k] & 1) && !window_mean(&cost, costs_in(r, k) + corner, r->stride,
                                                                 r->weights + (size_t)q * WINDOW_FLOATS, r->sums[q]))
                continue;
            int at = seen++;
            for (; at > 0 && sorted[at - 1] > cost; at--) sorted[at] = sorted[at - 1];
            sorted[at] = cost;
        }
        costs[q] = cross + match_rank(m, sorted, seen, count, m->out_of_view_cost[i]);
    }
}

static void segment_costs(void *ctx, size_t begin, size_t end, int thread)
{
    const struct choice *c = ctx;
    struct surroundings r = {0};
    for (size_t i = begin; i < end; i++) {
        const struct segment *g = &c->s->segments[i];
        const int *candidates = c->candidates + c->first_candidate[i];
        const int count = c->first_candidate[i + 1] - c->first_candidate[i];
        if (count < 2) continue;
        if (!reserve_surroundings(&r, g, c->p->m->neighbour_count)) {
            c->failed[thread] = ST_NOMEM;
            break;
        }
        /* what lies outside of the picture has weight 0, but must be a number */
        memset(r.costs, 0, r.cost_room * sizeof *r.costs);
        for (int q = 0; q < g->pixels; q++)
            r.sums[q] = window_weights(c, c->s->pixel[g->first + q], r.weights + (size_t)q * WINDOW_FLOATS);
        for (int k = 0; k < count; k++)
            candidate_costs(c, &r, (int)i, c->planes[candidates[k]],
                            c->costs + c->first_cost[i] + (size_t)k * (size_t)g->pixels);
    }
    free(r.costs);
    free(r.weights);
    free(r.sums);
}

/* The pixels around one: their weights, and the inverse depth there on the planes that they lie on, in jumps above
 * `from`. */
struct nearby {
    _Alignas(32) float weight[NEAR], jumps[NEAR];
    float sum;
};

static void look_around(struct nearby *n, const struct choice *c, int px, int py, double from)
{
    const struct segmentation *s = c->s;
    const size_t pixel = (size_t)py * (size_t)s->width + (size_t)px;
    const double scale = 1 / (JUMP * c->p->step);
    n->sum = 1e-9f;
    for (int k = 0; k < NEAR; k++) {
        const int x = px + c->near_x[k], y = py + c->near_y[k];
        const size_t at = (size_t)y * (size_t)s->width + (size_t)x;
        n->weight[k] = n->jumps[k] = 0;
        if (x < 0 || y < 0 || x >= s->width || y >= s->height || c->label[at] < 0) continue;
        n->weight[k] = c->near_by_place[k] * colour_weight(c, features_of(c, pixel), features_of(c, at));
        n->jumps[k] = (float)(scale * (plane_at(c->planes[c->label[at]], px + 0.5, py + 0.5) - from));
        n->sum += n->weight[k];
    }
}

/* Mean difference in depth from the pixels around, 0 .. 1. */
static float roughness(const struct nearby *n, float jumps)
{
    const f32x8 own = f32x8_all(jumps), one = f32x8_all(1);
    f32x8 sum = {0};
    for (int k = 0; k < NEAR; k += 8) {
        const f32x8 apart = f32x8_abs(f32x8_load(n->jumps + k) - own);
        sum += f32x8_load(n->weight + k) * f32x8_min(one, apart);
    }
    return f32x8_sum(sum) / n->sum;
}

static int choose_pixel(const struct choice *c, int i, int q)
{
    const struct segment *g = &c->s->segments[i];
    const int pixel = c->s->pixel[g->first + q], px = pixel % c->s->width, py = pixel / c->s->width;
    const int *candidates = c->candidates + c->first_candidate[i];
    const int count = c->first_candidate[i + 1] - c->first_candidate[i];
    const double from = plane_at(c->planes[i], px + 0.5, py + 0.5), scale = 1 / (JUMP * c->p->step);
    struct nearby near;
    float lowest = INFINITY;
    int best = i;
    look_around(&near, c, px, py, from);
    for (int k = 0; k < count; k++) {
        const double inverse = plane_at(c->planes[candidates[k]], px + 0.5, py + 0.5);
        const float cost = c->costs[c->first_cost[i] + (size_t)k * (size_t)g->pixels + (size_t)q] +
                           (float)SMOOTHNESS * roughness(&near, (float)(scale * (inverse - from)));
        if (!(cost < lowest)) continue;
        lowest = cost;
        best = candidates[k];
    }
    return best;
}

static void choose_pixels(void *ctx, size_t begin, size_t end, int thread)
{
    const struct choice *c = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct segment *g = &c->s->segments[i];
        const bool alone = c->first_candidate[i + 1] - c->first_candidate[i] < 2;
        for (int q = 0; q < g->pixels; q++)
            c->next[c->s->pixel[g->first + q]] = alone ? (int)i : choose_pixel(c, (int)i, q);
    }
}

static void make_tables(struct choice *c)
{
    int count = 0;
    for (int k = 0; k < GREYS; k++) c->by_colour[k] = expf((float)(-k / COLOUR));
    for (int j = 0; j < WINDOW; j++)
        for (int i = 0; i < 8; i++)
            c->by_place[j][i] = i < WINDOW ? expf((float)(-hypot(i - RADIUS, j - RADIUS) / SPACE)) : 0;
    for (int j = -NEAR_RADIUS; j <= NEAR_RADIUS; j++)
        for (int i = -NEAR_RADIUS; i <= NEAR_RADIUS; i++) {
            if (!i && !j) continue;
            c->near_x[count] = i;
            c->near_y[count] = j;
            c->near_by_place[count++] = expf((float)(-hypot(i, j) / NEAR_SPACE));
        }
}

static enum status list_all(struct choice *c, struct err *err)
{
    const int count = c->s->count;
    const size_t most = (size_t)count * MAX_CANDIDATES + 1;
    c->first_candidate = malloc(((size_t)count + 1) * sizeof *c->first_candidate);
    c->first_cost = malloc(((size_t)count + 1) * sizeof *c->first_cost);
    c->candidates = malloc(most * sizeof *c->candidates);
    if (!c->first_candidate || !c->first_cost || !c->candidates)
        return err_nomem(err, "the planes around segments", most * sizeof *c->candidates);
    int listed = 0;
    size_t costs = 0;
    for (int i = 0; i < count; i++) {
        const int own = list_candidates(c, i, c->candidates + listed);
        c->first_candidate[i] = listed;
        c->first_cost[i] = costs;
        listed += own;
        if (own > 1) costs += (size_t)own * (size_t)c->s->segments[i].pixels;
    }
    c->first_candidate[count] = listed;
    c->costs = malloc((costs + 1) * sizeof *c->costs);
    return c->costs ? ST_OK : err_nomem(err, "the costs of pixels", costs * sizeof *c->costs);
}

enum status pixel_planes_choose(int *label, const struct plane *planes, const struct plane_problem *p, struct err *err)
{
    const struct segmentation *s = p->m->segments;
    const size_t size = (size_t)s->width * (size_t)s->height * sizeof *label;
    const int threads = parallel_threads();
    struct choice c = {.s = s, .planes = planes, .p = p, .failed = calloc((size_t)threads, sizeof *c.failed)};
    int *other = malloc(size);
    if (!c.failed || !other) err_nomem(err, "the segments of pixels", size);
    if (!err->status && !list_all(&c, err)) {
        make_tables(&c);
        parallel_for((size_t)s->count, 32, segment_costs, &c);
    }
    for (int t = 0; !err->status && t < threads; t++)
        if (c.failed[t]) err_nomem(err, "the surroundings of a segment", size);
    if (!err->status) {
        memcpy(label, s->label, size); /* pixels that the view does not have stay -1 */
        memcpy(other, s->label, size);
    }
    for (int pass = 0; !err->status && pass < PASSES; pass++) {
        c.label = pass % 2 ? other : label;
        c.next = pass % 2 ? label : other;
        parallel_for((size_t)s->count, 32, choose_pixels, &c);
    }
    if (!err->status && PASSES % 2) memcpy(label, other, size);
    free(c.first_candidate);
    free(c.first_cost);
    free(c.candidates);
    free(c.costs);
    free(c.failed);
    free(other);
    return err->status;
}
