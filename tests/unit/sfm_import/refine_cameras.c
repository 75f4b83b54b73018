/* refine_cameras.c - bundle adjustment of simulated photos whose lenses and poses are known. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/log.h"
#include "common/base/parallel.h"
#include "stages/sfm_import/refine_cameras.h"
#include "tests/unit/sfm_import/disturb.h"

enum { MAX_PHOTOS = 16 };

/* A set of photos to simulate. Lengths in scene units; the points are 3 to 9 in front of the cameras. */
struct setup {
    struct camera lens;
    int photos, points;
    double shift;      /* px, standard deviation of the principal points */
    double noise;      /* px */
    double wrong;      /* share of observations that are off by up to 4 px */
    bool flat;         /* all points in one slanted plane */
    int sparse_points; /* of the last photo; 0: all */
    int of_station;    /* photos that are taken from one place, turned; 0: one */
    int tracks;        /* photos at most that observe a point, each from another place; 0: all */
};

static const struct camera simple = {CAMERA_SIMPLE_RADIAL, 800, 600, {650, 400, 300, -0.05}};
static const struct camera fisheye = {CAMERA_OPENCV_FISHEYE, 800, 600, {300, 300, 400, 300, -0.03, 0.002, 0, 0}};

struct truth {
    struct sfm_model model; /* exact */
    double shift[MAX_PHOTOS][2];
};

/* Photos from an arc that look at the points' middle; every point in the picture is observed. */
static void simulate(struct truth *t, const struct setup *s)
{
    const struct rng rng = rng_make(7, "refine_cameras", "test");
    struct sfm_model *m = &t->model;
    *t = (struct truth){0};
    m->cameras = calloc(1, sizeof *m->cameras);
    m->images = calloc((size_t)s->photos, sizeof *m->images);
    m->points = calloc((size_t)s->points, sizeof *m->points);
    m->camera_count = 1;
    m->image_count = s->photos;
    m->cameras[0] = (struct sfm_camera){1, s->lens};
    for (int i = 0; i < s->photos; i++) {
        struct sfm_image *im = &m->images[i];
        const int turns = s->of_station ? s->of_station : 1, place = i / turns;
        const double a = 0.5 * ((turns * place + 0.5) / s->photos - 0.5), roll = 0.3 * normal(&rng, (uint64_t)i, 30);
        const double yaw = a + 0.25 * (i % turns - 0.5 * (turns - 1));
        im->cam_from_world.rotation = turned(turned((struct quat){1, 0, 0, 0}, 0.02 * (i % 3), yaw, 0), 0, 0, roll);
        im->id = i + 1;
        im->name = malloc(32);
        snprintf(im->name, 32, "p%02d.jpg", i);
        im->observations = calloc((size_t)s->points, sizeof *im->observations);
        const struct vec3 centre = vec3_make(6 * sin(a), 0.4 * (place % 3 - 1), 6 - 6 * cos(a) + 0.3 * (place % 2));
        const struct vec3 moved = mat3_apply(mat3_from_quat(im->cam_from_world.rotation), centre);
        im->cam_from_world.translation = vec3_scale(moved, -1);
        for (int k = 0; k < 2; k++) t->shift[i][k] = s->shift * normal(&rng, (uint64_t)i, (uint64_t)(40 + k));
    }
    for (int i = 0; i < s->points; i++) {
        struct sfm_point *p = &m->points[m->point_count++];
        const uint64_t n = 1000 + (uint64_t)i;
        const double x = 6 * rng_uniform(&rng, n, 0) - 3, y = 4 * rng_uniform(&rng, n, 1) - 2;
        const double z = s->flat ? 6 + 0.4 * x + 0.2 * y : 3 + 6 * rng_uniform(&rng, n, 2);
        *p = (struct sfm_point){.id = i + 1, .position = {x, y, z}, .error = -1};
        p->track = calloc((size_t)s->photos, sizeof *p->track);
        const int from = s->tracks ? (int)(rng_uniform(&rng, n, 5) * s->photos) : 0;
        for (int step = 0; step < s->photos; step++) {
            const int k = (from + step) % s->photos, turns = s->of_station ? s->of_station : 1;
            struct sfm_image *im = &m->images[k];
            double u, v;
            bool wanted = !s->tracks || p->track_count < s->tracks;
            for (int j = 0; j < p->track_count && s->tracks; j++)
                wanted = wanted && p->track[j].image_idx / turns != k / turns;
            if (!wanted) continue;
            if (s->sparse_points && k == s->photos - 1 && im->observation_count == s->sparse_points) continue;
            if (!camera_project(&s->lens, pose_apply(&im->cam_from_world, p->position), &u, &v)) continue;
            if (!(u >= 0 && v >= 0 && u <= s->lens.width && v <= s->lens.height)) continue;
            const uint64_t at = n * MAX_PHOTOS + (uint64_t)k;
            u += t->shift[k][0] + s->noise * normal(&rng, at, 3);
            v += t->shift[k][1] + s->noise * normal(&rng, at, 4);
            if (rng_uniform(&rng, at, 20) < s->wrong) u += 8 * rng_uniform(&rng, at, 21) - 4;
            p->track[p->track_count++] = (struct sfm_track){k, im->observation_count};
            im->observations[im->observation_count++] = (struct sfm_observation){u, v, p->id};
        }
    }
}

