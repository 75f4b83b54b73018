/* clip_reader.c - colours of clips by their codes, ranges and matrices against what they were made from; rotation;
 * wide pixels; times; files that are no clips. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/import_photos/clip_reader.h"

enum { W = 64, H = 48, PATCH = 16, COLUMNS = W / PATCH, FRAMES = 5 };

static const char *clip(const char *name) { return scratch_path(name); }

static void shell(const char *format, ...)
{
    char command[2048];
    va_list args;
    va_start(args, format);
    vsnprintf(command, sizeof command, format, args);
    va_end(args);
    if (system(command) != 0) fail_msg("%s failed", command);
}

/* ------------------------------------------------------------------------------------------ colours, in closed form */

struct kind {
    const char *name, *tags;
    double kr, kb;
    int bits, full;
    double (*signal)(double light);
    double from_rec709[3][3]; /* linear light */
};

static double signal_of_709(double l) { return l < 0.018 ? 4.5 * l : 1.099 * pow(l, 0.45) - 0.099; }

/* Light 1 is at 75 %, as ITU-R BT.2408 says. */
static double signal_of_hlg(double l)
{
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * log(4 * a), scene = l * (exp((0.75 - c) / a) + b) / 12;
    return scene <= 1.0 / 12 ? sqrt(3 * scene) : a * log(12 * scene - b) + c;
}

/* Light 1 is 203 cd/m^2. */
static double signal_of_pq(double l)
{
    const double y = pow(l * 203 / 10000, 2610.0 / 16384);
    return pow((3424.0 / 4096 + 2413.0 / 128 * y) / (1 + 2392.0 / 128 * y), 2523.0 / 32);
}

#define SAME                              \
    {                                     \
        {1, 0, 0}, {0, 1, 0}, { 0, 0, 1 } \
    }
/* ITU-R BT.2087 */
#define TO_2020                                                                        \
    {                                                                                  \
        {0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0114}, { 0.0164, 0.0880, 0.8956 } \
    }

static const struct kind kinds[] = {
    {"bt709.mp4", "-vf setparams=range=tv:color_primaries=bt709:color_trc=bt709:colorspace=bt709", 0.2126, 0.0722, 8, 0,
     signal_of_709, SAME},
    {"full.mp4", "-vf setparams=range=pc:color_primaries=bt709:color_trc=bt709:colorspace=bt709", 0.2126, 0.0722, 8, 1,
     signal_of_709, SAME},
    {"bt601.mp4", "-vf setparams=range=tv:color_primaries=bt709:color_trc=bt709:colorspace=smpte170m", 0.299, 0.114, 8,
     0, signal_of_709, SAME},
    {"hlg.mov", "-vf setparams=range=tv:color_primaries=bt2020:color_trc=arib-std-b67:colorspace=bt2020nc", 0.2627,
     0.0593, 10, 0, signal_of_hlg, TO_2020},
    {"hlg-full.mov", "-vf setparams=range=pc:color_primaries=bt2020:color_trc=arib-std-b67:colorspace=bt2020nc", 0.2627,
     0.0593, 10, 1, signal_of_hlg, TO_2020},
    {"pq.mp4", "-vf setparams=range=tv:color_primaries=bt2020:color_trc=smpte2084:colorspace=bt2020nc", 0.2627, 0.0593,
     10, 0, signal_of_pq, TO_2020},
};

/* Linear Rec.709: greys, saturated colours, and in HDR light above white. */
static void patch_light(double rgb[3], int patch, const struct kind *k)
{
    static const double colours[12][3] = {{0.18, 0.18, 0.18}, {0.9, 0.9, 0.9},  {0.6, 0.1, 0.1},  {0.1, 0.5, 0.15},
                                          {0.1, 0.15, 0.6},   {0.5, 0.45, 0.1}, {0.45, 0.2, 0.4}, {0.1, 0.4, 0.4},
                                          {1, 1, 1},          {0.3, 0.2, 0.15}, {2.5, 2, 1.5},    {0.05, 0.05, 0.05}};
    for (int c = 0; c < 3; c++) rgb[c] = k->bits == 8 ? fmin(colours[patch][c], 1) : colours[patch][c];
}

