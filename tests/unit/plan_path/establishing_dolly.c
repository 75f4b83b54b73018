/* establishing_dolly.c - planned moves over a wall with a box before it, whose layers are made by ray casting. */
#include "stages/plan_path/establishing_dolly.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "common/parallel.h"

enum { W = 160, H = 120, TILE = 10, MOST = 16 };

struct rectangle { /* faces -z: |x - cx| <= half_x, |y - cy| <= half_y at depth z of the world */
    double cx, cy, z, half_x, half_y;
};

static const struct rectangle wall_and_box[] = {{0, 0, 10, 40, 40}, {0.5, 0.3, 6, 1.2, 1.5}};

struct fixture {
    struct view views[MOST];
    struct camera_set set;
    struct layered_depth depths[MOST];
    struct layer_scene scene;
    struct vec3 ups[MOST];
};

/* A view at `center` looking at `target`, its y axis towards `down`. */
static void add_view(struct fixture *f, struct vec3 center, struct vec3 target, struct vec3 down)
{
    struct view *v = &f->views[f->set.view_count++];
    *v = (struct view){.name = "view", .width = W, .height = H, .fx = W, .fy = W, .cx = W / 2.0, .cy = H / 2.0};
    struct vec3 z = vec3_normalize(vec3_sub(target, center));
    struct vec3 x = vec3_normalize(vec3_cross(down, z)), y = vec3_cross(z, x);
    v->cam_from_world = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    v->center = center;
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, center), -1);
    f->set.views = f->views;
}

static void add_straight(struct fixture *f, double x, double y, double z)
{
    add_view(f, vec3_make(x, y, z), vec3_make(x, y, z + 1), vec3_make(0, 1, 0));
}

/* The nearest rectangle along a pixel's ray, -1 none; *depth along the camera's axis. */
static int hit(const struct view *v, double px, double py, const struct rectangle *r, int count, double *depth)
{
    struct vec3 d = vec3_sub(view_unproject(v, px, py, 1), v->center);
    int best = -1;
    *depth = HUGE_VAL;
    for (int i = 0; i < count; i++) {
        double t = (r[i].z - v->center.z) / d.z; /* d has depth 1, so t is the depth */
        struct vec3 p = vec3_add(v->center, vec3_scale(d, t));
        if (t > 0 && t < *depth && fabs(p.x - r[i].cx) <= r[i].half_x && fabs(p.y - r[i].cy) <= r[i].half_y)
            *depth = t, best = i;
    }
    return best;
}

/* 1/z of the world plane z = Z in a view's pixels. */
static void plane_in_view(const struct view *v, double world_z, double plane[3])
{
    struct vec3 n = mat3_apply(v->cam_from_world, vec3_make(0, 0, 1));
    double d = world_z + vec3_dot(n, v->translation);
    plane[0] = n.x / v->fx / d;
    plane[1] = n.y / v->fy / d;
    plane[2] = (n.z - n.x * v->cx / v->fx - n.y * v->cy / v->fy) / d;
}

/* Tiles of each rectangle are segments. */
static void make_layers(struct layered_depth *l, const struct view *v, const struct rectangle *r, int count)
{
    struct err err = ERR_INIT;
    const int columns = W / TILE, tiles = columns * (H / TILE);
    int ids[2 * (W / TILE) * (H / TILE)] = {0};
    assert_true(count <= 2);
    assert_int_equal(layered_depth_init(l, v->width, v->height, &err), ST_OK);
    l->segments = calloc((size_t)tiles * 2, sizeof *l->segments);
    assert_non_null(l->segments);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            double z;
            size_t p = (size_t)(y * W + x);
            int at = hit(v, x + 0.5, y + 0.5, r, count, &z);
            if (at < 0) continue;
            int *id = &ids[at * tiles + y / TILE * columns + x / TILE];
            if (!*id) {
                *id = ++l->segment_count;
                struct depth_segment *s = &l->segments[*id - 1];
                *s = (struct depth_segment){.id = (uint32_t)*id, .sigma = 0.001, .confidence = 1};
                plane_in_view(v, r[at].z, s->plane);
            }
            l->segments[*id - 1].pixels++;
            l->interior.id[p] = (uint32_t)*id;
            l->interior.z[p] = (float)z;
            for (int c = 0; c < 4; c++) l->interior.rgba[4 * p + (size_t)c] = 1;
        }
}

