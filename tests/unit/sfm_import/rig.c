/* rig.c - photos of a simulated multi-lens camera: its lenses and captures are found by the names of pictures, and keep
 * their poses relative to each other in the adjustment. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/capture/camera_alignment.h"
#include "stages/sfm_import/refine_cameras.h"
#include "tests/unit/sfm_import/disturb.h"

enum { COLUMNS = 3, ROWS = 2, LENSES = COLUMNS * ROWS, MAX_PICTURES = 4 * LENSES, POINTS = 300 };

static const struct split_size grid = {COLUMNS, ROWS}, no_grid = {0, 0};
static const struct camera lens = {CAMERA_SIMPLE_RADIAL, 800, 600, {650, 400, 300, -0.05}};
static const double noise = 0.5;             /* px */
static const double noise_angle = 0.5 / 650; /* radians */

/* What to simulate: captures of a camera whose lenses are 5 to 9 cm apart, points at 2 to 5 m. */
struct setup {
    int captures;
    double bend;    /* radians by which the lenses of the last capture are turned, each about other axes */
    int missing;    /* picture that is not there; 0: none */
    int sparse;     /* picture with four observations; 0: none */
    bool one_place; /* the lenses of a capture are at one place */
};

struct scene {
    struct sfm_model truth, model; /* the second is off, as structure from motion leaves it, and then refined */
    struct refinement r;
};

static struct pose pose_at(struct quat rotation, struct vec3 center)
{
    return (struct pose){rotation, vec3_scale(mat3_apply(mat3_from_quat(rotation), center), -1)};
}

static struct pose true_pose(const struct setup *s, const struct rng *rng, int picture)
{
    const int capture = picture / LENSES, at = picture % LENSES, column = at % COLUMNS, row = at / COLUMNS;
    const uint64_t of_capture = 100 + (uint64_t)capture, of_lens = 200 + (uint64_t)at;
    const struct quat body = turned((struct quat){1, 0, 0, 0}, 0.05 * normal(rng, of_capture, 0),
                                    0.05 * normal(rng, of_capture, 1), 0.05 * normal(rng, of_capture, 2));
    const struct quat mount =
        turned((struct quat){1, 0, 0, 0}, 0.02 * normal(rng, of_lens, 0), 0.02 * normal(rng, of_lens, 1), 0.02);
    const struct vec3 place = vec3_make(0.06 * column + 0.01 * row, 0.08 * row, 0.005 * normal(rng, of_lens, 2));
    const struct vec3 step = vec3_make(0.35 * capture, 0.1 * (capture % 2), 0.15 * (capture % 3));
    const double bend = capture == s->captures - 1 ? s->bend : 0;
    const struct quat q = turned(quat_multiply(mount, body), bend * normal(rng, of_lens, 3),
                                 bend * normal(rng, of_lens, 4), bend * normal(rng, of_lens, 5));
    const struct vec3 in_world = mat3_apply(mat3_transpose(mat3_from_quat(body)), place);
    return pose_at(q, s->one_place ? step : vec3_add(step, in_world));
}

/* Every point is observed by half of the pictures that it is in; one match in 50 is wrong by up to 20 px. */
static void observe(struct sfm_model *m, const struct setup *s, const struct rng *rng, struct sfm_point *p)
{
    for (int i = 0; i < m->image_count; i++) {
        struct sfm_image *im = &m->images[i];
        const uint64_t key = 10000 + (uint64_t)(p->id * MAX_PICTURES + im->id);
        double u, v;
        if (rng_uniform(rng, key, 0) < 0.5 || (s->sparse == im->id && im->observation_count == 4)) continue;
        if (!camera_project(&lens, pose_apply(&im->cam_from_world, p->position), &u, &v)) continue;
        if (!(u >= 0 && v >= 0 && u <= lens.width && v <= lens.height)) continue;
        u += noise * normal(rng, key, 1);
        v += noise * normal(rng, key, 2);
        if (rng_uniform(rng, key, 6) < 0.02) u += 40 * rng_uniform(rng, key, 7) - 20;
        p->track[p->track_count++] = (struct sfm_track){i, im->observation_count};
        im->observations[im->observation_count++] = (struct sfm_observation){u, v, p->id};
    }
}