/* The codes of a patch: Y, Cb, Cr. */
static void patch_codes(int codes[3], int patch, const struct kind *k)
{
    double light[3], v[3] = {0};
    patch_light(light, patch, k);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) v[i] += k->from_rec709[i][j] * light[j];
        v[i] = k->signal(v[i]);
    }
    const double y = k->kr * v[0] + (1 - k->kr - k->kb) * v[1] + k->kb * v[2];
    const double b = (v[2] - y) / (2 * (1 - k->kb)), r = (v[0] - y) / (2 * (1 - k->kr));
    const double step = pow(2, k->bits - 8), top = pow(2, k->bits) - 1;
    codes[0] = (int)lrint(k->full ? y * top : (16 + 219 * y) * step);
    codes[1] = (int)lrint(k->full ? b * top + 128 * step : (128 + 224 * b) * step);
    codes[2] = (int)lrint(k->full ? r * top + 128 * step : (128 + 224 * r) * step);
}

/* 4:2:0; patches are larger than samples of chroma. The frames have the tags, by setparams: as options of the output
 * they make ffmpeg 7 convert the samples, or are dropped. */
static const char *make_clip(const struct kind *k)
{
    const char *raw = clip("raw.yuv");
    FILE *fp = fopen(raw, "wb");
    assert_non_null(fp);
    for (int f = 0; f < FRAMES; f++)
        for (int plane = 0; plane < 3; plane++)
            for (int y = 0; y < (plane ? H / 2 : H); y++)
                for (int x = 0; x < (plane ? W / 2 : W); x++) {
                    const int side = plane ? PATCH / 2 : PATCH;
                    int codes[3];
                    patch_codes(codes, y / side * COLUMNS + x / side, k);
                    fputc(codes[plane] & 255, fp);
                    if (k->bits > 8) fputc(codes[plane] >> 8, fp);
                }
    assert_int_equal(fclose(fp), 0);
    shell(
        "ffmpeg -v error -y -f rawvideo -pix_fmt %s -video_size %dx%d -framerate 10 -i '%s' -c:v libx264 -qp 0 %s '%s'",
        k->bits > 8 ? "yuv420p10le" : "yuv420p", W, H, raw, k->tags, clip(k->name));
    return clip(k->name);
}

static void read_frame(struct photo *p, const char *path, int number)
{
    struct clip_reader *c = NULL;
    struct clip_frame at = {-1, 0};
    struct err err = ERR_INIT;
    assert_ok(clip_open(&c, path, &err), err);
    while (at.number < number) {
        if (!clip_next(c, &at, &err)) fail_msg("frame %d is missing: %s", number, err.text);
        assert_true(fabs(at.seconds - 0.1 * at.number) < 1e-3);
    }
    assert_ok(clip_photo(c, p, &err), err);
    clip_close(c);
}

/* Colours are right within 1 %, or what half a step of an 8-bit sample is. Written as PNG and read again they are the
 * same. */
static void colours_are_those_of_the_clip(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        struct photo p = {0}, again = {0};
        struct image linear = {0}, as_png = {0};
        struct err err = ERR_INIT;
        const char *png = clip("frame.png");
        read_frame(&p, make_clip(&kinds[i]), FRAMES - 1);
        assert_int_equal(p.info.bits, kinds[i].bits > 8 ? 16 : 8);
        assert_ok(photo_to_linear(&linear, &p, &err), err);
        assert_ok(photo_write_part(png, &p, 0, 0, W, H, &p.info, &err), err);
        assert_ok(photo_read(&again, png, &err), err);
        assert_ok(photo_to_linear(&as_png, &again, &err), err);
        for (int patch = 0; patch < 12; patch++) {
            const int x = patch % COLUMNS * PATCH + PATCH / 2, y = patch / COLUMNS * PATCH + PATCH / 2;
            const float *found = &linear.data[3 * (y * W + x)], *read = &as_png.data[3 * (y * W + x)];
            double wanted[3];
            patch_light(wanted, patch, &kinds[i]);
            for (int c = 0; c < 3; c++) {
                const double room = 0.01 * wanted[c] + (kinds[i].bits == 8 ? 0.006 : 0.0015);
                if (!(fabs((double)found[c] - wanted[c]) <= room))
                    fail_msg("%s, patch %d: channel %d is %g, wanted %g", kinds[i].name, patch, c, (double)found[c],
                             wanted[c]);
                assert_true(fabsf(found[c] - read[c]) <= 1e-6f);
            }
        }
        image_release(&linear);
        image_release(&as_png);
        photo_release(&p);
        photo_release(&again);
    }
}

