/* photo.c - all kinds of JPEG and PNG, EXIF, damaged files, written files. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/image/photo.h"

#define CORPUS "tests/fuzz/corpus/photo/"

static struct photo read_good(const char *name)
{
    char path[100];
    struct photo p;
    struct photo_info info;
    struct err err = ERR_INIT;
    snprintf(path, sizeof path, CORPUS "%s", name);
    assert_ok(photo_read(&p, path, &err), err);
    assert_ok(photo_read_info(&info, path, &err), err);
    assert_memory_equal(&info, &p.info, sizeof info);
    return p;
}

/* The 7x5 PNGs of the corpus hold 16 x, 16 y, 8 (x + y) in 8 bits, 4096 x + 1, 4096 y + 2, 2048 (x + y) + 3 in 16. */
static void colour_pngs_are_read(void **state)
{
    const char *const eight[] = {"rgb8.png", "rgba8.png", "rgb-transparent.png", "interlaced.png"};
    const char *const sixteen[] = {"rgb16.png", "rgba16.png"};
    (void)state;
    for (int i = 0; i < 6; i++) {
        struct photo p = read_good(i < 4 ? eight[i] : sixteen[i - 4]);
        assert_true(p.info.width == 7 && p.info.height == 5 && p.info.bits == (i < 4 ? 8 : 16));
        for (int y = 0; y < 5; y++) {
            for (int x = 0; x < 7; x++) {
                const uint16_t *s = p.samples + 3 * (y * 7 + x);
                if (i < 4)
                    assert_true(s[0] == 16 * x && s[1] == 16 * y && s[2] == 8 * (x + y));
                else
                    assert_true(s[0] == 4096 * x + 1 && s[1] == 4096 * y + 2 && s[2] == 2048 * (x + y) + 3);
            }
        }
        photo_release(&p);
    }
}

static void grey_and_palette_pngs_are_read(void **state)
{
    const char *const grey[] = {"grey8.png", "grey-alpha.png", "grey-transparent.png", "grey16.png"};
    const char *const palette[] = {"palette.png", "palette-transparent.png"};
    const uint16_t colours[] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 8, 7};
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct photo p = read_good(grey[i]);
        for (int k = 0; k < 7 * 5; k++) {
            int wanted = i == 3 ? 4096 * (k % 7) + k / 7 : 16 * (k % 7) + k / 7;
            for (int c = 0; c < 3; c++) assert_int_equal(p.samples[3 * k + c], wanted);
        }
        photo_release(&p);
    }
    for (int i = 0; i < 2; i++) {
        struct photo p = read_good(palette[i]);
        for (int y = 0; y < 3; y++) assert_memory_equal(p.samples + y * 12, colours, sizeof colours);
        photo_release(&p);
    }
    struct photo p = read_good("grey1.png"); /* 10110001 */
    const int bits[] = {1, 0, 1, 1, 0, 0, 0, 1};
    for (int x = 0; x < 8; x++) assert_int_equal(p.samples[3 * x], 255 * bits[x]);
    photo_release(&p);
}

/* 16x12, about 15 x, 20 y, 128; decoders may differ by a few steps. */
static void colour_jpegs_are_read(void **state)
{
    const char *const files[] = {"rgb.jpg", "progressive.jpg", "full-chroma.jpg", "padded-end.jpg", "trailing.jpg"};
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct photo p = read_good(files[i]);
        assert_true(p.info.width == 16 && p.info.height == 12 && p.info.bits == 8 && p.info.orientation == 1);
        for (int k = 0; k < 16 * 12; k++) {
            const uint16_t *s = p.samples + 3 * k;
            assert_true(abs(s[0] - 15 * (k % 16)) < 12 && abs(s[1] - 20 * (k / 16)) < 12 && abs(s[2] - 128) < 12);
        }
        photo_release(&p);
    }
    struct photo p = read_good("grey.jpg");
    for (int k = 0; k < 16 * 12; k++)
        assert_true(p.samples[3 * k] == p.samples[3 * k + 1] && p.samples[3 * k] == p.samples[3 * k + 2]);
    photo_release(&p);
}

