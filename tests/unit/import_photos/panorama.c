/* panorama.c - views of a panorama whose colours are its directions; which photos are panoramas. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/capture/panorama_name.h"
#include "common/image/photo.h"
#include "common/math/numbers.h"
#include "stages/import_photos/panorama.h"

enum { W = 1024, H = 512 };

/* Red, green and blue are the x, y and z of the direction. */
static void colour_of(double rgb[3], double longitude, double latitude)
{
    const double d[3] = {cos(latitude) * sin(longitude), sin(latitude), cos(latitude) * cos(longitude)};
    for (int c = 0; c < 3; c++) rgb[c] = (0.5 + 0.4 * d[c]) * 65535;
}

static void make_panorama(struct photo *p)
{
    struct err err = ERR_INIT;
    *p = (struct photo){.info = {.width = W, .height = H, .bits = 16, .orientation = 1}};
    assert_ok(photo_init_samples(p, &err), err);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            double rgb[3];
            colour_of(rgb, ((x + 0.5) / W - 0.5) * 2 * PI, ((y + 0.5) / H - 0.5) * PI);
            for (int c = 0; c < 3; c++) p->samples[3 * (y * W + x) + c] = (uint16_t)lrint(rgb[c]);
        }
}

static void views_show_what_their_pixels_see(void **state)
{
    struct photo panorama;
    (void)state;
    make_panorama(&panorama);
    const int side = panorama_side(&panorama);
    assert_true(side % 2 == 0 && abs(side - (int)(W / PI)) <= 2);
    for (int view = 0; view < PANORAMA_VIEWS; view++) {
        struct photo p = {0};
        struct err err = ERR_INIT;
        const double yaw = view * PANORAMA_STEP * DEGREE, f = side / 2.0;
        assert_ok(panorama_cut(&p, &panorama, view * PANORAMA_STEP, &err), err);
        assert_true(p.info.width == side && p.info.height == side && p.info.bits == 16);
        for (int v = 0; v < side; v += 5)
            for (int u = 0; u < side; u += 5) {
                const double x = (u + 0.5 - f) / f, y = (v + 0.5 - f) / f;
                double rgb[3];
                colour_of(rgb, yaw + atan(x), atan2(y, hypot(x, 1)));
                for (int c = 0; c < 3; c++)
                    if (!(fabs(p.samples[3 * (v * side + u) + c] - rgb[c]) <= 8)) /* of 65535: rounding and bending */
                        fail_msg("view %d, pixel %d %d: %d, wanted %g", view, u, v, p.samples[3 * (v * side + u) + c],
                                 rgb[c]);
            }
        photo_release(&p);
    }
    photo_release(&panorama);
}

/* Writes part of the panorama, and finds whether it is one. */
static int found(const char *name, const struct photo *p, int x, int y, int width, int height, const char *rule)
{
    static int number;
    struct photo_scan scan = {0};
    struct photo_params params = PHOTO_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    char folder[300], path[400];
    snprintf(folder, sizeof folder, "%s/%d", scratch, ++number);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    snprintf(params.panoramas, sizeof params.panoramas, "%s", rule);
    assert_int_equal(mkdir(folder, 0777), 0);
    assert_ok(photo_write_part(path, p, x, y, width, height, &p->info, &err), err);
    assert_ok(photo_scan_folder(&scan, folder, &err), err);
    const int count = panorama_find(&scan, &params);
    assert_int_equal(scan.photos[0].panorama, count);
    photo_scan_release(&scan);
    return count;
}

static void panoramas_are_known_by_their_edges(void **state)
{
    struct photo p;
    (void)state;
    make_panorama(&p);
    assert_int_equal(found("a.png", &p, 0, 0, W, H, "auto"), 1);
    assert_int_equal(found("a.png", &p, 0, 0, W, H, "no"), 0);
    assert_int_equal(found("a.png", &p, 100, 0, W / 2 + 88, 300, "auto"), 0); /* 2:1 like a phone's wide photo */
    assert_int_equal(found("a.png", &p, 100, 0, 600, 300, "yes"), 1);
    assert_int_equal(found("a.png", &p, 0, 0, W, H - 1, "yes"), 0);
    photo_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_show_what_their_pixels_see),
        cmocka_unit_test(panoramas_are_known_by_their_edges),
    };
    return cmocka_run_group_tests_name("panorama", tests, scratch_make, scratch_remove);
}
