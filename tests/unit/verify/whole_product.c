/* whole_product.c - whole products of every kind pass; cut, empty and mislabelled ones are refused by name. */
#include "stages/verify/whole_product.h"

#include "tests/unit/scratch.h"

#include "common/capture/point_cloud.h"
#include "common/image/exr.h"
#include "common/image/photo.h"
#include "common/texture/atlas.h"

static void assert_whole(const char *name)
{
    struct err err = ERR_INIT;
    assert_ok(product_verify(scratch_path(name), &err), err);
}

static void assert_refused(const char *name)
{
    struct err err = ERR_INIT;
    const enum status st = product_verify(scratch_path(name), &err);
    if (st != ST_DATA && st != ST_IO) fail_msg("%s: status %d", name, st);
    assert_non_null(strstr(err.text, name));
}

/* Copies the first `size` bytes of a file; all but `-size` of them if it is negative. */
static void cut(const char *from, const char *to, long size)
{
    static unsigned char bytes[1 << 20];
    FILE *f = fopen(scratch_path(from), "rb");
    assert_non_null(f);
    const size_t count = fread(bytes, 1, sizeof bytes, f);
    fclose(f);
    scratch_write_bytes(to, bytes, size < 0 ? count - (size_t)-size : (size_t)size);
}

/* An atlas of one tile, whose page has `width` texels in a row. */
static void write_atlas(int width)
{
    const struct provenance prov = {.stage = "test", .version = "0"};
    struct atlas_tile tile = {.face = 1, .view = -1, .width = 4, .height = 3, .matrix = {{0}, {0}, {0, 0, 0, 1}}};
    struct atlas atlas = {.tiles = &tile, .tile_count = 1};
    struct atlas_page page = {0};
    struct err err = ERR_INIT;
    assert_ok(atlas_pack(&atlas, &err), err);
    assert_ok(atlas_page_init(&page, width, 3, &err), err);
    assert_ok(atlas_write(&atlas, &page, scratch_path("vita"), &prov, &err), err);
    atlas_page_release(&page);
    free(atlas.page_sizes);
}

static void an_atlas_is_whole_with_its_pages(void **state)
{
    (void)state;
    write_atlas(4);
    assert_whole("vita/atlas.txt");
    assert_whole("vita/page0.exr");
    write_atlas(5);
    struct err err = ERR_INIT;
    assert_int_equal(product_verify(scratch_path("vita/atlas.txt"), &err), ST_DATA);
    assert_err(err, ST_DATA, "vita/page0.exr: found 5 x 3 texels, wanted 4 x 3");
    assert_int_equal(remove(scratch_path("vita/page0.exr")), 0);
    err = (struct err)ERR_INIT;
    assert_int_equal(product_verify(scratch_path("vita/atlas.txt"), &err), ST_IO);
    assert_non_null(strstr(err.text, "vita/page0.exr"));
    write_atlas(4);
    cut("vita/atlas.txt", "vita/cut.txt", -3);
    assert_int_equal(rename(scratch_path("vita/cut.txt"), scratch_path("vita/atlas.txt")), 0);
    assert_refused("vita/atlas.txt");
}

static void pictures_are_decoded(void **state)
{
    static unsigned char rgb[64 * 48 * 3];
    const struct provenance prov = {.stage = "test", .version = "0"};
    struct exr_image im = {0};
    struct exr_plane *plane;
    struct err err = ERR_INIT;
    (void)state;
    for (size_t i = 0; i < sizeof rgb; i++) rgb[i] = (unsigned char)(i * 37 % 251);
    assert_ok(png_write(scratch_path("a.png"), rgb, 64, 48, 3, &err), err);
    assert_ok(jpeg_write(scratch_path("a.jpg"), rgb, 64, 48, 90, &err), err);
    assert_ok(exr_image_init(&im, 64, 48, &err), err);
    assert_ok(exr_add_plane(&im, "Z", EXR_FLOAT, &plane, &err), err);
    for (int i = 0; i < 64 * 48; i++) plane->f[i] = (float)(i * 37 % 251);
    assert_ok(exr_write(&im, scratch_path("a.exr"), &prov, &err), err);
    exr_image_release(&im);
    static const char *const KINDS[] = {"png", "jpg", "exr"};
    for (int k = 0; k < 3; k++) {
        char whole[16], part[16];
        snprintf(whole, sizeof whole, "a.%s", KINDS[k]);
        assert_whole(whole);
        snprintf(part, sizeof part, "cut.%s", KINDS[k]);
        cut(whole, part, -2);
        assert_refused(part);
        cut(whole, part, 30);
        assert_refused(part);
        cut(whole, part, 0);
        assert_refused(part);
    }
    cut("a.jpg", "a.JPG", 1);
    assert_refused("a.JPG");
    assert_ok(png_write(scratch_path("png_inside.jpg"), rgb, 64, 48, 3, &err), err);
    assert_refused("png_inside.jpg");
    assert_refused("missing.png");
}