/* A start as structure from motion would leave it: without shifts, poses and points off, the lens simpler. */
static void perturb(struct sfm_model *m)
{
    const struct rng rng = rng_make(8, "refine_cameras", "perturb");
    struct camera *c = &m->cameras[0].camera;
    c->params[0] *= 1.02;
    if (c->model == CAMERA_SIMPLE_RADIAL) c->params[3] = 0;
    if (c->model == CAMERA_OPENCV_FISHEYE) c->params[1] *= 1.02;
    for (int i = 1; i < m->image_count; i++) {
        struct pose *p = &m->images[i].cam_from_world;
        double d[6];
        for (int k = 0; k < 6; k++) d[k] = normal(&rng, (uint64_t)i, (uint64_t)k);
        p->rotation = turned(p->rotation, 0.003 * d[0], 0.003 * d[1], 0.003 * d[2]);
        p->translation = vec3_add(p->translation, vec3_make(0.02 * d[3], 0.02 * d[4], 0.02 * d[5]));
    }
    for (int i = 0; i < m->point_count; i++) {
        struct vec3 *x = &m->points[i].position;
        const uint64_t n = 100 + (uint64_t)i;
        *x = vec3_add(*x, vec3_make(0.02 * normal(&rng, n, 0), 0.02 * normal(&rng, n, 1), 0.05 * normal(&rng, n, 2)));
    }
}

static const struct sfm_import_params defaults = SFM_IMPORT_PARAMS_DEFAULT;

struct outcome {
    struct truth truth;
    struct sfm_model model; /* refined; released with the truth's, whose observations it has */
    struct refinement r;
};

static void refine(struct outcome *o, const struct setup *s, enum given_cameras given, const char *asked)
{
    struct sfm_import_params params = defaults;
    struct err err = ERR_INIT;
    snprintf(params.refine, sizeof params.refine, "%s", asked);
    simulate(&o->truth, s);
    struct truth copy;
    simulate(&copy, s);
    o->model = copy.model;
    perturb(&o->model);
    assert_ok(refine_cameras(&o->r, &o->model, given, (struct split_size){0}, &params, &err), err);
}

static void release(struct outcome *o)
{
    sfm_model_release(&o->truth.model);
    sfm_model_release(&o->model);
    refine_cameras_release(&o->r);
}

static const struct lens_form *chosen(const struct outcome *o)
{
    assert_true(o->r.chosen >= 0);
    return &o->r.forms[o->r.chosen].form;
}

/* Degrees between the refined and the true rotation from one photo to the next; the largest. */
static double rotation_error(const struct outcome *o, int photos)
{
    double worst = 0;
    for (int i = 1; i < photos; i++) {
        struct mat3 turn[2];
        const struct sfm_model *m[2] = {&o->truth.model, &o->model};
        for (int k = 0; k < 2; k++)
            turn[k] = mat3_multiply(mat3_from_quat(m[k]->images[i].cam_from_world.rotation),
                                    mat3_transpose(mat3_from_quat(m[k]->images[i - 1].cam_from_world.rotation)));
        const struct mat3 d = mat3_multiply(turn[0], mat3_transpose(turn[1]));
        const double sine = 0.5 * hypot(hypot(d.m[2][1] - d.m[1][2], d.m[0][2] - d.m[2][0]), d.m[1][0] - d.m[0][1]);
        worst = fmax(worst, asin(fmin(sine, 1)) / DEGREE);
    }
    return worst;
}