static void finish(struct fixture *f, const struct rectangle *r, int count)
{
    struct err err = ERR_INIT;
    for (int i = 0; i < f->set.view_count; i++) make_layers(&f->depths[i], &f->views[i], r, count);
    assert_int_equal(layer_scene_init(&f->scene, &f->set, f->depths, &err), ST_OK);
}

static struct plan_params quick(void)
{
    struct plan_params p = PLAN_PARAMS_DEFAULT;
    p.seconds = 1;
    p.check_side = 80;
    return p;
}

static double score(const struct camera_path *p, const char *name)
{
    for (int i = 0; i < p->score_count; i++)
        if (!strcmp(p->scores[i].name, name)) return p->scores[i].value;
    fail_msg("no score %s", name);
    return 0;
}

static void must_plan(struct camera_path *path, struct dolly_notes *notes, const struct fixture *f,
                      const struct vec3 *ups, const struct plan_params *params)
{
    struct err err = ERR_INIT;
    if (plan_establishing_dolly(path, notes, &f->scene, ups, params, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < path->frame_count; i++) {
        const struct view *v = &path->frames[i].camera;
        assert_true(v->width > 0 && v->width % 2 == 0 && v->height > 0 && v->height % 2 == 0);
        struct vec3 c = mat3_apply(v->cam_from_world, vec3_make(1, 2, 3));
        assert_float_equal(vec3_length(c), sqrt(14), 1e-12);
        assert_true(isfinite(vec3_length(v->translation)) && v->fx == v->fy && v->fx > 0);
        c = vec3_add(mat3_apply(v->cam_from_world, v->center), v->translation);
        assert_true(vec3_length(c) < 1e-12 * (1 + vec3_length(v->center)));
    }
}

static struct vec3 row_of(struct mat3 m, int row) { return vec3_make(m.m[row][0], m.m[row][1], m.m[row][2]); }

static void release(struct fixture *f, struct camera_path *path)
{
    camera_path_release(path);
    layer_scene_release(&f->scene);
}

static void rail(void **state)
{
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    (void)state;
    for (int i = 0; i < 5; i++) add_straight(&f, i - 2, 0, 0);
    finish(&f, wall_and_box, 2);
    must_plan(&path, &notes, &f, NULL, &params);
    assert_int_equal(path.frame_count, 30);
    assert_float_equal(path.frames[29].time, 29 / 30.0, 1e-12);
    assert_false(notes.stands_still);
    assert_true(notes.zoom <= 1.3 && notes.hole_limit == params.max_holes);
    assert_true(notes.outside_limit == params.max_outside);
    const struct view *first = &path.frames[0].camera, *last = &path.frames[29].camera;
    assert_int_equal(first->width, W);
    assert_int_equal(first->height, H);
    assert_float_equal(first->fx, W * notes.zoom, 1e-9);
    /* from left to right, along the rail, as far apart on both sides */
    assert_true(first->center.x < -0.5 && last->center.x > 0.5 && first->center.x >= -2 && last->center.x <= 2);
    assert_float_equal(first->center.x, -last->center.x, 1e-9);
    assert_float_equal(first->center.y, 0, 1e-9);
    assert_true(score(&path, "angle") <= params.max_angle + 1e-6);
    assert_float_equal(score(&path, "near_depth"), 6, 0.1);
    assert_float_equal(score(&path, "far_depth"), 10, 0.2);
    assert_true(score(&path, "parallax") > 20);
    assert_true(score(&path, "holes_at_0") <= params.max_holes && score(&path, "holes_at_1") <= params.max_holes);
    /* all frames point at one place, at the wall or the box, and have no roll */
    for (int i = 0; i < 30; i++) {
        const struct view *v = &path.frames[i].camera;
        double u, t;
        struct vec3 at = view_unproject(first, first->cx, first->cy, 1), z0 = vec3_sub(at, first->center);
        struct vec3 z1 = row_of(last->cam_from_world, 2), span = vec3_sub(last->center, first->center);
        double depth = span.x / (z0.x - z1.x * z0.z / z1.z); /* where the first and the last axis meet */
        struct vec3 centroid = vec3_add(first->center, vec3_scale(z0, depth));
        assert_true(centroid.z > 5.9 && centroid.z < 10.1);
        assert_true(view_project(v, centroid, &u, &t) > 0);
        assert_float_equal(u, v->cx, 1e-6);
        assert_float_equal(t, v->cy, 1e-6);
        assert_float_equal(v->cam_from_world.m[0][1], 0, 1e-9);
        assert_true(v->cam_from_world.m[1][1] > 0.9);
    }
    release(&f, &path);
}

static void easing(void **state)
{
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    (void)state;
    for (int i = 0; i < 3; i++) add_straight(&f, i - 1, 0, 0);
    finish(&f, wall_and_box, 2);
    for (int smooth = 0; smooth < 2; smooth++) {
        strcpy(params.ease, smooth ? "smooth" : "none");
        must_plan(&path, &notes, &f, NULL, &params);
        double step[29], least = HUGE_VAL, most = 0;
        for (int i = 0; i < 29; i++) {
            step[i] = path.frames[i + 1].camera.center.x - path.frames[i].camera.center.x;
            least = fmin(least, step[i]);
            most = fmax(most, step[i]);
        }
        assert_true(least > 0);
        if (smooth)
            assert_true(step[0] < 0.2 * most && step[28] < 0.2 * most && step[14] == most);
        else
            assert_true(most - least < 1e-9);
        camera_path_release(&path);
    }
    release(&f, &path);
}

static void sizes(void **state)
{
    const struct {
        int width, height, max_side, want_width, want_height;
        double focal; /* of W x H at focal length W */
    } cases[] = {
        {0, 0, 1280, 160, 120, 160},
        {0, 0, 80, 80, 60, 80},
        {0, 0, 101, 102, 76, 102},
        {321, 0, 16, 322, 240, 322},
        {0, 90, 16, 120, 90, 120},
        {320, 180, 16, 320, 180, 320},
        {90, 160, 16, 90, 160, 160 * 160 / 120.0},
    };
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    (void)state;
    for (int i = 0; i < 3; i++) add_straight(&f, 0.2 * i, 0, 0);
    finish(&f, wall_and_box, 2);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct plan_params params = quick();
        params.width = cases[i].width, params.height = cases[i].height, params.max_side = cases[i].max_side;
        must_plan(&path, &notes, &f, NULL, &params);
        assert_int_equal(path.frames[0].camera.width, cases[i].want_width);
        assert_int_equal(path.frames[0].camera.height, cases[i].want_height);
        assert_float_equal(path.frames[0].camera.fx / notes.zoom, cases[i].focal, 0.02 * cases[i].focal);
        camera_path_release(&path);
    }
    release(&f, &path);
}

