/* crop_fit.c - robust fit of a crop under the constraint that it lies within the photograph.
 *
 * With p = (x / step_x, y / step_y), a frame shows p at S p + t, S > 0. S and t minimise Huber's loss of the distances
 * between S p + t and q = (u, v), by iteratively reweighted least squares [Huber 1964]. For a photograph of size P, in
 * units of p, the constraint is linear in S and t,
 *   t <= 0,  t + S P >= (frame_width, frame_height),
 * so the problem is convex. For given weights and S, the best t is the unconstrained q' - S p' (primes: weighted
 * means), clamped per axis. This leaves a convex function of S, whose slope
 *   S |p - p'|^2 - (p - p') (q - q') + r(S) r'(S),  r = t - (q' - S p') of each clamped axis,
 * increases with S; bisection finds its zero, or the smallest S at which the frame fits into the photograph. */
#include "stages/pan_scan/crop_fit.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/math/numbers.h"

#define MAX_ROUNDS     200  /* of reweighting */
#define CONVERGED      1e-7 /* frame px */
#define MAX_BISECTIONS 200

struct scale_shift {
    double scale, t[2];
};

struct moments {               /* of weighted pairs */
    double weight, p[2], q[2]; /* sum, means */
    double spread_p, product;  /* sums of (p - p')^2 and (p - p') (q - q') over both axes */
};

static void point_of(const struct crop_task *task, const struct crop_pair *pair, double p[2], double q[2])
{
    p[0] = pair->x / task->step_x, p[1] = pair->y / task->step_y;
    q[0] = pair->u, q[1] = pair->v;
}

static double residual(const struct crop_task *task, const struct crop_pair *pair, const struct scale_shift *s)
{
    double p[2], q[2];
    point_of(task, pair, p, q);
    return hypot(s->scale * p[0] + s->t[0] - q[0], s->scale * p[1] + s->t[1] - q[1]);
}

/* Moments with the weights of Huber's loss for s; NULL: equal weights. */
static struct moments measure(const struct crop_task *task, const struct scale_shift *s)
{
    struct moments m = {0};
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < task->count; i++) {
            double p[2], q[2], distance = s ? residual(task, &task->pairs[i], s) : 0;
            double w = distance > task->tolerance ? task->tolerance / distance : 1;
            point_of(task, &task->pairs[i], p, q);
            if (pass == 0) m.weight += w;
            for (int k = 0; k < 2; k++)
                if (pass == 0)
                    m.p[k] += w * p[k], m.q[k] += w * q[k];
                else
                    m.spread_p += w * (p[k] - m.p[k]) * (p[k] - m.p[k]),
                        m.product += w * (p[k] - m.p[k]) * (q[k] - m.q[k]);
        }
        for (int k = 0; k < 2 && pass == 0; k++) m.p[k] /= m.weight, m.q[k] /= m.weight;
    }
    return m;
}

struct bounds { /* the photograph in units of p, the frame */
    double photo[2], frame[2];
};

/* Sets the best t for a scale; returns the slope of the loss with respect to the scale. */
static double shift_and_slope(const struct moments *m, const struct bounds *b, double scale, double t[2])
{
    double slope = scale * m->spread_p - m->product;
    for (int k = 0; k < 2; k++) {
        const double wanted = m->q[k] - scale * m->p[k], min = b->frame[k] - scale * b->photo[k];
        t[k] = wanted > 0 ? 0 : wanted < min ? min : wanted;
        if (wanted > 0) slope += m->weight * (t[k] - wanted) * m->p[k];
        if (wanted < min) slope += m->weight * (t[k] - wanted) * (m->p[k] - b->photo[k]);
    }
    return slope;
}

static double min_scale(const struct bounds *b) { return fmax(b->frame[0] / b->photo[0], b->frame[1] / b->photo[1]); }

static struct scale_shift solve_within(const struct moments *m, const struct bounds *b)
{
    struct scale_shift s = {.scale = min_scale(b)};
    double low = s.scale, high = 2 * s.scale;
    if (shift_and_slope(m, b, low, s.t) < 0) {
        while (shift_and_slope(m, b, high, s.t) < 0 && high < 1e9 * s.scale) low = high, high *= 2;
        for (int i = 0; i < MAX_BISECTIONS && low < high; i++) {
            double middle = low + (high - low) / 2;
            if (middle <= low || middle >= high) break;
            if (shift_and_slope(m, b, middle, s.t) < 0)
                low = middle;
            else
                high = middle;
        }
        s.scale = high;
    }
    shift_and_slope(m, b, s.scale, s.t);
    return s;
}

