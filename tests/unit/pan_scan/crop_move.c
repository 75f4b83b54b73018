/* crop_move.c - tests that crops follow a straight move over a flat wall exactly, for every orientation of the stored
 * photograph, and show a misfit over depth. */
#include "stages/pan_scan/crop_move.h"

#include "tests/unit/scratch.h"

#include <math.h>

enum { SIDE = 9, POINTS = SIDE * SIDE, FRAMES = 11, W = 400, H = 300, FILM_W = 160, FILM_H = 90 };

struct fixture {
    struct view views[3];
    struct camera_set set;
    struct sfm_image images[3];
    struct sfm_observation seen[3][POINTS];
    struct sfm_point points[POINTS];
    struct sfm_track tracks[POINTS][3];
    struct camera_path path;
};

/* An upright camera that faces along z. */
static struct view camera_at(double x, double y, double z, int width, int height, double focal)
{
    struct view v = {.width = width, .height = height, .fx = focal, .fy = focal, .cx = width / 2.0, .cy = height / 2.0};
    v.cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    v.center = vec3_make(x, y, z);
    v.translation = vec3_scale(v.center, -1);
    return v;
}

/* Stores the view's picture on its side: (x, y) goes to (y, width - x), the inverse of a clockwise quarter turn. */
static void store_turned(struct view *v)
{
    const struct view o = *v;
    v->width = o.height, v->height = o.width;
    v->fx = o.fy, v->fy = o.fx;
    v->cx = o.cy, v->cy = o.width - o.cx;
    for (int k = 0; k < 3; k++) {
        v->cam_from_world.m[0][k] = o.cam_from_world.m[1][k];
        v->cam_from_world.m[1][k] = -o.cam_from_world.m[0][k];
    }
    v->translation = vec3_make(o.translation.y, -o.translation.x, o.translation.z);
}

/* A wall at z = 10, with every third point nearer by `relief` and the next by twice that; three views of it, stored
 * rotated by quarter turns; an eased move to the right and forward. */
static void make(struct fixture *f, int quarters, double relief)
{
    static const char *const names[] = {"left", "middle", "right"};
    struct err err = ERR_INIT;
    *f = (struct fixture){.set = {.views = f->views, .view_count = 3}};
    f->set.model =
        (struct sfm_model){.images = f->images, .points = f->points, .image_count = 3, .point_count = POINTS};
    for (int i = 0; i < POINTS; i++) {
        f->points[i].position = vec3_make(i % SIDE - SIDE / 2, 0.8 * (i / SIDE - SIDE / 2), 10 - relief * (i % 3));
        f->points[i].track = f->tracks[i];
        f->points[i].track_count = 3;
    }
    for (int k = 0; k < 3; k++) {
        f->views[k] = camera_at(k - 1, 0.1, 0, W, H, 380);
        f->views[k].name = names[k];
        for (int q = 0; q < quarters; q++) store_turned(&f->views[k]);
        f->images[k].observations = f->seen[k];
        f->images[k].observation_count = POINTS;
        for (int i = 0; i < POINTS; i++) {
            view_project(&f->views[k], f->points[i].position, &f->seen[k][i].u, &f->seen[k][i].v);
            f->tracks[i][k] = (struct sfm_track){k, i};
        }
    }
    assert_ok(camera_path_init(&f->path, "move", 30, FRAMES, &err), err);
    for (int i = 0; i < FRAMES; i++) {
        const double t = i / (FRAMES - 1.0), eased = t * t * (3 - 2 * t);
        struct view v = camera_at(-0.4 + 1.0 * eased, 0.05, 0.5 * eased, FILM_W, FILM_H, 170);
        v.name = f->path.frames[i].camera.name;
        f->path.frames[i].camera = v;
    }
}

static void release(struct fixture *f) { camera_path_release(&f->path); }

