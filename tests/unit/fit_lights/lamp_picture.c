/* lamp_picture.c, cone_edge.c - the edge of a cone on a floor is a circle or an ellipse known in closed form; where
 * something stands in its way it breaks; pictures show it where it is, from the views that see it. */
#include "stages/fit_lights/lamp_picture.h"

#include <math.h>

#include "common/capture/view_image.h"
#include "common/image/photo.h"
#include "common/math/numbers.h"
#include "tests/unit/box_solids.h"

enum { SIDE = 240 };

static const struct box room_boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
static char lamp_name[] = "spot 1/2";

static struct lamp spot(double beta)
{
    return (struct lamp){.name = lamp_name,
                         .shape = LAMP_DISK,
                         .centre = {0.1, -0.2, 2},
                         .normal = {0, 0, -1},
                         .x = {0.15, 0, 0},
                         .y = {0, 0.15, 0},
                         .radius = 0.15,
                         .radiance = {1, 1, 1},
                         .beta = beta};
}

static void straight_over_a_floor_the_edge_is_a_circle(void **state)
{
    struct model_rays m = make_rays(room_boxes, 2);
    const struct lamp l = spot(20 * DEGREE);
    static struct curve c;
    (void)state;
    cone_edge_find(&c, &l, &m);
    assert_int_equal(c.count, CURVE_POINTS);
    for (int i = 0; i < c.count; i++) {
        assert_float_equal(c.points[i].at.z, -2, 1e-9);
        assert_float_equal(hypot(c.points[i].at.x - 0.1, c.points[i].at.y + 0.2), 4 * tan(20 * DEGREE), 1e-4);
        assert_true(c.points[i].joins);
    }
    model_rays_release(&m);
}

/* The extreme points of the ellipse on its long axis are at h tan(tilt -+ beta). */
static void a_tilted_lamp_gives_an_ellipse(void **state)
{
    struct model_rays m = make_rays(room_boxes, 2);
    const double tilt = 10 * DEGREE, beta = 12 * DEGREE;
    struct lamp l = spot(beta);
    static struct curve c;
    double low = 9, high = -9;
    (void)state;
    l.centre = vec3_make(0, 0, 1.9);
    l.normal = vec3_make(sin(tilt), 0, -cos(tilt));
    cone_edge_find(&c, &l, &m);
    assert_int_equal(c.count, CURVE_POINTS);
    for (int i = 0; i < c.count; i++) {
        const struct vec3 p = c.points[i].at;
        low = fmin(low, p.x), high = fmax(high, p.x);
        assert_float_equal(vec3_dot(vec3_normalize(vec3_sub(p, l.centre)), l.normal), cos(beta), 1e-5);
    }
    assert_float_equal(low, 3.9 * tan(tilt - beta), 1e-3);
    assert_float_equal(high, 3.9 * tan(tilt + beta), 1e-3);
    model_rays_release(&m);
}

static void a_wide_cone_bends_up_the_walls_in_one_piece(void **state)
{
    struct model_rays m = make_rays(room_boxes, 2);
    const struct lamp l = spot(45 * DEGREE);
    static struct curve c;
    int on_walls = 0;
    (void)state;
    cone_edge_find(&c, &l, &m);
    assert_int_equal(c.count, CURVE_POINTS);
    for (int i = 0; i < c.count; i++) {
        on_walls += c.points[i].at.z > -1.99;
        assert_true(c.points[i].joins);
    }
    assert_true(on_walls > CURVE_POINTS / 2);
    model_rays_release(&m);
}

static void a_cone_without_an_edge_has_no_curve(void **state)
{
    struct model_rays m = make_rays(room_boxes, 2);
    const struct lamp l = spot(90 * DEGREE);
    static struct curve c;
    (void)state;
    cone_edge_find(&c, &l, &m);
    assert_int_equal(c.count, 0);
    model_rays_release(&m);
}

