/* penumbra_fit.c - see penumbra_fit.h.
 *
 * Across an edge's point, t runs along the normal, towards the lit side. Both profiles are means of a few pixels
 * along the edge on the same face. The photograph's should be
 *   log L(t) = c + m t + s e(t'), t' = t - d + (a - 1) clamp(t - d, -w, w)
 * with the shift d, the penumbra a times as steep, w half its width, and free c, m and strength s, 0.5 to 1.5. All
 * pairs (d, a) are tried. Texture hides a single profile, so a pair's cost is a sum over the edge's points: of the
 * logarithm of the rest's mean square, which a bright joint in one profile cannot rule. Near points weigh most, but
 * some weight reaches far, since boards and print run along an edge for a while.
 *
 * Evidence. What moves a quotient must be sure, for a wrong move draws an outline where none was. A fit is multiplied
 * by x^4 / (1 + x^4) for how far the move lowers the mean logarithm (x = 1 at 0.5), and for how far the edge itself
 * does; and by 1 / (1 + r^4), r the difference of the shifts that both halves of the edge find by themselves, over what
 * is moved. A shift at the end of the range does not count. Large moves cost a little, so that of pairs that fit alike
 * the nearest is taken. */
#include "stages/relight/penumbra_fit.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

enum {
    STEPS = 2,      /* shifts a pixel */
    WIDTHS = 7,     /* widths that are tried */
    MAX_SHIFT = 16, /* px, most that the parameter allows */
    BESIDE = 4,     /* px along the edge on either side whose mean is a profile */
    MARGIN = 4,     /* px of a profile beyond penumbra and shift */
    FINE = 2,       /* samples a pixel of the profile of e */
    MAX_REACH = PENUMBRA_MOST_HALF + MAX_SHIFT + MARGIN,
    MAX_FINE = 2 * FINE * (MAX_REACH + PENUMBRA_MOST_HALF + MAX_SHIFT) + 1,
    MAX_COSTS = (2 * STEPS * MAX_SHIFT + 1) * WIDTHS
};
static const double STEEPER[WIDTHS] = {0.5, 0.62996052, 0.79370053, 1, 1.25992105, 1.58740105, 2};
static const double NEAR = 16, FAR = 64; /* px: standard deviations of weights along an edge */
static const double FAR_SHARE = 0.25;    /* of the weight of the near ones */
static const double BEND = 0.1;        /* how far points of one edge may lie off a line, as a part of their distance */
static const double SAME_NORMAL = 0.9; /* least cosine of normals of one edge */
static const double NOISE = 0.01;      /* of log radiance: a smaller misfit counts as this */
static const double EXPLAINED = 0.5;   /* fall of the log mean square by the edge of which half is believed */
static const double STAY = 0.05;       /* cost of the largest shift, and of half or twice the width */
static const double GAIN = 0.5;        /* the same by the move */
static const double STRENGTH[2] = {0.5, 1.5};

struct fit {
    struct old_edges *edges;
    int most, shifts; /* px; shifts that are tried */
    struct edge_point *fitted;
    float *costs;       /* shifts * WIDTHS of each point */
    float *unexplained; /* the cost without the edge */
};

/* -------------------------------------------------------------------------------------------------------- profiles */

struct profile {
    int reach, fine_reach; /* px; samples of e */
    double photo[2 * MAX_REACH + 1], weight[2 * MAX_REACH + 1];
    double e[MAX_FINE];
};

/* The mean along the edge at a distance from it; false: less than half of the places are of the surface. */
static bool mean_at(double *value, const struct fit *s, const float *field, const struct edge_point *p, double t,
                    int beside)
{
    const double x = p->x + t * p->nx, y = p->y + t * p->ny;
    double sum = 0, one;
    int count = 0;
    for (int k = -beside; k <= beside; k++) {
        if (!penumbra_edges_sample(&one, s->edges, field, s->edges->surface[p->pixel], x - k * p->ny, y + k * p->nx))
            continue;
        sum += one;
        count++;
    }
    *value = count ? sum / count : 0;
    return 2 * count > 2 * beside + 1;
}

