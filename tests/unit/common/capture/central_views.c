/* central_views.c - the order of views from the centre outwards. */
#include "common/capture/central_views.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static struct view at(double x, double y, double gaze_x)
{
    const double gaze_z = sqrt(1 - gaze_x * gaze_x);
    return (struct view){.center = {x, y, 0},
                         .cam_from_world = {{{gaze_z, 0, -gaze_x}, {0, 1, 0}, {gaze_x, 0, gaze_z}}}};
}

static void views_nearest_to_the_centroid_come_first(void **state)
{
    (void)state;
    struct view views[] = {at(-2, 0, 0), at(-1, 0, 0), at(0.1, 0, 0), at(0.9, 0, 0), at(2, 0, 0)};
    const struct camera_set set = {.views = views, .view_count = 5};
    int order[5];
    struct err err = ERR_INIT;
    assert_int_equal(central_views(order, &set, &err), ST_OK);
    assert_true(order[0] == 2 && order[1] == 3 && order[2] == 1 && order[3] + order[4] == 4);
}

/* Views of one photo, or taken from a tripod. */
static void equal_distances_are_ordered_by_viewing_direction(void **state)
{
    (void)state;
    struct view views[] = {at(1, 1, -0.8), at(1, 1, 0.6), at(1, 1, 0.5), at(1, 1, 0.4)};
    const struct camera_set set = {.views = views, .view_count = 4};
    int order[4];
    struct err err = ERR_INIT;
    assert_int_equal(central_views(order, &set, &err), ST_OK);
    assert_true(order[3] == 0);
    assert_true(order[0] == 3); /* the sum of the directions is (0.7, 3.28): nearest to it is 0.4 */
}

static void a_single_view_is_central(void **state)
{
    (void)state;
    struct view views[] = {at(1, 1, 0)};
    const struct camera_set set = {.views = views, .view_count = 1};
    int order[1] = {-1};
    struct err err = ERR_INIT;
    assert_int_equal(central_views(order, &set, &err), ST_OK);
    assert_true(order[0] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_nearest_to_the_centroid_come_first),
        cmocka_unit_test(equal_distances_are_ordered_by_viewing_direction),
        cmocka_unit_test(a_single_view_is_central),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
