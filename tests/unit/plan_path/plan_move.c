/* plan_move.c - tests of all moves of the taxonomy over a wall with a box in front of it, and of hard cases: few views,
 * collinear or coincident centres, no valid viewpoint, an aperture that cannot open. */
#include "stages/plan_path/plan_move.h"

#include "common/base/parallel.h"
#include "stages/plan_path/parallax.h"
#include "stages/sample_validity/sample.h"
#include "tests/unit/scratch.h"
#include "tests/unit/wall_scene.h"

/* The first is on the box, the second on the wall beside it. */
static struct subject two_subjects[2];
static struct subject_list subjects = {two_subjects, 2};
static const struct subject_list nobody;

static int set_up(void **state)
{
    (void)state;
    two_subjects[0] = upright_subject(0.5, 0.3, 6, 0.3, 0.4);
    two_subjects[1] = upright_subject(-1.5, 0.2, 10, 0.5, 0.8);
    return 0;
}

static struct validity_params quick_sampling(void)
{
    struct validity_params p = VALIDITY_PARAMS_DEFAULT;
    p.grid = 6;
    p.check_side = W;
    p.tolerance = 0.02;
    p.check_cells = 0;
    return p;
}

static struct plan_params quick(void)
{
    struct plan_params p = PLAN_PARAMS_DEFAULT;
    p.seconds = 1;
    p.parallax_side = 96;
    return p;
}

/* --------------------------------------------------------------------------------- planning, and checks of any path */

struct planned_film {
    struct validity v;
    struct camera_path path;
    struct effects layers;
    struct move_notes notes;
    struct sampling_notes sampling;
};

static double score(const struct camera_path *p, const char *name)
{
    for (int i = 0; i < p->score_count; i++)
        if (!strcmp(p->scores[i].name, name)) return p->scores[i].value;
    fail_msg("no score %s", name);
    return 0;
}

static bool has_score(const struct camera_path *p, const char *name)
{
    for (int i = 0; i < p->score_count; i++)
        if (!strcmp(p->scores[i].name, name)) return true;
    return false;
}

static void sample(struct planned_film *film, const struct wall_scene *f, struct film_effect effect,
                   const struct validity_params *params)
{
    struct err err = ERR_INIT;
    *film = (struct planned_film){.v = {.zoom = 0}};
    if (validity_sample(&film->v, &film->sampling, &f->scene, NULL, &subjects, &effect, params, &err))
        fail_msg("%s", err.text);
}

static void plan(struct planned_film *film, const struct wall_scene *f, const struct plan_params *params)
{
    static const char *const always[] = {"length",  "length_of_thesis", "angle",         "parallax",
                                         "worst_h", "worst_h_at",       "worst_outside", "parallax_of_thesis",
                                         "h_limit", "outside_limit",    "zoom"};
    struct err err = ERR_INIT;
    char name[EFFECT_NAME_SIZE];
    const struct subject_list *of = film_move_subjects(film->v.effect.move) ? &subjects : &nobody;
    if (plan_move(&film->path, &film->layers, &film->notes, &f->scene, &film->v, of, params, &err))
        fail_msg("%s", err.text);
    const struct camera_path *p = &film->path;
    film_effect_name(&film->v.effect, name);
    assert_string_equal(p->effect, name);
    assert_int_equal(p->frame_count, (int)round(params->seconds * params->fps));
    for (int i = 0; i < p->frame_count; i++) {
        const struct path_frame *frame = &p->frames[i];
        assert_camera(&frame->camera);
        assert_float_equal(frame->time, i / params->fps, 1e-12);
        assert_true(fabs(vec3_dot(row_of(frame->camera.cam_from_world, 0), film->v.shot.up)) < 1e-9); /* no roll */
        assert_true(vec3_dot(row_of(frame->camera.cam_from_world, 1), film->v.shot.up) < -0.5);
        assert_true((frame->aperture > 0) == (frame->focus > 0) && frame->aperture >= 0);
    }
    for (size_t i = 0; i < sizeof always / sizeof *always; i++) assert_true(has_score(p, always[i]));
    for (int i = 0; i < p->score_count; i++) assert_true(isfinite(p->scores[i].value));
    assert_float_equal(score(p, "length"),
                       vec3_length(vec3_sub(p->frames[p->frame_count - 1].camera.center, p->frames[0].camera.center)),
                       1e-9);
    assert_true(score(p, "angle") <= params->max_angle + 1e-6);
    assert_true(score(p, "h_limit") == film->v.limits.max_h);
    assert_true(has_score(p, "aperture") == (film->v.effect.focus != FOCUS_ALL));
}

static void release(struct planned_film *film)
{
    camera_path_release(&film->path);
    effects_release(&film->layers);
    validity_release(&film->v);
}

/* Measures every frame again. Frames may be invalid only if an end has no valid viewpoint, which the notes then
 * state. */
static void assert_all_frames_valid(const struct planned_film *film, const struct wall_scene *f)
{
    struct scene_points points;
    struct err err = ERR_INIT;
    const bool none = film->sampling.no_valid[0] || film->sampling.no_valid[1];
    assert_ok(scene_points_collect(&points, &f->scene, &err), err);
    struct viewpoint_test test = {
        .scene = &f->scene, .points = &points, .shot = &film->v.shot, .limits = film->v.limits};
    assert_true(film->notes.ends.valid || none);
    for (int i = 0; i < film->path.frame_count; i++) {
        struct viewpoint v;
        assert_ok(viewpoint_measure(&v, &test, &film->path.frames[i].camera, &err), err);
        if (film->notes.ends.valid && !(v.h < film->v.limits.max_h))
            fail_msg("move %d, frame %d: H is %g", film->v.effect.move, i, v.h);
        assert_true(v.h <= score(&film->path, "worst_h"));
        assert_true(v.outside <= score(&film->path, "worst_outside"));
    }
    viewpoint_test_release(&test);
    scene_points_release(&points);
}

