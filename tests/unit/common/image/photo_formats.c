/* photo_formats.c - TIFF, EXR, and raw files (a DNG of known radiance, made here). */
#include "tests/unit/scratch.h"

#include <math.h>
#include <tiffio.h>

#include "common/image/exr.h"
#include "common/image/photo.h"

enum { WIDTH = 9, HEIGHT = 7 };

/* red 20 x, green 30 y, blue 10 (x + y); in 16 bits 257 times that and 1, 2, 3 more */
static int colour(int x, int y, int c, int bits)
{
    const int v = c == 0 ? 20 * x : c == 1 ? 30 * y : 10 * (x + y);
    return bits == 16 ? 257 * v + c + 1 : v;
}

struct kind {
    const char *name;
    int bits, samples, planar, compression, photometric;
    bool tiled;
    int format, alpha; /* SAMPLEFORMAT_UINT is 1; EXTRASAMPLE: 0: none */
};

static const struct kind kinds[] = {
    {"rgb8.tif", 8, 3, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_RGB, false, 1, 0},
    {"rgb16.tif", 16, 3, PLANARCONFIG_CONTIG, COMPRESSION_LZW, PHOTOMETRIC_RGB, false, 1, 0},
    {"rgba16.tif", 16, 4, PLANARCONFIG_CONTIG, COMPRESSION_ADOBE_DEFLATE, PHOTOMETRIC_RGB, false, 1,
     EXTRASAMPLE_UNASSALPHA},
    {"premultiplied8.tif", 8, 4, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_RGB, false, 1,
     EXTRASAMPLE_ASSOCALPHA},
    {"premultiplied16.tif", 16, 4, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_RGB, true, 1,
     EXTRASAMPLE_ASSOCALPHA},
    {"planes16.tif", 16, 3, PLANARCONFIG_SEPARATE, COMPRESSION_NONE, PHOTOMETRIC_RGB, false, 1, 0},
    {"planes8.tif", 8, 3, PLANARCONFIG_SEPARATE, COMPRESSION_LZW, PHOTOMETRIC_RGB, true, 1, 0},
    {"grey8.tif", 8, 1, PLANARCONFIG_CONTIG, COMPRESSION_PACKBITS, PHOTOMETRIC_MINISBLACK, false, 1, 0},
    {"grey16.tif", 16, 1, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_MINISBLACK, false, 1, 0},
    {"white-is-zero.tif", 8, 1, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_MINISWHITE, false, 1, 0},
    {"white-is-zero16.tif", 16, 1, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_MINISWHITE, false, 1, 0},
    {"tiles8.tif", 8, 3, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_RGB, true, 1, 0},
    {"tiles16.tif", 16, 3, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_RGB, true, 1, 0},
    {"tiled-planes16.tif", 16, 3, PLANARCONFIG_SEPARATE, COMPRESSION_LZW, PHOTOMETRIC_RGB, true, 1, 0},
    {"float.tif", 32, 3, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_RGB, false, SAMPLEFORMAT_IEEEFP, 0},
    {"tiled-float.tif", 32, 3, PLANARCONFIG_SEPARATE, COMPRESSION_NONE, PHOTOMETRIC_RGB, true, SAMPLEFORMAT_IEEEFP, 0},
    {"half.tif", 16, 3, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_RGB, false, SAMPLEFORMAT_IEEEFP, 0},
    {"double-grey.tif", 64, 1, PLANARCONFIG_CONTIG, COMPRESSION_NONE, PHOTOMETRIC_MINISBLACK, false,
     SAMPLEFORMAT_IEEEFP, 0},
};

/* Of the pixels, one in three is hidden by an alpha of a quarter; the others have an alpha of 1. */
static bool is_hidden(const struct kind *k, int x, int y) { return k->alpha && (x + y) % 3 == 0; }

/* The number that is stored for a sample of a pixel. */
static double stored(const struct kind *k, int x, int y, int c)
{
    const double largest = k->bits == 16 ? 65535 : 255;
    if (k->format == SAMPLEFORMAT_IEEEFP) return colour(x, y, c, 8) / 64.0; /* exact in half floats */
    if (c == 3) return is_hidden(k, x, y) ? largest / 4 : largest;
    const double value = colour(x, y, c, k->bits);
    return k->alpha == EXTRASAMPLE_ASSOCALPHA && is_hidden(k, x, y) ? value / 4 : value;
}

