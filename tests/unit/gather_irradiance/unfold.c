/* unfold.c - every direction above a surface has one pixel of the unfolded hemicube, and the pixels fill the
 * hemisphere. */
#include "stages/gather_irradiance/unfold.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "common/base/rng.h"
#include "common/math/numbers.h"

enum { N = 64 };

static void every_pixel_of_a_face_has_one_direction_and_back(void **state)
{
    int faces = 0;
    (void)state;
    for (int y = -1; y <= 2 * N; y++)
        for (int x = -1; x <= 2 * N; x++) {
            struct vec3 d;
            int px, py;
            if (!unfold_direction(&d, N, x, y)) continue;
            faces++;
            unfold_pixel(&px, &py, N, d);
            if (px != x || py != y) fail_msg("pixel %d %d comes back as %d %d", x, y, px, py);
        }
    assert_int_equal(faces, 3 * N * N); /* a top of N x N and four sides of half of it */
}

/* Solid angles of pixels: area times cosine by distance squared, on a cube of side 2. */
static void pixels_fill_the_hemisphere(void **state)
{
    double sum = 0;
    (void)state;
    for (int y = 0; y < 2 * N; y++)
        for (int x = 0; x < 2 * N; x++) {
            struct vec3 d;
            if (!unfold_direction(&d, N, x, y)) continue;
            const double distance = vec3_length(d); /* to a plane at a distance of 1 */
            sum += 4.0 / (N * N) / (distance * distance * distance);
        }
    assert_float_equal(sum, 2 * PI, 1e-3);
}

static void directions_have_the_pixel_that_looks_there(void **state)
{
    const struct rng rng = rng_make(1, "unfold", "test");
    (void)state;
    for (uint64_t i = 0; i < 20000; i++) {
        const double z = 1e-6 + rng_uniform(&rng, i, 0), turn = 2 * PI * rng_uniform(&rng, i, 1);
        const double r = sqrt(fmax(0, 1 - z * z));
        const struct vec3 d = {r * cos(turn), r * sin(turn), z};
        struct vec3 centre;
        int x, y;
        unfold_pixel(&x, &y, N, d);
        assert_true(unfold_direction(&centre, N, x, y));
        /* on the plane of its face, at most half a pixel off in each direction */
        const double most = fmax(fmax(fabs(d.x), fabs(d.y)), d.z);
        const struct vec3 off = vec3_sub(vec3_scale(d, 1 / most), centre);
        assert_true(fmax(fmax(fabs(off.x), fabs(off.y)), fabs(off.z)) <= 1.0 / N + 1e-9);
    }
}

static void the_cross_continues_over_its_folds(void **state)
{
    int x, y;
    (void)state;
    unfold_pixel(&x, &y, N, vec3_make(0, 0, 1));
    assert_true(x == N && y == N);
    unfold_pixel(&x, &y, N, vec3_make(1, 0, 0.999));
    assert_true(x == 3 * N / 2 && y == N);
    unfold_pixel(&x, &y, N, vec3_make(1, 0, 1e-9));
    assert_true(x == 2 * N - 1 && y == N);
    unfold_pixel(&x, &y, N, vec3_make(-1, 0.01, 0.999));
    assert_true(x == N / 2 - 1 && y == N);
    unfold_pixel(&x, &y, N, vec3_make(0.01, 1, 1e-9));
    assert_true(x == N && y == 2 * N - 1);
    unfold_pixel(&x, &y, N, vec3_make(0.01, -1, 1e-9));
    assert_true(x == N && y == 0);
}

static void walls_have_down_below_and_pictures_are_not_mirrored(void **state)
{
    const struct vec3 normals[] = {{1, 0, 0}, {0, -1, 0}, {0.6, 0, 0.8}, {0, 0, 1}, {0, 0, -1}};
    (void)state;
    for (int i = 0; i < 5; i++) {
        struct vec3 right, down;
        unfold_frame(&right, &down, normals[i]);
        assert_float_equal(vec3_length(right), 1, 1e-12);
        assert_float_equal(vec3_dot(vec3_cross(right, down), normals[i]), 1, 1e-12); /* as of a camera */
        if (i < 3) assert_true(down.z < -0.5);
        if (i >= 3) assert_float_equal(down.y, -1, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pixel_of_a_face_has_one_direction_and_back),
        cmocka_unit_test(pixels_fill_the_hemisphere),
        cmocka_unit_test(directions_have_the_pixel_that_looks_there),
        cmocka_unit_test(the_cross_continues_over_its_folds),
        cmocka_unit_test(walls_have_down_below_and_pictures_are_not_mirrored),
    };
    return cmocka_run_group_tests_name("unfold", tests, NULL, NULL);
}
