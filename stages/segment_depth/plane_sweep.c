/* plane_sweep.c - the first round's start: a plane sweep, smoothed over the segment graph.
 *
 * The depth range is divided into planes evenly spaced in 1/z, about one pixel of disparity apart. At each depth d the
 * cost volume holds
 *   C_i(d) = min(match_cost(z = 1/d), match_cost(plane of a family through the segment at 1/d) + slant)
 * Families are level planes, and planes across the headings of a room's walls where these are known: floors and walls
 * seen at grazing angles match on no plane of constant depth [Furukawa 2009]. With the cost of the sparse
 * points added, and weighted by the segment's size, it is the data cost of smooth_labels(); the label found decides the
 * segment's depth, and its matching costs decide between the constant and the horizontal plane. */
#include "stages/segment_depth/plane_sweep.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "stages/segment_depth/smooth.h"

#define HORIZON 0.03 /* |cosine| between a ray and the vertical below which horizontal planes are not tried */

/* The data cost per step of a segment whose depth is given: high enough that no neighbour moves it. */
#define GIVEN_WEIGHT 10
#define MAX_OFFSET   1e3

struct sweep_job {
    const struct plane_sweep *w;
    const struct view *view;
    const struct plane_families *families;
    const struct matcher *m;
    const struct point_evidence *points;
    const struct segment_params *params;
    float *energy; /* data costs of smooth_labels(), `planes` per segment: cost with points, times size */
    struct progress progress;
};

/* The two planes of a segment at a label. horizontal_plane() returns false if its plane is indistinguishable from the
 * facing one, is seen at too grazing an angle, or leaves the depth range. */
static struct plane facing_plane(const struct plane_sweep *w, int label)
{
    return (struct plane){0, 0, w->min_inverse_z + label * w->step};
}

static bool family_plane(const struct sweep_job *job, const struct segment *g, int label, int family,
                         struct plane *plane)
{
    const struct plane_sweep *w = job->w;
    const struct view *v = job->view;
    const struct vec3 down = job->families->normal[family];
    const double d = w->min_inverse_z + label * w->step, size = sqrt(g->pixels);
    const double cosine = down.x * (g->cx - v->cx) / v->fx + down.y * (g->cy - v->cy) / v->fy + down.z;
    if (!(fabs(cosine) > HORIZON)) return false;
    const double a = d * down.x / (v->fx * cosine), b = d * down.y / (v->fy * cosine), rise = hypot(a, b) / w->step;
    *plane = (struct plane){a, b, d - a * g->cx - b * g->cy};
    const double max_inverse_z = w->min_inverse_z + (w->planes - 1) * w->step;
    return rise * size > 0.5 && rise < 1 && plane_within(*plane, g, w->min_inverse_z, max_inverse_z);
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
        if (given_depth_has(w->given, (int)i)) {
            const double given = plane_at(w->given->planes[i], g->cx, g->cy);
            for (int p = 0; p < w->planes; p++) {
                cost[p] = (float)fmin(fabs(w->min_inverse_z + p * w->step - given) / w->step, MAX_OFFSET);
                energy[p] = GIVEN_WEIGHT * cost[p];
            }
            continue;
        }
        unsigned best = 0;
        for (int p = 0; p < w->planes; p++) {
            const struct plane plane = facing_plane(w, p);
            /* planes are about a pixel apart: the neighbours that match one best match the next one best */
            const bool known = p & 1 && __builtin_popcount(best) == job->m->params->best_neighbours;
            cost[p] = match_cost_sweep(job->m, (int)i, plane, known ? best : ~0u, &best);
            for (int f = 0; f < job->families->count; f++) {
                struct plane slanted;
                /* walls at every second label: the smoothing bridges one, and expansion finds what lies between */
                if ((f && p & 1) || !family_plane(job, g, p, f, &slanted)) continue;
                const float other =
                    match_cost_sweep(job->m, (int)i, slanted, f ? ~0u : best, NULL) + (float)job->params->slant;
                cost[p] = other < cost[p] ? other : cost[p];
            }
            energy[p] = size * (cost[p] + (float)point_evidence_cost(job->points, (int)i, plane, g->cx, g->cy));
        }
    }
    progress_add(&job->progress, (int64_t)(end - begin));
}

static struct plane best_plane(const struct sweep_job *job, int segment, int label)
{
    struct plane best = facing_plane(job->w, label), slanted;
    float lowest = NAN;
    for (int f = 0; f < job->families->count; f++) {
        if (!family_plane(job, &job->m->segments->segments[segment], label, f, &slanted)) continue;
        if (isnan(lowest)) lowest = match_cost(job->m, segment, best, 0);
        const float cost = match_cost(job->m, segment, slanted, 0) + (float)job->params->slant;
        if (!(cost < lowest)) continue;
        lowest = cost;
        best = slanted;
    }
    return best;
}

void plane_sweep_steps(struct plane_sweep *w, const struct matcher *m, double min_inverse_z, double max_inverse_z,
                       const struct segment_params *params)
{
    w->planes = (int)fmin(fmax(ceil(match_shift(m, min_inverse_z, max_inverse_z)) + 1, 4), params->planes);
    if (!m->neighbour_count) w->planes = params->planes;
    w->step = (max_inverse_z - min_inverse_z) / (w->planes - 1);
    w->min_inverse_z = min_inverse_z;
}

enum status plane_sweep_run(struct plane_sweep *w, struct plane *plane, const struct matcher *m,
                            const struct point_evidence *points, const float *weights, const struct view *view,
                            const struct plane_families *families, const struct segment_params *params, struct err *err)
{
    const struct segmentation *s = m->segments;
    struct sweep_job job = {.w = w, .view = view, .families = families, .m = m, .points = points, .params = params};
    const size_t costs = (size_t)s->count * (size_t)w->planes + 1;
    int *labels = malloc(((size_t)s->count + 1) * sizeof *labels);
    w->cost = malloc(costs * sizeof *w->cost);
    job.energy = malloc(costs * sizeof *job.energy);
    if (!labels || !w->cost || !job.energy) err_nomem(err, "matching costs", costs * 2 * sizeof(float));
    if (!err->status) {
        progress_start(&job.progress, "plane sweep", s->count, "segments");
        parallel_for((size_t)s->count, 32, sweep_segments, &job);
        progress_end(&job.progress);
        smooth_labels(labels, s, job.energy, w->planes, weights, (float)(params->smoothness / params->jump),
                      (float)params->smoothness, err);
    }
    for (int i = 0; !err->status && i < s->count; i++)
        plane[i] = given_depth_has(w->given, i) ? w->given->planes[i] : best_plane(&job, i, labels[i]);
    free(labels);
    free(job.energy);
    return err->status;
}

void plane_sweep_release(struct plane_sweep *w)
{
    if (!w) return;
    free(w->cost);
    *w = (struct plane_sweep){0};
}