static void a_flat_wall_is_followed_exactly(void **state)
{
    struct crop upright[2] = {{0}};
    (void)state;
    for (int quarters = 0; quarters < 4; quarters++) {
        struct fixture f;
        struct crop_move m;
        struct err err = ERR_INIT;
        make(&f, quarters, 0);
        assert_ok(crop_move_init(&m, &f.set, 1, NULL, &f.path, 0.01, &err), err);
        assert_int_equal(m.quarters, quarters);
        assert_int_equal(m.view.width, W);
        assert_int_equal(m.point_count, POINTS);
        for (int end = 0; end < 2; end++) {
            const struct crop c = crop_move_crop(&m, end ? FRAMES - 1 : 0);
            assert_true(m.misfits[end] < 1e-9 && m.ends[end].beyond == 0);
            if (!quarters) upright[end] = c;
            assert_true(fabs(c.x - upright[end].x) < 1e-9 && fabs(c.y - upright[end].y) < 1e-9 &&
                        fabs(c.width - upright[end].width) < 1e-9);
            /* the wall is at depth 10 from the view, and at 10 and 9.5 from the film's ends */
            const double width = FILM_W * (380 / 10.0) / (170 / (end ? 9.5 : 10.0));
            assert_true(fabs(c.width - width) < 1e-9 && fabs(c.height - width * FILM_H / FILM_W) < 1e-9);
            assert_true(fabs(c.x + c.width / 2 - (W / 2.0 + 38 * (end ? 0.6 : -0.4))) < 1e-9);

            /* the rectangle in the stored picture has the same ray through its centre */
            const struct crop s = crop_move_stored(&m, c);
            const struct vec3 a = view_unproject(&f.views[1], s.x + s.width / 2, s.y + s.height / 2, 10);
            const struct vec3 b = view_unproject(&m.view, c.x + c.width / 2, c.y + c.height / 2, 10);
            assert_true(vec3_length(vec3_sub(a, b)) < 1e-9);
            assert_true(fabs(quarters % 2 ? s.height - c.width : s.width - c.width) < 1e-12);
        }
        /* a stored pixel goes to where the rotated view has its ray */
        struct image im = {0};
        assert_ok(image_init(&im, f.views[1].width, f.views[1].height, 1, &err), err);
        image_at(&im, 70, 45)[0] = 1;
        assert_ok(crop_move_turn(&im, &m, &err), err);
        double u = 0, v = 0;
        view_project(&m.view, view_unproject(&f.views[1], 70.5, 45.5, 3), &u, &v);
        assert_true(im.width == W && im.height == H && image_at(&im, (int)u, (int)v)[0] == 1);
        image_release(&im);
        crop_move_release(&m);
        crop_move_release(&m);
        release(&f);
    }
}

static void depth_causes_misfit(void **state)
{
    struct fixture f;
    struct crop_move m;
    struct err err = ERR_INIT;
    double misfit;
    (void)state;
    make(&f, 0, 2);
    assert_ok(crop_move_init(&m, &f.set, 1, NULL, &f.path, 0.01, &err), err);
    assert_true(m.misfits[0] > 1 && m.misfits[1] > 1);
    assert_ok(crop_move_misfit(&misfit, &m, FRAMES - 1, &err), err);
    assert_true(misfit == m.misfits[1]);
    crop_move_release(&m);
    release(&f);
}

static void a_depth_map_replaces_sparse_points(void **state)
{
    struct fixture f;
    struct crop_move m, sparse;
    struct layered_depth d = {0};
    struct err err = ERR_INIT;
    (void)state;
    make(&f, 1, 0);
    assert_ok(layered_depth_init(&d, f.views[1].width, f.views[1].height, &err), err);
    for (int p = 0; p < W * H; p++) d.interior.z[p] = p % 7 ? 10 : 0;
    assert_ok(crop_move_init(&m, &f.set, 1, &d, &f.path, 0.01, &err), err);
    assert_ok(crop_move_init(&sparse, &f.set, 1, NULL, &f.path, 0.01, &err), err);
    for (int i = 0; i < FRAMES; i++) {
        const struct crop a = crop_move_crop(&m, i), b = crop_move_crop(&sparse, i);
        assert_true(fabs(a.x - b.x) < 1e-8 && fabs(a.y - b.y) < 1e-8 && fabs(a.width - b.width) < 1e-8);
    }
    crop_move_release(&m);
    crop_move_release(&sparse);
    d.width--; /* of another size */
    assert_int_equal(crop_move_init(&m, &f.set, 1, &d, &f.path, 0.01, &err), ST_DATA);
    assert_err(err, ST_DATA, "depth map of view middle");
    d.width++;
    layered_depth_release(&d);
    release(&f);
}