/* ------------------------------------------------------------------------------------------------------ given poses */

/* Refines, as the user asked, given poses: places and rotations are off by these standard deviations. */
static void refine_given(struct outcome *o, struct sfm_model *start, const struct setup *s, double off, double turn)
{
    const struct rng rng = rng_make(9, "refine_cameras", "given");
    struct sfm_import_params params = defaults;
    struct err err = ERR_INIT;
    struct truth copies[2];
    snprintf(params.refine, sizeof params.refine, "yes");
    simulate(&o->truth, s);
    for (int c = 0; c < 2; c++) {
        simulate(&copies[c], s);
        for (int i = 0; i < s->photos; i++) {
            struct pose *p = &copies[c].model.images[i].cam_from_world;
            const int place = i / (s->of_station ? s->of_station : 1);
            struct vec3 center = pose_center(p);
            double d[6];
            for (int k = 0; k < 3; k++) d[k] = normal(&rng, (uint64_t)place, (uint64_t)k);
            for (int k = 3; k < 6; k++) d[k] = normal(&rng, (uint64_t)i, (uint64_t)k);
            if (off > 0) center = vec3_add(center, vec3_scale(vec3_make(d[0], d[1], d[2]), off));
            if (turn > 0) p->rotation = turned(p->rotation, turn * d[3], turn * d[4], turn * d[5]);
            p->translation = vec3_scale(mat3_apply(mat3_from_quat(p->rotation), center), -1);
        }
    }
    *start = copies[0].model;
    o->model = copies[1].model;
    assert_ok(refine_cameras(&o->r, &o->model, GIVEN_MODEL, (struct split_size){0}, &params, &err), err);
}

/* The root mean square of the distances of centres from the true ones. */
static double center_error(const struct sfm_model *m, const struct outcome *o)
{
    double sum = 0;
    for (int i = 0; i < m->image_count; i++) {
        const struct vec3 off =
            vec3_sub(pose_center(&m->images[i].cam_from_world), pose_center(&o->truth.model.images[i].cam_from_world));
        sum += vec3_dot(off, off) / m->image_count;
    }
    return sqrt(sum);
}

static void photos_of_one_place_keep_one_centre(void **state)
{
    (void)state;
    struct outcome o;
    struct sfm_model start;
    const struct setup s = {.lens = simple, .photos = 16, .points = 700, .noise = 0.3, .of_station = 4, .tracks = 2};
    refine_given(&o, &start, &s, 0.02, 0.002);
    assert_int_not_equal(chosen(&o)->center, CENTER_PER_PHOTO);
    for (int i = 0; i < 16; i++) {
        const struct vec3 a = pose_center(&o.model.images[i].cam_from_world);
        const struct vec3 b = pose_center(&o.model.images[i / 4 * 4].cam_from_world);
        assert_true(vec3_length(vec3_sub(a, b)) < 1e-12);
    }
    assert_true(center_error(&o.model, &o) < center_error(&start, &o));
    assert_true(o.r.gain.mean > 2 * o.r.gain.error);
    sfm_model_release(&start);
    release(&o);
}

/* Few points of two photos each: the residual falls by fitting their errors. */
static void given_poses_that_are_right_are_kept(void **state)
{
    (void)state;
    struct outcome o;
    struct sfm_model start;
    const struct setup s = {.lens = simple, .photos = 12, .points = 200, .noise = 0.5, .tracks = 2};
    refine_given(&o, &start, &s, 0, 0);
    assert_int_equal(o.r.chosen, -1);
    bool falls = false;
    for (int i = 0; i < o.r.form_count; i++)
        falls |= o.r.forms[i].held_out && o.r.forms[i].fit.noise < 0.9 * o.r.before.noise;
    assert_true(falls);
    for (int i = 0; i < 12; i++)
        assert_memory_equal(&o.model.images[i].cam_from_world, &start.images[i].cam_from_world, sizeof(struct pose));
    assert_true(o.model.cameras[0].camera.params[0] == 650);
    sfm_model_release(&start);
    release(&o);
}

