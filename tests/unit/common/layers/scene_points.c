/* scene_points.c - centroids of segments: position, weight, and which are central. */
#include "common/layers/scene_points.h"

#include "tests/unit/scratch.h"
#include "tests/unit/wall_scene.h"

static void points_are_on_the_surfaces(void **state)
{
    (void)state;
    struct wall_scene f = {0};
    struct scene_points p;
    struct err err = ERR_INIT;
    double weight[3] = {0}, box = 0;
    size_t central = 0;
    add_straight(&f, -1, 0, 0);
    add_straight(&f, 1, 0.5, 1);
    add_view(&f, vec3_make(0, 0, 0), vec3_make(1, 0.5, 5), vec3_make(0, 1, 0));
    finish(&f, wall_and_box, 2);
    assert_ok(scene_points_collect(&p, &f.scene, &err), err);
    for (size_t i = 0; i < p.count; i++) {
        const struct scene_point *q = &p.points[i];
        const struct view *v = &f.views[q->view];
        double u, w;
        const bool at_box = q->position.z < 8;
        assert_float_equal(q->position.z, at_box ? 6 : 10, 1e-5);
        if (at_box) assert_true(fabs(q->position.x - 0.5) < 1.2 && fabs(q->position.y - 0.3) < 1.5);
        assert_true(view_project(v, q->position, &u, &w) > 0 && u > 0 && w > 0 && u < W && w < H);
        assert_true(q->central == (u >= W / 4.0 && u <= 3 * W / 4.0 && w >= H / 4.0 && w <= 3 * H / 4.0));
        assert_true(q->weight > 0);
        weight[q->view] += q->weight;
        box += at_box && q->view == 0 ? q->weight : 0;
        central += q->central;
    }
    for (int i = 0; i < 3; i++) assert_float_equal(weight[i], W * H, 1e-9); /* every pixel counts once */
    /* the box is 2.4 x 3 at depth 6 */
    assert_float_equal(box / ((2.4 / 6 * W) * (3.0 / 6 * W)), 1, 0.03);
    assert_true(central > p.count / 6 && central < p.count / 2);
    scene_points_release(&p);
    assert_null(p.points);
    scene_points_release(&p);
    scene_points_release(NULL);
    layer_scene_release(&f.scene);
}

static void a_scene_without_depth_is_an_error(void **state)
{
    (void)state;
    struct wall_scene f = {0};
    struct scene_points p;
    struct err err = ERR_INIT;
    for (int i = 0; i < 2; i++) add_straight(&f, i, 0, 0);
    finish(&f, NULL, 0);
    assert_int_equal(scene_points_collect(&p, &f.scene, &err), ST_DATA);
    assert_err(err, ST_DATA, "none of the 2 depth maps has a segment with a depth");
    assert_true(!p.points && !p.count);
    layer_scene_release(&f.scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_are_on_the_surfaces),
        cmocka_unit_test(a_scene_without_depth_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