static void put(unsigned char *to, int i, double value, const struct kind *k)
{
    const size_t size = (size_t)k->bits / 8;
    const uint16_t whole = (uint16_t)lrint(value);
    const float single = (float)value;
    to += (size_t)i * size;
    if (k->format != SAMPLEFORMAT_IEEEFP && size == 1)
        *to = (unsigned char)whole;
    else if (k->format != SAMPLEFORMAT_IEEEFP)
        memcpy(to, &whole, size);
    else if (size == 4)
        memcpy(to, &single, size);
    else if (size == 8)
        memcpy(to, &value, size);
    else { /* half: all values are 0, or normal and exact */
        int exponent = 0;
        const double mantissa = frexp(value, &exponent);
        const uint16_t half =
            value == 0 ? 0 : (uint16_t)((exponent + 14) << 10 | ((unsigned)lrint(mantissa * 2048) & 1023));
        memcpy(to, &half, size);
    }
}

static const char *write_tiff(const struct kind *k)
{
    const char *path = scratch_path(k->name);
    uint64_t exif = 0;
    uint16_t iso = 200;
    TIFF *t = TIFFOpen(path, "w");
    unsigned char line[8 * 4 * 16 * 16];
    assert_non_null(t);
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, WIDTH);
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, HEIGHT);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, k->bits);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, k->samples);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, k->planar);
    TIFFSetField(t, TIFFTAG_COMPRESSION, k->compression);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, k->photometric);
    TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, k->format);
    TIFFSetField(t, TIFFTAG_ORIENTATION, 6);
    TIFFSetField(t, TIFFTAG_MAKE, "remodel");
    TIFFSetField(t, TIFFTAG_MODEL, "a test");
    if (k->alpha) TIFFSetField(t, TIFFTAG_EXTRASAMPLES, 1, (uint16_t[]){(uint16_t)k->alpha});
    const bool apart = k->planar == PLANARCONFIG_SEPARATE;
    const int planes = apart ? k->samples : 1, step = apart ? 1 : k->samples;
    if (k->tiled) {
        TIFFSetField(t, TIFFTAG_TILEWIDTH, 16);
        TIFFSetField(t, TIFFTAG_TILELENGTH, 16);
        for (int plane = 0; plane < planes; plane++) {
            memset(line, 0, sizeof line);
            for (int y = 0; y < HEIGHT; y++)
                for (int i = 0; i < WIDTH * step; i++)
                    put(line, y * 16 * step + i, stored(k, i / step, y, apart ? plane : i % step), k);
            assert_true(TIFFWriteTile(t, line, 0, 0, 0, (uint16_t)plane) > 0);
        }
    } else {
        TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, 3);
        for (int plane = 0; plane < planes; plane++)
            for (int y = 0; y < HEIGHT; y++) {
                for (int i = 0; i < WIDTH * step; i++)
                    put(line, i, stored(k, i / step, y, apart ? plane : i % step), k);
                assert_true(TIFFWriteScanline(t, line, (uint32_t)y, (uint16_t)plane) == 1);
            }
    }
    assert_true(TIFFWriteDirectory(t));
    assert_false(TIFFCreateEXIFDirectory(t));
    TIFFSetField(t, EXIFTAG_EXPOSURETIME, 0.0125);
    TIFFSetField(t, EXIFTAG_FNUMBER, 5.6);
    TIFFSetField(t, EXIFTAG_FOCALLENGTH, 18.0);
    TIFFSetField(t, EXIFTAG_FOCALLENGTHIN35MMFILM, 28);
    TIFFSetField(t, EXIFTAG_ISOSPEEDRATINGS, 1, &iso);
    assert_true(TIFFWriteCustomDirectory(t, &exif));
    assert_true(TIFFSetDirectory(t, 0));
    TIFFSetField(t, TIFFTAG_EXIFIFD, exif);
    assert_true(TIFFRewriteDirectory(t));
    TIFFClose(t);
    return path;
}