static void photos_stored_on_their_side(void **state)
{
    (void)state;
    for (int side = -1; side <= 1; side += 2) { /* the pictures' x axes point down or up */
        struct fixture f = {0};
        struct camera_path path = {0};
        struct dolly_notes notes;
        struct plan_params params = quick();
        for (int i = 0; i < 3; i++) {
            add_view(&f, vec3_make(i, 0, 0), vec3_make(i, 0, 1), vec3_make(side, 0, 0));
            f.ups[i] = mat3_apply(f.views[i].cam_from_world, vec3_make(0, -1, 0));
            assert_float_equal(fabs(f.ups[i].x), 1, 1e-9);
        }
        finish(&f, wall_and_box, 2);
        must_plan(&path, &notes, &f, f.ups, &params);
        assert_int_equal(path.frames[0].camera.width, H);
        assert_int_equal(path.frames[0].camera.height, W);
        assert_true(row_of(path.frames[0].camera.cam_from_world, 1).y > 0.9);
        release(&f, &path);
    }
}

static void orbit_stays_around_the_middle(void **state)
{
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    (void)state;
    for (int i = 0; i < 11; i++) { /* 140 degrees around the box */
        double angle = (i - 5) * 14 * M_PI / 180;
        add_view(&f, vec3_make(6 * sin(angle), 0, 6 - 6 * cos(angle)), vec3_make(0, 0, 6), vec3_make(0, 1, 0));
    }
    finish(&f, wall_and_box, 2);
    must_plan(&path, &notes, &f, NULL, &params);
    double angle = score(&path, "angle");
    assert_true(angle > 5 && angle <= params.max_angle + 1e-6);
    assert_string_equal(notes.center_view, "view");
    for (int i = 0; i < path.frame_count; i++) assert_true(vec3_length(path.frames[i].camera.center) < 3);
    release(&f, &path);
}

