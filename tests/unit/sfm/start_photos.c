/* start_photos.c - which photos the mapper is started from again. */
#include "tests/unit/scratch.h"

#include "stages/sfm/start_photos.h"

enum { MOST = 4 };

/* Photos 1 to 3 see each other, and so do 4 to 6; the last pair connects them. */
static const struct verified_pair two_rooms[] = {
    {{1, 2}, 300}, {{1, 3}, 200}, {{2, 3}, 100}, {{4, 5}, 50}, {{5, 6}, 60}, {{3, 4}, 20},
};

static void photos_that_are_not_placed_come_first(void **state)
{
    (void)state;
    const int placed[] = {1, 2, 3};
    int ids[MOST], chosen = 0, linked = 0;
    struct err err = ERR_INIT;
    assert_int_equal(start_photos_choose(ids, &chosen, MOST, &linked, two_rooms, 6, placed, 3, &err), ST_OK);
    assert_int_equal(linked, 6);
    assert_int_equal(chosen, 4);
    /* 5 has the most matches of those not placed, and 4 and 6 are beside it; 1 has the most of the others; then 4 has
     * more than 6 */
    assert_int_equal(ids[0], 5);
    assert_int_equal(ids[1], 1);
    assert_int_equal(ids[2], 4);
    assert_int_equal(ids[3], 6);
}

static void a_room_that_is_no_larger_is_not_tried(void **state)
{
    (void)state;
    const int placed[] = {1, 2, 3};
    int ids[MOST], chosen = 7, linked = 0;
    struct err err = ERR_INIT;
    assert_int_equal(start_photos_choose(ids, &chosen, MOST, &linked, two_rooms, 5, placed, 3, &err), ST_OK);
    assert_int_equal(linked, 3);
    assert_int_equal(chosen, 0);
}

static void without_pairs_there_is_no_start(void **state)
{
    (void)state;
    int ids[MOST], chosen = 7, linked = 7;
    struct err err = ERR_INIT;
    assert_int_equal(start_photos_choose(ids, &chosen, MOST, &linked, NULL, 0, NULL, 0, &err), ST_OK);
    assert_int_equal(chosen, 0);
    assert_int_equal(linked, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photos_that_are_not_placed_come_first),
        cmocka_unit_test(a_room_that_is_no_larger_is_not_tried),
        cmocka_unit_test(without_pairs_there_is_no_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
