/* photo_colour.c - photos in other colour spaces than sRGB become linear Rec.709. */
#include "tests/unit/scratch.h"

#include <math.h>
#include <png.h>
#include <tiffio.h>

#include "common/image/exr.h"
#include "common/image/photo.h"

static const struct chromaticities p3 = {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}},
                                   rec709 = {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}},
                                   aces = {{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}}};

/* Display P3's red, green and blue in linear Rec.709, one column each (published, to four digits). */
static const double p3_to_rec709[3][3] = {{1.2249, -0.2247, 0}, {-0.0420, 1.0419, 0}, {-0.0197, -0.0786, 1.0979}};

static struct colour_space *space_of(const struct chromaticities *c, double gamma, int bits)
{
    struct colour_space *space = NULL;
    struct err err = ERR_INIT;
    assert_ok(colour_space_from_primaries(&space, c, gamma, bits, "test", &err), err);
    return space;
}

static void primaries_give_the_published_matrix(void **state)
{
    struct colour_space *space = space_of(&p3, 2.2, 8);
    (void)state;
    assert_non_null(space);
    for (int i = 0; i < 9; i++) assert_true(fabs(space->matrix[i / 3][i % 3] - p3_to_rec709[i / 3][i % 3]) < 1e-3);
    for (int i = 0; i < 256; i++) assert_true(fabs((double)space->light[i] - pow(i / 255.0, 2.2)) < 1e-5);
    float rgb[6] = {1, 0, 0, 0.5f, 0.5f, 0.5f};
    colour_space_to_rec709(space, rgb, 2);
    assert_true(rgb[0] > 1.2f && rgb[1] < -0.03f); /* outside of Rec.709, and not clipped */
    for (int c = 3; c < 6; c++) assert_true(fabsf(rgb[c] - 0.5f) < 1e-4f);
    colour_space_release(space);
}

static void white_is_adapted(void **state)
{
    struct colour_space *space = space_of(&aces, 1, 32);
    float rgb[3] = {1, 1, 1};
    (void)state;
    assert_non_null(space);
    colour_space_to_rec709(space, rgb, 1);
    for (int c = 0; c < 3; c++) assert_true(fabsf(rgb[c] - 1) < 1e-3f);
    colour_space_release(space);
}

static void srgb_is_no_other_space(void **state)
{
    struct colour_space *space = space_of(&rec709, 1, 32);
    (void)state;
    assert_null(space);
    space = space_of(&rec709, 2.2, 8); /* a curve of its own */
    assert_non_null(space);
    colour_space_release(space);
}

static struct photo read_ok(const char *path)
{
    struct photo p = {0};
    struct err err = ERR_INIT;
    assert_ok(photo_read_any(&p, path, &err), err);
    return p;
}

/* Samples of a patch of one colour, written as PNG in a space, read back and linearised. */
static void read_patch(float rgb[3], const char *path, struct photo *p)
{
    struct image linear = {0};
    struct err err = ERR_INIT;
    *p = read_ok(path);
    assert_ok(photo_to_linear(&linear, p, &err), err);
    memcpy(rgb, linear.data, 3 * sizeof *rgb);
    image_release(&linear);
}

static const char *write_patch(struct colour_space *space)
{
    uint16_t samples[3 * 16];
    const struct photo_info info = {.width = 4, .height = 4, .bits = 8, .orientation = 1};
    const struct photo p = {.info = info, .samples = samples, .space = space};
    struct err err = ERR_INIT;
    const char *path = scratch_path("patch.png");
    for (int i = 0; i < 16; i++) samples[3 * i] = 200, samples[3 * i + 1] = 100, samples[3 * i + 2] = 50;
    assert_ok(photo_write_part(path, &p, 0, 0, 4, 4, &info, &err), err);
    return path;
}

static void a_part_of_a_photo_keeps_its_profile(void **state)
{
    struct colour_space *space = space_of(&p3, 2.2, 8);
    struct photo p;
    float rgb[3];
    (void)state;
    read_patch(rgb, write_patch(space), &p);
    assert_non_null(p.space);
    assert_true(*p.info.colour != 0);
    const double light[3] = {pow(200 / 255.0, 2.2), pow(100 / 255.0, 2.2), pow(50 / 255.0, 2.2)};
    for (int c = 0; c < 3; c++) {
        double wanted = 0;
        for (int k = 0; k < 3; k++) wanted += p3_to_rec709[c][k] * light[k];
        assert_true(fabs((double)rgb[c] - wanted) < 2e-3);
    }
    photo_release(&p);
    colour_space_release(space);
}