static const struct view *camera(const struct planned_film *film, int i)
{
    return &film->path.frames[i < 0 ? film->path.frame_count + i : i].camera;
}

static struct film_effect move_alone(enum camera_move move) { return (struct film_effect){move, FOCUS_ALL, TONE_NONE}; }

/* Nine views in a slightly irregular square of 2 by 2 that point at one spot, as hand-held photos do. */
static void nine_views(struct wall_scene *f)
{
    *f = (struct wall_scene){.scene = {.sigma = 0}};
    for (int i = 0; i < 9; i++)
        add_view(f, vec3_make(i % 3 - 1 + 0.05 * (i / 3), i / 3 - 1, 0.05 * sin(i)), vec3_make(0, 0, 9),
                 vec3_make(0, 1, 0));
    finish(f, wall_and_box, 2);
}

/* Plans a move with default settings and checks what holds for every move. */
static void make(struct planned_film *film, struct wall_scene *f, enum camera_move move)
{
    const struct validity_params sampling = quick_sampling();
    const struct plan_params params = quick();
    nine_views(f);
    sample(film, f, move_alone(move), &sampling);
    plan(film, f, &params);
    assert_false(film->notes.is_static);
    assert_true(score(&film->path, "parallax") > 0);
    assert_true(film->layers.layer_count == 0);
    assert_all_frames_valid(film, f);
}

static void release_all(struct planned_film *film, struct wall_scene *f)
{
    release(film);
    layer_scene_release(&f->scene);
}

static void establishing_dolly_moves_right_and_points_at_the_centroid(void **state)
{
    (void)state;
    struct planned_film film;
    struct wall_scene f;
    make(&film, &f, MOVE_ESTABLISHING_DOLLY);
    const struct vec3 centroid = film.v.shot.centroid;
    assert_true(centroid.z > 5.9 && centroid.z < 10.1);
    for (int i = 0; i < 30; i++) {
        assert_true(off_axis(camera(&film, i), centroid) < 1e-6);
        assert_float_equal(camera(&film, i)->fx, W * film.v.zoom, 1e-9);
    }
    assert_int_equal(camera(&film, 0)->width, W);
    assert_int_equal(camera(&film, 0)->height, H);
    assert_true(camera(&film, 0)->center.x < -0.5 && camera(&film, -1)->center.x > 0.5);
    release_all(&film, &f);
}

static void establishing_dolly_out_moves_back_on_the_axis(void **state)
{
    (void)state;
    struct planned_film film;
    struct wall_scene f;
    make(&film, &f, MOVE_ESTABLISHING_DOLLY_OUT);
    for (int i = 0; i < 30; i++) {
        const struct vec3 c = shot_from_world(&film.v.shot, camera(&film, i)->center);
        assert_true(fabs(c.x) < 1e-9 && fabs(c.y) < 1e-9);
        assert_true(off_axis(camera(&film, i), film.v.shot.centroid) < 1e-6);
    }
    assert_true(camera(&film, 0)->center.z > camera(&film, -1)->center.z + 0.5);
    assert_float_equal(camera(&film, 0)->fx, 1.5 * film.v.shot.lens.fx, 1e-9);
    assert_float_equal(camera(&film, -1)->fx, film.v.shot.lens.fx, 1e-9);
    release_all(&film, &f);
}

static void dollies_in_and_out_have_a_close_end_at_the_subject(void **state)
{
    (void)state;
    for (int out = 0; out < 2; out++) {
        struct planned_film film;
        struct wall_scene f;
        make(&film, &f, out ? MOVE_DOLLY_OUT : MOVE_DOLLY_IN);
        const struct view *wide = camera(&film, out ? -1 : 0), *close = camera(&film, out ? 0 : -1);
        assert_true(off_axis(wide, film.v.shot.centroid) < 1e-6);
        assert_true(off_axis(close, subject_lower_center(&two_subjects[0])) < 1e-6);
        assert_float_equal(wide->fx, film.v.shot.lens.fx, 1e-9);
        assert_float_equal(close->fx, 1.5 * film.v.shot.lens.fx, 1e-9);
        if (!(close->center.z > wide->center.z))
            fail_msg("%d: close at %g %g %g, wide at %g %g %g; cells %d %d; chosen %d still %d", out, close->center.x,
                     close->center.y, close->center.z, wide->center.x, wide->center.y, wide->center.z,
                     validity_region_count(&film.v.region[0]), validity_region_count(&film.v.region[1]),
                     film.notes.chosen.chosen, film.notes.is_static);
        assert_true(film.notes.place_error < 1e-6);
        release_all(&film, &f);
    }
}

static void dolly_zooms_keep_the_subjects_size(void **state)
{
    (void)state;
    for (int in = 0; in < 2; in++) {
        struct planned_film film;
        struct wall_scene f;
        make(&film, &f, in ? MOVE_DOLLY_ZOOM_IN : MOVE_DOLLY_ZOOM);
        const double promised = film.v.move.end[0].size, direction = in ? 1 : -1;
        for (int i = 0; i < 30; i++) {
            assert_float_equal(subject_size_in(&two_subjects[0], camera(&film, i)), promised, 1e-6);
            const struct vec3 c = shot_from_world(&film.v.shot, camera(&film, i)->center);
            assert_true(fabs(c.x) < 1e-9 && fabs(c.y) < 1e-9);
            if (i) assert_true(direction * (camera(&film, i)->center.z - camera(&film, i - 1)->center.z) > 0);
            if (i) assert_true(direction * (camera(&film, i - 1)->fx - camera(&film, i)->fx) > 0);
        }
        assert_true(film.notes.size_error < 0.01);
        release_all(&film, &f);
    }
}

