/* frame_points.c - points on walls that straight edges show. */
#include "stages/suggest_model/frame_points.h"

#include <math.h>
#include <stdlib.h>

#include "tests/unit/scratch.h"

static struct frame_heading headings[2] = {{{0, 1, 0}, 0.001, 0.2}, {{-1, 0, 0}, 0.001, 0.2}};
static struct frame_wall walls[2] = {{0, 1, -3, -1, 2, 4}, {1, -1, 2, 0, 5, 1}};
static const struct room_frame frame = {
    .known = true, .up = {0, 0, 1}, .headings = headings, .heading_count = 2, .walls = walls, .wall_count = 2};

/* Model units are half of the scene's; the floor is at -1.2 of the scene. */
static const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .translation = {0, 0, 0.6}, .scale = 0.5};

static void points_cover_a_wall_and_face_its_room(void **state)
{
    (void)state;
    struct point_cloud cloud = {0};
    struct err err = ERR_INIT;
    double low = HUGE_VAL, high = -HUGE_VAL;
    assert_ok(frame_points_add(&cloud, &frame, &axes, 1.3, 0.1, &err), err);
    assert_int_equal(cloud.count, 15 * 13); /* the second wall has the support of one place */
    for (size_t i = 0; i < cloud.count; i++) {
        const struct cloud_point *p = &cloud.points[i];
        /* across = up x along = -x, so that the wall is at x = 3 of the scene, and its room at smaller x */
        assert_true(fabs(p->position.x - 1.5) < 1e-9);
        assert_true(p->position.z > 0 && p->position.z < 1.3);
        assert_true(p->normal[0] < -0.999f);
        assert_int_equal(p->views, 4);
        low = fmin(low, p->position.y);
        high = fmax(high, p->position.y);
    }
    assert_true(fabs(low + 0.45) < 1e-9 && fabs(high - 0.95) < 1e-9);
    free(cloud.points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(points_cover_a_wall_and_face_its_room)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
