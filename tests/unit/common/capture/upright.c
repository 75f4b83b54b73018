/* upright.c - the upright direction of stored pictures, from EXIF orientation. */
#include "common/capture/upright.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* EXIF orientation: the displayed positions of the stored picture's first row and first column. */
static void the_upright_direction_follows_exif_orientation(void **state)
{
    (void)state;
    static const double expected[10][2] = {{0, -1}, {0, -1}, {0, -1}, {0, 1}, {0, 1},
                                           {-1, 0}, {-1, 0}, {1, 0},  {1, 0}, {0, -1}};
    for (int i = 0; i < 10; i++) {
        const struct vec3 up = upright_from_orientation(i);
        assert_true(up.x == expected[i][0] && up.y == expected[i][1] && up.z == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_upright_direction_follows_exif_orientation)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
