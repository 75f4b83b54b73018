/* given_read.c - depth files that the user provides: values, resampling to the view, and errors. */
#include "tests/unit/scratch.h"

#include <math.h>
#include <png.h>

#include "common/image/exr.h"
#include "common/image/photo.h"
#include "stages/segment_depth/given_read.h"

enum { W = 40, H = 30 };

static struct view view_of(int width, int height, double focal)
{
    return (struct view){
        .name = "v", .width = width, .height = height, .fx = focal, .fy = focal, .cx = width / 2.0, .cy = height / 2.0};
}

static void forget(const char *name) { remove(scratch_path(name)); }

static int empty_folder(void **state)
{
    (void)state;
    forget("v.exr");
    forget("v.png");
    forget("depth.txt");
    return 0;
}

/* Writes v.exr with float channels; sample(k, x, y) is channel k's value. */
static void write_exr(int width, int height, const char *const *names, int count, enum exr_type type,
                      double (*sample)(int k, int x, int y))
{
    struct exr_image im;
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&im, width, height, &err), err);
    im.codec = EXR_NONE;
    for (int k = 0; k < count; k++) {
        struct exr_plane *plane;
        assert_ok(exr_add_plane(&im, names[k], type, &plane, &err), err);
        for (int i = 0; i < width * height; i++) {
            if (type == EXR_UINT)
                plane->u[i] = (uint32_t)sample(k, i % width, i / width);
            else
                plane->f[i] = (float)sample(k, i % width, i / width);
        }
    }
    assert_ok(exr_write(&im, scratch_path("v.exr"), NULL, &err), err);
    exr_image_release(&im);
}

/* Replaces the bytes of every sample of v.exr that equals `from`. */
static void patch_bytes(const void *from, const void *bits, size_t count)
{
    FILE *fp = fopen(scratch_path("v.exr"), "rb");
    static unsigned char bytes[1 << 20];
    assert_non_null(fp);
    const size_t size = fread(bytes, 1, sizeof bytes, fp);
    fclose(fp);
    int found = 0;
    for (size_t i = 0; i + count <= size; i++)
        if (!memcmp(bytes + i, from, count)) {
            memcpy(bytes + i, bits, count);
            found++;
        }
    assert_true(found > 0);
    scratch_write_bytes("v.exr", bytes, size);
}

static void patch(float from, uint32_t bits) { patch_bytes(&from, &bits, 4); }

static double ramp(int k, int x, int y) { return (k ? 1000 : 2) + x + 100 * y; }
static double strange(int k, int x, int y)
{
    return (void)k, y ? 5 : x == 1 ? 0 : x == 2 ? 1234.5 : x == 3 ? 4321.5 : x == 4 ? -0.0 : 7;
}
static double below(int k, int x, int y) { return (void)k, x == 3 && y == 2 ? -1.5 : 4; }

static float *read_for(const struct view *view, const struct lens *lens)
{
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    struct given given;
    assert_ok(given_read(&given, scratch, view, lens, false, &prov, &err), err);
    float *z = given.z;
    if (z) assert_true(prov.count > 0 && !strncmp(prov.inputs[0].name, "given/v.", 8));
    provenance_release(&prov);
    return z;
}

static void refused(const struct view *view, const struct lens *lens, const char *message, const char *more)
{
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    struct given given;
    given_read(&given, scratch, view, lens, false, &prov, &err);
    assert_null(given.z);
    assert_err(err, ST_DATA, message);
    assert_contains(err.text, more);
    provenance_release(&prov);
}

/* ----------------------------------------------------------------------------------------------------------- EXR */

static void without_a_file_no_depth_is_given(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    assert_null(read_for(&view, NULL));
}

static void the_depth_channel_is_z_or_the_only_one(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    const char *const many[] = {"Z", "A", "id"}, *const one[] = {"depth"}, *const none[] = {"R", "G"};
    for (int k = 0; k < 2; k++) {
        write_exr(W, H, k ? one : many, k ? 1 : 3, EXR_FLOAT, ramp);
        float *z = read_for(&view, NULL);
        for (int i = 0; i < W * H; i++) assert_true(z[i] == (float)(2 + i % W + 100 * (i / W)));
        free(z);
    }
    write_exr(W, H, none, 2, EXR_HALF, ramp);
    refused(&view, NULL, "has the channels G R", "wanted a channel Z");
}

