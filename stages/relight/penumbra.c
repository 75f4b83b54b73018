/* penumbra.c - see penumbra.h.
 *
 * Overview. Where the photograph has the edge of a patch of sun that the edit takes away, the relit picture L q should
 * be smooth. So the logarithm of the photograph is compared with that of 1 / q across the edge, for shifts and widths
 * of the latter, and the pair that explains the photograph best moves the quotient.
 *
 * Edges. With e = -log q, luminances, an old edge is where e is steepest across its slope, and where the old light E
 * has the same slope: grad e . grad log E >= |grad e|^2 / 2. The edge of a new patch has a slope of e alone, and stays.
 *
 * Fit. Across an edge's point, t runs along the normal, towards the lit side. Both profiles are means of a few pixels
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
 * the nearest is taken.
 *
 * Result. A pixel near an edge takes the quotient of the place t' in place of its own t: that of the vector v that
 * minimises sum w (v . n - (t' - t))^2 over the points beside it, so that at a corner both edges move. Beyond the
 * penumbra the quotient is flat across the edge, and the shift fades. Where the edit leaves a part of the old edge,
 * that part is in the light before and after alike and moves with the quotient. */
#include "stages/relight/penumbra.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/math/numbers.h"

enum {
    STEPS = 2,      /* shifts a pixel */
    WIDTHS = 7,     /* widths that are tried */
    MAX_SHIFT = 16, /* px, most that the parameter allows */
    MAX_HALF = 20,  /* px, half of the widest penumbra */
    BESIDE = 4,     /* px along the edge on either side whose mean is a profile */
    MARGIN = 4,     /* px of a profile beyond penumbra and shift */
    FADE = 8,       /* px over which a shift fades beyond */
    FINE = 2,       /* samples a pixel of the profile of e */
    MAX_REACH = MAX_HALF + MAX_SHIFT + MARGIN,
    MAX_FINE = 2 * FINE * (MAX_REACH + MAX_HALF + MAX_SHIFT) + 1,
    MAX_COSTS = (2 * STEPS * MAX_SHIFT + 1) * WIDTHS
};
static const double STEEPER[WIDTHS] = {0.5, 0.62996052, 0.79370053, 1, 1.25992105, 1.58740105, 2};
static const double BLUR = 2;            /* px, before slopes are taken */
static const double MIN_SLOPE = 0.008;   /* of e, a pixel */
static const double MIN_STEP = 0.06;     /* of e across the edge */
static const double OLD = 0.5;           /* least part of the slope of e that the old light has */
static const double FOOT = 0.15;         /* of the steepest slope: where a penumbra ends */
static const double NEAR = 16, FAR = 64; /* px: standard deviations of weights along an edge */
static const double FAR_SHARE = 0.25;    /* of the weight of the near ones */
static const double BEND = 0.1;        /* how far points of one edge may lie off a line, as a part of their distance */
static const double SAME_NORMAL = 0.9; /* least cosine of normals of one edge */
static const double NOISE = 0.01;      /* of log radiance: less is no evidence */
static const double EXPLAINED = 0.5;   /* fall of the log mean square by the edge of which half is believed */
static const double STAY = 0.05;       /* cost of the largest shift, and of half or twice the width */
static const double GAIN = 0.5;        /* the same by the move */
static const double STRENGTH[2] = {0.5, 1.5};
static const double LEAST_PART = 0.05; /* of a move that is believed: less is none */
static const double STIFF = 0.01;      /* of the weights: what holds a shift along an edge */
static const double SPLAT = 3;         /* px: standard deviation of a point's weight along the edge */

struct edge_point {
    int pixel;
    double x, y;   /* on the ridge beside its centre */
    double nx, ny; /* normal, towards more old light */
    double half;   /* of the penumbra, px */
    double shift, steeper, part;
    bool is_known; /* it has a profile */
};