static void dolly_runs_from_the_first_subject_to_the_second(void **state)
{
    (void)state;
    struct planned_film film;
    struct wall_scene f;
    make(&film, &f, MOVE_DOLLY);
    assert_true(off_axis(camera(&film, 0), subject_center(&two_subjects[0])) < 1e-6);
    assert_true(off_axis(camera(&film, -1), subject_center(&two_subjects[1])) < 1e-6);
    const double first = subject_size_in(&two_subjects[0], camera(&film, 0));
    assert_float_equal(subject_size_in(&two_subjects[1], camera(&film, -1)), first, 1e-6);
    assert_true(film.notes.size_error < 0.01 && film.notes.place_error < 1e-6);
    release_all(&film, &f);
}

/* ------------------------------------------------------------------------------------------ the ends and the frames */

static void easing_slows_down_both_ends(void **state)
{
    (void)state;
    struct wall_scene f;
    struct planned_film film;
    struct plan_params params = quick();
    const struct validity_params sampling = quick_sampling();
    nine_views(&f);
    sample(&film, &f, move_alone(MOVE_ESTABLISHING_DOLLY), &sampling);
    for (int smooth = 0; smooth < 2; smooth++) {
        strcpy(params.ease, smooth ? "smooth" : "none");
        plan(&film, &f, &params);
        double step[29], min = HUGE_VAL, max = 0;
        for (int i = 0; i < 29; i++) {
            step[i] = camera(&film, i + 1)->center.x - camera(&film, i)->center.x;
            min = fmin(min, step[i]);
            max = fmax(max, step[i]);
        }
        assert_true(min > 0);
        if (smooth)
            assert_true(step[0] < 0.2 * max && step[28] < 0.2 * max && step[14] == max);
        else
            assert_true(max - min < 1e-9);
        camera_path_release(&film.path);
    }
    release_all(&film, &f);
}

static void end_picture(struct depth_picture *d, const struct wall_scene *f, const struct validity *v, int end,
                        struct vec3 at, int side)
{
    struct err err = ERR_INIT;
    const struct view c = shot_end_camera(&v->shot, &v->move.end[end], at);
    assert_ok(parallax_picture_make(d, &f->scene, &c, side, &err), err);
}

static double parallax_of(const struct wall_scene *f, const struct validity *v, const struct vec3 at[2], int side)
{
    struct depth_picture pictures[2];
    for (int k = 0; k < 2; k++) end_picture(&pictures[k], f, v, k, at[k], side);
    const double parallax = parallax_between(&pictures[0], &pictures[1], parallax_tolerance(&f->scene));
    for (int k = 0; k < 2; k++) parallax_picture_release(&pictures[k]);
    return parallax;
}

static double angle_of(const struct validity *v, const struct vec3 at[2])
{
    const struct vec3 a = vec3_sub(at[0], v->shot.centroid), b = vec3_sub(at[1], v->shot.centroid);
    return acos(vec3_dot(a, b) / vec3_length(a) / vec3_length(b)) * 180 / M_PI;
}

/* All pairs of cells, in small pictures; the ends stay on the grid. */
static void compare_all_pairs(struct plan_params *params)
{
    params->pairs = 20736;
    params->parallax_side = 48;
    strcpy(params->refine, "no");
}

/* With an angle limit that excludes pairs and with one that does not. */
static void all_pairs_agree_with_brute_force(void **state)
{
    (void)state;
    static const enum camera_move moves[] = {MOVE_ESTABLISHING_DOLLY, MOVE_DOLLY_IN, MOVE_DOLLY};
    enum { CELLS = 16 };
    struct wall_scene f;
    struct validity_params sampling = quick_sampling();
    struct plan_params params = quick();
    sampling.grid = 4;
    sampling.extent = 1;
    compare_all_pairs(&params);
    nine_views(&f);
    for (size_t m = 0; m < sizeof moves / sizeof *moves; m++) {
        struct planned_film film;
        struct depth_picture pictures[2][CELLS] = {{{.z = NULL}}};
        sample(&film, &f, move_alone(moves[m]), &sampling);
        for (int i = 0; i < 2 * CELLS; i++)
            if (film.v.region[i / CELLS].cells[i % CELLS].valid)
                end_picture(&pictures[i / CELLS][i % CELLS], &f, &film.v, i / CELLS,
                            ends_candidate(&film.v, i / CELLS, i % CELLS, SIDE_OWN), params.parallax_side);
        for (int narrow = 0; narrow < 2; narrow++) {
            double best = -1;
            int counted = 0;
            params.max_angle = narrow ? 8 : 180;
            for (int a = 0; a < CELLS; a++)
                for (int b = 0; b < CELLS; b++) {
                    if (!film.v.region[0].cells[a].valid || !film.v.region[1].cells[b].valid) continue;
                    const struct vec3 at[2] = {ends_candidate(&film.v, 0, a, SIDE_OWN),
                                               ends_candidate(&film.v, 1, b, SIDE_OWN)};
                    if (angle_of(&film.v, at) > params.max_angle) continue;
                    const double advance =
                        shot_from_world(&film.v.shot, at[1]).z - shot_from_world(&film.v.shot, at[0]).z;
                    if (moves[m] == MOVE_DOLLY_IN && advance < 0.5 * vec3_length(vec3_sub(at[1], at[0]))) continue;
                    best = fmax(best, parallax_between(&pictures[0][a], &pictures[1][b], parallax_tolerance(&f.scene)));
                    counted++;
                }
            if (!(counted > (narrow ? 3 : 20)))
                fail_msg("move %d narrow %d: %d; cells %d %d", (int)m, narrow, counted,
                         validity_region_count(&film.v.region[0]), validity_region_count(&film.v.region[1]));
            plan(&film, &f, &params);
            const struct ends_notes *n = &film.notes.chosen;
            assert_int_equal(n->pairs, counted);
            assert_true(n->discrete.parallax == best);
            assert_false(n->refined);
            if (n->chosen == 0) assert_true(film.notes.ends.parallax == best);
            if (n->chosen >= 0) {
                assert_true(film.notes.ends.valid);
                assert_true(film.notes.ends.parallax ==
                            parallax_of(&f, &film.v, film.notes.ends.at, params.parallax_side));
            }
            camera_path_release(&film.path);
        }
        for (int i = 0; i < 2 * CELLS; i++) parallax_picture_release(&pictures[i / CELLS][i % CELLS]);
        release(&film);
    }
    layer_scene_release(&f.scene);
}

