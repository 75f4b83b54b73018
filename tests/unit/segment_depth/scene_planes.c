/* scene_planes.c - dominant planes from votes, and the blank part of a wall that no view can match. */
#include "stages/segment_depth/scene_planes.h"
#include "tests/unit/scratch.h"
#include "tests/unit/segment_depth/whole.h"

#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/math/numbers.h"

enum { VOTES = 900 };

static const double step = 0.003;

/* Votes on a grid of 300 x 300 px: on two planes, left and right of u = 180, and every tenth anywhere. */
static const struct plane left_wall = {0.0004, -0.0001, 0.2}, right_wall = {-0.0009, 0.0002, 0.5};

static void make_votes(struct plane_vote *votes, double noise)
{
    const struct rng rng = rng_make(5, "test", "votes");
    for (int i = 0; i < VOTES; i++) {
        const double u = i % 30 * 10 + 5, v = i / 30 * 10.0 + 5;
        struct plane p = u < 180 ? left_wall : right_wall;
        const uint64_t k = (uint64_t)i;
        p.a += noise * 1e-5 * (2 * rng_uniform(&rng, k, 0) - 1);
        p.b += noise * 1e-5 * (2 * rng_uniform(&rng, k, 1) - 1);
        if (i % 10 == 3) p = (struct plane){0.003 * rng_uniform(&rng, k, 2), 0, 0.2 + 0.3 * rng_uniform(&rng, k, 3)};
        p.c += plane_at(u < 180 ? left_wall : right_wall, u, v) - plane_at(p, u, v) +
               (i % 10 == 3 ? 0.1 : noise * 0.2 * step * (2 * rng_uniform(&rng, k, 4) - 1));
        votes[i] = (struct plane_vote){p, u, v, 100};
    }
}

static void the_planes_of_most_votes_are_found_in_order(void **state)
{
    (void)state;
    static struct plane_vote votes[VOTES];
    for (int noisy = 0; noisy < 2; noisy++) {
        struct scene_planes s = {0};
        struct err err = ERR_INIT;
        make_votes(votes, noisy);
        assert_ok(scene_planes_find(&s, votes, VOTES, step, 0.05 * VOTES * 100, &err), err);
        assert_int_equal(s.count, 2);
        for (int k = 0; k < 2; k++) {
            const struct plane truth = k ? right_wall : left_wall;
            for (int c = 0; c < 4; c++) {
                const double u = c & 1 ? 290 : 10, v = c & 2 ? 290 : 10;
                assert_near(plane_at(s.planes[k], u, v), plane_at(truth, u, v), noisy ? 0.5 * step : 1e-9);
            }
            assert_true(scene_planes_have(&s, s.planes[k]));
        }
        struct plane other = s.planes[0];
        other.c = nextafter(other.c, 1);
        assert_true(!scene_planes_have(&s, other));
        assert_true(!scene_planes_have(NULL, other));
    }
}

/* Votes scatter by the noise of pictures, not by the steps of a sweep. */
static void fine_steps_find_the_same_planes(void **state)
{
    (void)state;
    static struct plane_vote votes[VOTES];
    struct scene_planes s = {0};
    struct err err = ERR_INIT;
    make_votes(votes, 1);
    assert_ok(scene_planes_find(&s, votes, VOTES, 0.05 * step, 0.05 * VOTES * 100, &err), err);
    assert_int_equal(s.count, 2);
}

static void the_order_of_votes_does_not_matter(void **state)
{
    (void)state;
    static struct plane_vote votes[VOTES], turned[VOTES];
    struct scene_planes a = {0}, b = {0};
    struct err err = ERR_INIT;
    make_votes(votes, 1);
    for (int i = 0; i < VOTES; i++) turned[i] = votes[VOTES - 1 - i];
    assert_ok(scene_planes_find(&a, votes, VOTES, step, 1000, &err), err);
    assert_ok(scene_planes_find(&b, turned, VOTES, step, 1000, &err), err);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.planes, b.planes, (size_t)a.count * sizeof *a.planes);
}

static void constant_depths_and_small_parts_are_no_planes_of_a_scene(void **state)
{
    (void)state;
    static struct plane_vote votes[VOTES];
    struct scene_planes s = {0};
    struct err err = ERR_INIT;
    make_votes(votes, 0);
    assert_ok(scene_planes_find(&s, votes, VOTES, step, VOTES * 100.0, &err), err);
    assert_int_equal(s.count, 0);
    for (int i = 0; i < VOTES; i++) votes[i].plane = (struct plane){0, 0, 0.3};
    assert_ok(scene_planes_find(&s, votes, VOTES, step, 100, &err), err);
    assert_int_equal(s.count, 0);
    assert_ok(scene_planes_find(&s, votes, 0, step, 0.1, &err), err);
    assert_int_equal(s.count, 0);
}

/* A ceiling whose near half is blank, and outside of the other views' frames and of the range of the points' depths. */
static void a_blank_ceiling_continues_the_part_that_is_matched(void **state)
{
    (void)state;
    struct result r = {0};
    struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    params.near = 5;
    params.far = 12;
    start();
    struct painted_surface *wall = scene_wall(&scene, 0, 0, 8, 20, 20, 0);
    wall->cell = 0.6;
    struct painted_surface *far = scene_surface(&scene, vec3_make(0, -1.2, 6.3)),
                           *near = scene_surface(&scene, vec3_make(0, -1.2, 2.6));
    far->across = near->across = vec3_make(15, 0, 0);
    far->down = vec3_make(0, 0, 1.7);
    near->down = vec3_make(0, 0, 2);
    far->cell = 0.25;
    near->contrast = 0;
    for (int c = 0; c < 3; c++) near->colour[c] = far->colour[c];
    place_cameras(4);
    assert_ok(depth_of(&r, &params, &err), err);
    check_invariants(&r.depth);
    int right = 0, count = 0;
    for (int i = 0; i < W * H; i++) {
        int at;
        const double z = scene_depth(&scene, &scene.views[0], i % W + 0.5, i / W + 0.5, &at);
        if (at != 2 || at_jump(i % W, i / W)) continue;
        count++;
        right += fabs((double)r.depth.interior.z[i] / z - 1) <= 0.03;
    }
    if (getenv("VERDICT")) print_message("  %d of %d px of the blank ceiling are right\n", right, count);
    assert_true(count > W * H / 20);
    assert_true(right > 0.9 * count);
    layered_depth_release(&r.depth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_planes_of_most_votes_are_found_in_order),
        cmocka_unit_test(fine_steps_find_the_same_planes),
        cmocka_unit_test(the_order_of_votes_does_not_matter),
        cmocka_unit_test(constant_depths_and_small_parts_are_no_planes_of_a_scene),
        cmocka_unit_test(a_blank_ceiling_continues_the_part_that_is_matched),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