/* Three photos in a room, each a view ahead and two of what is behind it: the move looks where most look, and what is
 * behind the camera has no part in where the scene is. */
static void views_that_look_all_ways(void **state)
{
    (void)state;
    static const struct rectangle front_and_back[] = {{0, 0, 10, 40, 40}, {0, 0, -6, 40, 40}};
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    for (int i = -1; i <= 1; i++) {
        add_view(&f, vec3_make(i, 0, 0), vec3_make(i - 0.3, 0, -1), vec3_make(0, 1, 0));
        add_view(&f, vec3_make(i, 0, 0), vec3_make(i + 0.3, 0, -1), vec3_make(0, 1, 0));
        for (int k = -1; k <= 1; k++)
            add_view(&f, vec3_make(i, 0, 0), vec3_make(i + 0.3 * k, 0, 1), vec3_make(0, 1, 0));
    }
    finish(&f, front_and_back, 2);
    must_plan(&path, &notes, &f, NULL, &params);
    for (int i = 0; i < path.frame_count; i++) assert_true(row_of(path.frames[i].camera.cam_from_world, 2).z > 0.8);
    release(&f, &path);
}

static void two_views_and_one_and_a_tripod(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        struct fixture f = {0};
        struct camera_path path = {0};
        struct dolly_notes notes;
        struct plan_params params = quick();
        params.max_holes = 0.05;
        add_straight(&f, 0, 0, 0);
        if (kind == 0) add_straight(&f, 1, 0, 0);
        for (int i = 0; kind == 2 && i < 3; i++)
            add_view(&f, vec3_make(0, 0, 0), vec3_make(0.1 * (i - 1), 0, 1), vec3_make(0, 1, 0));
        finish(&f, wall_and_box, 2);
        must_plan(&path, &notes, &f, NULL, &params);
        assert_false(notes.stands_still);
        assert_true(score(&path, "length") > 0.1);
        if (kind == 0) /* between the two */
            for (int i = 0; i < path.frame_count; i++)
                assert_true(path.frames[i].camera.center.x > -1e-9 && path.frames[i].camera.center.x < 1 + 1e-9);
        release(&f, &path);
    }
}

static void holes_shorten_the_move_or_zoom_in(void **state)
{
    const struct rectangle small_wall[] = {{0, 0, 10, 5.2, 3.9},
                                           {0.5, 0.3, 6, 1.2, 1.5}}; /* the middle view just sees it all */
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    (void)state;
    for (int i = 0; i < 5; i++) add_straight(&f, i - 2, 0, 0);
    finish(&f, small_wall, 2);
    must_plan(&path, &notes, &f, NULL, &params);
    assert_true(notes.zoom > 1);
    assert_true(notes.zoom <= params.max_zoom + 1e-9);
    for (int i = 0; i <= 4; i++) {
        char name[32];
        snprintf(name, sizeof name, "holes_at_%g", i / 4.0);
        assert_true(score(&path, name) <= params.max_holes);
    }
    assert_true(score(&path, "outside_at_0") <= params.max_outside &&
                score(&path, "outside_at_1") <= params.max_outside);
    double zoomed = score(&path, "length");
    assert_true(zoomed > 0.5);
    camera_path_release(&path);
    params.max_zoom = 1;
    must_plan(&path, &notes, &f, NULL, &params);
    assert_true(notes.zoom == 1 && score(&path, "length") < zoomed);
    release(&f, &path);
}

