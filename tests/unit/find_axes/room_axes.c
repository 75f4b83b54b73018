/* room_axes.c - axes, floor and ceiling of synthetic rooms. */
#include "stages/find_axes/room_axes.h"

#include "common/math/rotation_fit.h"
#include "tests/unit/find_axes/synthetic_room.h"
#include "tests/unit/scratch.h"

static const struct axes_params PARAMS = AXES_PARAMS_DEFAULT;

static struct room_spec plain(void)
{
    return (struct room_spec){.noise = 0, .ceiling = 1, .world_from_room = ROOM_IDENTITY, .scale = 1};
}

/* A rotation about an oblique axis. */
static struct mat3 turned(double degrees)
{
    const struct vec3 axis = vec3_normalize(vec3_make(0.3, -0.5, 0.8));
    return rotation_turn(ROOM_IDENTITY, vec3_scale(axis, degrees * M_PI / 180));
}

static void find(struct room *room, const struct synthetic_room *r)
{
    const struct room_inputs in = room_inputs(r);
    struct err err = ERR_INIT;
    assert_ok(room_find(room, &in, &PARAMS, &err), err);
}

static void make_and_find(struct room *room, struct synthetic_room *r, const struct room_spec *m)
{
    synthetic_room_make(r, m);
    find(room, r);
}

