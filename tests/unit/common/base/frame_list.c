/* frame_list.c - lists of frames. */
#include "common/base/frame_list.h"

#include "tests/unit/scratch.h"

static void frame_lists_are_parsed(void **state)
{
    (void)state;
    static const struct {
        const char *list, *wanted; /* of 6 frames */
    } valid[] = {{"1:6", "111111"}, {"1", "100000"}, {"2:4", "011100"}, {"1:2,5", "110010"}, {"6,3,3:4", "001101"}};
    static const char *const bad[] = {"",   "0",    "7", "1:7", "3:2", "1:",    ":3", ",",
                                      "1,", "1,,2", "a", "1-3", "-1",  "1:2:3", " 1", "99999999999999999999"};
    bool wanted[6];

    for (size_t i = 0; i < sizeof valid / sizeof *valid; i++) {
        struct err err = ERR_INIT;
        assert_ok(frame_list_read(wanted, 6, valid[i].list, &err), err);
        for (int k = 0; k < 6; k++) assert_int_equal(wanted[k], valid[i].wanted[k] == '1');
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err err = ERR_INIT;
        assert_int_equal(frame_list_read(wanted, 6, bad[i], &err), ST_USAGE);
        assert_err(err, ST_USAGE, "from 1 to 6");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(frame_lists_are_parsed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
