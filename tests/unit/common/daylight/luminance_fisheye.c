/* luminance_fisheye.c - a calibrated luminance picture of an office gives the illuminance at its lens by Radiance's
 * convention, 179 lm/W. The picture is not part of the repository: without ../shared/data the test is skipped. */
#include "common/daylight/sky_luminance.h"

#include "tests/unit/scratch.h"

#include "common/base/file_bytes.h"
#include "common/math/numbers.h"

#define PICTURE "../shared/data/luminance-fisheye/testimage.hdr"

enum { SIDE = 786 };
static const double FIELD = 182 * DEGREE; /* VIEW= -vta -vv 182 -vh 182: an angular fisheye */

/* One component of a row, in runs of equal and of different bytes. */
static const uint8_t *read_runs(uint8_t *to, const uint8_t *from)
{
    for (int x = 0; x < SIDE;) {
        const int n = *from++, equal = n > 128 ? n - 128 : 0, length = equal ? equal : n;
        assert_true(length > 0 && x + length <= SIDE);
        for (int i = 0; i < length; i++) to[x++] = equal ? *from : from[i];
        from += equal ? 1 : length;
    }
    return from;
}

static double luminance_of_pixel(const uint8_t rgbe[4])
{
    const double unit = rgbe[3] ? ldexp(1, rgbe[3] - 136) : 0;
    return WHITE_EFFICACY * unit * (0.265 * (rgbe[0] + 0.5) + 0.670 * (rgbe[1] + 0.5) + 0.065 * (rgbe[2] + 0.5));
}

static void the_illuminance_at_the_lens_is_the_stated_one(void **state)
{
    struct file_bytes file = {0};
    struct err err = ERR_INIT;
    static uint8_t row[4][SIDE];
    double illuminance = 0, angle = 0;
    (void)state;
    if (access(PICTURE, R_OK)) skip();
    assert_ok(file_bytes_read(&file, PICTURE, &err), err);
    const char *size = strstr(file.bytes, "\n\n-Y 786 +X 786\n");
    assert_non_null(size);
    const uint8_t *from = (const uint8_t *)strchr(size + 2, '\n') + 1;
    for (int y = 0; y < SIDE; y++) {
        from += 4; /* 2 2 and the width */
        for (int c = 0; c < 4; c++) from = read_runs(row[c], from);
        for (int x = 0; x < SIDE; x++) {
            const double u = (x + 0.5) / SIDE - 0.5, v = (y + 0.5) / SIDE - 0.5, theta = hypot(u, v) * FIELD;
            if (theta >= PI / 2) continue;
            const double solid = FIELD / SIDE * FIELD / SIDE * (theta > 0 ? sin(theta) / theta : 1);
            angle += solid;
            illuminance +=
                luminance_of_pixel((const uint8_t[4]){row[0][x], row[1][x], row[2][x], row[3][x]}) * solid * cos(theta);
        }
    }
    file_bytes_release(&file);
    assert_true(fabs(angle / (2 * PI) - 1) < 1e-4);
    /* its README says about 6100 lx */
    if (fabs(illuminance / 6100 - 1) > 0.01) fail_msg("%g lx", illuminance);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_illuminance_at_the_lens_is_the_stated_one)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
