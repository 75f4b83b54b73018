/* view_depth.c - depth of a view by multi-view segment matching [Colburn 2014, 3.5] [Zitnick 2007].
 *
 * The view is divided into small segments of similar colour. Each gets a plane that minimizes an energy of matching
 * costs with the neighbouring views, evidence of sparse points, smoothness between similar segments, and consistency
 * with the neighbours' depth maps; pixels at depth edges are split into two colours. The steps, in order:
 *   neighbours    views to match with, by shared points, angle and scale; the points also bound the depth range
 *   oversegment   SLIC superpixels in gamma-encoded opponent colours
 *   frame_prior   floor, ceiling and walls that straight edges show, where the view's rays meet them; or
 *   model_prior   the same of the faces of the solid model, in the round that knows it
 *   given_depth   fixed planes of the segments whose depth the user provides
 *   furniture_sweep  tables and fronts that depth missed, before the faces, in the round that knows the model
 *   plane_sweep   first round: cost volume over the depth range, smoothed; later rounds start from the previous planes
 *   gravity       which way is down, from cameras and walls; and the ground, at the feet of what stands on it
 *   expand        expansion moves: minimum cuts over planes, slanted where that explains the pictures better; the
 *                 scene's dominant planes are offered to the whole view, and fitted to what takes them
 *   refine        local search with the same energy
 *   inherit       border areas that nothing holds where they are take over what is beside them
 *   before_model  what stands before the solid model without evidence takes its depth, in the round that knows it
 *   depth_deviation  how far off each segment's depth may be
 *   pixel_planes  each pixel chooses among the planes around it
 *   layers        opaque interiors, and mattes at depth edges
 *
 * The first round of a large view may work in half the size of the pictures (level.h), up to `inherit`; then each pixel
 * of the full size chooses. That takes little more than half of the time, and blank walls match better.
 *
 * Rounds after the first have smaller segments: they begin on good planes, so that these need few moves.
 *
 * What differs from the sources: planes may be slanted; sparse points are soft evidence; a round reads the neighbours'
 * depth of the previous round only, so that views are processed in parallel. */
#include "stages/segment_depth/view_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/capture/upright.h"
#include "common/layers/depth_sigma.h"
#include "common/math/numbers.h"
#include "stages/segment_depth/before_model.h"
#include "stages/segment_depth/depth_deviation.h"
#include "stages/segment_depth/expand.h"
#include "stages/segment_depth/frame_prior.h"
#include "stages/segment_depth/furniture_sweep.h"
#include "stages/segment_depth/gravity.h"
#include "stages/segment_depth/inherit.h"
#include "stages/segment_depth/layers.h"
#include "stages/segment_depth/level.h"
#include "stages/segment_depth/model_prior.h"
#include "stages/segment_depth/pixel_planes.h"
#include "stages/segment_depth/plane_sweep.h"
#include "stages/segment_depth/refine_planes.h"
#include "stages/segment_depth/smooth.h"

