/* view_depth.c - the chapter of this stage.
 *
 * Thesis 3.5 after Zitnick and Kang (2007): cut the view into small segments of like colour; find each segment's depth by
 * comparing the view with its neighbours at many depths; let touching segments of like colour agree; split the
 * segments' rims into two colours. In order:
 *   oversegment   SLIC in gamma-encoded opponent colours
 *   neighbours    by shared points, angle and scale; the points also bound the depths
 *   sweep         matching cost of every segment at planes z = const, evenly spaced in 1/z, a step about one pixel
 *   smooth        tree-reweighted message passing over the segments
 *   refine        a plane a segment, slanted where that explains the pictures better
 *   layers        opaque interiors, two-colour rims
 * What differs from the thesis: planes may slant; sparse points of structure from motion count as soft evidence; each view
 * stands alone (its neighbours' pictures are read, their depths are not), so that views run side by side. */
#include "stages/segment_depth/view_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/parallel.h"
#include "common/progress.h"
#include "stages/segment_depth/layers.h"
#include "stages/segment_depth/refine.h"
#include "stages/segment_depth/smooth.h"

#define PARAM_STRUCT struct segment_params
const struct param segment_param_table[] = {SEGMENT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define HORIZON 0.03 /* |cosine| between a ray and the horizontal below which horizontal planes are not tried */

struct sweep {
    const struct view *view;
    struct vec3 down; /* in the view's axes */
    const struct matcher *m;
    const struct point_evidence *points;
    const struct segment_params *params;
    double least, most, step; /* of 1/z */
    int planes;
    float *cost;   /* planes a segment: matching alone */
    float *energy; /* planes a segment: with points, weighted by size */
    struct progress progress;
};

/* A segment's plane at a label: facing the camera, or else horizontal, which is how floors and ceilings lie. False if
 * the two are the same to the pictures, or the horizontal one is seen at too grazing an angle, or leaves the depths. */
static struct plane facing_plane(const struct sweep *w, int label)
{
    return (struct plane){0, 0, w->least + label * w->step};
}

static bool horizontal_plane(const struct sweep *w, const struct segment *g, int label, struct plane *plane)
{
    const struct view *v = w->view;
    double d = w->least + label * w->step, size = sqrt(g->pixels);
    double cosine = w->down.x * (g->cx - v->cx) / v->fx + w->down.y * (g->cy - v->cy) / v->fy + w->down.z;
    if (!(fabs(cosine) > HORIZON)) return false;
    double a = d * w->down.x / (v->fx * cosine), b = d * w->down.y / (v->fy * cosine), rise = hypot(a, b) / w->step;
    *plane = (struct plane){a, b, d - a * g->cx - b * g->cy};
    return rise * size > 0.5 && rise < 1 && plane_keeps_to(*plane, g, PLANE_LEAST * w->least, PLANE_MOST * w->most);
}

static void sweep_segments(void *ctx, size_t begin, size_t end, int thread)
{
    struct sweep *w = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        float *cost = w->cost + i * (size_t)w->planes, *energy = w->energy + i * (size_t)w->planes;
        const struct segment *g = &w->m->segments->segments[i];
        float weight = (float)g->pixels / (float)w->params->segment_pixels;
        for (int p = 0; p < w->planes; p++) {
            struct plane plane = facing_plane(w, p), tilted;
            cost[p] = match_cost_half(w->m, (int)i, plane);
            if (horizontal_plane(w, g, p, &tilted)) {
                float other = match_cost_half(w->m, (int)i, tilted) + (float)w->params->slant;
                cost[p] = other < cost[p] ? other : cost[p];
            }
            energy[p] = weight * (cost[p] + (float)point_evidence_cost(w->points, (int)i, plane, g->cx, g->cy));
        }
    }
    progress_add(&w->progress, (int64_t)(end - begin));
}

static struct plane better_plane(const struct sweep *w, int segment, int label)
{
    struct plane facing = facing_plane(w, label), tilted;
    if (!horizontal_plane(w, &w->m->segments->segments[segment], label, &tilted)) return facing;
    float slant = (float)w->params->slant;
    return match_cost(w->m, segment, tilted) + slant < match_cost(w->m, segment, facing) ? tilted : facing;
}

/* How sure a segment's depth is: the sweep's best cost around `at` against its best elsewhere, for a refined plane would
 * win over an equal one of the sweep; and the final cost against a hopeless match. */
static double confidence_of(const float *cost, int planes, double at, float chosen)
{
    double apart = fmin(3, (planes - 1) / 3.0); /* steps: nearer depths are the same answer */
    float near = 1, rival = 1;
    for (int p = 0; p < planes; p++) {
        float *best = fabs(p - at) > apart ? &rival : &near;
        *best = fminf(*best, cost[p]);
    }
    double distinct = (double)(rival - near) / 0.12, good = (0.7 - (double)chosen) / 0.3;
    return fmin(fmax(distinct, 0), 1) * fmin(fmax(good, 0), 1);
}

static enum status list_depths(struct layered_depth *out, const struct sweep *w, const struct plane *planes,
                               struct err *err)
{
    const struct segmentation *s = w->m->segments;
    out->segments = calloc((size_t)s->count + 1, sizeof *out->segments);
    if (!out->segments) return err_nomem(err, "segments", (size_t)s->count * sizeof *out->segments);
    out->segment_count = s->count;
    for (int i = 0; i < s->count; i++) {
        const struct segment *g = &s->segments[i];
        double inverse = plane_at(planes[i], g->cx, g->cy);
        float chosen = match_cost(w->m, i, planes[i]);
        double sure =
            confidence_of(w->cost + (size_t)i * (size_t)w->planes, w->planes, (inverse - w->least) / w->step, chosen);
        /* a sure segment is right to half a step; an inherited one to a few */
        out->segments[i] = (struct depth_segment){
            .id = (uint32_t)i + 1,
            .plane = {planes[i].a, planes[i].b, planes[i].c},
            .sigma = (0.5 + 2.5 * (1 - sure)) * w->step / inverse,
            .confidence = sure,
        };
    }
    return ST_OK;
}

