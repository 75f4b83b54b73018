/* given_map.c - depth files of several formats have the same samples; names, sentinels and errors. */
#include "tests/unit/scratch.h"

#include <math.h>
#include <tiffio.h>

#include "stages/segment_depth/given_map.h"

enum { W = 7, H = 5 };

static double ramp(int x, int y) { return 2 + x + 10 * y; }

static void write_pfm(const char *name, const char *head, bool most_first)
{
    unsigned char bytes[64 + 4 * W * H];
    size_t n = (size_t)snprintf((char *)bytes, 64, "%s", head);
    for (int y = H - 1; y >= 0; y--) /* from the bottom up */
        for (int x = 0; x < W; x++) {
            const float sample = (float)ramp(x, y);
            uint32_t bits;
            memcpy(&bits, &sample, 4);
            for (int k = 0; k < 4; k++) bytes[n++] = (unsigned char)(bits >> 8 * (most_first ? 3 - k : k));
        }
    scratch_write_bytes(name, bytes, n);
}

static void write_tiff(const char *name, int bits, int format, int channels)
{
    TIFF *t = TIFFOpen(scratch_path(name), "w");
    assert_non_null(t);
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, W);
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, H);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, format);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, channels);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
    for (int y = 0; y < H; y++) {
        unsigned char row[8 * 4 * W] = {0};
        for (int x = 0; x < W * channels; x++) {
            const double v = ramp(x / channels, y);
            const float f = (float)v;
            const uint32_t u32 = (uint32_t)v;
            const uint16_t u16 = (uint16_t)v;
            if (bits == 64) memcpy(row + 8 * x, &v, 8);
            if (bits == 32) memcpy(row + 4 * x, format == SAMPLEFORMAT_IEEEFP ? (const void *)&f : &u32, 4);
            if (bits == 16) memcpy(row + 2 * x, &u16, 2);
        }
        assert_true(TIFFWriteScanline(t, row, (uint32_t)y, 0) >= 0);
    }
    TIFFClose(t);
}

static void expect_ramp(const char *name, bool whole_numbers)
{
    struct given_map m;
    struct err err = ERR_INIT;
    assert_ok(given_map_read(&m, scratch_path(name), &err), err);
    assert_int_equal(m.width, W);
    assert_int_equal(m.height, H);
    assert_int_equal(m.whole_numbers, whole_numbers);
    for (int i = 0; i < W * H; i++) assert_true(m.samples[i] == ramp(i % W, i / W));
    given_map_release(&m);
}

static void formats_have_the_same_samples(void **state)
{
    (void)state;
    write_pfm("a.pfm", "Pf\n7 5\n-1.0\n", false);
    write_pfm("b.PFM", "Pf 7 5 1\n", true);
    expect_ramp("a.pfm", false);
    expect_ramp("b.PFM", false);
    static const int kinds[][2] = {{32, SAMPLEFORMAT_IEEEFP}, {64, SAMPLEFORMAT_IEEEFP}, {16, SAMPLEFORMAT_UINT},
                                   {32, SAMPLEFORMAT_UINT},   {16, SAMPLEFORMAT_INT},    {32, SAMPLEFORMAT_INT}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        write_tiff(i % 2 ? "c.tiff" : "c.TIF", kinds[i][0], kinds[i][1], 1);
        expect_ramp(i % 2 ? "c.tiff" : "c.TIF", kinds[i][1] != SAMPLEFORMAT_IEEEFP);
    }
}

static void refused(const char *name, const char *words)
{
    struct given_map m;
    struct err err = ERR_INIT;
    assert_int_equal(given_map_read(&m, scratch_path(name), &err), ST_DATA);
    assert_err(err, ST_DATA, words);
    assert_null(m.samples);
}

