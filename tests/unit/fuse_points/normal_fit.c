/* normal_fit.c - normals from the depths around a pixel, on known planes. */
#include "planes.h"

#include "stages/fuse_points/normal_fit.h"

static float inverse[WIDTH * HEIGHT];

static double degrees_between(struct vec3 a, struct vec3 b) { return acos(fmin(vec3_dot(a, b), 1)) * 180 / M_PI; }

static struct vec3 fit(const struct world *w, struct vec3 normal, int x, int y)
{
    return normal_fit(normal, inverse, &w->views[0], x, y, 15, 0.002);
}

/* Depths of the wall to the left of column `crease`, of the board to the right. */
static void paint(const struct world *w, int crease)
{
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const struct depth_segment *s = &w->depths[0].segments[i % WIDTH < crease];
        inverse[i] = (float)(s->plane[0] * (i % WIDTH + 0.5) + s->plane[1] * (i / WIDTH + 0.5) + s->plane[2]);
    }
}

static void a_wrong_normal_is_corrected_to_the_plane(void **state)
{
    struct world w;
    (void)state;
    world_make(&w);
    paint(&w, WIDTH);
    const struct vec3 facing = {0, 0, -1};
    assert_true(degrees_between(facing, wall().normal) > 15);
    assert_true(degrees_between(fit(&w, facing, 48, 36), wall().normal) < 1);
    assert_true(degrees_between(fit(&w, facing, 0, 0), wall().normal) < 3); /* half of the window is outside */
    assert_true(degrees_between(fit(&w, wall().normal, 48, 36), wall().normal) < 0.01);
    world_release(&w);
}

static void another_surface_does_not_change_the_normal(void **state)
{
    struct world w;
    (void)state;
    world_make(&w);
    paint(&w, 50);
    assert_true(degrees_between(fit(&w, wall().normal, 47, 36), wall().normal) < 1);
    assert_true(degrees_between(fit(&w, board().normal, 53, 36), board().normal) < 1);
    world_release(&w);
}

static void without_surrounding_depths_the_normal_is_kept(void **state)
{
    struct world w;
    (void)state;
    world_make(&w);
    memset(inverse, 0, sizeof inverse);
    inverse[36 * WIDTH + 48] = 0.25f;
    assert_true(degrees_between(fit(&w, board().normal, 48, 36), board().normal) < 1e-4);
    /* a normal that faces away has no initial slope */
    const struct vec3 away = vec3_scale(board().normal, -1);
    assert_true(degrees_between(fit(&w, away, 48, 36), away) < 1e-4);
    world_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wrong_normal_is_corrected_to_the_plane),
        cmocka_unit_test(another_surface_does_not_change_the_normal),
        cmocka_unit_test(without_surrounding_depths_the_normal_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