static void refinement_never_loses_parallax(void **state)
{
    (void)state;
    struct wall_scene f;
    struct validity_params sampling = quick_sampling();
    struct plan_params params = quick();
    bool any_refined = false;
    nine_views(&f);
    params.fps = 10;
    params.parallax_side = 48;
    sampling.grid = 4;
    for (int move = 0; move < MOVE_COUNT; move++) {
        struct planned_film film;
        sample(&film, &f, move_alone((enum camera_move)move), &sampling);
        params.max_angle = move % 2 ? 12 : 25;
        strcpy(params.refine, "no");
        plan(&film, &f, &params);
        const struct move_ends grid = film.notes.ends;
        camera_path_release(&film.path);
        strcpy(params.refine, "yes");
        plan(&film, &f, &params);
        const struct move_ends *e = &film.notes.ends;
        assert_true(e->parallax >= grid.parallax && e->valid >= grid.valid);
        assert_true(e->angle <= params.max_angle * (1 + 1e-9));
        if (!film.notes.chosen.refined) assert_memory_equal(e->at, grid.at, sizeof e->at);
        if (film.notes.chosen.refined) assert_true(e->parallax > grid.parallax);
        assert_false(film.v.move.on_axis && film.notes.chosen.refined);
        any_refined |= film.notes.chosen.refined;
        release(&film);
    }
    assert_true(any_refined);
    layer_scene_release(&f.scene);
}

/* What the end that shows less shows of the scene, as a part of what the centremost view shows. */
static double least_shown(const struct planned_film *film, const struct wall_scene *f)
{
    const struct validity *v = &film->v;
    struct scene_points points = {0};
    struct err err = ERR_INIT;
    double least = HUGE_VAL;
    assert_ok(scene_points_collect(&points, &f->scene, &err), err);
    const struct viewpoint_test test = {.scene = &f->scene, .points = &points, .shot = &v->shot, .limits = v->limits};
    for (int k = 0; k < 2; k++) {
        const struct view center = shot_end_camera(&v->shot, &v->move.end[k], v->shot.origin),
                          end = shot_end_camera(&v->shot, &v->move.end[k], film->notes.ends.at[k]);
        least = fmin(least, viewpoint_pixels_within(&test, &end) / viewpoint_pixels_within(&test, &center));
    }
    scene_points_release(&points);
    return least;
}

static void both_ends_of_an_establishing_dolly_show_most_of_the_scene(void **state)
{
    (void)state;
    struct wall_scene f;
    struct validity_params sampling = quick_sampling();
    struct plan_params params = quick();
    struct planned_film film;
    double shown[2], parallax[2];
    nine_views(&f);
    sampling.grid = 6;
    sampling.extent = 1;
    sample(&film, &f, move_alone(MOVE_ESTABLISHING_DOLLY), &sampling);
    for (int limited = 0; limited < 2; limited++) {
        params.min_shown = limited ? 0.9 : 0;
        plan(&film, &f, &params);
        assert_true(film.notes.ends.valid && film.notes.chosen.chosen >= 0);
        shown[limited] = least_shown(&film, &f);
        parallax[limited] = film.notes.ends.parallax;
        camera_path_release(&film.path);
    }
    release(&film);
    layer_scene_release(&f.scene);
    if (!(shown[0] < 0.85 && shown[1] >= 0.9 && parallax[0] > parallax[1]))
        fail_msg("shown %g %g, parallax %g %g", shown[0], shown[1], parallax[0], parallax[1]);
}

static void any_thread_count_gives_the_same_path(void **state)
{
    (void)state;
    static const struct film_effect effects[] = {{MOVE_ESTABLISHING_DOLLY, FOCUS_ALL, TONE_NONE},
                                                 {MOVE_DOLLY_ZOOM, FOCUS_NARROW, TONE_DIM},
                                                 {MOVE_DOLLY, FOCUS_PULL, TONE_NONE}};
    struct wall_scene f;
    const struct validity_params sampling = quick_sampling();
    const struct plan_params params = quick();
    nine_views(&f);
    for (size_t k = 0; k < sizeof effects / sizeof *effects; k++) {
        struct planned_film a, b;
        parallel_set_threads(1);
        sample(&a, &f, effects[k], &sampling);
        plan(&a, &f, &params);
        parallel_set_threads(3);
        sample(&b, &f, effects[k], &sampling);
        plan(&b, &f, &params);
        assert_int_equal(a.path.score_count, b.path.score_count);
        for (int i = 0; i < a.path.score_count; i++) assert_true(a.path.scores[i].value == b.path.scores[i].value);
        for (int i = 0; i < a.path.frame_count; i++) {
            const struct path_frame *p = &a.path.frames[i], *q = &b.path.frames[i];
            assert_memory_equal(&p->camera.cam_from_world, &q->camera.cam_from_world, sizeof p->camera.cam_from_world);
            assert_memory_equal(&p->camera.center, &q->camera.center, sizeof p->camera.center);
            assert_true(p->camera.fx == q->camera.fx && p->aperture == q->aperture && p->focus == q->focus);
        }
        release(&a);
        release(&b);
    }
    layer_scene_release(&f.scene);
}