/* Writes the matrix of the track header: x' = a x + c y, y' = b x + d y. */
static void set_matrix(const char *path, const int abcd[4])
{
    static unsigned char bytes[1 << 16];
    FILE *fp = fopen(path, "r+b");
    assert_non_null(fp);
    const size_t size = fread(bytes, 1, sizeof bytes, fp);
    const unsigned char *header = memmem(bytes, size, "tkhd", 4);
    assert_non_null(header);
    for (int i = 0; i < 4; i++) { /* 16.16, in rows of three; the header's version is 0 */
        const unsigned char value[4] = {abcd[i] < 0 ? 255 : 0, (unsigned char)abcd[i], 0, 0};
        fseek(fp, (long)(header - bytes) + 4 + 40 + 4 * (i + (i > 1)), SEEK_SET);
        assert_int_equal(fwrite(value, 1, 4, fp), 4);
    }
    assert_int_equal(fclose(fp), 0);
}

/* A clip with a red corner at the top left of what is stored, and every rotation and mirror that its header can state.
 * A phone that is held upright writes {0, 1, -1, 0}. */
static void clips_stand_upright(void **state)
{
    static const struct {
        int abcd[4];
        bool right, down; /* the corner, as shown */
    } turns[] = {{{1, 0, 0, 1}, false, false}, {{0, 1, -1, 0}, true, false}, {{-1, 0, 0, -1}, true, true},
                 {{0, -1, 1, 0}, false, true}, {{-1, 0, 0, 1}, true, false}, {{1, 0, 0, -1}, false, true},
                 {{0, 1, 1, 0}, false, false}, {{0, -1, -1, 0}, true, true}};
    (void)state;
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
        struct photo p = {0};
        const char *path = clip("turned.mp4");
        const bool sideways = !turns[i].abcd[0];
        shell("ffmpeg -v error -y -f lavfi -i color=gray:size=%dx%d:rate=10,drawbox=w=16:h=16:c=red:t=fill,"
              "drawbox=x=16:w=16:h=16:c=blue:t=fill -frames:v 3 -c:v libx264 -qp 0 -pix_fmt yuv420p '%s'",
              W, H, path);
        set_matrix(path, turns[i].abcd);
        read_frame(&p, path, 0);
        assert_int_equal(p.info.width, sideways ? H : W);
        assert_int_equal(p.info.height, sideways ? W : H);
        assert_int_equal(p.info.orientation, 1);
        const int x = turns[i].right ? p.info.width - 8 : 8, y = turns[i].down ? p.info.height - 8 : 8;
        /* blue is beside red in the direction of x, as stored */
        const int bx = x + 16 * turns[i].abcd[0], by = y + 16 * turns[i].abcd[1];
        const uint16_t *red = p.samples + 3 * (y * p.info.width + x), *blue = p.samples + 3 * (by * p.info.width + bx);
        if (red[0] < 200 || red[2] > 60 || blue[2] < 200 || blue[0] > 60)
            fail_msg("turn %zu: a corner is elsewhere", i);
        photo_release(&p);
    }
}

static void wide_pixels_are_stretched(void **state)
{
    struct photo p = {0};
    (void)state;
    shell("ffmpeg -v error -y -f lavfi -i testsrc2=size=%dx%d:rate=10 -frames:v 3 -vf setsar=4/3 -c:v libx264 '%s'", W,
          H, clip("wide.mp4"));
    read_frame(&p, clip("wide.mp4"), 0);
    assert_int_equal(p.info.width, 85);
    assert_int_equal(p.info.height, H);
    photo_release(&p);
}

static int count_frames(const char *path)
{
    struct clip_reader *c = NULL;
    struct clip_frame at = {-1, 0};
    struct err err = ERR_INIT;
    if (!clip_open(&c, path, &err))
        while (clip_next(c, &at, &err)) continue;
    clip_close(c);
    assert_ok(err.status, err);
    return at.number + 1;
}