static struct scale_shift solve_free(const struct moments *m, const struct bounds *b)
{
    struct scale_shift s = {.scale = m->product / m->spread_p};
    if (!(s.scale > 0)) s.scale = min_scale(b); /* the picture is mirrored, which no crop can match */
    for (int k = 0; k < 2; k++) s.t[k] = m->q[k] - s.scale * m->p[k];
    return s;
}

typedef struct scale_shift solve_fn(const struct moments *m, const struct bounds *b);

static struct scale_shift fit(const struct crop_task *task, const struct bounds *b, solve_fn *solve)
{
    struct moments m = measure(task, NULL);
    struct scale_shift s = solve(&m, b);
    for (int i = 0; i < MAX_ROUNDS; i++) {
        const struct scale_shift last = s;
        m = measure(task, &s);
        s = solve(&m, b);
        double moved = fabs(s.scale - last.scale) * fmax(b->photo[0], b->photo[1]);
        for (int k = 0; k < 2; k++) moved = fmax(moved, fabs(s.t[k] - last.t[k]));
        if (moved < CONVERGED) break;
    }
    return s;
}

static double beyond_photo(const struct scale_shift *s, const struct bounds *b)
{
    double beyond = 0;
    for (int k = 0; k < 2; k++) beyond = fmax(beyond, fmax(s->t[k], b->frame[k] - s->t[k] - s->scale * b->photo[k]));
    return beyond;
}

enum status crop_fit(struct crop_result *result, const struct crop_task *task, struct err *err)
{
    const struct bounds b = {{task->photo_width / task->step_x, task->photo_height / task->step_y},
                             {task->frame_width, task->frame_height}};
    *result = (struct crop_result){0};
    if (task->count < MIN_CROP_POINTS)
        return err_set(err, ST_DATA,
                       "found %zu points to fit a crop to, at least %d are needed; use depth maps or another view.",
                       task->count, MIN_CROP_POINTS);
    const struct moments m = measure(task, NULL);
    if (!(m.spread_p > 1e-12 * m.weight * b.photo[0] * b.photo[0]))
        return err_set(err, ST_DATA,
                       "found %zu points to fit a crop to, all at the same position; use depth maps or another view.",
                       task->count);
    const struct scale_shift best = fit(task, &b, solve_free);
    result->beyond = beyond_photo(&best, &b);
    const struct scale_shift s = result->beyond > 0 ? fit(task, &b, solve_within) : best;
    struct crop *c = &result->crop;
    c->width = fmin(task->frame_width / s.scale * task->step_x, task->photo_width);
    c->height = fmin(task->frame_height / s.scale * task->step_y, task->photo_height);
    c->x = clamp(-s.t[0] / s.scale * task->step_x, 0, task->photo_width - c->width);
    c->y = clamp(-s.t[1] / s.scale * task->step_y, 0, task->photo_height - c->height);
    return ST_OK;
}

void crop_apply(const struct crop_task *task, const struct crop *crop, double x, double y, double *u, double *v)
{
    *u = (x - crop->x) * task->frame_width / crop->width;
    *v = (y - crop->y) * task->frame_height / crop->height;
}

enum status crop_misfit(double *misfit, const struct crop_task *task, const struct crop *crop, struct err *err)
{
    *misfit = 0;
    if (!task->count) return ST_OK;
    double *distance = malloc(task->count * sizeof *distance);
    if (!distance) return err_nomem(err, "distances of points", task->count * sizeof *distance);
    for (size_t i = 0; i < task->count; i++) {
        double u, v;
        crop_apply(task, crop, task->pairs[i].x, task->pairs[i].y, &u, &v);
        distance[i] = hypot(u - task->pairs[i].u, v - task->pairs[i].v);
    }
    sort_doubles(distance, task->count);
    *misfit = distance[task->count / 2];
    free(distance);
    return ST_OK;
}