/* What the edges around a pixel say of where its quotient is: sums of weights w times n n^T, n u, 1, for edges with the
 * normal n across which it is u away. */
struct flow {
    float xx, xy, yy, x, y, weight, along;
};

struct edges {
    int width, height, most; /* most: shift, px */
    int shifts;              /* that are tried */
    int *surface;            /* face of each pixel; -1: none that counts */
    float *photo, *e, *old;  /* logarithms */
    float *smooth_e, *smooth_old;
    struct edge_point *points, *fitted;
    size_t count;
    size_t *rows;       /* first point of each row, and the end */
    float *costs;       /* shifts * WIDTHS of each point */
    float *unexplained; /* the cost without the edge */
    float (*source)[4]; /* log quotients before they are moved */
    struct flow *flow;
    float (*quotient)[4];
};

static void release(struct edges *s)
{
    free(s->surface);
    free(s->photo);
    free(s->e);
    free(s->old);
    free(s->smooth_e);
    free(s->smooth_old);
    free(s->points);
    free(s->fitted);
    free(s->rows);
    free(s->costs);
    free(s->unexplained);
    free(s->source);
    free(s->flow);
}

/* ----------------------------------------------------------------------------------------------------------- fields */

static double luminance(const float *rgb)
{
    return rgb_luminance(rgb_make((double)rgb[0], (double)rgb[1], (double)rgb[2]));
}

static bool counts(const struct pixels *p, size_t i, const float q[4], double photo, double before)
{
    if (p->kind[i] != PIXEL_TEXTURE || p->face[i] < 0) return false;
    return q[3] >= RELIT_SURE && q[0] > 0 && q[1] > 0 && q[2] > 0 && photo > 0 && before > 0;
}

static enum status init(struct edges *s, float (*quotient)[4], const float (*matt)[3], const struct irradiance *before,
                        const struct pixels *p, int most, struct err *err)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    *s = (struct edges){.width = p->width, .height = p->height, .most = most, .shifts = 2 * STEPS * most + 1};
    s->quotient = quotient;
    s->surface = calloc(n + 1, sizeof *s->surface);
    s->photo = calloc(n + 1, sizeof *s->photo);
    s->e = calloc(n + 1, sizeof *s->e);
    s->old = calloc(n + 1, sizeof *s->old);
    s->smooth_e = calloc(n + 1, sizeof *s->smooth_e);
    s->smooth_old = calloc(n + 1, sizeof *s->smooth_old);
    s->rows = calloc((size_t)p->height + 1, sizeof *s->rows);
    if (!s->surface || !s->photo || !s->e || !s->old || !s->smooth_e || !s->smooth_old || !s->rows)
        return err_nomem(err, "edges of light", n * 24);
    for (size_t i = 0; i < n; i++) {
        const double light = rgb_luminance(before[i].value), radiance = luminance(matt[i]);
        s->surface[i] = -1;
        if (!counts(p, i, quotient[i], radiance, light)) continue;
        s->surface[i] = p->face[i];
        s->photo[i] = (float)log(radiance);
        s->e[i] = (float)-log(luminance(quotient[i]));
        s->old[i] = (float)log(light);
    }
    return ST_OK;
}

/* Smooths one row or column of `from`, over pixels of one surface without a gap. */
static void smooth_line(float *to, const float *from, const int *surface, size_t first, size_t step, int count)
{
    enum { REACH = 5 };
    double kernel[REACH + 1];
    for (int k = 0; k <= REACH; k++) kernel[k] = exp(-k * k / (2 * BLUR * BLUR));
    for (int x = 0; x < count; x++) {
        const size_t i = first + (size_t)x * step;
        double sum = (double)from[i] * kernel[0], weights = kernel[0];
        if (surface[i] < 0) continue;
        for (int sign = -1; sign <= 1; sign += 2)
            for (int k = 1; k <= REACH && x + sign * k >= 0 && x + sign * k < count; k++) {
                const size_t n = first + (size_t)(x + sign * k) * step;
                if (surface[n] != surface[i]) break;
                sum += kernel[k] * (double)from[n];
                weights += kernel[k];
            }
        to[i] = (float)(sum / weights);
    }
}