/* 64 x 48 pixels of 4 x, 5 y, 128 in 8 bits; 1024 x + 3, 1280 y + 5, 32768 in 16, stored with `bits`. */
static void other_formats_are_read(void **state)
{
    static const struct {
        const char *file;
        int bits, most; /* most: difference in steps of 8 or 10 bits; encoders round to YCbCr, deep.avif is lossy */
    } cases[] = {
        {"rgb.heic", 8, 1}, {"turned.heic", 8, 1}, {"rgb.avif", 8, 1},  {"rgb.webp", 8, 0},
        {"rgb.jxl", 8, 0},  {"deep.heic", 10, 2},  {"deep.jxl", 16, 0}, {"deep.avif", 10, 6},
    };
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct photo p = read_good(cases[k].file);
        const bool deep = cases[k].bits > 8, turned = strstr(cases[k].file, "turned");
        assert_int_equal(p.info.bits, deep ? 16 : 8);
        assert_true(p.info.width == (turned ? 48 : 64) && p.info.height == (turned ? 64 : 48));
        assert_int_equal(p.info.orientation, 1);
        int worst = 0;
        for (int y = 0; y < 48; y++)
            for (int x = 0; x < 64; x++) {
                /* turned by 90 degrees clockwise: the left column becomes the top row */
                const uint16_t *s = p.samples + 3 * (turned ? x * 48 + 47 - y : y * 64 + x);
                const int wanted[] = {deep ? 1024 * x + 3 : 4 * x, deep ? 1280 * y + 5 : 5 * y, deep ? 32768 : 128};
                for (int c = 0; c < 3; c++) worst = abs(s[c] - wanted[c]) > worst ? abs(s[c] - wanted[c]) : worst;
            }
        print_message("%s: largest difference %d\n", cases[k].file, worst);
        if (worst > cases[k].most * (deep ? 64 : 1)) fail_msg("%s is off by %d", cases[k].file, worst);
        photo_release(&p);
    }
}

/* A HEIC stands upright already; its camera's EXIF may say otherwise. */
static void exif_is_read(void **state)
{
    const char *const files[] = {"exif.jpg",  "exif-big-endian.jpg", "exif.png", "exif-after-data.png",
                                 "exif.heic", "exif.webp",           "exif.jxl"};
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct photo p = read_good(files[i]);
        const struct photo_info *info = &p.info;
        assert_int_equal(info->orientation, strstr(files[i], "heic") ? 1 : 6);
        assert_true(info->focal_mm == 5.85 && info->focal35_mm == 35 && info->seconds == 1 / 250.0);
        assert_true(info->f_number == 2.8 && info->iso == 400);
        assert_string_equal(info->make, "Mker"); /* printable ASCII of "  M\xc3\xa4ker\n " */
        assert_string_equal(info->model, "Model \"7\" #x");
        photo_release(&p);
    }
}

