/* outdoors_rotation.c - rays to points outdoors give the rotation of a camera in a window, within the stated error. */
#include "stages/hdr_merge/outdoors_rotation.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "common/math/rotation_fit.h"
#include "tests/unit/scratch.h"

enum { MOST = 4000 };

static struct outdoors_sight sights[MOST];
static int sight_count;

static const struct outdoors_rules rules = {.nearest = 1, .place_error = 0, .min_sights = 12, .max_error = 1};

/* How the photos see what is outdoors. */
struct setting {
    int points, photos;
    double least, most; /* distances of the points */
    double noise;       /* of each ray, degrees along each axis */
    double wrong;       /* share of the sights that are not of the point */
    struct vec3 place;  /* error of the camera's place */
};

static double uniform(const struct rng *random, int *drawn, double least, double most)
{
    return least + (most - least) * rng_uniform(random, 0, (uint64_t)(*drawn)++);
}

static double normal(const struct rng *random, int *drawn)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) sum += uniform(random, drawn, 0, 1);
    return sum;
}

/* A direction within 50 degrees of +y in azimuth and from 25 degrees below to 25 degrees above the horizon. */
static struct vec3 outwards(const struct rng *random, int *drawn)
{
    const double a = uniform(random, drawn, -50, 50) * DEGREE, e = uniform(random, drawn, -25, 25) * DEGREE;
    return vec3_make(cos(e) * sin(a), cos(e) * cos(a), sin(e));
}

static struct vec3 disturbed(struct vec3 ray, double noise, const struct rng *random, int *drawn)
{
    const struct vec3 off = {normal(random, drawn), normal(random, drawn), normal(random, drawn)};
    return vec3_normalize(vec3_add(ray, vec3_scale(off, noise * DEGREE)));
}

/* The camera's true rotation: it looks along +y, pitched and rolled by a few degrees. */
static struct mat3 truth(void)
{
    const struct mat3 level = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    return rotation_turn(level, vec3_make(0.03, -0.05, 0.04));
}

static void see(const struct setting *s, uint64_t seed)
{
    const struct rng random = rng_make(seed, "test", "sights");
    struct vec3 photos[64];
    int drawn = 0;
    for (int k = 0; k < s->photos; k++)
        photos[k] = vec3_make(uniform(&random, &drawn, -2, 2), uniform(&random, &drawn, -4, -0.5),
                              uniform(&random, &drawn, -0.4, 0.4));
    sight_count = 0;
    for (int i = 0; i < s->points; i++) {
        /* half of the points are on photos in pairs */
        const int seen = s->photos > 1 && i % 2 ? 2 : 1;
        const double q = uniform(&random, &drawn, 1 / s->most, 1 / s->least);
        const struct vec3 at = vec3_scale(outwards(&random, &drawn), 1 / q);
        const struct vec3 ray =
            disturbed(mat3_apply(truth(), vec3_normalize(vec3_sub(at, s->place))), s->noise, &random, &drawn);
        const int first = (int)uniform(&random, &drawn, 0, s->photos);
        for (int k = 0; k < seen && sight_count < MOST; k++) {
            const int photo = (first + k) % s->photos;
            const bool wrong = uniform(&random, &drawn, 0, 1) < s->wrong;
            const struct vec3 to = wrong ? outwards(&random, &drawn) : vec3_normalize(vec3_sub(at, photos[photo]));
            sights[sight_count++] =
                (struct outdoors_sight){i, photo, ray, photos[photo], disturbed(to, s->noise, &random, &drawn)};
        }
    }
}

static double degrees_off(struct mat3 a) { return quat_angle(quat_from_mat3(a), quat_from_mat3(truth())) / DEGREE; }

/* From a rotation that is off by `start` degrees about an axis. */
static struct outdoors_rotation find(double start, const struct outdoors_rules *with)
{
    const struct vec3 axis = vec3_normalize(vec3_make(0.4, -0.5, 0.8));
    const struct mat3 given = rotation_turn(truth(), vec3_scale(axis, start * DEGREE));
    struct outdoors_rotation r;
    struct err err = ERR_INIT;
    assert_ok(outdoors_rotation_find(&r, given, sights, sight_count, with, "sky", &err), err);
    return r;
}

static void exact_rays_give_the_exact_rotation(void **state)
{
    const struct setting s = {.points = 60, .photos = 4, .least = 5, .most = 60};
    (void)state;
    see(&s, 1);
    const struct outdoors_rotation r = find(6, &rules);
    assert_int_equal(r.verdict, OUTDOORS_TURNED);
    assert_int_equal(r.agree, sight_count);
    assert_true(degrees_off(r.cam_from_model) < 1e-4);
    assert_true(fabs(r.turned - 6) < 1e-3);
}

/* Of forty made-up windows, the errors are as large as stated: their mean square, in units of the stated one, is near
 * 1, and nearly all are below 2.5. */
static void assert_stated(const struct setting *s, double start, double max_degrees)
{
    enum { TRIES = 40 };
    double squares = 0;
    int above = 0;
    for (int k = 0; k < TRIES; k++) {
        see(s, (uint64_t)k);
        const struct outdoors_rotation r = find(start, &rules);
        const double off = degrees_off(r.cam_from_model);
        assert_int_equal(r.verdict, OUTDOORS_TURNED);
        assert_true(off < max_degrees);
        squares += off * off / (r.error * r.error) / TRIES;
        above += off > 2.5 * r.error;
    }
    print_message("# off %.3g of the stated error\n", sqrt(squares));
    assert_true(squares > 0.3 && squares < 1.7);
    assert_true(above <= 1);
}

