/* ends_search.c - depth pictures of viewpoints, and measures of the path between two ends. */
#include "stages/plan_path/ends_search.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

#define MAX_PATH_SAMPLES 1000 /* frames of a longer film are closer together than matters */
#define COARSE_SAMPLES   7    /* of a path, in the quick test of its validity */
#define MIN_ADVANCE      0.5  /* of the length of a dolly in or out: its part along z */

enum status ends_search_init(struct ends_search *s, const struct layer_scene *scene, const struct validity *v,
                             const struct plan_params *params, struct ends_notes *notes, struct err *err)
{
    *s = (struct ends_search){.scene = scene, .v = v, .params = params, .notes = notes};
    s->test = (struct viewpoint_test){.scene = scene, .points = &s->points, .shot = &v->shot, .limits = v->limits};
    if (scene_points_collect(&s->points, scene, err)) return err->status;
    for (int k = 0; k < 2 && v->move.move == MOVE_ESTABLISHING_DOLLY; k++) {
        const struct view camera = shot_end_camera(&v->shot, &v->move.end[k], v->shot.origin);
        s->least_pixels[k] = params->min_shown * viewpoint_pixels_within(&s->test, &camera);
    }
    return ST_OK;
}

void ends_search_release(struct ends_search *s)
{
    scene_points_release(&s->points);
    viewpoint_test_release(&s->test);
}

static enum status render_end(struct depth_picture *d, const struct ends_search *s, int end, struct vec3 at,
                              struct err *err)
{
    const struct view camera = shot_end_camera(&s->v->shot, &s->v->move.end[end], at);
    return parallax_picture_make(d, s->scene, &camera, s->params->parallax_side, err);
}

void ends_batch_release(struct picture_batch *b)
{
    for (int i = 0; b->pictures && i < b->count; i++) parallax_picture_release(&b->pictures[i]);
    free(b->pictures);
    free(b->at);
    free(b->end);
    free(b->wanted);
    free(b->errors);
}

enum status ends_batch_init(struct picture_batch *b, struct ends_search *s, int count, struct err *err)
{
    const size_t n = (size_t)count;
    *b = (struct picture_batch){.search = s, .count = count};
    b->at = calloc(n, sizeof *b->at);
    b->end = calloc(n, sizeof *b->end);
    b->wanted = calloc(n, sizeof *b->wanted);
    b->pictures = calloc(n, sizeof *b->pictures);
    b->errors = calloc(n, sizeof *b->errors);
    if (b->at && b->end && b->wanted && b->pictures && b->errors) return ST_OK;
    ends_batch_release(b);
    *b = (struct picture_batch){0};
    return err_nomem(err, "depth pictures", n * sizeof *b->pictures);
}

static void render_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct picture_batch *b = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (b->wanted[i]) render_end(&b->pictures[i], b->search, b->end[i], b->at[i], &b->errors[i]);
}

enum status ends_batch_render(struct picture_batch *b, struct err *err)
{
    parallel_for((size_t)b->count, 1, render_some, b);
    for (int i = 0; i < b->count; i++) b->search->notes->renders += b->wanted[i];
    for (int i = 0; i < b->count; i++)
        if (b->errors[i].status) return err_set(err, b->errors[i].status, "%s", b->errors[i].text);
    return ST_OK;
}

enum status ends_measure_parallax(struct ends_search *s, struct move_ends *e, struct err *err)
{
    struct depth_picture pictures[2] = {{.z = NULL}};
    for (int i = 0; !err->status && i < 2; i++) {
        render_end(&pictures[i], s, i, e->at[i], err);
        s->notes->renders++;
    }
    if (!err->status) e->parallax = parallax_between(&pictures[0], &pictures[1], parallax_tolerance(s->scene));
    for (int i = 0; i < 2; i++) parallax_picture_release(&pictures[i]);
    return err->status;
}