static void a_table_breaks_the_curve(void **state)
{
    static const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"table", "table", {0.5, -3, -1}, {1.9, 3, -0.9}, 0}};
    struct model_rays m = make_rays(boxes, 3);
    const struct lamp l = spot(20 * DEGREE);
    static struct curve c;
    int gaps = 0;
    (void)state;
    cone_edge_find(&c, &l, &m);
    for (int i = 0; i < c.count; i++) gaps += !c.points[i].joins;
    assert_int_equal(gaps, 2);
    model_rays_release(&m);
}

static void an_outline_goes_around_its_lamp(void **state)
{
    static struct curve c;
    struct lamp l = spot(1);
    double length = 0;
    (void)state;
    cone_outline(&c, &l);
    for (int i = 0; i < c.count; i++) assert_float_equal(vec3_length(vec3_sub(c.points[i].at, l.centre)), 0.15, 1e-12);
    l.shape = LAMP_QUAD;
    cone_outline(&c, &l);
    for (int i = 0; i < c.count; i++) length += vec3_length(vec3_sub(c.points[(i + 1) % c.count].at, c.points[i].at));
    assert_float_equal(length, 8 * 0.15, 0.02);
}

/* From z = 1 the circle has a radius of f r / 3 pixels. */
static void a_view_shows_the_projected_circle(void **state)
{
    struct model_rays m = make_rays(room_boxes, 2);
    const struct lamp l = spot(20 * DEGREE);
    static struct curve c;
    (void)state;
    cone_edge_find(&c, &l, &m);
    const struct view down = view_at(vec3_make(0, 0, 1), PI, 0, SIDE, SIDE, 150);
    const struct view up = view_at(vec3_make(0, 0, 1), 0, 0, SIDE, SIDE, 150);
    const double radius = 150 * 4 * tan(20 * DEGREE) / 3;
    assert_float_equal(lamp_curve_draw(NULL, &c, &down, &m, 0, NULL), 2 * PI * radius / SIDE, 1e-3);
    assert_float_equal(lamp_curve_draw(NULL, &c, &up, &m, 0, NULL), 0, 0);
    model_rays_release(&m);
}

static void what_the_model_hides_is_not_drawn(void **state)
{
    static const struct box boxes[] = {
        ROOM_OUTSIDE, ROOM_INSIDE, {"board", "board", {-1.9, -1.9, 0.4}, {0.1, 1.9, 0.5}, 0}};
    struct model_rays bare = make_rays(room_boxes, 2), m = make_rays(boxes, 3);
    const struct lamp l = spot(20 * DEGREE);
    static struct curve c;
    (void)state;
    cone_edge_find(&c, &l, &bare);
    const struct view down = view_at(vec3_make(0.1, 0, 1), PI, 0, SIDE, SIDE, 150);
    const double whole = lamp_curve_draw(NULL, &c, &down, &bare, 0, NULL),
                 half = lamp_curve_draw(NULL, &c, &down, &m, 0, NULL);
    assert_float_equal(half / whole, 0.5, 0.01); /* the board covers one side of the camera's axis */
    model_rays_release(&bare);
    model_rays_release(&m);
}

/* A grey picture of the floor and one of the ceiling. */
static void write_view(const struct view *v)
{
    const struct provenance prov = {.stage = "test", .version = "0"};
    struct image im = {0};
    struct err err = ERR_INIT;
    char path[300];
    assert_ok(image_init(&im, v->width, v->height, 4, &err), err);
    for (int i = 0; i < 4 * v->width * v->height; i++) im.data[i] = i % 4 == 3 ? 1 : 0.2f;
    snprintf(path, sizeof path, "%s.exr", v->name);
    assert_ok(view_image_write(&im, NULL, scratch_path(path), v, &prov, "exact", &err), err);
    image_release(&im);
}

static bool is_near(const struct photo *p, double x, double y, int r, int g, int b)
{
    const uint16_t *s = p->samples + 3 * ((ptrdiff_t)(int)y * p->info.width + (int)x);
    return abs(s[0] - r) < 60 && abs(s[1] - g) < 60 && abs(s[2] - b) < 60;
}

