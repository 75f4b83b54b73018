/* depth_deviation.c - how far off the depth of segments may be.
 *
 * In steps s of inverse depth, the variance of a segment's inverse depth is
 *   s^2 ((POINTS r)^2 + LEAST^2 + (MATCHES w)^2).
 *
 * r, of the view: what the planes are off where their depth is known otherwise. 68 % of the sparse points are within r
 * of their segment's plane. Points come from features in many photographs, which are more exact than planes. r is large
 * where the cameras are wrong, which no matching cost shows: in rooms photographed as panoramas it is ten times that
 * of simulated ones. A view with few points is not trusted: FEW points that are off by one step are added.
 *
 * w, of the segment: the spread of the depths that match as well. With C(o) the mean matching cost of the segment and
 * of the surface around it at o steps before or behind their planes,
 *   w^2 = sum_o o^2 exp(-C(o) / TEMPERATURE) / sum_o exp(-C(o) / TEMPERATURE).
 * It is the variance of the posterior over depths that a matching cost stands for [Matthies 1989] [Hu 2012]. The
 * surface is all segments that are reached over at most RINGS borders where planes meet. A blank segment in a textured
 * surface is known by it; a blank wall is not known at all, and w is as wide as the range of depths.
 *
 * Later rounds have no costs at all depths. A segment keeps the deviation of the plane it started from, but less of it
 * the more other views agree: AGREEING views are as good as a certain match.
 *
 * POINTS, LEAST and MATCHES were chosen on loft and redkitchen (docs/decisions/0055-what-depth-may-be-off.md). What
 * differs from the sources: costs are averaged over a surface, and the level of the noise comes from points. */
#include "stages/segment_depth/depth_deviation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"

#define POINTS      1.9
#define LEAST       0.03
#define MATCHES     0.7
#define TEMPERATURE 0.05 /* of matching costs, where 0 is a good match and 1 a chance one */
#define SHARE       0.683
#define FEW         5
#define AGREEING    2.0
#define MEETING     1.0 /* steps by which the planes of a surface may differ at their border */

enum { RINGS = 2, MAX_AROUND = 64, ROWS = 32 };

enum status deviation_of_points(double *steps, const struct plane_problem *p, const struct plane *planes,
                                struct err *err)
{
    const struct point_evidence *e = p->points;
    const int count = e->first[p->m->segments->count];
    double *off = malloc(((size_t)count + 1) * sizeof *off);
    if (!off) return err_nomem(err, "what points are off", (size_t)count * sizeof *off);
    for (int i = 0; i < p->m->segments->count; i++)
        for (int k = e->first[i]; k < e->first[i + 1]; k++) {
            const struct observed_point *point = &e->points[k];
            off[k] = fabs(plane_at(planes[i], point->u, point->v) - point->inverse_z) / p->step;
        }
    sort_doubles(off, (size_t)count);
    *steps = count ? (count * off[(int)(SHARE * (count - 1))] + FEW) / (count + FEW) : 1;
    free(off);
    return ST_OK;
}

/* Lists segment i and those around it on the same surface. Returns how many. */
static int surface_around(int around[MAX_AROUND], const struct plane_problem *p, const struct plane *planes, int i)
{
    const struct segmentation *s = p->m->segments;
    int count = 1, ring = 0;
    around[0] = i;
    for (int round = 0; round < RINGS; round++) {
        const int end = count;
        for (; ring < end; ring++)
            for (int t = s->first_border[around[ring]]; t < s->first_border[around[ring] + 1]; t++) {
                const struct border *b = &s->borders[t];
                const double gap = plane_at(planes[around[ring]], (double)b->u, (double)b->v) -
                                   plane_at(planes[b->other], (double)b->u, (double)b->v);
                int k = 0;
                while (k < count && around[k] != b->other) k++;
                if (k == count && count < MAX_AROUND && fabs(gap) <= MEETING * p->step) around[count++] = b->other;
            }
    }
    return count;
}

/* The label nearest to a segment's plane. */
static int label_of(const struct plane_problem *p, const struct plane *planes, int i)
{
    const struct segment *g = &p->m->segments->segments[i];
    const double label = (plane_at(planes[i], g->cx, g->cy) - p->min_inverse_z) / p->step;
    return (int)(clamp(label, 0, p->planes - 1) + 0.5);
}

double deviation_of_matches(const struct plane_problem *p, const struct plane *planes, int segment, double *room)
{
    double *sum = room, *weight = room + p->planes;
    int around[MAX_AROUND];
    const int count = surface_around(around, p, planes, segment), own = label_of(p, planes, segment);
    memset(sum, 0, (size_t)p->planes * sizeof *sum);
    memset(weight, 0, (size_t)p->planes * sizeof *weight);
    for (int k = 0; k < count; k++) {
        const float *cost = p->cost + (size_t)around[k] * (size_t)p->planes;
        const int shift = own - label_of(p, planes, around[k]);
        const double pixels = p->m->segments->segments[around[k]].pixels;
        for (int label = shift > 0 ? 0 : -shift; label < p->planes && label + shift < p->planes; label++) {
            sum[label + shift] += pixels * (double)cost[label];
            weight[label + shift] += pixels;
        }
    }
    double least = INFINITY, total = 0, square = 0;
    for (int label = 0; label < p->planes; label++) least = fmin(least, sum[label] / weight[label]);
    for (int label = 0; label < p->planes; label++) {
        const double likely = exp((least - sum[label] / weight[label]) / TEMPERATURE);
        total += likely;
        square += likely * (label - own) * (label - own);
    }
    return sqrt(square / total);
}

struct deviation_job {
    double *deviation;
    const struct plane_problem *p;
    const struct plane *planes;
    const double *before, *agreeing;
    double points, *room; /* room: 2 p->planes numbers for each thread */
};

static void find_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct deviation_job *job = ctx;
    const struct plane_problem *p = job->p;
    double *room = job->room + (size_t)thread * 2 * (size_t)p->planes;
    for (size_t i = begin; i < end; i++) {
        const struct segment *g = &p->m->segments->segments[i];
        const double own = job->before ? job->before[i] * (1 - fmin(job->agreeing[i] / AGREEING, 1))
                                       : MATCHES * deviation_of_matches(p, job->planes, (int)i, room);
        const double steps = sqrt(job->points * job->points + LEAST * LEAST + own * own);
        job->deviation[i] = steps * p->step / plane_at(job->planes[i], g->cx, g->cy);
    }
}

enum status deviation_find(double *deviation, const struct plane_problem *p, const struct plane *planes,
                           const double *before, const double *agreeing, struct err *err)
{
    const size_t room = ((size_t)parallel_threads() * 2 * (size_t)p->planes + 1) * sizeof(double);
    struct deviation_job job = {deviation, p, planes, before, agreeing, 0, malloc(room)};
    if (!job.room)
        err_nomem(err, "matching costs of surfaces", room);
    else if (!deviation_of_points(&job.points, p, planes, err)) {
        job.points *= POINTS;
        parallel_for((size_t)p->m->segments->count, ROWS, find_some, &job);
    }
    free(job.room);
    return err->status;
}