/* Where e has no value it goes on as it is last. */
static void read_e(struct profile *f, const struct fit *s, const struct edge_point *p)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        double last = (double)s->edges->e[p->pixel];
        bool is_over = false;
        for (int k = 0; k <= f->fine_reach; k++) {
            double value;
            is_over = is_over || !mean_at(&value, s, s->edges->e, p, sign * k / (double)FINE, BESIDE);
            if (!is_over) last = value;
            f->e[f->fine_reach + sign * k] = last;
        }
    }
}

static bool read_profile(struct profile *f, const struct fit *s, const struct edge_point *p)
{
    double weights = 0, all = 0;
    f->reach = (int)ceil(p->half) + s->most + MARGIN;
    f->fine_reach = FINE * (f->reach + s->most + (int)ceil(p->half));
    for (int t = -f->reach; t <= f->reach; t++) {
        const int k = t + f->reach;
        const double window = 0.5 + 0.5 * cos(PI * t / (f->reach + 1.0));
        f->weight[k] = mean_at(&f->photo[k], s, s->edges->photo, p, t, BESIDE) ? window : 0;
        weights += f->weight[k];
        all += window;
    }
    if (weights < 0.6 * all) return false;
    read_e(f, s, p);
    return true;
}

static double e_at(const struct profile *f, double t)
{
    const double at = clamp(t * FINE + f->fine_reach, 0, 2 * f->fine_reach - 1e-6);
    const int k = (int)at;
    return f->e[k] + (at - k) * (f->e[k + 1] - f->e[k]);
}

double penumbra_fit_moved(const struct edge_point *p, double t, double shift, double steeper)
{
    return t - shift + (steeper - 1) * clamp(t - shift, -p->half, p->half);
}

/* Removes the mean and the slope of values. */
static void detrend(double *values, const struct profile *f)
{
    double w = 0, t1 = 0, t2 = 0, v1 = 0, vt = 0;
    for (int t = -f->reach; t <= f->reach; t++) {
        const int k = t + f->reach;
        w += f->weight[k], t1 += f->weight[k] * t, t2 += f->weight[k] * t * t;
        v1 += f->weight[k] * values[k], vt += f->weight[k] * values[k] * t;
    }
    const double determinant = w * t2 - t1 * t1;
    if (!(determinant > 0)) return;
    const double m = (w * vt - t1 * v1) / determinant, c = (v1 - m * t1) / w;
    for (int t = -f->reach; t <= f->reach; t++) values[t + f->reach] -= c + m * t;
}

static double product(const double *a, const double *b, const struct profile *f)
{
    double sum = 0;
    for (int k = 0; k <= 2 * f->reach; k++) sum += f->weight[k] * a[k] * b[k];
    return sum;
}

static void find_costs(float *costs, float *unexplained, struct profile *f, const struct fit *s,
                       const struct edge_point *p)
{
    double e[2 * MAX_REACH + 1] = {0}, weights = 0;
    for (int k = 0; k <= 2 * f->reach; k++) weights += f->weight[k];
    detrend(f->photo, f);
    const double all = product(f->photo, f->photo, f);
    *unexplained = (float)log(all / weights + NOISE * NOISE);
    for (int d = 0; d < s->shifts; d++)
        for (int a = 0; a < WIDTHS; a++) {
            const double shift = (double)d / STEPS - s->most;
            for (int t = -f->reach; t <= f->reach; t++)
                e[t + f->reach] = e_at(f, penumbra_fit_moved(p, t, shift, STEEPER[a]));
            detrend(e, f);
            const double both = product(f->photo, e, f), own = product(e, e, f);
            const double strength = own > 0 ? clamp(both / own, STRENGTH[0], STRENGTH[1]) : 0;
            const double rest = fmax(0, all - 2 * strength * both + strength * strength * own);
            costs[d * WIDTHS + a] = (float)log(rest / weights + NOISE * NOISE);
        }
}

static void find_some_costs(void *ctx, size_t begin, size_t end, int thread)
{
    struct fit *s = ctx;
    const size_t size = (size_t)s->shifts * WIDTHS;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        struct profile f = {0};
        s->edges->points[n].is_known = read_profile(&f, s, &s->edges->points[n]);
        if (s->edges->points[n].is_known)
            find_costs(s->costs + n * size, s->unexplained + n, &f, s, &s->edges->points[n]);
    }
}

/* ------------------------------------------------------------------------------------------------- along the edge */

