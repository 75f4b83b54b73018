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
    assert_ok(similar_by_features(similar, lists, PHOTOS, 4, &err), err);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photos_of_one_place_are_similar),
        cmocka_unit_test(neighbours_by_name_are_near_or_powers_of_two_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
