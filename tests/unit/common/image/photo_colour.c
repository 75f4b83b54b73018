/* photo_colour.c - photos in other colour spaces than sRGB become linear Rec.709. */
#include "tests/unit/scratch.h"

#include <lcms2.h>
#include <math.h>
#include <png.h>
#include <tiffio.h>

#include "common/image/exr.h"
#include "common/image/photo.h"

#define CORPUS "tests/fuzz/corpus/photo/"

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

/* Photos of one colour, 200 100 50 in Display P3, with that profile or its codes. */
static void each_format_has_its_colours(void **state)
{
    static const struct {
        const char *file, *colour;
    } photos[] = {
        {"p3.png", "RGB built-in"}, {"p3.heic", "RGB built-in"},           {"p3.webp", "RGB built-in"},
        {"p3.jxl", "RGB built-in"}, {"p3.avif", "Display P3, sRGB curve"}, {"p3-lossy.jxl", "Display P3, sRGB curve"}};
    const double light[3] = {(double)linear_from_srgb(200 / 255.0f), (double)linear_from_srgb(100 / 255.0f),
                             (double)linear_from_srgb(50 / 255.0f)};
    (void)state;
    for (size_t i = 0; i < sizeof photos / sizeof *photos; i++) {
        struct photo p;
        struct photo_info info;
        struct err err = ERR_INIT;
        float rgb[3];
        char path[100];
        snprintf(path, sizeof path, CORPUS "%s", photos[i].file);
        read_patch(rgb, path, &p);
        assert_ok(photo_read_info(&info, path, &err), err);
        assert_memory_equal(&info, &p.info, sizeof info);
        assert_string_equal(info.colour, photos[i].colour);
        for (int c = 0; c < 3; c++) {
            double wanted = 0;
            for (int k = 0; k < 3; k++) wanted += p3_to_rec709[c][k] * light[k];
            assert_true(fabs((double)rgb[c] - wanted) < 0.01);
        }
        photo_release(&p);
    }
}

static double light_of_code(int transfer, double sample)
{
    struct colour_space *space = NULL;
    struct err err = ERR_INIT;
    assert_ok(colour_space_from_codes(&space, 9, transfer, 16, "test", &err), err);
    assert_non_null(space);
    const double light = (double)space->light[lrint(sample * 65535)];
    colour_space_release(space);
    return light;
}

/* BT.2408: 203 cd/m^2 are 58 % of PQ, and 75 % of HLG are white; BT.2100: the 10 000 cd/m^2 of PQ's largest sample;
 * HLG's largest one is 12 times its 50 %'s third of the light. */
static void codes_have_the_published_light(void **state)
{
    struct colour_space *space = NULL;
    struct err err = ERR_INIT;
    (void)state;
    assert_true(fabs(light_of_code(16, 0.58069) - 1) < 1e-3);
    assert_true(fabs(light_of_code(16, 0.50808) - 100 / 203.0) < 1e-3);
    assert_true(fabs(light_of_code(16, 1) - 10000 / 203.0) < 1e-3);
    assert_true(fabs(light_of_code(18, 0.75) - 1) < 1e-3);
    assert_true(fabs(light_of_code(18, 1) / light_of_code(18, 0.5) - 12) < 1e-3);
    assert_true(fabs(light_of_code(1, 0.5) - pow(0.599 / 1.099, 1 / 0.45)) < 1e-4);
    assert_true(fabs(light_of_code(8, 0.25) - 0.25) < 1e-4);
    assert_ok(colour_space_from_codes(&space, 1, 13, 8, "test", &err), err);
    assert_null(space);
    assert_ok(colour_space_from_codes(&space, 2, 2, 8, "test", &err), err);
    assert_null(space);
    assert_int_equal(colour_space_from_codes(&space, 1, 200, 8, "odd.heic", &err), ST_DATA);
    assert_err(err, ST_DATA, "odd.heic: its colour codes (primaries 1, transfer 200 of ITU-T H.273) are none that");
}

static void codes_without_a_meaning_are_refused(void **state)
{
    struct photo p = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(photo_read(&p, CORPUS "unknown-codes.avif", &err), ST_DATA);
    assert_err(err, ST_DATA, "unknown-codes.avif: its colour codes are none that libheif knows");
}

