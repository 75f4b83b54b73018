/* penumbra_edges.c - see penumbra_edges.h.
 *
 * With e = -log q, luminances, an old edge is where e is steepest across its slope, and where the old light E has the
 * same slope: grad e . grad log E >= |grad e|^2 / 2. The edge of a new patch has a slope of e alone, and stays. */
#include "stages/relight/penumbra_edges.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/parallel.h"

static const double BLUR = 2;          /* px, before slopes are taken */
static const double MIN_SLOPE = 0.008; /* of e, a pixel */
static const double MIN_STEP = 0.06;   /* of e across the edge */
static const double OLD = 0.5;         /* least part of the slope of e that the old light has */
static const double FOOT = 0.15;       /* of the steepest slope: where a penumbra ends */

void penumbra_edges_release(struct old_edges *s)
{
    free(s->surface);
    free(s->photo);
    free(s->e);
    free(s->old);
    free(s->smooth_e);
    free(s->smooth_old);
    free(s->points);
    free(s->rows);
    *s = (struct old_edges){0};
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

static enum status init(struct old_edges *s, float (*quotient)[4], const float (*matt)[3],
                        const struct irradiance *before, const struct pixels *p, struct err *err)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    *s = (struct old_edges){.width = p->width, .height = p->height, .quotient = quotient};
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
    const struct old_edges *s;
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

static enum status smooth(float *to, const float *from, const struct old_edges *s, struct err *err)
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

/* Bilinear. */
bool penumbra_edges_sample(double *value, const struct old_edges *s, const float *field, int surface, double x,
                           double y)
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

static bool slope(double to[2], const struct old_edges *s, const float *field, int x, int y)
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

static double steepness(const struct old_edges *s, int x, int y)
{
    double g[2];
    return slope(g, s, s->smooth_e, x, y) ? hypot(g[0], g[1]) : 0;
}

/* Steepness between pixels. */
static double steepness_at(const struct old_edges *s, double x, double y)
{
    const int left = (int)floor(x), top = (int)floor(y);
    const double u = x - left, v = y - top;
    if (left < 0 || top < 0 || left + 1 >= s->width || top + 1 >= s->height) return 0;
    return (1 - v) * ((1 - u) * steepness(s, left, top) + u * steepness(s, left + 1, top)) +
           v * ((1 - u) * steepness(s, left, top + 1) + u * steepness(s, left + 1, top + 1));
}

/* How far the penumbra reaches along the normal (sign 1) or against it. */
static int foot(double *value, const struct old_edges *s, const struct edge_point *p, int surface, double steepest,
                int sign)
{
    const double x = p->x, y = p->y;
    double last = 0, next;
    int t = 0;
    penumbra_edges_sample(&last, s, s->smooth_e, surface, x, y);
    for (t = 0; t < PENUMBRA_MOST_HALF; t++) {
        if (!penumbra_edges_sample(&next, s, s->smooth_e, surface, x + sign * (t + 1) * p->nx,
                                   y + sign * (t + 1) * p->ny))
            break;
        if (sign * (next - last) < FOOT * steepest) break;
        last = next;
    }
    *value = last;
    return t;
}

/* Whether a pixel lies on the ridge of an old edge. */
static bool is_edge(struct edge_point *p, const struct old_edges *s, int x, int y)
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

static enum status find_points(struct old_edges *s, struct err *err)
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

enum status penumbra_edges_find(struct old_edges *s, float (*quotient)[4], const float (*matt)[3],
                                const struct irradiance *before, const struct pixels *p, struct err *err)
{
    if (!init(s, quotient, matt, before, p, err) && !smooth(s->smooth_e, s->e, s, err) &&
        !smooth(s->smooth_old, s->old, s, err))
        find_points(s, err);
    return err->status;
}
