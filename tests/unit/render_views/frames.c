/* frames.c - crop and scale of frames, and the files of rendered frames. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/image/exr.h"
#include "stages/render_views/frames.h"

#define W 48
#define H 32

struct scene {
    struct view view;
    struct camera_set set;
    struct layer_scene layers;
    struct camera_path path;
    struct effects effects; /* none */
    struct renderer renderer;
};

/* One view of a wall at depth 4, and a path that slides along it. */
static void scene_make(struct scene *s, int frames, const char *renderer)
{
    struct render_params params = RENDER_PARAMS_DEFAULT;
    struct layered_depth d;
    struct err err = ERR_INIT;

    memset(s, 0, sizeof *s);
    s->view = (struct view){.name = "wall", .width = W, .height = H, .fx = 40, .fy = 40, .cx = W / 2.0, .cy = H / 2.0};
    s->view.cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    s->set.views = &s->view;
    s->set.view_count = 1;
    assert_ok(layered_depth_init(&d, W, H, &err), err);
    d.segments = calloc(1, sizeof *d.segments);
    d.segment_count = 1;
    d.segments[0] = (struct depth_segment){.id = 1, .pixels = W * H, .plane = {0, 0, 0.25}, .sigma = 0.01};
    for (int i = 0; i < W * H; i++) {
        for (int k = 0; k < 3; k++) d.interior.rgba[4 * i + k] = (float)((i % W * (k + 1)) % 64) / 64;
        d.interior.rgba[4 * i + 3] = 1;
        d.interior.z[i] = 4;
        d.interior.id[i] = 1;
    }
    assert_ok(layer_scene_init(&s->layers, &s->set, &d, &err), err);
    assert_ok(camera_path_init(&s->path, "test", 30, frames, &err), err);
    for (int i = 0; i < frames; i++) {
        struct view *c = &s->path.frames[i].camera;
        const char *name = c->name;
        *c = s->view;
        c->name = name;
        c->center.x = 0.03 * i;
        c->translation.x = -0.03 * i;
    }
    snprintf(params.renderer, sizeof params.renderer, "%s", renderer);
    renderer_init(&s->renderer, &s->layers, &s->path, &s->effects, &params);
}

static void scene_drop(struct scene *s)
{
    renderer_release(&s->renderer);
    layer_scene_release(&s->layers);
    camera_path_release(&s->path);
}

static void frames_are_written_with_all_channels(void **state)
{
    const char *kind = *state;
    const struct provenance prov = {.stage = "render_views", .version = "0"};
    const bool wanted[4] = {true, false, false, true};
    struct scene s;
    struct exr_image im = {0};
    struct err err = ERR_INIT;

    scene_make(&s, 4, kind);
    assert_ok(frames_render(&s.path, wanted, &s.renderer, scratch_path("some"), &prov, &err), err);
    assert_int_equal(count_entries(scratch_path("some")), 2);
    assert_ok(exr_read(&im, scratch_path("some/0001.exr"), NULL, 0, &err), err);
    assert_int_equal(im.width, W);
    for (int i = 0; i < W * H; i++) { /* at the view itself, its photo */
        assert_true(exr_find(&im, "Z")->f[i] == 4);
        assert_true(exr_find(&im, "A")->f[i] == 1);
        assert_true(exr_find(&im, "G")->f[i] == (float)((i % W * 2) % 64) / 64);
    }
    assert_string_equal(exr_attribute(&im, "remodel:holes"), "0");
    assert_true(im.has_world_to_camera);
    exr_image_release(&im);

    assert_ok(exr_read(&im, scratch_path("some/0004.exr"), NULL, 0, &err), err);
    /* 0.09 to the right is 0.9 px: the last column is a hole, and filled */
    assert_true(fabs(atof(exr_attribute(&im, "remodel:holes")) - 1.0 / W) < 1e-6);
    assert_string_equal(exr_attribute(&im, "remodel:unfilled"), "0");
    exr_image_release(&im);
    scene_drop(&s);
}

static void any_split_and_thread_count_gives_the_same_bytes(void **state)
{
    const char *kind = *state;
    const struct provenance prov = {.stage = "render_views", .version = "0"};
    const bool all[3] = {true, true, true};
    const int threads = parallel_threads();
    struct scene s;
    struct err err = ERR_INIT;

    scene_make(&s, 3, kind);
    parallel_set_threads(2);
    assert_ok(frames_render(&s.path, all, &s.renderer, scratch_path("all"), &prov, &err), err);
    parallel_set_threads(1);
    for (int i = 2; i >= 0; i--) {
        bool one[3] = {false};
        one[i] = true;
        assert_ok(frames_render(&s.path, one, &s.renderer, scratch_path("split"), &prov, &err), err);
    }
    parallel_set_threads(threads);
    for (int i = 1; i <= 3; i++) {
        char a[HASH_TEXT], b[HASH_TEXT], name[32];
        snprintf(name, sizeof name, "all/%04d.exr", i);
        assert_ok(hash_file(a, scratch_path(name), &err), err);
        snprintf(name, sizeof name, "split/%04d.exr", i);
        assert_ok(hash_file(b, scratch_path(name), &err), err);
        assert_string_equal(a, b);
    }
    scene_drop(&s);
}

