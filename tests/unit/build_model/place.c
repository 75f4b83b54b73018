/* place.c - walls from rectangles on photographs: synthetic points on known walls. */
#include "tests/unit/build_model/scripted.h"

#include "common/base/rng.h"
#include "stages/build_model/place/place.h"

/* A camera at (2, 2, 1.5) of the model that looks along +y, as a fisheye and as a pinhole; the world is the model
 * rotated by 30 degrees, translated, and half as large. */
static char fish[] = "fish", pin[] = "pin", pin0[] = "pin@0";
static struct lens lenses[] = {
    {fish, fish, {CAMERA_OPENCV_FISHEYE, 960, 640, {426, 426, 480, 320, -1.0 / 24, 1.0 / 1920, 0, 0}}, {1, 0, 0, 0}},
    {pin0, pin, {CAMERA_PINHOLE, 400, 300, {200, 200, 200, 150}}, {0.96592582628906831, 0, 0.25881904510252074, 0}}};
static const struct lens_list list = {lenses, 2};
static struct model_axes axes = {.scale = 2, .metric = true, .ceiling = 2.5, .translation = {0.3, -0.2, 0.1}};
static struct view views[2];
static const struct camera_set set = {.views = views, .view_count = 2};
static struct point_cloud cloud;
static struct placer placer;
static const struct model_params params = MODEL_PARAMS_DEFAULT;

static void add_point(double x, double y, double z, double nx, double ny, double nz)
{
    const struct vec3 p = world_from_model_point(&axes, vec3_make(x, y, z));
    const struct vec3 n = world_from_model_direction(&axes, vec3_normalize(vec3_make(nx, ny, nz)));
    if (!(cloud.count & (cloud.count - 1))) /* a power of two: the points fill their memory */
        cloud.points = realloc(cloud.points, (cloud.count ? 2 * cloud.count : 1) * sizeof *cloud.points);
    assert_non_null(cloud.points);
    cloud.points[cloud.count++] = (struct cloud_point){p, {(float)n.x, (float)n.y, (float)n.z}, {0}, 3, 0.9F};
}

/* Adds noisy points on a wall n p = c about (x, y): `width` to either side, from z 0 to 2.5. */
static void add_wall(double nx, double ny, double c, double x, double y, double width, int count, double noise)
{
    const struct rng r = rng_make(1, "place", "points");
    const uint64_t key = cloud.count;
    uint64_t k = 0;
    for (int i = 0; i < count; i++) {
        double d[7];
        for (int n = 0; n < 7; n++) d[n] = rng_uniform(&r, key, k++);
        const double along = -ny * x + nx * y + width * (2 * d[0] - 1), at = c + noise * (d[1] + d[2] - 1);
        add_point(nx * at - ny * along, ny * at + nx * along, 2.5 * d[3], nx + 0.2 * (d[4] - 0.5),
                  ny + 0.2 * (d[5] - 0.5), 0.2 * (d[6] - 0.5));
    }
}

static const struct camera_set no_views = {0};
static const struct lens_list no_lenses = {0};

static int start(void **state)
{
    struct err err = ERR_INIT;
    axes.rotation = (struct quat){cos(0.25), 0, 0, sin(0.25)};
    /* cam_from_model: x right is x, y down is -z, z forward is y */
    for (int i = 0; i < 2; i++) {
        struct view v = {
            .name = i ? "pin@0" : "fish", .width = 100, .height = 100, .fx = 50, .fy = 50, .cx = 50, .cy = 50};
        const struct mat3 look = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
        v.cam_from_world = mat3_multiply(mat3_from_quat(lenses[i].view_from_photo), look);
        v.center = vec3_make(2, 2, 1.5);
        v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
        views[i] = v;
        views[i].translation =
            vec3_scale(vec3_add(v.translation, mat3_apply(v.cam_from_world, axes.translation)), 1 / axes.scale);
        views[i].cam_from_world = mat3_multiply(v.cam_from_world, mat3_from_quat(axes.rotation));
        views[i].center = world_from_model_point(&axes, v.center);
    }
    /* in front of the camera a wall at y = 4 with its normal along -y; 40 cm in front of it a board at y = 3.6, behind
     * it a wall of another room, to the side an angled wall; to the left a wall at x = 1, and behind it a far one that
     * has many more points in each direction */
    add_wall(0, -1, -4, 2, 4, 1.5, 6000, 0.02);
    add_wall(0, -1, -3.6, 1.2, 3.6, 0.3, 1500, 0.02);
    add_wall(0, -1, -6, 2, 6, 3, 20000, 0.02);
    add_wall(-0.8, -0.6, -(0.8 * 4.5 + 0.6 * 3.6), 4.5, 3.6, 0.7, 6000, 0.01);
    add_wall(1, 0, 1, 1, 2.2, 0.7, 15000, 0.01);
    add_wall(1, 0, -6, -6, 7.6, 1.3, 40000, 0.01);
    const struct placer_views known[2] = {{&set, &list}, {&no_views, &no_lenses}};
    return scratch_make(state) || place_init(&placer, known, &axes, &cloud, &params, &err);
}

