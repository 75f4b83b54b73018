/* outdoors_turn.c - an image taken in a window is turned by what made-up views show of the houses outside. */
#include "stages/hdr_merge/outdoors_turn.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/capture/view_image.h"
#include "common/light/value_noise.h"
#include "common/math/numbers.h"
#include "common/math/rotation_fit.h"
#include "common/model/model_axes.h"
#include "stages/hdr_merge/opening_sight.h"
#include "tests/unit/scratch.h"

/* A room with a window in its southern wall; a second room behind an inner wall with a door. */
static const char plan_text[] =
    "remodel-plan 2\n"
    "wall south normal 0 1 at 0.15 thickness 0.3 from 0 to 8.8 foot 0 top 2.7 start free end free\n"
    "wall inner normal -1 0 at -5 thickness 0.2 from 0 to 4.2 foot 0 top 2.7 start free end free\n"
    "wall slanted normal 0.6 0.8 at -3 thickness 0.3 from 0 to 4.2 foot 0 top 2.7 start free end free\n"
    "window sunny on south from 1.4 0.75 to 3.4 2.25 closed\n"
    "passage door on inner from 1.5 0 to 2.4 2.1 open\n"
    "window far on slanted from 1.5 0.95 to 2.4 2.15 closed\n";

static const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1, .metric = true};
static const struct vec3 place = {2.4, -0.15, 1.5};
enum { VIEWS = 3, WIDTH = 240, HEIGHT = 200, LENS_WIDTH = 300, LENS_HEIGHT = 200 };

/* ------------------------------------------------------------------------------------------------------ the houses */

/* A grid of windows of random brightness. */
static double facade(uint32_t seed, double x, double y)
{
    const int i = (int)floor(x), j = (int)floor(y);
    const bool pane = x - i > 0.25 && y - j > 0.3;
    return pane ? 4 + 16 * noise_unit(noise_hash(seed, i, j), 0) : 12;
}

/* What is seen outdoors: a house at y = -20, a row of houses at y = -40, the ground, the sky. */
static double outdoors(struct vec3 from, struct vec3 d)
{
    for (int k = 0; k < 2; k++) {
        const double t = ((k ? -40 : -20) - from.y) / d.y, x = from.x + t * d.x, z = from.z + t * d.z;
        if (d.y < 0 && (k ? z < 9 + facade(9, x / 6, 0) / 4 : x > 6 && z < 7) && z > 0)
            return facade((uint32_t)k, x / 1.1, z / 1.1);
    }
    if (d.z < 0) return 6 + 3 * noise_value(7, (from.x - d.x / d.z * from.z) / 2, (from.y - d.y / d.z * from.z) / 2);
    return 25;
}

static bool is_in_window(struct vec3 from, struct vec3 d)
{
    bool passes = true;
    for (int face = 0; face < 2; face++) {
        const double t = ((face ? -0.15 : 0.15) - from.y) / d.y, x = from.x + t * d.x, z = from.z + t * d.z;
        passes &= t > 0 && x > 1.4 && x < 3.4 && z > 0.75 && z < 2.25;
    }
    return passes;
}

static struct mat3 southwards(void) { return (struct mat3){{{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}}}; }

static void write_view(struct sfm_model *m, int k, struct vec3 at, struct vec3 turn)
{
    static char names[VIEWS][8];
    const struct mat3 r = rotation_turn(southwards(), turn);
    const struct vec3 t = vec3_scale(mat3_apply(r, at), -1);
    snprintf(names[k], sizeof names[k], "v%d.exr", k);
    m->images[k] = (struct sfm_image){.id = k + 1, .cam_from_world = {quat_from_mat3(r), t}, .name = names[k]};
    const struct view view = {names[k], WIDTH, HEIGHT, 200, 200, WIDTH / 2.0, HEIGHT / 2.0, r, t, at};
    struct image im = {0};
    struct err err = ERR_INIT;
    char path[32];
    assert_ok(image_init(&im, WIDTH, HEIGHT, 4, &err), err);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const struct vec3 d = vec3_sub(view_unproject(&view, x + 0.5, y + 0.5, 1), at);
            float *p = image_at(&im, x, y);
            p[0] = p[1] = p[2] = (float)(is_in_window(at, d) ? outdoors(at, d) : 0.3);
            p[3] = 1;
        }
    snprintf(path, sizeof path, "v%d.exr", k);
    assert_ok(view_image_write(&im, NULL, scratch_path(path), &view, NULL, "exact", &err), err);
    image_release(&im);
}

