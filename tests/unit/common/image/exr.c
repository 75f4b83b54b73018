/* exr.c - OpenEXR files: written samples read back, bytes are reproducible; foreign and damaged files; view images. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"

#define CORPUS "tests/fuzz/corpus/exr/"

static char *file_bytes(const char *path, size_t *size)
{
    FILE *fp = fopen(path, "rb");
    assert_non_null(fp);
    assert_int_equal(fseek(fp, 0, SEEK_END), 0);
    *size = (size_t)ftell(fp);
    rewind(fp);
    char *bytes = malloc(*size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, fp), *size);
    fclose(fp);
    return bytes;
}

/* An image with every type of channel, and a height that leaves the last chunk incomplete. */
static struct exr_image sample(int width, int height)
{
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&im, width, height, &err), err);
    assert_ok(exr_add_plane(&im, "interior.id", EXR_UINT, NULL, &err), err);
    assert_ok(exr_add_plane(&im, "Z", EXR_FLOAT, NULL, &err), err);
    assert_ok(exr_add_plane(&im, "R", EXR_HALF, NULL, &err), err);
    for (int i = 0; i < width * height; i++) {
        exr_find(&im, "interior.id")->u[i] = 0xffffffffU - (uint32_t)i;
        exr_find(&im, "Z")->f[i] = (float)i / 3;
        exr_find(&im, "R")->f[i] = (float)(i % 2048) / 1024; /* exact in half */
    }
    assert_ok(exr_set_attribute(&im, "remodel:note", "first", &err), err);
    assert_ok(exr_set_attribute(&im, "remodel:note", "a \"second\"", &err), err);
    im.has_world_to_camera = true;
    for (int i = 0; i < 16; i++) im.world_to_camera[i] = (float)i / 7;
    return im;
}

static void written_images_read_back(void **state)
{
    struct err err = ERR_INIT;
    struct exr_image im = sample(37, 45), in;
    const char *path = scratch_path("made/deeper/a.exr"), *names[] = {"Z", "R"};
    (void)state;
    assert_ok(exr_write(&im, path, NULL, &err), err);
    assert_ok(exr_read(&in, path, NULL, 0, &err), err);
    assert_true(in.width == 37 && in.height == 45 && in.count == 3);
    assert_memory_equal(exr_find(&in, "interior.id")->u, exr_find(&im, "interior.id")->u, 37 * 45 * 4);
    assert_memory_equal(exr_find(&in, "Z")->f, exr_find(&im, "Z")->f, 37 * 45 * 4);
    assert_memory_equal(exr_find(&in, "R")->f, exr_find(&im, "R")->f, 37 * 45 * 4);
    assert_int_equal(exr_find(&in, "R")->type, EXR_HALF);
    assert_string_equal(exr_attribute(&in, "remodel:note"), "a \"second\"");
    assert_true(in.has_world_to_camera);
    assert_memory_equal(in.world_to_camera, im.world_to_camera, sizeof im.world_to_camera);
    exr_image_release(&in);

    assert_ok(exr_read(&in, path, names, 2, &err), err);
    assert_int_equal(in.count, 2);
    assert_null(exr_find(&in, "interior.id"));
    assert_memory_equal(exr_find(&in, "Z")->f, exr_find(&im, "Z")->f, 37 * 45 * 4);
    exr_image_release(&in);

    names[1] = "boundary.A";
    assert_int_equal(exr_read(&in, path, names, 2, &err), ST_DATA);
    assert_err(err, ST_DATA, "no channel boundary.A; it has R Z interior.id");
    assert_null(in.planes);
    exr_image_release(&in);
    exr_image_release(&im);
    exr_image_release(&im);
    exr_image_release(NULL);
}

static void every_codec_reads_back(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    for (int codec = EXR_ZIP; codec <= EXR_NONE; codec++) {
        struct exr_image im = sample(37, 45), in;
        const char *path = scratch_path("codec.exr");
        im.codec = (enum exr_codec)codec;
        assert_ok(exr_write(&im, path, NULL, &err), err);
        assert_ok(exr_read(&in, path, NULL, 0, &err), err);
        assert_memory_equal(exr_find(&in, "interior.id")->u, exr_find(&im, "interior.id")->u, 37 * 45 * 4);
        assert_memory_equal(exr_find(&in, "Z")->f, exr_find(&im, "Z")->f, 37 * 45 * 4);
        assert_memory_equal(exr_find(&in, "R")->f, exr_find(&im, "R")->f, 37 * 45 * 4);
        exr_image_release(&in);
        exr_image_release(&im);
    }
}

