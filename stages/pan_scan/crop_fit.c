/* crop_fit.c - see crop_fit.h.
 *
 * With p = (x / step_x, y / step_y) a frame shows p at S p + t, S > 0. Wanted are S and t that bring the points' p near
 * their q = (u, v): Huber's loss of the distances, minimised by reweighted least squares. That the crop lies within the
 * photograph of size P (in units of p) is linear in S and t,
 *   t <= 0,  t + S P >= (frame_width, frame_height),
 * so the whole is convex. For weights and S given, t is the unbound one, q' - S p' (means), clamped axis by axis; what
 * is left is a convex function of S alone, whose slope
 *   S |p - p'|^2 - (p - p') (q - q') + r(S) r'(S),  r = t - (q' - S p') of each axis that is clamped,
 * grows with S: its zero, or the smallest S at which the frame fits into the photograph, is found by bisection. */
#include "stages/pan_scan/crop_fit.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "common/base/sort.h"

#define ROUNDS     200
#define CONVERGED  1e-7 /* frame px */
#define BISECTIONS 200

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

static double miss(const struct crop_task *task, const struct crop_pair *pair, const struct scale_shift *s)
{
    double p[2], q[2];
    point_of(task, pair, p, q);
    return hypot(s->scale * p[0] + s->t[0] - q[0], s->scale * p[1] + s->t[1] - q[1]);
}

/* s NULL: all weigh the same. */
static struct moments measure(const struct crop_task *task, const struct scale_shift *s)
{
    struct moments m = {0};
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < task->count; i++) {
            double p[2], q[2], off = s ? miss(task, &task->pairs[i], s) : 0;
            double w = off > task->tolerance ? task->tolerance / off : 1;
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

/* The shift for a scale; the slope of the loss with the scale. */
static double shift_and_slope(const struct moments *m, const struct bounds *b, double scale, double t[2])
{
    double slope = scale * m->spread_p - m->product;
    for (int k = 0; k < 2; k++) {
        const double wanted = m->q[k] - scale * m->p[k], least = b->frame[k] - scale * b->photo[k];
        t[k] = wanted > 0 ? 0 : wanted < least ? least : wanted;
        if (wanted > 0) slope += m->weight * (t[k] - wanted) * m->p[k];
        if (wanted < least) slope += m->weight * (t[k] - wanted) * (m->p[k] - b->photo[k]);
    }
    return slope;
}

static double least_scale(const struct bounds *b) { return fmax(b->frame[0] / b->photo[0], b->frame[1] / b->photo[1]); }

static struct scale_shift solve_within(const struct moments *m, const struct bounds *b)
{
    struct scale_shift s = {.scale = least_scale(b)};
    double low = s.scale, high = 2 * s.scale;
    if (shift_and_slope(m, b, low, s.t) < 0) {
        while (shift_and_slope(m, b, high, s.t) < 0 && high < 1e9 * s.scale) low = high, high *= 2;
        for (int i = 0; i < BISECTIONS && low < high; i++) {
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
    if (!(s.scale > 0)) s.scale = least_scale(b); /* points that swap places: nothing a crop can do */
    for (int k = 0; k < 2; k++) s.t[k] = m->q[k] - s.scale * m->p[k];
    return s;
}

typedef struct scale_shift solve_fn(const struct moments *m, const struct bounds *b);

static struct scale_shift fit(const struct crop_task *task, const struct bounds *b, solve_fn *solve)
{
    struct moments m = measure(task, NULL);
    struct scale_shift s = solve(&m, b);
    for (int i = 0; i < ROUNDS; i++) {
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
    double most = 0;
    for (int k = 0; k < 2; k++) most = fmax(most, fmax(s->t[k], b->frame[k] - s->t[k] - s->scale * b->photo[k]));
    return most;
}

static double clamp(double x, double most) { return x < 0 ? 0 : x > most ? most : x; }

enum status crop_fit(struct crop_result *result, const struct crop_task *task, struct err *err)
{
    const struct bounds b = {{task->photo_width / task->step_x, task->photo_height / task->step_y},
                             {task->frame_width, task->frame_height}};
    *result = (struct crop_result){0};
    if (task->count < MIN_CROP_POINTS)
        return err_set(err, ST_DATA, "%zu points tell where a crop should be; wanted at least %d.", task->count,
                       MIN_CROP_POINTS);
    const struct moments m = measure(task, NULL);
    if (!(m.spread_p > 1e-12 * m.weight * b.photo[0] * b.photo[0]))
        return err_set(err, ST_DATA, "the %zu points that tell where a crop should be are all at one place.",
                       task->count);
    const struct scale_shift best = fit(task, &b, solve_free);
    result->beyond = beyond_photo(&best, &b);
    const struct scale_shift s = result->beyond > 0 ? fit(task, &b, solve_within) : best;
    struct crop *c = &result->crop;
    c->width = fmin(task->frame_width / s.scale * task->step_x, task->photo_width);
    c->height = fmin(task->frame_height / s.scale * task->step_y, task->photo_height);
    c->x = clamp(-s.t[0] / s.scale * task->step_x, task->photo_width - c->width);
    c->y = clamp(-s.t[1] / s.scale * task->step_y, task->photo_height - c->height);
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
    double *off = malloc(task->count * sizeof *off);
    if (!off) return err_nomem(err, "the points' distances", task->count * sizeof *off);
    for (size_t i = 0; i < task->count; i++) {
        double u, v;
        crop_apply(task, crop, task->pairs[i].x, task->pairs[i].y, &u, &v);
        off[i] = hypot(u - task->pairs[i].u, v - task->pairs[i].v);
    }
    sort_doubles(off, task->count);
    *misfit = off[task->count / 2];
    free(off);
    return ST_OK;
}