static void write_scene(void)
{
    struct sfm_camera camera = {1, {CAMERA_PINHOLE, WIDTH, HEIGHT, {200, 200, WIDTH / 2.0, HEIGHT / 2.0}}};
    struct sfm_image images[VIEWS];
    struct sfm_model m = {&camera, images, NULL, 1, VIEWS, 0};
    struct err err = ERR_INIT;
    write_view(&m, 0, vec3_make(1.2, 2.4, 1.4), vec3_make(0, 0, 0.3));
    write_view(&m, 1, vec3_make(3.2, 3.0, 1.5), vec3_make(0.05, 0, -0.1));
    write_view(&m, 2, vec3_make(2.3, 1.4, 1.6), vec3_make(-0.05, 0.02, 0));
    assert_ok(sfm_model_write_text(&m, scratch, NULL, &err), err);
    assert_ok(model_axes_write(&axes, scratch_path("axes.txt"), NULL, &err), err);
    scratch_write("plan.txt", plan_text);
}

/* -------------------------------------------------------------------------------------------------------- the tests */

static struct mat3 truth(void) { return rotation_turn(southwards(), vec3_make(0.06, -0.08, 0.1)); }

/* What the camera shows; blank: the sky alone. */
static struct image photograph(const struct camera *lens, bool blank)
{
    struct image im = {0};
    struct err err = ERR_INIT;
    assert_ok(image_init(&im, LENS_WIDTH, LENS_HEIGHT, 3, &err), err);
    for (int y = 0; y < LENS_HEIGHT; y++)
        for (int x = 0; x < LENS_WIDTH; x++) {
            struct vec3 ray;
            float *p = image_at(&im, x, y);
            assert_true(camera_unproject(lens, x + 0.5, y + 0.5, &ray));
            p[0] = p[1] = p[2] = (float)(blank ? 25 : outdoors(place, mat3_apply(mat3_transpose(truth()), ray)));
        }
    return im;
}

static struct outdoors_turn turn(struct pose *pose, bool blank, int opening)
{
    static char paths[2][FILE_PATH];
    const struct merge_params params = MERGE_PARAMS_DEFAULT;
    const struct camera lens = camera_equisolid(LENS_WIDTH, LENS_HEIGHT, 120, LENS_WIDTH / 2.0, LENS_HEIGHT / 2.0);
    struct image im = photograph(&lens, blank);
    snprintf(paths[0], sizeof paths[0], "%s", scratch_path("axes.txt"));
    snprintf(paths[1], sizeof paths[1], "%s", scratch_path("plan.txt"));
    const struct reference_frame frame = {.axes = paths[0], .plan = paths[1], .outdoors = scratch};
    const struct outdoors_image image = {"sky", &im, &lens, opening, true};
    struct outdoors_turn t;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    *pose = (struct pose){quat_from_mat3(southwards()), vec3_scale(mat3_apply(southwards(), place), -1)};
    assert_ok(outdoors_turn_find(&t, pose, &image, &frame, &params, &prov, &err), err);
    provenance_release(&prov);
    image_release(&im);
    return t;
}

static double degrees_off(const struct pose *pose)
{
    return quat_angle(pose->rotation, quat_from_mat3(truth())) / DEGREE;
}

