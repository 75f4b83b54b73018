/* portrait_depth.c - the depth that a HEIC carries comes out with its values.
 *
 * libheif writes no depth, but a picture's alpha, as an auxiliary picture too. In the corpus' portraits its name was
 * changed from that of alpha to that of depth (auxid:1 to auxid:2), and XMP data were moved to it: stand-ins for a
 * phone's. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/import_photos/portrait_depth.h"

#define CORPUS "tests/fuzz/corpus/photo/"

enum { W = 128, H = 96 };

static int sample(int x, int y) { return 16 + x / 16 * 24 + y / 32 * 8; } /* flat blocks */

/* Writes a portrait of the corpus as NAME, with words replaced by others of the same length. */
static void write_portrait(const char *name, const char *from, const char *old, const char *new)
{
    static char bytes[1 << 16];
    FILE *f = fopen(from, "rb");
    assert_non_null(f);
    const size_t size = fread(bytes, 1, sizeof bytes, f);
    fclose(f);
    char *at = old ? memmem(bytes, size, old, strlen(old)) : NULL;
    assert_true(!old || (at && strlen(old) == strlen(new)));
    if (at) memcpy(at, new, strlen(new));
    scratch_write_bytes(name, bytes, size);
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

static void assert_units(const char *wanted)
{
    char *text = scratch_read(scratch_path("depth/depth.txt"));
    assert_string_equal(text, wanted);
    free(text);
}

static void depth_comes_out_as_disparity(void **state)
{
    (void)state;
    write_portrait("plain.heic", CORPUS "portrait.heic", NULL, NULL);
    assert_taken(true, "plain.heic", ST_OK);
    assert_values(1 / 255.0, 1 + 1 / 255.0);
    assert_units("samples disparity\n");
}

static void xmp_data_state_its_range(void **state)
{
    (void)state;
    write_portrait("apple.heic", CORPUS "portrait-range.heic", NULL, NULL);
    assert_taken(true, "apple.heic", ST_OK);
    assert_values(0.25, 2.5);
    assert_units("samples disparity\n");
    write_portrait("depth.heic", CORPUS "portrait-range.heic", ">disparity<", ">depth    <");
    assert_taken(true, "depth.heic", ST_OK);
    assert_values(0.25, 2.5);
    assert_units("samples depth\n");
    write_portrait("broken.heic", CORPUS "portrait-range.heic", "<x:xmpmeta ", "<x:xmpmeta<"); /* which says nothing */
    assert_taken(true, "broken.heic", ST_OK);
    assert_values(1 / 255.0, 1 + 1 / 255.0);
    assert_units("samples disparity\n");
}

static void photos_without_depth_have_none(void **state)
{
    struct err err = ERR_INIT;
    bool taken = true;
    (void)state;
    write_portrait("alpha.heic", CORPUS "portrait.heic", "2015:auxid:2", "2015:auxid:1");
    assert_taken(false, "alpha.heic", ST_OK);
    assert_ok(portrait_depth_take(&taken, CORPUS "exif.jpg", "me", scratch_path("depth"), &err), err);
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
