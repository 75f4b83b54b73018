/* photo_cases.c - photos in other colour spaces against the same photos in sRGB, for developers who have
 * ../shared/data/cases/colour-profiles. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/image/photo.h"

#define CASES "../shared/data/cases/colour-profiles/"
#define SRGB  "../shared/data/kermit/photos/"

static void need_cases(void)
{
    FILE *there = fopen(CASES "README", "r"), *srgb = fopen(SRGB "kermit000.jpg", "r");
    const bool have = there && srgb;
    if (there) fclose(there);
    if (srgb) fclose(srgb);
    if (have) return;
    print_message(CASES " or " SRGB " does not exist: skipped\n");
    skip();
}

/* Linear Rec.709. */
static void read_linear(struct image *linear, struct photo *p, const char *path)
{
    struct err err = ERR_INIT;
    assert_ok(photo_read_any(p, path, &err), err);
    if (!p->values) {
        assert_ok(photo_to_linear(linear, p, &err), err);
        return;
    }
    assert_ok(image_init(linear, p->info.width, p->info.height, 3, &err), err);
    const size_t pixels = (size_t)p->info.width * (size_t)p->info.height;
    memcpy(linear->data, p->values, 3 * pixels * sizeof *p->values);
    if (p->space) colour_space_to_rec709(p->space, linear->data, pixels);
}

static void mean_of(double mean[3], const struct image *im)
{
    const size_t pixels = (size_t)im->width * (size_t)im->height;
    for (int c = 0; c < 3; c++) mean[c] = 0;
    for (size_t i = 0; i < 3 * pixels; i++) mean[i % 3] += (double)im->data[i] / (double)pixels;
}

static void compare(const char *path, const char *colour, const char *original, double most)
{
    struct image a = {0}, b = {0};
    struct photo p, q;
    double wanted[3], found[3], off = 0;
    read_linear(&a, &p, path);
    read_linear(&b, &q, original);
    assert_string_equal(p.info.colour, colour);
    assert_true(!*q.info.colour && a.width == b.width && a.height == b.height);
    mean_of(found, &a);
    mean_of(wanted, &b);
    for (int c = 0; c < 3; c++) off = fmax(off, fabs(found[c] / wanted[c] - 1));
    print_message("%s: mean off by %.2f %%\n", path, 100 * off);
    assert_true(off < most);
    image_release(&a);
    image_release(&b);
    photo_release(&p);
    photo_release(&q);
}

static void other_spaces_give_the_colours_of_srgb(void **state)
{
    (void)state;
    need_cases();
    compare(CASES "photos/kermit000.jpg", "Artifex Software A98 ICC Profile", SRGB "kermit000.jpg", 0.01);
    compare(CASES "photos/kermit001.png", "Artifex Software ROMMRGB ICC", SRGB "kermit001.jpg", 0.01);
    compare(CASES "photos/kermit002.png", "gAMA 1", SRGB "kermit002.jpg", 0.01);
    compare(CASES "photos/p3-kermit000.jpg", "Display P3 (test)", SRGB "kermit000.jpg", 0.01);
    compare(CASES "photos/p3-kermit001.jpg", "Display P3 (test)", SRGB "kermit001.jpg", 0.01);
}

/* Both hold one picture. */
static void an_exr_in_acescg_gives_the_colours_of_rec709(void **state)
{
    struct image linear = {0};
    struct photo p;
    double mean[3];
    const double wanted[3] = {0.20516, 0.22900, 0.19289}; /* of the samples of sm-aspect2.exr, in Rec.709 */
    (void)state;
    need_cases();
    read_linear(&linear, &p, CASES "sm-aces.exr");
    assert_string_equal(p.info.colour, "EXR chromaticities");
    mean_of(mean, &linear);
    for (int c = 0; c < 3; c++) assert_true(fabs(mean[c] / wanted[c] - 1) < 0.01);
    image_release(&linear);
    photo_release(&p);
}

static void an_exr_of_wide_pixels_is_refused(void **state)
{
    struct photo p = {0};
    struct err err = ERR_INIT;
    (void)state;
    need_cases();
    assert_int_equal(photo_read_any(&p, CASES "sm-aspect2.exr", &err), ST_DATA);
    assert_err(err, ST_DATA, "sm-aspect2.exr: its pixels are 2 times as wide as high, wanted square ones");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_spaces_give_the_colours_of_srgb),
        cmocka_unit_test(an_exr_in_acescg_gives_the_colours_of_rec709),
        cmocka_unit_test(an_exr_of_wide_pixels_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
