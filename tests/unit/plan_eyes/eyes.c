/* eyes.c - rendered pictures of two eyes have the known horizontal disparity and no vertical one; the distance between
 * the eyes keeps within the limits. */
#include "tests/unit/wall_scene.h"

#include "common/layers/layer_render.h"
#include "stages/plan_eyes/eyes.h"
#include "tests/unit/scratch.h"

static const struct eyes_params usual = EYES_PARAMS_DEFAULT;

/* A film of `frames` equal frames. */
static void make_film(struct camera_path *film, const struct view *camera, int frames)
{
    struct err err = ERR_INIT;
    assert_ok(camera_path_init(film, "test", 25, frames, &err), err);
    for (int i = 0; i < frames; i++) {
        const char *name = film->frames[i].camera.name;
        film->frames[i].camera = *camera;
        film->frames[i].camera.name = name;
    }
}

static struct view camera_at(double x, double y, double yaw, double pitch)
{
    struct wall_scene f = {.set.view_count = 0};
    add_view(&f, vec3_make(x, y, 0), vec3_make(x + tan(yaw), y + tan(pitch), 1), vec3_make(0, 1, 0));
    return f.views[0];
}

/* ------------------------------------------------------------------------------------------------ limits of comfort */

static void plan_depths(struct eyes_plan *plan, struct camera_path *film, double fx, double nearest, double farthest,
                        const struct eyes_params *params)
{
    struct err err = ERR_INIT;
    struct view camera = camera_at(0, 0, 0, 0);
    const struct eyes_depth depths[2] = {{nearest, farthest, 0}, {nearest, farthest, 0}};
    camera.fx = camera.fy = fx;
    make_film(film, &camera, 2);
    assert_ok(eyes_plan_from_depths(plan, film, depths, EYES_FLAT, params, &err), err);
}

static void near_things_limit_the_distance_to_a_thirtieth(void **state)
{
    (void)state;
    struct camera_path film = {0};
    struct eyes_plan plan = {0};
    plan_depths(&plan, &film, 160, 6, 10, &usual);
    assert_string_equal(plan.limit, "near_ratio");
    assert_float_equal(plan.base, 0.2, 1e-12);
    /* a third of the range of 1/z is in front of the screen, two thirds are behind it */
    assert_float_equal(plan.frames[0].convergence, 1 / (1 / 6.0 - 1 / 45.0), 1e-9);
    assert_float_equal(plan.front, 160 * 0.2 / 45, 1e-9);
    assert_float_equal(plan.behind, 160 * 0.2 * 2 / 45, 1e-9);
    eyes_plan_release(&plan);
    camera_path_release(&film);
}

static void deep_scenes_use_the_budget_of_disparity_and_no_more(void **state)
{
    (void)state;
    struct camera_path film = {0};
    struct eyes_plan plan = {0};
    plan_depths(&plan, &film, 320, 2, 1000, &usual);
    assert_string_equal(plan.limit, "disparity");
    assert_true(plan.base < 2 / 30.0);
    assert_float_equal(plan.front, 0.01 * W, 1e-9);
    assert_float_equal(plan.behind, 0.02 * W, 1e-9);
    assert_true(plan.frames[0].convergence >= 2 && plan.frames[0].convergence <= 1000);
    eyes_plan_release(&plan);
    camera_path_release(&film);
}

static void a_given_distance_is_kept(void **state)
{
    (void)state;
    struct eyes_params params = usual;
    struct camera_path film = {0};
    struct eyes_plan plan = {0};
    params.base = 0.5;
    plan_depths(&plan, &film, 320, 2, 1000, &params);
    assert_string_equal(plan.limit, "base");
    assert_float_equal(plan.base, 0.5, 0);
    assert_true(plan.front > 0.01 * W);
    eyes_plan_release(&plan);
    camera_path_release(&film);
}

/* The depths of a film that flies towards a thing jump between its frames: the screen follows them, smoothly, within
 * what each frame shows. */