static void unknown_depth_is_zero(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    const char *const names[] = {"Z"};
    write_exr(W, H, names, 1, EXR_FLOAT, strange);
    patch(1234.5f, 0x7fc00000); /* NaN */
    patch(4321.5f, 0x7f800000); /* infinity */
    float *z = read_for(&view, NULL);
    const float row[] = {7, 0, 0, 0, 0, 7};
    assert_memory_equal(z, row, sizeof row - sizeof *row);
    assert_true(z[5] == 7 && z[W] == 5);
    free(z);
    write_exr(W, H, names, 1, EXR_FLOAT, strange);
    patch(4321.5f, 0xff800000); /* minus infinity, and NaN with a sign */
    patch(1234.5f, 0xffc00000);
    z = read_for(&view, NULL);
    assert_true(z[2] == 0 && z[3] == 0);
    free(z);
    write_exr(W, H, names, 1, EXR_HALF, strange);
    patch_bytes(&(uint16_t){0x64d2}, &(uint16_t){0x7e00}, 2); /* 1234 */
    patch_bytes(&(uint16_t){0x6c38}, &(uint16_t){0x7c00}, 2); /* 4320 */
    z = read_for(&view, NULL);
    assert_true(z[2] == 0 && z[3] == 0 && z[5] == 7 && z[W - 1] == 7);
    free(z);
}

static void negative_depth_is_an_error(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    const char *const names[] = {"Z"};
    write_exr(W, H, names, 1, EXR_FLOAT, below);
    refused(&view, NULL, "pixel (3, 2) has the depth -1.5", "0 where it is unknown");
}

static void integer_and_half_float_samples_are_read(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    const char *const names[] = {"Z"};
    scratch_write("depth.txt", "# millimetres\nscale 0.001\n");
    write_exr(W, H, names, 1, EXR_UINT, ramp);
    float *z = read_for(&view, NULL);
    assert_true(fabsf(z[3 * W + 5] - 0.307f) < 1e-6f);
    free(z);
    write_exr(W, H, names, 1, EXR_HALF, ramp);
    z = read_for(&view, NULL);
    assert_true(fabsf(z[3 * W + 5] - 0.307f) < 1e-3f);
    free(z);
}

static void a_damaged_file_is_an_error(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    scratch_write("v.exr", "no EXR");
    refused(&view, NULL, "v.exr", "");
}

/* ----------------------------------------------------------------------------------------------------------- PNG */

static void write_png16(int width, int height, bool colour)
{
    png_image im = {.version = PNG_IMAGE_VERSION,
                    .width = (png_uint_32)width,
                    .height = (png_uint_32)height,
                    .format = colour ? PNG_FORMAT_LINEAR_RGB : PNG_FORMAT_LINEAR_Y};
    static uint16_t samples[3 * W * H];
    for (int i = 0; i < width * height * (colour ? 3 : 1); i++) samples[i] = (uint16_t)(37 * i);
    assert_true(png_image_write_to_file(&im, scratch_path("v.png"), 0, samples, 0, NULL));
}

static void a_16_bit_png_is_multiplied_by_the_scale(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    write_png16(W, H, false);
    refused(&view, NULL, "v.png holds whole numbers", "depth.txt");
    scratch_write("depth.txt", "pixels view\n");
    refused(&view, NULL, "v.png holds whole numbers", "scale NUMBER");
    scratch_write("depth.txt", "pixels view\nscale 0.25\n");
    float *z = read_for(&view, NULL);
    for (int i = 0; i < W * H; i++) assert_true(z[i] == 0.25f * (float)(uint16_t)(37 * i));
    free(z);
    write_png16(W, H, true);
    refused(&view, NULL, "is a colour picture", "grey");
}

static void an_8_bit_png_is_multiplied_by_the_scale(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    static unsigned char grey[W * H];
    struct err err = ERR_INIT;
    for (int i = 0; i < W * H; i++) grey[i] = (unsigned char)i;
    assert_ok(png_write(scratch_path("v.png"), grey, W, H, 1, &err), err);
    scratch_write("depth.txt", "scale 2\n");
    float *z = read_for(&view, NULL);
    for (int i = 0; i < W * H; i++) assert_true(z[i] == 2 * (float)(unsigned char)i);
    free(z);
}

static void an_exr_takes_precedence_over_a_png(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    const char *const names[] = {"Z"};
    write_exr(W, H, names, 1, EXR_FLOAT, ramp);
    write_png16(W, H, false);
    float *z = read_for(&view, NULL);
    assert_true(z[1] == 3);
    free(z);
}

/* ---------------------------------------------------------------------------------------------------------- sizes */

static double step(int k, int x, int y) { return (void)k, x < 10 ? 1 : y < 8 ? 2 : 4; }

