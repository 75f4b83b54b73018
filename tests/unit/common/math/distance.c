/* distance.c - the distance transform against brute force. */
#include "common/math/distance.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "common/base/rng.h"

enum { W = 37, H = 23 };

static void distances_match_brute_force(void **state)
{
    (void)state;
    const struct rng rng = rng_make(1, "test", "distance");
    for (uint64_t round = 0; round < 40; round++) {
        static uint8_t inside[W * H];
        static float squared[W * H];
        struct err err = ERR_INIT;
        const int width = round % 5 == 0 ? 1 : W, height = round % 7 == 0 ? 1 : H;
        for (int p = 0; p < width * height; p++)
            inside[p] = rng_uniform(&rng, round, (uint64_t)p) > 0.3 / (1 + (double)round);
        assert_int_equal(distance_squared(squared, inside, width, height, &err), ST_OK);
        for (int p = 0; p < width * height; p++) {
            float best = INFINITY;
            for (int q = 0; q < width * height; q++)
                if (!inside[q]) {
                    const float dx = (float)(p % width - q % width), dy = (float)(p / width - q / width);
                    best = fminf(best, dx * dx + dy * dy);
                }
            assert_true(squared[p] == best);
        }
    }
}

static void without_an_outside_pixel_distances_are_infinite(void **state)
{
    (void)state;
    uint8_t inside[6] = {1, 1, 1, 1, 1, 1};
    float squared[6];
    struct err err = ERR_INIT;
    assert_int_equal(distance_squared(squared, inside, 3, 2, &err), ST_OK);
    for (int p = 0; p < 6; p++) assert_true(squared[p] == INFINITY);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(distances_match_brute_force),
                                       cmocka_unit_test(without_an_outside_pixel_distances_are_infinite)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