struct smooth_job {
    const struct edges *s;
    const float *from;
    float *to;
    bool is_column;
};

static void smooth_lines(void *ctx, size_t begin, size_t end, int thread)
{
    const struct smooth_job *j = ctx;
    const size_t width = (size_t)j->s->width;
    (void)thread;
    for (size_t k = begin; k < end; k++)
        if (j->is_column)
            smooth_line(j->to, j->from, j->s->surface, k, width, j->s->height);
        else
            smooth_line(j->to, j->from, j->s->surface, k * width, 1, j->s->width);
}

static enum status smooth(float *to, const float *from, const struct edges *s, struct err *err)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    float *between = calloc(n + 1, sizeof *between);
    if (!between) return err_nomem(err, "edges of light", n * sizeof *between);
    struct smooth_job rows = {s, from, between, false}, columns = {s, between, to, true};
    parallel_for((size_t)s->height, 8, smooth_lines, &rows);
    parallel_for((size_t)s->width, 8, smooth_lines, &columns);
    free(between);
    return ST_OK;
}

/* Bilinear; false: not all of the pixels around are of the surface. */
static bool sample(double *value, const struct edges *s, const float *field, int surface, double x, double y)
{
    const int left = (int)floor(x), top = (int)floor(y);
    const double u = x - left, v = y - top;
    const double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    *value = 0;
    for (int k = 0; k < 4; k++) {
        const int at_x = left + k % 2, at_y = top + k / 2;
        if (!(weights[k] > 0)) continue;
        if (at_x < 0 || at_y < 0 || at_x >= s->width || at_y >= s->height) return false;
        const size_t i = (size_t)at_y * (size_t)s->width + (size_t)at_x;
        if (s->surface[i] != surface) return false;
        *value += weights[k] * (double)field[i];
    }
    return true;
}

/* ------------------------------------------------------------------------------------------------------------ edges */

static bool slope(double to[2], const struct edges *s, const float *field, int x, int y)
{
    const size_t width = (size_t)s->width, i = (size_t)y * width + (size_t)x;
    const int f = s->surface[i];
    if (f < 0 || x < 1 || y < 1 || x + 1 >= s->width || y + 1 >= s->height) return false;
    if (s->surface[i - 1] != f || s->surface[i + 1] != f || s->surface[i - width] != f || s->surface[i + width] != f)
        return false;
    to[0] = 0.5 * ((double)field[i + 1] - (double)field[i - 1]);
    to[1] = 0.5 * ((double)field[i + width] - (double)field[i - width]);
    return true;
}

static double steepness(const struct edges *s, int x, int y)
{
    double g[2];
    return slope(g, s, s->smooth_e, x, y) ? hypot(g[0], g[1]) : 0;
}

/* Steepness between pixels. */
static double steepness_at(const struct edges *s, double x, double y)
{
    const int left = (int)floor(x), top = (int)floor(y);
    const double u = x - left, v = y - top;
    if (left < 0 || top < 0 || left + 1 >= s->width || top + 1 >= s->height) return 0;
    return (1 - v) * ((1 - u) * steepness(s, left, top) + u * steepness(s, left + 1, top)) +
           v * ((1 - u) * steepness(s, left, top + 1) + u * steepness(s, left + 1, top + 1));
}

/* How far the penumbra reaches along the normal (sign 1) or against it. */
static int foot(double *value, const struct edges *s, const struct edge_point *p, int surface, double steepest,
                int sign)
{
    const double x = p->x, y = p->y;
    double last = 0, next;
    int t = 0;
    sample(&last, s, s->smooth_e, surface, x, y);
    for (t = 0; t < MAX_HALF; t++) {
        if (!sample(&next, s, s->smooth_e, surface, x + sign * (t + 1) * p->nx, y + sign * (t + 1) * p->ny)) break;
        if (sign * (next - last) < FOOT * steepest) break;
        last = next;
    }
    *value = last;
    return t;
}

