/* photo_exposure.c - exposures of photos by robust least squares over sparse points, as in [Brown 2007; Goldman 2005].
 *
 * Where photo i observes point p, at the tangent r of the angle to its axis, the logarithm of its luminance is
 *   log L = l_p + g_i + v r^2
 * with the unknown radiance l_p of the point, gain g_i of the photo and vignetting v. Radiances are eliminated, so that
 * one small dense system is left. Points that do not fit (a gloss, a wrong match, an occluder) lose their weight
 * (Cauchy). With these weights and v, gains of R, G and B follow one by one, which is the white balance.
 *
 * A frame's gain is that of the photos around its camera, so that a photo's own camera shows what the photo does, and
 * brightness changes steadily along a move. */
#include "common/layers/photo_exposure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/image/luminance.h"
#include "common/math/cholesky.h"

#define HALF_WINDOW 2     /* px around an observation: the mean of 5 x 5 */
#define BRIGHTEST   0.95f /* of a colour that is not clipped */
#define DARKEST     0.005f
#define WHITE       0.8f /* from here to 1, white counts as clipped */
#define ROBUST      0.1  /* residual, in log luminance, at which a weight is halved */
#define ITERATIONS  10   /* of weights */
#define PRIOR       1e-3 /* weight of equal exposures, in observations: decides what no point does */
#define MIN_CHANGE  0.01 /* differences below are noise */
#define MIN_SIGMAS  3.0  /* of vignetting */
#define MAX_VIEWS   1000 /* more are blended as they were taken: the system is dense */
#define OWN         0.01 /* of the views' spacing: a camera this near to a view has its exposure */

enum { LUMINANCE = 3, CHANNELS = 4 };

struct sample {
    int view;
    double r2;
    double log[CHANNELS]; /* R, G, B, luminance */
    double weight;
};

struct samples { /* those of a point are adjacent */
    struct sample *list;
    size_t *end; /* of each point */
    size_t count, points;
    double max_r2;
};

/* ---------------------------------------------------------------------------------------------------- samples */

/* The photo's mean around pixel (u, v); false: beyond the border, without depth, clipped or dark. */
static bool colour_around(const struct layer_view *lv, double u, double v, double log_of[CHANNELS])
{
    const int x0 = (int)floor(u) - HALF_WINDOW, y0 = (int)floor(v) - HALF_WINDOW, side = 2 * HALF_WINDOW + 1;
    float sum[4] = {0};

    if (x0 < 0 || y0 < 0 || x0 + side > lv->width || y0 + side > lv->height) return false;
    for (int y = y0; y < y0 + side; y++)
        for (int x = x0; x < x0 + side; x++) {
            float rgba[4];
            layer_view_photo(lv, x, y, rgba);
            if (rgba[3] < 0.99f) return false;
            for (int c = 0; c < 3; c++) {
                if (!(rgba[c] <= BRIGHTEST)) return false;
                sum[c] += rgba[c] / (float)(side * side);
            }
        }
    const float luminance = luminance_of(sum);
    if (!(luminance >= DARKEST)) return false;
    for (int c = 0; c < 3; c++) log_of[c] = log((double)fmaxf(sum[c], 0.1f * DARKEST));
    log_of[LUMINANCE] = log((double)luminance);
    return true;
}

static enum status samples_take(struct samples *s, const struct camera_set *set, const struct layer_view *views,
                                struct err *err)
{
    const struct sfm_model *m = &set->model;
    size_t most = 1;

    *s = (struct samples){0};
    for (int p = 0; p < m->point_count; p++) most += (size_t)m->points[p].track_count;
    s->list = malloc(most * sizeof *s->list);
    s->end = malloc(((size_t)m->point_count + 1) * sizeof *s->end);
    if (!s->list || !s->end) return err_nomem(err, "photos at sparse points", most * sizeof *s->list);
    for (int p = 0; p < m->point_count; p++) {
        const size_t begin = s->count;
        for (int t = 0; t < m->points[p].track_count; t++) {
            const struct sfm_track *track = &m->points[p].track[t];
            const struct sfm_observation *o = &m->images[track->image_idx].observations[track->observation_idx];
            const struct view *v = &set->views[track->image_idx];
            struct sample *to = &s->list[s->count];
            if (!colour_around(&views[track->image_idx], o->u, o->v, to->log)) continue;
            const double x = (o->u - v->cx) / v->fx, y = (o->v - v->cy) / v->fy;
            to->view = track->image_idx;
            to->r2 = x * x + y * y;
            to->weight = 1;
            s->count++;
        }
        if (s->count - begin < 2) /* nothing to compare with */
            s->count = begin;
        else
            s->end[s->points++] = s->count;
    }
    for (size_t i = 0; i < s->count; i++) s->max_r2 = fmax(s->max_r2, s->list[i].r2);
    return ST_OK;
}

static void samples_release(struct samples *s)
{
    free(s->list);
    free(s->end);
}

/* -------------------------------------------------------------------------------------------------- the system */

