/* encode.c - videos have all frames and the right tags, and are reproducible; a failure is an error and leaves no
 * file. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/hash.h"
#include "common/image/exr.h"
#include "stages/encode_video/encode.h"

#define W      64
#define H      64
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

static enum status encode_flat(const struct camera_path *path, const char *folder, const char *out,
                               const struct encode_params *params, struct err *err)
{
    const struct encode_source source = {.frames = scratch_path(folder)};
    return encode_frames(path, &source, out, params, err);
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
    assert_ok(encode_flat(&path, "complete", scratch_path("a.mp4"), &params, &err), err);
    assert_ok(encode_flat(&path, "complete", scratch_path("b.mp4"), &params, &err), err);
    assert_ok(hash_file(a, scratch_path("a.mp4"), &err), err);
    assert_ok(hash_file(b, scratch_path("b.mp4"), &err), err);
    assert_string_equal(a, b);

    run_command(text, sizeof text, "ffprobe -v error -count_frames -show_streams -of default=nk=0 %s",
                scratch_path("a.mp4"));
    assert_contains(text, "codec_name=h264");
    assert_contains(text, "width=64\nheight=64");
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
    assert_int_equal(encode_flat(&path, "holed", scratch_path("old.mp4"), &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "frame 3 of 5 is missing");
    assert_file_text(scratch_path("old.mp4"), "an older video");
    assert_int_equal(count_entries(scratch), before); /* no temporary file is left */

    err = (struct err)ERR_INIT;
    frame_make("holed/0003.exr", W, H - 2, grey);
    assert_int_equal(encode_flat(&path, "holed", scratch_path("old.mp4"), &params, &err), ST_DATA);
    assert_err(err, ST_DATA, "64 x 62");
    camera_path_release(&path);

    err = (struct err)ERR_INIT;
    path_make(&path, W - 1, H);
    assert_int_equal(encode_flat(&path, "holed", scratch_path("old.mp4"), &params, &err), ST_DATA);
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
    assert_int_equal(encode_flat(&path, "fine", scratch_path("none.mp4"), &params, &err), ST_IO);
    assert_err(err, ST_IO, "ffmpeg ended with status");
    assert_int_equal(access(scratch_path("none.mp4"), F_OK), -1);
    camera_path_release(&path);
}

/* ------------------------------------------------------------------------------------------------ further formats */

/* The middle sample of the first plane, and of both others, of each frame, as 10-bit code values. */
static void read_codes(int codes[FRAMES][3], const char *file, const char *samples)
{
    static unsigned char bytes[FRAMES * W * H * 4];
    char format[256];
    snprintf(format, sizeof format, "ffmpeg -v error -i %%s -f rawvideo -pix_fmt %s -", samples);
    const size_t chroma = strstr(samples, "420") ? W / 2 * (H / 2) : W / 2 * H;
    const size_t planes[3] = {0, W * H, W * H + chroma},
                 middles[3] = {W * H / 2 + W / 2, chroma / 2 + W / 4, chroma / 2 + W / 4};
    run_command((char *)bytes, sizeof bytes, format, file);
    for (size_t i = 0; i < FRAMES; i++)
        for (size_t k = 0; k < 3; k++) {
            const size_t at = 2 * (i * (W * H + 2 * chroma) + planes[k] + middles[k]);
            codes[i][k] = bytes[at] | bytes[at + 1] << 8;
        }
}

/* A grey ramp, each frame of one radiance. */
static const float ramp[FRAMES] = {0.03125F, 0.25F, 1, 2, 4};

static void make_ramp(const char *folder)
{
    for (int i = 0; i < FRAMES; i++) {
        char name[64];
        const float grey[3] = {ramp[i], ramp[i], ramp[i]};
        snprintf(name, sizeof name, "%s/%04d.exr", folder, i + 1);
        frame_make(name, W, H, grey);
    }
}

static void encode_as(const char *format, const char *file, const char *tags[], int count)
{
    struct encode_params params = ENCODE_PARAMS_DEFAULT;
    struct encode_source source = {.frames = scratch_path("ramp")};
    struct camera_path path = {0};
    struct err err = ERR_INIT;
    char text[4096], a[HASH_TEXT], b[HASH_TEXT];
    params.crf = 1; /* the signal is looked at, and not what an encoder loses */
    path_make(&path, W, H);
    source.format = film_format_find(format);
    assert_non_null(source.format);
    assert_ok(encode_frames(&path, &source, scratch_path(file), &params, &err), err);
    assert_ok(hash_file(a, scratch_path(file), &err), err);
    assert_ok(encode_frames(&path, &source, scratch_path(file), &params, &err), err);
    assert_ok(hash_file(b, scratch_path(file), &err), err);
    assert_string_equal(a, b);
    run_command(text, sizeof text, "ffprobe -v error -count_frames -show_streams -of default=nk=0 %s",
                scratch_path(file));
    for (int i = 0; i < count; i++) assert_contains(text, tags[i]);
    assert_contains(text, "nb_read_frames=5");
    run_command(text, sizeof text, "grep -abo -e moov -e mdat %s | head -1", scratch_path(file));
    assert_contains(text, "moov");
    camera_path_release(&path);
}

