/* Furniture in an original view: a pixel is lit where its own depth says that something stands before the model. */
#include "tests/unit/relight/relit_room.h"

#include "common/layers/layered_depth.h"
#include "common/texture/view_ids.h"

/* The depth of the model at each pixel, panes included; 0: none. */
static void model_depth(float z[PIXELS], const struct relit_room *r, struct vec3 from, struct quat turn)
{
    const struct model_rays *m = &r->change.before.model;
    const struct mat3 model_from_cam = mat3_transpose(mat3_from_quat(turn));
    for (int i = 0; i < PIXELS; i++) {
        struct vec3 ray;
        struct ray_hit hit;
        assert_true(camera_unproject(&r->picture.lens, i % WIDTH + 0.5, i / WIDTH + 0.5, &ray));
        const struct vec3 way = mat3_apply(model_from_cam, ray);
        double t = ray_scene_hit(&m->rays, from, way, &hit) ? hit.t : 0;
        const double to_pane = (2 - from.y) / way.y; /* of window_room, where rays pass its pane */
        if (!(t > 0) && way.y > 0) t = to_pane;
        z[i] = (float)(t * ray.z);
    }
}

/* Finds the pixels of a view that says everywhere that furniture stands before the model, and whose own depth is `part`
 * of the model's; `odd` at the pixel `at` alone. */
static void find_view(struct relit_room *r, struct edit *e, struct vec3 from, struct quat turn, double part, int at,
                      double odd)
{
    static const struct provenance no_inputs = {.stage = "test", .version = "1"};
    const struct mat3 rotation = mat3_from_quat(turn);
    struct view v = {.name = (char *)"v", .width = WIDTH, .height = HEIGHT, .fx = 14, .fy = 14};
    struct layered_depth depth = {0};
    struct view_ids ids = {0};
    struct err err = ERR_INIT;
    float z[PIXELS];
    v.cx = WIDTH / 2.0, v.cy = HEIGHT / 2.0;
    v.cam_from_world = rotation, v.center = from, v.translation = vec3_scale(mat3_apply(rotation, from), -1);
    *r = (struct relit_room){.params = RELIGHT_PARAMS_DEFAULT};
    edit_read(&r->change, e);
    draw_picture(r, from, turn, e->colours);
    model_depth(z, r, from, turn);
    mkdir(scratch_path("depth"), 0777);
    mkdir(scratch_path("ids"), 0777);
    assert_ok(layered_depth_init(&depth, WIDTH, HEIGHT, &err), err);
    assert_ok(view_ids_init(&ids, WIDTH, HEIGHT, &err), err);
    depth.segments = calloc(1, sizeof *depth.segments);
    assert_non_null(depth.segments);
    depth.segment_count = 1;
    depth.segments[0] =
        (struct depth_segment){.id = 1, .plane = {0, 0, 0.5}, .sigma = 0.002, .confidence = 1, .pixels = PIXELS};
    for (int i = 0; i < PIXELS; i++) {
        r->picture.made[i] = MADE_PHOTO;
        ids.id[i] = z[i] > 0;
        ids.z[i] = z[i];
        ids.clutter[i] = 1;
        depth.interior.id[i] = 1;
        depth.interior.z[i] = z[i] > 0 ? z[i] * (float)(i == at ? odd : part) : 1;
        for (int c = 0; c < 4; c++) depth.interior.rgba[4 * i + c] = 1;
    }
    assert_ok(layered_depth_write(&depth, &v, scratch_path("depth/v.exr"), &no_inputs, &err), err);
    assert_ok(view_ids_write(&ids, &v, scratch_path("ids/v.exr"), &no_inputs, &err), err);
    layered_depth_release(&depth);
    view_ids_release(&ids);
    const struct pixel_layers layers = {keep_path("ids"), keep_path("depth"), &v};
    assert_ok(pixels_find(&r->pixels, &r->change, &r->picture, &layers, NULL, &err), err);
}

static int count_kind(const struct relit_room *r, enum pixel_kind kind)
{
    int count = 0;
    for (int i = 0; i < PIXELS; i++) count += r->pixels.kind[i] == kind;
    return count;
}