static void times_of_exif_are_seconds(void **state)
{
    const struct {
        const char *date, *subseconds;
        double seconds;
    } cases[] = {
        {"2024:05:01 12:02:02", "", 1714564922},
        {"2024:05:01 12:02:02", "35", 1714564922.35},
        {"2024:05:01 12:02:02", "5 ", 1714564922.5},
        {"2024:05:01 12:02:02", "x", 1714564922},
        {"2024:02:29 00:00:00", "", 1709164800},
        {"1970:01:01 00:00:01", "", 1},
        {"0000:00:00 00:00:00", "", 0},
        {"    :  :     :  :  ", "", 0},
        {"2024:13:01 12:02:02", "", 0},
        {"2024:05:01", "", 0},
        {"2024:05:01 12:61:02", "", 0},
        {"", "123456789123456789", 0},
        {"2024:05:01 12:02:02", "123456789123456789", 1714564922.123456789},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        assert_true(fabs(photo_time(cases[i].date, cases[i].subseconds) - cases[i].seconds) < 1e-6);
}

/* False or truncated EXIF loses its values, never the pixels. */
/* A sample of the picture that EXIF's orientation shows, at column x of row y. */
static int shown(const struct photo *p, int orientation, int x, int y)
{
    const int w = p->info.width, h = p->info.height, across = w - 1, down = h - 1;
    const int u[] = {x, across - x, across - x, x, y, y, across - y, across - y},
              v[] = {y, y, down - y, down - y, x, down - x, down - x, x};
    return p->samples[3 * (v[orientation - 1] * w + u[orientation - 1])];
}

/* Rows of mirrored photos are reversed, and a turn is left, which shows the same picture. */
static void mirrored_photos_lose_their_mirror(void **state)
{
    enum { W = 5, H = 3 };
    (void)state;
    for (int orientation = 1; orientation <= 8; orientation++) {
        struct photo made = {.info = {.width = W, .height = H, .bits = 8, .orientation = orientation}}, read;
        struct photo_info header;
        struct err err = ERR_INIT;
        const char *path = scratch_path("turned.png");
        assert_ok(photo_init_samples(&made, &err), err);
        for (int i = 0; i < W * H * 3; i++) made.samples[i] = (uint16_t)(i / 3 * 7);
        assert_ok(photo_write_part(path, &made, 0, 0, W, H, &made.info, &err), err);
        assert_ok(photo_read(&read, path, &err), err);
        assert_ok(photo_read_info(&header, path, &err), err);
        const int left = read.info.orientation;
        assert_int_equal(header.orientation, left);
        assert_true(left == 1 || left == 3 || left == 6 || left == 8);
        const bool mirrored = orientation == 2 || orientation == 4 || orientation == 5 || orientation == 7;
        assert_int_equal(mirrored, left != orientation);
        const int width = orientation > 4 ? H : W, height = orientation > 4 ? W : H;
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) assert_int_equal(shown(&read, left, x, y), shown(&made, orientation, x, y));
        photo_release(&made);
        photo_release(&read);
    }
}

/* Those with an alpha below a half. */
static void transparent_pixels_are_counted(void **state)
{
    static const struct {
        const char *file;
        double share;
    } wanted[] = {{"rgb8.png", 0}, {"rgba8.png", 5 / 7.0}, {"rgba16.png", 4 / 7.0}, {"rgb-transparent.png", 1 / 35.0}};
    (void)state;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        struct photo p = read_good(wanted[i].file);
        assert_true(p.transparent == wanted[i].share);
        photo_release(&p);
    }
}

static void damaged_exif_keeps_the_pixels(void **state)
{
    const char *const files[] = {"exif-bad-offsets.jpg",    "exif-cut.jpg",        "exif-empty.jpg", "exif-loop.jpg",
                                 "exif-no-denominator.jpg", "exif-wrong-types.jpg"};
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        struct photo p = read_good(files[i]);
        assert_true(p.info.orientation >= 1 && p.info.orientation <= 8);
        assert_true(p.info.focal_mm == 0 && p.info.seconds == 0 && p.info.make[0] == 0);
        photo_release(&p);
    }
}

