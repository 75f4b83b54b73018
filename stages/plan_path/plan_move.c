/* plan_move.c - planning of a move: ends, frames, aperture and focus, colour layers, scores.
 *
 * The ends (ends.c) fix the camera of every frame: position, target and focal length run linearly between the two ends,
 * eased in time [Colburn 2014, 3.4.2]. Then come the image effects of 3.4.3 (image_effects.c). Ends on the border of
 * the valid region leave an aperture no room, since its corners would be invalid; the thesis does not treat this case.
 * Here the ends are drawn in step by step until the aperture opens far enough.
 *
 * The scores compare the result with the thesis's discrete choice and state by how much the finished frames miss the
 * sizes and targets that the move promises. */
#include "stages/plan_path/plan_move.h"

#include <stdlib.h>

#define PARAM_STRUCT struct plan_params
const struct param plan_param_table[] = {PLAN_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define ROOM_STEPS 7    /* attempts to draw in the ends until the aperture opens */
#define ROOM_STEP  0.1  /* part of the way to the origin, per attempt */
#define MIN_LENGTH 1e-6 /* median depths: a shorter move is static */

enum status plan_params_check(const void *values, struct err *err)
{
    const struct plan_params *p = values;
    if (p->seconds * p->fps >= 1.5) return ST_OK;
    return err_set(err, ST_USAGE,
                   "seconds = %g at fps = %g give fewer than two frames, a film needs at least two; raise seconds.",
                   p->seconds, p->fps);
}

/* Makes an establishing dolly run to the right, or upwards if it is nearly vertical, which viewers expect. Its ends
 * follow the same rule, so they may be swapped. */
static void orient_establishing_dolly(struct move_ends *e, const struct validity *v)
{
    const struct view camera = shot_aim(&v->shot, v->shot.origin, v->shot.centroid, v->shot.lens.fx);
    const struct vec3 step = vec3_sub(e->at[1], e->at[0]), in_camera = mat3_apply(camera.cam_from_world, step);
    const double sideways = fabs(in_camera.x) > 0.1 * vec3_length(step) ? in_camera.x : -in_camera.y;
    if (v->effect.move != MOVE_ESTABLISHING_DOLLY || sideways >= 0) return;
    const struct vec3 first = e->at[0];
    e->at[0] = e->at[1];
    e->at[1] = first;
    e->worst_at = 1 - e->worst_at;
}

static void fill_frames(struct camera_path *path, double *fractions, const struct validity *v,
                        const struct move_ends *e, const char *ease)
{
    const struct vec3 at[2] = {e->at[0], e->at[1]};
    for (int i = 0; i < path->frame_count; i++) {
        const char *name = path->frames[i].camera.name;
        const double t = path_fraction(i, path->frame_count, ease);
        fractions[i] = t;
        path->frames[i].camera = shot_camera(&v->shot, &v->move, at, t);
        path->frames[i].camera.name = name;
    }
}

/* The widest circle of confusion of an infinitely far point, px. */
static double widest_blur(const struct camera_path *path)
{
    double widest = 0;
    for (int i = 0; i < path->frame_count; i++) {
        const struct path_frame *f = &path->frames[i];
        if (f->aperture > 0) widest = fmax(widest, f->aperture * f->camera.fx / f->focus);
    }
    return widest;
}

/* Sets apertures and focus. Draws the ends in towards the origin step by step until the aperture gives half of
 * max_blur; if it never does, takes the ends for which it opens widest. */
static enum status open_aperture(struct camera_path *path, double *fractions, struct move_notes *n,
                                 struct viewpoint_test *test, const struct validity *v,
                                 const struct subject_list *subjects, const struct plan_params *params, struct err *err)
{
    const double enough = 0.5 * params->max_blur * fmax(v->shot.lens.width, v->shot.lens.height);
    const struct move_ends chosen = n->ends;
    struct move_ends best = chosen;
    double widest = -1;

    for (int i = 0; i < ROOM_STEPS && widest < enough; i++) {
        struct move_ends e = chosen;
        for (int k = 0; k < 2; k++) {
            const struct vec3 offset = vec3_sub(chosen.at[k], v->shot.origin);
            e.at[k] = vec3_add(v->shot.origin, vec3_scale(offset, 1 - ROOM_STEP * i));
        }
        if (i && ends_measure(&e, test->scene, v, params, err)) return err->status;
        if (i && !e.valid) continue;
        fill_frames(path, fractions, v, &e, params->ease);
        if (effects_focus(path, &n->aperture, fractions, test, v, subjects, params, err)) return err->status;
        if (widest_blur(path) > widest) widest = widest_blur(path), best = e;
    }
    n->ends = best;
    fill_frames(path, fractions, v, &best, params->ease);
    if (effects_focus(path, &n->aperture, fractions, test, v, subjects, params, err)) return err->status;
    n->blur = widest_blur(path);
    return ST_OK;
}

/* Measures in the finished frames by how much subjects miss the size and position that the move promises. */
static void check_subjects(struct move_notes *n, const struct camera_path *path, const struct validity *v,
                           const struct subject_list *subjects)
{
    const enum camera_move move = v->effect.move;
    const int last = path->frame_count - 1, count = film_move_subjects(move);
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
        if (!two && i != close) continue; /* the wide end points at the centroid */
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
    double *fractions = NULL;

    *notes = (struct move_notes){.aperture = 0};
    film_effect_name(&v->effect, name);
    plan_params_check(params, err);
    const struct scene_subjects available = film_scene_subjects(subjects);
    if (!err->status && !film_effect_check(&v->effect, &available, err))
        ends_choose(&notes->ends, &notes->chosen, scene, v, params, err);
    if (!err->status && !isfinite(notes->ends.worst_h))
        err_set(err, ST_DATA,
                "%s: some frames show nothing of the scene, even close to the origin; see the depth maps.", name);
    if (!err->status) {
        orient_establishing_dolly(&notes->ends, v);
        notes->is_static = !(notes->ends.length > MIN_LENGTH * v->shot.median_depth);
        camera_path_init(path, name, params->fps, (int)round(params->seconds * params->fps), err);
    }
    if (!err->status && !(fractions = malloc((size_t)path->frame_count * sizeof *fractions)))
        err_nomem(err, "frames", (size_t)path->frame_count * sizeof *fractions);
    if (!err->status) fill_frames(path, fractions, v, &notes->ends, params->ease);
    if (!err->status && v->effect.focus && !scene_points_collect(&points, scene, err))
        open_aperture(path, fractions, notes, &test, v, subjects, params, err);
    if (!err->status) effects_tone_layers(layers, v, subjects, path, params, err);
    if (!err->status) {
        check_subjects(notes, path, v, subjects);
        add_scores(path, notes, v, err);
    }
    free(fractions);
    scene_points_release(&points);
    viewpoint_test_release(&test);
    if (err->status) {
        camera_path_release(path);
        effects_release(layers);
    }
    return err->status;
}