static void every_kind_of_tiff_is_read(void **state)
{
    (void)state;
    for (size_t n = 0; n < sizeof kinds / sizeof *kinds; n++) {
        const struct kind *k = &kinds[n];
        const char *path = write_tiff(k);
        struct photo p;
        struct photo_info info;
        struct err err = ERR_INIT;
        const bool real = k->format == SAMPLEFORMAT_IEEEFP;
        int hidden = 0;
        assert_ok(photo_read_any(&p, path, &err), err);
        assert_ok(photo_read_info(&info, path, &err), err);
        assert_memory_equal(&info, &p.info, sizeof info);
        assert_true(p.info.width == WIDTH && p.info.height == HEIGHT && p.info.bits == (real ? 32 : k->bits));
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
            const int x = i / 3 % WIDTH, y = i / 3 / WIDTH, c = k->samples == 1 ? 0 : i % 3;
            const int value = colour(x, y, c, k->bits), largest = k->bits == 16 ? 65535 : 255,
                      wanted = k->photometric == PHOTOMETRIC_MINISWHITE ? largest - value : value,
                      /* a quarter of the value and of alpha were rounded */
                room = k->alpha == EXTRASAMPLE_ASSOCALPHA && is_hidden(k, x, y) ? 2 + wanted / 50 : 0;
            if (real && p.values[i] != (float)stored(k, x, y, c))
                fail_msg("%s: value %d is %g", k->name, i, (double)p.values[i]);
            if (!real && abs(p.samples[i] - wanted) > room)
                fail_msg("%s: sample %d is %d, wanted %d", k->name, i, p.samples[i], wanted);
            hidden += i % 3 == 0 && is_hidden(k, x, y);
        }
        assert_true(fabs(p.transparent - (double)hidden / (WIDTH * HEIGHT)) < 1e-12 && p.pages == 0);
        if (real) {
            struct photo none;
            assert_int_equal(photo_read(&none, path, &err), ST_DATA);
            assert_err(err, ST_DATA, "is a TIFF of floating-point samples");
        }
        assert_int_equal(p.info.orientation, 6);
        assert_float_equal(p.info.seconds, 0.0125, 1e-7);
        assert_float_equal(p.info.f_number, 5.6, 1e-6);
        assert_float_equal(p.info.focal_mm, 18, 1e-6);
        assert_true(p.info.focal35_mm == 28 && p.info.iso == 200);
        assert_string_equal(p.info.make, "remodel");
        assert_string_equal(p.info.model, "a test");
        photo_release(&p);
    }
}

/* The first page is the photo. Reduced copies are no pages. */
static void pages_of_a_tiff_are_counted(void **state)
{
    const char *path = scratch_path("pages.tif");
    const unsigned char row[WIDTH] = {0};
    (void)state;
    TIFF *t = TIFFOpen(path, "w");
    assert_non_null(t);
    for (int page = 0; page < 4; page++) {
        TIFFSetField(t, TIFFTAG_SUBFILETYPE, page == 2 ? FILETYPE_REDUCEDIMAGE : page ? FILETYPE_PAGE : 0);
        TIFFSetField(t, TIFFTAG_IMAGEWIDTH, WIDTH);
        TIFFSetField(t, TIFFTAG_IMAGELENGTH, 1 + page);
        TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        for (int y = 0; y <= page; y++) assert_true(TIFFWriteScanline(t, (void *)row, (uint32_t)y, 0) == 1);
        assert_true(TIFFWriteDirectory(t));
    }
    TIFFClose(t);
    struct photo p;
    struct err err = ERR_INIT;
    assert_ok(photo_read(&p, path, &err), err);
    assert_int_equal(p.info.height, 1);
    assert_int_equal(p.pages, 3);
    photo_release(&p);
}

static void damaged_tiffs_are_errors(void **state)
{
    struct photo p;
    struct stat s;
    (void)state;
    const char *path = write_tiff(&kinds[1]);
    assert_false(stat(path, &s));
    char *all = malloc((size_t)s.st_size);
    FILE *fp = fopen(path, "rb");
    assert_true(all && fp && fread(all, 1, (size_t)s.st_size, fp) == (size_t)s.st_size);
    fclose(fp);
    for (size_t cut = 8; cut < (size_t)s.st_size; cut += 13) { /* truncated anywhere: an image or an error */
        struct err err = ERR_INIT;
        const enum status st = photo_read(&p, scratch_write_bytes("cut.tif", all, cut), &err);
        if (st) assert_contains(err.text, "cut.tif");
        photo_release(&p);
    }
    free(all);
}