static void damaged_files_are_errors(void **state)
{
    const char *const cases[][2] = {
        {"no-such.jpg", "cannot open"},
        {"empty.jpg", "is empty"},
        {"two-bytes.jpg", "neither JPEG"},
        {"gif.jpg", "47 49 46 38"},
        {"text.png", "neither JPEG, PNG"},
        {"cmyk.jpg", "is a CMYK JPEG"},
        {"cut.heic", "cut.heic is a damaged or cut-off HEIC"},
        {"cut.avif", "cut.avif is a damaged or cut-off HEIC"},
        {"cut-in-header.heic", "damaged"},
        {"cut.webp", "damaged or cut-off WebP"},
        {"cut.jxl", "damaged or cut-off JPEG XL"},
        {"cut.jpg", "cut-off JPEG"},
        {"cut-before-end.jpg", "cut-off JPEG"},
        {"cut-in-header.jpg", "header"},
        {"progressive-cut.jpg", "cut-off JPEG"},
        {"bad-code.jpg", "damaged"},
        {"zero-height.jpg", "damaged"},
        {"too-large.jpg", "65500"},
        {"twelve-bits.jpg", "precision 12"},
        {"cut-in-data.png", "cut-off PNG"},
        {"cut-before-end.png", "cut-off PNG"},
        {"cut-in-header.png", "cut-off PNG"},
        {"short-data.png", "cut-off PNG"},
        {"bad-crc.png", "damaged"},
        {"palette-missing.png", "damaged"},
        {"zero-size.png", "damaged"},
        {"too-large.png", "65535 x 65535"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char path[100];
        struct err err = ERR_INIT;
        struct photo p;
        snprintf(path, sizeof path, CORPUS "%s", cases[i][0]);
        assert_int_not_equal(photo_read(&p, path, &err), ST_OK);
        assert_err(err, i ? ST_DATA : ST_IO, cases[i][1]);
        assert_contains(err.text, path);
        assert_null(p.samples);
    }
    struct err err = ERR_INIT;
    struct photo p;
    assert_int_equal(photo_read(&p, "tests", &err), ST_IO);
    assert_err(err, ST_IO, "tests");
}

/* A file truncated anywhere is an error, not an image with a grey lower half. */
static void truncated_files_are_errors(void **state)
{
    const char *const files[] = {CORPUS "rgb.jpg", CORPUS "progressive.jpg", CORPUS "rgb8.png",
                                 CORPUS "interlaced.png"};
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        unsigned char bytes[4096];
        FILE *fp = fopen(files[i], "rb");
        assert_non_null(fp);
        size_t size = fread(bytes, 1, sizeof bytes, fp);
        fclose(fp);
        for (size_t cut = 0; cut < size; cut++) {
            struct photo p;
            struct err err = ERR_INIT;
            assert_int_equal(photo_read(&p, scratch_write_bytes("cut", bytes, cut), &err), ST_DATA);
            assert_err(err, ST_DATA, "cut");
        }
    }
}

static void photos_are_linearised(void **state)
{
    const char *const files[] = {"rgb8.png", "rgb16.png"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct photo p = read_good(files[i]);
        struct image im;
        struct err err = ERR_INIT;
        double white = i ? 65535 : 255;
        assert_ok(photo_to_linear(&im, &p, &err), err);
        assert_true(im.width == 7 && im.height == 5 && im.channels == 3);
        for (int k = 0; k < 7 * 5 * 3; k++) {
            double v = p.samples[k] / white, wanted = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
            assert_true(fabs(im.data[k] - wanted) < 2e-7);
        }
        image_release(&im);
        photo_release(&p);
    }
}

