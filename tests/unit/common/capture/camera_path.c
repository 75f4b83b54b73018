/* camera_path.c - a path can be written and read back; invalid paths are rejected with file and line. */
#include "common/capture/camera_path.h"

#include "tests/unit/scratch.h"

/* `frames` cameras that move to the right and rotate. */
static void make_path(struct camera_path *p, int frames)
{
    struct err err = ERR_INIT;
    assert_ok(camera_path_init(p, "establishing_dolly", 24000.0 / 1001, frames, &err), err);
    for (int i = 0; i < frames; i++) {
        double angle = 0.01 * i;
        struct view *v = &p->frames[i].camera;
        v->width = 320, v->height = 200, v->fx = 301.25 + i, v->fy = 300, v->cx = 160, v->cy = 100;
        v->cam_from_world = mat3_from_quat((struct quat){cos(angle), 0, sin(angle), 0});
        v->center = vec3_make(0.1 * i, 1.0 / 3, -2);
        v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
        p->frames[i].aperture = 0.001 * i;
        p->frames[i].focus = 4 + i / 7.0;
    }
    assert_ok(camera_path_add_score(p, "parallax", 1.0 / 7, "px", &err), err);
    assert_ok(camera_path_add_score(p, "holes_at 0.25", 0, "", &err), err);
}

static void a_path_is_read_as_it_was_written(void **state)
{
    struct camera_path p = {0}, q = {0};
    struct err err = ERR_INIT;
    (void)state;
    make_path(&p, 5);
    assert_string_equal(p.frames[4].camera.name, "0005");
    assert_ok(camera_path_write(&p, scratch_path("dolly"), NULL, &err), err);
    assert_ok(camera_path_read(&q, scratch_path("dolly"), NULL, &err), err);
    assert_string_equal(q.effect, "establishing_dolly");
    assert_true(q.fps == p.fps);
    assert_int_equal(q.score_count, 2);
    assert_string_equal(q.scores[1].name, "holes_at 0.25");
    assert_string_equal(q.scores[1].unit, "");
    assert_true(q.scores[0].value == 1.0 / 7);
    assert_int_equal(q.frame_count, 5);
    for (int i = 0; i < 5; i++) {
        const struct path_frame *a = &p.frames[i], *b = &q.frames[i];
        assert_string_equal(a->camera.name, b->camera.name);
        assert_true(a->time == b->time && a->aperture == b->aperture && a->focus == b->focus);
        assert_true(a->camera.fx == b->camera.fx && a->camera.cy == b->camera.cy && a->camera.width == b->camera.width);
        assert_true(vec3_length(vec3_sub(a->camera.center, b->camera.center)) < 1e-14);
    }
    camera_path_release(&q);
    camera_path_release(&p);
    camera_path_release(&p);
    camera_path_release(NULL);
}

static void many_frames_stay_in_order(void **state)
{
    struct camera_path p = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(camera_path_init(&p, "e", 30, 12000, &err), err);
    assert_string_equal(p.frames[0].camera.name, "00001");
    assert_string_equal(p.frames[11999].camera.name, "12000");
    camera_path_release(&p);
}

static void invalid_paths_cannot_be_made(void **state)
{
    struct camera_path p = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(camera_path_init(&p, "e", 30, 0, &err), ST_DATA);
    assert_err(err, ST_DATA, "0 frames");
    err = (struct err)ERR_INIT;
    assert_int_equal(camera_path_init(&p, "e", 0, 3, &err), ST_DATA);
    assert_err(err, ST_DATA, "0 frames per second");
    err = (struct err)ERR_INIT;
    assert_ok(camera_path_init(&p, "e", 30, 2, &err), err);
    assert_int_equal(camera_path_add_score(&p, "s", NAN, "px", &err), ST_INTERNAL);
    camera_path_release(&p);
}

/* Writes a valid path of two frames, then `text` as its path.txt (NULL: unchanged); reading it must fail with
 * `message`. */