/* The normal equations of `views` gains and, in their last place, vignetting; without it (n = views) that of `x` is
 * given. Lower triangle of a (n x n) and right-hand side b. */
struct system {
    double *a, *b, *point; /* point: sums of one point over the unknowns */
    int n, views;
};

static void add_point(struct system *y, const struct sample *from, size_t count, int channel, double vignetting)
{
    const bool with_vignetting = y->n > y->views;
    double weight = 0, mean = 0, r2 = 0;

    for (size_t i = 0; i < count; i++) {
        const struct sample *s = &from[i];
        const double value = s->log[channel] - (with_vignetting ? 0 : vignetting * s->r2);
        weight += s->weight;
        mean += s->weight * value;
        r2 += s->weight * s->r2;
    }
    mean /= weight;
    r2 /= weight;
    for (size_t i = 0; i < count; i++) {
        const struct sample *s = &from[i];
        const double value = s->log[channel] - (with_vignetting ? 0 : vignetting * s->r2) - mean;
        y->b[s->view] += s->weight * value;
        y->a[(size_t)s->view * (size_t)y->n + (size_t)s->view] += s->weight;
        for (size_t k = 0; k < count; k++)
            if (from[k].view <= s->view)
                y->a[(size_t)s->view * (size_t)y->n + (size_t)from[k].view] -= s->weight * from[k].weight / weight;
        if (!with_vignetting) continue;
        double *last = y->a + (size_t)y->views * (size_t)y->n;
        last[s->view] += s->weight * (s->r2 - r2);
        last[y->views] += s->weight * (s->r2 - r2) * (s->r2 - r2);
        y->b[y->views] += s->weight * (s->r2 - r2) * value;
    }
}

/* Solves for the unknowns x[n]; y->a becomes its Cholesky factor. */
static bool solve(struct system *y, const struct samples *s, int channel, double vignetting, double *x)
{
    const size_t n = (size_t)y->n;

    memset(y->a, 0, n * n * sizeof *y->a);
    memset(y->b, 0, n * sizeof *y->b);
    for (size_t p = 0, begin = 0; p < s->points; begin = s->end[p++])
        add_point(y, s->list + begin, s->end[p] - begin, channel, vignetting);
    for (size_t i = 0; i < n; i++) y->a[i * n + i] += PRIOR;
    if (!cholesky_factor(y->a, y->n)) return false;
    memcpy(x, y->b, n * sizeof *x);
    cholesky_forward(y->a, y->n, x);
    cholesky_backward(y->a, y->n, x);
    return true;
}

/* Weights from the residuals of the luminance; returns the weighted variance of a sample. */
static double weigh(struct samples *s, const double *gain, double vignetting)
{
    double sum = 0, total = 0;
    for (size_t p = 0, begin = 0; p < s->points; begin = s->end[p++]) {
        double mean = 0, weight = 0;
        for (size_t i = begin; i < s->end[p]; i++) {
            const struct sample *o = &s->list[i];
            mean += o->weight * (o->log[LUMINANCE] - gain[o->view] - vignetting * o->r2);
            weight += o->weight;
        }
        mean /= weight;
        for (size_t i = begin; i < s->end[p]; i++) {
            struct sample *o = &s->list[i];
            const double r = o->log[LUMINANCE] - gain[o->view] - vignetting * o->r2 - mean;
            sum += o->weight * r * r;
            total += o->weight;
            o->weight = 1 / (1 + r * r / (ROBUST * ROBUST));
        }
    }
    return total > 0 ? sum / total : 0;
}

/* Fits luminance: weights and vignetting, 0 if it is not significant. x: room for all unknowns. */
static bool fit_luminance(struct system *y, struct samples *s, double *x, double *vignetting)
{
    double variance = 0;
    y->n = y->views + 1;
    for (int i = 0; i < ITERATIONS; i++) {
        if (!solve(y, s, LUMINANCE, 0, x)) return false;
        variance = weigh(s, x, x[y->views]);
    }
    const double information = y->a[(size_t)y->n * (size_t)y->n - 1]; /* square root of that of vignetting alone */
    const double sigma = sqrt(variance) / information, v = x[y->views];
    *vignetting = fabs(v) > MIN_SIGMAS * sigma && fabs(v) * s->max_r2 > MIN_CHANGE ? v : 0;
    return true;
}

static bool fit(struct photo_exposures *e, struct system *y, struct samples *s, double *x)
{
    double largest = 0;
    if (!fit_luminance(y, s, x, &e->vignetting)) return false;
    y->n = y->views;
    for (int c = 0; c < 3; c++) {
        if (!solve(y, s, c, e->vignetting, x)) return false;
        for (int i = 0; i < y->views; i++) {
            e->gain[i][c] = x[i];
            largest = fmax(largest, fabs(x[i]));
        }
    }
    return largest >= MIN_CHANGE || e->vignetting != 0;
}

enum status photo_exposures_fit(struct photo_exposures *e, const struct camera_set *set, const struct layer_view *views,
                                struct err *err)
{
    const size_t n = (size_t)set->view_count + 1;
    struct samples s = {0};
    struct system y = {.views = set->view_count};
    double *x = NULL;