static void half_is_rounded_to_nearest_and_clamped(void **state)
{
    struct err err = ERR_INIT;
    struct exr_image im = {0}, in;
    struct exr_plane *p;
    const float values[] = {
        1.0F + 1.0F / 2048 + 1e-6F, 65504, 65519, 65520, 1e30F, INFINITY, -1e30F, 5.9604645e-8F, 1e-9F, -0.0F};
    const float wanted[] = {1.0F + 1.0F / 1024, 65504, 65504, 65504, 65504, 65504, -65504, 5.9604645e-8F, 0, -0.0F};
    (void)state;
    assert_ok(exr_image_init(&im, 10, 1, &err), err);
    assert_ok(exr_add_plane(&im, "Y", EXR_HALF, &p, &err), err);
    memcpy(p->f, values, sizeof values);
    assert_ok(exr_write(&im, scratch_path("half.exr"), NULL, &err), err);
    assert_ok(exr_read(&in, scratch_path("half.exr"), NULL, 0, &err), err);
    assert_memory_equal(in.planes[0].f, wanted, sizeof wanted);
    exr_image_release(&in);
    exr_image_release(&im);
}

static void bytes_do_not_depend_on_threads_or_channel_order(void **state)
{
    struct err err = ERR_INIT;
    struct exr_image im = sample(100, 133);
    size_t one_size, size;
    (void)state;
    parallel_set_threads(1);
    assert_ok(exr_write(&im, scratch_path("one.exr"), NULL, &err), err);
    char *one = file_bytes(scratch_path("one.exr"), &one_size);
    struct exr_plane first = im.planes[0]; /* the file sorts its channels by name */
    im.planes[0] = im.planes[2];
    im.planes[2] = first;
    for (int threads = 1; threads < 6; threads++) {
        parallel_set_threads(threads);
        assert_ok(exr_write(&im, scratch_path("more.exr"), NULL, &err), err);
        char *more = file_bytes(scratch_path("more.exr"), &size);
        assert_int_equal(size, one_size);
        assert_memory_equal(one, more, size);
        free(more);
    }
    parallel_set_threads(0);
    free(one);
    exr_image_release(&im);
}