static void what_is_no_map_is_refused_by_name(void **state)
{
    (void)state;
    write_pfm("p.pfm", "PF\n7 5\n-1.0\n", false);
    refused("p.pfm", "p.pfm is no grey PFM; wanted \"Pf\", width, height and the order of bytes, but it is of colours");
    write_pfm("p.pfm", "Pf\n70 5\n-1.0\n", false);
    refused("p.pfm", "p.pfm has 140 bytes of samples, wanted 1400; it was cut off");
    write_pfm("p.pfm", "Pf\n9999999 9999999\n-1.0\n", false);
    refused("p.pfm", "has 9999999 x 9999999 pixels");
    scratch_write("p.pfm", "Pf\n7");
    refused("p.pfm", "is no grey PFM");
    scratch_write("t.tif", "not a TIFF");
    refused("t.tif", "t.tif is no TIFF that can be read");
    write_tiff("t.tif", 16, SAMPLEFORMAT_UINT, 3);
    refused("t.tif", "t.tif has 3 channels of 16 bits, whole numbers; wanted one channel");
    write_tiff("t.tif", 64, SAMPLEFORMAT_UINT, 1);
    refused("t.tif", "t.tif has 1 channels of 64 bits");
    write_tiff("t.tif", 32, SAMPLEFORMAT_IEEEFP, 1);
    assert_int_equal(truncate(scratch_path("t.tif"), 20), 0);
    refused("t.tif", "t.tif is no TIFF that can be read");
    scratch_write("x.npy", "");
    refused("x.npy", "x.npy is none of .exr, .png, .pfm, .tif and .tiff");
}

static void files_are_found_by_the_views_name(void **state)
{
    (void)state;
    char *path;
    struct err err = ERR_INIT;
    mkdir(scratch_path("found"), 0777);
    /* each is preferred to those before it */
    static const char *const files[] = {"V1.TIFF", "V1.exr", "v1.tiff", "v1.tif",
                                        "v1.PFM",  "v1.png", "v1.EXR",  "v1.exr"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char name[64];
        snprintf(name, sizeof name, "found/%s", files[i]);
        scratch_write(name, "");
        scratch_write("found/v11.exr", "");
        scratch_write("found/v1.npy", "");
        assert_ok(given_map_find(&path, scratch_path("found"), "v1", &err), err);
        assert_non_null(path);
        assert_string_equal(strrchr(path, '/') + 1, files[i]);
        free(path);
    }
    assert_ok(given_map_find(&path, scratch_path("found"), "v", &err), err);
    assert_null(path);
}

/* ------------------------------------------------------------------------------------------------------- sentinels */

enum { N = 1000 };

/* Depths 1 to 2; the first `count` are `value`. */
static struct given_map with_sentinel(double value, int count)
{
    static double samples[N];
    struct err err = ERR_INIT;
    struct given_map m = {.width = N, .height = 1, .samples = samples};
    for (int i = 0; i < N; i++) samples[i] = i < count ? value : 1 + (double)i / N;
    assert_ok(given_map_clear_sentinel(&m, &err), err);
    return m;
}

static void one_extreme_value_that_is_repeated_is_unknown(void **state)
{
    (void)state;
    static const double values[] = {1e10, 65535, 4.1, -1, -9999, 3.4e38};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
        const struct given_map m = with_sentinel(values[k], 100);
        assert_int_equal(m.sentinels, 100);
        assert_true(m.sentinel == values[k]);
        for (int i = 0; i < N; i++) assert_int_equal(isnan(m.samples[i]), i < 100);
    }
}

static void other_samples_are_kept(void **state)
{
    (void)state;
    static const struct {
        double value;
        int count;
    } cases[] = {
        {1e10, GIVEN_REPEATED - 1}, /* a few pixels may be far */
        {2.5, 500},                 /* a wall behind all that is in front of it */
        {0, 500},                   /* unknown anyway */
        {5, N},                     /* nothing else */
        {-1, 3},                    /* not a mark, but an error */
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const struct given_map m = with_sentinel(cases[k].value, cases[k].count);
        assert_int_equal(m.sentinels, 0);
        for (int i = 0; i < N; i++) assert_false(isnan(m.samples[i]));
    }
    /* a sky at many different distances */
    struct given_map m = with_sentinel(0, 0);
    struct err err = ERR_INIT;
    for (int i = 0; i < 100; i++) m.samples[i] = 1e6 + i;
    assert_ok(given_map_clear_sentinel(&m, &err), err);
    assert_int_equal(m.sentinels, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formats_have_the_same_samples),
        cmocka_unit_test(what_is_no_map_is_refused_by_name),
        cmocka_unit_test(files_are_found_by_the_views_name),
        cmocka_unit_test(one_extreme_value_that_is_repeated_is_unknown),
        cmocka_unit_test(other_samples_are_kept),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
