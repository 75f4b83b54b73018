/* photo_mask.c - masks of photos and of exposures: masked pixels and errors. */
#include "tests/unit/scratch.h"

#include "common/capture/photo_mask.h"

enum { W = 8, H = 6 };

/* masks/NAME.png: `value` in all columns from `begin`, white elsewhere. */
static void paint(const char *name, int width, int begin, unsigned char value)
{
    unsigned char grey[2 * W * H];
    char file[64];
    struct err err = ERR_INIT;
    for (int i = 0; i < width * H; i++) grey[i] = i % width >= begin ? value : 255;
    mkdir(scratch_path("masks"), 0777);
    snprintf(file, sizeof file, "masks/%s.png", name);
    assert_ok(png_write(scratch_path(file), grey, width, H, 1, &err), err);
}

static int no_masks(void **state)
{
    (void)state;
    static const char *const names[] = {"masks/a.png", "masks/e1.png", "masks/e2.png", "masks/other.png", "masks"};
    for (int i = 0; i < 5; i++) remove(scratch_path(names[i]));
    return mkdir(scratch_path("masks"), 0777);
}

static struct photo_record photo(void)
{
    return (struct photo_record){.id = (char *)"a", .file = (char *)"a.jpg", .info = {.width = W, .height = H}};
}

static struct photo_mask read_mask(const struct photo_record *r, struct provenance *prov)
{
    struct photo_mask m;
    struct err err = ERR_INIT;
    assert_ok(photo_mask_read(&m, scratch_path("masks"), scratch, r, prov, &err), err);
    return m;
}

static void without_a_mask_nothing_is_masked(void **state)
{
    (void)state;
    const struct photo_record r = photo();
    struct photo_mask m;
    struct err err = ERR_INIT;
    paint("other", W, 0, 0);
    m = read_mask(&r, NULL);
    assert_null(m.masked);
    assert_ok(photo_mask_read(&m, NULL, scratch, &r, NULL, &err), err);
    assert_null(m.masked);
}

static void samples_below_half_are_masked(void **state)
{
    (void)state;
    const struct photo_record r = photo();
    for (int value = 0; value < 256; value += 127) {
        struct provenance prov = {0};
        paint("a", W, 5, (unsigned char)value);
        struct photo_mask m = read_mask(&r, &prov);
        assert_true(m.width == W && m.height == H);
        for (int i = 0; i < W * H; i++) assert_int_equal(m.masked[i], i % W >= 5 && value < 128);
        assert_int_equal(prov.count, 1);
        assert_string_equal(prov.inputs[0].name, "masks/a.png");
        provenance_release(&prov);
        photo_mask_release(&m);
        photo_mask_release(&m);
    }
}

static void masks_of_another_size_are_rejected(void **state)
{
    (void)state;
    const struct photo_record r = photo();
    struct photo_mask m;
    struct err err = ERR_INIT;
    paint("a", 2 * W, 5, 0);
    assert_int_equal(photo_mask_read(&m, scratch_path("masks"), scratch, &r, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "masks/a.png has 16 x 6 pixels, but the photo \"a.jpg\" that it masks has 8 x 6");
    assert_null(m.masked);
}

static void masks_of_the_whole_photo_are_rejected(void **state)
{
    (void)state;
    const struct photo_record r = photo();
    struct photo_mask m;
    struct err err = ERR_INIT;
    paint("a", W, 0, 1); /* 0 and 1 instead of 0 and 255 */
    assert_int_equal(photo_mask_read(&m, scratch_path("masks"), scratch, &r, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "the mask of photo a");
    assert_contains(err.text, "EXCLUDE");
    assert_null(m.masked);
    scratch_write("masks/a.png", "no picture");
    err = (struct err)ERR_INIT;
    assert_int_equal(photo_mask_read(&m, scratch_path("masks"), scratch, &r, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "masks/a.png is neither JPEG, PNG");
}

/* A pixel is masked by the view's mask or that of any exposure; masks of other photos are ignored. */
static void masks_of_exposures_are_combined(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct photo_record r = photo();
    struct bracket brackets[] = {{.file = (char *)"IMG 1.jpg"}, {.file = (char *)"IMG 2.jpg"}};
    struct provenance prov = {0};
    char members[512];
    r.brackets = brackets;
    r.bracket_count = 2;
    snprintf(members, sizeof members, "%s/members", scratch);
    mkdir(members, 0777);
    static const char *const ids[] = {"e1", "e2", "other"}, *const files[] = {"IMG 1.jpg", "IMG 2.jpg", "IMG 3.jpg"};
    for (int k = 0; k < 3; k++) {
        struct photo_record member = {.id = (char *)ids[k],
                                      .file = (char *)files[k],
                                      .hash = "0123456789abcdef0123456789abcdef",
                                      .info = {.width = W, .height = H, .bits = 8, .orientation = 1}};
        assert_ok(photo_record_write(&member, members, &err), err);
    }
    paint("e2", W, 6, 0);
    paint("e1", W, 7, 0);
    paint("other", W, 0, 0);
    struct photo_mask m = read_mask(&r, &prov);
    for (int i = 0; i < W * H; i++) assert_int_equal(m.masked[i], i % W >= 6);
    assert_int_equal(prov.count, 2);
    photo_mask_release(&m);
    provenance_release(&prov);
    paint("a", W, 4, 0);
    m = read_mask(&r, NULL);
    for (int i = 0; i < W * H; i++) assert_int_equal(m.masked[i], i % W >= 4);
    photo_mask_release(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(without_a_mask_nothing_is_masked, no_masks),
        cmocka_unit_test_setup(samples_below_half_are_masked, no_masks),
        cmocka_unit_test_setup(masks_of_another_size_are_rejected, no_masks),
        cmocka_unit_test_setup(masks_of_the_whole_photo_are_rejected, no_masks),
        cmocka_unit_test_setup(masks_of_exposures_are_combined, no_masks),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