static struct sfm_model simulate(const struct setup *s)
{
    const struct rng rng = rng_make(3, "rig", "test");
    struct sfm_model m = {.camera_count = 1};
    m.cameras = calloc(1, sizeof *m.cameras);
    m.images = calloc(MAX_PICTURES, sizeof *m.images);
    m.points = calloc(POINTS, sizeof *m.points);
    m.cameras[0] = (struct sfm_camera){1, lens};
    for (int i = 0; i < s->captures * LENSES; i++) {
        struct sfm_image *im = &m.images[m.image_count];
        if (i + 1 == s->missing) continue;
        im->id = i + 1;
        im->cam_from_world = true_pose(s, &rng, i);
        im->observations = calloc(POINTS, sizeof *im->observations);
        im->name = malloc(32);
        snprintf(im->name, 32, "shot%d_c%dr%d.png", i / LENSES, i % COLUMNS + 1, i % LENSES / COLUMNS + 1);
        m.image_count++;
    }
    for (int i = 0; i < POINTS; i++) {
        struct sfm_point *p = &m.points[m.point_count++];
        const uint64_t n = 1000 + (uint64_t)i;
        const double z = 2 + 3 * rng_uniform(&rng, n, 2);
        p->position =
            vec3_make(z * (1.2 * rng_uniform(&rng, n, 0) - 0.6) + 0.3, z * (rng_uniform(&rng, n, 1) - 0.5), z);
        p->id = i + 1;
        p->track = calloc(MAX_PICTURES, sizeof *p->track);
        observe(&m, s, &rng, p);
    }
    return m;
}

/* Poses off by 2 mrad and 5 mm, points by 2 cm. */
static void perturb(struct sfm_model *m)
{
    const struct rng rng = rng_make(4, "rig", "perturb");
    for (int i = 1; i < m->image_count; i++) {
        struct pose *p = &m->images[i].cam_from_world;
        double d[6];
        for (int k = 0; k < 6; k++) d[k] = normal(&rng, (uint64_t)m->images[i].id, (uint64_t)k);
        p->rotation = turned(p->rotation, 0.002 * d[0], 0.002 * d[1], 0.002 * d[2]);
        p->translation = vec3_add(p->translation, vec3_make(0.005 * d[3], 0.005 * d[4], 0.005 * d[5]));
    }
    for (int i = 0; i < m->point_count; i++) {
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = 0.02 * normal(&rng, 1000 + (uint64_t)i, (uint64_t)k);
        m->points[i].position = vec3_add(m->points[i].position, vec3_make(d[0], d[1], d[2]));
    }
}

static void refine(struct scene *at, const struct setup *s, enum given_cameras given, struct split_size split)
{
    struct sfm_import_params params = SFM_IMPORT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    snprintf(params.refine, sizeof params.refine, "yes");
    at->truth = simulate(s);
    at->model = simulate(s);
    perturb(&at->model);
    assert_ok(refine_cameras(&at->r, &at->model, given, split, &params, &err), err);
    assert_true(at->r.chosen >= 0);
}

static void release(struct scene *at)
{
    sfm_model_release(&at->truth);
    sfm_model_release(&at->model);
    refine_cameras_release(&at->r);
}

static int picture_of(const struct sfm_model *m, int capture, int at)
{
    for (int i = 0; i < m->image_count; i++)
        if (m->images[i].id == capture * LENSES + at + 1) return i;
    return -1;
}

/* How much the pose of a lens relative to the second one differs from that in the first capture, of all captures and
 * lenses the most: radians, and metres. */
static void relative_poses_differ(double *angle, double *length, const struct sfm_model *m, int captures)
{
    *angle = *length = 0;
    for (int at = 0; at < LENSES; at++) {
        struct quat turn = {0};
        struct vec3 place = {0};
        bool first = true;
        for (int i = 0; i < captures; i++) {
            const int image = picture_of(m, i, at), second = picture_of(m, i, 1);
            if (image < 0 || second < 0) continue;
            const struct pose *p = &m->images[image].cam_from_world, *o = &m->images[second].cam_from_world;
            const struct quat q = quat_multiply(p->rotation, quat_conjugate(o->rotation));
            const struct vec3 c = pose_apply(o, pose_center(p));
            if (!first) *angle = fmax(*angle, quat_angle(q, turn));
            if (!first) *length = fmax(*length, vec3_length(vec3_sub(c, place)));
            if (first) turn = q;
            if (first) place = c;
            first = false;
        }
    }
}

