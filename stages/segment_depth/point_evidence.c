/* point_evidence.c - cost of a plane given the sparse points of structure from motion.
 *
 *   cost = inside_weight  sum over the n points inside the segment of min(1, |plane - 1/z| / (2 step)) / (n + 1)
 *        + nearest_weight min over the nearest points of min(1, |plane - 1/z| / tolerance)
 *        + far_weight     (1/z - min_inverse_z) / (max_inverse_z - min_inverse_z)
 * with the plane taken at the point. Points inside a segment measure its depth. A textureless segment without points
 * most likely lies on a plane with a point nearby in place and colour: the minimum lets any of them explain it. The
 * last term prefers the farthest depth, since the edges of a flat region belong to the surface in front of it. All are
 * soft: they decide where the pictures do not. */
#include "stages/segment_depth/point_evidence.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"

#define COLOUR_SCALE 6.0f /* Lab distance that is as far as PLACE_SCALE of the picture's diagonal */
#define PLACE_SCALE  0.08f
/* Distance from the nearest points' depths at which the cost is full: a part of the depth range, but at least so many
 * steps, within which the pictures decide better. */
#define TOLERANCE       0.04
#define TOLERANCE_STEPS 4

static enum status sort_into_segments(struct point_evidence *e, const struct segmentation *s,
                                      const struct observed_points *seen, struct err *err)
{
    e->first = calloc((size_t)s->count + 2, sizeof *e->first);
    e->points = malloc(((size_t)seen->count + 1) * sizeof *e->points);
    if (!e->first || !e->points) return err_nomem(err, "lists of points", (size_t)s->count * sizeof *e->first);
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < seen->count; i++) {
            const struct observed_point *p = &seen->points[i];
            if (!(p->u >= 0 && p->v >= 0 && p->u < s->width && p->v < s->height)) continue;
            int label = s->label[(int)p->v * s->width + (int)p->u];
            if (label < 0) continue;
            if (round == 0)
                e->first[label + 2]++;
            else
                e->points[e->first[label + 1]++] = *p;
        }
        for (int k = 1; k <= s->count + 1 && round == 0; k++) e->first[k] += e->first[k - 1];
    }
    return ST_OK;
}

struct nearest_job {
    struct point_evidence *e;
    const struct segmentation *s;
    float place;     /* scale of places, 1 / px */
    float (*key)[5]; /* of each point: place and colour, scaled */
};

static void fill_key(float key[5], const struct segment *g, double u, double v, float place)
{
    key[0] = place * (float)u;
    key[1] = place * (float)v;
    for (int c = 0; c < 3; c++) key[2 + c] = g->colour[c] / COLOUR_SCALE;
}

static void find_nearest(void *ctx, size_t begin, size_t end, int thread)
{
    const struct nearest_job *job = ctx;
    int points = job->e->first[job->s->count], keep = job->e->nearest_count;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct segment *g = &job->s->segments[i];
        float key[5], distance[NEAREST_POINTS];
        int nearest[NEAREST_POINTS], count = 0;
        fill_key(key, g, g->cx, g->cy, job->place);
        for (int p = 0; p < points; p++) {
            float d = 0;
            for (int c = 0; c < 5; c++) d += (key[c] - job->key[p][c]) * (key[c] - job->key[p][c]);
            if (count == keep && d >= distance[count - 1]) continue;
            int at = count < keep ? count++ : count - 1;
            for (; at > 0 && distance[at - 1] > d; at--) {
                distance[at] = distance[at - 1];
                nearest[at] = nearest[at - 1];
            }
            distance[at] = d;
            nearest[at] = p;
        }
        for (int k = 0; k < count; k++) {
            const struct observed_point *p = &job->e->points[nearest[k]];
            job->e->nearest[i * NEAREST_POINTS + (size_t)k] =
                (struct near_point){(float)p->u, (float)p->v, (float)p->inverse_z};
        }
    }
}

enum status point_evidence_make(struct point_evidence *e, const struct segmentation *s,
                                const struct observed_points *seen, double min_inverse_z, double max_inverse_z,
                                double step, const struct segment_params *params, struct err *err)
{
    *e = (struct point_evidence){.min_inverse_z = min_inverse_z,
                                 .max_inverse_z = max_inverse_z,
                                 .step = step,
                                 .inside_weight = params->points,
                                 .nearest_weight = params->nearest_points,
                                 .far_weight = params->far_bias};
    if (!sort_into_segments(e, s, seen, err)) {
        int points = e->first[s->count];
        float place = (float)(1 / (PLACE_SCALE * hypot(s->width, s->height)));
        struct nearest_job job = {.e = e, .s = s, .place = place};
        e->nearest_count = points < NEAREST_POINTS ? points : NEAREST_POINTS;
        e->nearest = malloc(((size_t)s->count * NEAREST_POINTS + 1) * sizeof *e->nearest);
        job.key = malloc(((size_t)points + 1) * sizeof *job.key);
        if (e->nearest && job.key) {
            for (int i = 0; i < s->count; i++)
                for (int k = e->first[i]; k < e->first[i + 1]; k++)
                    fill_key(job.key[k], &s->segments[i], e->points[k].u, e->points[k].v, place);
            parallel_for((size_t)s->count, 64, find_nearest, &job);
        } else {
            err_nomem(err, "points near segments", (size_t)s->count * NEAREST_POINTS * sizeof *e->nearest);
        }
        free(job.key);
    }
    if (err->status) point_evidence_release(e);
    return err->status;
}

void point_evidence_release(struct point_evidence *e)
{
    if (!e) return;
    free(e->first);
    free(e->points);
    free(e->nearest);
    *e = (struct point_evidence){0};
}

double point_evidence_far(const struct point_evidence *e, struct plane plane, double u, double v)
{
    const double here = plane_at(plane, u, v);
    return e->far_weight * fmin(fmax((here - e->min_inverse_z) / (e->max_inverse_z - e->min_inverse_z), 0), 1);
}

double point_evidence_cost(const struct point_evidence *e, int segment, struct plane plane, double u, double v)
{
    int begin = e->first[segment], end = e->first[segment + 1];
    double inside = 0, nearest = 1;
    for (int i = begin; i < end; i++) {
        const struct observed_point *p = &e->points[i];
        inside += fmin(1, fabs(plane_at(plane, p->u, p->v) - p->inverse_z) / (2 * e->step));
    }
    if (begin < end) inside /= end - begin + 1.0; /* a single point counts half as much as many */
    const struct near_point *near = e->nearest + (size_t)segment * NEAREST_POINTS;
    double tolerance = fmax(TOLERANCE * (e->max_inverse_z - e->min_inverse_z), TOLERANCE_STEPS * e->step);
    for (int k = 0; k < e->nearest_count; k++) {
        /* not fmin: gcc 12 for arm64 stops with an internal error */
        const double off =
            fabs(plane_at(plane, (double)near[k].u, (double)near[k].v) - (double)near[k].inverse_z) / tolerance;
        if (off < nearest) nearest = off;
    }
    return e->inside_weight * inside + (e->nearest_count ? e->nearest_weight * nearest : 0) +
           point_evidence_far(e, plane, u, v);
}

double point_evidence_support(const struct point_evidence *e, int segment, struct plane plane)
{
    const int begin = e->first[segment], end = e->first[segment + 1];
    int near = 0;
    for (int i = begin; i < end; i++) {
        const struct observed_point *p = &e->points[i];
        near += fabs(plane_at(plane, p->u, p->v) - p->inverse_z) <= 2 * e->step;
    }
    return near / (end - begin + 1.0);
}