    *e = (struct photo_exposures){0};
    if (set->view_count > MAX_VIEWS) return ST_OK;
    samples_take(&s, set, views, err);
    if (!err->status) {
        y.a = malloc(n * n * sizeof *y.a);
        y.b = malloc(n * sizeof *y.b);
        x = malloc(n * sizeof *x);
        e->gain = calloc(n, sizeof *e->gain);
        if (!y.a || !y.b || !x || !e->gain) err_nomem(err, "exposures of photos", n * n * sizeof *y.a);
    }
    if (err->status || !s.points || !fit(e, &y, &s, x)) photo_exposures_release(e);
    samples_release(&s);
    free(y.a);
    free(y.b);
    free(x);
    return err->status;
}

void photo_exposures_release(struct photo_exposures *e)
{
    if (!e) return;
    free(e->gain);
    *e = (struct photo_exposures){0};
}

/* --------------------------------------------------------------------------------------- removing and applying */

/* How much of a colour is the white of a clipped photo, 0 to 1. Its balance is not that of the light; and its radiance,
 * of which the photo tells a lower bound, counts as white at the mean exposure, or sky would turn grey. */
static float clipped_white(const float rgba[4])
{
    const float least = fminf(rgba[0], fminf(rgba[1], rgba[2]));
    const float t = fmaxf(0, fminf(1, (least - WHITE) / (1 - WHITE)));
    return t * t * (3 - 2 * t);
}

struct remove_job {
    const struct view *view;
    struct layer_view *lv;
    double vignetting;
    float gain[3], grey; /* factors */
};

static void remove_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct remove_job *job = ctx;
    const struct view *v = job->view;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < job->lv->width; x++) {
            const double dx = (x + 0.5 - v->cx) / v->fx, dy = (y + 0.5 - v->cy) / v->fy;
            const float all = job->vignetting != 0 ? (float)exp(-job->vignetting * (dx * dx + dy * dy)) : 1;
            float rgba[4], factor[3];
            layer_view_photo(job->lv, x, y, rgba);
            const float white = clipped_white(rgba);
            for (int c = 0; c < 3; c++) factor[c] = all * (job->gain[c] + white * (job->grey - job->gain[c]));
            layer_view_scale(job->lv, x, y, factor);
        }
}

enum status photo_exposures_remove(const struct photo_exposures *e, int i, const struct view *view,
                                   struct layer_view *lv, struct err *err)
{
    struct remove_job job = {.view = view, .lv = lv, .vignetting = e->vignetting};
    if (!e->gain) return ST_OK;
    for (int c = 0; c < 3; c++) job.gain[c] = (float)exp(-e->gain[i][c]);
    job.grey = fmaxf(1, (float)exp(-(e->gain[i][0] + e->gain[i][1] + e->gain[i][2]) / 3));
    parallel_for((size_t)lv->height, 16, remove_rows, &job);
    return layer_view_reduce(lv, err);
}

/* The gain of a photo from the camera: the photos' own, weighted by 1 / distance^2 [Shepard 1968]. */
static void gain_near(double gain[3], const struct photo_exposures *e, const struct view_mesh *mesh,
                      const struct view *camera)
{
    const struct camera_set *set = mesh->set;
    const double own = mesh->spacing > 0 ? OWN * mesh->spacing : 1; /* all views are in one place */
    double total = 0;

    gain[0] = gain[1] = gain[2] = 0;
    for (int i = 0; i < set->view_count; i++) {
        const struct vec3 d = vec3_sub(set->views[i].center, camera->center);
        const double weight = 1 / (vec3_dot(d, d) + own * own);
        for (int c = 0; c < 3; c++) gain[c] += weight * e->gain[i][c];
        total += weight;
    }
    for (int c = 0; c < 3; c++) gain[c] /= total;
}

struct apply_job {
    const struct photo_exposures *e;
    const struct view *camera;
    float gain[3], *rgba;
};

static void apply_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct apply_job *job = ctx;
    const struct view *v = job->camera;
    const size_t width = (size_t)v->width;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < width; x++) {
            const double dx = ((double)x + 0.5 - v->cx) / v->fx, dy = ((double)y + 0.5 - v->cy) / v->fy;
            const float all = job->e->vignetting != 0 ? (float)exp(job->e->vignetting * (dx * dx + dy * dy)) : 1;
            for (size_t c = 0; c < 3; c++) job->rgba[4 * (y * width + x) + c] *= all * job->gain[c];
        }
}

void photo_exposures_apply(const struct photo_exposures *e, const struct view_mesh *mesh, const struct view *camera,
                           struct rendered_frame *frame)
{
    double gain[3];
    if (!e->gain) return;
    gain_near(gain, e, mesh, camera);
    struct apply_job job = {e, camera, {(float)exp(gain[0]), (float)exp(gain[1]), (float)exp(gain[2])}, frame->rgba};
    parallel_for((size_t)frame->height, 16, apply_rows, &job);
}