static void the_screen_never_leaves_what_a_frame_shows(void **state)
{
    (void)state;
    enum { FRAMES = 40 };
    struct err err = ERR_INIT;
    struct camera_path film = {0};
    struct eyes_plan plan = {0};
    struct eyes_depth depths[FRAMES];
    const struct view camera = camera_at(0, 0, 0, 0);
    make_film(&film, &camera, FRAMES);
    for (int i = 0; i < FRAMES; i++) depths[i] = i < 20 ? (struct eyes_depth){8, 9, 0} : (struct eyes_depth){2, 3, 0};
    depths[0] = depths[30] = (struct eyes_depth){0}; /* these show nothing */
    assert_ok(eyes_plan_from_depths(&plan, &film, depths, EYES_FLAT, &usual, &err), err);
    for (int i = 0; i < FRAMES; i++) {
        assert_true(plan.frames[i].convergence >= plan.frames[i].nearest);
        assert_true(plan.frames[i].convergence <= plan.frames[i].farthest);
    }
    assert_float_equal(plan.base, 2 / 30.0, 1e-12);
    eyes_plan_release(&plan);

    memset(depths, 0, sizeof depths);
    assert_int_equal(eyes_plan_from_depths(&plan, &film, depths, EYES_FLAT, &usual, &err), ST_DATA);
    assert_err(err, ST_DATA, "no frame of the film shows anything of the scene");
    eyes_plan_release(&plan);
    camera_path_release(&film);
}

/* --------------------------------------------------------------------------------------------------------- cameras */

static void points_have_the_disparity_of_their_depth_and_none_vertically(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct camera_path film = {0}, left = {0}, right = {0};
    struct eyes_plan plan = {0};
    const struct view camera = camera_at(0.3, -0.2, 0.1, -0.2);
    const struct eyes_depth depths[1] = {{6, 10, 0}};
    make_film(&film, &camera, 1);
    assert_ok(eyes_plan_from_depths(&plan, &film, depths, EYES_FLAT, &usual, &err), err);
    assert_ok(eyes_path(&left, &film, &plan, -1, &err), err);
    assert_ok(eyes_path(&right, &film, &plan, 1, &err), err);
    const struct view *l = &left.frames[0].camera, *r = &right.frames[0].camera;
    assert_float_equal(vec3_length(vec3_sub(r->center, l->center)), plan.base, 1e-12);
    assert_float_equal(vec3_length(vec3_sub(vec3_scale(vec3_add(l->center, r->center), 0.5), camera.center)), 0, 1e-12);
    for (int i = 0; i < 27; i++) {
        const double z = i / 9 == 0 ? 6 : i / 9 == 1 ? plan.frames[0].convergence : 10;
        const struct vec3 p = view_unproject(&camera, 80 + 60 * (i % 3 - 1), 60 + 50 * (i / 3 % 3 - 1), z);
        double ul = 0, vl = 0, ur = 0, vr = 0;
        assert_true(view_project(l, p, &ul, &vl) > 0 && view_project(r, p, &ur, &vr) > 0);
        assert_true(fabs(vr - vl) < 1e-9);
        assert_true(fabs(ur - ul - eyes_disparity(&plan, &camera, 0, z)) < 1e-9);
        if (i / 9 == 1) assert_true(fabs(ur - ul) < 1e-9);
    }
    camera_path_release(&left);
    camera_path_release(&right);
    eyes_plan_release(&plan);
    camera_path_release(&film);
}

/* -------------------------------------------------------------------------------------------------------- pictures */

static double texture(double x, double y)
{
    return 0.5 + 0.1 * (sin(7.1 * x + 1) + sin(8.3 * y) + sin(4.7 * x + 5.9 * y) + sin(5.3 * x - 3.9 * y));
}