static void invalid_samples_keep_the_old_file(void **state)
{
    struct err err = ERR_INIT;
    struct exr_image im = sample(20, 40);
    (void)state;
    assert_int_equal(mkdir(scratch_path("keep"), 0777), 0);
    assert_ok(exr_write(&im, scratch_path("keep/a.exr"), NULL, &err), err);
    size_t size, again_size;
    char *before = file_bytes(scratch_path("keep/a.exr"), &size);

    exr_find(&im, "R")->f[20 * 33 + 7] = NAN;
    exr_find(&im, "Z")->f[20 * 39 + 1] = NAN;
    assert_int_equal(exr_write(&im, scratch_path("keep/a.exr"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "channel R holds NaN or infinity at pixel (7, 33)");
    err = (struct err)ERR_INIT;
    exr_find(&im, "Z")->f[20 * 5 + 19] = -INFINITY;
    assert_int_equal(exr_write(&im, scratch_path("keep/a.exr"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "channel Z holds NaN or infinity at pixel (19, 5)");

    char *after = file_bytes(scratch_path("keep/a.exr"), &again_size);
    assert_int_equal(size, again_size);
    assert_memory_equal(before, after, size);
    assert_int_equal(count_entries(scratch_path("keep")), 1);
    free(before);
    free(after);
    exr_image_release(&im);
}

static void provenance_is_in_the_file(void **state)
{
    struct err err = ERR_INIT;
    struct exr_image im = sample(3, 3), in;
    struct provenance prov = {.stage = "rectify", .version = "1.2.3"};
    const char *marks[] = {"remodel:stage",      "rectify",        "remodel:version", "1.2.3",
                           "remodel:parameters", "remodel:inputs", "views/some.txt",  "chromaticities"};
    size_t size;
    (void)state;
    assert_ok(provenance_add_file(&prov, "views/some.txt", scratch_write("some.txt", "words"), &err), err);
    assert_ok(exr_write(&im, scratch_path("p.exr"), &prov, &err), err);
    char *bytes = file_bytes(scratch_path("p.exr"), &size);
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        assert_non_null(memmem(bytes, size, marks[i], strlen(marks[i])));
    assert_null(memmem(bytes, size, scratch, strlen(scratch))); /* no absolute path */
    free(bytes);

    /* read and written again, it has the new provenance only */
    assert_ok(exr_read(&in, scratch_path("p.exr"), NULL, 0, &err), err);
    assert_int_equal(in.attribute_count, 1);
    prov.stage = "another";
    assert_ok(exr_write(&in, scratch_path("q.exr"), &prov, &err), err);
    bytes = file_bytes(scratch_path("q.exr"), &size);
    assert_null(memmem(bytes, size, "rectify", 7));
    free(bytes);
    exr_image_release(&in);
    exr_image_release(&im);
    provenance_release(&prov);
}

static void a_product_is_read_once_and_recorded(void **state)
{
    static const char *const names[] = {"R", "Z"};
    struct err err = ERR_INIT;
    struct exr_image im = sample(65, 33), plain, in;
    struct provenance prov = {0};
    const char *path = scratch_path("views/a.exr");
    char hash[HASH_TEXT];
    (void)state;
    assert_ok(exr_write(&im, path, NULL, &err), err);
    assert_ok(exr_read(&plain, path, names, 2, &err), err);
    for (int i = 0; i < 2; i++) { /* the second time from the file, as it is recorded */
        assert_ok(exr_read_product(&in, PRODUCT_VIEW, path, names, 2, &prov, &err), err);
        for (int k = 0; k < 2; k++) {
            const struct exr_plane *a = exr_find(&plain, names[k]), *b = exr_find(&in, names[k]);
            assert_memory_equal(a->f, b->f, 65 * 33 * sizeof *a->f);
        }
        exr_image_release(&in);
        assert_int_equal(prov.count, 1);
    }
    assert_string_equal(prov.inputs[0].name, "views/a.exr");
    assert_ok(hash_file(hash, path, &err), err);
    assert_string_equal(prov.inputs[0].hash, hash);
    provenance_keep(&prov, 0);
    scratch_write("views/b.exr", "no picture");
    assert_int_equal(exr_read_product(&in, PRODUCT_VIEW, scratch_path("views/b.exr"), names, 2, &prov, &err), ST_DATA);
    assert_err(err, ST_DATA, "not OpenEXR");
    size_t size;
    char *bytes = file_bytes(path, &size);
    scratch_write_bytes("views/c.exr", bytes, size / 2);
    free(bytes);
    err = (struct err)ERR_INIT;
    assert_int_equal(exr_read_product(&in, PRODUCT_VIEW, scratch_path("views/c.exr"), names, 2, &prov, &err), ST_DATA);
    assert_err(err, ST_DATA, "make it again");
    assert_int_equal(in.count, 0);
    exr_image_release(&plain);
    exr_image_release(&im);
    provenance_release(&prov);
}

static void rgba_images_and_numeric_attributes(void **state)
{
    const float rgba[] = {0, 0.5f, 1, 0.25f, 2, 4, 8, 0.75f};
    static const char *const names[] = {"R", "G", "B", "A"};
    struct err err = ERR_INIT;
    struct exr_image im;
    (void)state;
    assert_ok(exr_init_rgba(&im, rgba, 2, 1, &err), err);
    assert_int_equal(im.count, 4);
    for (int c = 0; c < 4; c++) {
        assert_true(exr_find(&im, names[c])->type == EXR_HALF);
        for (int p = 0; p < 2; p++) assert_true(exr_find(&im, names[c])->f[p] == rgba[4 * p + c]);
    }
    assert_ok(exr_set_number(&im, "remodel:holes", 1.0 / 3, &err), err);
    assert_string_equal(exr_attribute(&im, "remodel:holes"), "0.333333333");
    exr_image_release(&im);
    assert_int_equal(exr_init_rgba(&im, rgba, 0, 1, &err), ST_DATA);
    exr_image_release(&im);
}

static void names_and_sizes_have_limits(void **state)
{
    struct err err = ERR_INIT;
    struct exr_image im = {0}, in;
    char name[EXR_NAME_SIZE + 1];
    (void)state;
    assert_int_equal(exr_image_init(&im, 0, 4, &err), ST_DATA);
    err = (struct err)ERR_INIT;
    assert_int_equal(exr_image_init(&im, 1 << 20, 1 << 20, &err), ST_DATA);
    err = (struct err)ERR_INIT;
    assert_ok(exr_image_init(&im, 20000, 16, &err), err);
    assert_int_equal(exr_write(&im, scratch_path("none.exr"), NULL, &err), ST_INTERNAL);
    err = (struct err)ERR_INIT;
    memset(name, 'n', sizeof name);
    name[EXR_NAME_SIZE] = 0;
    assert_int_equal(exr_add_plane(&im, name, EXR_HALF, NULL, &err), ST_DATA);
    err = (struct err)ERR_INIT;
    name[EXR_NAME_SIZE - 1] = 0; /* longer than 31, the limit of old readers */
    assert_ok(exr_add_plane(&im, name, EXR_HALF, NULL, &err), err);
    assert_int_equal(exr_add_plane(&im, name, EXR_HALF, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "exists already");
    err = (struct err)ERR_INIT;
    assert_ok(exr_write(&im, scratch_path("long.exr"), NULL, &err), err);
    assert_ok(exr_read(&in, scratch_path("long.exr"), NULL, 0, &err), err);
    assert_string_equal(in.planes[0].name, name);
    assert_int_equal(in.width, 20000);
    exr_image_release(&in);
    exr_image_release(&im);
}

/* The images of the corpus hold B = x y / 8, G = y / 4, R = x + y / 16, Z = -1000.5 x - y, id = x + 1000 y. */
static void foreign_codecs_and_layouts_are_read(void **state)
{
    const char *const files[] = {"none", "rle", "zips", "zip", "tiled", "tiled-none", "offset-window", "attributes"};
    (void)state;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[100];
        struct err err = ERR_INIT;
        struct exr_image im;
        snprintf(path, sizeof path, CORPUS "%s.exr", files[i]);
        assert_ok(exr_read(&im, path, NULL, 0, &err), err);
        assert_int_equal(im.count, 5);
        for (int y = 0; y < im.height; y++) {
            for (int x = 0; x < im.width; x++) {
                int at = y * im.width + x;
                assert_true(exr_find(&im, "B")->f[at] == (float)(x * y) / 8);
                assert_true(exr_find(&im, "G")->f[at] == (float)y / 4);
                assert_true(exr_find(&im, "R")->f[at] == (float)x + (float)y / 16);
                assert_true(exr_find(&im, "Z")->f[at] == (float)(-1000.5 * x - y));
                assert_true(exr_find(&im, "id")->u[at] == (uint32_t)(x + 1000 * y));
            }
        }
        exr_image_release(&im);
    }
}

static void damaged_files_are_errors(void **state)
{
    const char *const cases[][2] = {
        {"no-such", "cannot open"},
        {"empty", "cannot read"},
        {"text", "not an OpenEXR"},
        {"cut-in-header", "cannot read"},
        {"header-only", "cannot read"},
        {"cut-in-table", "cannot read"},
        {"cut", "chunk 3 of 3"},
        {"missing-chunk", "chunk 2 of 3"},
        {"bad-zip", "chunk 1 of 1"},
        {"short-zip", "chunk 1 of 1"},
        {"long-zip", "chunk 1 of 1"},
        {"short-rle", "chunk 1 of 4"},
        {"short-none", "chunk 1 of 4"},
        {"wide-liar", "chunk 1 of 1"},
        {"too-large", "cannot read"},
        {"nan-half", "channel R holds NaN or infinity at pixel (3, 17)"},
        {"bad-window", "cannot read"},
        {"inf-float", "channel Z holds NaN or infinity at pixel (2, 1)"},
        {"crop", "display window"},
        {"subsampled", "channel BY is subsampled"},
        {"no-channels", "cannot read"},
        {"channel-twice", "cannot read"},
        {"deep", "cannot read"},
        {"multipart", "cannot read"},
        {"long-channel-name", "cannot read"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char path[100];
        struct err err = ERR_INIT;
        struct exr_image im;
        snprintf(path, sizeof path, CORPUS "%s.exr", cases[i][0]);
        assert_int_not_equal(exr_read(&im, path, NULL, 0, &err), ST_OK);
        assert_err(err, i ? ST_DATA : ST_IO, cases[i][1]);
        assert_contains(err.text, path);
        assert_null(im.planes);
    }
    /* channels that are not requested are not checked */
    const char *alpha = "A";
    struct err err = ERR_INIT;
    struct exr_image im;
    assert_ok(exr_read(&im, CORPUS "inf-float.exr", &alpha, 1, &err), err);
    exr_image_release(&im);
}

static struct view sample_view(int width, int height)
{
    struct view v = {.name = "IMG_1", .width = width, .height = height, .fx = 50, .fy = 60, .cx = 8, .cy = 7};
    v.cam_from_world = mat3_from_quat((struct quat){0.5, 0.5, -0.5, 0.5});
    v.translation = vec3_make(1, 2, 3);
    return v;
}

static void view_images_are_written(void **state)
{
    struct err err = ERR_INIT;
    struct view view = sample_view(17, 33);
    struct image im = {0}, in;
    (void)state;
    assert_ok(image_init(&im, 17, 33, 4, &err), err);
    for (int i = 0; i < 17 * 33 * 4; i++) im.data[i] = (float)(i % 1000) / 512;
    assert_ok(view_image_write(&im, NULL, scratch_path("IMG_1.exr"), &view, NULL, "approximate", &err), err);
    assert_ok(view_image_read(&in, scratch, &view, NULL, &err), err);
    assert_int_equal(in.channels, 4);
    assert_memory_equal(in.data, im.data, 17 * 33 * 4 * sizeof(float));
    image_release(&in);

    struct exr_image exr;
    assert_ok(exr_read(&exr, scratch_path("IMG_1.exr"), NULL, 0, &err), err);
    assert_string_equal(exr_attribute(&exr, "remodel:radiometry"), "approximate");
    assert_true(exr.has_world_to_camera);
    exr_image_release(&exr);

    view.width = 16;
    assert_int_equal(view_image_read(&in, scratch, &view, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "17 x 33");
    image_release(&im);
}

/* OpenEXR's camera looks along +z with y up: a point above and right of the axis has positive x and y there. */
static void world_to_camera_follows_openexr(void **state)
{
    struct exr_image im = {0};
    struct view view = sample_view(16, 14);
    const struct vec3 world = vec3_make(0.25, -4, 7);
    (void)state;
    view_image_set_camera(&im, &view);
    const float *m = im.world_to_camera, p[4] = {0.25F, -4, 7, 1};
    float out[4] = {0};
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++) out[c] += p[r] * m[4 * r + c];
    struct vec3 cam = vec3_add(mat3_apply(view.cam_from_world, world), view.translation);
    assert_true(fabs(out[0] - cam.x) < 1e-5 && fabs(out[1] + cam.y) < 1e-5 && fabs(out[2] - cam.z) < 1e-5);
    assert_true(out[3] == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(written_images_read_back),
        cmocka_unit_test(every_codec_reads_back),
        cmocka_unit_test(half_is_rounded_to_nearest_and_clamped),
        cmocka_unit_test(bytes_do_not_depend_on_threads_or_channel_order),
        cmocka_unit_test(invalid_samples_keep_the_old_file),
        cmocka_unit_test(provenance_is_in_the_file),
        cmocka_unit_test(a_product_is_read_once_and_recorded),
        cmocka_unit_test(rgba_images_and_numeric_attributes),
        cmocka_unit_test(names_and_sizes_have_limits),
        cmocka_unit_test(foreign_codecs_and_layouts_are_read),
        cmocka_unit_test(damaged_files_are_errors),
        cmocka_unit_test(view_images_are_written),
        cmocka_unit_test(world_to_camera_follows_openexr),
    };
    return cmocka_run_group_tests_name("exr", tests, scratch_make, scratch_remove);
}
