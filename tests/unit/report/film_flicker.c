/* film_flicker.c - surfaces that keep their light do not flicker, however the camera moves; changes are measured. */
#include "stages/report/film_flicker.h"

#include <errno.h>
#include <math.h>
#include <sys/resource.h>

#include "common/base/outfile.h"
#include "tests/unit/scratch.h"

enum { W = 64, H = 48 };

struct plane_picture {
    struct flicker_picture picture;
    float luminance[W * H], z[W * H];
};

/* A plane z = 5 + x / 2 in the world, whose light is linear in the picture of the first camera's direction. */
static void make(struct plane_picture *p, double x, double factor)
{
    struct view *c = &p->picture.camera;
    *c = (struct view){.name = "0001", .width = W, .height = H, .fx = 60, .fy = 60, .cx = W / 2.0, .cy = H / 2.0};
    c->cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    c->center = vec3_make(x, 0, 0);
    c->translation = vec3_make(-x, 0, 0);
    for (int i = 0; i < W * H; i++) {
        const double u = (i % W + 0.5 - c->cx) / c->fx, v = (i / W + 0.5 - c->cy) / c->fy;
        const double z = (5 + x / 2) / (1 - u / 2); /* z = 5 + (x + u z) / 2 */
        p->z[i] = (float)z;
        p->luminance[i] = (float)(factor * (2 + 0.1 * (x + u * z) + 0.05 * v * z));
    }
    p->picture.luminance = p->luminance;
    p->picture.z = p->z;
}

static void a_steady_surface_does_not_flicker(void **state)
{
    (void)state;
    static struct plane_picture a, b;
    struct flicker_values v = {.values = NULL};
    struct err err = ERR_INIT;
    make(&a, 0, 1);
    make(&b, 0.23, 1);
    assert_ok(film_flicker_add(&v, &a.picture, &b.picture, 1, &err), err);
    assert_true(v.count > W * H / 2);
    assert_true(film_flicker_quantile(&v, 1) < 1e-3); /* curvature between pixels */
    film_flicker_release(&v);
}

static void a_change_of_a_tenth_is_ten_per_cent(void **state)
{
    (void)state;
    static struct plane_picture a, b;
    struct flicker_values v = {.values = NULL};
    struct err err = ERR_INIT;
    make(&a, 0, 1);
    make(&b, 0.1, 1.1);
    assert_ok(film_flicker_add(&v, &a.picture, &b.picture, 2, &err), err);
    assert_float_equal(film_flicker_quantile(&v, 0.5), 0.1, 1e-3);
    assert_float_equal(film_flicker_quantile(&v, 0.95), 0.1, 1e-3);
    film_flicker_release(&v);
}

static void hidden_and_unknown_places_do_not_count(void **state)
{
    (void)state;
    static struct plane_picture a, b;
    struct flicker_values v = {.values = NULL};
    struct err err = ERR_INIT;
    make(&a, 0, 1);
    make(&b, 0, 2);
    for (int i = 0; i < W * H; i++) {
        if (i % W < W / 2) a.z[i] = 0;     /* unknown */
        if (i / W < H / 2) b.z[i] *= 0.9F; /* something nearer */
    }
    assert_ok(film_flicker_add(&v, &a.picture, &b.picture, 1, &err), err);
    assert_true(v.count > 0 && v.count <= W * H / 4);
    film_flicker_release(&v);
    assert_true(film_flicker_quantile(&v, 0.5) == 0);
}

static void films_without_frames_have_no_flicker(void **state)
{
    (void)state;
    struct camera_path path = {0};
    struct err err = ERR_INIT;
    double middle, high;
    bool known = true;
    assert_ok(camera_path_init(&path, "test", 25, 5, &err), err);
    assert_ok(film_flicker_measure(&middle, &high, &known, &path, scratch, "parallax/test", &err), err);
    assert_false(known);
    camera_path_release(&path);
}

/* A frame that cannot be opened for a moment is not a film without flicker. */
static void a_trouble_that_passes_is_an_error(void **state)
{
    (void)state;
    struct camera_path path = {0};
    struct rlimit was, none;
    struct err err = ERR_INIT;
    double middle, high;
    bool known = true;
    assert_ok(camera_path_init(&path, "test", 25, 5, &err), err);
    assert_ok(outfile_make_folders(scratch_path("parallax/test/frames"), &err), err);
    scratch_write("parallax/test/frames/0001.exr", "a frame");
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &was), 0);
    none = (struct rlimit){.rlim_cur = 0, .rlim_max = was.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &none), 0);
    film_flicker_measure(&middle, &high, &known, &path, scratch, "parallax/test", &err);
    assert_int_equal(setrlimit(RLIMIT_NOFILE, &was), 0);
    assert_int_equal(err.status, ST_IO);
    assert_non_null(strstr(err.text, strerror(EMFILE)));
    camera_path_release(&path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_steady_surface_does_not_flicker),
        cmocka_unit_test(a_change_of_a_tenth_is_ten_per_cent),
        cmocka_unit_test(hidden_and_unknown_places_do_not_count),
        cmocka_unit_test(films_without_frames_have_no_flicker),
        cmocka_unit_test(a_trouble_that_passes_is_an_error),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