static const char *write_exr(const char *name, float max, int clipped)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_path(name);
    assert_ok(exr_image_init(&im, 20, 20, &err), err);
    for (int c = 0; c < 3; c++) {
        struct exr_plane *plane = NULL;
        assert_ok(exr_add_plane(&im, names[c], EXR_FLOAT, &plane, &err), err);
        for (int i = 0; i < 400; i++) plane->f[i] = i < clipped ? max : (float)i * 0.001f * (float)(c + 1);
    }
    im.planes[0].f[399] = -0.25f;
    assert_ok(exr_write(&im, path, NULL, &err), err);
    exr_image_release(&im);
    return path;
}

static void exr_is_read_as_linear(void **state)
{
    struct photo p;
    struct photo_info info;
    struct err err = ERR_INIT;
    (void)state;
    const char *path = write_exr("cut.exr", 3, 30);
    assert_ok(photo_read_any(&p, path, &err), err);
    assert_ok(photo_read_info(&info, path, &err), err);
    assert_memory_equal(&info, &p.info, sizeof info);
    assert_true(p.info.bits == 32 && p.info.width == 20 && !p.samples && p.values);
    assert_true(p.saturation == 3);
    for (int i = 30; i < 399; i++)
        for (int c = 0; c < 3; c++) assert_float_equal(p.values[3 * i + c], (float)i * 0.001f * (float)(c + 1), 1e-7);
    assert_true(p.values[3 * 399] == -0.25f); /* colours outside of Rec.709 stay */
    photo_release(&p);
    assert_ok(photo_read_any(&p, write_exr("whole.exr", 3, 1), &err), err);
    assert_true(p.saturation == 0);
    photo_release(&p);
    assert_int_equal(photo_read(&p, path, &err), ST_DATA);
    assert_err(err, ST_DATA, "is an EXR file; wanted JPEG, PNG, TIFF, HEIC");
}

/* A DNG of an RGGB mosaic, 14 bits, black level 512; camera colours are XYZ, white is D50. After white balance the
 * right half is `level` of white in each camera colour, the left half 0.1 of that. */
static const char *write_dng(const char *name, double level)
{
    enum { SIDE = 64, BLACK = 512, WHITE = 16383 };
    static uint16_t mosaic[SIDE];
    const float matrix[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, neutral[3] = {0.5f, 1, 0.7f};
    const char *path = scratch_path(name);
    TIFF *t = TIFFOpen(path, "w");
    assert_non_null(t);
    TIFFSetField(t, TIFFTAG_SUBFILETYPE, 0);
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, SIDE);
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, SIDE);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 16);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_CFA);
    TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, SIDE);
    TIFFSetField(t, TIFFTAG_ORIENTATION, 6);
    TIFFSetField(t, TIFFTAG_MAKE, "remodel");
    TIFFSetField(t, TIFFTAG_MODEL, "raw");
    TIFFSetField(t, TIFFTAG_DNGVERSION, "\1\4\0\0");
    TIFFSetField(t, TIFFTAG_DNGBACKWARDVERSION, "\1\1\0\0");
    TIFFSetField(t, TIFFTAG_UNIQUECAMERAMODEL, "remodel raw");
    TIFFSetField(t, TIFFTAG_CFAREPEATPATTERNDIM, (uint16_t[]){2, 2});
    TIFFSetField(t, TIFFTAG_CFAPATTERN, 4, "\0\1\1\2");
    TIFFSetField(t, TIFFTAG_BLACKLEVEL, 1, (float[]){BLACK});
    TIFFSetField(t, TIFFTAG_WHITELEVEL, 1, (uint32_t[]){WHITE});
    TIFFSetField(t, TIFFTAG_COLORMATRIX1, 9, matrix);
    TIFFSetField(t, TIFFTAG_CALIBRATIONILLUMINANT1, 21); /* D65 */
    TIFFSetField(t, TIFFTAG_ASSHOTNEUTRAL, 3, neutral);
    for (int y = 0; y < SIDE; y++) {
        for (int x = 0; x < SIDE; x++) {
            const int c = x % 2 + y % 2; /* R G G B */
            const double light = level * (x < SIDE / 2 ? 0.1 : 1) * (double)neutral[c];
            mosaic[x] = (uint16_t)lrint(BLACK + (light < 1 ? light : 1) * (WHITE - BLACK));
        }
        assert_true(TIFFWriteScanline(t, mosaic, (uint32_t)y, 0) == 1);
    }
    TIFFClose(t);
    return path;
}