static void written_images_read_back(void **state)
{
    static unsigned char rgb[40 * 30 * 3], grey[40 * 30];
    struct err err = ERR_INIT;
    struct photo p;
    (void)state;
    for (int i = 0; i < 40 * 30; i++) {
        grey[i] = (unsigned char)(i * 7);
        rgb[3 * i] = (unsigned char)(i % 40 * 6);
        rgb[3 * i + 1] = (unsigned char)(i / 40 * 8);
        rgb[3 * i + 2] = 100;
    }
    assert_ok(png_write(scratch_path("rgb.png"), rgb, 40, 30, 3, &err), err);
    assert_ok(photo_read(&p, scratch_path("rgb.png"), &err), err);
    for (int i = 0; i < 40 * 30 * 3; i++) assert_int_equal(p.samples[i], rgb[i]);
    photo_release(&p);
    assert_ok(png_write(scratch_path("grey.png"), grey, 40, 30, 1, &err), err);
    assert_ok(photo_read(&p, scratch_path("grey.png"), &err), err);
    for (int i = 0; i < 40 * 30; i++) assert_int_equal(p.samples[3 * i + 1], grey[i]);
    photo_release(&p);

    assert_ok(jpeg_write(scratch_path("rgb.jpg"), rgb, 40, 30, 95, &err), err);
    assert_ok(photo_read(&p, scratch_path("rgb.jpg"), &err), err);
    for (int i = 0; i < 40 * 30 * 3; i++) assert_true(abs(p.samples[i] - rgb[i]) < 12);
    photo_release(&p);

    unsigned char *one = NULL, *two = NULL;
    size_t one_size = 0, two_size = 0;
    assert_ok(jpeg_encode(&one, &one_size, rgb, 40, 30, 95, &err), err);
    assert_ok(jpeg_encode(&two, &two_size, rgb, 40, 30, 95, &err), err);
    assert_int_equal(one_size, two_size);
    assert_memory_equal(one, two, one_size);
    free(one);
    free(two);

    assert_int_equal(png_write(scratch_path("x.png"), rgb, 40, 30, 2, &err), ST_INTERNAL);
    err = (struct err)ERR_INIT;
    assert_int_equal(png_write(scratch_path("rgb.png/x.png"), rgb, 40, 30, 3, &err), ST_IO);
}

/* Written EXIF reads back, exposure times exactly; unknown values stay unknown. */
static void exif_is_written(void **state)
{
    const double seconds[] = {1.0 / 8000, 1.0 / 240, 1.0 / 60, 0.3, 1, 2.5, 30};
    unsigned char rgb[16 * 12 * 3];
    struct photo_info info;
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < 16 * 12 * 3; i++) rgb[i] = (unsigned char)(i * 5);
    for (size_t i = 0; i < sizeof seconds / sizeof *seconds; i++) {
        const struct photo_info info_written = {0,
                                                0,
                                                0,
                                                1,
                                                24.5,
                                                33,
                                                seconds[i],
                                                5.6,
                                                400,
                                                "remodel",
                                                "lens of 24 mm",
                                                1714564922.25 + 86400 * (double)i,
                                                "",
                                                false};
        const char *path = scratch_path("exif.jpg");
        assert_ok(photo_write_jpeg(path, rgb, 16, 12, 90, &info_written, &err), err);
        assert_ok(photo_read_info(&info, path, &err), err);
        assert_true(info.width == 16 && info.height == 12 && info.bits == 8 && info.orientation == 1);
        assert_true(fabs(info.seconds - seconds[i]) < 1e-12 && info.f_number == 5.6 && info.iso == 400);
        assert_true(info.focal_mm == 24.5 && info.focal35_mm == 33);
        assert_true(fabs(info.taken - info_written.taken) < 1e-6);
        assert_string_equal(info.make, "remodel");
        assert_string_equal(info.model, "lens of 24 mm");
    }
    const struct photo_info nothing = {0};
    struct photo p;
    assert_ok(photo_write_jpeg(scratch_path("bare.jpg"), rgb, 16, 12, 90, &nothing, &err), err);
    assert_ok(photo_read(&p, scratch_path("bare.jpg"), &err), err);
    assert_true(p.info.seconds == 0 && p.info.focal_mm == 0 && !*p.info.make && p.info.orientation == 1);
    photo_release(&p);
    assert_int_equal(photo_write_jpeg(scratch_path("bare.jpg/x.jpg"), rgb, 16, 12, 90, &nothing, &err), ST_IO);
}