/* ---------------------------------------------------------------------------------------------------- image effects */

static void the_aperture_opens_with_the_subject_in_focus(void **state)
{
    (void)state;
    static const enum focus_effect focuses[] = {FOCUS_NARROW, FOCUS_WIDEN};
    struct wall_scene f;
    const struct validity_params sampling = quick_sampling();
    const struct plan_params params = quick();
    nine_views(&f);
    for (int k = 0; k < 2; k++) {
        struct planned_film film;
        const int narrow = focuses[k] == FOCUS_NARROW;
        sample(&film, &f, (struct film_effect){MOVE_DOLLY_ZOOM, focuses[k], TONE_NONE}, &sampling);
        plan(&film, &f, &params);
        const double widest = film.notes.aperture;
        assert_true(widest > 0 && score(&film.path, "aperture") == widest);
        for (int i = 0; i < 30; i++) {
            const struct path_frame *at = &film.path.frames[i];
            const double linear = i / 29.0, t = linear * linear * (3 - 2 * linear), open = narrow ? t : 1 - t;
            double u, w;
            assert_float_equal(at->aperture, widest * open, 1e-12);
            if (at->aperture > 0)
                assert_float_equal(at->focus, view_project(&at->camera, subject_center(&two_subjects[0]), &u, &w),
                                   1e-9);
        }
        /* the blur at infinity, aperture fx / focus px, keeps its limit */
        const struct path_frame *open = &film.path.frames[narrow ? 29 : 0];
        assert_true(open->aperture * open->camera.fx / open->focus <= params.max_blur * W * (1 + 1e-9));
        release(&film);
    }
    layer_scene_release(&f.scene);
}

static void focus_is_pulled_from_the_first_to_the_second_subject(void **state)
{
    (void)state;
    struct wall_scene f;
    struct planned_film film;
    const struct validity_params sampling = quick_sampling();
    const struct plan_params params = quick();
    double u, w;
    nine_views(&f);
    sample(&film, &f, (struct film_effect){MOVE_DOLLY, FOCUS_PULL, TONE_NONE}, &sampling);
    plan(&film, &f, &params);
    assert_true(film.notes.aperture > 0);
    for (int i = 0; i < 30; i++) assert_true(film.path.frames[i].aperture == film.notes.aperture);
    assert_float_equal(film.path.frames[0].focus,
                       view_project(camera(&film, 0), subject_center(&two_subjects[0]), &u, &w), 1e-9);
    assert_float_equal(film.path.frames[29].focus,
                       view_project(camera(&film, -1), subject_center(&two_subjects[1]), &u, &w), 1e-9);
    release_all(&film, &f);
}

/* A subject's box is as large as its rectangle, along the rectangle's axes, and 1.5 heights deep. */
static void assert_tight_box(const struct effect_box *b, const struct subject *s)
{
    const struct vec3 *c = s->corner, size = vec3_sub(b->high, b->low);
    const double width = vec3_length(vec3_sub(c[1], c[0])), height = vec3_length(vec3_sub(c[3], c[0]));
    const struct vec3 middle = vec3_scale(vec3_add(b->low, b->high), 0.5);
    const struct mat3 box_from_world = mat3_from_quat(b->box_from_world);
    assert_float_equal(size.x, width, 1e-12);
    assert_float_equal(size.y, height, 1e-12);
    assert_float_equal(size.z, 1.5 * height, 1e-12);
    assert_float_equal(b->falloff, 0.35 * height, 1e-12);
    for (int i = 0; i < 4; i++) {
        const struct vec3 at = mat3_apply(box_from_world, vec3_sub(c[i], middle));
        assert_float_equal(at.x, i == 1 || i == 2 ? width / 2 : -width / 2, 1e-12);
        assert_float_equal(at.y, i >= 2 ? height / 2 : -height / 2, 1e-12);
        assert_float_equal(at.z, 0, 1e-12);
    }
}

static void a_turned_subject_has_a_tight_box(void **state)
{
    (void)state;
    struct path_frame frames[2] = {{.time = 0}, {.time = 1}};
    const struct camera_path path = {.frames = frames, .frame_count = 2};
    const struct validity v = {.effect = {MOVE_DOLLY_IN, FOCUS_ALL, TONE_DIM}};
    const struct plan_params params = PLAN_PARAMS_DEFAULT;
    struct subject s = upright_subject(0.5, 0.3, 6, 0.3, 0.4);
    const struct subject_list list = {&s, 1};
    struct err err = ERR_INIT;

    for (int i = 0; i < 16; i++) { /* also upside down, with the normal backwards */
        const struct mat3 turn = mat3_from_quat(quat_normalize((struct quat){i % 4, i / 4 - 1, 1, i % 3 - 1}));
        struct subject turned = s;
        struct effects layers;
        for (int k = 0; k < 4; k++) turned.corner[k] = mat3_apply(turn, s.corner[k]);
        assert_ok(effects_tone_layers(&layers, &v, &(struct subject_list){&turned, 1}, &path, &params, &err), err);
        assert_tight_box(&layers.layers[0].boxes[0], &turned);
        effects_release(&layers);
    }
    struct effects layers;
    assert_ok(effects_tone_layers(&layers, &v, &list, &path, &params, &err), err);
    assert_float_equal(layers.layers[0].boxes[0].box_from_world.w, 1, 1e-15); /* along the world's axes */
    effects_release(&layers);
}

