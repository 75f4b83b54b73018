/* axes_pictures.c - the room's outline and the axes are drawn in the right pixels, on the right views. */
#include "stages/find_axes/axes_pictures.h"

#include "tests/unit/find_axes/synthetic_room.h"
#include "tests/unit/scratch.h"

static const struct axes_params PARAMS = AXES_PARAMS_DEFAULT;

static struct room_spec plain_room(void)
{
    return (struct room_spec){.ceiling = 1, .world_from_room = ROOM_IDENTITY, .scale = 1};
}

/* A found room and a black picture. */
struct drawing {
    struct synthetic_room r;
    struct room room;
    unsigned char *pixels;
};

static void set_up(struct drawing *d)
{
    const struct room_spec m = plain_room();
    struct err err = ERR_INIT;
    synthetic_room_make(&d->r, &m);
    const struct room_inputs in = room_inputs(&d->r);
    assert_ok(room_find(&d->room, &in, &PARAMS, &err), err);
    d->pixels = calloc(3, 800 * 600);
    assert_non_null(d->pixels);
}

static void tear_down(struct drawing *d)
{
    free(d->pixels);
    synthetic_room_release(&d->r);
}

/* The pixel of a point of the room. */
static const unsigned char *at(const struct drawing *d, double x, double y, double z)
{
    double u, v;
    room_pixel(&d->r, 0, vec3_make(x, y, z), &u, &v);
    assert_true(u > 1 && v > 1 && u < 799 && v < 599);
    return d->pixels + 3 * ((int)v * 800 + (int)u);
}

static void outlines_and_arrows_are_in_the_right_pixels(void **state)
{
    (void)state;
    struct drawing d;
    set_up(&d);
    const struct vec3 corner = {4, 2.5, 0};
    pictures_draw_room(d.pixels, &d.r.views[0], &d.room, &corner, 1);
    const unsigned char *p = at(&d, 5, 2.8, 0); /* between wall and floor */
    assert_true(p[0] > 200 && p[1] > 150 && p[2] < 100);
    p = at(&d, 5, 2.5, 2.6); /* between wall and ceiling */
    assert_true(p[0] < 100 && p[1] > 150 && p[2] > 150);
    p = at(&d, 4, 2.5, 0.3); /* the blue arrow on the corner */
    assert_true(p[2] > 200 && p[0] < 100);
    p = at(&d, 5, 2, 1.3); /* the middle of a wall */
    assert_true(p[0] == 0 && p[1] == 0 && p[2] == 0);
    tear_down(&d);
}

/* Cameras on the floor's outline and far behind everything: lines are clipped, and nothing is written outside the
 * picture (checked by the sanitizers). */
static void cameras_at_any_position_draw_inside_the_picture(void **state)
{
    (void)state;
    struct drawing d;
    set_up(&d);
    static const double places[][3] = {{0, 0, 0}, {5, 2, 0}, {2, 2, 0}, {-50, 2, 1}, {2, 2, 2.6}, {1e6, 1e6, 1e6}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        for (int k = 0; k < ROOM_VIEWS; k++) {
            struct view v = d.r.views[k];
            v.center = vec3_make(places[i][0], places[i][1], places[i][2]);
            v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
            pictures_draw_room(d.pixels, &v, &d.room, NULL, 0);
        }
    tear_down(&d);
}

static void views_are_chosen_evenly(void **state)
{
    (void)state;
    const struct room_spec m = plain_room();
    struct synthetic_room r;
    synthetic_room_make(&r, &m);
    const struct room_inputs in = room_inputs(&r);
    for (int count = 0; count <= 6; count++) {
        bool chosen[ROOM_VIEWS] = {false};
        struct err err = ERR_INIT;
        int sum = 0;
        assert_ok(pictures_choose(chosen, count, &in, &err), err);
        for (int i = 0; i < ROOM_VIEWS; i++) sum += chosen[i];
        assert_int_equal(sum, count < ROOM_VIEWS ? count : ROOM_VIEWS);
        if (count == 2) assert_true(chosen[0] && chosen[2]);
    }
    synthetic_room_release(&r);
}

static void a_black_picture_stays_black(void **state)
{
    (void)state;
    struct image im = {0};
    struct err err = ERR_INIT;
    unsigned char pixels[12];
    assert_ok(image_init(&im, 2, 2, 4, &err), err);
    assert_ok(pictures_expose(pixels, &im, &err), err);
    for (int i = 0; i < 12; i++) assert_int_equal(pixels[i], 0);
    for (int i = 0; i < 16; i++) im.data[i] = i % 4 == 3 ? 1 : 1e6F; /* however bright */
    assert_ok(pictures_expose(pixels, &im, &err), err);
    for (int i = 0; i < 12; i++) assert_int_equal(pixels[i], 255);
    image_release(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outlines_and_arrows_are_in_the_right_pixels),
        cmocka_unit_test(cameras_at_any_position_draw_inside_the_picture),
        cmocka_unit_test(views_are_chosen_evenly),
        cmocka_unit_test(a_black_picture_stays_black),
    };
    return cmocka_run_group_tests_name("pictures", tests, NULL, NULL);
}