static void what_stands_before_the_model_is_furniture(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct relit_room r;
    (void)state;
    find_view(&r, &e, vec3_make(0.1, 0.2, 1), to_floor, 0.75, -1, 0);
    assert_int_equal(count_kind(&r, PIXEL_CLUTTER), PIXELS);
    for (int i = 0; i < PIXELS; i++) /* three quarters of the way from the camera to a wall */
        assert_true(fabs(r.pixels.before[i].at.x) < 1.6 && fabs(r.pixels.before[i].at.y) < 1.6);
    relit_room_release(&r);
}

/* The rim of clutter: where it shows a wall, estimated a little behind the model, the wall counts. */
static void a_rim_of_furniture_that_shows_the_wall_is_the_wall(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct relit_room r;
    (void)state;
    find_view(&r, &e, vec3_make(0.1, 0.2, 1), to_floor, 1.1, WIDTH * 3 + 3, 0.75);
    for (int i = 0; i < PIXELS; i++)
        assert_int_equal(r.pixels.kind[i], i == WIDTH * 3 + 3 ? PIXEL_CLUTTER : PIXEL_TEXTURE);
    relit_room_release(&r);
}

/* The picture shows it before a wall that the edit adds, whatever its depth says: it is lit there, not behind it. */
static void what_is_drawn_before_a_new_wall_is_lit_on_this_side(void **state)
{
    struct edit e = {.before = closed_room,
                     .after = split_room,
                     .before_count = COUNT(closed_room),
                     .after_count = COUNT(split_room),
                     .colours = plain};
    struct relit_room r;
    int beyond = 0;
    (void)state;
    find_view(&r, &e, vec3_make(-1, 0.2, 1), to_floor, 0.9, -1, 0);
    assert_int_equal(count_kind(&r, PIXEL_CLUTTER), PIXELS);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(r.pixels.after[i].at.x < -0.2 + 1e-6);
        beyond += fabs(r.pixels.after[i].at.x + 0.2) < 1e-6;
    }
    assert_true(beyond > 100);
    relit_room_release(&r);
}

static struct edit edit_of_window_room(void)
{
    return (struct edit){.before = window_room,
                         .after = window_room,
                         .before_count = COUNT(window_room),
                         .after_count = COUNT(window_room),
                         .colours = plain,
                         .sky = 5};
}

static const struct vec3 below_window = {0.03, 1, -1};
enum { IN_WINDOW = WIDTH * (HEIGHT - 6) + WIDTH / 2 };

/* A curtain hangs 4 % before the pane, but for a spot where the depth says 20 %. */
static void a_curtain_at_a_pane_keeps_its_light_with_its_spots(void **state)
{
    struct edit e = edit_of_window_room();
    struct relit_room r;
    (void)state;
    find_view(&r, &e, below_window, to_ceiling, 0.96, IN_WINDOW, 0.8);
    assert_true(count_kind(&r, PIXEL_KEPT) > 100);
    assert_int_equal(r.pixels.kind[IN_WINDOW], PIXEL_KEPT);
    relit_room_release(&r);
}

static void what_stands_well_before_a_window_is_furniture(void **state)
{
    struct edit e = edit_of_window_room();
    struct relit_room r;
    (void)state;
    find_view(&r, &e, below_window, to_ceiling, 0.8, IN_WINDOW, 0.96);
    assert_int_equal(count_kind(&r, PIXEL_KEPT), 1);
    assert_int_equal(r.pixels.kind[IN_WINDOW], PIXEL_KEPT);
    relit_room_release(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_stands_before_the_model_is_furniture),
        cmocka_unit_test(a_rim_of_furniture_that_shows_the_wall_is_the_wall),
        cmocka_unit_test(what_is_drawn_before_a_new_wall_is_lit_on_this_side),
        cmocka_unit_test(a_curtain_at_a_pane_keeps_its_light_with_its_spots),
        cmocka_unit_test(what_stands_well_before_a_window_is_furniture),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