/* The mean distance of the centres from the true ones after the best similarity, metres. */
static double center_error(const struct scene *at)
{
    struct pose found[MAX_PICTURES] = {0}, truth[MAX_PICTURES] = {0};
    struct similarity a;
    struct err err = ERR_INIT;
    const int n = at->model.image_count;
    double sum = 0;
    for (int i = 0; i < n; i++) {
        found[i] = at->model.images[i].cam_from_world;
        truth[i] = at->truth.images[i].cam_from_world;
    }
    assert_ok(camera_alignment_find(&a, found, truth, n, &err), err);
    for (int i = 0; i < n; i++) {
        const struct vec3 c = mat3_apply(a.rotation, vec3_scale(pose_center(&found[i]), a.scale));
        sum += vec3_length(vec3_sub(vec3_add(c, a.translation), pose_center(&truth[i]))) / n;
    }
    return sum;
}

static void assert_same_cameras(const struct scene *a, const struct scene *b)
{
    assert_int_equal(a->r.chosen, b->r.chosen);
    assert_int_equal(a->model.camera_count, b->model.camera_count);
    for (int i = 0; i < a->model.camera_count; i++)
        assert_memory_equal(&a->model.cameras[i], &b->model.cameras[i], sizeof a->model.cameras[i]);
    for (int i = 0; i < a->model.image_count; i++)
        assert_memory_equal(&a->model.images[i].cam_from_world, &b->model.images[i].cam_from_world,
                            sizeof(struct pose));
    for (int i = 0; i < a->model.point_count; i++)
        assert_memory_equal(&a->model.points[i].position, &b->model.points[i].position, sizeof(struct vec3));
}

/* --------------------------------------------------------------------------------------------------- the adjustment */

static const struct setup three = {.captures = 3};

/* The relative poses are the same in all three captures, and the centres nearer to the truth than without a rig. */
static void assert_rigid_and_better(const struct scene *rig, const struct scene *alone)
{
    double angle, length;
    relative_poses_differ(&angle, &length, &rig->model, 3);
    assert_true(angle < 1e-3 * noise_angle && length < 1e-5);
    assert_true(center_error(rig) < 0.8 * center_error(alone));
}

static void lenses_keep_their_relative_poses(void **state)
{
    (void)state;
    const enum given_cameras given[] = {GIVEN_NOTHING, GIVEN_LENS, GIVEN_MODEL};
    for (int i = 0; i < 3; i++) {
        struct scene alone, rig;
        double angle, length;
        refine(&alone, &three, given[i], no_grid);
        refine(&rig, &three, given[i], grid);
        assert_int_equal(alone.r.rig.lenses, 0);
        assert_int_equal(rig.r.rig.lenses, LENSES);
        assert_int_equal(rig.r.rig.captures, 3);
        assert_true(rig.r.rig.angle > 0.1 * noise_angle && rig.r.rig.angle < noise_angle);
        relative_poses_differ(&angle, &length, &alone.model, 3);
        assert_true(angle > noise_angle && length > 1e-3);
        assert_rigid_and_better(&rig, &alone);
        release(&alone);
        release(&rig);
    }
}

/* Cameras that fit the pictures best each on its own fit them a little worse as a rig, and better the truth. */
static void cameras_that_were_adjusted_before_become_a_rig(void **state)
{
    (void)state;
    struct scene at;
    const struct sfm_import_params params = SFM_IMPORT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    refine(&at, &three, GIVEN_NOTHING, no_grid);
    const double error = center_error(&at);
    refine_cameras_release(&at.r);
    assert_ok(refine_cameras(&at.r, &at.model, GIVEN_NOTHING, grid, &params, &err), err);
    assert_true(at.r.chosen >= 0);
    assert_int_equal(at.r.rig.lenses, LENSES);
    assert_true(at.r.after.noise > at.r.before.noise);
    assert_true(center_error(&at) < 0.8 * error);
    release(&at);
}

static void a_missing_lens_may_be_the_reference_or_another(void **state)
{
    (void)state;
    const int missing[] = {LENSES + 1, LENSES + 5};
    for (int i = 0; i < 2; i++) {
        struct scene alone, rig;
        const struct setup s = {.captures = 3, .missing = missing[i]};
        refine(&alone, &s, GIVEN_NOTHING, no_grid);
        refine(&rig, &s, GIVEN_NOTHING, grid);
        assert_int_equal(rig.r.rig.lenses, LENSES);
        assert_rigid_and_better(&rig, &alone);
        release(&alone);
        release(&rig);
    }
}