/* Whether two points lie on one edge; *ahead: the place of b along it, from a, px. */
static bool is_same_edge(double *ahead, const struct fit *s, const struct edge_point *a, const struct edge_point *b)
{
    const double x = b->x - a->x, y = b->y - a->y;
    *ahead = -x * a->ny + y * a->nx;
    if (s->edges->surface[a->pixel] != s->edges->surface[b->pixel] || a->nx * b->nx + a->ny * b->ny < SAME_NORMAL)
        return false;
    return fabs(x * a->nx + y * a->ny) <= 2 + BEND * fabs(*ahead);
}

static double bell(double x, double deviation) { return exp(-x * x / (2 * deviation * deviation)); }

struct span {
    size_t begin, end;
};

/* The points in the rows around a point. */
static struct span around(const struct fit *s, const struct edge_point *p, double reach_px)
{
    const int y = p->pixel / s->edges->width, reach = (int)ceil(reach_px);
    return (struct span){s->edges->rows[clamp_int(y - reach, 0, s->edges->height)],
                         s->edges->rows[clamp_int(y + reach + 1, 0, s->edges->height)]};
}

static int least(const double *costs, int count)
{
    int at = 0;
    for (int k = 1; k < count; k++)
        if (costs[k] < costs[at]) at = k;
    return at;
}

/* Sets shift and width of the least cost, between those that were tried: where a quadratic form through the 3 x 3 costs
 * around the least one is least. Costs are sums of logarithms of mean squares; the mean square itself is nearly
 * quadratic, its logarithm is not. False: the least shift is at the end of the range. */
static bool least_pair(double *shift, double *steeper, const struct fit *s, const double *costs, double weights)
{
    const int at = least(costs, s->shifts * WIDTHS), d = at / WIDTHS, a = at % WIDTHS;
    double near[3][3], by_d = 0, by_a = 0;
    *shift = (double)d / STEPS - s->most;
    *steeper = STEEPER[a];
    if (d == 0 || d + 1 == s->shifts) return false;
    const bool is_inside = a > 0 && a + 1 < WIDTHS;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            near[i][k] = exp((costs[(d + i - 1) * WIDTHS + (is_inside ? a + k - 1 : a)] - costs[at]) / weights);
    const double slope_d = 0.5 * (near[2][1] - near[0][1]), bend_d = near[2][1] + near[0][1] - 2;
    const double slope_a = 0.5 * (near[1][2] - near[1][0]), bend_a = near[1][2] + near[1][0] - 2;
    const double twist = 0.25 * (near[2][2] + near[0][0] - near[2][0] - near[0][2]);
    const double determinant = bend_d * bend_a - twist * twist;
    if (is_inside && determinant > 0.1 * bend_d * bend_a) {
        by_d = (twist * slope_a - bend_a * slope_d) / determinant;
        by_a = (twist * slope_d - bend_d * slope_a) / determinant;
    } else if (bend_d > 0) {
        by_d = -slope_d / bend_d;
    }
    *shift += clamp(by_d, -1, 1) / STEPS;
    *steeper *= pow(STEEPER[1] / STEEPER[0], clamp(by_a, -1, 1));
    return true;
}

/* What a shift or a width costs by itself: of pairs that fit alike, the least move. */
static double unlikely(const struct fit *s, int c)
{
    const double d = ((double)(c / WIDTHS) / STEPS - s->most) / s->most, a = log(STEEPER[c % WIDTHS]) / log(STEEPER[0]);
    return STAY * (d * d + a * a);
}

static double believed(double gain, double half)
{
    const double x = fmax(0, gain / half);
    return x * x * x * x / (1 + x * x * x * x);
}

/* The weight of a point for another one of its edge. */
static double weight_at(double ahead) { return bell(ahead, NEAR) + FAR_SHARE * bell(ahead, FAR); }

/* The middle of an edge's points, weighted; from a point along the edge. */
static double middle_of(const struct fit *s, const struct edge_point *p, struct span near)
{
    double sum = 0, weights = 0, ahead;
    for (size_t k = near.begin; k < near.end; k++) {
        if (!s->edges->points[k].is_known || !is_same_edge(&ahead, s, p, &s->edges->points[k])) continue;
        sum += weight_at(ahead) * ahead;
        weights += weight_at(ahead);
    }
    return weights > 0 ? sum / weights : 0;
}