static void assert_refused(const struct synthetic_room *r, const char *words)
{
    const struct room_inputs in = room_inputs(r);
    struct room room;
    struct err err = ERR_INIT;
    assert_int_equal(room_find(&room, &in, &PARAMS, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
}

static void a_perfect_room_is_found_to_rounding(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    for (int k = 0; k < 5; k++) {
        m.world_from_room = turned(37.0 * k);
        m.scale = k == 1 ? 1 / 3.0 : 1;
        m.origin = vec3_make(3.1 * k, -1.7 * k, 0.8 * k);
        make_and_find(&room, &r, &m);
        assert_true(room_angle(&r, &room.axes) < 1e-5);
        assert_true(fabs(room_floor(&r, &room.axes)) < 1e-7);
        assert_true(fabs(room.axes.ceiling - 2.6 * m.scale) < 1e-6);
        assert_false(room.axes.metric);
        assert_true(room.axes.scale == 1 && room.axes.thickness == 0);
        for (int a = 0; a < 2; a++) /* x may be the room's y */
            assert_true(fabs(room.high[a] - room.low[a] - 5 * m.scale) < 1e-4 ||
                        fabs(room.high[a] - room.low[a] - 4 * m.scale) < 1e-4);
        synthetic_room_release(&r);
    }
}

/* The origin is straight below the central camera, x is the axis nearest to its right. */
static void the_frame_is_that_of_the_central_camera(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    m.world_from_room = turned(50);
    make_and_find(&room, &r, &m);
    assert_int_equal(room.central, 0); /* the centre nearest to the mean of all */
    const struct vec3 c = model_from_world_point(&room.axes, r.views[0].center);
    assert_true(fabs(c.x) < 1e-9 && fabs(c.y) < 1e-9 && fabs(c.z - 1.5) < 1e-6);
    /* turned by 20 degrees from the room's x, right is nearest to the room's -y */
    const struct vec3 x =
        mat3_apply(mat3_transpose(m.world_from_room), world_from_model_direction(&room.axes, vec3_make(1, 0, 0)));
    assert_true(fabs(x.y + 1) < 1e-6);
    synthetic_room_release(&r);
}

/* Noise of 1 cm, normals off by 5 degrees, 10 % outliers, tables and chairs: as in real rooms. */
static void noise_outliers_and_furniture_change_the_result_little(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    m.noise = 0.01;
    m.normal_noise = 5;
    m.outliers = 0.1;
    m.furniture = 0.4;
    m.world_from_room = turned(23);
    make_and_find(&room, &r, &m);
    assert_true(room_angle(&r, &room.axes) < 0.02);
    assert_true(fabs(room_floor(&r, &room.axes)) < 0.001);
    assert_true(fabs(room.axes.ceiling - 2.6) < 0.001);
    /* the stated errors are of the size of the true ones */
    assert_true(room.axes.tilt_error > 0 && room.axes.tilt_error < 0.05);
    assert_true(room.axes.heading_error > 0 && room.axes.heading_error < 0.05);
    assert_true(room.axes.floor_error > 0 && room.axes.floor_error < 0.003);
    synthetic_room_release(&r);
}

/* Over many rooms with different noise, the ratio of true to stated errors is about 1. */
static void stated_errors_agree_with_true_errors(void **state)
{
    (void)state;
    enum { ROOMS = 12 };
    double tilt = 0, floor = 0;
    for (int i = 0; i < ROOMS; i++) {
        struct room_spec m = plain();
        struct synthetic_room r;
        struct room room;
        m.noise = 0.01;
        m.seed = (uint64_t)i;
        m.normal_noise = 3;
        m.world_from_room = turned(11.0 * i);
        make_and_find(&room, &r, &m);
        const struct vec3 up =
            mat3_apply(mat3_transpose(m.world_from_room), world_from_model_direction(&room.axes, vec3_make(0, 0, 1)));
        const double off = hypot(up.x, up.y) * 180 / M_PI / room.axes.tilt_error;
        tilt += off * off / ROOMS;
        const double f = room_floor(&r, &room.axes) / room.axes.floor_error;
        floor += f * f / ROOMS;
        synthetic_room_release(&r);
    }
    assert_true(sqrt(tilt) > 0.4 && sqrt(tilt) < 2);
    assert_true(sqrt(floor) > 0.4 && sqrt(floor) < 2);
}

static void a_room_may_have_no_ceiling(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    m.ceiling = 0;
    m.noise = 0.003;
    make_and_find(&room, &r, &m);
    assert_true(room.axes.ceiling == 0 && room.axes.ceiling_error == 0);
    assert_true(fabs(room_floor(&r, &room.axes)) < 0.001);
    synthetic_room_release(&r);
}

/* Beams below a ceiling with few points. */
static void the_ceiling_is_above_its_beams(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    m.ceiling = 0.15;
    m.noise = 0.003;
    synthetic_room_make(&r, &m);
    r.cloud.points = realloc(r.cloud.points, (ROOM_POINTS + 3000) * sizeof *r.cloud.points);
    assert_non_null(r.cloud.points);
    for (int i = 0; i < 3000; i++) add_room_point(&r, vec3_make(1 + i % 3, 4.0 * i / 3000, 2.44), vec3_make(0, 0, -1));
    find(&room, &r);
    assert_true(fabs(room.axes.ceiling - 2.6) < 0.002);
    synthetic_room_release(&r);
}

static void two_directions_are_enough(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    m.one_wall_direction = true;
    m.noise = 0.005;
    m.normal_noise = 3;
    m.world_from_room = turned(70);
    make_and_find(&room, &r, &m);
    assert_true(room_angle(&r, &room.axes) < 0.05);
    assert_true(fabs(room_floor(&r, &room.axes)) < 0.001);
    synthetic_room_release(&r);
}

/* Tables have more upward normals than the floor, but at several heights. */
static void tables_do_not_become_the_floor(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    m.furniture = 0.6;
    m.noise = 0.003;
    make_and_find(&room, &r, &m);
    assert_true(fabs(room_floor(&r, &room.axes)) < 0.001);
    synthetic_room_release(&r);
}

/* It has 1.7 times as many points as the floor. */
static void a_bed_does_not_become_the_floor(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    m.furniture = 0.65;
    m.bed = true;
    m.noise = 0.003;
    make_and_find(&room, &r, &m);
    assert_true(fabs(room_floor(&r, &room.axes)) < 0.001);
    synthetic_room_release(&r);
}

static void a_ball_has_no_axes(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    const struct rng rng = rng_make(5, "test", "ball");
    synthetic_room_make(&r, &m);
    for (uint64_t i = 0; i < r.cloud.count; i++) { /* the inside of a ball */
        const struct vec3 d = room_direction(&rng, i, 0);
        struct cloud_point *p = &r.cloud.points[i];
        p->position = vec3_scale(d, 3);
        cloud_set_normal(p, vec3_scale(d, -1));
    }
    assert_refused(&r, "no two perpendicular directions have enough");
    r.cloud.count = 0;
    assert_refused(&r, "there are no points");
    synthetic_room_release(&r);
}

static void a_room_without_floor_is_an_error(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    synthetic_room_make(&r, &m);
    size_t kept = 0;
    for (size_t i = 0; i < r.cloud.count; i++)
        if (!(r.cloud.points[i].normal[2] > 0.5F)) r.cloud.points[kept++] = r.cloud.points[i];
    r.cloud.count = kept;
    assert_refused(&r, "no floor was found");
    synthetic_room_release(&r);
}

/* Points say 2.6; straight edges, 2.65. */
static void the_ceiling_is_that_of_the_smaller_error(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    struct frame_heading headings[2] = {{.along = {1, 0, 0}, .error = 1e-3, .share = 0.2},
                                        {.along = {0, 1, 0}, .error = 1e-3, .share = 0.2}};
    m.noise = 0.03;
    synthetic_room_make(&r, &m);
    for (int sure = 0; sure < 2; sure++) {
        const struct room_frame frame = {.known = true,
                                         .up = {0, 0, 1},
                                         .up_error = 1e-3,
                                         .headings = headings,
                                         .heading_count = 2,
                                         .ceiling = {true, 2.65, sure ? 1e-6 : 0.2}};
        struct room_inputs in = room_inputs(&r);
        struct err err = ERR_INIT;
        in.frame = &frame;
        assert_ok(room_find(&room, &in, &PARAMS, &err), err);
        assert_true(fabs(room.axes.ceiling - (sure ? 2.65 : 2.6)) < 0.01);
    }
    synthetic_room_release(&r);
}

/* Photographs that are stored rotated. */
static void records_of_rotated_photos_give_the_up_direction(void **state)
{
    (void)state;
    struct room_spec m = plain();
    struct synthetic_room r;
    struct room room;
    synthetic_room_make(&r, &m);
    for (int i = 0; i < ROOM_VIEWS; i++) { /* a quarter turn about the camera's axis: up becomes left */
        static const struct mat3 quarter = {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
        r.views[i].cam_from_world = mat3_multiply(quarter, r.views[i].cam_from_world);
        r.views[i].translation = mat3_apply(quarter, r.views[i].translation);
        r.ups[i] = vec3_make(-1, 0, 0);
    }
    find(&room, &r);
    assert_true(room_angle(&r, &room.axes) < 1e-5);
    const struct vec3 x = world_from_model_direction(&room.axes, vec3_make(1, 0, 0));
    assert_true(fabs(x.y + 1) < 1e-6);
    synthetic_room_release(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_perfect_room_is_found_to_rounding),
        cmocka_unit_test(the_frame_is_that_of_the_central_camera),
        cmocka_unit_test(noise_outliers_and_furniture_change_the_result_little),
        cmocka_unit_test(stated_errors_agree_with_true_errors),
        cmocka_unit_test(a_room_may_have_no_ceiling),
        cmocka_unit_test(the_ceiling_is_above_its_beams),
        cmocka_unit_test(the_ceiling_is_that_of_the_smaller_error),
        cmocka_unit_test(two_directions_are_enough),
        cmocka_unit_test(tables_do_not_become_the_floor),
        cmocka_unit_test(a_bed_does_not_become_the_floor),
        cmocka_unit_test(a_ball_has_no_axes),
        cmocka_unit_test(a_room_without_floor_is_an_error),
        cmocka_unit_test(records_of_rotated_photos_give_the_up_direction),
    };
    return cmocka_run_group_tests_name("room", tests, NULL, NULL);
}