static void lenses_that_moved_are_adjusted_on_their_own(void **state)
{
    (void)state;
    struct scene alone, rig;
    const struct setup s = {.captures = 3, .bend = DEGREE};
    refine(&alone, &s, GIVEN_NOTHING, no_grid);
    refine(&rig, &s, GIVEN_NOTHING, grid);
    assert_int_equal(rig.r.rig.lenses, 0);
    assert_same_cameras(&alone, &rig);
    release(&alone);
    release(&rig);
}

static int refine_bent(void *ctx)
{
    struct scene rig;
    (void)ctx;
    parallel_set_threads(1); /* threads of the parent are not in the child */
    refine(&rig, &(struct setup){.captures = 2, .bend = DEGREE}, GIVEN_NOTHING, grid);
    release(&rig);
    return 0;
}

static void the_warning_states_both_noises_and_what_to_check(void **state)
{
    (void)state;
    char *output = NULL;
    assert_int_equal(child_run(refine_bent, NULL, &output), 0);
    assert_non_null(strstr(output, "warning: the 6 lenses of the multi-lens camera"));
    assert_non_null(strstr(output, "px with one rig"));
    assert_non_null(strstr(output, "check SPLIT"));
    assert_null(strstr(output, "have the same poses"));
    free(output);
}

static void one_capture_is_no_rig(void **state)
{
    (void)state;
    struct scene alone, rig;
    const struct setup s = {.captures = 1};
    refine(&alone, &s, GIVEN_NOTHING, no_grid);
    refine(&rig, &s, GIVEN_NOTHING, grid);
    assert_int_equal(rig.r.rig.lenses, 0);
    assert_same_cameras(&alone, &rig);
    release(&alone);
    release(&rig);
}

static void a_picture_with_few_observations_keeps_its_pose(void **state)
{
    (void)state;
    struct scene rig;
    double angle, length;
    const struct setup s = {.captures = 3, .sparse = LENSES + 3};
    refine(&rig, &s, GIVEN_NOTHING, grid);
    struct sfm_model start = simulate(&s);
    perturb(&start);
    const int held = picture_of(&start, 1, 2);
    assert_memory_equal(&rig.model.images[held].cam_from_world, &start.images[held].cam_from_world,
                        sizeof(struct pose));
    rig.model.images[held].id = -1; /* the others agree */
    relative_poses_differ(&angle, &length, &rig.model, 3);
    assert_true(angle < 1e-3 * noise_angle && length < 1e-5);
    sfm_model_release(&start);
    release(&rig);
}

/* Given pictures at one place share their centre, and a rig has it too. */
static void given_lenses_at_one_place_stay_there(void **state)
{
    (void)state;
    struct scene rig;
    struct err err = ERR_INIT;
    double angle, length;
    const struct setup s = {.captures = 3, .one_place = true};
    struct sfm_import_params params = SFM_IMPORT_PARAMS_DEFAULT;
    snprintf(params.refine, sizeof params.refine, "yes");
    rig = (struct scene){.truth = simulate(&s), .model = simulate(&s)};
    rig.model.cameras[0].camera.params[0] *= 1.02;
    assert_ok(refine_cameras(&rig.r, &rig.model, GIVEN_MODEL, grid, &params, &err), err);
    assert_int_equal(rig.r.rig.lenses, LENSES);
    relative_poses_differ(&angle, &length, &rig.model, 3);
    assert_true(angle < 1e-3 * noise_angle && length < 1e-12);
    release(&rig);
}

static void the_same_bits_come_from_any_number_of_threads(void **state)
{
    (void)state;
    struct scene one, three_threads;
    parallel_set_threads(1);
    refine(&one, &three, GIVEN_NOTHING, grid);
    parallel_set_threads(3);
    refine(&three_threads, &three, GIVEN_NOTHING, grid);
    parallel_set_threads(0);
    assert_int_equal(one.r.rig.lenses, LENSES);
    assert_same_cameras(&one, &three_threads);
    release(&one);
    release(&three_threads);
}

/* ---------------------------------------------------------------------------------------------- captures and lenses */