/* Samples of 8 and 16 bits and EXIF of a part read back as in the photo. */
static void a_written_part_keeps_the_samples(void **state)
{
    static uint16_t samples[20 * 10 * 3];
    struct err err = ERR_INIT;
    (void)state;
    for (int bits = 8; bits <= 16; bits += 8) {
        const struct photo_info info_written = {
            0, 0, 0, 6, 24.5, 70, 1.0 / 60, 5.6, 400, "remodel", "nine lenses", 1e9 + 0.9996, "", false};
        struct photo part, p = {.info = {.width = 20, .height = 10, .bits = bits}, .samples = samples};
        for (int i = 0; i < 20 * 10 * 3; i++) samples[i] = (uint16_t)(i * 109 % (bits == 8 ? 256 : 65536));
        assert_ok(photo_write_part(scratch_path("part.png"), &p, 13, 4, 7, 6, &info_written, &err), err);
        assert_ok(photo_read(&part, scratch_path("part.png"), &err), err);
        assert_true(part.info.width == 7 && part.info.height == 6 && part.info.bits == bits);
        for (int y = 0; y < 6; y++)
            for (int i = 0; i < 7 * 3; i++)
                assert_int_equal(part.samples[y * 21 + i], samples[(y + 4) * 60 + 13 * 3 + i]);
        assert_true(part.info.orientation == 6 && part.info.focal_mm == 24.5 && part.info.focal35_mm == 70);
        assert_true(fabs(part.info.seconds - 1.0 / 60) < 1e-12 && part.info.f_number == 5.6 && part.info.iso == 400);
        assert_string_equal(part.info.model, "nine lenses");
        assert_true(part.info.taken == 1e9 + 1); /* to milliseconds */
        photo_release(&part);
    }
}

/* Quality 50 uses the luma table of the standard (ITU-T T.81, table K.1) as it is; twice the step, four times the
 * variance. */
static void the_variance_of_quantization_is_that_of_the_table(void **state)
{
    static const int luma[64] = {16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,
                                 14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,
                                 18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,
                                 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};
    static const int qualities[] = {50, 25};
    const struct photo_info info = {.orientation = 1};
    unsigned char rgb[3 * 16 * 16] = {0};
    double variance = 0;
    (void)state;
    for (int k = 0; k < 64; k++) variance += luma[k] * luma[k] / (64 * 12.0);
    for (int i = 0; i < 2; i++) {
        struct photo p;
        struct err err = ERR_INIT;
        assert_ok(photo_write_jpeg(scratch_path("q.jpg"), rgb, 16, 16, qualities[i], &info, &err), err);
        assert_ok(photo_read(&p, scratch_path("q.jpg"), &err), err);
        assert_float_equal(p.jpeg_variance / (variance * (i ? 4 : 1)), 1, 1e-3);
        photo_release(&p);
    }
    struct photo png = read_good("rgb8.png");
    assert_true(png.jpeg_variance == 0);
    photo_release(&png);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colour_pngs_are_read),
        cmocka_unit_test(grey_and_palette_pngs_are_read),
        cmocka_unit_test(colour_jpegs_are_read),
        cmocka_unit_test(other_formats_are_read),
        cmocka_unit_test(exif_is_read),
        cmocka_unit_test(times_of_exif_are_seconds),
        cmocka_unit_test(mirrored_photos_lose_their_mirror),
        cmocka_unit_test(transparent_pixels_are_counted),
        cmocka_unit_test(damaged_exif_keeps_the_pixels),
        cmocka_unit_test(damaged_files_are_errors),
        cmocka_unit_test(truncated_files_are_errors),
        cmocka_unit_test(photos_are_linearised),
        cmocka_unit_test(written_images_read_back),
        cmocka_unit_test(exif_is_written),
        cmocka_unit_test(the_variance_of_quantization_is_that_of_the_table),
        cmocka_unit_test(a_written_part_keeps_the_samples),
    };
    return cmocka_run_group_tests_name("photo", tests, scratch_make, scratch_remove);
}
