/* sample.c - tests of viewpoint sampling over walls and boxes: grid, z limits, zoom, layout, errors. */
#include "stages/sample_validity/sample.h"

#include "common/base/parallel.h"
#include "tests/unit/scratch.h"
#include "tests/unit/wall_scene.h"

static const struct subject_list nobody;

static struct validity_params quick(void)
{
    struct validity_params p = VALIDITY_PARAMS_DEFAULT;
    p.grid = 4;
    p.check_side = W;
    p.tolerance = 0.02;
    p.check_cells = 0;
    return p;
}

static void sample(struct validity *v, struct sampling_notes *notes, const struct wall_scene *f, enum camera_move move,
                   const struct vec3 *ups, const struct validity_params *params)
{
    const struct film_effect effect = {move, FOCUS_ALL, TONE_NONE};
    struct err err = ERR_INIT;
    assert_ok(validity_sample(v, notes, &f->scene, ups, &nobody, &effect, params, &err), err);
    assert_true(v->effect.move == move && v->move.move == move);
    assert_true(v->shot.lens.width % 2 == 0 && v->shot.lens.height % 2 == 0 && v->shot.median_depth > 0);
    assert_float_equal(vec3_length(v->shot.up), 1, 1e-12);
    assert_true(v->zoom >= 1 && v->zoom <= params->max_zoom + 1e-9);
    for (int k = 0; k < 2; k++) assert_true(validity_region_count(&v->region[k]) > 0);
    assert_true(notes->renders > 0);
}

static void nine_views(struct wall_scene *f)
{
    *f = (struct wall_scene){.scene = {.sigma = 0}};
    for (int i = 0; i < 9; i++) add_view(f, vec3_make(i % 3 - 1, i / 3 - 1, 0), vec3_make(0, 0, 9), vec3_make(0, 1, 0));
    finish(f, wall_and_box, 2);
}

static bool valid_at(const struct wall_scene *f, const struct validity *v, int end, double x, double y, double z)
{
    struct scene_points points;
    struct err err = ERR_INIT;
    bool valid = false;
    assert_ok(scene_points_collect(&points, &f->scene, &err), err);
    struct viewpoint_test test = {.scene = &f->scene, .points = &points, .shot = &v->shot, .limits = v->limits};
    const struct view camera = shot_end_camera(&v->shot, &v->move.end[end], world_from_shot(&v->shot, x, y, z));
    assert_ok(viewpoint_is_valid(&valid, &test, &camera, &err), err);
    viewpoint_test_release(&test);
    scene_points_release(&points);
    return valid;
}

static void the_grid_covers_twice_the_box_of_the_centres(void **state)
{
    (void)state;
    struct wall_scene f;
    struct validity v;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    nine_views(&f);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_float_equal(v.shot.low[0], -1, 1e-9);
    assert_float_equal(v.shot.high[1], 1, 1e-9);
    assert_true(vec3_length(v.shot.origin) < 1e-12 && v.shot.axis_z.z > 0.999);
    for (int i = 0; i < 16; i++) { /* centres of 4 x 4 cells over a square of 4 by 4 */
        const struct validity_cell *c = &v.region[0].cells[i];
        assert_float_equal(c->x, (i % 4) - 1.5, 1e-9);
        assert_float_equal(c->y, (i / 4) - 1.5, 1e-9);
    }
    assert_true(v.limits.max_h == 2 && v.limits.max_outside == 0.03);
    assert_memory_equal(v.region[0].cells, v.region[1].cells,
                        16 * sizeof *v.region[0].cells); /* one rule, one region */
    validity_release(&v);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY_OUT, NULL, &params);
    for (int k = 0; k < 2; k++) {
        assert_true(v.region[k].columns == 1 && v.region[k].rows == 1);
        assert_true(v.region[k].cells[0].x == 0 && v.region[k].cells[0].y == 0);
    }
    validity_release(&v);
    layer_scene_release(&f.scene);
}