static void noise_and_wrong_matches_leave_the_stated_error(void **state)
{
    const struct setting s = {.points = 150, .photos = 6, .least = 8, .most = 80, .noise = 0.1, .wrong = 0.4};
    (void)state;
    assert_stated(&s, 8, 0.15);
}

static void far_points_leave_the_stated_error(void **state)
{
    const struct setting s = {.points = 100, .photos = 3, .least = 300, .most = 3000, .noise = 0.1, .wrong = 0.2};
    (void)state;
    assert_stated(&s, 8, 0.3);
}

/* Neglected, the distance of points 6 to 15 m away would turn the camera by degrees. */
static void near_points_do_not_turn_the_camera(void **state)
{
    const struct setting s = {.points = 200, .photos = 8, .least = 6, .most = 15, .noise = 0.05, .wrong = 0.3};
    (void)state;
    assert_stated(&s, 12, 0.15);
}

static void an_error_of_the_place_is_stated(void **state)
{
    const struct setting s = {
        .points = 200, .photos = 8, .least = 6, .most = 15, .noise = 0.02, .place = {0.08, -0.05, 0.04}};
    const struct outdoors_rules unsure = {.nearest = 1, .place_error = 0.06, .min_sights = 12, .max_error = 3};
    (void)state;
    see(&s, 3);
    const struct outdoors_rotation sure = find(5, &rules), r = find(5, &unsure);
    assert_int_equal(r.verdict, OUTDOORS_TURNED);
    const double off = degrees_off(r.cam_from_model);
    print_message("# off %.3g, stated %.3g, without the place %.3g\n", off, r.error, sure.error);
    assert_true(off < 2 * r.error && off > sure.error && r.error > 1.5 * sure.error);
}

static void matches_by_chance_are_refused(void **state)
{
    const struct setting s = {.points = 300, .photos = 6, .least = 8, .most = 80, .noise = 0.1, .wrong = 1};
    (void)state;
    for (uint64_t k = 0; k < 5; k++) {
        see(&s, k);
        const struct outdoors_rotation r = find(3, &rules);
        assert_int_equal(r.verdict, OUTDOORS_FEW);
        assert_int_equal(r.sights, sight_count);
        print_message("# %d of %d agree, wanted %d\n", r.agree, r.sights, r.wanted);
        assert_true(r.wanted > 12 && r.wanted < 0.15 * sight_count);
        assert_true(r.agree < r.wanted);
        assert_true(fabs(degrees_off(r.cam_from_model) - 3) < 1e-6);
    }
}

static void few_matches_are_refused(void **state)
{
    const struct setting s = {.points = 7, .photos = 3, .least = 8, .most = 80, .noise = 0.1}, none = {.photos = 1};
    (void)state;
    see(&s, 1);
    struct outdoors_rotation r = find(3, &rules);
    assert_int_equal(r.verdict, OUTDOORS_FEW);
    assert_int_equal(r.sights, sight_count);
    assert_int_equal(r.wanted, 12);
    assert_true(fabs(degrees_off(r.cam_from_model) - 3) < 1e-6);
    see(&none, 1);
    r = find(3, &rules);
    assert_int_equal(r.verdict, OUTDOORS_FEW);
    assert_int_equal(r.sights, 0);
}

/* One photo straight to the side: nothing tells distance from azimuth. */
static void what_the_matches_do_not_decide_is_refused(void **state)
{
    const struct setting s = {.points = 60, .photos = 1, .least = 8, .most = 9, .noise = 0.1};
    (void)state;
    see(&s, 2);
    for (int i = 0; i < sight_count; i++) {
        const struct vec3 at = vec3_scale(mat3_apply(mat3_transpose(truth()), sights[i].ray), 8);
        sights[i].from = vec3_make(-2, 0, 0);
        sights[i].direction = vec3_normalize(vec3_sub(at, sights[i].from));
    }
    const struct outdoors_rules strict = {.nearest = 1, .place_error = 0, .min_sights = 12, .max_error = 0.001};
    const struct outdoors_rotation r = find(0, &strict);
    assert_int_equal(r.verdict, OUTDOORS_UNCERTAIN);
    assert_true(r.error > 0.001);
}

/* Turned by more than a user may be off. */
static void far_turns_are_refused(void **state)
{
    const struct setting s = {.points = 100, .photos = 4, .least = 8, .most = 80, .noise = 0.1};
    (void)state;
    see(&s, 4);
    const struct outdoors_rotation r = find(45, &rules);
    assert_int_not_equal(r.verdict, OUTDOORS_TURNED);
    assert_true(fabs(degrees_off(r.cam_from_model) - 45) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_rays_give_the_exact_rotation),
        cmocka_unit_test(noise_and_wrong_matches_leave_the_stated_error),
        cmocka_unit_test(far_points_leave_the_stated_error),
        cmocka_unit_test(near_points_do_not_turn_the_camera),
        cmocka_unit_test(an_error_of_the_place_is_stated),
        cmocka_unit_test(matches_by_chance_are_refused),
        cmocka_unit_test(few_matches_are_refused),
        cmocka_unit_test(what_the_matches_do_not_decide_is_refused),
        cmocka_unit_test(far_turns_are_refused),
    };
    return cmocka_run_group_tests_name("outdoors_rotation", tests, scratch_make, scratch_remove);
}