/* BT.2100, written down once more. */
static double pq(double light)
{
    const double y = pow(light / 10000, 0.1593017578125);
    return pow((0.8359375 + 18.8515625 * y) / (1 + 18.6875 * y), 78.84375);
}

static double hlg(double light) /* of a grey on a display of 1000 cd/m2 */
{
    const double e = pow(light / 1000, 1 / 1.2);
    return e <= 1.0 / 12 ? sqrt(3 * e) : 0.17883277 * log(12 * e - 0.28466892) + 0.55991073;
}

static void ramps_of_high_dynamic_range_have_the_codes_of_their_light(void **state)
{
    (void)state;
    const char *pq_tags[] = {"codec_name=hevc",       "profile=Main 10",      "pix_fmt=yuv420p10le",
                             "color_range=tv",        "color_space=bt2020nc", "color_transfer=smpte2084",
                             "color_primaries=bt2020"};
    const char *hlg_tags[] = {"codec_name=hevc",       "profile=Main 10",      "pix_fmt=yuv420p10le",
                              "color_range=tv",        "color_space=bt2020nc", "color_transfer=arib-std-b67",
                              "color_primaries=bt2020"};
    int codes[FRAMES][3];
    char text[4096];
    make_ramp("ramp");
    encode_as("pq", "pq.mp4", pq_tags, 7);
    read_codes(codes, scratch_path("pq.mp4"), "yuv420p10le");
    for (int i = 0; i < FRAMES; i++) {
        const double wanted = 64 + 876 * pq(203 * (double)ramp[i]);
        print_message("radiance %g: PQ %d, wanted %.1f\n", (double)ramp[i], codes[i][0], wanted);
        assert_true(labs(codes[i][0] - lround(wanted)) <= 1);
        assert_true(abs(codes[i][1] - 512) <= 1 && abs(codes[i][2] - 512) <= 1);
    }
    assert_true(abs(codes[2][0] - 573) <= 1); /* white, 203 cd/m2: 58 % [ITU 2023] */
    run_command(text, sizeof text, "ffprobe -v error -show_frames -read_intervals '%%+#1' %s", scratch_path("pq.mp4"));
    assert_contains(text, "Mastering display metadata");
    assert_contains(text, "max_luminance=10000000/10000");
    assert_contains(text, "max_content=812"); /* 4 x 203 cd/m2 */
    assert_contains(text, "max_average=812");

    encode_as("hlg", "hlg.mp4", hlg_tags, 7);
    read_codes(codes, scratch_path("hlg.mp4"), "yuv420p10le");
    for (int i = 0; i < FRAMES; i++) {
        const double wanted = 64 + 876 * hlg(203 * (double)ramp[i]);
        print_message("radiance %g: HLG %d, wanted %.1f\n", (double)ramp[i], codes[i][0], wanted);
        assert_true(labs(codes[i][0] - lround(wanted)) <= 1);
        assert_true(abs(codes[i][1] - 512) <= 1 && abs(codes[i][2] - 512) <= 1);
    }
    assert_true(abs(codes[2][0] - 721) <= 1); /* white: 75 % */
}

static void av1_and_prores_have_ten_bits_of_srgb(void **state)
{
    (void)state;
    const char *av1_tags[] = {"codec_name=av1", "pix_fmt=yuv420p10le", "color_space=bt709", "color_transfer=bt709"};
    const char *prores_tags[] = {"codec_name=prores", "profile=HQ", "pix_fmt=yuv422p10le", "color_space=bt709",
                                 "codec_tag_string=apch"};
    int codes[FRAMES][3];
    make_ramp("ramp");
    for (int k = 0; k < 2; k++) {
        const char *file = k ? "ramp.mov" : "av1.mp4";
        encode_as(k ? "prores" : "av1", file, k ? prores_tags : av1_tags, k ? 5 : 4);
        read_codes(codes, scratch_path(file), k ? "yuv422p10le" : "yuv420p10le");
        for (int i = 0; i < FRAMES; i++) {
            const double wanted = 64 + 876 * (double)srgb_from_linear(ramp[i]);
            print_message("radiance %g: %s %d, wanted %.1f\n", (double)ramp[i], file, codes[i][0], wanted);
            assert_true(labs(codes[i][0] - lround(wanted)) <= 1);
        }
    }
}

/* -------------------------------------------------------------------------------------------------------- two eyes */