static void an_empty_frame_is_an_error(void **state)
{
    const char *kind = *state;
    const struct provenance prov = {.stage = "render_views", .version = "0"};
    const bool all[3] = {true, true, true};
    struct scene s;
    struct err err = ERR_INIT;

    scene_make(&s, 3, kind);
    s.path.frames[1].camera.translation.z = -8; /* behind the wall */
    s.path.frames[1].camera.center.z = 8;
    assert_int_equal(frames_render(&s.path, all, &s.renderer, scratch_path("empty"), &prov, &err), ST_DATA);
    assert_err(err, ST_DATA, "frame 2 ");
    assert_int_equal(count_entries(scratch_path("empty")), 1);
    scene_drop(&s);
}

static void each_camera_has_a_frame_of_its_own_size(void **state)
{
    const char *kind = *state;
    const struct provenance prov = {.stage = "render_views", .version = "0"};
    const char *const one[] = {"odd"}, *const none[] = {"other"};
    struct view cameras[2];
    struct camera_set set = {.views = cameras, .view_count = 2};
    bool wanted[2];
    struct scene s;
    struct exr_image im = {0};
    struct err err = ERR_INIT;

    scene_make(&s, 1, kind);
    cameras[0] = cameras[1] = s.view;
    cameras[0].name = "behind";
    cameras[0].translation.z = -8; /* sees nothing: an empty frame */
    cameras[0].center.z = 8;
    cameras[1].name = "odd";
    cameras[1].width = W + 11; /* 11 columns that no view covers, on the right */
    assert_ok(frame_select_cameras(wanted, &set, NULL, 0, &err), err);
    assert_true(wanted[0] && wanted[1]);
    assert_ok(frame_render_cameras(&set, wanted, &s.renderer, scratch_path("cameras"), &prov, &err), err);
    assert_ok(exr_read(&im, scratch_path("cameras/odd.exr"), NULL, 0, &err), err);
    assert_int_equal(im.width, W + 11);
    for (int i = 0; i < (W + 11) * H; i++) {
        assert_true(exr_find(&im, "hole")->f[i] == (i % (W + 11) >= W));
        assert_true(exr_find(&im, "Z")->f[i] == 4);
    }
    exr_image_release(&im);
    assert_ok(exr_read(&im, scratch_path("cameras/behind.exr"), NULL, 0, &err), err);
    assert_string_equal(exr_attribute(&im, "remodel:holes"), "1");
    for (int i = 0; i < W * H; i++) assert_true(exr_find(&im, "hole")->f[i] == 1 && exr_find(&im, "A")->f[i] == 0);
    exr_image_release(&im);

    assert_ok(frame_select_cameras(wanted, &set, one, 1, &err), err);
    assert_true(!wanted[0] && wanted[1]);
    assert_int_equal(frame_select_cameras(wanted, &set, none, 1, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "--camera other");
    scene_drop(&s);
}

/* ------------------------------------------------------------------------------------------------ crop and scale */

static void crops_and_scales_are_parsed(void **state)
{
    (void)state;
    static const char *const bad_crops[] = {"",         "1,2,3",     "1,2,3,4,5",         "1,2,3,4 ",
                                            "a,b,c,d",  "-1,0,4,4",  "0,-1,4,4",          "0,0,0,4",
                                            "0,0,4,-4", "1.5,0,4,4", "99999999999,0,4,4", "0 0 4 4"};
    static const char *const bad_scales[] = {"", "0", "-1", "nan", "inf", "17", "1x", "x", "1e-400"};
    struct frame_part part;
    struct err err = ERR_INIT;

    assert_ok(frame_part_read(&part, NULL, NULL, &err), err);
    assert_true(part.width == 0 && part.scale == 1);
    assert_ok(frame_part_read(&part, "3,0,40,20", "0.5", &err), err);
    assert_true(part.x == 3 && part.y == 0 && part.width == 40 && part.height == 20 && part.scale == 0.5);
    for (size_t i = 0; i < sizeof bad_crops / sizeof *bad_crops; i++) {
        struct err e = ERR_INIT;
        if (frame_part_read(&part, bad_crops[i], NULL, &e) != ST_USAGE)
            fail_msg("--crop \"%s\" was taken", bad_crops[i]);
        assert_err(e, ST_USAGE, "wanted X,Y,WIDTH,HEIGHT");
    }
    for (size_t i = 0; i < sizeof bad_scales / sizeof *bad_scales; i++) {
        struct err e = ERR_INIT;
        if (frame_part_read(&part, NULL, bad_scales[i], &e) != ST_USAGE)
            fail_msg("--scale \"%s\" was taken", bad_scales[i]);
        assert_err(e, ST_USAGE, "wanted a number above 0, at most 16");
    }
}

static void a_crop_must_be_inside_its_picture(void **state)
{
    (void)state;
    static const struct frame_part bad[] = {
        {W - 3, 0, 4, 4, 1}, {0, H, 1, 1, 1}, {0, 0, W + 1, 1, 1}, {0, 0, 4, H + 1, 1}, {2147483, 0, 999999999, 4, 1}};
    const struct frame_part nothing = {0, 0, 4, 4, 0.05}, huge = {0, 0, 0, 0, 16};
    struct view v = {.name = "wall", .width = W, .height = H, .fx = 40, .fy = 41, .cx = 24, .cy = 16};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err err = ERR_INIT;
        struct view c = v;
        assert_int_equal(frame_part_camera(&c, &bad[i], &err), ST_USAGE);
        assert_err(err, ST_USAGE, "48 x 32 pixels");
    }
    struct err err = ERR_INIT;
    struct view c = v;
    assert_int_equal(frame_part_camera(&c, &nothing, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "--scale 0.05 gives a picture of 0 x 0 pixels");
    err = (struct err)ERR_INIT;
    c = v;
    c.width = 20000;
    assert_int_equal(frame_part_camera(&c, &huge, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "320000 x 512");

    /* the same rays: a point is projected to the same position, cropped and scaled */
    const struct frame_part part = {10, 5, 30, 20, 1.5};
    err = (struct err)ERR_INIT;
    c = v;
    assert_ok(frame_part_camera(&c, &part, &err), err);
    assert_true(c.width == 45 && c.height == 30);
    assert_true(fabs((0.3 * c.fx + c.cx) - 1.5 * (0.3 * v.fx + v.cx - 10)) < 1e-9);
    assert_true(fabs((-0.2 * c.fy + c.cy) - 1.5 * (-0.2 * v.fy + v.cy - 5)) < 1e-9);
}

static void a_crop_equals_that_part_of_the_frame(void **state)
{
    const char *kind = *state;
    const struct frame_part part = {9, 7, 27, 18, 1};
    struct scene s;
    struct rendered_frame whole = {0}, cut = {0};
    struct err err = ERR_INIT;

    scene_make(&s, 3, kind);
    for (int i = 0; i < 3; i++) {
        struct view camera = s.path.frames[i].camera;
        assert_ok(renderer_camera(&s.renderer, &camera, &whole, &err), err);
        assert_ok(frame_part_camera(&camera, &part, &err), err);
        assert_ok(renderer_camera(&s.renderer, &camera, &cut, &err), err);
        assert_true(cut.width == 27 && cut.height == 18);
        for (int y = 0; y < 18; y++)
            for (int x = 0; x < 27; x++) {
                const int p = y * 27 + x, q = (y + 7) * W + x + 9;
                assert_int_equal(cut.hole[p], whole.hole[q]);
                if (cut.hole[p]) continue;
                assert_true(fabsf(cut.z[p] - whole.z[q]) < 1e-4f);
                for (int k = 0; k < 4; k++) assert_true(fabsf(cut.rgba[4 * p + k] - whole.rgba[4 * q + k]) < 1e-4f);
            }
    }
    /* at twice the size: pairs of pixels around the same position, of the same depth */
    struct view camera = s.view;
    const struct frame_part twice = {0, 0, 0, 0, 2};
    assert_ok(frame_part_camera(&camera, &twice, &err), err);
    assert_ok(renderer_camera(&s.renderer, &camera, &cut, &err), err);
    assert_true(cut.width == 2 * W && cut.height == 2 * H);
    for (int p = 0; p < 4 * W * H; p++) assert_true(fabsf(cut.z[p] - 4) < 1e-4f);
    rendered_frame_release(&whole);
    rendered_frame_release(&cut);
    scene_drop(&s);
}

static char fast[] = "fast", offline[] = "offline";
#define BOTH(test) \
    {#test " (fast)", test, NULL, NULL, fast}, { #test " (offline)", test, NULL, NULL, offline }

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crops_and_scales_are_parsed),
        cmocka_unit_test(a_crop_must_be_inside_its_picture),
        BOTH(a_crop_equals_that_part_of_the_frame),
        BOTH(frames_are_written_with_all_channels),
        BOTH(any_split_and_thread_count_gives_the_same_bytes),
        BOTH(an_empty_frame_is_an_error),
        BOTH(each_camera_has_a_frame_of_its_own_size),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