static void z_limits_are_valid_and_one_step_beyond_is_not(void **state)
{
    (void)state;
    struct wall_scene f;
    struct validity v;
    struct sampling_notes notes;
    struct validity_params params = quick();
    params.extent = 1;
    int checked = 0;
    nine_views(&f);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    for (int i = 0; i < 16; i++) {
        const struct validity_cell *c = &v.region[0].cells[i];
        assert_true(c->valid == valid_at(&f, &v, 0, c->x, c->y, 0));
        if (!c->valid) continue;
        assert_true(c->low <= 0 && c->high >= 0);
        assert_true(valid_at(&f, &v, 0, c->x, c->y, c->low) && valid_at(&f, &v, 0, c->x, c->y, c->high));
        assert_true(c->high < 6); /* in front of the box */
        assert_false(valid_at(&f, &v, 0, c->x, c->y, c->high + v.step));
        if (c->low > -3.9 * v.shot.median_depth) assert_false(valid_at(&f, &v, 0, c->x, c->y, c->low - v.step));
        checked++;
    }
    assert_true(checked >= 4);
    validity_release(&v);
    layer_scene_release(&f.scene);
}

static void full_pictures_report_no_error(void **state)
{
    (void)state;
    struct wall_scene f;
    struct validity v;
    struct sampling_notes notes;
    struct validity_params params = quick();
    params.check_cells = 3; /* the film is as small as the sampled pictures */
    nine_views(&f);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_true(notes.error.limits > 0 && notes.error.within == notes.error.limits && notes.error.worst == 0);
    validity_release(&v);
    layer_scene_release(&f.scene);
}

