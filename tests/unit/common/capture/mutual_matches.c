/* mutual_matches.c - nearest descriptors, against a plain search, and the matches made of them. */
#include "tests/unit/scratch.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/rng.h"
#include "common/capture/mutual_matches.h"

/* Random descriptors of few values, so that products are often equal. */
static struct feature_list random_list(int count, uint64_t seed, unsigned values)
{
    struct feature_list list = {calloc((size_t)count + 1, sizeof(struct feature)), count, ""};
    const struct rng rng = rng_make(seed, "mutual_matches", "");
    assert_non_null(list.features);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < DESCRIPTOR_SIZE; k++)
            list.features[i].descriptor[k] =
                (uint8_t)(rng_u32(&rng, (uint64_t)i, (uint64_t)k) % values * (255 / (values - 1)));
    return list;
}

static struct nearest plain_nearest(const struct feature *of, const struct feature_list *among)
{
    struct nearest n = {-1, -1, -1};
    for (int j = 0; j < among->count; j++) {
        int32_t product = 0;
        for (int k = 0; k < DESCRIPTOR_SIZE; k++) product += of->descriptor[k] * among->features[j].descriptor[k];
        if (product > n.best) {
            n.second = n.best;
            n.best = product;
            n.at = j;
        } else if (product > n.second)
            n.second = product;
    }
    return n;
}

static void check_all(const struct nearest *found, const struct feature_list *of, const struct feature_list *among)
{
    for (int i = 0; i < of->count; i++) {
        const struct nearest n = plain_nearest(&of->features[i], among);
        assert_int_equal(found[i].at, n.at);
        assert_int_equal(found[i].best, n.best);
        assert_int_equal(found[i].second, n.second);
    }
}

static void nearest_descriptors_are_those_of_a_plain_search(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 2}, {3, 1}, {0, 4}, {4, 0}, {5, 16}, {17, 33}, {70, 1100}, {601, 7}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (unsigned values = 2; values <= 256; values += 127) {
            struct err err = ERR_INIT;
            struct feature_list a = random_list(sizes[s][0], s, values), b = random_list(sizes[s][1], s + 99, values);
            struct nearest_descriptors of_a, of_b;
            struct nearest *ab = malloc(((size_t)a.count + 1) * sizeof *ab),
                           *ba = malloc(((size_t)b.count + 1) * sizeof *ba);
            assert_ok(nearest_descriptors_init(&of_a, &a, &err), err);
            assert_ok(nearest_descriptors_init(&of_b, &b, &err), err);
            assert_ok(nearest_descriptors_find(ab, ba, &of_a, &of_b, &err), err);
            check_all(ab, &a, &b);
            check_all(ba, &b, &a);
            free(ab);
            free(ba);
            nearest_descriptors_release(&of_a);
            nearest_descriptors_release(&of_b);
            feature_list_release(&a);
            feature_list_release(&b);
        }
}

/* A descriptor with its length in two values, at `angle` (radians) from the first axis. */
static struct feature at_angle(int axis, double angle)
{
    struct feature f = {0};
    f.descriptor[axis] = (uint8_t)lround(255 * cos(angle));
    f.descriptor[axis + 1] = (uint8_t)lround(255 * sin(angle));
    /* the rest of the length is the same for all */
    for (int k = 100; k < 103; k++) f.descriptor[k] = 255;
    return f;
}

static int count_matches(struct feature *a, int a_count, struct feature *b, int b_count, struct matched_pair *pair)
{
    struct err err = ERR_INIT;
    const struct feature_list la = {a, a_count, ""}, lb = {b, b_count, ""};
    const struct match_limits limits = MATCH_LIMITS;
    struct nearest_descriptors of_a, of_b;
    *pair = (struct matched_pair){0};
    assert_ok(nearest_descriptors_init(&of_a, &la, &err), err);
    assert_ok(nearest_descriptors_init(&of_b, &lb, &err), err);
    assert_ok(mutual_matches_find(pair, &of_a, &of_b, &limits, &err), err);
    nearest_descriptors_release(&of_a);
    nearest_descriptors_release(&of_b);
    return pair->count;
}

static void a_match_is_mutual_and_clear(void **state)
{
    (void)state;
    struct matched_pair pair;
    struct feature a[] = {at_angle(0, 0.1), at_angle(10, 0.2), at_angle(20, 0.3)};
    struct feature b[] = {at_angle(20, 0.35), at_angle(0, 0.15), at_angle(10, 0.25), at_angle(10, 0.9)};
    assert_int_equal(count_matches(a, 3, b, 4, &pair), 3);
    assert_int_equal(pair.matches[0].second, 1);
    assert_int_equal(pair.matches[1].second, 2);
    assert_int_equal(pair.matches[2].second, 0);
    free(pair.matches);

    /* two of b that are as near as each other: neither is clear */
    struct feature twins[] = {at_angle(0, 0.15), at_angle(0, 0.15)};
    assert_int_equal(count_matches(a, 1, twins, 2, &pair), 0);
    free(pair.matches);
    /* the same seen from b: both of a are nearest to it */
    assert_int_equal(count_matches(twins, 2, a, 1, &pair), 0);
    free(pair.matches);
    /* a single feature has no second, and matches only what is near enough */
    struct feature far[] = {at_angle(40, 0.5)};
    far[0].descriptor[100] = 0;
    far[0].descriptor[101] = 0;
    assert_int_equal(count_matches(a, 1, b + 1, 1, &pair), 1);
    free(pair.matches);
    assert_int_equal(count_matches(a, 1, far, 1, &pair), 0);
    free(pair.matches);
}

static void blank_photos_have_no_matches(void **state)
{
    (void)state;
    struct matched_pair pair;
    struct feature a[] = {at_angle(0, 0.1)};
    assert_int_equal(count_matches(a, 0, a, 1, &pair), 0);
    free(pair.matches);
    assert_int_equal(count_matches(a, 1, a, 0, &pair), 0);
    free(pair.matches);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearest_descriptors_are_those_of_a_plain_search),
        cmocka_unit_test(a_match_is_mutual_and_clear),
        cmocka_unit_test(blank_photos_have_no_matches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