double ends_angle(const struct shot_setup *shot, const struct vec3 at[2])
{
    const struct vec3 a = vec3_sub(at[0], shot->centroid), b = vec3_sub(at[1], shot->centroid);
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) * 180 / PI;
}

double path_fraction(int i, int count, const char *ease)
{
    const double t = i / (count - 1.0);
    return strcmp(ease, "smooth") ? t : t * t * (3 - 2 * t);
}

/* Updates validity and worst values of e by `count` samples of its path. */
static enum status measure_path_samples(struct ends_search *s, struct move_ends *e, int count, const char *ease,
                                        struct err *err)
{
    struct view *cameras = calloc((size_t)count, sizeof *cameras);
    struct viewpoint *found = calloc((size_t)count, sizeof *found);
    if (!cameras || !found) err_nomem(err, "cameras of a path", (size_t)count * sizeof *cameras);

    for (int i = 0; !err->status && i < count; i++)
        cameras[i] = shot_camera(&s->v->shot, &s->v->move, e->at, path_fraction(i, count, ease));
    if (!err->status) viewpoints_measure(found, cameras, count, &s->test, err);
    for (int i = 0; !err->status && i < count; i++) {
        e->valid &= found[i].valid;
        e->worst_outside = fmax(e->worst_outside, found[i].outside);
        if (found[i].h > e->worst_h) e->worst_h = found[i].h, e->worst_at = path_fraction(i, count, ease);
    }
    free(cameras);
    free(found);
    return err->status;
}

enum status ends_measure_path(struct ends_search *s, struct move_ends *e, struct err *err)
{
    const int frames = (int)fmin(round(s->params->seconds * s->params->fps), MAX_PATH_SAMPLES);

    e->length = vec3_length(vec3_sub(e->at[1], e->at[0]));
    e->angle = ends_angle(&s->v->shot, e->at);
    e->valid = true;
    e->worst_h = -1;
    e->worst_outside = 0;
    measure_path_samples(s, e, PATH_SAMPLES, "none", err);
    if (!err->status && e->valid) measure_path_samples(s, e, frames, s->params->ease, err);
    return err->status;
}

enum status ends_test_path(bool *valid, struct ends_search *s, const struct vec3 at[2], struct err *err)
{
    static const int order[COARSE_SAMPLES] = {3, 1, 5, 2, 4, 0, 6}; /* ends last: alone, most of them are valid */
    struct view cameras[COARSE_SAMPLES];

    for (int i = 0; i < COARSE_SAMPLES; i++)
        cameras[i] = shot_camera(&s->v->shot, &s->v->move, at, order[i] / (COARSE_SAMPLES - 1.0));
    return viewpoints_are_valid(valid, cameras, COARSE_SAMPLES, &s->test, err);
}

bool ends_show_enough(const struct ends_search *s, int end, struct vec3 at)
{
    if (!(s->least_pixels[end] > 0)) return true;
    const struct view camera = shot_end_camera(&s->v->shot, &s->v->move.end[end], at);
    return camera.fx > 0 && viewpoint_pixels_within(&s->test, &camera) >= s->least_pixels[end];
}

bool ends_move_as_asked(const struct ends_search *s, const struct vec3 at[2])
{
    const struct shot_setup *shot = &s->v->shot;
    const enum camera_move move = s->v->move.move;
    if (ends_angle(shot, at) > s->params->max_angle * (1 + 1e-9)) return false;
    if (move != MOVE_DOLLY_IN && move != MOVE_DOLLY_OUT) return true;
    const double advance = shot_from_world(shot, at[1]).z - shot_from_world(shot, at[0]).z;
    return (move == MOVE_DOLLY_IN ? advance : -advance) >= MIN_ADVANCE * vec3_length(vec3_sub(at[1], at[0]));
}

bool ends_are_allowed(const struct ends_search *s, const struct vec3 at[2])
{
    return ends_move_as_asked(s, at) && ends_show_enough(s, 0, at[0]) && ends_show_enough(s, 1, at[1]);
}
