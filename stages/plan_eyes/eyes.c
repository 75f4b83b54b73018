/* eyes.c - two eyes instead of a film's camera.
 *
 * The eyes are half the distance `base` to the left and to the right of the film's camera, along its x axis, and look
 * in its direction. They are not turned towards each other: that would make vertical disparities, which tire. Instead
 * their principal points are shifted (an off-axis lens), so that a point at the convergence depth zc has the same
 * pixel in both pictures and appears on the screen. A point at depth z then has the disparity
 *     d(z) = f base (1/zc - 1/z),
 * negative in front of the screen, positive behind it, and no vertical disparity, since z and the y axis are shared.
 *
 * Comfort. `base` is at most a thirtieth of the nearest depth (near_ratio), the rule of thumb of stereographers
 * [Mendiburu 2009], and small enough that no disparity exceeds the budget: max_front and max_behind, in percent of the
 * picture's width. It is constant over the film: a distance that changes would make the scene grow and shrink. zc
 * follows the frame: 1/zc divides the range from 1/nearest to 1/farthest in the ratio of the two limits, so it is never
 * in front of what the layers show, and never behind it.
 *
 * The nearest and farthest depths are percentiles of the layers' depths in small pictures of some frames, linear in 1/z
 * between these. 1/zc is smoothed over neighbouring samples, so that the screen does not jump.
 *
 * A half-sphere has no screen: its disparity is measured from infinity, and only near_ratio limits it. */
#include "stages/plan_eyes/eyes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/layers/layer_render.h"
#include "common/math/weighted.h"
#include "common/product/product.h"

#define NEAREST  0.005 /* these percentiles of a frame's depths count as nearest and farthest */
#define FARTHEST 0.995

#define PARAM_STRUCT struct eyes_params
const struct param eyes_param_table[] = {EYES_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

double eyes_disparity(const struct eyes_plan *plan, const struct view *camera, int frame, double z)
{
    const double zc = plan->frames[frame].convergence;
    /* a half-sphere has as many px per radian as its width has for half a turn */
    const double focal = plan->kind == EYES_HALF_SPHERE ? plan->width / acos(-1) : camera->fx;
    return focal * plan->base * ((zc > 0 ? 1 / zc : 0) - 1 / z);
}

/* --------------------------------------------------------------------------------------------------------- depths */

static enum status measure_depth(struct eyes_depth *d, struct weighted *values, const struct rendered_frame *frame)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    size_t count = 0;
    for (size_t p = 0; p < pixels; p++)
        if (frame->z[p] > 0 && frame->rgba[4 * p + 3] > 0) values[count++] = (struct weighted){frame->z[p], 1};
    *d = (struct eyes_depth){0};
    if (!count) return ST_OK;
    d->nearest = weighted_percentile(values, count, NEAREST);
    d->farthest = weighted_percentile(values, count, FARTHEST);
    return ST_OK;
}

/* What the camera of a frame shows of the layers, in a picture of the longer side `side`. */
static enum status look(struct eyes_depth *d, const struct layer_scene *scene, const struct view *camera, int side,
                        struct err *err)
{
    static const struct layer_render_options options = {.soft_z = SOFT_Z_WIDTHS};
    const int longer = camera->width > camera->height ? camera->width : camera->height;
    struct rendered_frame frame = {0};
    struct weighted *values = NULL;
    struct view small = *camera;
    if (side < longer)
        view_resize(&small, (int)fmax(1, round((double)camera->width * side / longer)),
                    (int)fmax(1, round((double)camera->height * side / longer)));
    const size_t pixels = (size_t)small.width * (size_t)small.height;
    if (!(values = malloc(pixels * sizeof *values))) err_nomem(err, "depths", pixels * sizeof *values);
    if (!err->status && !layer_render(&frame, scene, &small, &options, err)) measure_depth(d, values, &frame);
    rendered_frame_release(&frame);
    free(values);
    return err->status;
}

/* Depths of the frames between two samples, linear in 1/z. */
static void fill_between(struct eyes_depth *frames, int from, int to)
{
    const struct eyes_depth a = frames[from], b = frames[to];
    for (int i = from + 1; i < to; i++) {
        const double t = (double)(i - from) / (to - from);
        if (a.nearest > 0 && b.nearest > 0)
            frames[i] = (struct eyes_depth){1 / ((1 - t) / a.nearest + t / b.nearest),
                                            1 / ((1 - t) / a.farthest + t / b.farthest), 0};
        else
            frames[i] = a.nearest > 0 ? a : b;
    }
}

