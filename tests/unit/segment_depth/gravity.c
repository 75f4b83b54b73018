/* gravity.c - gravity and ground of scenes of points: walls, lawns, tables. World: y is down. */
#include "stages/segment_depth/gravity.h"

#include "tests/unit/segment_depth/scene.h"

static struct scene scene; /* large; zeroed by start() */

static void start(void) { memset(&scene, 0, sizeof scene); }

/* A camera at (x, y, 0), turned to the right by yaw and then up by pitch, in degrees. */
static void camera(double x, double y, double yaw, double pitch)
{
    struct view *v = scene_view(&scene, 160, 120, 160, x, y, 0, yaw * M_PI / 180);
    const double c = cos(pitch * M_PI / 180), s = sin(pitch * M_PI / 180);
    const struct mat3 up = {{{1, 0, 0}, {0, c, s}, {0, -s, c}}};
    v->cam_from_world = mat3_multiply(up, v->cam_from_world);
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
}

static void cameras_in_a_row(double pitch)
{
    for (int i = 0; i < 4; i++) camera(i - 1.5, 0.1 * (i % 2), 4 * i - 6, pitch);
}

/* `count` points of a box. */
static void points_in(int count, double x0, double x1, double y0, double y1, double z0, double z1)
{
    const int from = scene.set.model.point_count;
    for (int i = from; i < from + count; i++)
        scene_point(&scene,
                    vec3_make(x0 + (x1 - x0) * scene_hash(i, 1, 0), y0 + (y1 - y0) * scene_hash(i, 2, 0),
                              z0 + (z1 - z0) * scene_hash(i, 3, 0)),
                    3);
}

/* The front and a wing of a building that stands at y = 1.5. */
static void building(void)
{
    points_in(240, -5, 5, -4, 1.5, 10, 10);
    points_in(40, 5, 5, -4, 1.5, 6, 10);
}

/* Degrees between what is found and down. */
static double gravity_error(bool known)
{
    struct vec3 down;
    bool is_known;
    struct err err = ERR_INIT;
    assert_int_equal(gravity_find(&down, &is_known, &scene.set, NULL, &err), ST_OK);
    assert_int_equal(is_known, known);
    assert_near(vec3_length(down), 1, 1e-12);
    return asin(fmin(1, vec3_length(vec3_cross(down, vec3_make(0, 1, 0))))) * 180 / M_PI;
}

static bool find(struct ground *g)
{
    bool found;
    struct err err = ERR_INIT;
    assert_int_equal(gravity_find_ground(g, &found, &scene.set, vec3_make(0, 1, 0), &err), ST_OK);
    return found;
}

static void walls_show_gravity_to_photos_that_are_all_tilted(void **state)
{
    (void)state;
    for (int pitch = -30; pitch <= 30; pitch += 10) {
        start();
        cameras_in_a_row(pitch);
        building();
        assert_true(gravity_error(true) < 1.25); /* the mean of turned and tilted photos has a roll of 1.1 itself */
    }
}

static void without_walls_gravity_is_the_mean_of_the_photos(void **state)
{
    (void)state;
    start();
    cameras_in_a_row(10);
    points_in(300, -5, 5, -4, 4, 6, 14);
    assert_near(gravity_error(false), 10, 0.1);
    start();
    cameras_in_a_row(10);
    assert_near(gravity_error(false), 10, 0.1); /* no points at all */
}

/* Their tilts cancel out. A leaning wall does not change the result. */
static void photos_taken_all_around_show_gravity_themselves(void **state)
{
    (void)state;
    start();
    for (int i = 0; i < 6; i++) camera(0, 0, 60 * i, 15);
    for (int i = 0; i < 200; i++)
        scene_point(&scene, vec3_make(4 * scene_hash(i, 1, 0), scene_hash(i, 2, 0), 5 + 0.3 * scene_hash(i, 2, 0)), 3);
    assert_true(gravity_error(true) < 1e-6);
}

static void the_ground_lies_at_the_foot_of_what_stands_on_it(void **state)
{
    (void)state;
    for (int outliers = 0; outliers <= 3; outliers += 3) {
        struct ground g;
        start();
        cameras_in_a_row(0);
        building();
        points_in(40, -5, 5, 1.5, 1.5, 3, 9);
        points_in(outliers, -5, 5, 2, 5, 3, 9);
        assert_true(find(&g));
        for (int k = 0; k < 4; k++) /* between the cameras and the building */
            assert_near(vec3_dot(g.down, vec3_make(k % 2 ? 4 : -4, 1.5, k / 2 ? 9 : 3)), g.offset, 0.15);
    }
}

static void a_table_is_not_the_ground_where_the_floor_shows(void **state)
{
    (void)state;
    struct ground g;
    start();
    cameras_in_a_row(0);
    points_in(200, -1, 1, 0.8, 0.8, 3, 5);
    points_in(40, -3, 3, 1.8, 1.8, 4, 8);
    if (find(&g)) assert_near(g.offset, 1.8, 0.2);
}

static void a_wall_without_a_foot_shows_no_ground(void **state)
{
    (void)state;
    struct ground g;
    start();
    cameras_in_a_row(0);
    points_in(300, -5, 5, -4, 1.5, 10, 10);
    assert_false(find(&g));
    start();
    cameras_in_a_row(0);
    assert_false(find(&g)); /* no points at all */
}

/* The same points, but the photos see nothing below them. */
static void the_lower_edge_of_the_photos_is_not_the_ground(void **state)
{
    (void)state;
    struct ground g;
    for (int pitch = 0; pitch <= 13; pitch += 13) {
        start();
        cameras_in_a_row(pitch);
        building();
        points_in(40, -5, 5, 1.5, 1.5, 3, 9);
        assert_int_equal(find(&g), pitch == 0);
    }
}

static void a_ceiling_is_not_the_ground(void **state)
{
    (void)state;
    struct ground g;
    start();
    cameras_in_a_row(0);
    points_in(300, -5, 5, -2, -2, 3, 9);
    assert_false(find(&g));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walls_show_gravity_to_photos_that_are_all_tilted),
        cmocka_unit_test(without_walls_gravity_is_the_mean_of_the_photos),
        cmocka_unit_test(photos_taken_all_around_show_gravity_themselves),
        cmocka_unit_test(the_ground_lies_at_the_foot_of_what_stands_on_it),
        cmocka_unit_test(a_table_is_not_the_ground_where_the_floor_shows),
        cmocka_unit_test(a_wall_without_a_foot_shows_no_ground),
        cmocka_unit_test(the_lower_edge_of_the_photos_is_not_the_ground),
        cmocka_unit_test(a_ceiling_is_not_the_ground),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