static int stop(void **state)
{
    place_release(&placer);
    point_cloud_release(&cloud);
    return scratch_remove(state);
}

static enum status place(struct placed_wall *w, const char *view, double x0, double y0, double x1, double y1,
                         const double *normal, bool angled, struct err *err)
{
    const struct script_place p = {.kind = PLACE_VIEW, .view = view, .a = {x0, y0, x1, y1}};
    const struct place_direction wanted = {.normal = normal, .is_free = angled};
    *err = (struct err)ERR_INIT;
    return place_wall(w, &placer, &p, &wanted, "model.txt", 9, err);
}

/* Pixel of a point of the model in the fisheye photo. */
static void pixel(double x, double y, double z, double *u, double *v)
{
    assert_true(camera_project(&lenses[0].camera, vec3_make(x - 2, 1.5 - z, y - 2), u, v));
}

static void a_rectangle_places_a_wall(void **state)
{
    struct placed_wall w;
    struct err err;
    double u0, u1, v;
    (void)state;
    pixel(1.6, 4, 1.5, &u0, &v);
    pixel(2.8, 4, 1.5, &u1, &v);
    assert_ok(place(&w, "fish", u0, 250, u1, 390, NULL, false, &err), err);
    assert_true(w.n[0] == 0 && w.n[1] == -1); /* snapped to an axis */
    assert_true(fabs(w.c + 4) < 0.003);       /* noise of 2 cm, a wall of another room behind */
    assert_true(fabs(w.ends[0][0] - 1.6) < 0.01 && fabs(w.ends[1][0] - 2.8) < 0.01);
    assert_true(w.points > 500 && w.spread < 0.02);
}

static void a_board_in_front_is_outvoted(void **state)
{
    struct placed_wall w;
    struct err err;
    double u0, u1, v;
    (void)state;
    pixel(0.8, 4, 1.5, &u0, &v);
    pixel(3.2, 4, 1.5, &u1, &v);
    assert_ok(place(&w, "fish", u0, 200, u1, 440, NULL, false, &err), err);
    assert_true(fabs(w.c + 4) < 0.005);
}

static void a_near_wall_hides_a_far_one_of_many_more_points(void **state)
{
    struct placed_wall w;
    struct err err;
    double u0, u1, v;
    (void)state;
    pixel(1, 2.55, 1.5, &u0, &v);
    pixel(1, 2.85, 1.5, &u1, &v);
    assert_ok(place(&w, "fish", u0, v - 60, u1, v + 60, NULL, false, &err), err);
    assert_true(w.n[0] == 1 && w.n[1] == 0);
    assert_true(fabs(w.c - 1) < 0.005);
}

static void pixels_are_those_of_the_photo_for_any_of_its_views(void **state)
{
    struct placed_wall a, b;
    struct err err;
    (void)state;
    assert_ok(place(&a, "pin", 160, 100, 280, 200, NULL, false, &err), err);
    assert_ok(place(&b, "pin@0", 160, 100, 280, 200, NULL, false, &err), err);
    assert_true(a.c == b.c && fabs(a.c + 4) < 0.005);
    assert_true(fabs(a.ends[0][0] - (2 - 0.4)) < 0.005 && fabs(a.ends[1][0] - (2 + 0.8)) < 0.005);
}

static void an_angled_wall_gets_the_direction_of_its_points(void **state)
{
    struct placed_wall w;
    struct err err;
    double u0, u1, v;
    (void)state;
    pixel(4.26, 3.92, 1.5, &u0, &v);
    pixel(4.74, 3.28, 1.5, &u1, &v);
    assert_ok(place(&w, "fish", u0, 240, u1, 400, NULL, true, &err), err);
    assert_true(hypot(w.n[0] + 0.8, w.n[1] + 0.6) < 0.01);
    const double off = w.n[0] * 4.5 + w.n[1] * 3.6 - w.c;
    assert_true(fabs(off) < 0.01);
}

static void adjust_keeps_the_direction(void **state)
{
    const double normal[2] = {0, -1};
    struct placed_wall w;
    struct err err;
    (void)state;
    assert_ok(place(&w, "pin", 190, 100, 280, 200, normal, false, &err), err);
    assert_true(fabs(w.c + 4) < 0.005);
    const double aside[2] = {1, 0};
    assert_int_not_equal(place(&w, "pin", 190, 100, 280, 200, aside, false, &err), ST_OK);
    assert_err(err, ST_DATA, "with the wall's normal");
}