static void a_given_photo_with_few_points_keeps_its_pose(void **state)
{
    (void)state;
    struct outcome o;
    struct sfm_model start;
    const struct setup s = {.lens = simple, .photos = 8, .points = 300, .noise = 0.3, .sparse_points = 8};
    refine_given(&o, &start, &s, 0.02, 0.002);
    assert_true(o.r.chosen >= 0);
    for (int i = 0; i < 8; i++) {
        const struct pose *a = &o.model.images[i].cam_from_world, *b = &start.images[i].cam_from_world;
        assert_int_equal(!memcmp(a, b, sizeof *a), i == 7);
    }
    assert_true(center_error(&o.model, &o) < center_error(&start, &o));
    sfm_model_release(&start);
    release(&o);
}

static void principal_point(const struct sfm_model *m, int image, double center[2])
{
    double fx, fy;
    camera_focal(&m->cameras[m->images[image].camera_idx].camera, &fx, &fy, &center[0], &center[1]);
}

/* How many of the photos' principal points are within three stated deviations of the truth in both directions, and
 * the largest stated deviation. */
static int points_within(const struct outcome *o, double *largest)
{
    int within = 0;
    *largest = 0;
    for (int i = 0; i < o->model.image_count; i++) {
        const struct camera *lens = &o->truth.model.cameras[0].camera;
        const struct principal_shift *s = &o->r.shifts[i];
        double found[2], fx, fy, true_center[2];
        principal_point(&o->model, i, found);
        camera_focal(lens, &fx, &fy, &true_center[0], &true_center[1]);
        const double du = found[0] - true_center[0] - o->truth.shift[i][0];
        const double dv = found[1] - true_center[1] - o->truth.shift[i][1];
        within += fabs(du) <= 3 * s->sigma_u && fabs(dv) <= 3 * s->sigma_v;
        *largest = fmax(*largest, fmax(s->sigma_u, s->sigma_v));
    }
    return within;
}

static void shifted_principal_points_are_recovered_within_their_interval(void **state)
{
    (void)state;
    struct outcome o;
    double sigma;
    const struct setup s = {.lens = simple, .photos = 12, .points = 500, .shift = 3, .noise = 0.3, .wrong = 0.05};
    refine(&o, &s, GIVEN_NOTHING, "auto");
    assert_int_equal(chosen(&o)->center, CENTER_PER_PHOTO);
    assert_int_equal(chosen(&o)->model, CAMERA_SIMPLE_RADIAL);
    assert_int_equal(points_within(&o, &sigma), 12);
    assert_true(sigma < 1.5);
    assert_true(o.r.before.median > 2 && o.r.after.median < 0.42);
    assert_true(o.r.after.noise > 0.2 && o.r.after.noise < 0.33); /* Student's scale is below a Gaussian's sigma */
    assert_true(rotation_error(&o, 12) < 0.15);
    release(&o);
}

static void one_lens_is_chosen_for_photos_with_one_principal_point(void **state)
{
    (void)state;
    struct outcome o;
    const struct setup s = {.lens = simple, .photos = 12, .points = 500, .noise = 0.3, .wrong = 0.05};
    refine(&o, &s, GIVEN_NOTHING, "auto");
    assert_int_equal(chosen(&o)->center, CENTER_KEPT);
    assert_int_equal(chosen(&o)->model, CAMERA_SIMPLE_RADIAL);
    assert_int_equal(o.model.camera_count, 1);
    assert_null(o.r.shifts);
    assert_true(fabs(o.model.cameras[0].camera.params[0] - 650) < 2);
    assert_true(fabs(o.model.cameras[0].camera.params[3] + 0.05) < 0.003);
    assert_true(rotation_error(&o, 12) < 0.03);
    release(&o);
}

