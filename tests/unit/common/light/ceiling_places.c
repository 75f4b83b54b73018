/* ceiling_places.c - places below the ceiling of a room. */
#include "common/light/ceiling_places.h"

#include "tests/unit/box_solids.h"

enum { MOST = 100 };
static const struct box room[] = {ROOM_OUTSIDE, ROOM_INSIDE};

static bool is_east(const void *ctx, struct vec3 at) { return at.x > *(const double *)ctx; }

/* The room is 4 high, wide and deep, about the origin. */
static void places_hang_below_the_ceiling_inside_the_room(void **state)
{
    (void)state;
    struct model_rays rays = make_rays(room, 2);
    struct vec3 places[MOST];
    const struct ceiling_grid grid = {.rays = &rays, .spacing = 0.2, .below = 0.1, .most = MOST};
    const double spacing = ceiling_places_spacing(&grid);
    const int count = ceiling_places_list(places, &grid);
    assert_true(fabs(spacing - 0.2 * model_rays_height(&rays)) < 1e-9);
    assert_true(count >= 9 && count <= MOST);
    for (int i = 0; i < count; i++) {
        assert_true(fabs(places[i].x) < 2 && fabs(places[i].y) < 2);
        assert_true(fabs(places[i].z - 1.6) < 1e-6);
    }
    model_rays_release(&rays);
}

static void places_that_are_not_wanted_are_left_out_and_no_more_than_fit(void **state)
{
    (void)state;
    struct model_rays rays = make_rays(room, 2);
    struct vec3 places[MOST];
    const double from = 0.5;
    struct ceiling_grid grid = {&rays, 0.05, 0.1, MOST, is_east, &from};
    const int east = ceiling_places_list(places, &grid);
    assert_true(east > 0);
    for (int i = 0; i < east; i++) assert_true(places[i].x > from);
    grid.may_be = NULL;
    assert_true(ceiling_places_list(places, &grid) > east);
    grid.most = 4;
    assert_true(ceiling_places_list(places, &grid) <= 4);
    model_rays_release(&rays);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_hang_below_the_ceiling_inside_the_room),
        cmocka_unit_test(places_that_are_not_wanted_are_left_out_and_no_more_than_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