static void tone_effects_are_layers_around_the_subject(void **state)
{
    (void)state;
    static const struct {
        enum tone_effect tone;
        enum effect_kind kind;
        enum effect_region region;
    } tones[] = {{TONE_SATURATE, EFFECT_SATURATION, EFFECT_INSIDE},
                 {TONE_DESATURATE, EFFECT_SATURATION, EFFECT_OUTSIDE},
                 {TONE_BRIGHTEN, EFFECT_BRIGHTNESS, EFFECT_INSIDE},
                 {TONE_DIM, EFFECT_BRIGHTNESS, EFFECT_OUTSIDE}};
    const double to[] = {1.6, 0.1, 1.5, 0.4};
    struct wall_scene f;
    const struct validity_params sampling = quick_sampling();
    const struct plan_params params = quick();
    nine_views(&f);
    for (int k = 0; k < 4; k++) {
        struct planned_film film;
        double v[3];
        sample(&film, &f, (struct film_effect){MOVE_DOLLY_ZOOM, FOCUS_ALL, tones[k].tone}, &sampling);
        plan(&film, &f, &params);
        assert_int_equal(film.layers.layer_count, 1);
        const struct effect_layer *l = &film.layers.layers[0];
        assert_true(l->kind == tones[k].kind && l->region == tones[k].region && l->box_count == 1);
        assert_tight_box(&l->boxes[0], &two_subjects[0]);
        effect_layer_value(l, 0, v);
        assert_float_equal(v[0], 1, 1e-12);
        effect_layer_value(l, film.path.frames[29].time, v);
        assert_float_equal(v[0], to[k], 1e-12);
        release(&film);
    }
    layer_scene_release(&f.scene);
}

/* ------------------------------------------------------------------------------------------------------- hard cases */

/* Plans all moves of a scene; length gets the shortest and the longest. */
static void all_moves(struct wall_scene *f, const struct rectangle *r, int count, double length[2])
{
    struct validity_params sampling = quick_sampling();
    struct plan_params params = quick();
    sampling.grid = 4;
    params.fps = 12;
    params.parallax_side = 48;
    finish(f, r, count);
    length[0] = HUGE_VAL;
    length[1] = 0;
    for (int move = 0; move < MOVE_COUNT; move++) {
        struct planned_film film;
        sample(&film, f, move_alone((enum camera_move)move), &sampling);
        plan(&film, f, &params);
        assert_all_frames_valid(&film, f);
        length[0] = fmin(length[0], film.notes.ends.length);
        length[1] = fmax(length[1], film.notes.ends.length);
        release(&film);
    }
    layer_scene_release(&f->scene);
}

static void one_view_is_enough_for_a_move(void **state)
{
    (void)state;
    struct wall_scene f = {0};
    double length[2];
    add_straight(&f, 0, 0, 0);
    all_moves(&f, wall_and_box, 2, length);
    assert_true(length[1] > 0.1);
}

static void two_views_are_enough_for_a_move(void **state)
{
    (void)state;
    struct wall_scene f = {0};
    double length[2];
    add_straight(&f, 0, 0, 0);
    add_straight(&f, 1, 0, 0);
    all_moves(&f, wall_and_box, 2, length);
    assert_true(length[1] > 0.1); /* not length[0]: no viewpoint shows the dolly's second subject */
}

static void centres_in_a_line_allow_all_moves(void **state)
{
    (void)state;
    static const struct vec3 along[] = {
        {1, 0, 0}, {0, 1, 0}, {0, 0, 0.4}, {0.5, 0.7, 0.2}}; /* the third is towards the scene */
    for (int k = 0; k < 4; k++) {
        struct wall_scene f = {0};
        double length[2];
        for (int i = -2; i <= 2; i++) add_straight(&f, i * along[k].x, i * along[k].y, i * along[k].z);
        all_moves(&f, wall_and_box, 2, length);
        assert_true(length[0] > 0.1);
    }
}

static void coincident_centres_allow_a_move(void **state)
{
    (void)state;
    struct wall_scene f = {0};
    double length[2];
    for (int i = -1; i <= 1; i++) add_view(&f, vec3_make(0, 0, 0), vec3_make(0.1 * i, 0, 1), vec3_make(0, 1, 0));
    all_moves(&f, wall_and_box, 2, length);
    assert_true(length[1] > 0.1);
}

/* Also: if only the origin is valid, the camera does not move. */
static void regions_without_a_valid_cell_are_an_error(void **state)
{
    (void)state;
    struct wall_scene f;
    const struct validity_params sampling = quick_sampling();
    struct plan_params params = quick();
    strcpy(params.refine, "no");
    nine_views(&f);
    for (int move = 0; move < MOVE_COUNT; move++) {
        struct planned_film film;
        sample(&film, &f, move_alone((enum camera_move)move), &sampling);
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < film.v.region[k].columns * film.v.region[k].rows; i++)
                film.v.region[k].cells[i] = (struct validity_cell){.valid = false};
        struct err err = ERR_INIT;
        assert_int_equal(plan_move(&film.path, &film.layers, &film.notes, &f.scene, &film.v, &subjects, &params, &err),
                         ST_DATA);
        assert_err(err, ST_DATA, "no cell of the move's regions is valid");
        assert_true(!film.path.frames && !film.layers.layers);
        film.v.region[0].cells[0] = film.v.region[1].cells[0] = (struct validity_cell){.valid = true};
        plan(&film, &f, &params);
        assert_true(film.notes.is_static && score(&film.path, "length") < 1e-12);
        for (int i = 0; i < 30; i++)
            assert_true(vec3_length(vec3_sub(camera(&film, i)->center, film.v.shot.origin)) < 1e-12);
        release(&film);
    }
    layer_scene_release(&f.scene);
}