static void any_thread_count_gives_the_same_regions(void **state)
{
    (void)state;
    struct wall_scene f;
    struct validity a, b;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    nine_views(&f);
    parallel_set_threads(1);
    sample(&a, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    const long renders = notes.renders;
    parallel_set_threads(3);
    sample(&b, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_true(notes.renders == renders && a.zoom == b.zoom);
    assert_memory_equal(&a.shot.up, &b.shot.up, sizeof a.shot - offsetof(struct shot_setup, up));
    for (int i = 0; i < 16; i++) {
        const struct validity_cell *c = &a.region[0].cells[i], *d = &b.region[0].cells[i];
        assert_true(c->valid == d->valid && c->low == d->low && c->high == d->high);
    }
    validity_release(&a);
    validity_release(&b);
    layer_scene_release(&f.scene);
}

static void photos_stored_on_their_side_give_an_upright_film(void **state)
{
    (void)state;
    for (int side = -1; side <= 1; side += 2) { /* the pictures' x axis points down or up */
        struct wall_scene f = {0};
        struct validity v;
        struct sampling_notes notes;
        const struct validity_params params = quick();
        for (int i = 0; i < 3; i++) {
            add_view(&f, vec3_make(i, 0, 0), vec3_make(i, 0, 1), vec3_make(side, 0, 0));
            f.ups[i] = mat3_apply(f.views[i].cam_from_world, vec3_make(0, -1, 0));
            assert_float_equal(fabs(f.ups[i].x), 1, 1e-9);
        }
        finish(&f, wall_and_box, 2);
        sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, f.ups, &params);
        assert_int_equal(v.shot.lens.width, H);
        assert_int_equal(v.shot.lens.height, W);
        assert_true(v.shot.up.y < -0.9);
        validity_release(&v);
        layer_scene_release(&f.scene);
    }
}

static void the_origin_of_an_orbit_is_its_middle(void **state)
{
    (void)state;
    struct wall_scene f = {0};
    struct validity v;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    for (int i = 0; i < 11; i++) { /* 140 degrees around the box */
        const double angle = (i - 5) * 14 * M_PI / 180;
        add_view(&f, vec3_make(6 * sin(angle), 0, 6 - 6 * cos(angle)), vec3_make(0, 0, 6), vec3_make(0, 1, 0));
    }
    finish(&f, wall_and_box, 2);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_string_equal(notes.center_view, "view");
    assert_true(fabs(v.shot.origin.x) < 3 && fabs(v.shot.origin.y) < 1e-9);
    assert_true(v.shot.centroid.z > 5.9 && v.shot.centroid.z < 10.1);
    validity_release(&v);
    layer_scene_release(&f.scene);
}

/* Three positions in a room, each with three views ahead and two backwards: the move faces where most views face. */
static void views_that_face_backwards_do_not_move_the_centroid(void **state)
{
    (void)state;
    static const struct rectangle front_and_back[] = {{0, 0, 10, 40, 40}, {0, 0, -6, 40, 40}};
    struct wall_scene f = {0};
    struct validity v;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    for (int i = -1; i <= 1; i++) {
        add_view(&f, vec3_make(i, 0, 0), vec3_make(i - 0.3, 0, -1), vec3_make(0, 1, 0));
        add_view(&f, vec3_make(i, 0, 0), vec3_make(i + 0.3, 0, -1), vec3_make(0, 1, 0));
        for (int k = -1; k <= 1; k++)
            add_view(&f, vec3_make(i, 0, 0), vec3_make(i + 0.3 * k, 0, 1), vec3_make(0, 1, 0));
    }
    finish(&f, front_and_back, 2);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_float_equal(v.shot.centroid.z, 10, 0.01);
    const struct view camera = shot_aim(&v.shot, v.shot.origin, v.shot.centroid, v.shot.lens.fx);
    assert_true(row_of(camera.cam_from_world, 2).z > 0.8);
    validity_release(&v);
    layer_scene_release(&f.scene);
}

static void borders_of_photos_in_the_frames_cause_a_zoom(void **state)
{
    (void)state;
    const struct rectangle small_wall[] = {{0, 0, 10, 5.2, 3.9},
                                           {0.5, 0.3, 6, 1.2, 1.5}}; /* it just fills the middle view */
    struct wall_scene f = {0};
    struct validity v;
    struct sampling_notes notes;
    struct validity_params params = quick();
    for (int i = 0; i < 5; i++) add_straight(&f, i - 2, 0, 0);
    finish(&f, small_wall, 2);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_true(v.zoom > 1);
    assert_float_equal(v.shot.lens.fx, W * v.zoom, 1e-9);
    validity_release(&v);
    params.max_zoom = 1;
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_true(v.zoom == 1 && v.shot.lens.fx == W);
    validity_release(&v);
    layer_scene_release(&f.scene);
}

/* Five photos of a wall, the middle one pointing aside: the frame at the origin then shows most of its border. */
static void the_origin_stays_valid_if_the_middle_view_points_aside(void **state)
{
    (void)state;
    const struct rectangle wall = {0, 0, 10, 40, 40};
    struct wall_scene f = {0};
    struct validity v;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    for (int i = -2; i <= 2; i++) add_view(&f, vec3_make(i, 0, 0), vec3_make(i ? 0 : 1.5, 0, 10), vec3_make(0, 1, 0));
    finish(&f, &wall, 1);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_true(v.limits.max_outside == params.max_outside); /* the limit was not raised */
    assert_true(valid_at(&f, &v, 0, 0, 0, 0) && valid_at(&f, &v, 1, 0, 0, 0));
    validity_release(&v);
    layer_scene_release(&f.scene);
}

static void holes_everywhere_raise_the_limit(void **state)
{
    (void)state;
    const struct rectangle post = {0, 0, 10, 1, 20};
    struct wall_scene f = {0};
    struct validity v;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    for (int i = 0; i < 3; i++) add_straight(&f, 0.3 * i, 0, 0);
    finish(&f, &post, 1);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    assert_float_equal(v.zoom, params.max_zoom, 1e-9);
    assert_true(v.limits.max_h > params.max_h && notes.requested_h == params.max_h && isfinite(v.limits.max_h));
    assert_true(valid_at(&f, &v, 0, 0, 0, 0)); /* the origin meets the raised limits */
    validity_release(&v);
    layer_scene_release(&f.scene);
}

static void viewpoints_too_near_to_the_scene_are_invalid(void **state)
{
    (void)state;
    const struct rectangle wall_and_near[] = {{0, 0, 10, 40, 40},
                                              {4.9, 0, 2, 2.2, 30}}; /* in front of the outer views alone */
    struct wall_scene f = {0};
    struct validity v;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    for (int i = 0; i < 9; i++) add_straight(&f, i - 4, 0, 0);
    finish(&f, wall_and_near, 2);
    sample(&v, &notes, &f, MOVE_ESTABLISHING_DOLLY, NULL, &params);
    for (int i = 0; i < 16; i++)
        if (v.region[0].cells[i].valid) assert_true(v.region[0].cells[i].x < 3.5 && v.region[0].cells[i].high < 8);
    validity_release(&v);
    layer_scene_release(&f.scene);
}

/* The second subject is outside all views; the notes report it. */
static void an_end_without_a_valid_cell_gets_the_origin(void **state)
{
    (void)state;
    struct wall_scene f;
    struct validity v;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    struct subject two[2] = {upright_subject(0.5, 0.3, 6, 0.3, 0.4), upright_subject(-30, 0, 10, 0.5, 0.8)};
    const struct subject_list list = {two, 2};
    const struct film_effect dolly = {MOVE_DOLLY, FOCUS_ALL, TONE_NONE};
    struct err err = ERR_INIT;
    nine_views(&f);
    assert_ok(validity_sample(&v, &notes, &f.scene, NULL, &list, &dolly, &params, &err), err);
    assert_true(!notes.no_valid[0] && notes.no_valid[1]);
    assert_int_equal(validity_region_count(&v.region[1]), 1);
    for (int i = 0; i < 16; i++) {
        const struct validity_cell *c = &v.region[1].cells[i];
        if (c->valid) assert_true(c->x == 0 && c->y == 0 && c->low == 0 && c->high == 0);
    }
    validity_release(&v);
    layer_scene_release(&f.scene);
}

static void scenes_without_depth_and_bad_subjects_are_errors(void **state)
{
    (void)state;
    struct wall_scene f = {0};
    struct validity v;
    struct sampling_notes notes;
    const struct validity_params params = quick();
    struct film_effect effect = {MOVE_ESTABLISHING_DOLLY, FOCUS_ALL, TONE_NONE};
    struct err err = ERR_INIT;
    for (int i = 0; i < 3; i++) add_straight(&f, i, 0, 0);
    finish(&f, NULL, 0); /* nothing is seen */
    assert_int_equal(validity_sample(&v, &notes, &f.scene, NULL, &nobody, &effect, &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "no scene to move in");
    assert_true(!v.region[0].cells && !v.region[1].cells);
    layer_scene_release(&f.scene);
    nine_views(&f);
    struct subject behind = upright_subject(0, 0, -5, 1, 1);
    const struct subject_list list = {&behind, 1};
    effect.move = MOVE_DOLLY_ZOOM;
    err = (struct err)ERR_INIT;
    assert_int_equal(validity_sample(&v, &notes, &f.scene, NULL, &list, &effect, &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "is not in front");
    err = (struct err)ERR_INIT;
    assert_int_equal(validity_sample(&v, &notes, &f.scene, NULL, &nobody, &effect, &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "needs 1 subjects");
    assert_true(!v.region[0].cells && !v.region[1].cells);
    layer_scene_release(&f.scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_grid_covers_twice_the_box_of_the_centres),
        cmocka_unit_test(z_limits_are_valid_and_one_step_beyond_is_not),
        cmocka_unit_test(full_pictures_report_no_error),
        cmocka_unit_test(any_thread_count_gives_the_same_regions),
        cmocka_unit_test(photos_stored_on_their_side_give_an_upright_film),
        cmocka_unit_test(the_origin_of_an_orbit_is_its_middle),
        cmocka_unit_test(views_that_face_backwards_do_not_move_the_centroid),
        cmocka_unit_test(borders_of_photos_in_the_frames_cause_a_zoom),
        cmocka_unit_test(the_origin_stays_valid_if_the_middle_view_points_aside),
        cmocka_unit_test(holes_everywhere_raise_the_limit),
        cmocka_unit_test(viewpoints_too_near_to_the_scene_are_invalid),
        cmocka_unit_test(an_end_without_a_valid_cell_gets_the_origin),
        cmocka_unit_test(scenes_without_depth_and_bad_subjects_are_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