/* Layers of a wall and a box, with a texture in the world's plane. */
static void make_scene(struct wall_scene *f)
{
    struct err err = ERR_INIT;
    for (int i = 0; i < 5; i++) add_straight(f, 0.4 * (i % 3 - 1), 0.3 * (i / 3), 0);
    for (int i = 0; i < f->set.view_count; i++) {
        const struct view *v = &f->views[i];
        make_layers(&f->depths[i], v, wall_and_box, 2);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const size_t p = (size_t)(y * W + x);
                const double z = (double)f->depths[i].interior.z[p];
                const struct vec3 at = view_unproject(v, x + 0.5, y + 0.5, z);
                for (int k = 0; k < 3; k++)
                    f->depths[i].interior.rgba[4 * p + (size_t)k] = (float)texture(at.x * 6 / z, at.y * 6 / z);
            }
    }
    assert_ok(layer_scene_init(&f->scene, &f->set, f->depths, &err), err);
}

static double sample(const struct rendered_frame *f, double u, double v)
{
    const int x = (int)floor(u - 0.5), y = (int)floor(v - 0.5);
    const double a = u - 0.5 - x, b = v - 0.5 - y;
    const float *p = f->rgba + 4 * (y * W + x);
    return (1 - b) * ((1 - a) * (double)p[0] + a * (double)p[4]) +
           b * ((1 - a) * (double)p[4 * W] + a * (double)p[4 * W + 4]);
}

/* Refines the displacement (*dx, *dy) from the left to the right picture of a block, by least squares
 * [Lucas 1981]. */
static void displacement(double *dx, double *dy, const struct rendered_frame *l, const struct rendered_frame *r, int x0,
                         int y0, int side)
{
    for (int pass = 0; pass < 8; pass++) {
        double xx = 0, xy = 0, yy = 0, xe = 0, ye = 0;
        for (int y = y0; y < y0 + side; y++)
            for (int x = x0; x < x0 + side; x++) {
                const double u = x + 0.5 + *dx, v = y + 0.5 + *dy;
                const double gx = (sample(r, u + 1, v) - sample(r, u - 1, v)) / 2;
                const double gy = (sample(r, u, v + 1) - sample(r, u, v - 1)) / 2;
                const double e = sample(l, x + 0.5, y + 0.5) - sample(r, u, v);
                xx += gx * gx, xy += gx * gy, yy += gy * gy, xe += gx * e, ye += gy * e;
            }
        const double det = xx * yy - xy * xy;
        assert_true(det > 1e-9); /* the texture says where it is */
        *dx += (yy * xe - xy * ye) / det;
        *dy += (xx * ye - xy * xe) / det;
    }
}

/* Whether a block shows one surface in both pictures, away from what hides it; *plane: 1/z in its middle. */
static bool one_surface(const struct rendered_frame *l, int x0, int y0, int side, double *z)
{
    double least = HUGE_VAL, most = 0;
    for (int y = y0 - 4; y < y0 + side + 4; y++)
        for (int x = x0 - 4; x < x0 + side + 4; x++) {
            const double d = (double)l->z[y * W + x];
            if (!(d > 0)) return false;
            least = fmin(least, d);
            most = fmax(most, d);
        }
    *z = (double)l->z[(y0 + side / 2) * W + x0 + side / 2];
    return most < 1.2 * least;
}

static int check_blocks(const struct eyes_plan *plan, const struct view *camera, const struct rendered_frame *l,
                        const struct rendered_frame *r, double *worst_x, double *worst_y)
{
    enum { SIDE = 12 };
    int blocks = 0;
    for (int y = 8; y + SIDE + 8 < H; y += SIDE)
        for (int x = 8; x + SIDE + 8 < W; x += SIDE) {
            double z, dx, dy = 0;
            if (!one_surface(l, x, y, SIDE, &z)) continue;
            const double expected = dx = eyes_disparity(plan, camera, 0, z);
            displacement(&dx, &dy, l, r, x, y, SIDE);
            *worst_x = fmax(*worst_x, fabs(dx - expected));
            *worst_y = fmax(*worst_y, fabs(dy));
            blocks++;
        }
    return blocks;
}