/* Claims that viewpoints far outside are valid: cells farther than `from` from the axis, moved out by a factor. */
static void spread_cells(struct validity *v, double from, double factor)
{
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < v->region[k].columns * v->region[k].rows; i++) {
            struct validity_cell *c = &v->region[k].cells[i];
            if (!(hypot(c->x, c->y) > from)) continue;
            c->x *= factor;
            c->y *= factor;
        }
}

/* The ends are drawn in until the path is valid; it never stays invalid. */
static void ends_with_an_invalid_path_are_drawn_in(void **state)
{
    (void)state;
    struct wall_scene f;
    const struct validity_params sampling = quick_sampling();
    const struct plan_params params = quick();
    struct planned_film film;
    nine_views(&f);
    sample(&film, &f, move_alone(MOVE_ESTABLISHING_DOLLY), &sampling);
    spread_cells(&film.v, 0, 3);
    plan(&film, &f, &params);
    assert_all_frames_valid(&film, &f);
    assert_true(film.notes.ends.length > 0.1);
    release_all(&film, &f);
}

/* The outer cells may lie back, those in the middle may not: a path between outer cells is lifted to where all may be.
 */
static void a_path_is_lifted_into_what_is_valid(void **state)
{
    (void)state;
    struct wall_scene f;
    const struct validity_params sampling = quick_sampling();
    struct plan_params params = quick();
    struct planned_film film;
    double back = 0;
    strcpy(params.refine, "no");
    nine_views(&f);
    sample(&film, &f, move_alone(MOVE_ESTABLISHING_DOLLY), &sampling);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < film.v.region[k].columns * film.v.region[k].rows; i++) {
            struct validity_cell *c = &film.v.region[k].cells[i];
            if (fabs(c->x) < 0.5) c->low = 0;
            back = fmin(back, c->low);
        }
    assert_true(back < -0.1);
    plan(&film, &f, &params);
    assert_all_frames_valid(&film, &f);
    assert_true(film.notes.chosen.chosen >= 0 && film.notes.ends.length > 1);
    for (int k = 0; k < 2; k++) {
        const struct vec3 end = shot_from_world(&film.v.shot, film.notes.ends.at[k]);
        assert_true(fabs(end.x) < 0.5 || fabs(end.z) < 1e-9);
    }
    release_all(&film, &f);
}

/* The most parallax of a pair of cells whose whole path is valid, by measuring all of them. */
static double best_of_all_pairs(const struct planned_film *film, const struct wall_scene *f,
                                const struct plan_params *params)
{
    const struct validity *v = &film->v;
    const int cells = v->region[0].columns * v->region[0].rows;
    double best = 0;
    for (int a = 0; a < cells; a++)
        for (int b = 0; b < cells; b++) {
            if (!v->region[0].cells[a].valid || !v->region[1].cells[b].valid) continue;
            struct move_ends e = {.at = {ends_candidate(v, 0, a, SIDE_OWN), ends_candidate(v, 1, b, SIDE_OWN)}};
            struct err err = ERR_INIT;
            if (angle_of(v, e.at) > params->max_angle) continue;
            if (parallax_of(f, v, e.at, params->parallax_side) <= best) continue;
            assert_ok(ends_measure(&e, &f->scene, v, params, &err), err);
            if (e.valid) best = e.parallax;
        }
    return best;
}

/* Where the pairs of the most parallax have no valid path, pairs of less are tried. */
static void a_pair_of_less_parallax_replaces_invalid_ones(void **state)
{
    (void)state;
    struct wall_scene f;
    struct validity_params sampling = quick_sampling();
    struct plan_params params = quick();
    struct planned_film film;
    sampling.grid = 8;
    params.seconds = 0.2;
    compare_all_pairs(&params);
    nine_views(&f);
    sample(&film, &f, move_alone(MOVE_ESTABLISHING_DOLLY), &sampling);
    spread_cells(&film.v, 0.9, 4);
    const double best = best_of_all_pairs(&film, &f, &params);
    plan(&film, &f, &params);
    assert_all_frames_valid(&film, &f);
    assert_true(best > 0 && film.notes.chosen.chosen >= 36);
    assert_true(score(&film.path, "parallax") >= 0.9 * best);
    release_all(&film, &f);
}

