/* view_depth.c - the chapter of this stage.
 *
 * Thesis 3.5 after Zitnick and Kang (2007): cut the view into small segments of like colour; find each segment's depth by
 * comparing the view with its neighbours at many depths; let touching segments of like colour agree; let views agree,
 * in rounds; split the segments' rims into two colours. In order:
 *   oversegment   SLIC in gamma-encoded opponent colours
 *   given_depth   planes of segments whose depth a user brought: no match can move them, all others go on from them
 *   neighbours    by shared points, angle and scale; the points also bound the depths
 *   plane_sweep   first round: matching cost of every segment at constant depths, smoothed; later rounds begin with the
 *                 planes of the round before
 *   expand        planes of segments, slanted where that explains the pictures better, by expansion moves on one energy
 *   refine        small changes to the same energy
 *   layers        opaque interiors, two-colour rims
 * What differs from the thesis: planes may slant; sparse points of structure from motion count as soft evidence; a round reads what the neighbours
 * had in the round before, never what they have now, so that views run side by side. */
#include "stages/segment_depth/view_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stages/segment_depth/expand.h"
#include "stages/segment_depth/layers.h"
#include "stages/segment_depth/plane_sweep.h"
#include "stages/segment_depth/refine.h"
#include "stages/segment_depth/smooth.h"