static void one_principal_point_off_the_centre_is_found(void **state)
{
    (void)state;
    struct outcome o;
    struct setup s = {.lens = simple, .photos = 12, .points = 500, .noise = 0.3};
    s.lens.params[1] = 409;
    s.lens.params[2] = 294;
    simulate(&o.truth, &s);
    struct truth start;
    simulate(&start, &s);
    o.model = start.model;
    perturb(&o.model);
    o.model.cameras[0].camera.params[1] = 400;
    o.model.cameras[0].camera.params[2] = 300;
    struct err err = ERR_INIT;
    assert_ok(refine_cameras(&o.r, &o.model, GIVEN_NOTHING, (struct split_size){0}, &defaults, &err), err);
    double found[2];
    principal_point(&o.model, 0, found);
    assert_int_equal(chosen(&o)->center, CENTER_SHARED);
    assert_true(fabs(found[0] - 409) < 2.5 && fabs(found[1] - 294) < 2.5);
    release(&o);
}

static void a_lens_with_two_coefficients_is_found_from_one_with_none(void **state)
{
    (void)state;
    struct outcome o;
    struct setup s = {.lens = {CAMERA_RADIAL, 800, 600, {650, 400, 300, -0.2, 0.12}}, .photos = 12, .points = 500};
    s.noise = 0.3;
    simulate(&o.truth, &s);
    struct truth start;
    simulate(&start, &s);
    o.model = start.model;
    perturb(&o.model);
    o.model.cameras[0].camera = (struct camera){CAMERA_SIMPLE_PINHOLE, 800, 600, {640, 400, 300}};
    struct err err = ERR_INIT;
    assert_ok(refine_cameras(&o.r, &o.model, GIVEN_NOTHING, (struct split_size){0}, &defaults, &err), err);
    assert_int_equal(chosen(&o)->model, CAMERA_RADIAL);
    assert_true(fabs(o.model.cameras[0].camera.params[3] + 0.2) < 0.02);
    release(&o);
}

static void two_photos_do_not_drift(void **state)
{
    (void)state;
    struct outcome o;
    const struct setup s = {.lens = simple, .photos = 2, .points = 400, .noise = 0.3};
    refine(&o, &s, GIVEN_NOTHING, "auto");
    assert_int_not_equal(chosen(&o)->center, CENTER_PER_PHOTO);
    assert_true(o.r.after.median < 0.4);
    const double f = o.model.cameras[o.model.images[0].camera_idx].camera.params[0];
    assert_true(fabs(f - 650) < 0.1 * 650);
    assert_true(rotation_error(&o, 2) < 0.3);
    release(&o);
}

static void points_in_one_plane_do_not_drift(void **state)
{
    (void)state;
    struct outcome o;
    const struct setup s = {.lens = simple, .photos = 8, .points = 600, .noise = 0.3, .flat = true};
    refine(&o, &s, GIVEN_NOTHING, "auto");
    assert_true(o.r.after.median < 0.4);
    const double f = o.model.cameras[o.model.images[0].camera_idx].camera.params[0];
    assert_true(fabs(f - 650) < 0.1 * 650);
    for (int i = 0; i < 8; i++) {
        double found[2];
        principal_point(&o.model, i, found);
        assert_true(hypot(found[0] - 400, found[1] - 300) < 20);
    }
    assert_true(rotation_error(&o, 8) < 0.5);
    release(&o);
}

static void a_photo_with_ten_points_stays_near_its_prior(void **state)
{
    (void)state;
    struct outcome o;
    double sigma;
    const struct setup s = {.lens = simple, .photos = 9, .points = 500, .shift = 3, .noise = 0.3, .sparse_points = 10};
    refine(&o, &s, GIVEN_NOTHING, "auto");
    assert_int_equal(o.truth.model.images[8].observation_count, 10);
    assert_int_equal(chosen(&o)->center, CENTER_PER_PHOTO);
    assert_int_equal(points_within(&o, &sigma), 9);
    assert_true(o.r.shifts[8].sigma_u > o.r.shifts[7].sigma_u);
    assert_true(hypot(o.r.shifts[8].u, o.r.shifts[8].v) < 12);
    release(&o);
}

