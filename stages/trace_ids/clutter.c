/* clutter.c - where something that the model does not hold stands in front of it.
 *
 * Furniture must not be painted onto the wall behind it. The view's layered depth says what the photograph shows; the
 * model says how far its face is. With z the depth of the view and w = 1 / z_model, d = 1 - z w is the part of the way
 * to the model that is missing: above 0 the photograph shows something nearer. d has a tolerance for the model and the
 * cameras (depth_tolerance), and the uncertainty of the segment's depth (common/layers/depth_sigma.h) times
 * depth_sigmas. What lies behind the model is never clutter: a pane of glass has the street as its texture.
 *
 *   1    nearer by more than the tolerance, by either layer of the view's depth
 *   0    not nearer, and the depth is sure enough to tell
 *   0.5  the depth is not confident enough to say
 *
 * Clutter narrower than 2 min_clutter + 1 px is noise of the depth (opening); what is left grows by clutter_margin,
 * because outlines of segments are off by a pixel or two, and blurred. */
#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/layers/depth_sigma.h"
#include "common/math/distance.h"
#include "stages/trace_ids/view_trace.h"

#define MIN_ALPHA 0.1f /* of a boundary layer that counts */

enum { ROWS = 16 };

struct clutter_job {
    float *clutter;
    const struct view_ids *ids;
    const struct layered_depth *depth;
    const struct trace_params *params;
};

static float judge(const struct clutter_job *job, uint32_t id, float z, double z_model)
{
    const struct depth_segment *s = &job->depth->segments[id - 1];
    if (!(z > 0) || s->confidence < job->params->min_confidence) return CLUTTER_UNSURE;
    const double nearer = 1 - (double)z / z_model, sigma = depth_sigma(s);
    if (nearer > job->params->depth_tolerance + job->params->depth_sigmas * sigma) return 1;
    return sigma > job->params->max_depth_error ? CLUTTER_UNSURE : 0;
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

/* Sets inside to 1 where the squared distance exceeds (or does not exceed) reach squared. */
static void threshold(uint8_t *inside, const float *squared, size_t pixels, int reach, bool beyond)
{
    for (size_t i = 0; i < pixels; i++) inside[i] = (squared[i] > (float)reach * (float)reach) == beyond;
}

/* Clutter is eroded by min_clutter, and what is left dilated by min_clutter and clutter_margin. */
static enum status clean_outlines(struct clutter_job *job, struct err *err)
{
    const int width = job->ids->width, height = job->ids->height;
    const size_t pixels = (size_t)width * (size_t)height;
    uint8_t *mask = malloc(pixels);
    float *squared = malloc(pixels * sizeof *squared);
    enum status st = mask && squared ? ST_OK : err_nomem(err, "clutter", pixels * 5);
    for (size_t i = 0; !st && i < pixels; i++) mask[i] = job->clutter[i] >= 1;
    if (!st) st = distance_squared(squared, mask, width, height, err);
    if (!st) threshold(mask, squared, pixels, job->params->min_clutter, false); /* 0 in the cores */
    if (!st) st = distance_squared(squared, mask, width, height, err);
    const float reach = (float)job->params->min_clutter, rim = reach + (float)job->params->clutter_margin;
    for (size_t i = 0; !st && i < pixels; i++) {
        if (!job->depth->interior.id[i] || squared[i] <= rim * rim)
            job->clutter[i] = 1;
        else if (job->clutter[i] >= 1)
            job->clutter[i] = CLUTTER_UNSURE;
    }
    free(mask);
    free(squared);
    return st;
}

enum status find_clutter(struct view_ids *ids, const struct view_trace *t, const struct layered_depth *depth,
                         const struct trace_params *params, struct err *err)
{
    struct clutter_job job = {ids->clutter, ids, depth, params};
    parallel_for((size_t)t->height, ROWS, judge_rows, &job);
    return clean_outlines(&job, err);
}
