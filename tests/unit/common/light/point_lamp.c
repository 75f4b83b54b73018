/* point_lamp.c - what a small lamp gives a surface, against closed forms. */
#include "common/light/point_lamp.h"

#include "tests/unit/box_solids.h"
#include "tests/unit/common/light/near.h"

static const struct vec3 up = {0, 0, 1}, east = {1, 0, 0};

/* The room is 4 high, wide and deep, about the origin; its floor is at z = -2. */
static void a_lamp_gives_cosines_over_the_square_of_the_distance(void **state)
{
    (void)state;
    struct model_rays rays = make_rays(&(const struct box)ROOM_INSIDE, 1);
    const struct vec3 lamp = {0, 0, 1}, floor = {1.5, 0, -2}, wall = {-2, 0, 0};
    const double to_floor = 1.5 * 1.5 + 9, to_wall = 4 + 1;
    assert_near(point_lamp_factor(&rays, POINT_LAMP_DOWNWARDS, lamp, floor, up), 9 / (to_floor * to_floor), 1e-9);
    assert_near(point_lamp_factor(&rays, POINT_LAMP_ROUND, lamp, floor, up), 3 / pow(to_floor, 1.5), 1e-9);
    assert_near(point_lamp_factor(&rays, POINT_LAMP_DOWNWARDS, lamp, wall, east), 2 / (to_wall * to_wall), 1e-9);
    model_rays_release(&rays);
}

static void nothing_arrives_from_behind_or_from_above_a_lamp_or_through_a_wall(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct model_rays rays = make_rays(boxes, 2);
    const struct vec3 lamp = {0, 0, 0}, floor = {1, 0, -2}, high = {-2, 0, 1}, far_below = {0, 0, -20};
    assert_true(point_lamp_factor(&rays, POINT_LAMP_ROUND, lamp, floor, vec3_scale(up, -1)) == 0);
    assert_true(point_lamp_factor(&rays, POINT_LAMP_DOWNWARDS, lamp, high, east) == 0);
    assert_true(point_lamp_factor(&rays, POINT_LAMP_ROUND, lamp, high, east) > 0);
    assert_true(point_lamp_factor(&rays, POINT_LAMP_DOWNWARDS, lamp, far_below, up) == 0);
    model_rays_release(&rays);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_gives_cosines_over_the_square_of_the_distance),
        cmocka_unit_test(nothing_arrives_from_behind_or_from_above_a_lamp_or_through_a_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
