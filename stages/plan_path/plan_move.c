/* plan_move.c - see plan_move.h. */
#include "stages/plan_path/plan_move.h"

#include <stdlib.h>

#define PARAM_STRUCT struct plan_params
const struct param plan_param_table[] = {PLAN_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define ROOM_STEPS 7 /* by which ends are drawn together to let the aperture open */
#define ROOM_STEP  0.1
#define STILL      1e-6 /* median depths: a move shorter than this is none */

enum status plan_params_check(const void *values, struct err *err)
{
    const struct plan_params *p = values;
    if (p->seconds * p->fps >= 1.5) return ST_OK;
    return err_set(err, ST_USAGE,
                   "seconds = %g at fps = %g make fewer than two frames: a film needs at least two; raise seconds.",
                   p->seconds, p->fps);
}

/* An establishing dolly goes to the right, or upwards where it hardly goes sideways: of two directions that are alike
 * viewers take this one for granted. Its ends have one rule, so they may change places. */
static void turn_round(struct move_ends *e, const struct validity *v)
{
    const struct view camera = shot_aim(&v->shot, v->shot.origin, v->shot.centroid, v->shot.lens.fx);
    const struct vec3 way = vec3_sub(e->at[1], e->at[0]), in_camera = mat3_apply(camera.cam_from_world, way);
    const double sideways = fabs(in_camera.x) > 0.1 * vec3_length(way) ? in_camera.x : -in_camera.y;
    if (v->effect.move != MOVE_ESTABLISHING_DOLLY || sideways >= 0) return;
    const struct vec3 first = e->at[0];
    e->at[0] = e->at[1];
    e->at[1] = first;
    e->worst_at = 1 - e->worst_at;
}

static void fill_frames(struct camera_path *path, double *parts, const struct validity *v, const struct move_ends *e,
                        const char *ease)
{
    for (int i = 0; i < path->frame_count; i++) {
        const char *name = path->frames[i].camera.name;
        const double t = ends_part(i, path->frame_count, ease);
        parts[i] = t;
        path->frames[i].camera = shot_camera(&v->shot, &v->move, e->at, t);
        path->frames[i].camera.name = name;
    }
}

/* The widest circle of confusion of what is infinitely far, px. */
static double widest_blur(const struct camera_path *path)
{
    double most = 0;
    for (int i = 0; i < path->frame_count; i++) {
        const struct path_frame *f = &path->frames[i];
        if (f->aperture > 0) most = fmax(most, f->aperture * f->camera.fx / f->focus);
    }
    return most;
}

/* Sets apertures and focus. Ends that were chosen at the very border of what is valid leave an aperture no room: they
 * are drawn together towards the origin, step by step, until it opens to half of max_blur; where it never does, they
 * stay where it opens most. */
static enum status open_aperture(struct camera_path *path, double *parts, struct move_notes *n,
                                 struct viewpoint_test *test, const struct validity *v,
                                 const struct subject_list *subjects, const struct plan_params *params, struct err *err)
{
    const double enough = 0.5 * params->max_blur * fmax(v->shot.lens.width, v->shot.lens.height);
    const struct move_ends chosen = n->ends;
    struct move_ends best = chosen;
    double most = -1;

    for (int i = 0; i < ROOM_STEPS && most < enough; i++) {
        struct move_ends e = chosen;
        for (int k = 0; k < 2; k++) {
            const struct vec3 way = vec3_sub(chosen.at[k], v->shot.origin);
            e.at[k] = vec3_add(v->shot.origin, vec3_scale(way, 1 - ROOM_STEP * i));
        }
        if (i && ends_measure(&e, test->scene, v, params, err)) return err->status;
        if (i && !e.valid) continue;
        fill_frames(path, parts, v, &e, params->ease);
        if (focus_frames(path, &n->aperture, parts, test, v, subjects, params, err)) return err->status;
        if (widest_blur(path) > most) most = widest_blur(path), best = e;
    }
    n->ends = best;
    fill_frames(path, parts, v, &best, params->ease);
    if (focus_frames(path, &n->aperture, parts, test, v, subjects, params, err)) return err->status;
    n->blur = widest_blur(path);
    return ST_OK;
}

/* Of the film's frames, not of the rules they were made by: how far subjects are off the promised size and place. */
static void check_subjects(struct move_notes *n, const struct camera_path *path, const struct validity *v,
                           const struct subject_list *subjects)
{
    const enum move move = v->effect.move;
    const int last = path->frame_count - 1, count = move_subjects(move);
    const struct view *ends[2] = {&path->frames[0].camera, &path->frames[last].camera};

    if (!count) return;
    if (move == MOVE_DOLLY_ZOOM || move == MOVE_DOLLY_ZOOM_IN) {
        const double promised = subject_size_in(&subjects->subjects[0], ends[0]);
        for (int i = 1; i <= last; i++) {
            const double size = subject_size_in(&subjects->subjects[0], &path->frames[i].camera);
            n->size_error = fmax(n->size_error, fabs(size / promised - 1));
        }
        return;
    }
    for (int i = 0; i < 2; i++) {
        const int close = move == MOVE_DOLLY_IN, two = count == 2;
        if (!two && i != close) continue; /* the wide end shows the scene */
        const struct subject *s = &subjects->subjects[two ? i : 0];
        const struct vec3 target = two ? subject_center(s) : subject_lower_center(s);
        double u = HUGE_VAL, w = HUGE_VAL;
        view_project(ends[i], target, &u, &w);
        n->place_error = fmax(n->place_error, hypot(u - ends[i]->cx, w - ends[i]->cy));
    }
    if (count == 2)
        n->size_error = fabs(
            subject_size_in(&subjects->subjects[1], ends[1]) / subject_size_in(&subjects->subjects[0], ends[0]) - 1);
}

static enum status add_scores(struct camera_path *path, const struct move_notes *n, const struct validity *v,
                              struct err *err)
{
    const struct move_ends *e = &n->ends, *d = &n->chosen.discrete;
    const struct {
        const char *name, *unit;
        double value;
        bool wanted;
    } scores[] = {
        {"length", "scene units", e->length, true},
        {"length_of_thesis", "scene units", d->length, true},
        {"angle", "degrees", e->angle, true},
        {"parallax", "frames", e->parallax, true},
        {"parallax_of_thesis", "frames", d->parallax, true},
        {"worst_h", "", e->worst_h, true},
        {"worst_h_at", "", e->worst_at, true},
        {"worst_h_of_thesis", "", d->worst_h, isfinite(d->worst_h)},
        {"worst_outside", "", e->worst_outside, true},
        {"h_limit", "", v->limits.max_h, true},
        {"outside_limit", "", v->limits.max_outside, true},
        {"zoom", "", v->zoom, true},
        {"aperture", "scene units", n->aperture, v->effect.focus != FOCUS_ALL},
        {"blur", "px", n->blur, v->effect.focus != FOCUS_ALL},
        {"subject_size_error", "", n->size_error, n->size_error > 0},
        {"subject_place_error", "px", n->place_error, n->place_error > 0},
    };
    for (size_t i = 0; i < sizeof scores / sizeof *scores; i++)
        if (scores[i].wanted && camera_path_add_score(path, scores[i].name, scores[i].value, scores[i].unit, err))
            return err->status;
    return ST_OK;
}

enum status plan_move(struct camera_path *path, struct effects *layers, struct move_notes *notes,
                      const struct layer_scene *scene, const struct validity *v, const struct subject_list *subjects,
                      const struct plan_params *params, struct err *err)
{
    struct scene_points points = {0};
    struct viewpoint_test test = {.scene = scene, .points = &points, .shot = &v->shot, .limits = v->limits};
    char name[EFFECT_NAME_SIZE];
    double *parts = NULL;

    *notes = (struct move_notes){.aperture = 0};
    film_effect_name(&v->effect, name);
    enum status st = plan_params_check(params, err);
    const struct scene_subjects has = scene_subjects_of(subjects);
    if (!st) st = film_effect_check(&v->effect, &has, err);
    if (!st) st = ends_choose(&notes->ends, &notes->chosen, scene, v, params, err);
    if (!st && !isfinite(notes->ends.worst_h))
        st = err_set(err, ST_DATA, "%s: a part of the way sees nothing of the scene, even close to the origin.", name);
    if (!st) {
        turn_round(&notes->ends, v);
        notes->stands_still = !(notes->ends.length > STILL * v->shot.median_depth);
        st = camera_path_init(path, name, params->fps, (int)round(params->seconds * params->fps), err);
    }
    if (!st && !(parts = malloc((size_t)path->frame_count * sizeof *parts)))
        st = err_nomem(err, "frames", (size_t)path->frame_count * sizeof *parts);
    if (!st) fill_frames(path, parts, v, &notes->ends, params->ease);
    if (!st && v->effect.focus) {
        st = scene_points_collect(&points, scene, err);
        if (!st) st = open_aperture(path, parts, notes, &test, v, subjects, params, err);
    }
    if (!st) st = tone_layers(layers, v, subjects, path, params, err);
    if (!st) {
        check_subjects(notes, path, v, subjects);
        st = add_scores(path, notes, v, err);
    }
    free(parts);
    scene_points_release(&points);
    viewpoint_test_release(&test);
    if (st) {
        camera_path_release(path);
        effects_release(layers);
    }
    return st;
}