/* Adds a JPEG segment that holds a part of a profile. */
static size_t put_profile(unsigned char *to, const unsigned char *icc, size_t size, int part)
{
    enum { HEAD = 18 };
    memcpy(to, "\xff\xe2..ICC_PROFILE", HEAD - 3);
    to[2] = (unsigned char)((size + HEAD - 2) >> 8);
    to[3] = (unsigned char)(size + HEAD - 2);
    to[HEAD - 3] = 0;
    to[HEAD - 2] = (unsigned char)part;
    to[HEAD - 1] = 2;
    memcpy(to + HEAD, icc, size);
    return HEAD + size;
}

/* Its profile is in two segments, of which the second comes first. */
static void a_jpeg_has_its_profile_in_parts(void **state)
{
    unsigned char *jpeg = NULL, rgb[3 * 64], *file;
    size_t size = 0, n = 2;
    struct colour_space *space = space_of(&p3, 2.2, 8), *stored = NULL;
    struct err err = ERR_INIT;
    bool tables = true;
    (void)state;
    memset(rgb, 128, sizeof rgb);
    assert_ok(jpeg_encode(&jpeg, &size, rgb, 8, 8, 90, &err), err);
    file = malloc(size + space->icc_size + 100);
    assert_non_null(file);
    memcpy(file, jpeg, n);
    const size_t half = space->icc_size / 2;
    n += put_profile(file + n, space->icc + half, space->icc_size - half, 2);
    const size_t first = n;
    n += put_profile(file + n, space->icc, half, 1);
    memcpy(file + n, jpeg + 2, size - 2);
    struct photo p = read_ok(scratch_write_bytes("p3.jpg", file, n + size - 2));
    assert_ok(colour_space_from_icc(&stored, &tables, space->icc, space->icc_size, 8, "test", &err), err);
    assert_false(tables);
    assert_non_null(p.space);
    assert_true(colour_space_same(p.space, stored));
    photo_release(&p);
    memset(file + first + 18 + 36, '?', 4); /* the profile's signature */
    assert_int_equal(photo_read(&p, scratch_write_bytes("bad.jpg", file, n + size - 2), &err), ST_DATA);
    assert_err(err, ST_DATA, "bad.jpg: its colour profile is damaged; save the photo as sRGB.");
    free(file);
    free(jpeg);
    colour_space_release(stored);
    colour_space_release(space);
}

static const char *write_gamma(const char *name, double gamma)
{
    const char *path = scratch_path(name);
    FILE *f = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    unsigned char row[3] = {128, 128, 128};
    assert_non_null(f);
    png_init_io(png, f);
    png_set_IHDR(png, info, 1, 1, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_gAMA(png, info, gamma);
    png_write_info(png, info);
    png_write_row(png, row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(f);
    return path;
}

static void the_gamma_of_a_png_counts(void **state)
{
    struct photo p;
    float rgb[3];
    (void)state;
    read_patch(rgb, write_gamma("linear.png", 1), &p);
    assert_true(fabsf(rgb[1] - 128 / 255.0f) < 1e-3f);
    photo_release(&p);
    read_patch(rgb, write_gamma("usual.png", 0.45455), &p); /* what programs write for sRGB */
    assert_null(p.space);
    assert_true(fabsf(rgb[1] - linear_from_srgb(128 / 255.0f)) < 1e-6f);
    photo_release(&p);
}

static void a_tiff_has_its_profile(void **state)
{
    struct colour_space *space = space_of(&p3, 1.8, 8);
    const char *path = scratch_path("p3.tif");
    unsigned char row[3] = {255, 0, 0};
    TIFF *t = TIFFOpen(path, "w");
    (void)state;
    assert_non_null(t);
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, 1);
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, 1);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, 3);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
    TIFFSetField(t, TIFFTAG_ICCPROFILE, (uint32_t)space->icc_size, space->icc);
    assert_int_equal(TIFFWriteScanline(t, row, 0, 0), 1);
    TIFFClose(t);
    struct photo p;
    float rgb[3];
    read_patch(rgb, path, &p);
    assert_true(fabsf(rgb[0] - 1.2249f) < 2e-3f && rgb[1] < 0);
    photo_release(&p);
    colour_space_release(space);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(primaries_give_the_published_matrix),
        cmocka_unit_test(white_is_adapted),
        cmocka_unit_test(srgb_is_no_other_space),
        cmocka_unit_test(a_part_of_a_photo_keeps_its_profile),
        cmocka_unit_test(a_jpeg_has_its_profile_in_parts),
        cmocka_unit_test(the_gamma_of_a_png_counts),
        cmocka_unit_test(a_tiff_has_its_profile),
    };
    return cmocka_run_group_tests_name("image photo_colour", tests, scratch_make, scratch_remove);
}
