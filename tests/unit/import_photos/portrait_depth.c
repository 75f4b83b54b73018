/* portrait_depth.c - the depth that a HEIC carries comes out with its values.
 *
 * libheif writes no depth, but a picture's alpha, as an auxiliary picture too. Its name in the file is then changed from
 * that of alpha to that of depth, and XMP data are moved to it: a stand-in for a phone's portrait. */
#include "tests/unit/scratch.h"

#include <math.h>

#include <libheif/heif.h>

#include "stages/import_photos/portrait_depth.h"

enum { W = 128, H = 96 };

static int sample(int x, int y) { return 16 + x / 16 * 24 + y / 32 * 8; } /* flat blocks */

/* Writes a portrait; xmp: of its depth, or NULL. False: libheif has no encoder here. */
static bool write_portrait(const char *name, const char *xmp, bool is_depth)
{
    struct heif_context *context = heif_context_alloc();
    struct heif_encoder *encoder = NULL;
    struct heif_image *image = NULL;
    struct heif_image_handle *handle = NULL;
    int stride;
    if (heif_context_get_encoder_for_format(context, heif_compression_HEVC, &encoder).code != heif_error_Ok) {
        heif_context_free(context);
        return false;
    }
    heif_encoder_set_lossy_quality(encoder, 100);
    assert_int_equal(heif_image_create(W, H, heif_colorspace_RGB, heif_chroma_interleaved_RGBA, &image).code, 0);
    assert_int_equal(heif_image_add_plane(image, heif_channel_interleaved, W, H, 8).code, 0);
    unsigned char *rows = heif_image_get_plane(image, heif_channel_interleaved, &stride);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            unsigned char *p = rows + y * stride + 4 * x;
            p[0] = (unsigned char)(2 * x);
            p[1] = (unsigned char)(2 * y);
            p[2] = 128;
            p[3] = (unsigned char)sample(x, y);
        }
    assert_int_equal(heif_context_encode_image(context, image, encoder, NULL, &handle).code, 0);
    if (xmp) assert_int_equal(heif_context_add_XMP_metadata(context, handle, xmp, (int)strlen(xmp)).code, 0);
    assert_int_equal(heif_context_write_to_file(context, scratch_path(name)).code, 0);
    heif_image_handle_release(handle);
    heif_image_release(image);
    heif_encoder_release(encoder);
    heif_context_free(context);

    FILE *f = fopen(scratch_path(name), "r+b");
    static char bytes[1 << 20];
    const size_t size = fread(bytes, 1, sizeof bytes, f);
    char *aux = memmem(bytes, size, "urn:mpeg:hevc:2015:auxid:1", 26);
    assert_non_null(aux);
    if (is_depth) aux[25] = '2';
    char *describes = memmem(bytes, size, "cdsc", 4), *auxiliary = memmem(bytes, size, "auxl", 4);
    if (xmp) memcpy(describes + 8, auxiliary + 4, 2); /* the data describe the auxiliary picture, not the photo */
    rewind(f);
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    fclose(f);
    return true;
}

/* The values of ID.pfm, rows from the top. */
static void read_map(float values[W * H], const char *path)
{
    static const char head[] = "Pf\n128 96\n-1.0\n";
    char found[sizeof head] = "";
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    assert_int_equal(fread(found, 1, sizeof head - 1, f), sizeof head - 1);
    assert_string_equal(found, head);
    for (int y = H - 1; y >= 0; y--) assert_int_equal(fread(values + y * W, sizeof(float), W, f), W);
    fclose(f);
}

static void assert_taken(bool wanted, const char *name, enum status st)
{
    struct err err = ERR_INIT;
    bool taken;
    assert_int_equal(portrait_depth_take(&taken, scratch_path(name), "me", scratch_path("depth"), &err), st);
    assert_true(taken == wanted);
}

/* Two levels: what the codec loses in flat blocks. */
static void assert_values(double low, double high)
{
    float values[W * H];
    read_map(values, scratch_path("depth/me.pfm"));
    for (int y = 4; y < H; y += 8) /* away from the blocks' edges */
        for (int x = 8; x < W; x += 16) {
            const double wanted = low + (high - low) * sample(x, y) / 255;
            assert_true(fabs((double)values[y * W + x] - wanted) <= fabs(high - low) * 2 / 255);
        }
}

static void depth_comes_out_as_disparity(void **state)
{
    (void)state;
    if (!write_portrait("plain.heic", NULL, true)) skip();
    assert_taken(true, "plain.heic", ST_OK);
    assert_values(1 / 255.0, 1 + 1 / 255.0);
    char *text = scratch_read(scratch_path("depth/depth.txt"));
    assert_string_equal(text, "samples disparity\n");
    free(text);
}

static void xmp_data_state_its_range(void **state)
{
    static const char xmp[] = "<x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF xmlns:rdf='http://www.w3.org/1999/02/22-rdf"
                              "-syntax-ns#'><rdf:Description xmlns:apdi='http://ns.apple.com/pixeldatainfo/1.0/' "
                              "apdi:FloatMinValue='0.25'><apdi:FloatMaxValue>2.5</apdi:FloatMaxValue>"
                              "<apdi:AuxiliaryImageType>%s</apdi:AuxiliaryImageType></rdf:Description></rdf:RDF>"
                              "</x:xmpmeta>";
    static const char *const kinds[] = {"disparity", "depth"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        char own[1000], wanted[40];
        snprintf(own, sizeof own, xmp, kinds[i]);
        snprintf(wanted, sizeof wanted, "samples %s\n", kinds[i]);
        if (!write_portrait("apple.heic", own, true)) skip();
        assert_taken(true, "apple.heic", ST_OK);
        assert_values(0.25, 2.5);
        char *text = scratch_read(scratch_path("depth/depth.txt"));
        assert_string_equal(text, wanted);
        free(text);
    }
    if (!write_portrait("broken.heic", "<x:xmpmeta apdi", true)) skip(); /* which says nothing */
    assert_taken(true, "broken.heic", ST_OK);
    assert_values(1 / 255.0, 1 + 1 / 255.0);
}

static void photos_without_depth_have_none(void **state)
{
    struct err err = ERR_INIT;
    bool taken = true;
    (void)state;
    if (!write_portrait("alpha.heic", NULL, false)) skip();
    assert_taken(false, "alpha.heic", ST_OK);
    assert_ok(portrait_depth_take(&taken, "tests/fuzz/corpus/photo/exif.jpg", "me", scratch_path("depth"), &err), err);
    assert_false(taken);
}

static void what_is_old_is_removed(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    mkdir(scratch_path("old"), 0777);
    scratch_write("old/a.pfm", "a");
    scratch_write("old/b.pfm", "b");
    scratch_write("old/depth.txt", "samples depth\n");
    assert_ok(portrait_depth_remove("b", scratch_path("old"), &err), err);
    assert_int_not_equal(access(scratch_path("old/a.pfm"), F_OK), 0);
    assert_int_equal(access(scratch_path("old/b.pfm"), F_OK), 0);
    assert_int_equal(access(scratch_path("old/depth.txt"), F_OK), 0);
    assert_ok(portrait_depth_remove(NULL, scratch_path("old"), &err), err);
    assert_int_not_equal(access(scratch_path("old"), F_OK), 0);
    assert_ok(portrait_depth_remove(NULL, scratch_path("old"), &err), err);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth_comes_out_as_disparity),
        cmocka_unit_test(xmp_data_state_its_range),
        cmocka_unit_test(photos_without_depth_have_none),
        cmocka_unit_test(what_is_old_is_removed),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
