/* encode.c - videos have all frames and the right tags, and are reproducible; a failure is an error and leaves no
 * file. */
#include "tests/unit/scratch.h"

#include "common/base/hash.h"
#include "common/image/exr.h"
#include "stages/encode_video/encode.h"

#define W      64
#define H      48
#define FRAMES 5

static void path_make(struct camera_path *path, int width, int height)
{
    struct err err = ERR_INIT;
    assert_ok(camera_path_init(path, "test", 25, FRAMES, &err), err);
    for (int i = 0; i < FRAMES; i++) {
        path->frames[i].camera.width = width;
        path->frames[i].camera.height = height;
    }
}

/* A flat colour (linear), which encoding must keep. */
static void frame_make(const char *name, int width, int height, const float rgb[3])
{
    static const char *const names[] = {"R", "G", "B"};
    const struct provenance prov = {.stage = "test", .version = "0"};
    struct exr_image im = {0};
    struct exr_plane *plane;
    struct err err = ERR_INIT;

    assert_ok(exr_image_init(&im, width, height, &err), err);
    for (int k = 0; k < 3; k++) {
        assert_ok(exr_add_plane(&im, names[k], EXR_HALF, &plane, &err), err);
        for (int i = 0; i < width * height; i++) plane->f[i] = rgb[k];
    }
    assert_ok(exr_write(&im, scratch_path(name), &prov, &err), err);
    exr_image_release(&im);
}

static void frames_make(const char *folder)
{
    char name[64];
    for (int i = 0; i < FRAMES; i++) {
        const float rgb[3] = {0.8f, 0.2f, 0.05f * (float)i};
        snprintf(name, sizeof name, "%s/%04d.exr", folder, i + 1);
        frame_make(name, W, H, rgb);
    }
}

/* The output of a shell command about a file. */
static void run_command(char *text, size_t size, const char *format, const char *file)
{
    char command[1024];
    snprintf(command, sizeof command, format, file);
    FILE *fp = popen(command, "r");
    assert_non_null(fp);
    text[fread(text, 1, size - 1, fp)] = 0;
    assert_int_equal(pclose(fp), 0);
}

static void videos_have_all_frames_and_tags(void **state)
{
    (void)state;
    const struct encode_params params = ENCODE_PARAMS_DEFAULT;
    struct camera_path path = {0};
    struct err err = ERR_INIT;
    char text[4096], a[HASH_TEXT], b[HASH_TEXT];

    path_make(&path, W, H);
    frames_make("complete");
    assert_ok(encode_frames(&path, scratch_path("complete"), scratch_path("a.mp4"), &params, &err), err);
    assert_ok(encode_frames(&path, scratch_path("complete"), scratch_path("b.mp4"), &params, &err), err);
    assert_ok(hash_file(a, scratch_path("a.mp4"), &err), err);
    assert_ok(hash_file(b, scratch_path("b.mp4"), &err), err);
    assert_string_equal(a, b);

    run_command(text, sizeof text, "ffprobe -v error -count_frames -show_streams -of default=nk=0 %s",
                scratch_path("a.mp4"));
    assert_contains(text, "codec_name=h264");
    assert_contains(text, "width=64\nheight=48");
    assert_contains(text, "pix_fmt=yuv420p");
    assert_contains(text, "color_range=tv");
    assert_contains(text, "color_space=bt709");
    assert_contains(text, "color_transfer=bt709");
    assert_contains(text, "color_primaries=bt709");
    assert_contains(text, "r_frame_rate=25/1");
    assert_contains(text, "nb_read_frames=5");

    /* faststart: the index comes before the data */
    run_command(text, sizeof text, "grep -abo -e moov -e mdat %s | head -1", scratch_path("a.mp4"));
    assert_contains(text, "moov");

    /* colour: linear 0.8 and 0.2 are 231 and 124 in sRGB; 8-bit YUV with 4:2:0 chroma keeps a flat picture within 2 */
    unsigned char rgb[4] = {0};
    run_command((char *)rgb, sizeof rgb,
                "ffmpeg -v error -i %s -vf scale=in_color_matrix=bt709,crop=1:1:20:20 -frames:v 1 "
                "-f rawvideo -pix_fmt rgb24 -",
                scratch_path("a.mp4"));
    assert_in_range(rgb[0], 229, 233);
    assert_in_range(rgb[1], 122, 126);
    assert_in_range(rgb[2], 0, 3);
    camera_path_release(&path);
}

static void missing_and_odd_frames_are_refused(void **state)
{
    (void)state;
    const struct encode_params params = ENCODE_PARAMS_DEFAULT;
    const float grey[3] = {0.5f, 0.5f, 0.5f};
    struct camera_path path = {0};
    struct err err = ERR_INIT;

    path_make(&path, W, H);
    frames_make("holed");
    assert_int_equal(remove(scratch_path("holed/0003.exr")), 0);
    scratch_write("old.mp4", "an older video");
    const int before = count_entries(scratch);
    assert_int_equal(encode_frames(&path, scratch_path("holed"), scratch_path("old.mp4"), &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "frame 3 of 5 is missing");
    assert_file_text(scratch_path("old.mp4"), "an older video");
    assert_int_equal(count_entries(scratch), before); /* no temporary file is left */

    err = (struct err)ERR_INIT;
    frame_make("holed/0003.exr", W, H - 2, grey);
    assert_int_equal(encode_frames(&path, scratch_path("holed"), scratch_path("old.mp4"), &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "64 x 46");
    camera_path_release(&path);

    err = (struct err)ERR_INIT;
    path_make(&path, W - 1, H);
    assert_int_equal(encode_frames(&path, scratch_path("holed"), scratch_path("old.mp4"), &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "even sizes");
    camera_path_release(&path);
}

static void a_failed_encoder_leaves_no_file(void **state)
{
    (void)state;
    const struct encode_params params = {.crf = 18, .preset = "nonsense"};
    struct camera_path path = {0};
    struct err err = ERR_INIT;

    path_make(&path, W, H);
    frames_make("fine");
    assert_int_equal(encode_frames(&path, scratch_path("fine"), scratch_path("none.mp4"), &params, &err), ST_IO);
    assert_err(err, ST_IO, "ffmpeg ended with status");
    assert_int_equal(access(scratch_path("none.mp4"), F_OK), -1);
    camera_path_release(&path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(videos_have_all_frames_and_tags),
        cmocka_unit_test(missing_and_odd_frames_are_refused),
        cmocka_unit_test(a_failed_encoder_leaves_no_file),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