/* Whether a pixel lies on the ridge of an old edge. */
static bool is_edge(struct edge_point *p, const struct edges *s, int x, int y)
{
    double g[2], old[2], low, high;
    if (!slope(g, s, s->smooth_e, x, y) || !slope(old, s, s->smooth_old, x, y)) return false;
    const double steepest = hypot(g[0], g[1]);
    if (!(steepest >= MIN_SLOPE) || g[0] * old[0] + g[1] * old[1] < OLD * steepest * steepest) return false;
    *p = (struct edge_point){.pixel = y * s->width + x, .nx = g[0] / steepest, .ny = g[1] / steepest};
    const double next = steepness_at(s, x + p->nx, y + p->ny), last = steepness_at(s, x - p->nx, y - p->ny);
    if (next > steepest || last >= steepest) return false;
    const double by = 0.5 * (next - last) / (2 * steepest - next - last);
    p->x = x + by * p->nx;
    p->y = y + by * p->ny;
    const int surface = s->surface[p->pixel];
    const int above = foot(&high, s, p, surface, steepest, 1), below = foot(&low, s, p, surface, steepest, -1);
    p->half = fmax(1.5, above > below ? above : below);
    return high - low >= MIN_STEP;
}

static enum status find_edges(struct edges *s, struct err *err)
{
    struct edge_point p;
    for (int y = 0; y < s->height; y++) {
        s->rows[y] = s->count;
        for (int x = 0; x < s->width; x++) {
            if (s->surface[(size_t)y * (size_t)s->width + (size_t)x] < 0 || !is_edge(&p, s, x, y)) continue;
            if (array_append(&s->points, s->count, sizeof *s->points, "edges of light", err)) return err->status;
            s->points[s->count++] = p;
        }
    }
    s->rows[s->height] = s->count;
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------------- fit */

struct profile {
    int reach, fine_reach; /* px; samples of e */
    double photo[2 * MAX_REACH + 1], weight[2 * MAX_REACH + 1];
    double e[MAX_FINE];
};

/* The mean along the edge at a distance from it; false: less than half of the places are of the surface. */
static bool mean_at(double *value, const struct edges *s, const float *field, const struct edge_point *p, double t,
                    int beside)
{
    const double x = p->x + t * p->nx, y = p->y + t * p->ny;
    double sum = 0, one;
    int count = 0;
    for (int k = -beside; k <= beside; k++) {
        if (!sample(&one, s, field, s->surface[p->pixel], x - k * p->ny, y + k * p->nx)) continue;
        sum += one;
        count++;
    }
    *value = count ? sum / count : 0;
    return 2 * count > 2 * beside + 1;
}

/* Where e has no value it goes on as it is last. */
static void read_e(struct profile *f, const struct edges *s, const struct edge_point *p)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        double last = (double)s->e[p->pixel];
        bool is_over = false;
        for (int k = 0; k <= f->fine_reach; k++) {
            double value;
            is_over = is_over || !mean_at(&value, s, s->e, p, sign * k / (double)FINE, BESIDE);
            if (!is_over) last = value;
            f->e[f->fine_reach + sign * k] = last;
        }
    }
}