static void a_fisheye_keeps_its_model(void **state)
{
    (void)state;
    struct outcome o;
    double sigma;
    struct setup s = {.lens = fisheye, .photos = 10, .points = 500, .noise = 0.2};
    refine(&o, &s, GIVEN_NOTHING, "auto");
    assert_true(chosen(&o)->model_kept && chosen(&o)->center == CENTER_KEPT);
    assert_int_equal(o.model.cameras[0].camera.model, CAMERA_OPENCV_FISHEYE);
    assert_true(fabs(o.model.cameras[0].camera.params[0] - 300) < 2);
    assert_true(rotation_error(&o, 10) < 0.05);
    release(&o);
    s.shift = 3;
    refine(&o, &s, GIVEN_NOTHING, "auto");
    assert_true(chosen(&o)->model_kept && chosen(&o)->center == CENTER_PER_PHOTO);
    assert_int_equal(points_within(&o, &sigma), 10);
    release(&o);
}

static void what_the_user_gave_is_refined_only_on_request(void **state)
{
    (void)state;
    struct outcome o;
    const struct setup s = {.lens = simple, .photos = 8, .points = 300, .noise = 0.3};
    refine(&o, &s, GIVEN_MODEL, "auto");
    assert_int_equal(o.r.chosen, -1);
    assert_true(o.model.cameras[0].camera.params[0] == 650 * 1.02);
    release(&o);
    refine(&o, &s, GIVEN_NOTHING, "no");
    assert_int_equal(o.r.chosen, -1);
    release(&o);
    refine(&o, &s, GIVEN_LENS, "auto");
    assert_true(chosen(&o)->lens_kept);
    assert_true(o.model.cameras[0].camera.params[0] == 650 * 1.02 && o.model.cameras[0].camera.params[3] == 0);
    assert_true(o.r.after.noise < o.r.before.noise);
    release(&o);
    refine(&o, &s, GIVEN_MODEL, "yes");
    assert_true(fabs(o.model.cameras[0].camera.params[0] - 650) < 4);
    release(&o);
}

static void a_model_with_few_observations_is_kept(void **state)
{
    (void)state;
    struct outcome o;
    const struct setup s = {.lens = simple, .photos = 2, .points = 12, .noise = 0.3};
    refine(&o, &s, GIVEN_NOTHING, "auto");
    assert_int_equal(o.r.chosen, -1);
    assert_true(o.model.cameras[0].camera.params[0] == 650 * 1.02);
    release(&o);
}

static void the_same_bits_come_from_any_number_of_threads(void **state)
{
    (void)state;
    struct outcome one, three;
    const struct setup s = {.lens = simple, .photos = 6, .points = 300, .shift = 2, .noise = 0.3};
    parallel_set_threads(1);
    refine(&one, &s, GIVEN_NOTHING, "auto");
    parallel_set_threads(3);
    refine(&three, &s, GIVEN_NOTHING, "auto");
    parallel_set_threads(0);
    assert_int_equal(one.r.chosen, three.r.chosen);
    for (int i = 0; i < 6; i++) {
        assert_memory_equal(&one.model.images[i].cam_from_world, &three.model.images[i].cam_from_world,
                            sizeof(struct pose));
        assert_memory_equal(one.model.cameras[one.model.images[i].camera_idx].camera.params,
                            three.model.cameras[three.model.images[i].camera_idx].camera.params, 12 * sizeof(double));
    }
    for (int i = 0; i < one.model.point_count; i++)
        assert_memory_equal(&one.model.points[i].position, &three.model.points[i].position, sizeof(struct vec3));
    release(&one);
    release(&three);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shifted_principal_points_are_recovered_within_their_interval),
        cmocka_unit_test(one_lens_is_chosen_for_photos_with_one_principal_point),
        cmocka_unit_test(one_principal_point_off_the_centre_is_found),
        cmocka_unit_test(a_lens_with_two_coefficients_is_found_from_one_with_none),
        cmocka_unit_test(two_photos_do_not_drift),
        cmocka_unit_test(points_in_one_plane_do_not_drift),
        cmocka_unit_test(a_photo_with_ten_points_stays_near_its_prior),
        cmocka_unit_test(a_fisheye_keeps_its_model),
        cmocka_unit_test(what_the_user_gave_is_refined_only_on_request),
        cmocka_unit_test(a_model_with_few_observations_is_kept),
        cmocka_unit_test(photos_of_one_place_keep_one_centre),
        cmocka_unit_test(given_poses_that_are_right_are_kept),
        cmocka_unit_test(a_given_photo_with_few_points_keeps_its_pose),
        cmocka_unit_test(the_same_bits_come_from_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