static void houses_turn_an_image(void **state)
{
    struct pose pose, again;
    (void)state;
    const struct outdoors_turn t = turn(&pose, false, 0);
    print_message("# %d matches, %d agree, off %.3f, stated %.3f\n", t.found.sights, t.found.agree, degrees_off(&pose),
                  t.found.error);
    assert_int_equal(t.views, VIEWS);
    assert_int_equal(t.found.verdict, OUTDOORS_TURNED);
    assert_float_equal(t.found.turned, vec3_length(vec3_make(0.06, -0.08, 0.1)) / DEGREE, 0.2);
    assert_true(degrees_off(&pose) < 0.2 && degrees_off(&pose) < 2.5 * t.found.error);
    assert_true(vec3_length(vec3_sub(pose_center(&pose), place)) < 1e-9);
    parallel_set_threads(1);
    turn(&again, false, 0);
    parallel_set_threads(0);
    assert_memory_equal(&again, &pose, sizeof pose);
}

static void a_blank_sky_leaves_the_rotation(void **state)
{
    struct pose pose;
    (void)state;
    const struct outdoors_turn t = turn(&pose, true, 0);
    assert_int_equal(t.found.verdict, OUTDOORS_FEW);
    assert_true(t.views == VIEWS && t.found.sights < t.found.wanted);
    assert_true(quat_angle(pose.rotation, quat_from_mat3(southwards())) < 1e-7);
}

static void an_opening_that_no_view_shows_leaves_the_rotation(void **state)
{
    struct pose pose;
    (void)state;
    const struct outdoors_turn door = turn(&pose, false, 1), slanted = turn(&pose, false, 2);
    assert_int_equal(door.views + slanted.views, 0);
    assert_int_equal(door.found.verdict, OUTDOORS_FEW);
    assert_true(quat_angle(pose.rotation, quat_from_mat3(southwards())) < 1e-7);
}

/* Rays from both rooms to the window. */
static void walls_hide_what_is_outdoors(void **state)
{
    struct model_plan plan = {0};
    struct opening_sight s, none;
    struct err err = ERR_INIT;
    const struct vec3 in = {2.4, 2, 1.5}, next = {6.4, 3.3, 1.5}, middle = {2.4, 0, 1.5};
    (void)state;
    assert_ok(model_plan_read(&plan, scratch_path("plan.txt"), NULL, &err), err);
    assert_true(opening_sight_init(&s, &plan, 0) && !opening_sight_init(&none, &plan, 2));
    assert_float_equal(opening_sight_diagonal(&s), 2.5, 1e-12);
    assert_true(opening_sight_passes(&s, in, vec3_sub(middle, in)));
    assert_false(opening_sight_passes(&s, in, vec3_sub(in, middle)));       /* away from it */
    assert_false(opening_sight_passes(&s, in, vec3_make(-0.99, -1.84, 0))); /* stopped by the reveal */
    assert_true(opening_sight_passes(&s, in, vec3_make(-0.6, -1.84, 0)));
    assert_true(opening_sight_passes(&s, next, vec3_sub(middle, next)));                      /* through the door */
    assert_false(opening_sight_passes(&s, vec3_make(6.4, 1.5, 1.5), vec3_make(-4, -1.5, 0))); /* beside the door */
    assert_false(opening_sight_passes(&s, vec3_make(2.4, -2, 1.5), vec3_make(0, 1, 0)));      /* from outside */
    model_plan_release(&plan);
}

static int make_scene(void **state)
{
    if (scratch_make(state)) return -1;
    write_scene();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(houses_turn_an_image),
        cmocka_unit_test(a_blank_sky_leaves_the_rotation),
        cmocka_unit_test(an_opening_that_no_view_shows_leaves_the_rotation),
        cmocka_unit_test(walls_hide_what_is_outdoors),
    };
    return cmocka_run_group_tests_name("outdoors_turn", tests, make_scene, scratch_remove);
}
