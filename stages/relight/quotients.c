/* quotients.c - see quotients.h.
 *
 * Overview. The gather says how well it knows each quotient. First the noise is smoothed along surfaces; then what may
 * be noise alone is left out.
 *
 * Smoothing. A pixel's log quotient d becomes the weighted mean of 5 x 5 pixels around it, pass by pass twice as far
 * apart [Dammertz 2010]. A neighbour counts if it lies on the same plane, and by how well both agree within their
 * noise, 1 / (1 + (d_j - d_i)^2 / (K^2 (s_i^2 + s_j^2)))^2: at the edge of a shadow or of a patch of sun the difference
 * is many times the noise, and the edge stays. The quotient alone is smoothed, never the texture.
 *
 * Shrinking. With s the error that the gather states, the log quotient becomes
 *   d' = d D^4 / (D^4 + s^4),
 * D the largest of the three channels' |d|. A change of twice its error stays (94 %), one of half its error is left out
 * (6 %), and in between it fades, so that no outline shows. Squares in place of fourth powers, Wiener's filter, would
 * take 20 % of a change of twice its error. The error is that before smoothing. Errors of the model do not count here:
 * they grow with the change, so a small change is as true as a large one. */
#include "stages/relight/quotients.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"

enum { REACH = 2 };
static const double KERNEL[REACH + 1] = {0.375, 0.25, 0.0625}; /* of a cubic B-spline */
static const double AGREE = 3;                                 /* K */
static const double PARALLEL = 0.95;                           /* least cosine of the normals of a surface */
static const double OFF = 0.05; /* how far from the plane a neighbour may lie, as a part of its distance */

struct smooth_job {
    const struct pixels *p;
    const float *error;
    float (*from)[4], (*to)[4]; /* log quotient; [3]: whether there is one */
    int step;
};

static bool is_beside(const struct gather_point *a, const struct gather_point *b)
{
    const struct vec3 by = vec3_sub(b->at, a->at);
    return vec3_dot(a->normal, b->normal) > PARALLEL && fabs(vec3_dot(a->normal, by)) <= OFF * vec3_length(by);
}

static double squared_difference(const float a[4], const float b[4])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += ((double)a[k] - (double)b[k]) * ((double)a[k] - (double)b[k]);
    return sum / 3;
}

static void smooth_pixel(const struct smooth_job *j, int x, int y)
{
    const struct pixels *p = j->p;
    const size_t i = (size_t)y * (size_t)p->width + (size_t)x;
    const double own = (double)j->error[i];
    double sum[3] = {0}, weights = 0;
    for (int k = 0; k < 4; k++) j->to[i][k] = j->from[i][k];
    if (!(j->from[i][3] > 0) || !(own > 0)) return;
    for (int v = -REACH; v <= REACH; v++)
        for (int u = -REACH; u <= REACH; u++) {
            const int at_x = x + u * j->step, at_y = y + v * j->step;
            if (at_x < 0 || at_y < 0 || at_x >= p->width || at_y >= p->height) continue;
            const size_t n = (size_t)at_y * (size_t)p->width + (size_t)at_x;
            if (!(j->from[n][3] > 0) || (n != i && !is_beside(&p->after[i], &p->after[n]))) continue;
            const double noise = AGREE * AGREE * (own * own + (double)j->error[n] * (double)j->error[n]);
            const double off = 1 + squared_difference(j->from[n], j->from[i]) / noise;
            const double w = KERNEL[abs(u)] * KERNEL[abs(v)] / (off * off);
            for (int k = 0; k < 3; k++) sum[k] += w * (double)j->from[n][k];
            weights += w;
        }
    for (int k = 0; k < 3; k++) j->to[i][k] = (float)(sum[k] / weights);
}

static void smooth_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct smooth_job *j = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < j->p->width; x++) smooth_pixel(j, x, (int)y);
}

/* Whether a quotient is to be settled. One that was bounded belongs to its own texel (light_quotient.c), and stays. */
static bool has_log(const struct pixels *p, size_t i, const float q[4])
{
    if (p->kind[i] != PIXEL_TEXTURE && p->kind[i] != PIXEL_CLUTTER) return false;
    return q[3] >= RELIT_SURE && q[0] > 0 && q[1] > 0 && q[2] > 0;
}

/* By what a log quotient is multiplied. */
static double kept_part(const float d[4], double error)
{
    double most = 0;
    for (int k = 0; k < 3; k++) most = fmax(most, fabs((double)d[k]));
    if (!(most > 0)) return 0;
    const double noise = error / most;
    return 1 / (1 + noise * noise * noise * noise);
}

enum status quotients_settle(float (*quotient)[4], const float *error, const struct pixels *p,
                             const struct relight_params *params, struct err *err)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    struct smooth_job j = {.p = p, .error = error, .step = 1};
    j.from = calloc(n + 1, sizeof *j.from);
    j.to = calloc(n + 1, sizeof *j.to);
    if (!j.from || !j.to) err_nomem(err, "quotients of light", 2 * n * sizeof *j.from);
    for (size_t i = 0; !err->status && i < n; i++) {
        if (!has_log(p, i, quotient[i])) continue;
        for (int k = 0; k < 3; k++) j.from[i][k] = logf(quotient[i][k]);
        j.from[i][3] = 1;
    }
    for (int k = 0; !err->status && k < params->smooth; k++, j.step *= 2) {
        parallel_for((size_t)p->height, 4, smooth_rows, &j);
        float(*old)[4] = j.from;
        j.from = j.to;
        j.to = old;
    }
    for (size_t i = 0; !err->status && i < n; i++) {
        if (!(j.from[i][3] > 0)) continue;
        const double part = kept_part(j.from[i], (double)error[i]);
        for (int k = 0; k < 3; k++)
            if (j.from[i][k] != 0)
                quotient[i][k] = (float)exp((double)j.from[i][k] * part);
            else
                quotient[i][k] = 1;
    }
    free(j.from);
    free(j.to);
    return err->status;
}