/* With focus on a far wall, any opening shows a hole behind a near post. */
static void an_aperture_stays_shut_where_opening_shows_holes(void **state)
{
    (void)state;
    static const struct rectangle far_wall_and_post[] = {{0, 0, 1000, 4000, 4000}, {-1.5, 0, 6, 0.5, 40}};
    struct wall_scene f = {0};
    struct plan_params params = quick();
    struct subject far = upright_subject(0, 0, 1000, 20, 20);
    add_straight(&f, 0, 0, 0);
    finish(&f, far_wall_and_post, 2);
    struct planned_film film = {.v = {.effect = {MOVE_DOLLY_ZOOM, FOCUS_NARROW, TONE_NONE},
                                      .shot = {.lens = f.views[0],
                                               .up = {0, -1, 0},
                                               .axis_x = {1, 0, 0},
                                               .axis_y = {0, 1, 0},
                                               .axis_z = {0, 0, 1},
                                               .low = {-1, -1},
                                               .high = {1, 1},
                                               .centroid = {0, 0, 1000},
                                               .near_limit = 1,
                                               .median_depth = 1000},
                                      .zoom = 1,
                                      .step = 1,
                                      .limits = {0.01, 1, W}}};
    struct err err = ERR_INIT;
    const struct subject kept = two_subjects[0];
    two_subjects[0] = far;
    assert_ok(shot_move_make(&film.v.move, &film.v.shot, MOVE_DOLLY_ZOOM, &subjects, &err), err);
    for (int k = 0; k < 2; k++) {
        assert_ok(validity_region_init(&film.v.region[k], 1, 1, &err), err);
        film.v.region[k].cells[0].valid = true;
    }
    plan(&film, &f, &params);
    assert_true(film.notes.ends.valid && film.notes.aperture == 0 && score(&film.path, "aperture") == 0);
    for (int i = 0; i < 30; i++) assert_true(film.path.frames[i].aperture == 0 && film.path.frames[i].focus == 0);
    camera_path_release(&film.path);
    film.v.limits.max_h = 1e6; /* the holes alone kept it shut */
    plan(&film, &f, &params);
    assert_true(film.notes.aperture > 0);
    camera_path_release(&film.path);
    params.max_blur = 0; /* so does a blur limit of 0 */
    plan(&film, &f, &params);
    assert_true(film.notes.aperture == 0);
    two_subjects[0] = kept;
    release_all(&film, &f);
}

static void too_few_subjects_or_frames_are_an_error(void **state)
{
    (void)state;
    struct wall_scene f;
    struct planned_film film;
    struct plan_params params = quick();
    const struct validity_params sampling = quick_sampling();
    struct err err = ERR_INIT;
    nine_views(&f);
    sample(&film, &f, move_alone(MOVE_DOLLY), &sampling);
    const struct subject_list one = {two_subjects, 1};
    assert_int_equal(plan_move(&film.path, &film.layers, &film.notes, &f.scene, &film.v, &one, &params, &err),
                     ST_USAGE);
    assert_err(err, ST_USAGE, "dolly needs 2 subjects, and the scene has 1");
    params.seconds = 0;
    err = (struct err)ERR_INIT;
    assert_int_equal(plan_move(&film.path, &film.layers, &film.notes, &f.scene, &film.v, &subjects, &params, &err),
                     ST_USAGE);
    assert_non_null(strstr(err.text, "at least two"));
    assert_true(!film.path.frames && !film.layers.layers);
    params.seconds = 0.04; /* one frame */
    err = (struct err)ERR_INIT;
    assert_int_equal(plan_params_check(&params, &err), ST_USAGE);
    params.seconds = 0.06;
    err = (struct err)ERR_INIT;
    assert_int_equal(plan_params_check(&params, &err), ST_OK);
    release(&film);
    layer_scene_release(&f.scene);
}

static void a_scene_without_depth_is_an_error(void **state)
{
    (void)state;
    struct wall_scene f = {0}, seen;
    struct planned_film film;
    const struct plan_params params = quick();
    const struct validity_params sampling = quick_sampling();
    struct err err = ERR_INIT;
    nine_views(&seen);
    sample(&film, &seen, move_alone(MOVE_ESTABLISHING_DOLLY), &sampling);
    for (int i = 0; i < 3; i++) add_straight(&f, i, 0, 0);
    finish(&f, NULL, 0);
    assert_int_equal(plan_move(&film.path, &film.layers, &film.notes, &f.scene, &film.v, &nobody, &params, &err),
                     ST_DATA);
    assert_non_null(strstr(err.text, "no scene to move in"));
    assert_null(film.path.frames);
    layer_scene_release(&f.scene);
    release_all(&film, &seen);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(establishing_dolly_moves_right_and_points_at_the_centroid),
        cmocka_unit_test(establishing_dolly_out_moves_back_on_the_axis),
        cmocka_unit_test(dollies_in_and_out_have_a_close_end_at_the_subject),
        cmocka_unit_test(dolly_zooms_keep_the_subjects_size),
        cmocka_unit_test(dolly_runs_from_the_first_subject_to_the_second),
        cmocka_unit_test(easing_slows_down_both_ends),
        cmocka_unit_test(all_pairs_agree_with_brute_force),
        cmocka_unit_test(refinement_never_loses_parallax),
        cmocka_unit_test(both_ends_of_an_establishing_dolly_show_most_of_the_scene),
        cmocka_unit_test(any_thread_count_gives_the_same_path),
        cmocka_unit_test(the_aperture_opens_with_the_subject_in_focus),
        cmocka_unit_test(focus_is_pulled_from_the_first_to_the_second_subject),
        cmocka_unit_test(a_turned_subject_has_a_tight_box),
        cmocka_unit_test(tone_effects_are_layers_around_the_subject),
        cmocka_unit_test(one_view_is_enough_for_a_move),
        cmocka_unit_test(two_views_are_enough_for_a_move),
        cmocka_unit_test(centres_in_a_line_allow_all_moves),
        cmocka_unit_test(coincident_centres_allow_a_move),
        cmocka_unit_test(regions_without_a_valid_cell_are_an_error),
        cmocka_unit_test(ends_with_an_invalid_path_are_drawn_in),
        cmocka_unit_test(a_path_is_lifted_into_what_is_valid),
        cmocka_unit_test(a_pair_of_less_parallax_replaces_invalid_ones),
        cmocka_unit_test(an_aperture_stays_shut_where_opening_shows_holes),
        cmocka_unit_test(too_few_subjects_or_frames_are_an_error),
        cmocka_unit_test(a_scene_without_depth_is_an_error),
    };
    return cmocka_run_group_tests(tests, set_up, NULL);
}