static void the_picture_shows_the_patch_and_beside_it_the_lamp(void **state)
{
    struct view views[2] = {view_at(vec3_make(0.1, -0.2, 1), PI, 0, SIDE, SIDE, 150),
                            view_at(vec3_make(0, 0, -1), 0, 0, SIDE, SIDE, 300)};
    struct lamp l = spot(20 * DEGREE);
    struct lit_point points[2] = {{{0.1, -0.2, -2}, {0, 0, 1}, 0, 0, 0, NOTE_LIT, 0},
                                  {{1.8, -0.2, -2}, {0, 0, 1}, 0, 1, 1, NOTE_UNLIT, 0}};
    const struct lit_scene scene = {.lights = {.lamps = &l, .lamp_count = 1}, .points = points, .point_count = 2};
    struct lit_model model = {
        .in = {.axes = {.rotation = {1, 0, 0, 0}, .scale = 1}, .set = {.views = views, .view_count = 2}}};
    struct photo p = {0};
    struct err err = ERR_INIT;
    char floor[] = "floor", ceiling[] = "ceiling";
    double x, y;
    (void)state;
    views[0].name = floor, views[1].name = ceiling;
    write_view(&views[0]);
    write_view(&views[1]);
    model.rays = make_rays(room_boxes, 2);
    assert_ok(lamp_pictures_write(&scene, &model, scratch, scratch, &err), err);
    assert_ok(photo_read(&p, scratch_path("spot%201%2F2.jpg"), &err), err);
    assert_int_equal(p.info.width, 2 * SIDE + 8);
    assert_true(view_project(&views[0], vec3_make(0.1 + 4 * tan(20 * DEGREE), -0.2, -2), &x, &y) > 0);
    assert_true(is_near(&p, x, y, 255, 140, 0));
    assert_true(view_project(&views[0], points[0].at, &x, &y) > 0);
    assert_true(is_near(&p, x, y, 255, 235, 60));
    assert_true(view_project(&views[1], vec3_make(0.25, -0.2, 2), &x, &y) > 0);
    assert_true(is_near(&p, x + SIDE + 8, y, 90, 255, 120));
    photo_release(&p);

    model.in.set.view_count = 0; /* nothing shows it any more: the old picture goes */
    assert_ok(lamp_pictures_write(&scene, &model, scratch, scratch, &err), err);
    assert_int_not_equal(access(scratch_path("spot%201%2F2.jpg"), F_OK), 0);
    model_rays_release(&model.rays);
}

static void long_names_of_lamps_become_numbers(void **state)
{
    char name[LAMP_FILE_NAME], text[256];
    struct lamp lamps[2] = {spot(1), spot(1)};
    const struct light_list list = {.lamps = lamps, .lamp_count = 2};
    (void)state;
    memset(text, 'a', sizeof text);
    text[255] = '\0';
    lamps[1].name = text;
    light_list_lamp_file(name, &list, 0);
    assert_string_equal(name, "spot%201%2F2");
    light_list_lamp_file(name, &list, 1);
    assert_string_equal(name, "lamp2");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(straight_over_a_floor_the_edge_is_a_circle),
        cmocka_unit_test(a_tilted_lamp_gives_an_ellipse),
        cmocka_unit_test(a_wide_cone_bends_up_the_walls_in_one_piece),
        cmocka_unit_test(a_cone_without_an_edge_has_no_curve),
        cmocka_unit_test(a_table_breaks_the_curve),
        cmocka_unit_test(an_outline_goes_around_its_lamp),
        cmocka_unit_test(a_view_shows_the_projected_circle),
        cmocka_unit_test(what_the_model_hides_is_not_drawn),
        cmocka_unit_test_setup_teardown(the_picture_shows_the_patch_and_beside_it_the_lamp, scratch_make,
                                        scratch_remove),
        cmocka_unit_test(long_names_of_lamps_become_numbers),
    };
    return cmocka_run_group_tests_name("lamp_picture", tests, NULL, NULL);
}