#define PARAM_STRUCT struct segment_params
const struct param segment_param_table[] = {SEGMENT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

/* How distinct the minimum of a segment's matching cost at label `at` is, 0 .. 1: the sweep's minimum near `at` against
 * its minimum elsewhere. The refined plane's own cost is not used, since it is below that of an equal plane of the
 * sweep. */
static double distinctness(const float *cost, int planes, double at)
{
    const double apart = fmin(3, (planes - 1) / 3.0); /* steps: closer minima are the same one */
    float near = MATCH_WORST, rival = MATCH_WORST;
    for (int p = 0; p < planes; p++) {
        float *best = fabs(p - at) > apart ? &rival : &near;
        *best = fminf(*best, cost[p]);
    }
    return clamp((double)(rival - near) / 0.4, 0, 1);
}

/* The same of the minimum of all labels. */
static double sweep_distinctness(const struct plane_sweep *w, int segment)
{
    const float *cost = w->cost + (size_t)segment * (size_t)w->planes;
    int best = 0;
    for (int p = 1; p < w->planes; p++)
        if (cost[p] < cost[best]) best = p;
    return distinctness(cost, w->planes, best) * clamp(1.33 - (double)cost[best], 0, 1);
}

/* Standard deviation of a confident and of an inherited depth. */
#define SURE_STEPS   0.5
#define UNSURE_STEPS 3.0

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
        unsigned occluded = 0;
        if (p->cross) cross_view_cost(p->cross, i, planes[i], &occluded);
        float match = MATCH_WORST;
        const bool seen = match_evidence(p->m, i, planes[i], occluded, &match) > 0;
        const double good = clamp((double)(MATCH_WORST - match), 0, 1);
        const double agreeing = p->cross ? cross_view_support(p->cross, i, planes[i]) : 0;
        /* the agreement of two other views replaces distinctness; where no view sees the segment, only points count */
        const double confidence =
            seen ? good * fmax(distinct[i], fmin(agreeing / 2, 1)) : point_evidence_support(p->points, i, planes[i]);
        out->segments[i] = (struct depth_segment){
            .id = (uint32_t)i + 1,
            .plane = {planes[i].a, planes[i].b, planes[i].c},
            .sigma = (SURE_STEPS + (UNSURE_STEPS - SURE_STEPS) * (1 - confidence)) * p->step / inverse,
            .confidence = confidence,
        };
    }
    return ST_OK;
}

struct solver {
    const struct camera_set *set;
    int view_idx;
    const int *neighbours;
    int neighbour_count;
    struct matcher *m;
    const struct image *picture;
    const struct observed_points *seen;
    double min_inverse_z, max_inverse_z;
    float *given;         /* z of each pixel, or NULL */
    struct matcher *full; /* the same segments in pictures of twice the size, where pixels choose; or NULL */
    const struct view_source *source;
    const struct segment_params *params;
};

/* The planes of this view in the previous round, whose segments may be others, at the middle pixel of each segment;
 * their confidence as distinctness; and their deviations, as inverse depths. */
static enum status read_previous_planes(struct plane *planes, double *distinct, double *deviation,
                                        const struct solver *v, struct err *err)
{
    struct layered_depth before = {0};
    v->source->read_depth(v->source->ctx, v->view_idx, &before, err);
    const struct segmentation *s = v->m->segments;
    if (!err->status && (before.width != s->width || before.height != s->height))
        err_set(err, ST_DATA,
                "the previous round of view %s has %d x %d pixels, but its picture has %d x %d: the picture has "
                "changed since; make the previous round again.",
                v->set->views[v->view_idx].name, before.width, before.height, s->width, s->height);
    for (int i = 0; !err->status && i < s->count; i++) {
        const uint32_t id = before.interior.id[s->pixel[s->segments[i].first + s->segments[i].pixels / 2]];
        planes[i] = (struct plane){0, 0, 0.5 * (v->min_inverse_z + v->max_inverse_z)};
        if (!id) continue; /* the view had no pixel there */
        const struct depth_segment *g = &before.segments[id - 1];
        planes[i] = (struct plane){g->plane[0], g->plane[1], g->plane[2]};
        distinct[i] = g->confidence;
        deviation[i] = depth_sigma(g) * plane_at(planes[i], s->segments[i].cx, s->segments[i].cy);
    }
    layered_depth_release(&before);
    return err->status;
}

#define MAX_UNIT_RATIO 1.1 /* of given depth to the sparse points', either way, without a warning */