static void raw_files_are_developed_to_linear_light(void **state)
{
    struct photo a, b;
    struct photo_info info;
    struct err err = ERR_INIT;
    (void)state;
    const char *bright = write_dng("bright.dng", 0.8), *dim = write_dng("dim.dng", 0.2);
    assert_ok(photo_read_any(&a, bright, &err), err);
    assert_ok(photo_read_any(&b, dim, &err), err);
    assert_ok(photo_read_info(&info, bright, &err), err);
    assert_memory_equal(&info, &a.info, sizeof info);
    print_message("%d x %d, %s %s, orientation %d\n", a.info.width, a.info.height, a.info.make, a.info.model,
                  a.info.orientation);
    assert_true(a.info.bits == 32 && a.values && !a.samples && a.saturation == 1);
    assert_int_equal(a.info.orientation, 6);
    const int width = a.info.width, y = a.info.height / 2;
    const float *left = a.values + 3 * (y * width + width / 4), *right = a.values + 3 * (y * width + 3 * width / 4),
                *dimmer = b.values + 3 * (y * width + 3 * width / 4);
    print_message("left %g %g %g, right %g %g %g, dimmer %g %g %g\n", (double)left[0], (double)left[1], (double)left[2],
                  (double)right[0], (double)right[1], (double)right[2], (double)dimmer[0], (double)dimmer[1],
                  (double)dimmer[2]);
    for (int c = 0; c < 3; c++) { /* neutral is grey; radiance is proportional, within an image and between images */
        assert_float_equal(right[c], right[1], 0.01 * right[1]);
        assert_float_equal(left[c] / right[c], 0.1, 0.002);
        assert_float_equal(dimmer[c] / right[c], 0.25, 0.002);
    }
    assert_float_equal(right[1], 0.8, 0.01);
    photo_release(&a);
    photo_release(&b);
    assert_int_equal(photo_read(&a, bright, &err), ST_DATA);
    assert_err(err, ST_DATA, "is a camera's raw file; wanted JPEG");
}

static void damaged_raw_files_are_errors(void **state)
{
    struct photo p;
    struct stat s;
    struct err err = ERR_INIT;
    (void)state;
    const char *path = write_dng("whole.dng", 0.5);
    assert_false(stat(path, &s));
    char *all = malloc((size_t)s.st_size);
    FILE *fp = fopen(path, "rb");
    assert_true(all && fp && fread(all, 1, (size_t)s.st_size, fp) == (size_t)s.st_size);
    fclose(fp);
    assert_int_equal(
        photo_read_any(&p, scratch_write_bytes("nothing.raf", "FUJIFILMCCD-RAW 0201 and nothing more", 37), &err),
        ST_DATA);
    assert_err(err, ST_DATA, "nothing.raf is a raw file that cannot be read (libraw:");
    for (size_t cut = 16; cut < (size_t)s.st_size; cut += (size_t)s.st_size / 7) {
        struct err e = ERR_INIT;
        const enum status st = photo_read_any(&p, scratch_write_bytes("cut.dng", all, cut), &e);
        if (st) assert_contains(e.text, "cut.dng");
        photo_release(&p);
    }
    free(all);
}

static void unknown_formats_are_refused(void **state)
{
    struct photo p;
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(photo_read_any(&p, scratch_write("a.gif", "GIF89a and so on"), &err), ST_DATA);
    assert_err(err, ST_DATA, "JPEG XL, EXR nor a known raw format (it begins with the bytes 47 49 46");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_tiff_is_read),
        cmocka_unit_test(pages_of_a_tiff_are_counted),
        cmocka_unit_test(damaged_tiffs_are_errors),
        cmocka_unit_test(exr_is_read_as_linear),
        cmocka_unit_test(raw_files_are_developed_to_linear_light),
        cmocka_unit_test(damaged_raw_files_are_errors),
        cmocka_unit_test(unknown_formats_are_refused),
    };
    return cmocka_run_group_tests_name("photo_formats", tests, scratch_make, scratch_remove);
}