static void another_size_gives_the_nearest_sample(void **state)
{
    (void)state;
    const struct view larger = view_of(2 * W, 2 * H, 80), smaller = view_of(W / 2, H / 2, 20),
                      odd = view_of(61, 46, 61); /* 40 x 30 times 1.525, rounded */
    const char *const names[] = {"Z"};
    const struct view *const views[] = {&larger, &smaller, &odd};
    write_exr(W, H, names, 1, EXR_FLOAT, step);
    for (int k = 0; k < 3; k++) {
        float *z = read_for(views[k], NULL);
        for (int y = 0; y < views[k]->height; y++)
            for (int x = 0; x < views[k]->width; x++) {
                const int fx = (int)((x + 0.5) * W / views[k]->width), fy = (int)((y + 0.5) * H / views[k]->height);
                assert_true(z[y * views[k]->width + x] == (float)step(0, fx, fy)); /* no interpolation */
            }
        free(z);
    }
    const struct view wide = view_of(2 * W, H, 40);
    refused(&wide, NULL, "v.exr has 40 x 30 pixels, but view v has 80 x 30", "of the same shape");
}

/* A map of the photo is looked up through the lens's distortion. */
static void depth_of_a_photo_is_mapped_through_its_lens(void **state)
{
    (void)state;
    const struct view view = view_of(36, 26, 40);
    struct lens lens = {.view = (char *)"v",
                        .photo = (char *)"v",
                        .camera = {CAMERA_SIMPLE_RADIAL, W, H, {40, W / 2.0, H / 2.0, -0.3}},
                        .view_from_photo = {1, 0, 0, 0}};
    const char *const names[] = {"Z"};
    write_exr(W, H, names, 1, EXR_FLOAT, ramp);
    for (int declared = 0; declared < 2; declared++) {
        if (declared) scratch_write("depth.txt", "pixels photo\n");
        float *z = read_for(&view, &lens);
        for (int y = 0; y < 26; y++)
            for (int x = 0; x < 36; x++) {
                const double a = (x + 0.5 - 18) / 40, b = (y + 0.5 - 13) / 40, bent = 1 - 0.3 * (a * a + b * b);
                const int u = (int)(40 * bent * a + 20), v = (int)(40 * bent * b + 15);
                assert_true(z[y * 36 + x] == (float)ramp(0, u, v));
            }
        free(z);
    }
    /* the same map declared as of the view, whose aspect ratio is another */
    scratch_write("depth.txt", "pixels view\n");
    refused(&view, &lens, "wanted the view's size, as depth.txt says", "40 x 30");
    /* a photo with several views has no view of its name */
    lens.photo = (char *)"p";
    scratch_write("depth.txt", "pixels photo\n");
    refused(&view, &lens, "wanted a photo that is one view", "");
}

/* A view rotated against its photo: z along the photo's axis is converted to the view's. */
static void depth_is_converted_to_a_rotated_views_axis(void **state)
{
    (void)state;
    const struct view view = view_of(W + 2, H, 40);
    const double half = 0.1;
    const struct lens lens = {.view = (char *)"v",
                              .photo = (char *)"v",
                              .camera = {CAMERA_SIMPLE_PINHOLE, W, H, {40, W / 2.0, H / 2.0}},
                              .view_from_photo = {cos(half), 0, sin(half), 0}};
    const char *const names[] = {"Z"};
    write_exr(W, H, names, 1, EXR_FLOAT, below);
    write_exr(W, H, names, 1, EXR_FLOAT, step);
    float *z = read_for(&view, &lens);
    int seen = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W + 2; x++) {
            const double a = (x + 0.5 - view.cx) / 40, b = (y + 0.5 - view.cy) / 40, c = cos(2 * half),
                         s = sin(2 * half);
            const double px = c * a - s, pz = s * a + c; /* transposed */
            const double u = 40 * px / pz + W / 2.0, v = 40 * b / pz + H / 2.0;
            const float got = z[y * (W + 2) + x];
            if (u < 0 || v < 0 || u >= W || v >= H) {
                assert_true(got == 0);
                continue;
            }
            seen++;
            assert_true(fabs((double)got - step(0, (int)u, (int)v) / pz) < 1e-5);
        }
    assert_true(seen > W * H / 2);
    free(z);
}

/* ------------------------------------------------------------------------------------------------------- depth.txt */

/* Depth is the scale divided by a disparity; without a scale it is left to the sparse points. */
static void disparity_is_divided_into_the_scale(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    const char *const names[] = {"Z"};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    struct given given;
    write_exr(W, H, names, 1, EXR_FLOAT, ramp);
    scratch_write("depth.txt", "samples disparity\nscale 120\n");
    assert_ok(given_read(&given, scratch, &view, NULL, false, &prov, &err), err);
    assert_true(given.disparity && !given.relative);
    for (int i = 0; i < W * H; i++) assert_true(given.z[i] == (float)(120.0 / (2 + i % W + 100 * (i / W))));
    free(given.z);
    scratch_write("depth.txt", "samples disparity\n");
    assert_ok(given_read(&given, scratch, &view, NULL, false, &prov, &err), err);
    assert_true(given.disparity && given.relative);
    assert_true(given.z[W + 1] == 103);
    free(given.z);
    scratch_write("depth.txt", "samples depth\n");
    assert_ok(given_read(&given, scratch, &view, NULL, false, &prov, &err), err);
    assert_true(!given.disparity && !given.relative && given.z[W + 1] == 103);
    free(given.z);
    provenance_release(&prov);
}