/* Warns of other units in the first round only. */
static enum status fit_given(struct given_depth *given, const struct solver *v, double step, struct err *err)
{
    const struct segmentation *s = v->m->segments;
    const char *name = v->set->views[v->view_idx].name;
    if (given_depth_make(given, s, v->given, step, v->params, err)) return err->status;
    const double pixels = (double)s->width * s->height;
    log_note("depth is given for %d of %.0f pixels (%.1f %%) of view %s; it fixes %d of %d segments", given->pixels,
             pixels, 100 * given->pixels / pixels, name, given->segments, s->count);
    const double ratio = given_depth_ratio(v->given, s->width, s->height, v->seen);
    if (!v->source->read_depth && ratio > 0 && !(ratio > 1 / MAX_UNIT_RATIO && ratio < MAX_UNIT_RATIO))
        log_warn("the depth given for view %s is %.4g times that of its sparse points, so it seems to be in other "
                 "units than "
                 "the scene. It is used unchanged; set \"scale\" in depth.txt to convert it.",
                 name, ratio);
    if (v->neighbour_count || given->segments) return ST_OK;
    return err_set(
        err, ST_DATA,
        "view %s has no neighbour to match with, and its given depth is too sparse: it covers an eighth of the pixels "
        "of no segment. Give denser depth, larger segments ([segment_depth] segment_pixels), or photos taken beside "
        "this one.",
        name);
}

/* The planes of all segments while they are being found, and the terms of their energy. */
struct solution {
    struct plane_problem problem;
    struct point_evidence points;
    struct cross_view cross;
    struct plane_sweep sweep;
    struct given_depth given;
    struct scene_planes scene;
    struct plane_families families;
    struct plane_prior prior;
    double trust; /* in what straight edges say */
    struct plane ground;
    struct plane *planes;
    double *distinct;  /* of each segment: distinctness() in the first round */
    double *deviation; /* of each segment, of inverse depth: in the previous round, if there is one */
    struct furniture_planes furniture;
    struct plane *found; /* of each segment: the plane of furniture_sweep_find(); all zero: none */
    float *weights, *min_match;
};

/* The scene's ground as the view sees it. */
static enum status find_ground(struct solution *x, const struct solver *v, struct err *err)
{
    const struct view *view = &v->set->views[v->view_idx];
    struct ground ground;
    struct vec3 down;
    bool found;
    gravity_find(&down, &found, v->set, v->source->ups, err);
    if (!err->status && found) gravity_find_ground(&ground, &found, v->set, down, err);
    if (err->status || !found) return err->status;
    const double height = ground.offset - vec3_dot(ground.down, view->center);
    x->ground = plane_of_normal(view, vec3_scale(mat3_apply(view->cam_from_world, ground.down), 1 / height));
    x->problem.ground = &x->ground;
    return ST_OK;
}

/* Initial planes by a plane sweep. */
static enum status start_first_round(struct solution *x, const struct solver *v, struct err *err)
{
    plane_sweep_run(&x->sweep, x->planes, v->m, &x->points, x->weights, x->problem.view, &x->families, v->params, err);
    x->problem.cost = x->sweep.cost;
    for (int i = 0; !err->status && i < v->m->segments->count; i++) x->distinct[i] = sweep_distinctness(&x->sweep, i);
    if (!err->status) frame_prior_weigh(&x->prior, x->trust, x->distinct, v->m->segments);
    if (!err->status) match_select(v->m, x->planes, NULL, err);
    return err->status;
}