static void too_many_holes_everywhere_raise_the_limit(void **state)
{
    const struct rectangle post = {0, 0, 10, 1, 20};
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    (void)state;
    for (int i = 0; i < 3; i++) add_straight(&f, 0.3 * i, 0, 0);
    finish(&f, &post, 1);
    must_plan(&path, &notes, &f, NULL, &params);
    assert_float_equal(notes.zoom, params.max_zoom, 1e-9);
    assert_true(notes.hole_limit > 0.3 && notes.hole_limit <= 1.2);
    release(&f, &path);
}

static void does_not_run_into_the_scene(void **state)
{
    const struct rectangle wall_and_near[] = {{0, 0, 10, 40, 40},
                                              {4.9, 0, 2, 2.2, 30}}; /* before the outer views alone */
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    (void)state;
    params.max_angle = 90;
    for (int i = 0; i < 9; i++) add_straight(&f, i - 4, 0, 0);
    finish(&f, wall_and_near, 2);
    must_plan(&path, &notes, &f, NULL, &params);
    double end = path.frames[path.frame_count - 1].camera.center.x;
    assert_true(end > 0.3 && end < 3.5);
    release(&f, &path);
}

static void any_threads_same_path(void **state)
{
    struct fixture f = {0};
    struct camera_path a = {0}, b = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    (void)state;
    for (int i = 0; i < 9; i++) add_straight(&f, i % 3 + 0.1 * (i / 3), i / 3, 0.1 * sin(i));
    finish(&f, wall_and_box, 2);
    parallel_set_threads(1);
    must_plan(&a, &notes, &f, NULL, &params);
    parallel_set_threads(3);
    must_plan(&b, &notes, &f, NULL, &params);
    assert_memory_equal(a.scores, b.scores, (size_t)a.score_count * sizeof *a.scores);
    for (int i = 0; i < a.frame_count; i++)
        assert_memory_equal(&a.frames[i].camera.cam_from_world, &b.frames[i].camera.cam_from_world,
                            sizeof a.frames[i].camera.cam_from_world);
    camera_path_release(&a);
    release(&f, &b);
}

static void refuses_what_makes_no_film(void **state)
{
    struct fixture f = {0};
    struct camera_path path = {0};
    struct dolly_notes notes;
    struct plan_params params = quick();
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < 3; i++) add_straight(&f, i, 0, 0);
    finish(&f, NULL, 0); /* nothing is seen */
    assert_int_equal(plan_establishing_dolly(&path, &notes, &f.scene, NULL, &params, &err), ST_DATA);
    assert_non_null(strstr(err.text, "no scene to move in"));
    assert_null(path.frames);
    params.seconds = 0;
    err = (struct err)ERR_INIT;
    assert_int_equal(plan_establishing_dolly(&path, &notes, &f.scene, NULL, &params, &err), ST_USAGE);
    assert_non_null(strstr(err.text, "at least two"));
    params.seconds = 0.04; /* one frame */
    err = (struct err)ERR_INIT;
    assert_int_equal(plan_params_check(&params, &err), ST_USAGE);
    params.seconds = 0.06;
    err = (struct err)ERR_INIT;
    assert_int_equal(plan_params_check(&params, &err), ST_OK);
    release(&f, &path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rail),
        cmocka_unit_test(easing),
        cmocka_unit_test(sizes),
        cmocka_unit_test(photos_stored_on_their_side),
        cmocka_unit_test(orbit_stays_around_the_middle),
        cmocka_unit_test(views_that_look_all_ways),
        cmocka_unit_test(two_views_and_one_and_a_tripod),
        cmocka_unit_test(holes_shorten_the_move_or_zoom_in),
        cmocka_unit_test(too_many_holes_everywhere_raise_the_limit),
        cmocka_unit_test(does_not_run_into_the_scene),
        cmocka_unit_test(any_threads_same_path),
        cmocka_unit_test(refuses_what_makes_no_film),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