static void two_eyes_become_one_picture_that_says_so(void **state)
{
    (void)state;
    static const struct {
        const char *eyes, *size, *tags[3];
    } kinds[] = {
        {"side_by_side", "width=128\nheight=64", {"side_data_type=Stereo 3D", "type=side by side", ""}},
        {"top_bottom", "width=64\nheight=128", {"side_data_type=Stereo 3D", "type=top and bottom", ""}},
        {"anaglyph", "width=64\nheight=64", {"", "", ""}},
        {"vr180",
         "width=128\nheight=64",
         {"type=side by side", "Spherical Mapping", "projection=tiled equirectangular"}},
    };
    const struct encode_params params = ENCODE_PARAMS_DEFAULT;
    const float bright[3] = {0.5f, 0.5f, 0.5f}, dark[3] = {0.05f, 0.05f, 0.05f};
    struct camera_path path = {0};
    struct err err = ERR_INIT;
    char name[64], text[4096];
    path_make(&path, W, H);
    for (int i = 0; i < FRAMES; i++) {
        snprintf(name, sizeof name, "left/%04d.exr", i + 1);
        frame_make(name, W, H, bright);
        snprintf(name, sizeof name, "right/%04d.exr", i + 1);
        frame_make(name, W, H, dark);
    }
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const struct encode_source source = {scratch_path("left"), scratch_path("right"), eyes_find(kinds[i].eyes),
                                             NULL};
        assert_ok(encode_frames(&path, &source, scratch_path("eyes.mp4"), &params, &err), err);
        run_command(text, sizeof text, "ffprobe -v error -count_frames -show_streams -of default=nk=0 %s",
                    scratch_path("eyes.mp4"));
        assert_contains(text, kinds[i].size);
        assert_contains(text, "nb_read_frames=5");
        for (int k = 0; k < 3; k++) assert_contains(text, kinds[i].tags[k]);
        if (!kinds[i].tags[0][0]) assert_null(strstr(text, "Stereo 3D"));
        /* the left eye is on the left or on top */
        unsigned char grey[2 * W * H] = {0};
        run_command((char *)grey, sizeof grey, "ffmpeg -v error -i %s -frames:v 1 -f rawvideo -pix_fmt gray -",
                    scratch_path("eyes.mp4"));
        const int end = kinds[i].eyes[0] == 'a' ? W * H - 1 : 2 * W * H - 1;
        if (kinds[i].eyes[0] != 'a') assert_true(grey[0] > grey[end] + 80);
    }
    camera_path_release(&path);
}

static void anaglyphs_keep_greys_that_both_eyes_see(void **state)
{
    (void)state;
    struct image left = {0}, right = {0}, out = {0};
    struct err err = ERR_INIT;
    assert_ok(image_init(&left, 2, 1, 3, &err), err);
    assert_ok(image_init(&right, 2, 1, 3, &err), err);
    assert_ok(image_init(&out, 2, 1, 3, &err), err);
    for (int k = 0; k < 6; k++) left.data[k] = 0.4f, right.data[k] = k < 3 ? 0.4f : 0;
    eyes_picture(&out, &left, &right, FILM_ANAGLYPH);
    for (int k = 0; k < 3; k++) assert_float_equal(out.data[k], 0.4, 1e-6);
    /* what the left eye alone sees is red */
    assert_true(out.data[3] > 0.35f && out.data[4] == 0 && out.data[5] == 0);
    image_release(&left);
    image_release(&right);
    image_release(&out);
}

static void files_without_an_index_are_refused(void **state)
{
    (void)state;
    static const unsigned char free_box[] = {0, 0, 0, 12, 'f', 'r', 'e', 'e', 0, 0, 0, 0};
    static const unsigned char bare[] = {0, 0, 0, 16, 'm', 'o', 'o', 'v', 0, 0, 0, 8, 't', 'r', 'a', 'k'};
    static const unsigned char cut[] = {0, 0, 1, 0, 'm', 'o', 'o', 'v', 0, 0, 0, 8, 't', 'r', 'a', 'k'};
    static const struct {
        const void *bytes;
        size_t size;
        const char *what;
    } files[] = {
        {"", 0, "no index"},
        {free_box, sizeof free_box, "no index"},
        {bare, sizeof bare, "an index without a sample entry"},
        {cut, sizeof cut, "an index that ends early"},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct err err = ERR_INIT;
        const char *path = scratch_write_bytes("broken.mp4", files[i].bytes, files[i].size);
        assert_int_equal(stereo_boxes_add(path, STEREO_SIDE_BY_SIDE, false, &err), ST_DATA);
        assert_err(err, ST_DATA, files[i].what);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(videos_have_all_frames_and_tags),
        cmocka_unit_test(missing_and_odd_frames_are_refused),
        cmocka_unit_test(a_failed_encoder_leaves_no_file),
        cmocka_unit_test(ramps_of_high_dynamic_range_have_the_codes_of_their_light),
        cmocka_unit_test(av1_and_prores_have_ten_bits_of_srgb),
        cmocka_unit_test(two_eyes_become_one_picture_that_says_so),
        cmocka_unit_test(anaglyphs_keep_greys_that_both_eyes_see),
        cmocka_unit_test(files_without_an_index_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