static void crops_are_eased_as_the_path_is(void **state)
{
    struct fixture f;
    struct crop_move m;
    struct err err = ERR_INIT;
    (void)state;
    make(&f, 0, 0);
    assert_ok(crop_move_init(&m, &f.set, 1, NULL, &f.path, 0.01, &err), err);
    for (int i = 0; i < FRAMES; i++) {
        const double t = i / (FRAMES - 1.0), eased = t * t * (3 - 2 * t);
        assert_true(fabs(m.fractions[i] - eased) < 1e-12);
        const struct crop c = crop_move_crop(&m, i);
        assert_true(fabs(c.x - ((1 - eased) * m.ends[0].crop.x + eased * m.ends[1].crop.x)) < 1e-9);
    }
    crop_move_release(&m);

    for (int i = 0; i < FRAMES; i++) { /* the camera zooms in place: f = f0 exp(t^2) */
        struct view *v = &f.path.frames[i].camera;
        const struct view still = camera_at(0, 0, 0, FILM_W, FILM_H, 170);
        const char *name = v->name;
        *v = still;
        v->name = name;
        v->fx = v->fy = 170 * exp(i * i / 100.0);
    }
    assert_ok(crop_move_init(&m, &f.set, 1, NULL, &f.path, 0.01, &err), err);
    for (int i = 0; i < FRAMES; i++) assert_true(fabs(m.fractions[i] - i * i / 100.0) < 1e-12);
    crop_move_release(&m);

    for (int i = 0; i < FRAMES; i++)
        f.path.frames[i].camera.fx = f.path.frames[i].camera.fy = 170; /* a static camera */
    assert_ok(crop_move_init(&m, &f.set, 1, NULL, &f.path, 0.01, &err), err);
    for (int i = 0; i < FRAMES; i++) assert_true(fabs(m.fractions[i] - i / 10.0) < 1e-12);
    crop_move_release(&m);

    f.path.frame_count = 1; /* a single frame */
    assert_ok(crop_move_init(&m, &f.set, 1, NULL, &f.path, 0.01, &err), err);
    assert_true(m.fractions[0] == 0 && crop_move_crop(&m, 0).width == m.ends[1].crop.width);
    crop_move_release(&m);
    f.path.frame_count = FRAMES;
    release(&f);
}

static void a_move_beyond_the_photograph_is_held_at_its_border(void **state)
{
    struct fixture f;
    struct crop_move m;
    struct err err = ERR_INIT;
    (void)state;
    make(&f, 0, 0);
    for (int i = 0; i < FRAMES; i++) {
        struct view *v = &f.path.frames[i].camera;
        v->center.x += 3, v->translation.x -= 3;
    }
    assert_ok(crop_move_init(&m, &f.set, 1, NULL, &f.path, 0.01, &err), err);
    assert_true(m.ends[0].beyond > 10 && m.ends[1].beyond > m.ends[0].beyond);
    for (int i = 0; i < FRAMES; i++) {
        const struct crop c = crop_move_crop(&m, i);
        assert_true(c.x >= 0 && c.y >= 0 && c.x + c.width <= W + 1e-9 && c.y + c.height <= H + 1e-9);
    }
    crop_move_release(&m);
    release(&f);
}

static void the_nearest_view_that_faces_the_same_way_is_chosen(void **state)
{
    struct fixture f;
    (void)state;
    make(&f, 0, 0);
    assert_int_equal(crop_move_choose_view(&f.set, &f.path), 1);
    f.views[1].cam_from_world = (struct mat3){{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}; /* it faces backwards */
    assert_int_equal(crop_move_choose_view(&f.set, &f.path), 2);
    f.views[0].center =
        f.views[2].center; /* two at one position, as the views of a wide photo: the better aligned one */
    const double c = cos(0.3), s = sin(0.3);
    f.views[2].cam_from_world = (struct mat3){{{c, 0, -s}, {0, 1, 0}, {s, 0, c}}};
    assert_int_equal(crop_move_choose_view(&f.set, &f.path), 0);
    for (int k = 0; k < 3; k++)
        f.views[k].cam_from_world = f.views[1].cam_from_world; /* all face backwards: the nearest */
    assert_int_equal(crop_move_choose_view(&f.set, &f.path), 1);
    release(&f);
}

static void a_view_without_points_is_an_error(void **state)
{
    struct fixture f;
    struct crop_move m;
    struct err err = ERR_INIT;
    (void)state;
    make(&f, 0, 0);
    f.set.model.point_count = 2;
    assert_int_equal(crop_move_init(&m, &f.set, 1, NULL, &f.path, 0.01, &err), ST_DATA);
    assert_err(err, ST_DATA, "frame 0001 of the path, seen from view middle: found 2 points");
    assert_null(m.points);
    release(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_wall_is_followed_exactly),
        cmocka_unit_test(depth_causes_misfit),
        cmocka_unit_test(a_depth_map_replaces_sparse_points),
        cmocka_unit_test(crops_are_eased_as_the_path_is),
        cmocka_unit_test(a_move_beyond_the_photograph_is_held_at_its_border),
        cmocka_unit_test(the_nearest_view_that_faces_the_same_way_is_chosen),
        cmocka_unit_test(a_view_without_points_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