static void assert_rejected(const char *text, const char *message)
{
    struct camera_path p = {0};
    struct err err = ERR_INIT;
    make_path(&p, 2);
    assert_ok(camera_path_write(&p, scratch_path("bad"), NULL, &err), err);
    camera_path_release(&p);
    if (text) scratch_write("bad/path.txt", text);
    assert_int_equal(camera_path_read(&p, scratch_path("bad"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, message);
    assert_contains(err.text, "path.txt:");
    assert_null(p.frames);
    assert_null(p.scores);
}

#define HEAD "remodel-path 1\neffect e\nfps 30\n"

static void broken_lists_are_rejected(void **state)
{
    (void)state;
    assert_rejected("", "remodel-path");
    assert_rejected("remodel-lenses 1\n", "remodel-path");
    assert_rejected("remodel-path 2\n", "version");
    assert_rejected("remodel-path 1\neffect e\nfps 0\n", "above 0");
    assert_rejected("remodel-path 1\neffect e\nfps -3\n", "0 or more");
    assert_rejected("remodel-path 1\neffect e\nfps nan\n", "nan");
    assert_rejected(HEAD "frames 3\n", "wanted 2 frames");
    assert_rejected(HEAD "score a x px\nframes 2\n", "score");
    assert_rejected(HEAD "scores 2\n", "scores");
    assert_rejected(HEAD "frames 2\nframe 0001 0 0 0\n", "frame ...");
    assert_rejected(HEAD "frames 2\nframe 0002 0 0 0\n", "frame 0001");
    assert_rejected(HEAD "frames 2\nframe 0001 0 -1 0\n", "-1");
    assert_rejected(HEAD "frames 2\nframe 0001 0 0 inf\n", "inf");
    assert_rejected(HEAD "frames 2\nframe 0001 0 0 0 7\n", "7");
    assert_rejected(HEAD "frames 2\nframe 0001 0 0 0\nframe 0002 1 0 0\nframe 0003 2 0 0\n", "end of the file");
}

/* Reading a path with this second camera must fail with `message`. */
static void assert_camera_rejected(const char *camera, const char *message)
{
    struct camera_path p = {0};
    struct err err = ERR_INIT;
    char text[512];
    make_path(&p, 2);
    assert_ok(camera_path_write(&p, scratch_path("bad"), NULL, &err), err);
    camera_path_release(&p);
    snprintf(text, sizeof text, "1 PINHOLE 320 200 300 300 160 100\n2 %s\n", camera);
    scratch_write("bad/path/cameras.txt", text);
    assert_int_equal(camera_path_read(&p, scratch_path("bad"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, message);
    assert_null(p.frames);
}

static void cameras_that_cannot_be_filmed_are_rejected(void **state)
{
    (void)state;
    assert_camera_rejected("PINHOLE 321 200 300 300 160 100", "even");
    assert_camera_rejected("PINHOLE 322 200 300 300 160 100", "320 x 200");
    assert_camera_rejected("PINHOLE 320 200 0 300 160 100", "focal");
    assert_camera_rejected("PINHOLE 320 200 -300 300 160 100", "-300");
    assert_camera_rejected("PINHOLE 320 200 nan 300 160 100", "nan");
    assert_camera_rejected("RADIAL 320 200 300 160 100 0 0", "PINHOLE");
}

static void a_missing_file_is_named(void **state)
{
    struct camera_path p = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(camera_path_read(&p, scratch_path("nowhere"), NULL, &err), ST_IO);
    assert_contains(err.text, "nowhere/path");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_path_is_read_as_it_was_written),
        cmocka_unit_test(many_frames_stay_in_order),
        cmocka_unit_test(invalid_paths_cannot_be_made),
        cmocka_unit_test(broken_lists_are_rejected),
        cmocka_unit_test(cameras_that_cannot_be_filmed_are_rejected),
        cmocka_unit_test(a_missing_file_is_named),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