/* Finds the rig among images of these names, which end with NULL; a name that begins with ! is of a held image. */
static void find(struct rig *rig, const char *const *names)
{
    struct sfm_image images[16] = {0};
    struct bundle_image in_bundle[16] = {0};
    struct bundle_station station = {0};
    struct sfm_model m = {.images = images};
    const struct bundle b = {.images = in_bundle, .stations = &station};
    struct err err = ERR_INIT;
    for (; names[m.image_count]; m.image_count++) {
        in_bundle[m.image_count].fixed = *names[m.image_count] == '!';
        images[m.image_count].name = (char *)names[m.image_count] + in_bundle[m.image_count].fixed;
    }
    assert_ok(rig_find(rig, &m, &b, grid, &err), err);
}

static void assert_rig(const char *const *names, int captures, int lenses, const int (*wanted)[2])
{
    struct rig rig;
    find(&rig, names);
    assert_int_equal(rig.capture_count, captures);
    assert_int_equal(rig.lens_count, lenses);
    for (int i = 0; names[i] && lenses; i++) {
        assert_int_equal(rig.capture[i], wanted[i][0]);
        assert_int_equal(rig.lens[i], wanted[i][1]);
    }
    rig_release(&rig);
}

static void names_give_captures_and_lenses(void **state)
{
    (void)state;
    /* the most frequent lens is the reference; a lens outside the grid and other names stay alone */
    assert_rig((const char *[]){"a_c1r1.png", "a_c2r1.png", "a_c4r1.png", "b.png", "b_c1r1.png", "b_c2r1.png",
                                "c_c2r1.jpg", "c_c3r2.jpg", NULL},
               3, 3, (const int[][2]){{0, 1}, {0, 0}, {-1, -1}, {-1, -1}, {1, 1}, {1, 0}, {2, 0}, {2, 2}});
    /* photos of two folders are two captures, and ids may end like a picture's */
    assert_rig((const char *[]){"x/a_c1r1.png", "x/a_c2r1.png", "y/a_c1_c1r1", "y/a_c1_c2r1", "y/a_c1r1", "y/a_c2_c1r1",
                                "y/a_c2r1", NULL},
               4, 2, (const int[][2]){{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {3, 0}, {2, 1}});
    /* a picture whose name occurs twice, and a held one, stay alone */
    assert_rig((const char *[]){"a_c1r1.jpg", "a_c1r1.png", "a_c2r1.png", "!a_c3r1.png", "b_c1r1.png", "b_c2r1.png",
                                "b_c3r1.png", NULL},
               2, 3, (const int[][2]){{0, 0}, {-1, -1}, {0, 1}, {-1, -1}, {1, 0}, {1, 1}, {1, 2}});
}

static void images_that_share_no_lens_with_the_reference_stay_alone(void **state)
{
    (void)state;
    assert_rig((const char *[]){"a_c1r1.png", "a_c2r1.png", "b_c1r1.png", "b_c2r1.png", "c_c1r1.png", "c_c3r1.png",
                                "d_c2r2.png", "d_c3r2.png", "e_c2r2.png", "e_c3r1.png", NULL},
               4, 3,
               (const int[][2]){{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 2}, {-1, -1}, {-1, -1}, {-1, -1}, {3, 2}});
}

static void two_captures_must_share_two_lenses(void **state)
{
    (void)state;
    assert_rig((const char *[]){"a_c1r1.png", "a_c2r1.png", "a_c3r1.png", NULL}, 0, 0, NULL);
    assert_rig((const char *[]){"a_c1r1.png", "a_c2r1.png", "b_c1r1.png", "b_c3r1.png", "c_c3r1.png", NULL}, 0, 0,
               NULL);
    assert_rig((const char *[]){NULL}, 0, 0, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_give_captures_and_lenses),
        cmocka_unit_test(images_that_share_no_lens_with_the_reference_stay_alone),
        cmocka_unit_test(two_captures_must_share_two_lenses),
        cmocka_unit_test(lenses_keep_their_relative_poses),
        cmocka_unit_test(cameras_that_were_adjusted_before_become_a_rig),
        cmocka_unit_test(a_missing_lens_may_be_the_reference_or_another),
        cmocka_unit_test(lenses_that_moved_are_adjusted_on_their_own),
        cmocka_unit_test(the_warning_states_both_noises_and_what_to_check),
        cmocka_unit_test(one_capture_is_no_rig),
        cmocka_unit_test(a_picture_with_few_observations_keeps_its_pose),
        cmocka_unit_test(given_lenses_at_one_place_stay_there),
        cmocka_unit_test(the_same_bits_come_from_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