/* Initial planes of the previous round, with the neighbours' depths of that round as further evidence. */
static enum status start_later_round(struct solution *x, const struct solver *v, struct err *err)
{
    const struct segmentation *s = v->m->segments;
    const struct previous_depth_source source = {v->source->read_depth, v->source->ctx};
    x->problem.cross = &x->cross;
    if (!cross_view_make(&x->cross, s, v->set, v->view_idx, v->neighbours, v->neighbour_count, x->sweep.step, &source,
                         err))
        read_previous_planes(x->planes, x->distinct, x->deviation, v, err);
    if (v->source->model)
        x->problem.max_inverse_z = fmax(x->problem.max_inverse_z, furniture_sweep_nearest(&x->problem));
    if (!err->status && v->source->model)
        furniture_sweep_find(x->planes, x->distinct, x->found, &x->furniture, &x->problem, err);
    x->problem.furniture = &x->furniture;
    if (!err->status && v->source->model)
        model_prior_weigh(&x->prior, v->params->model_gain, x->distinct, s);
    else if (!err->status)
        frame_prior_weigh(&x->prior, x->trust, x->distinct, s);
    unsigned *occluded = calloc((size_t)s->count + 1, sizeof *occluded);
    if (!err->status && !occluded) err_nomem(err, "occlusions", (size_t)s->count * sizeof *occluded);
    for (int i = 0; !err->status && i < s->count; i++) cross_view_cost(&x->cross, i, x->planes[i], &occluded[i]);
    if (!err->status) match_select(v->m, x->planes, occluded, err);
    free(occluded);
    for (int i = 0; !err->status && i < s->count; i++) x->min_match[i] = match_cost_rough(v->m, i, x->planes[i], 0);
    x->problem.min_match = x->min_match;
    for (int i = 0; !err->status && i < s->count; i++)
        if (given_depth_has(x->sweep.given, i)) x->planes[i] = x->given.planes[i];
    return err->status;
}

/* What is known of the room: the model's faces, in the round that knows it; before, what straight edges show. */
static enum status make_prior(struct plane_prior *prior, const struct solver *v, struct err *err)
{
    const struct view *view = &v->set->views[v->view_idx];
    struct view_trace trace = {0};
    if (!v->source->model) return frame_prior_make(prior, v->source->frame, view, v->m->segments, err);
    if (!view_trace(&trace, v->source->model, v->source->axes, view, err))
        model_prior_make(prior, &trace, v->source->axes->scale, view, v->m->segments, err);
    view_trace_release(&trace);
    return err->status;
}

static enum status start_solution(struct solution *x, const struct solver *v, struct err *err)
{
    const struct segmentation *s = v->m->segments;
    const struct view *view = &v->set->views[v->view_idx];
    const struct vec3 down = vec3_scale(upright_mean(v->set, v->source->ups), -1);
    const size_t count = (size_t)s->count + 1;
    x->planes = malloc(count * sizeof *x->planes);
    x->distinct = calloc(count, sizeof *x->distinct);
    x->deviation = calloc(count, sizeof *x->deviation);
    x->weights = smooth_border_weights(s, v->params->segment_pixels);
    x->min_match = malloc(count * sizeof *x->min_match);
    x->found = calloc(count, sizeof *x->found);
    if (!x->planes || !x->distinct || !x->deviation || !x->found || !x->weights || !x->min_match)
        return err_nomem(err, "planes", (size_t)s->count * 48);
    plane_sweep_steps(&x->sweep, v->m, v->min_inverse_z, v->max_inverse_z, v->params);
    if (v->given) x->sweep.given = &x->given;
    x->problem = (struct plane_problem){.view = view,
                                        .down = mat3_apply(view->cam_from_world, down),
                                        .m = v->m,
                                        .points = &x->points,
                                        .given = x->sweep.given,
                                        .scene = &x->scene,
                                        .weights = x->weights,
                                        .params = v->params,
                                        .slant = problem_slant(v->params),
                                        .min_inverse_z = v->min_inverse_z,
                                        .max_inverse_z = v->max_inverse_z,
                                        .step = x->sweep.step,
                                        .planes = x->sweep.planes};
    x->families = (struct plane_families){{x->problem.down}, 1};
    if (v->source->frame && v->source->frame->known) {
        const struct room_frame *f = v->source->frame;
        x->problem.down = x->families.normal[0] = mat3_apply(view->cam_from_world, vec3_scale(f->up, -1));
        for (int k = 0; k < f->heading_count && x->families.count < MAX_FAMILIES; k++)
            x->families.normal[x->families.count++] = mat3_apply(view->cam_from_world, frame_across(f, k));
    }
    if (room_frame_trust(&x->trust, &v->set->model, err) || make_prior(&x->prior, v, err)) return err->status;
    x->problem.prior = x->prior.count ? &x->prior : NULL;
    x->problem.families = &x->families;
    if (v->given) fit_given(&x->given, v, x->sweep.step, err);
    if (!err->status && !find_ground(x, v, err))
        point_evidence_make(&x->points, s, v->seen, v->min_inverse_z, v->max_inverse_z, x->sweep.step, v->params, err);
    if (err->status) return err->status;
    return v->source->read_depth ? start_later_round(x, v, err) : start_first_round(x, v, err);
}