/* Where down is in the view's axes, if photographers hold cameras upright on average. */
static struct vec3 find_down(const struct camera_set *set, const struct view *view)
{
    struct vec3 sum = {0, 0, 0};
    for (int i = 0; i < set->view_count; i++) {
        const double *y = set->views[i].cam_from_world.m[1];
        sum = vec3_add(sum, vec3_make(y[0], y[1], y[2]));
    }
    return mat3_apply(view->cam_from_world, vec3_normalize(sum));
}

static enum status solve(struct layered_depth *out, const struct camera_set *set, const struct view *view,
                         const struct matcher *m, const struct image *picture, const struct seen_points *seen,
                         double least, double most, const struct segment_params *params, struct err *err)
{
    const struct segmentation *s = m->segments;
    double shift = matcher_shift(m, least, most);
    struct point_evidence points = {0};
    struct sweep w = {.view = view, .m = m, .points = &points, .params = params, .least = least, .most = most};
    w.down = find_down(set, view);
    struct plane *planes = malloc(((size_t)s->count + 1) * sizeof *planes);
    int *labels = malloc(((size_t)s->count + 1) * sizeof *labels);
    float *weights = touch_weights(s, params->segment_pixels);
    w.planes = (int)fmin(fmax(ceil(shift) + 1, 4), params->planes);
    w.step = (most - least) / (w.planes - 1);
    size_t costs = (size_t)s->count * (size_t)w.planes + 1;
    w.cost = malloc(costs * sizeof *w.cost);
    w.energy = malloc(costs * sizeof *w.energy);
    enum status st = point_evidence_make(&points, s, seen, least, most, w.step, params, err);
    if (!st && !(planes && labels && weights && w.cost && w.energy))
        st = err_nomem(err, "matching costs", costs * 2 * sizeof *w.cost);
    if (!st) {
        progress_start(&w.progress, "plane sweep", s->count, "segments");
        parallel_for((size_t)s->count, 32, sweep_segments, &w);
        progress_end(&w.progress);
        st = smooth_labels(labels, s, w.energy, w.planes, weights, (float)(params->smoothness / params->jump),
                           (float)params->smoothness, err);
    }
    if (!st) {
        for (int i = 0; i < s->count; i++) planes[i] = better_plane(&w, i, labels[i]);
        st = refine_planes(planes, m, &points, weights, params, err);
    }
    if (!st) st = list_depths(out, &w, planes, err);
    if (!st) st = layers_make(out, s, planes, picture, w.step, !strcmp(params->matte, "two_colour"), err);
    free(planes);
    free(labels);
    free(weights);
    free(w.cost);
    free(w.energy);
    point_evidence_release(&points);
    return st;
}

static enum status add_neighbour(struct matcher *m, const struct camera_set *set, int view_idx, int neighbour_idx,
                                 const struct view_source *source, const struct seen_points *seen, double typical,
                                 const struct gamma_image *reference, struct err *err)
{
    struct image picture = {0};
    struct gamma_image gamma = {0};
    enum status st = source->read(source->ctx, neighbour_idx, &picture, err);
    /* a brighter photo of the same scene must not clip here what it did not clip itself */
    if (!st) st = gamma_image_make(&gamma, &picture, fmin(reference->exposure, exposure_of(&picture)), err);
    image_release(&picture);
    if (!st) st = matcher_add(m, set, view_idx, neighbour_idx, seen, typical, reference, &gamma, err);
    gamma_image_release(&gamma);
    return st;
}

enum status view_depth(struct layered_depth *out, int neighbours[MAX_NEIGHBOURS], int *neighbour_count,
                       const struct camera_set *set, int view_idx, const struct view_source *source,
                       const struct segment_params *params, struct err *err)
{
    struct seen_points seen = {0};
    struct image picture = {0};
    struct gamma_image gamma = {0};
    struct segmentation segments = {0};
    struct matcher matcher = {0};
    double least = 0, most = 0;
    *out = (struct layered_depth){0};
    *neighbour_count = 0;
    enum status st = seen_points_find(&seen, set, view_idx, err);
    if (!st) st = neighbours_choose(neighbours, neighbour_count, set, view_idx, &seen, params->neighbours, err);
    if (!st) st = source->read(source->ctx, view_idx, &picture, err);
    if (!st) st = layered_depth_init(out, picture.width, picture.height, err);
    if (!st) st = depth_range(&least, &most, set, view_idx, &seen, neighbours, *neighbour_count, err);
    if (!st) st = gamma_image_make(&gamma, &picture, exposure_of(&picture), err);
    if (!st) st = oversegment(&segments, &gamma, params->segment_pixels, params->compactness, err);
    if (!st) st = matcher_init(&matcher, &segments, &gamma, err);
    for (int k = 0; !st && k < *neighbour_count; k++)
        st = add_neighbour(&matcher, set, view_idx, neighbours[k], source, &seen, 0.5 * (least + most), &gamma, err);
    if (!st) st = solve(out, set, &set->views[view_idx], &matcher, &picture, &seen, least, most, params, err);
    if (st) layered_depth_release(out);
    matcher_release(&matcher);
    segmentation_release(&segments);
    gamma_image_release(&gamma);
    image_release(&picture);
    seen_points_release(&seen);
    return st;
}
