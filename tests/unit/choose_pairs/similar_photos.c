/* similar_photos.c - which photos of a large set look alike. */
#include "tests/unit/scratch.h"

#include <stdlib.h>

#include "common/base/rng.h"
#include "stages/choose_pairs/similar_photos.h"

enum { PHOTOS = 12, FEATURES = 60, PLACES = 3 };

static uint8_t made_value(uint64_t kind, uint64_t feature, int k)
{
    const struct rng rng = rng_make(kind, "similar_photos", "");
    return (uint8_t)(rng_u32(&rng, feature, (uint64_t)k) % 2 * 63);
}

/* Photos of a place share half of their features, all others are their own. */
static void photos_of_one_place_are_similar(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct feature_list lists[PHOTOS] = {0};
    int shared[PHOTOS * PHOTOS] = {0};
    bool similar[PHOTOS * PHOTOS] = {0};
    for (int i = 0; i < PHOTOS; i++) {
        lists[i].features = calloc(FEATURES, sizeof *lists[i].features);
        assert_non_null(lists[i].features);
        lists[i].count = FEATURES;
        for (int f = 0; f < FEATURES; f++)
            for (int k = 0; k < DESCRIPTOR_SIZE; k++)
                lists[i].features[(f + 7 * i) % FEATURES].descriptor[k] =
                    made_value(f < FEATURES / 2 ? (uint64_t)(i % PLACES) : (uint64_t)(100 + i), (uint64_t)f, k);
    }
    assert_ok(similar_count_matches(shared, lists, PHOTOS, &err), err);
    assert_ok(similar_choose(similar, shared, PHOTOS, 4, PHOTOS, &err), err);
    for (int i = 0; i < PHOTOS; i++)
        for (int j = i + 1; j < PHOTOS; j++) assert_int_equal(similar[i * PHOTOS + j], (j - i) % PLACES == 0);
    for (int i = 0; i < PHOTOS; i++) feature_list_release(&lists[i]);
}

static void neighbours_by_name_are_near_or_powers_of_two_apart(void **state)
{
    (void)state;
    assert_true(similar_by_name(0, 1));
    assert_true(similar_by_name(5, 15));
    assert_false(similar_by_name(0, 11));
    assert_true(similar_by_name(3, 67));
    assert_false(similar_by_name(0, 1024));
}

/* Photo 0 is like all others; of these, each is like one more. */
static void of_many_similar_photos_the_most_similar_count(void **state)
{
    (void)state;
    enum { N = 5 };
    static const int shared[N * N] = {
        0, 9, 8, 8, 7, //
        9, 0, 3, 0, 0, //
        8, 3, 0, 0, 0, //
        8, 0, 0, 0, 9, //
        7, 0, 0, 9, 0, //
    };
    bool similar[N * N] = {0};
    struct err err = ERR_INIT;
    assert_ok(similar_choose(similar, shared, N, 4, 1, &err), err);
    static const bool wanted[N * N] = {[0 * N + 1] = true, [0 * N + 2] = true, [3 * N + 4] = true};
    for (int i = 0; i < N * N; i++) assert_int_equal(similar[i], wanted[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photos_of_one_place_are_similar),
        cmocka_unit_test(of_many_similar_photos_the_most_similar_count),
        cmocka_unit_test(neighbours_by_name_are_near_or_powers_of_two_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
