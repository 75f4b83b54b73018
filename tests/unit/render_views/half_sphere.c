/* half_sphere.c - each pixel of a half-sphere shows its own direction, across the edges of the cube's faces, whatever
 * the camera's pose; depth is along the camera's axis. */
#include "stages/render_views/half_sphere.h"

#include "common/math/vec.h"
#include "tests/unit/scratch.h"

#include <math.h>

#define DISTANCE 5.0 /* of a plane before the camera */

static struct view square(int n)
{
    struct view v = {
        .name = "eye", .width = n, .height = n, .fx = n / 2.0, .fy = n / 2.0, .cx = n / 2.0, .cy = n / 2.0};
    v.cam_from_world = mat3_from_quat((struct quat){0.5, 0.5, 0.5, 0.5});
    v.center = vec3_make(1, 2, 3);
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

struct seen {
    struct view eye;
    int faces;
};

/* Colours are the directions of pixels in the eye's frame. Directions behind 80 degrees show nothing. */
static enum status face(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err)
{
    struct seen *seen = ctx;
    seen->faces++;
    assert_float_equal(vec3_length(vec3_sub(camera->center, seen->eye.center)), 0, 0);
    if (rendered_frame_resize(out, camera->width, camera->height, true, err)) return err->status;
    for (int y = 0; y < camera->height; y++)
        for (int x = 0; x < camera->width; x++) {
            const size_t p = (size_t)(y * camera->width + x);
            const struct vec3 at = view_unproject(camera, x + 0.5, y + 0.5, 1);
            const struct vec3 q = mat3_apply(seen->eye.cam_from_world, vec3_sub(at, seen->eye.center));
            const struct vec3 d = vec3_normalize(q);
            const float rgb[3] = {(float)(0.5 + 0.5 * d.x), (float)(0.5 + 0.5 * d.y), (float)d.z};
            for (int k = 0; k < 3; k++) out->rgba[4 * p + (size_t)k] = rgb[k];
            out->rgba[4 * p + 3] = 1;
            out->z[p] = (float)(DISTANCE / q.z); /* the pixel's point has depth 1 in the face */
            out->hole[p] = d.z < cos(80 * acos(-1) / 180);
        }
    return ST_OK;
}

static void pixels_show_their_directions(void **state)
{
    (void)state;
    enum { N = 120 };
    struct err err = ERR_INIT;
    struct rendered_frame out = {0};
    struct seen seen = {square(N), 0};
    const double pi = acos(-1);
    double worst = 0, worst_z = 0;
    assert_ok(half_sphere_render(&out, &seen.eye, face, &seen, &err), err);
    assert_int_equal(seen.faces, 5);
    assert_true(out.width == N && out.height == N);
    for (int y = 0; y < N; y++)
        for (int x = 0; x < N; x++) {
            const float *c = out.rgba + 4 * (y * N + x);
            const double lon = ((x + 0.5) / N - 0.5) * pi, lat = ((y + 0.5) / N - 0.5) * pi;
            const double d[3] = {cos(lat) * sin(lon), sin(lat), cos(lat) * cos(lon)};
            worst = fmax(worst, fabs(2 * (double)c[0] - 1 - d[0]));
            worst = fmax(worst, fabs(2 * (double)c[1] - 1 - d[1]));
            worst = fmax(worst, fabs((double)c[2] - d[2]));
            assert_true(c[3] > 0.999F);
            if (d[2] > 0.5) worst_z = fmax(worst_z, fabs((double)out.z[y * N + x] - DISTANCE));
        }
    print_message("directions off by %.4f, depths by %.3f of %g\n", worst, worst_z, DISTANCE);
    assert_true(worst < 0.002);                          /* a pixel is 0.026 radians wide */
    assert_true(worst_z < 0.03 * DISTANCE);              /* of the nearest pixel */
    assert_float_equal(out.hole_fraction, 0.2919, 0.02); /* by numerical integration */
    assert_true(out.unfilled_fraction == 0);
    rendered_frame_release(&out);
}

static void other_shapes_are_refused(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct rendered_frame out = {0};
    struct seen seen = {square(20), 0};
    seen.eye.height = 18;
    assert_int_equal(half_sphere_render(&out, &seen.eye, face, &seen, &err), ST_DATA);
    assert_err(err, ST_DATA, "20 x 18 pixels, wanted a square");
    rendered_frame_release(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_show_their_directions),
        cmocka_unit_test(other_shapes_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