static bool read_profile(struct profile *f, const struct edges *s, const struct edge_point *p)
{
    double weights = 0, all = 0;
    f->reach = (int)ceil(p->half) + s->most + MARGIN;
    f->fine_reach = FINE * (f->reach + s->most + (int)ceil(p->half));
    for (int t = -f->reach; t <= f->reach; t++) {
        const int k = t + f->reach;
        const double window = 0.5 + 0.5 * cos(PI * t / (f->reach + 1.0));
        f->weight[k] = mean_at(&f->photo[k], s, s->photo, p, t, BESIDE) ? window : 0;
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

static double moved(const struct edge_point *p, double t, double shift, double steeper)
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

static void find_costs(float *costs, float *unexplained, struct profile *f, const struct edges *s,
                       const struct edge_point *p)
{
    double e[2 * MAX_REACH + 1], weights = 0;
    for (int k = 0; k <= 2 * f->reach; k++) weights += f->weight[k];
    detrend(f->photo, f);
    const double all = product(f->photo, f->photo, f);
    *unexplained = (float)log(all / weights + NOISE * NOISE);
    for (int d = 0; d < s->shifts; d++)
        for (int a = 0; a < WIDTHS; a++) {
            const double shift = (double)d / STEPS - s->most;
            for (int t = -f->reach; t <= f->reach; t++) e[t + f->reach] = e_at(f, moved(p, t, shift, STEEPER[a]));
            detrend(e, f);
            const double both = product(f->photo, e, f), own = product(e, e, f);
            const double strength = own > 0 ? clamp(both / own, STRENGTH[0], STRENGTH[1]) : 0;
            const double rest = fmax(0, all - 2 * strength * both + strength * strength * own);
            costs[d * WIDTHS + a] = (float)log(rest / weights + NOISE * NOISE);
        }
}

static void find_some_costs(void *ctx, size_t begin, size_t end, int thread)
{
    struct edges *s = ctx;
    const size_t size = (size_t)s->shifts * WIDTHS;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        struct profile f;
        s->points[n].is_known = read_profile(&f, s, &s->points[n]);
        if (s->points[n].is_known) find_costs(s->costs + n * size, s->unexplained + n, &f, s, &s->points[n]);
    }
}

/* ------------------------------------------------------------------------------------------------- along the edge */

/* Whether two points lie on one edge; *ahead: the place of b along it, from a, px. */
static bool is_same_edge(double *ahead, const struct edges *s, const struct edge_point *a, const struct edge_point *b)
{
    const double x = b->x - a->x, y = b->y - a->y;
    *ahead = -x * a->ny + y * a->nx;
    if (s->surface[a->pixel] != s->surface[b->pixel] || a->nx * b->nx + a->ny * b->ny < SAME_NORMAL) return false;
    return fabs(x * a->nx + y * a->ny) <= 2 + BEND * fabs(*ahead);
}

static double bell(double x, double deviation) { return exp(-x * x / (2 * deviation * deviation)); }

struct span {
    size_t begin, end;
};

/* The points in the rows around a point. */
static struct span around(const struct edges *s, const struct edge_point *p, double reach_px)
{
    const int y = p->pixel / s->width, reach = (int)ceil(reach_px);
    return (struct span){s->rows[clamp_int(y - reach, 0, s->height)], s->rows[clamp_int(y + reach + 1, 0, s->height)]};
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
static bool least_pair(double *shift, double *steeper, const struct edges *s, const double *costs, double weights)
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
static double unlikely(const struct edges *s, int c)
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
static double middle_of(const struct edges *s, const struct edge_point *p, struct span near)
{
    double sum = 0, weights = 0, ahead;
    for (size_t k = near.begin; k < near.end; k++) {
        if (!s->points[k].is_known || !is_same_edge(&ahead, s, p, &s->points[k])) continue;
        sum += weight_at(ahead) * ahead;
        weights += weight_at(ahead);
    }
    return weights > 0 ? sum / weights : 0;
}

static void fit_point(struct edge_point *p, const struct edges *s, size_t n)
{
    double sums[3][MAX_COSTS] = {{0}}; /* all, and both halves of the edge */
    double weights[3] = {0}, unexplained = 0;
    const int size = s->shifts * WIDTHS;
    const struct span near = around(s, &s->points[n], 2.5 * FAR);
    const double middle = middle_of(s, &s->points[n], near);
    for (size_t k = near.begin; k < near.end; k++) {
        double ahead;
        if (!s->points[k].is_known || !is_same_edge(&ahead, s, &s->points[n], &s->points[k])) continue;
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
    struct edges *s = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        s->fitted[n] = s->points[n];
        fit_point(&s->fitted[n], s, n);
    }
}

/* The mean of the fits along the edge. */
static void join_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct edges *s = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        struct edge_point *to = &s->points[n];
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

/* ------------------------------------------------------------------------------------------------------------ moves */

/* Adds what a point of an edge says of the pixels around it. */
static void splat(struct edges *s, const struct edge_point *p)
{
    const int at_x = p->pixel % s->width, at_y = p->pixel / s->width;
    const double flat = p->half + fabs(p->shift) + 2, reach = flat + FADE;
    const int r = (int)ceil(hypot(reach, 2.5 * SPLAT));
    for (int y = clamp_int(at_y - r, 0, s->height); y < clamp_int(at_y + r + 1, 0, s->height); y++)
        for (int x = clamp_int(at_x - r, 0, s->width); x < clamp_int(at_x + r + 1, 0, s->width); x++) {
            const size_t i = (size_t)y * (size_t)s->width + (size_t)x;
            const double t = (x - p->x) * p->nx + (y - p->y) * p->ny, along = (y - p->y) * p->nx - (x - p->x) * p->ny;
            if (s->surface[i] != s->surface[p->pixel] || fabs(t) > reach || fabs(along) > 2.5 * SPLAT) continue;
            const double by_along = exp(-along * along / (2 * SPLAT * SPLAT));
            const double fade = clamp((reach - fabs(t)) / FADE, 0, 1), off = t / p->half;
            const double weight = p->part * by_along / (1 + off * off);
            const double by = fade * fade * (3 - 2 * fade) * (moved(p, t, p->shift, p->steeper) - t);
            struct flow *f = &s->flow[i];
            f->xx += (float)(weight * p->nx * p->nx);
            f->xy += (float)(weight * p->nx * p->ny);
            f->yy += (float)(weight * p->ny * p->ny);
            f->x += (float)(weight * by * p->nx);
            f->y += (float)(weight * by * p->ny);
            f->weight += (float)weight;
            f->along += (float)(p->part * by_along);
        }
}

/* The shift that agrees best with all edges: at a corner, with that of both. */
static void find_shift(double by[2], const struct flow *f)
{
    const double least = STIFF * (double)f->weight, xx = (double)f->xx + least, yy = (double)f->yy + least;
    const double xy = (double)f->xy, determinant = xx * yy - xy * xy;
    const double part = fmin(1, (double)f->along / SPLAT) / determinant;
    by[0] = part * (yy * (double)f->x - xy * (double)f->y);
    by[1] = part * (xx * (double)f->y - xy * (double)f->x);
}

/* Weights of four values in a row at u between the middle ones: cubic, for a penumbra is a few pixels wide and a linear
 * mean would widen it. */
static void weigh(double w[4], double u, bool is_cubic)
{
    const double v = 1 - u;
    const double cubic[4] = {-0.5 * u * v * v, v + 0.5 * u * v * (3 * v - 1), u + 0.5 * u * v * (3 * u - 1),
                             -0.5 * v * u * u};
    for (int k = 0; k < 4; k++) w[k] = is_cubic ? cubic[k] : k == 1 ? v : k == 2 ? u : 0;
}

/* The log quotient at a place; false: not all of the pixels that it is made of are of the surface. */
static bool read_quotient(double to[3], const struct edges *s, int surface, double x, double y, bool is_cubic)
{
    const int left = (int)floor(x), top = (int)floor(y);
    double wx[4], wy[4];
    weigh(wx, x - left, is_cubic);
    weigh(wy, y - top, is_cubic);
    for (int c = 0; c < 3; c++) to[c] = 0;
    for (int k = 0; k < 16; k++) {
        const int at_x = left + k % 4 - 1, at_y = top + k / 4 - 1;
        const double w = wx[k % 4] * wy[k / 4];
        if (w == 0) continue;
        if (at_x < 0 || at_y < 0 || at_x >= s->width || at_y >= s->height) return false;
        const size_t i = (size_t)at_y * (size_t)s->width + (size_t)at_x;
        if (s->surface[i] != surface) return false;
        for (int c = 0; c < 3; c++) to[c] += w * (double)s->source[i][c];
    }
    return true;
}

/* Takes the quotient from beside the pixel. */
static void move_pixel(const struct edges *s, int x, int y)
{
    const size_t i = (size_t)y * (size_t)s->width + (size_t)x;
    double q[3], by[2];
    if (!(s->flow[i].weight > 0)) return;
    find_shift(by, &s->flow[i]);
    if (by[0] == 0 && by[1] == 0) return;
    if (!read_quotient(q, s, s->surface[i], x + by[0], y + by[1], true) &&
        !read_quotient(q, s, s->surface[i], x + by[0], y + by[1], false))
        return;
    for (int c = 0; c < 3; c++) s->quotient[i][c] = (float)exp(q[c]);
}

static void move_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct edges *s = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < s->width; x++) move_pixel(s, x, (int)y);
}

