/* upright.c - the upper side of stored pictures, by EXIF orientation. */
#include "common/capture/upright.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* What EXIF's orientations mean: where the stored picture's first row and first column are shown. */
static void the_upper_side_is_where_exif_says(void **state)
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_upper_side_is_where_exif_says)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