static void solution_release(struct solution *x)
{
    free(x->planes);
    free(x->distinct);
    free(x->deviation);
    free(x->found);
    free(x->weights);
    free(x->min_match);
    cross_view_release(&x->cross);
    plane_prior_release(&x->prior);
    plane_sweep_release(&x->sweep);
    given_depth_release(&x->given);
    point_evidence_release(&x->points);
}

/* Gives border areas that nothing holds the planes beside them, and what stands before the model without evidence the
 * model's depth, both without confidence. */
static enum status inherit(struct layered_depth *out, struct plane *planes, const struct plane_problem *p,
                           bool cautious, const struct plane *found, struct err *err)
{
    const size_t count = (size_t)out->segment_count + 1;
    double *confidence = malloc(count * sizeof *confidence);
    bool *inherited = calloc(count, sizeof *inherited);
    if (!confidence || !inherited) err_nomem(err, "confidences", count * sizeof *confidence);
    for (int i = 0; !err->status && i < out->segment_count; i++) confidence[i] = out->segments[i].confidence;
    if (!err->status) inherit_planes(planes, inherited, confidence, p, cautious, err);
    if (!err->status && found) before_model_settle(planes, inherited, confidence, found, p, err);
    for (int i = 0; !err->status && i < out->segment_count; i++)
        if (inherited[i]) {
            struct depth_segment *g = &out->segments[i];
            *g = (struct depth_segment){g->id, g->pixels, {planes[i].a, planes[i].b, planes[i].c}, 0, 0, 0};
            g->sigma = UNSURE_STEPS * p->step /
                       plane_at(planes[i], p->m->segments->segments[i].cx, p->m->segments->segments[i].cy);
        }
    free(confidence);
    free(inherited);
    return err->status;
}

/* States how far off each segment's depth may be. Given depth keeps what its residuals say. */
static enum status state_deviations(struct layered_depth *out, struct solution *x, struct err *err)
{
    const struct plane_problem *p = &x->problem;
    const int count = out->segment_count;
    double *agreeing = calloc((size_t)count + 1, sizeof *agreeing);
    double *found = calloc((size_t)count + 1, sizeof *found);
    if (!agreeing || !found) err_nomem(err, "deviations", (size_t)count * 2 * sizeof *found);
    for (int i = 0; !err->status && p->cross && i < count; i++) {
        const bool inherited = out->segments[i].confidence < DEPTH_INHERITED;
        agreeing[i] = inherited ? 0 : cross_view_support(p->cross, i, x->planes[i]);
        x->deviation[i] /= p->step;
    }
    if (!err->status)
        deviation_find(found, p, x->planes, p->cross ? x->deviation : NULL, p->cross ? agreeing : NULL, err);
    for (int i = 0; !err->status && i < count; i++)
        if (!given_depth_has(p->given, i) && isfinite(found[i]) && found[i] > 0) out->segments[i].deviation = found[i];
    free(agreeing);
    free(found);
    return err->status;
}

/* Whether a round follows for certain, which knows better which border areas are foreground. */
static bool another_round(const struct solver *v) { return !v->source->read_depth && v->params->rounds > 0; }

/* Moves planes to pictures of twice the size. */
static struct plane doubled(struct plane p) { return (struct plane){p.a / 2, p.b / 2, p.c}; }