#define PARAM_STRUCT struct segment_params
const struct param segment_param_table[] = {SEGMENT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

/* How well pictures tell a segment's depth: the sweep's best cost around `at` against its best elsewhere, for a refined plane would
 * win over an equal one of the sweep. */
static double distinctness(const float *cost, int planes, double at)
{
    const double apart = fmin(3, (planes - 1) / 3.0); /* steps: nearer depths are the same answer */
    float near = MATCH_WORST, rival = MATCH_WORST;
    for (int p = 0; p < planes; p++) {
        float *best = fabs(p - at) > apart ? &rival : &near;
        *best = fminf(*best, cost[p]);
    }
    return fmin(fmax((double)(rival - near) / 0.4, 0), 1);
}

static enum status fill_segments(struct layered_depth *out, const struct plane_problem *p, const struct plane *planes,
                               const double *distinct, struct err *err)
{
    const struct segmentation *s = p->m->segments;
    out->segments = calloc((size_t)s->count + 1, sizeof *out->segments);
    if (!out->segments) return err_nomem(err, "segments", (size_t)s->count * sizeof *out->segments);
    out->segment_count = s->count;
    for (int i = 0; i < s->count; i++) {
        const struct segment *g = &s->segments[i];
        const double inverse = plane_at(planes[i], g->cx, g->cy);
        if (given_depth_has(p->given, i)) {
            out->segments[i] = (struct depth_segment){
                .id = (uint32_t)i + 1,
                .plane = {planes[i].a, planes[i].b, planes[i].c},
                .sigma = (0.5 * p->step + (double)p->given->residual[i]) / inverse,
                .confidence = (double)p->given->quality[i],
            };
            continue;
        }
        unsigned hidden = 0;
        if (p->cross) cross_view_cost(p->cross, i, planes[i], &hidden);
        const double good = fmin(fmax((double)MATCH_WORST - (double)match_cost(p->m, i, planes[i], hidden), 0), 1);
        const double agreeing = p->cross ? cross_view_support(p->cross, i, planes[i]) : 0;
        /* unsure by itself, but two other views say the same: sure */
        const double sure = good * fmax(distinct[i], fmin(agreeing / 2, 1));
        /* a sure segment is right to half a step; an inherited one to a few */
        out->segments[i] = (struct depth_segment){
            .id = (uint32_t)i + 1,
            .plane = {planes[i].a, planes[i].b, planes[i].c},
            .sigma = (0.5 + 2.5 * (1 - sure)) * p->step / inverse,
            .confidence = sure,
        };
    }
    return ST_OK;
}

/* Where down is in the view's axes, if photographers hold cameras upright on average. */
static struct vec3 down_direction(const struct camera_set *set, const struct view *view)
{
    struct vec3 sum = {0, 0, 0};
    for (int i = 0; i < set->view_count; i++) {
        const double *y = set->views[i].cam_from_world.m[1];
        sum = vec3_add(sum, vec3_make(y[0], y[1], y[2]));
    }
    return mat3_apply(view->cam_from_world, vec3_normalize(sum));
}

struct solve {
    const struct camera_set *set;
    int view_idx;
    const int *neighbours;
    int neighbour_count;
    const struct matcher *m;
    const struct image *picture;
    const struct observed_points *seen;
    double least, most;
    float *given; /* z of each pixel, or NULL */
    const struct view_source *source;
    const struct segment_params *params;
};

/* The planes that this view had in the round before, and how distinct they were. */
static enum status planes_before(struct plane *planes, double *distinct, const struct solve *v, struct err *err)
{
    struct layered_depth before = {0};
    enum status st = v->source->read_depth(v->source->ctx, v->view_idx, &before, err);
    if (!st && before.segment_count != v->m->segments->count)
        st = err_set(err, ST_DATA,
                     "the round before has %d segments of view %s, this one %d: it is of another picture or other "
                     "parameters; make it again.",
                     before.segment_count, v->set->views[v->view_idx].name, v->m->segments->count);
    for (int i = 0; !st && i < before.segment_count; i++) {
        const struct depth_segment *g = &before.segments[i];
        planes[i] = (struct plane){g->plane[0], g->plane[1], g->plane[2]};
        distinct[i] = g->confidence;
    }
    layered_depth_release(&before);
    return st;
}

#define OTHER_UNITS 1.1 /* given depth that is so many times off its points' is not meant so */

/* Warns once, in the first round. */
static enum status fit_given(struct given_depth *given, const struct solve *v, double step, struct err *err)
{
    const struct segmentation *s = v->m->segments;
    const char *name = v->set->views[v->view_idx].name;
    if (given_depth_make(given, s, v->given, step, v->params, err)) return err->status;
    const double pixels = (double)s->width * s->height;
    log_note("depth is given for %d of %.0f pixels (%.1f %%) of view %s; it settles %d of %d segments", given->pixels,
             pixels, 100 * given->pixels / pixels, name, given->segments, s->count);
    const double ratio = given_depth_ratio(v->given, s->width, s->height, v->seen);
    if (!v->source->read_depth && ratio > 0 && !(ratio > 1 / OTHER_UNITS && ratio < OTHER_UNITS))
        log_warn(
            "the depth given for view %s is %.4g times that of its sparse points: it seems to be in other units than "
            "the scene. It is used as it is; \"scale\" in depth.txt would bring it there.",
            name, ratio);
    if (v->neighbour_count || given->segments) return ST_OK;
    return err_set(
        err, ST_DATA,
        "view %s has no neighbour to match with, and its given depth is too sparse: no segment has it in an "
        "eighth of its pixels. Give denser depth, larger segments ([segment_depth] segment_pixels), or photos "
        "taken beside this one.",
        name);
}

static enum status solve(struct layered_depth *out, const struct solve *v, struct err *err)
{
    const struct segmentation *s = v->m->segments;
    const struct segment_params *params = v->params;
    struct point_evidence points = {0};
    struct cross_view cross = {0};
    struct plane_sweep sweep = {0};
    struct given_depth given = {0};
    struct plane *planes = malloc(((size_t)s->count + 1) * sizeof *planes);
    double *distinct = calloc((size_t)s->count + 1, sizeof *distinct);
    float *weights = border_weights(s, params->segment_pixels);
    float *matches = malloc(((size_t)s->count + 1) * sizeof *matches);
    const bool first = !v->source->read_depth;
    plane_sweep_steps(&sweep, v->m, v->least, v->most, params);
    if (v->given) sweep.given = &given;
    const struct view *view = &v->set->views[v->view_idx];
    struct plane_problem problem = {.view = view,
                                    .down = down_direction(v->set, view),
                                    .m = v->m,
                                    .points = &points,
                                    .cross = first ? NULL : &cross,
                                    .given = sweep.given,
                                    .weights = weights,
                                    .params = params,
                                    .least = v->least,
                                    .most = v->most,
                                    .step = sweep.step,
                                    .planes = sweep.planes};
    enum status st = planes && distinct && weights && matches ? ST_OK : err_nomem(err, "planes", (size_t)s->count * 40);
    if (!st && v->given) st = fit_given(&given, v, sweep.step, err);
    if (!st) st = point_evidence_make(&points, s, v->seen, v->least, v->most, sweep.step, params, err);
    if (!st && first) {
        st = plane_sweep_run(&sweep, planes, v->m, &points, weights, view, problem.down, params, err);
        problem.cost = sweep.cost;
    } else if (!st) {
        const struct previous_depth_source source = {v->source->read_depth, v->source->ctx};
        st = cross_view_make(&cross, s, v->set, v->view_idx, v->neighbours, v->neighbour_count, sweep.step, &source,
                             err);
        if (!st) st = planes_before(planes, distinct, v, err);
        for (int i = 0; !st && i < s->count; i++) matches[i] = match_cost_rough(v->m, i, planes[i], 0);
        problem.min_match = matches;
        for (int i = 0; !st && i < s->count; i++)
            if (given_depth_has(sweep.given, i)) planes[i] = given.planes[i];
    }
    if (!st) st = expand_planes(planes, &problem, err);
    if (!st) st = refine_planes(planes, &problem, err);
    for (int i = 0; !st && first && i < s->count; i++)
        distinct[i] =
            distinctness(sweep.cost + (size_t)i * (size_t)sweep.planes, sweep.planes,
                         (plane_at(planes[i], s->segments[i].cx, s->segments[i].cy) - sweep.least) / sweep.step);
    if (!st) st = fill_segments(out, &problem, planes, distinct, err);
    if (!st) st = layers_make(out, s, planes, v->picture, sweep.step, !strcmp(params->matte, "two_colour"), err);
    free(planes);
    free(distinct);
    free(weights);
    free(matches);
    cross_view_release(&cross);
    plane_sweep_release(&sweep);
    given_depth_release(&given);
    point_evidence_release(&points);
    return st;
}

static enum status add_neighbour(struct matcher *m, const struct camera_set *set, int view_idx, int neighbour_idx,
                                 const struct view_source *source, const struct observed_points *seen, double typical,
                                 const struct gamma_image *reference, struct err *err)
{
    struct image picture = {0};
    struct gamma_image gamma = {0};
    enum status st = source->read(source->ctx, neighbour_idx, &picture, err);
    if (!st) {
        /* a brighter photo of the same scene must not clip here what it did not clip itself */
        const struct tone own = tone_of(&picture);
        st = gamma_image_make(&gamma, &picture,
                              (struct tone){fmin(reference->tone.exposure, own.exposure), reference->tone.power}, err);
    }
    image_release(&picture);
    if (!st) st = matcher_add(m, set, view_idx, neighbour_idx, seen, typical, reference, &gamma, err);
    gamma_image_release(&gamma);
    return st;
}

/* A view whose depth is given may stand alone. */
static enum status find_neighbours(int neighbours[MAX_NEIGHBOURS], int *count, const struct camera_set *set,
                                   int view_idx, const struct observed_points *seen, const struct segment_params *params,
                                   const float *given, struct err *err)
{
    struct err alone = ERR_INIT;
    const enum status st = neighbours_choose(neighbours, count, set, view_idx, seen, params->neighbours, &alone);
    return st && !(st == ST_DATA && given) ? err_set(err, st, "%s", alone.text) : ST_OK;
}

/* The inverse depths to look at: of the sparse points, of what is given, or of the neighbours' baselines; near and far go first. */
static enum status find_range(struct solve *v, int neighbour_count, size_t pixels, struct err *err)
{
    const struct segment_params *params = v->params;
    bool guessed = false;
    if (neighbour_count &&
        depth_range(&v->least, &v->most, &guessed, v->set, v->view_idx, v->neighbours, neighbour_count, err))
        return err->status;
    if (v->given) given_depth_range(&v->least, &v->most, v->given, pixels);
    if (guessed && params->near > 0) v->least = fmin(v->least, 1 / params->near / 500);
    if (params->far > 0) v->least = 1 / params->far;
    if (params->near > 0) v->most = 1 / params->near;
    if (v->least < v->most) return ST_OK;
    return err_set(err, ST_USAGE, "[segment_depth] near = %g and far = %g leave no depth between them.", 1 / v->most,
                   1 / v->least);
}

enum status view_depth(struct layered_depth *out, int neighbours[MAX_NEIGHBOURS], int *neighbour_count,
                       const struct camera_set *set, int view_idx, const struct view_source *source,
                       const struct segment_params *params, struct err *err)
{
    struct observed_points seen = {0};
    struct image picture = {0};
    struct gamma_image gamma = {0};
    struct segmentation segments = {0};
    struct matcher matcher = {0};
    struct solve v = {.set = set,
                      .view_idx = view_idx,
                      .neighbours = neighbours,
                      .m = &matcher,
                      .picture = &picture,
                      .seen = &seen,
                      .source = source,
                      .params = params};
    *out = (struct layered_depth){0};
    *neighbour_count = 0;
    enum status st = observed_points_find(&seen, set, view_idx, err);
    if (!st && source->read_given) st = source->read_given(source->ctx, view_idx, &v.given, err);
    if (!st) st = find_neighbours(neighbours, neighbour_count, set, view_idx, &seen, params, v.given, err);
    if (!st) st = source->read(source->ctx, view_idx, &picture, err);
    if (!st) st = layered_depth_init(out, picture.width, picture.height, err);
    if (!st) st = find_range(&v, *neighbour_count, (size_t)picture.width * (size_t)picture.height, err);
    if (!st) st = gamma_image_make(&gamma, &picture, tone_of(&picture), err);
    if (!st) st = oversegment(&segments, &gamma, params->segment_pixels, params->compactness, err);
    if (!st) st = matcher_init(&matcher, &segments, &gamma, err);
    for (int k = 0; !st && k < *neighbour_count; k++)
        st =
            add_neighbour(&matcher, set, view_idx, neighbours[k], source, &seen, 0.5 * (v.least + v.most), &gamma, err);
    if (!st) st = matcher_calibrate(&matcher, v.least, v.most, err);
    v.neighbour_count = *neighbour_count;
    if (!st) st = solve(out, &v, err);
    if (st) layered_depth_release(out);
    matcher_release(&matcher);
    segmentation_release(&segments);
    gamma_image_release(&gamma);
    image_release(&picture);
    observed_points_release(&seen);
    free(v.given);
    return st;
}