/* The only view of a scene may have its depth in one file of any name, without a scale but with its kind. */
static void the_only_view_takes_one_file(void **state)
{
    (void)state;
    const struct view view = view_of(W, H, 40);
    const char *const names[] = {"Z"};
    struct provenance prov = {0};
    struct err err = ERR_INIT, unsaid = ERR_INIT, bare = ERR_INIT;
    struct given given;
    write_exr(W, H, names, 1, EXR_FLOAT, ramp);
    assert_int_equal(rename(scratch_path("v.exr"), scratch_path("any.exr")), 0);
    scratch_write("depth.txt", "samples disparity\n");
    assert_ok(given_read(&given, scratch_path("any.exr"), &view, NULL, true, &prov, &err), err);
    assert_true(given.disparity && given.relative && given.z[W + 1] == 103);
    assert_string_equal(prov.inputs[0].name, "given/v.exr");
    free(given.z);
    scratch_write("bare", "");
    given_read(&given, scratch_path("bare"), &view, NULL, true, &prov, &bare);
    assert_err(bare, ST_DATA, "the name of a depth map must end in");

    write_png16(W, H, false);
    scratch_write("depth.txt", "samples depth\n");
    assert_ok(given_read(&given, scratch_path("v.png"), &view, NULL, true, &prov, &err), err);
    assert_true(!given.relative && given.z);
    free(given.z);
    unlink(scratch_path("depth.txt"));
    given_read(&given, scratch_path("v.png"), &view, NULL, true, &prov, &unsaid);
    assert_err(unsaid, ST_DATA, "holds whole numbers, which may be depth or disparity");
    provenance_release(&prov);
}

static void errors_in_depth_txt_name_their_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } bad[] = {
        {"scale 0\n", "depth.txt:1: found \"0\""},
        {"scale -1\n", "depth.txt:1: found \"-1\""},
        {"scale nan\n", "depth.txt:1"},
        {"scale 1e13\n", "a number from 1e-12 to 1e+12"},
        {"scale\n", "depth.txt:1"},
        {"scale 1 2\n", "depth.txt:1: found \"2\""},
        {"\nscale 1\nscale 2\n", "depth.txt:3"},
        {"pixels both\n", "found \"both\", wanted view or photo"},
        {"pixels view\npixels photo\n", "at most once"},
        {"metres\n", "found \"metres\""},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        struct given_units units;
        struct err err = ERR_INIT;
        const char *path = scratch_write("depth.txt", bad[k].text);
        assert_int_equal(given_units_read(&units, path, &err), ST_DATA);
        assert_err(err, ST_DATA, bad[k].message);
        assert_true(units.scale == 0 && units.pixels == PIXELS_BY_SIZE);
    }
    struct given_units units;
    struct err err = ERR_INIT;
    assert_ok(given_units_read(&units, scratch_write("depth.txt", "# as stored\npixels photo\n"), &err), err);
    assert_true(units.scale == 0 && units.pixels == PIXELS_OF_PHOTO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(without_a_file_no_depth_is_given, empty_folder),
        cmocka_unit_test_setup(the_depth_channel_is_z_or_the_only_one, empty_folder),
        cmocka_unit_test_setup(unknown_depth_is_zero, empty_folder),
        cmocka_unit_test_setup(negative_depth_is_an_error, empty_folder),
        cmocka_unit_test_setup(integer_and_half_float_samples_are_read, empty_folder),
        cmocka_unit_test_setup(a_damaged_file_is_an_error, empty_folder),
        cmocka_unit_test_setup(a_16_bit_png_is_multiplied_by_the_scale, empty_folder),
        cmocka_unit_test_setup(an_8_bit_png_is_multiplied_by_the_scale, empty_folder),
        cmocka_unit_test_setup(an_exr_takes_precedence_over_a_png, empty_folder),
        cmocka_unit_test_setup(another_size_gives_the_nearest_sample, empty_folder),
        cmocka_unit_test_setup(depth_of_a_photo_is_mapped_through_its_lens, empty_folder),
        cmocka_unit_test_setup(depth_is_converted_to_a_rotated_views_axis, empty_folder),
        cmocka_unit_test_setup(disparity_is_divided_into_the_scale, empty_folder),
        cmocka_unit_test_setup(the_only_view_takes_one_file, empty_folder),
        cmocka_unit_test_setup(errors_in_depth_txt_name_their_line, empty_folder),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