static void rendered_eyes_differ_by_the_disparity_of_the_depth_alone(void **state)
{
    (void)state;
    static const struct layer_render_options offline = {.offline = true, .more_views = 12, .soft_z = SOFT_Z_WIDTHS};
    static const double turns[][2] = {{0, 0}, {0.06, 0}, {0.03, -0.05}};
    struct wall_scene f = {.set.view_count = 0};
    struct err err = ERR_INIT;
    struct eyes_params params = usual;
    make_scene(&f);
    params.base = 0.4; /* larger than is comfortable, so that 0.3 px is a small part of the disparity */
    for (int i = 0; i < 3; i++) {
        const struct view camera = camera_at(0.1, 0.1, turns[i][0], turns[i][1]);
        struct camera_path film = {0}, left = {0}, right = {0};
        struct rendered_frame l = {0}, r = {0};
        struct eyes_plan plan = {0};
        double worst_x = 0, worst_y = 0;
        make_film(&film, &camera, 1);
        assert_ok(eyes_plan(&plan, &film, &f.scene, EYES_FLAT, &params, &err), err);
        assert_float_equal(plan.frames[0].nearest, 6, i ? 0.3 : 0.01);
        assert_ok(eyes_path(&left, &film, &plan, -1, &err), err);
        assert_ok(eyes_path(&right, &film, &plan, 1, &err), err);
        assert_ok(layer_render(&l, &f.scene, &left.frames[0].camera, &offline, &err), err);
        assert_ok(layer_render(&r, &f.scene, &right.frames[0].camera, &offline, &err), err);
        const int blocks = check_blocks(&plan, &camera, &l, &r, &worst_x, &worst_y);
        print_message("turn %g %g: %d blocks, front %.2f px, behind %.2f px; off by %.3f px across, %.3f px down\n",
                      turns[i][0], turns[i][1], blocks, plan.front, plan.behind, worst_x, worst_y);
        assert_true(blocks > 30);
        assert_true(worst_y <= 0.3);
        assert_true(worst_x <= 0.3);
        rendered_frame_release(&l);
        rendered_frame_release(&r);
        camera_path_release(&left);
        camera_path_release(&right);
        camera_path_release(&film);
        eyes_plan_release(&plan);
    }
    layer_scene_release(&f.scene);
}

static void half_spheres_look_the_same_way_and_never_converge(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct camera_path film = {0}, left = {0}, right = {0};
    struct eyes_plan plan = {0};
    const struct view camera = camera_at(0.3, -0.2, 0.1, -0.2);
    const struct eyes_depth depths[1] = {{6, 10, 0}};
    make_film(&film, &camera, 1);
    assert_ok(eyes_plan_from_depths(&plan, &film, depths, EYES_HALF_SPHERE, &usual, &err), err);
    assert_ok(eyes_path(&left, &film, &plan, -1, &err), err);
    assert_ok(eyes_path(&right, &film, &plan, 1, &err), err);
    const struct view *l = &left.frames[0].camera, *r = &right.frames[0].camera;
    assert_int_equal(l->width, usual.vr_side);
    assert_int_equal(l->height, usual.vr_side);
    assert_true(l->fx == usual.vr_side / 2.0 && l->cx == l->fx && r->cx == l->fx);
    assert_float_equal(plan.base, 0.2, 1e-12);
    /* 1/30 radian is 1.9 degrees of 180 */
    assert_float_equal(plan.front, usual.vr_side / 30.0 / acos(-1), 1e-9);
    assert_true(plan.behind == 0 && plan.frames[0].convergence == 0);
    assert_memory_equal(&l->cam_from_world, &r->cam_from_world, sizeof l->cam_from_world);
    camera_path_release(&left);
    camera_path_release(&right);
    eyes_plan_release(&plan);
    camera_path_release(&film);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(near_things_limit_the_distance_to_a_thirtieth),
        cmocka_unit_test(deep_scenes_use_the_budget_of_disparity_and_no_more),
        cmocka_unit_test(a_given_distance_is_kept),
        cmocka_unit_test(the_screen_never_leaves_what_a_frame_shows),
        cmocka_unit_test(points_have_the_disparity_of_their_depth_and_none_vertically),
        cmocka_unit_test(rendered_eyes_differ_by_the_disparity_of_the_depth_alone),
        cmocka_unit_test(half_spheres_look_the_same_way_and_never_converge),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
