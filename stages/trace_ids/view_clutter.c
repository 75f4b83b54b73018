/* view_clutter.c - where something that the model does not hold stands in front of it.
 *
 * Furniture must not be painted onto the wall behind it. The view's layered depth says what the photograph shows; the
 * model says how far its face is. With z the depth of the view and w = 1 / z_model, d = 1 - z w is the part of the way
 * to the model that is missing: above 0 the photograph shows something nearer. d has a tolerance for the model and the
 * cameras (depth_tolerance), and the uncertainty of the segment's depth (common/layers/depth_sigma.h) times
 * depth_sigmas. What lies behind the model is never clutter: a pane of glass has the street as its texture.
 *
 *   1     nearer by more than the tolerance, by either layer of the view's depth
 *   0.75  the same, by a segment of little confidence
 *   0.5   no depth to compare
 *   0.25  not nearer, by a segment of little confidence
 *   0     not nearer, and the depth is sure enough to tell
 *
 * From afar a view cannot tell a bookcase from the wall behind it: the tolerance, which grows with the distance, hides
 * it. So a view shows that a surface is clean only where its depth lies within `furniture` of it; between that and the
 * tolerance nothing is known.
 *
 * A segment of little confidence (below min_confidence) has inherited its depth from its neighbours. On plain walls,
 * which give nothing to match, that depth is right most of the time: such pixels are nearly as often clean as those of
 * sure depth (docs/decisions/0028-clutter.md), and without them a white room would have no texture.
 *
 * Clutter narrower than 2 min_clutter + 1 px is noise of the depth and becomes 0.5 (opening); what is left grows by
 * clutter_margin, because outlines of segments are off by a pixel or two, and blurred. Pixels that the view does not
 * have are 1, with the same rim. */
#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/layers/depth_sigma.h"
#include "common/math/distance.h"
#include "stages/trace_ids/view_layers.h"

#define MIN_ALPHA 0.1f  /* of a boundary layer that counts */
#define RATHER    0.25f /* what a segment of little confidence says counts half: 0.5 +- this */

#define SHARPEST 0.008 /* of the depth: no depth is surer than that */

enum { ROWS = 16 };

struct clutter_job {
    float *clutter;
    const struct view_ids *ids;
    const struct layered_depth *depth;
    const struct trace_params *params;
    double furniture; /* scene units */
};

static float judge(const struct clutter_job *job, uint32_t id, float z, double z_model)
{
    const struct depth_segment *s = &job->depth->segments[id - 1];
    if (!(z > 0)) return CLUTTER_UNSURE;
    const double nearer = 1 - (double)z / z_model, sigma = depth_width(s);
    const bool sure = s->confidence >= job->params->min_confidence;
    if (nearer > job->params->depth_tolerance + job->params->depth_sigmas * sigma)
        return sure ? 1 : CLUTTER_UNSURE + RATHER;
    if (sigma > job->params->max_depth_error || nearer > fmax(SHARPEST, job->furniture / z_model))
        return CLUTTER_UNSURE;
    return sure ? 0 : CLUTTER_UNSURE - RATHER;
}

static void judge_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct clutter_job *job = ctx;
    const struct layer *inner = &job->depth->interior, *outer = &job->depth->boundary;
    const size_t width = (size_t)job->ids->width;
    (void)thread;
    for (size_t i = begin * width; i < end * width; i++) {
        const double z = (double)job->ids->z[i];
        job->clutter[i] = CLUTTER_UNSURE;
        if (!inner->id[i]) {
            job->clutter[i] = 1;
            continue;
        }
        if (!(z > 0)) continue;
        job->clutter[i] = judge(job, inner->id[i], inner->z[i], z);
        if (outer->id[i] && outer->rgba[4 * i + 3] > MIN_ALPHA)
            job->clutter[i] = fmaxf(job->clutter[i], judge(job, outer->id[i], outer->z[i], z));
    }
}

struct outline_scratch {
    uint8_t *mask;
    float *squared, *grown;
};

/* Clutter of at least `level` is eroded by min_clutter, and what is left dilated by min_clutter and clutter_margin.
 * Raises `grown` to the level there. */
static enum status grow(struct outline_scratch *s, const struct clutter_job *job, float level, struct err *err)
{
    const int width = job->ids->width, height = job->ids->height;
    const size_t pixels = (size_t)width * (size_t)height;
    const float core = (float)job->params->min_clutter, rim = core + (float)job->params->clutter_margin;
    for (size_t i = 0; i < pixels; i++) s->mask[i] = job->clutter[i] >= level;
    if (distance_squared(s->squared, s->mask, width, height, err)) return err->status;
    for (size_t i = 0; i < pixels; i++) s->mask[i] = s->squared[i] <= core * core;
    if (distance_squared(s->squared, s->mask, width, height, err)) return err->status;
    for (size_t i = 0; i < pixels; i++)
        if (s->squared[i] <= rim * rim) s->grown[i] = fmaxf(s->grown[i], level);
    return ST_OK;
}

static enum status clean_outlines(const struct clutter_job *job, struct err *err)
{
    static const float levels[] = {CLUTTER_UNSURE + RATHER, 1};
    const size_t pixels = (size_t)job->ids->width * (size_t)job->ids->height;
    struct outline_scratch s = {malloc(pixels), malloc(pixels * sizeof *s.squared), malloc(pixels * sizeof *s.grown)};
    if (!s.mask || !s.squared || !s.grown) err_nomem(err, "clutter", pixels * 9);
    for (size_t i = 0; !err->status && i < pixels; i++) s.grown[i] = fminf(job->clutter[i], CLUTTER_UNSURE);
    for (int k = 0; !err->status && k < 2; k++) grow(&s, job, levels[k], err);
    for (size_t i = 0; !err->status && i < pixels; i++) job->clutter[i] = job->depth->interior.id[i] ? s.grown[i] : 1;
    free(s.mask);
    free(s.squared);
    free(s.grown);
    return err->status;
}

enum status view_clutter_find(struct view_ids *ids, const struct view_trace *t, const struct layered_depth *depth,
                              double scale, const struct trace_params *params, struct err *err)
{
    struct clutter_job job = {ids->clutter, ids, depth, params,
                              params->furniture * model_rays_height(t->model) / scale};
    parallel_for((size_t)t->height, ROWS, judge_rows, &job);
    return clean_outlines(&job, err);
}