static void rectangles_without_a_wall_are_refused(void **state)
{
    struct placed_wall w;
    struct err err;
    (void)state;
    assert_int_not_equal(place(&w, "fish", 400, 20, 500, 60, NULL, false, &err), ST_OK);
    assert_err(err, ST_DATA, "model.txt:9: the rectangle 400 20 500 60 in fish contains 0 visible points, wanted 30");
    assert_int_not_equal(place(&w, "fsh", 400, 20, 500, 60, NULL, false, &err), ST_OK);
    assert_err(err, ST_DATA, "did you mean fish?");
    assert_int_not_equal(place(&w, "pin", 400, 20, 500, 60, NULL, false, &err), ST_OK);
    assert_err(err, ST_DATA, "is not inside the photo pin, which has 400 x 300 pixels");
}

static void corners_lie_where_their_rays_meet_the_plane(void **state)
{
    struct vec3 c[2];
    struct err err = ERR_INIT;
    double u0, v0, u1, v1;
    (void)state;
    pixel(1.7, 4, 2.1, &u0, &v0);
    pixel(2.6, 4, 0.2, &u1, &v1);
    const struct script_place p = {.kind = PLACE_VIEW, .view = "fish", .a = {u0, v0, u1, v1}};
    assert_ok(place_corners(c, &placer, &p, vec3_make(0, -1, 0), -4, "m", 1, &err), err);
    assert_true(vec3_length(vec3_sub(c[0], vec3_make(1.7, 4, 2.1))) < 1e-6);
    assert_true(vec3_length(vec3_sub(c[1], vec3_make(2.6, 4, 0.2))) < 1e-6);
    assert_int_not_equal(place_corners(c, &placer, &p, vec3_make(0, 1, 0), 4, "m", 1, &err), ST_OK);
    assert_err(err, ST_DATA, "starts behind it");
}

/* Opposite corners of openings in a ceiling, which the camera sees from below, and in a floor. */
static void openings_of_rooms_lie_in_the_ceiling_and_the_floor(void **state)
{
    static const char *const ceilings[] = {"", "slope hall from west 2.5 to east 3\n",
                                           "gable hall from west 2.5 to east 2.5 ridge 3.5\n"};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct plan plan;
        struct script script = {0};
        struct err err = ERR_INIT;
        char edit[512];
        double a[4], b[4];
        const double low[2] = {2.25, 4}, high[2] = {2.75, 4.7};
        double z[2];
        for (int k = 0; k < 2; k++) {
            const double x = k ? high[0] : low[0];
            z[k] = i == 0 ? 2.5 : i == 1 ? 2.5 + x / 8 : 3.5 - fabs(x - 2) / 2;
        }
        pixel(low[0], low[1], z[0], &a[0], &a[1]); /* what is nearer is higher in the picture */
        pixel(high[0], high[1], z[1], &a[2], &a[3]);
        pixel(low[0], high[1], 0, &b[0], &b[1]);
        pixel(high[0], low[1], 0, &b[2], &b[3]);
        assert_ok(scripted(&plan, ROOM "move north by 2\n", NULL, &err), err);
        snprintf(
            edit, sizeof edit,
            "remodel-script 1\n%sskylight s on hall in fish %.9f %.9f %.9f %.9f\nhatch h on hall in fish %.9f %.9f "
            "%.9f %.9f\n",
            ceilings[i], a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]);
        assert_ok(script_read(&script, scratch_write("e.txt", edit), &err), err);
        assert_ok(plan_apply(&plan, &script, true, &placer, &err), err);
        for (int s = 0; s < 2; s++)
            for (int k = 0; k < 2; k++)
                assert_true(fabs(plan.slots[s].low[k] - low[k]) < 1e-5 && fabs(plan.slots[s].high[k] - high[k]) < 1e-5);
        script_release(&script);
        plan_release(&plan);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rectangle_places_a_wall),
        cmocka_unit_test(a_board_in_front_is_outvoted),
        cmocka_unit_test(a_near_wall_hides_a_far_one_of_many_more_points),
        cmocka_unit_test(pixels_are_those_of_the_photo_for_any_of_its_views),
        cmocka_unit_test(an_angled_wall_gets_the_direction_of_its_points),
        cmocka_unit_test(adjust_keeps_the_direction),
        cmocka_unit_test(rectangles_without_a_wall_are_refused),
        cmocka_unit_test(openings_of_rooms_lie_in_the_ceiling_and_the_floor),
        cmocka_unit_test(corners_lie_where_their_rays_meet_the_plane),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