static void points_are_decoded(void **state)
{
    struct cloud_point points[2] = {{.normal = {0, 0, 1}, .views = 2, .confidence = 0.5f},
                                    {.normal = {0, 1, 0}, .views = 3, .confidence = 1}};
    const struct point_cloud cloud = {points, 2, 0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(point_cloud_write(&cloud, scratch_path("a.ply"), NULL, &err), err);
    assert_whole("a.ply");
    cut("a.ply", "cut.ply", -1);
    assert_refused("cut.ply");
}

static void videos_need_their_boxes(void **state)
{
    static const unsigned char FTYP[] = "\0\0\0\x10"
                                        "ftypisom\0\0\2\0",
                               MOOV[] = "\0\0\0\x0c"
                                        "moovabcd",
                               MDAT[] = "\0\0\0\1"
                                        "mdat\0\0\0\0\0\0\0\x12"
                                        "xy",
                               TO_END[] = "\0\0\0\0"
                                          "mdatxyz";
    unsigned char file[64];
    size_t size = 0;
    (void)state;
    memcpy(file, FTYP, 16), size = 16;
    memcpy(file + size, MOOV, 12), size += 12;
    scratch_write_bytes("no_data.mp4", file, size);
    assert_refused("no_data.mp4");
    memcpy(file + size, MDAT, 18);
    scratch_write_bytes("long.mp4", file, size + 18);
    assert_whole("long.mp4");
    scratch_write_bytes("cut.mp4", file, size + 17);
    assert_refused("cut.mp4");
    scratch_write_bytes("cut_head.mp4", file, size + 9);
    assert_refused("cut_head.mp4");
    memcpy(file + size, TO_END, 11);
    scratch_write_bytes("to_end.mp4", file, size + 11);
    assert_whole("to_end.mp4");
    scratch_write_bytes("no_type.mp4", file + 16, size + 11 - 16);
    assert_refused("no_type.mp4");
    memcpy(file + 16, TO_END, 11);
    scratch_write_bytes("no_index.mp4", file, 27);
    assert_refused("no_index.mp4");
    scratch_write("empty.mp4", "");
    assert_refused("empty.mp4");
}

static void texts_need_their_end(void **state)
{
    static const char *const WHOLE[][2] = {
        {"a.txt", "x\n"},       {"a.tsv", "a\t1\n"},        {"a.mk", "X :=\n"},      {"a.obj", "v 0 0 0\n"},
        {"a.py", "pass\n"},     {"a.svg", "<svg></svg>\n"}, {"a.html", "</html>\n"}, {"a.json", " {\"a\": 1}\n\n"},
        {"b.json", "[1,\n2]\n"}};
    static const char *const REFUSED[][2] = {
        {"b.txt", "x"},          {"c.txt", ""},       {"b.obj", "v 0 0"},
        {"b.svg", "<svg>\n"},    {"c.svg", "</svg>"}, {"b.html", "<html>\n</body>\n"},
        {"c.json", "{\"a\":\n"}, {"d.json", "[1}\n"}, {"e.json", "\n"}};
    (void)state;
    assert_int_equal(mkdir(scratch_path("views"), 0777), 0);
    for (size_t i = 0; i < sizeof WHOLE / sizeof *WHOLE; i++) {
        scratch_write(WHOLE[i][0], WHOLE[i][1]);
        assert_whole(WHOLE[i][0]);
    }
    for (size_t i = 0; i < sizeof REFUSED / sizeof *REFUSED; i++) {
        scratch_write(REFUSED[i][0], REFUSED[i][1]);
        assert_refused(REFUSED[i][0]);
    }
    assert_whole("a.txt");
    scratch_write("views/lenses.txt", "remodel-lenses 1\n");
    assert_whole("views/lenses.txt");
    scratch_write("views/lenses.txt", "remodel-lenses 2\n");
    assert_refused("views/lenses.txt");
    scratch_write_bytes("zeros.txt", "a\0\n", 3);
    assert_refused("zeros.txt");
    assert_refused("missing.txt");
}

static void files_of_unknown_kind_must_not_be_empty(void **state)
{
    (void)state;
    scratch_write("a.xyz", "x");
    scratch_write("b.xyz", "");
    scratch_write("plain", "x");
    assert_whole("a.xyz");
    assert_whole("plain");
    assert_refused("b.xyz");
    assert_refused("missing.xyz");
    assert_refused("."); /* a folder */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_atlas_is_whole_with_its_pages),
        cmocka_unit_test(pictures_are_decoded),
        cmocka_unit_test(points_are_decoded),
        cmocka_unit_test(videos_need_their_boxes),
        cmocka_unit_test(texts_need_their_end),
        cmocka_unit_test(files_of_unknown_kind_must_not_be_empty),
    };
    return cmocka_run_group_tests_name("product", tests, scratch_make, scratch_remove);
}