/* A screen recording holds its last picture as long as nothing changes. */
static void a_last_frame_may_be_shown_for_long(void **state)
{
    (void)state;
    shell("ffmpeg -v error -y -f lavfi -i testsrc2=size=%dx%d:rate=10 -frames:v %d -c:v libx264 -bf 0 "
          "-bsf:v 'setts=duration=if(eq(N\\,%d)\\,20/TB\\,DURATION)' '%s'",
          W, H, FRAMES, FRAMES - 1, clip("hold.mp4"));
    assert_int_equal(count_frames(clip("hold.mp4")), FRAMES);
}

/* Even rows show a bar at x 8 to 24, odd ones, a field later, at x 40 to 56. */
static void interlaced_frames_show_one_moment(void **state)
{
    struct photo p = {0};
    (void)state;
    shell("ffmpeg -v error -y -f lavfi -i \"color=black:size=%dx%d:rate=10,drawbox=x=8:w=16:c=white:t=fill\" -f lavfi "
          "-i \"color=black:size=%dx%d:rate=10,drawbox=x=40:w=16:c=white:t=fill\" -filter_complex "
          "'[0][1]blend=all_expr=if(mod(Y\\,2)\\,B\\,A),setfield=tff' -frames:v %d -flags +ilme+ildct -x264opts tff=1 "
          "-c:v libx264 -qp 0 "
          "-pix_fmt yuv420p '%s'",
          W, H, W, H, FRAMES, clip("fields.mp4"));
    read_frame(&p, clip("fields.mp4"), 1);
    for (int y = 0; y < H; y++) {
        const uint16_t *row = p.samples + (size_t)3 * W * y;
        if (row[3 * 16] < 250 || row[3 * 48] > 5)
            fail_msg("row %d: %d at x 16, %d at x 48", y, row[3 * 16], row[3 * 48]);
    }
    photo_release(&p);
}

static void fails(const char *path, const char *words)
{
    struct clip_reader *c = NULL;
    struct clip_frame at;
    struct err err = ERR_INIT;
    if (!clip_open(&c, path, &err))
        while (clip_next(c, &at, &err)) continue;
    clip_close(c);
    if (err.status != ST_DATA || !strstr(err.text, path) || !strstr(err.text, words))
        fail_msg("%s: found \"%s\", wanted \"%s\"", path, err.text, words);
}

static void unusable_clips_are_named(void **state)
{
    (void)state;
    shell("ffmpeg -v error -y -f lavfi -i sine=duration=1 -c:a aac '%s'", clip("sound.mp4"));
    shell("ffmpeg -v error -y -f lavfi -i testsrc2=size=320x240:rate=25 -t 4 -c:v libx264 -movflags +faststart '%s'",
          clip("whole.mp4"));
    shell("head -c 60000 '%s' >'%s'", clip("whole.mp4"), clip("cut.mp4"));
    shell("ffmpeg -v error -y -i '%s' -c copy '%s'; head -c 60000 '%s' >'%s'", clip("whole.mp4"), clip("late.mp4"),
          clip("late.mp4"), clip("headless.mp4"));
    shell("cp '%s' '%s'; head -c 20000 /dev/zero | dd of='%s' bs=1 seek=40000 conv=notrunc status=none",
          clip("whole.mp4"), clip("holed.mp4"), clip("holed.mp4"));
    fails(clip("sound.mp4"), "no video stream");
    fails(clip("cut.mp4"), "damaged or cut off after");
    fails(clip("headless.mp4"), "damaged, cut off or no video");
    fails(clip("holed.mp4"), "damaged or cut off after");
    fails(scratch_write_bytes("text.mp4", "no video\n", 9), "damaged, cut off or no video");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colours_are_those_of_the_clip),     cmocka_unit_test(clips_stand_upright),
        cmocka_unit_test(wide_pixels_are_stretched),         cmocka_unit_test(a_last_frame_may_be_shown_for_long),
        cmocka_unit_test(interlaced_frames_show_one_moment), cmocka_unit_test(unusable_clips_are_named),
    };
    return cmocka_run_group_tests_name("clip_reader", tests, scratch_make, scratch_remove);
}