static void double_planes(struct layered_depth *out, struct solution *x)
{
    for (int i = 0; i < out->segment_count; i++) {
        struct depth_segment *g = &out->segments[i];
        x->planes[i] = doubled(x->planes[i]);
        g->plane[0] = x->planes[i].a;
        g->plane[1] = x->planes[i].b;
    }
    for (int k = 0; k < x->scene.count; k++) scene_planes_set(&x->scene, k, doubled(x->scene.planes[k]));
}

/* Lets pixels choose among the planes, and makes the layers. */
static enum status make_layers(struct layered_depth *out, struct solution *x, const struct solver *v, struct err *err)
{
    struct plane_problem problem = x->problem;
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    int *label = malloc(pixels * sizeof *label);
    if (!label) return err_nomem(err, "the segments of pixels", pixels * sizeof *label);
    if (v->full) {
        double_planes(out, x);
        matcher_take(v->full, v->m);
        problem.m = v->full;
    }
    pixel_planes_choose(label, x->planes, &problem, err);
    const bool matte = !strcmp(v->params->matte, "two_colour");
    if (!err->status) layers_make(out, label, x->planes, v->picture, x->sweep.step, matte, err);
    free(label);
    return err->status;
}

static enum status solve(struct layered_depth *out, const struct solver *v, struct err *err)
{
    const struct segmentation *s = v->m->segments;
    struct solution x = {0};
    const struct plane_sweep *sweep = &x.sweep;
    if (!start_solution(&x, v, err) && !expand_planes(x.planes, &x.problem, err))
        refine_planes(x.planes, &x.problem, err);

    if (!err->status) furniture_sweep_extend(x.distinct, x.found, x.planes, &x.problem);
    for (int i = 0; !err->status && !v->source->read_depth && i < s->count; i++)
        x.distinct[i] = distinctness(
            sweep->cost + (size_t)i * (size_t)sweep->planes, sweep->planes,
            (plane_at(x.planes[i], s->segments[i].cx, s->segments[i].cy) - sweep->min_inverse_z) / sweep->step);
    if (!err->status && !fill_segments(out, &x.problem, x.planes, x.distinct, err) &&
        !inherit(out, x.planes, &x.problem, another_round(v), v->source->model ? x.found : NULL, err) &&
        !state_deviations(out, &x, err))
        make_layers(out, &x, v, err);
    solution_release(&x);
    return err->status;
}

/* Adds a neighbour to both levels; half may be NULL. */
static enum status add_neighbour(struct level *full, struct level *half, int view_idx, int neighbour_idx,
                                 const struct view_source *source, double typical, struct err *err)
{
    const struct tone tone = full->gamma.tone;
    struct image picture = {0};
    struct gamma_image gamma = {0};
    source->read(source->ctx, neighbour_idx, &picture, err);
    if (!err->status) {
        /* a brighter photo must not be clipped where it is not clipped itself */
        const struct tone own = gamma_tone_of(&picture);
        gamma_image_make(&gamma, &picture, (struct tone){fmin(tone.exposure, own.exposure), tone.power}, err);
    }
    image_release(&picture);
    if (!err->status) level_add(full, half, view_idx, neighbour_idx, typical, &gamma, err);
    gamma_image_release(&gamma);
    return err->status;
}

/* A view whose depth is given needs no neighbour. */
static enum status find_neighbours(int neighbours[MAX_NEIGHBOURS], int *count, const struct camera_set *set,
                                   int view_idx, const struct observed_points *seen,
                                   const struct segment_params *params, const float *given, struct err *err)
{
    struct err alone = ERR_INIT;
    const enum status st = neighbours_choose(neighbours, count, set, view_idx, seen, params->neighbours, &alone);
    return st && !(st == ST_DATA && given) ? err_set(err, st, "%s", alone.text) : ST_OK;
}

/* The range of inverse depths: of the sparse points and the given depth, or of the neighbours' baselines; `near` and
 * `far` override it. */