static void fit_point(struct edge_point *p, const struct fit *s, size_t n)
{
    double sums[3][MAX_COSTS] = {{0}}; /* all, and both halves of the edge */
    double weights[3] = {0}, unexplained = 0;
    const int size = s->shifts * WIDTHS;
    const struct span near = around(s, &s->edges->points[n], 2.5 * FAR);
    const double middle = middle_of(s, &s->edges->points[n], near);
    for (size_t k = near.begin; k < near.end; k++) {
        double ahead;
        if (!s->edges->points[k].is_known || !is_same_edge(&ahead, s, &s->edges->points[n], &s->edges->points[k]))
            continue;
        const double w = weight_at(ahead);
        const int part = ahead > middle ? 2 : 1;
        const float *costs = s->costs + k * (size_t)size;
        for (int c = 0; c < size; c++) {
            sums[0][c] += w * (double)costs[c];
            sums[part][c] += w * (double)costs[c];
        }
        weights[0] += w;
        weights[part] += w;
        unexplained += w * (double)s->unexplained[k];
    }
    p->part = 0;
    if (!(weights[0] > 0.5 * NEAR)) return;
    for (int c = 0; c < size; c++)
        for (int k = 0; k < 3; k++) sums[k][c] += weights[k] * unlikely(s, c);
    if (!least_pair(&p->shift, &p->steeper, s, sums[0], weights[0])) return;
    double off = 0, shifts[2], other;
    if (weights[1] > 0.2 * weights[0] && weights[2] > 0.2 * weights[0]) {
        least_pair(&shifts[0], &other, s, sums[1], weights[1]);
        least_pair(&shifts[1], &other, s, sums[2], weights[2]);
        off = fabs(shifts[1] - shifts[0]);
    }
    const int unmoved = s->most * STEPS * WIDTHS + WIDTHS / 2;
    const double best = sums[0][least(sums[0], size)];
    const double gain = (sums[0][unmoved] - best) / weights[0], explained = (unexplained - best) / weights[0];
    const double moves = fmax(1, fmax(fabs(p->shift), fabs(log(p->steeper)) * p->half)), r = off / moves;
    p->part = believed(gain, GAIN) * believed(explained, EXPLAINED) / (1 + r * r * r * r);
}

static void fit_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct fit *s = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        s->fitted[n] = s->edges->points[n];
        fit_point(&s->fitted[n], s, n);
    }
}

/* The mean of the fits along the edge. */
static void join_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct fit *s = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        struct edge_point *to = &s->edges->points[n];
        const struct span near = around(s, to, 1.5 * NEAR);
        double weights = 0, parts = 0, shift = 0, steeper = 0, half = 0;
        for (size_t k = near.begin; k < near.end; k++) {
            double ahead;
            const struct edge_point *f = &s->fitted[k];
            if (!is_same_edge(&ahead, s, to, f)) continue;
            const double w = bell(ahead, 0.5 * NEAR);
            weights += w;
            parts += w * f->part;
            half += w * f->half;
            if (!(f->part > 0)) continue;
            shift += w * f->part * f->shift;
            steeper += w * f->part * log(f->steeper);
        }
        to->part = 0;
        if (!(parts > 0)) continue;
        to->part = parts / weights;
        to->half = half / weights;
        to->shift = shift / parts;
        to->steeper = exp(steeper / parts);
    }
}

enum status penumbra_fit_points(struct old_edges *edges, int most, struct err *err)
{
    struct fit s = {.edges = edges, .most = most, .shifts = 2 * STEPS * most + 1};
    const size_t count = edges->count, size = (size_t)s.shifts * WIDTHS;
    s.costs = calloc(count * size + 1, sizeof *s.costs);
    s.unexplained = calloc(count + 1, sizeof *s.unexplained);
    s.fitted = calloc(count + 1, sizeof *s.fitted);
    if (!s.costs || !s.unexplained || !s.fitted) {
        err_nomem(err, "edges of light", count * size * sizeof *s.costs);
    } else {
        parallel_for(count, 16, find_some_costs, &s);
        parallel_for(count, 16, fit_some, &s);
        parallel_for(count, 16, join_some, &s);
    }
    free(s.costs);
    free(s.unexplained);
    free(s.fitted);
    return err->status;
}