static enum status move(struct edges *s, struct err *err)
{
    const size_t n = (size_t)s->width * (size_t)s->height;
    s->source = calloc(n + 1, sizeof *s->source);
    s->flow = calloc(n + 1, sizeof *s->flow);
    if (!s->source || !s->flow) return err_nomem(err, "edges of light", 2 * n * sizeof *s->flow);
    for (size_t i = 0; i < n; i++)
        for (int c = 0; s->surface[i] >= 0 && c < 3; c++) s->source[i][c] = logf(s->quotient[i][c]);
    for (size_t k = 0; k < s->count; k++)
        if (s->points[k].part > LEAST_PART) splat(s, &s->points[k]);
    parallel_for((size_t)s->height, 8, move_rows, s);
    return ST_OK;
}

static enum status fit(struct edges *s, struct err *err)
{
    const size_t size = (size_t)s->shifts * WIDTHS;
    s->costs = calloc(s->count * size, sizeof *s->costs);
    s->unexplained = calloc(s->count, sizeof *s->unexplained);
    s->fitted = calloc(s->count, sizeof *s->fitted);
    if (!s->costs || !s->unexplained || !s->fitted) return err_nomem(err, "edges of light", s->count * size * 4);
    parallel_for(s->count, 16, find_some_costs, s);
    parallel_for(s->count, 16, fit_some, s);
    parallel_for(s->count, 16, join_some, s);
    return ST_OK;
}

static void count_fits(struct penumbra_stats *stats, const struct edges *s)
{
    double squares = 0;
    *stats = (struct penumbra_stats){.points = (int)s->count};
    for (size_t k = 0; k < s->count; k++) {
        if (!(s->points[k].part > 0.5)) continue;
        stats->fitted++;
        squares += s->points[k].shift * s->points[k].shift;
    }
    if (stats->fitted) stats->shift = sqrt(squares / stats->fitted);
}

enum status penumbra_fit(float (*quotient)[4], struct penumbra_stats *stats, const float (*matt)[3],
                         const struct irradiance *before, const struct pixels *p, const struct relight_params *params,
                         struct err *err)
{
    struct edges s = {0};
    *stats = (struct penumbra_stats){0};
    if (!params->penumbra) return ST_OK;
    if (!init(&s, quotient, matt, before, p, params->penumbra, err) && !smooth(s.smooth_e, s.e, &s, err) &&
        !smooth(s.smooth_old, s.old, &s, err) && !find_edges(&s, err) && s.count && !fit(&s, err)) {
        count_fits(stats, &s);
        if (stats->fitted) move(&s, err);
    }
    release(&s);
    return err->status;
}