static enum status find_range(struct solver *v, int neighbour_count, size_t pixels, struct err *err)
{
    const struct segment_params *params = v->params;
    bool guessed = false;
    if (neighbour_count && neighbours_depth_range(&v->min_inverse_z, &v->max_inverse_z, &guessed, v->set, v->view_idx,
                                                  v->neighbours, neighbour_count, err))
        return err->status;
    if (v->given) given_depth_range(&v->min_inverse_z, &v->max_inverse_z, v->given, pixels);
    if (guessed && params->near > 0) v->min_inverse_z = fmin(v->min_inverse_z, 1 / params->near / 500);
    if (params->far > 0) v->min_inverse_z = 1 / params->far;
    if (params->near > 0) v->max_inverse_z = 1 / params->near;
    if (v->min_inverse_z < v->max_inverse_z) return ST_OK;
    return err_set(err, ST_USAGE, "[segment_depth] near = %g and far = %g leave no depth between them.",
                   1 / v->max_inverse_z, 1 / v->min_inverse_z);
}

/* Makes the level of half the size, where planes are found, and its segments in the full size, where pixels choose. */
static enum status prepare_half(struct level *half, struct level *full, struct solver *v, struct err *err)
{
    if (!level_halve(half, full, err) &&
        !oversegment(&half->segments, &half->gamma, v->params->segment_pixels, v->params->compactness, err) &&
        !matcher_init(&half->matcher, &half->segments, &half->gamma, v->params, err))
        oversegment_double(&full->segments, &half->segments, &full->gamma, err);
    v->set = &half->set;
    v->seen = &half->seen;
    v->m = &half->matcher;
    v->full = &full->matcher;
    return err->status;
}

enum status view_depth(struct layered_depth *out, int neighbours[MAX_NEIGHBOURS], int *neighbour_count,
                       const struct camera_set *set, int view_idx, const struct view_source *source,
                       const struct segment_params *params, struct err *err)
{
    struct segment_params own = *params;
    struct image picture = {0};
    struct level full = {.set = *set}, other = {0}, *half = NULL;
    struct solver v = {.set = set,
                       .view_idx = view_idx,
                       .neighbours = neighbours,
                       .m = &full.matcher,
                       .picture = &picture,
                       .seen = &full.seen,
                       .source = source,
                       .params = &own};
    *out = (struct layered_depth){0};
    *neighbour_count = 0;
    neighbours_find_points(&full.seen, set, view_idx, err);
    if (!err->status && source->read_given) source->read_given(source->ctx, view_idx, &v.given, err);
    if (!err->status) find_neighbours(neighbours, neighbour_count, set, view_idx, &full.seen, params, v.given, err);
    if (!err->status && !source->read(source->ctx, view_idx, &picture, err) &&
        !layered_depth_init(out, picture.width, picture.height, err) &&
        !find_range(&v, *neighbour_count, (size_t)picture.width * (size_t)picture.height, err))
        gamma_image_make(&full.gamma, &picture, gamma_tone_of(&picture), err);
    if (source->read_depth) own.segment_pixels = params->fine_pixels;
    if (!err->status && !source->read_depth && !v.given &&
        depth_halves(params, (double)picture.width * picture.height)) {
        half = &other;
        own.segment_pixels = params->half_pixels;
    }
    if (!err->status && half) prepare_half(half, &full, &v, err);
    if (!err->status && !half) oversegment(&full.segments, &full.gamma, own.segment_pixels, own.compactness, err);
    if (!err->status) matcher_init(&full.matcher, &full.segments, &full.gamma, params, err);
    for (int k = 0; !err->status && k < *neighbour_count; k++)
        add_neighbour(&full, half, view_idx, neighbours[k], source, 0.5 * (v.min_inverse_z + v.max_inverse_z), err);
    if (!err->status) match_calibrate(v.m, v.min_inverse_z, v.max_inverse_z, err);
    v.neighbour_count = *neighbour_count;
    if (!err->status) solve(out, &v, err);
    if (err->status) layered_depth_release(out);
    level_release(&full);
    level_release(&other);
    image_release(&picture);
    free(v.given);
    return err->status;
}
