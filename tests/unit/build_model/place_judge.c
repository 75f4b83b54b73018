/* place_judge.c - rectangles that do not show where a wall is: one for each way in which points may mislead. */
#include "tests/unit/build_model/scripted.h"

#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "stages/build_model/place/place.h"

/* A camera at the origin, 1.5 above the floor, that looks along +y; the rectangle is the middle of its picture. */
static char photo[] = "photo";
static struct lens lens[] = {{photo, photo, {CAMERA_PINHOLE, 400, 300, {200, 200, 200, 150}}, {1, 0, 0, 0}}};
static const struct lens_list list = {lens, 1}, no_lenses = {0};
static struct view view[1];
static const struct camera_set set = {.views = view, .view_count = 1}, no_views = {0};
static const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1, .metric = true, .ceiling = 2.5};
static const struct model_params params = MODEL_PARAMS_DEFAULT;
enum { MAX_POINTS = 20000 };
static struct cloud_point points[MAX_POINTS];
static struct point_cloud cloud = {.points = points};

static int start(void **state)
{
    view[0] = (struct view){.name = "photo", .width = 400, .height = 300, .fx = 200, .fy = 200, .cx = 200, .cy = 150};
    view[0].cam_from_world = (struct mat3){{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    view[0].center = vec3_make(0, 0, 1.5);
    view[0].translation = vec3_scale(mat3_apply(view[0].cam_from_world, view[0].center), -1);
    return scratch_make(state);
}

/* Points on a surface that has the normal (nx, ny, nz), at depth y where it crosses the middle of the rectangle, within
 * the part u0 .. u1, v0 .. v1 of it; scattered in depth by up to `scatter` to either side. */
static void add(int count, double y, double nx, double ny, double nz, double scatter, const double part[4])
{
    const struct rng r = rng_make(2, "place_judge", "points");
    const struct vec3 n = vec3_normalize(vec3_make(nx, ny, nz));
    for (int i = 0; i < count; i++) {
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = rng_uniform(&r, cloud.count, (uint64_t)k);
        const double u = 200 * (part[0] + (part[1] - part[0]) * d[0]) - 100;
        const double v = 200 * (part[2] + (part[3] - part[2]) * d[1]) - 100;
        const struct vec3 ray = vec3_make(u / 200, 1, -v / 200);
        const double along = fabs(n.y) > 0.1 ? y * n.y / vec3_dot(n, ray) : y, at = along + scatter * (2 * d[2] - 1);
        assert_true(cloud.count < MAX_POINTS);
        points[cloud.count++] = (struct cloud_point){
            {ray.x * at, ray.y * at, 1.5 + ray.z * at}, {(float)n.x, (float)n.y, (float)n.z}, {0}, 3, 1};
    }
}

static const double whole[4] = {0, 1, 0, 1};

/* The same in a plane across the camera's axis, with the normals of something else. */
static void add_facing(int count, double y, double nx, double ny, double nz, double scatter, const double part[4])
{
    const struct vec3 n = vec3_normalize(vec3_make(nx, ny, nz));
    add(count, y, 0, -1, 0, scatter, part);
    for (size_t i = cloud.count - (size_t)count; i < cloud.count; i++) {
        points[i].normal[0] = (float)n.x;
        points[i].normal[1] = (float)n.y;
        points[i].normal[2] = (float)n.z;
    }
}

static enum status place(struct placed_wall *wall, const struct place_direction *wanted, struct err *err)
{
    const struct placer_views known[2] = {{&set, &list}, {&no_views, &no_lenses}};
    const struct script_place p = {.kind = PLACE_VIEW, .view = photo, .a = {100, 50, 300, 250}};
    const struct place_direction vote = {0};
    struct placer placer;
    *err = (struct err)ERR_INIT;
    assert_ok(place_init(&placer, known, &axes, &cloud, &params, err), *err);
    place_wall(wall, &placer, &p, wanted ? wanted : &vote, "model.txt", 9, err);
    place_release(&placer);
    return err->status;
}

static void assert_refused(const char *words)
{
    struct placed_wall wall;
    struct err err;
    assert_int_not_equal(place(&wall, NULL, &err), ST_OK);
    assert_err(err, ST_DATA, words);
    assert_err(err, ST_DATA, "model.txt:9: the rectangle 100 50 300 250 in photo does not show where the wall is: ");
    assert_err(err, ST_DATA, "wall NAME foot in VIEW X0 Y0 X1 Y1");
    cloud.count = 0;
}

static void assert_placed(const struct place_direction *wanted, double nx, double ny, double c)
{
    struct placed_wall wall;
    struct err err;
    assert_ok(place(&wall, wanted, &err), err);
    assert_true(hypot(wall.n[0] - nx, wall.n[1] - ny) < 0.005 && fabs(wall.c - c) < 0.01);
    cloud.count = 0;
}

static void a_wall_with_texture_is_placed(void **state)
{
    (void)state;
    cloud.count = 0;
    add(2000, 3, 0, -1, 0, 0.01, whole);
    assert_placed(NULL, 0, -1, -3);
    const double middle[4] = {0.2, 0.8, 0.2, 0.8};
    add(40, 3, 0, -1, 0, 0.01, middle); /* few, but all of one plane */
    assert_placed(NULL, 0, -1, -3);
}

static void few_points_are_refused(void **state)
{
    (void)state;
    cloud.count = 0;
    add(400, 3, 0, -1, 0, 0.9, whole); /* anywhere between 2.1 and 3.9 */
    assert_refused("lie on the plane that fits best");
    const double patch[4] = {0.3, 0.35, 0.3, 0.35};
    add(400, 3, 0, -1, 0, 0.01, patch);
    assert_refused("are in 1 of the rectangle's 64 parts alone, wanted 5 or more");
}

static void points_of_another_direction_are_refused(void **state)
{
    (void)state;
    cloud.count = 0;
    add(300, 3, 0, -1, 0, 0.01, whole);
    add_facing(700, 3, -1, -1, 0, 0.01, whole);
    assert_refused("of the points on upright surfaces only 30 % face the direction that the wall would have");
    add(1000, 3, tan(17 * DEGREE), -1, 0, 0.005, whole);
    assert_refused("its points face 17 degrees off the nearest axis, wanted 10 or less; add the word angled");
    add(1000, 3, tan(17 * DEGREE), -1, 0, 0.005, whole);
    const struct place_direction is_free = {.is_free = true};
    const double n[2] = {sin(17 * DEGREE), -cos(17 * DEGREE)};
    assert_placed(&is_free, n[0], n[1], 3 * n[1]);
}

static void a_given_direction_is_kept(void **state)
{
    const double x[2] = {1, 0}, y[2] = {0, 1}, turned[2] = {cos(17 * DEGREE), sin(17 * DEGREE)};
    const struct place_direction along[3] = {{.along = x}, {.along = y}, {.along = turned}};
    const double left[4] = {0, 0.6, 0, 1}, right[4] = {0.8, 1, 0, 1};
    (void)state;
    cloud.count = 0;
    add(900, 3, 0, -1, 0, 0.005, left); /* beside it a wall across it has more points */
    add(5000, 3, -1, 0, 0, 0, right);
    for (size_t k = 900; k < cloud.count; k++) {
        struct vec3 *p = &points[k].position;
        const double t = 1.6 / p->x; /* along the ray to the plane x = 1.6 */
        *p = vec3_make(1.6, t * p->y, 1.5 + t * (p->z - 1.5));
    }
    struct placed_wall wall;
    struct err err;
    assert_int_not_equal(place(&wall, NULL, &err), ST_OK);
    assert_placed(&along[0], 0, -1, -3);
    add(1000, 3, tan(17 * DEGREE), -1, 0, 0.005, whole);
    assert_placed(&along[2], sin(17 * DEGREE), -cos(17 * DEGREE), -3 * cos(17 * DEGREE));
    add(1000, 3, 0, -1, 0, 0.01, whole); /* no point faces along it */
    assert_int_not_equal(place(&wall, &along[1], &err), ST_OK);
    assert_err(err, ST_DATA, "0 visible points with the normal of a wall");
    cloud.count = 0;
}

static void scattered_points_are_refused(void **state)
{
    (void)state;
    cloud.count = 0;
    const double left[4] = {0, 0.4, 0, 1}, right[4] = {0.4, 1, 0, 1};
    add(400, 2.6, 0, -1, 0, 0.01, left);
    add(700, 3.3, 0, -1, 0, 0.12, right); /* scattered, and behind what stands at the left */
    assert_refused("or more off the plane that fits best, which is 2.6 from the camera, wanted 5 %");
}

static void points_before_the_wall_are_refused(void **state)
{
    const double left[4] = {0, 0.6, 0, 1}, right[4] = {0.6, 1, 0, 1};
    (void)state;
    cloud.count = 0;
    add(600, 3, 0, -1, 0, 0.01, left);
    add_facing(400, 2, 0, -1, 1, 0.01, right); /* the back of a sofa */
    assert_refused("% of the visible points stand before the plane that fits best, 3 from the camera, wanted 30");
    add(800, 3, 0, -1, 0, 0.01, left);
    add_facing(200, 2, 0, -1, 1, 0.01, right); /* a fifth may */
    assert_placed(NULL, 0, -1, -3);
}

static void a_wall_of_few_of_the_points_is_refused(void **state)
{
    const double left[4] = {0, 0.5, 0, 1}, right[4] = {0.5, 1, 0, 1};
    (void)state;
    cloud.count = 0;
    add(60, 3, 0, -1, 0, 0.01, left);
    add_facing(1140, 3, 0, -1, 1, 0.02, right); /* things at the same distance that face upwards */
    assert_refused("only 5.0 % of the visible points lie on the plane that fits best");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_with_texture_is_placed),
        cmocka_unit_test(few_points_are_refused),
        cmocka_unit_test(points_of_another_direction_are_refused),
        cmocka_unit_test(a_given_direction_is_kept),
        cmocka_unit_test(scattered_points_are_refused),
        cmocka_unit_test(points_before_the_wall_are_refused),
        cmocka_unit_test(a_wall_of_few_of_the_points_is_refused),
    };
    return cmocka_run_group_tests(tests, start, scratch_remove);
}
