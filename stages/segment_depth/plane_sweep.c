/* plane_sweep.c - see plane_sweep.h. */
#include "stages/segment_depth/plane_sweep.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "stages/segment_depth/smooth.h"

#define HORIZON 0.03 /* |cosine| between a ray and the horizontal below which horizontal planes are not tried */

/* Segments of given depth stay at the label nearest to it, whatever those that they touch want. */
#define GIVEN_WEIGHT 10
#define MOST_OFF     1e3

struct sweep_job {
    const struct plane_sweep *w;
    const struct view *view;
    struct vec3 down; /* in the view's axes */
    const struct matcher *m;
    const struct point_evidence *points;
    const struct segment_params *params;
    float *energy; /* planes a segment: with points, weighted by size */
    struct progress progress;
};

/* A segment's plane at a label: facing the camera, or else horizontal. The second returns false if the two are the same to
 * the pictures, or the horizontal one is seen at too grazing an angle, or leaves the depths. */
static struct plane facing_plane(const struct plane_sweep *w, int label)
{
    return (struct plane){0, 0, w->least + label * w->step};
}

static bool horizontal_plane(const struct sweep_job *job, const struct segment *g, int label, struct plane *plane)
{
    const struct plane_sweep *w = job->w;
    const struct view *v = job->view;
    const struct vec3 down = job->down;
    const double d = w->least + label * w->step, size = sqrt(g->pixels);
    const double cosine = down.x * (g->cx - v->cx) / v->fx + down.y * (g->cy - v->cy) / v->fy + down.z;
    if (!(fabs(cosine) > HORIZON)) return false;
    const double a = d * down.x / (v->fx * cosine), b = d * down.y / (v->fy * cosine), rise = hypot(a, b) / w->step;
    *plane = (struct plane){a, b, d - a * g->cx - b * g->cy};
    const double most = w->least + (w->planes - 1) * w->step;
    return rise * size > 0.5 && rise < 1 && plane_keeps_to(*plane, g, w->least, most);
}

static void sweep_segments(void *ctx, size_t begin, size_t end, int thread)
{
    struct sweep_job *job = ctx;
    const struct plane_sweep *w = job->w;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        float *cost = w->cost + i * (size_t)w->planes, *energy = job->energy + i * (size_t)w->planes;
        const struct segment *g = &job->m->segments->segments[i];
        const float size = (float)g->pixels / (float)job->params->segment_pixels;
        if (given_depth_knows(w->given, (int)i)) {
            const double given = plane_at(w->given->planes[i], g->cx, g->cy);
            for (int p = 0; p < w->planes; p++) {
                cost[p] = (float)fmin(fabs(w->least + p * w->step - given) / w->step, MOST_OFF);
                energy[p] = GIVEN_WEIGHT * cost[p];
            }
            continue;
        }
        for (int p = 0; p < w->planes; p++) {
            const struct plane plane = facing_plane(w, p);
            struct plane tilted;
            cost[p] = match_cost_rough(job->m, (int)i, plane, 0);
            if (horizontal_plane(job, g, p, &tilted)) {
                const float other = match_cost_rough(job->m, (int)i, tilted, 0) + (float)job->params->slant;
                cost[p] = other < cost[p] ? other : cost[p];
            }
            energy[p] = size * (cost[p] + (float)point_evidence_cost(job->points, (int)i, plane, g->cx, g->cy));
        }
    }
    progress_add(&job->progress, (int64_t)(end - begin));
}

static struct plane better_plane(const struct sweep_job *job, int segment, int label)
{
    const struct plane facing = facing_plane(job->w, label);
    struct plane tilted;
    if (!horizontal_plane(job, &job->m->segments->segments[segment], label, &tilted)) return facing;
    const float slant = (float)job->params->slant;
    return match_cost(job->m, segment, tilted, 0) + slant < match_cost(job->m, segment, facing, 0) ? tilted : facing;
}

void plane_sweep_steps(struct plane_sweep *w, const struct matcher *m, double least, double most,
                       const struct segment_params *params)
{
    w->planes = (int)fmin(fmax(ceil(matcher_shift(m, least, most)) + 1, 4), params->planes);
    if (!m->neighbour_count) w->planes = params->planes;
    w->step = (most - least) / (w->planes - 1);
    w->least = least;
}

enum status plane_sweep_run(struct plane_sweep *w, struct plane *plane, const struct matcher *m,
                            const struct point_evidence *points, const float *weights, const struct view *view,
                            struct vec3 down, const struct segment_params *params, struct err *err)
{
    const struct segmentation *s = m->segments;
    struct sweep_job job = {.w = w, .view = view, .down = down, .m = m, .points = points, .params = params};
    const size_t costs = (size_t)s->count * (size_t)w->planes + 1;
    int *labels = malloc(((size_t)s->count + 1) * sizeof *labels);
    w->cost = malloc(costs * sizeof *w->cost);
    job.energy = malloc(costs * sizeof *job.energy);
    enum status st =
        labels && w->cost && job.energy ? ST_OK : err_nomem(err, "matching costs", costs * 2 * sizeof(float));
    if (!st) {
        progress_start(&job.progress, "plane sweep", s->count, "segments");
        parallel_for((size_t)s->count, 32, sweep_segments, &job);
        progress_end(&job.progress);
        st = smooth_labels(labels, s, job.energy, w->planes, weights, (float)(params->smoothness / params->jump),
                           (float)params->smoothness, err);
    }
    for (int i = 0; !st && i < s->count; i++)
        plane[i] = given_depth_knows(w->given, i) ? w->given->planes[i] : better_plane(&job, i, labels[i]);
    free(labels);
    free(job.energy);
    return st;
}

void plane_sweep_release(struct plane_sweep *w)
{
    if (!w) return;
    free(w->cost);
    *w = (struct plane_sweep){0};
}