static enum status measure_depths(struct eyes_depth *frames, const struct camera_path *film,
                                  const struct layer_scene *scene, const struct eyes_params *params, struct err *err)
{
    const int last = film->frame_count - 1;
    const int steps = last < params->samples - 1 ? last : params->samples - 1;
    for (int k = 0, before = 0; k <= steps; k++) {
        const int at = steps ? (int)((long)last * k / steps) : 0;
        if (look(&frames[at], scene, &film->frames[at].camera, params->side, err)) return err->status;
        fill_between(frames, before, at);
        before = at;
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- plan */

/* Takes the depths of the nearest frame that shows anything for those that show nothing. */
static enum status fill_unknown(struct eyes_plan *plan, struct err *err)
{
    for (int pass = 0; pass < 2; pass++)
        for (int k = 1; k < plan->frame_count; k++) {
            const int i = pass ? plan->frame_count - 1 - k : k, before = pass ? i + 1 : i - 1;
            if (!(plan->frames[i].nearest > 0)) plan->frames[i] = plan->frames[before];
        }
    if (plan->frames[0].nearest > 0) return ST_OK;
    return err_set(err, ST_DATA,
                   "no frame of the film shows anything of the scene, so the distance between the eyes cannot be "
                   "chosen; check the cameras in path/images.txt, or plan the path again.");
}

/* The largest distance between the eyes that the limits allow. */
static void choose_base(struct eyes_plan *plan, const struct camera_path *film, const struct eyes_params *params)
{
    const double budget = (params->max_front + params->max_behind) / 100 * plan->width;
    double by_ratio = HUGE_VAL, by_budget = HUGE_VAL;
    for (int i = 0; i < plan->frame_count; i++) {
        const struct eyes_depth *d = &plan->frames[i];
        const double range = film->frames[i].camera.fx * (1 / d->nearest - 1 / d->farthest);
        by_ratio = fmin(by_ratio, d->nearest / params->near_ratio);
        if (plan->kind == EYES_FLAT && range > 0) by_budget = fmin(by_budget, budget / range);
    }
    plan->base = fmin(by_ratio, by_budget);
    plan->limit = by_ratio <= by_budget ? "near_ratio" : "disparity";
    if (!(params->base > 0)) return;
    plan->base = params->base;
    plan->limit = "base";
}

/* 1/zc of each frame: the limits' ratio divides the frame's range; smoothed over `reach` frames to both sides, and kept
 * within the range. */
static enum status choose_convergence(struct eyes_plan *plan, const struct eyes_params *params, int reach,
                                      struct err *err)
{
    const double part = params->max_front / (params->max_front + params->max_behind);
    double *inverse = malloc((size_t)plan->frame_count * sizeof *inverse);
    if (!inverse) return err_nomem(err, "depths", (size_t)plan->frame_count * sizeof *inverse);
    for (int i = 0; i < plan->frame_count; i++) {
        const struct eyes_depth *d = &plan->frames[i];
        inverse[i] = 1 / d->nearest - part * (1 / d->nearest - 1 / d->farthest);
    }
    for (int i = 0; i < plan->frame_count; i++) {
        struct eyes_depth *d = &plan->frames[i];
        double sum = 0, weight = 0;
        for (int k = -reach; k <= reach; k++) {
            if (i + k < 0 || i + k >= plan->frame_count) continue;
            sum += (reach + 1 - abs(k)) * inverse[i + k];
            weight += reach + 1 - abs(k);
        }
        d->convergence = 1 / fmin(fmax(sum / weight, 1 / d->farthest), 1 / d->nearest);
    }
    free(inverse);
    return ST_OK;
}

/* The largest disparities of all frames. */
static void find_extremes(struct eyes_plan *plan, const struct camera_path *film)
{
    plan->nearest = HUGE_VAL;
    for (int i = 0; i < plan->frame_count; i++) {
        const struct eyes_depth *d = &plan->frames[i];
        const double front = -eyes_disparity(plan, &film->frames[i].camera, i, d->nearest);
        const double behind = eyes_disparity(plan, &film->frames[i].camera, i, d->farthest);
        if (front > plan->front) plan->front = front, plan->front_at = i;
        if (behind > plan->behind) plan->behind = behind, plan->behind_at = i;
        plan->nearest = fmin(plan->nearest, d->nearest);
        plan->farthest = fmax(plan->farthest, d->farthest);
    }
}

/* Frames to both sides over which the convergence is smoothed: the distance of two samples. */
static int smoothing(const struct camera_path *film, const struct eyes_params *params)
{
    const int steps = film->frame_count < params->samples ? film->frame_count : params->samples;
    return steps > 1 ? (film->frame_count - 1) / (steps - 1) : 0;
}

enum status eyes_plan_from_depths(struct eyes_plan *plan, const struct camera_path *film,
                                  const struct eyes_depth *depths, enum eyes_kind kind,
                                  const struct eyes_params *params, struct err *err)
{
    const size_t n = (size_t)film->frame_count;
    *plan = (struct eyes_plan){.kind = kind, .limit = "base"};
    plan->width = kind == EYES_HALF_SPHERE ? params->vr_side / 2 * 2 : film->frames[0].camera.width;
    if (!(plan->frames = malloc(n * sizeof *plan->frames))) return err_nomem(err, "depths", n * sizeof *plan->frames);
    memcpy(plan->frames, depths, n * sizeof *depths);
    plan->frame_count = film->frame_count;
    if (fill_unknown(plan, err)) return err->status;
    for (int i = 0; i < plan->frame_count; i++) plan->frames[i].convergence = 0;
    choose_base(plan, film, params);
    if (kind == EYES_FLAT && choose_convergence(plan, params, smoothing(film, params), err)) return err->status;
    find_extremes(plan, film);
    return ST_OK;
}

enum status eyes_plan(struct eyes_plan *plan, const struct camera_path *film, const struct layer_scene *scene,
                      enum eyes_kind kind, const struct eyes_params *params, struct err *err)
{
    struct eyes_depth *depths = calloc((size_t)film->frame_count, sizeof *depths);
    if (!depths) return err_nomem(err, "depths", (size_t)film->frame_count * sizeof *depths);
    if (!measure_depths(depths, film, scene, params, err)) eyes_plan_from_depths(plan, film, depths, kind, params, err);
    free(depths);
    return err->status;
}

enum status eyes_path(struct camera_path *eye, const struct camera_path *film, const struct eyes_plan *plan, int side,
                      struct err *err)
{
    if (camera_path_init(eye, film->effect, film->fps, film->frame_count, err)) return err->status;
    for (int i = 0; i < film->frame_count; i++) {
        const struct path_frame *from = &film->frames[i];
        struct path_frame *to = &eye->frames[i];
        const double zc = plan->frames[i].convergence;
        struct view camera = from->camera;
        if (plan->kind == EYES_HALF_SPHERE) {
            camera.width = camera.height = plan->width;
            camera.fx = camera.fy = camera.cx = camera.cy = plan->width / 2.0;
        }
        camera = view_from_lens_point(&camera, side * plan->base / 2, 0, zc > 0 ? zc : HUGE_VAL);
        camera.name = to->camera.name;
        to->camera = camera;
        to->time = from->time;
        to->aperture = plan->kind == EYES_HALF_SPHERE ? 0 : from->aperture;
        to->focus = plan->kind == EYES_HALF_SPHERE ? 0 : from->focus;
    }
    return camera_path_add_score(eye, "base", plan->base, "", err);
}

/* ----------------------------------------------------------------------------------------------------------- file */

static void put_disparity(FILE *to, const char *word, double px, int width, double limit, const char *frame)
{
    fprintf(to, "%s %.4g %.4g %.9g %s\n", word, px, 100 * px / width, limit, frame);
}

enum status eyes_write(const struct eyes_plan *plan, const struct camera_path *film, const struct eyes_params *params,
                       const char *path, const struct provenance *prov, struct err *err)
{
    const bool flat = plan->kind == EYES_FLAT;
    struct outfile f = {0};
    if (!product_begin(&f, PRODUCT_EYES, path, prov, err)) {
        fprintf(f.fp, "kind %s\nwidth %d\nbase %.17g %s\n", flat ? "flat" : "half_sphere", plan->width, plan->base,
                plan->limit);
        fprintf(f.fp, "near_ratio %.6g %.9g\n", plan->nearest / plan->base, params->near_ratio);
        put_disparity(f.fp, "front", plan->front, plan->width, flat ? params->max_front : 0,
                      film->frames[plan->front_at].camera.name);
        put_disparity(f.fp, "behind", plan->behind, plan->width, flat ? params->max_behind : 0,
                      film->frames[plan->behind_at].camera.name);
        fprintf(f.fp, "frames %d\n", plan->frame_count);
        for (int i = 0; i < plan->frame_count; i++) {
            const struct eyes_depth *d = &plan->frames[i];
            fprintf(f.fp, "frame %s %.9g %.9g %.9g %.4g %.4g\n", film->frames[i].camera.name, d->nearest, d->farthest,
                    d->convergence, eyes_disparity(plan, &film->frames[i].camera, i, d->nearest),
                    eyes_disparity(plan, &film->frames[i].camera, i, d->farthest));
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

void eyes_plan_release(struct eyes_plan *plan)
{
    if (!plan) return;
    free(plan->frames);
    *plan = (struct eyes_plan){0};
}