static void a_part_of_an_hdr_photo_keeps_its_codes(void **state)
{
    struct colour_space *space = NULL;
    struct photo p;
    struct err err = ERR_INIT;
    float rgb[3];
    (void)state;
    assert_ok(colour_space_from_codes(&space, 9, 16, 8, "test", &err), err);
    read_patch(rgb, write_patch(space), &p);
    assert_string_equal(p.info.colour, "BT.2020, PQ");
    assert_true(colour_space_same(p.space, space));
    assert_true(rgb[0] > 10);
    assert_true(fabsf(colour_space_white(space) - 10000 / 203.0f) < 1e-3f);
    photo_release(&p);
    colour_space_release(space);
}

/* A profile of tables: Display P3 by gamma, as curves, a matrix and curves to XYZ. */
static size_t table_profile(unsigned char **icc)
{
    const cmsCIExyY white = {0.3127, 0.3290, 1};
    const cmsCIExyYTRIPLE primaries = {{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
    cmsToneCurve *gamma = cmsBuildGamma(NULL, 2.2), *one = cmsBuildGamma(NULL, 1);
    cmsToneCurve *gammas[3] = {gamma, gamma, gamma}, *ones[3] = {one, one, one};
    cmsHPROFILE from = cmsCreateRGBProfile(&white, &primaries, gammas), to = cmsCreateProfilePlaceholder(NULL);
    const cmsTagSignature tags[] = {cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag};
    double matrix[9];
    cmsUInt32Number size = 0;
    for (int c = 0; c < 3; c++) {
        const cmsCIEXYZ *xyz = cmsReadTag(from, tags[c]);
        matrix[c] = xyz->X * 32768 / 65535, matrix[3 + c] = xyz->Y * 32768 / 65535,
        matrix[6 + c] = xyz->Z * 32768 / 65535;
    }
    cmsPipeline *lut = cmsPipelineAlloc(NULL, 3, 3);
    assert_true(cmsPipelineInsertStage(lut, cmsAT_END, cmsStageAllocToneCurves(NULL, 3, gammas)));
    assert_true(cmsPipelineInsertStage(lut, cmsAT_END, cmsStageAllocMatrix(NULL, 3, 3, matrix, NULL)));
    assert_true(cmsPipelineInsertStage(lut, cmsAT_END, cmsStageAllocToneCurves(NULL, 3, ones)));
    cmsSetProfileVersion(to, 4.3);
    cmsSetDeviceClass(to, cmsSigInputClass);
    cmsSetColorSpace(to, cmsSigRgbData);
    cmsSetPCS(to, cmsSigXYZData);
    assert_true(cmsWriteTag(to, cmsSigAToB0Tag, lut));
    assert_true(cmsSaveProfileToMem(to, NULL, &size));
    *icc = malloc(size);
    assert_non_null(*icc);
    assert_true(cmsSaveProfileToMem(to, *icc, &size));
    cmsPipelineFree(lut);
    cmsFreeToneCurve(gamma);
    cmsFreeToneCurve(one);
    cmsCloseProfile(from);
    cmsCloseProfile(to);
    return size;
}

static void tables_keep_colours_outside(void **state)
{
    struct colour_space space = {.name = "tables"};
    struct photo p;
    float rgb[3];
    (void)state;
    space.icc_size = table_profile(&space.icc);
    read_patch(rgb, write_patch(&space), &p);
    assert_int_equal(p.info.bits, 16);
    const double light[3] = {pow(200 / 255.0, 2.2), pow(100 / 255.0, 2.2), pow(50 / 255.0, 2.2)};
    for (int c = 0; c < 3; c++) {
        double wanted = 0;
        for (int k = 0; k < 3; k++) wanted += p3_to_rec709[c][k] * light[k];
        assert_true(fabs((double)rgb[c] - wanted) < 2e-3);
    }
    struct photo_info info;
    struct err err = ERR_INIT;
    assert_ok(photo_read_info(&info, scratch_path("patch.png"), &err), err);
    assert_memory_equal(&info, &p.info, sizeof info);
    photo_release(&p);
    uint16_t red[3] = {255, 0, 0};
    struct colour_space *wide = NULL;
    bool tables = false;
    assert_ok(colour_space_from_icc(&wide, &tables, space.icc, space.icc_size, 8, "test", &err), err);
    assert_true(tables);
    assert_ok(colour_space_widen(red, 1, 8, space.icc, space.icc_size, "test", &err), err);
    for (int c = 0; c < 3; c++) rgb[c] = wide->light[c * wide->levels + red[c]];
    colour_space_to_rec709(wide, rgb, 1);
    for (int c = 0; c < 3; c++) assert_true(fabs((double)rgb[c] - p3_to_rec709[c][0]) < 2e-3);
    colour_space_release(wide);
    free(space.icc);
}

static void exif_names_adobe_rgb(void **state)
{
    /* IFD0 with the pointer to EXIF's, which has ColorSpace 2 */
    static const unsigned char exif[] = "\xff\xe1\0\x34"
                                        "Exif\0\0II*\0\x08\0\0\0\1\0\x69\x87\4\0\1\0\0\0\x1a\0\0\0\0\0\0\0"
                                        "\1\0\1\xa0\3\0\1\0\0\0\2\0\0\0\0\0\0\0";
    unsigned char *jpeg = NULL, rgb[3 * 64], file[2000];
    size_t size = 0;
    struct err err = ERR_INIT;
    (void)state;
    memset(rgb, 128, sizeof rgb);
    assert_ok(jpeg_encode(&jpeg, &size, rgb, 8, 8, 90, &err), err);
    assert_true(size + sizeof exif < sizeof file);
    memcpy(file, jpeg, 2);
    memcpy(file + 2, exif, sizeof exif - 1);
    memcpy(file + 2 + sizeof exif - 1, jpeg + 2, size - 2);
    struct photo p = read_ok(scratch_write_bytes("adobe.jpg", file, size + sizeof exif - 1));
    assert_string_equal(p.info.colour, "Adobe RGB (1998)");
    photo_release(&p);
    free(jpeg);
}

/* Overwrites floats of an attribute in an EXR file. */
static void patch_exr(const char *path, const char *attribute, size_t attribute_size, const float *values, size_t count)
{
    unsigned char file[4000];
    FILE *f = fopen(path, "r+b");
    assert_non_null(f);
    const size_t size = fread(file, 1, sizeof file, f);
    unsigned char *at = memmem(file, size, attribute, attribute_size);
    assert_non_null(at);
    memcpy(at + attribute_size + 4, values, count * sizeof *values); /* after the attribute's size */
    rewind(f);
    assert_int_equal(fwrite(file, 1, size, f), size);
    fclose(f);
}

static void the_primaries_of_an_exr_count(void **state)
{
    static const char chromaticities[] = "chromaticities\0chromaticities", aspect[] = "pixelAspectRatio\0float";
    const float ap1[8] = {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f}, two = 2;
    const char *path = scratch_path("aces.exr");
    const float rgba[4] = {-0.25f, 0.5f, 2, 1};
    struct exr_image im = {0};
    struct photo p = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(exr_init_rgba(&im, rgba, 1, 1, &err), err);
    assert_ok(exr_write(&im, path, NULL, &err), err);
    exr_image_release(&im);
    assert_ok(photo_read_any(&p, path, &err), err);
    assert_null(p.space);
    for (int c = 0; c < 3; c++) assert_true(p.values[c] == rgba[c]); /* below 0 too */
    photo_release(&p);
    patch_exr(path, chromaticities, sizeof chromaticities, ap1, 8);
    assert_ok(photo_read_any(&p, path, &err), err);
    assert_non_null(p.space);
    float red[3] = {1, 0, 0};
    colour_space_to_rec709(p.space, red, 1); /* published: 1.7051 -0.1303 -0.0240 */
    assert_true(fabsf(red[0] - 1.7051f) < 2e-3f && fabsf(red[1] + 0.1303f) < 2e-3f && fabsf(red[2] + 0.0240f) < 2e-3f);
    photo_release(&p);
    patch_exr(path, aspect, sizeof aspect, &two, 1);
    assert_int_equal(photo_read_any(&p, path, &err), ST_DATA);
    assert_err(err, ST_DATA, "aces.exr: its pixels are 2 times as wide as high, wanted square ones");
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
        cmocka_unit_test(each_format_has_its_colours),
        cmocka_unit_test(codes_have_the_published_light),
        cmocka_unit_test(codes_without_a_meaning_are_refused),
        cmocka_unit_test(a_part_of_an_hdr_photo_keeps_its_codes),
        cmocka_unit_test(tables_keep_colours_outside),
        cmocka_unit_test(exif_names_adobe_rgb),
        cmocka_unit_test(the_primaries_of_an_exr_count),
    };
    return cmocka_run_group_tests_name("image photo_colour", tests, scratch_make, scratch_remove);
}
