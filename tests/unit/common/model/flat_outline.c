/* Outlines on floors and walls: what they hold, where rays meet them. */
#include "common/model/flat_outline.h"

#include "tests/unit/scratch.h"

static struct flat_outline outline_of(struct vec3 normal, double offset, const struct vec3 *corners, int count)
{
    struct flat_outline o;
    struct err err = ERR_INIT;
    assert_ok(flat_outline_init(&o, normal, offset, count, &err), err);
    for (int i = 0; i < count; i++) flat_outline_put(&o, i, corners[i]);
    return o;
}

/* The same rectangle, 3 x 2, on planes across all axes and on an oblique one. */
static void a_rectangle_is_the_same_on_all_planes(void **state)
{
    static const struct vec3 normals[] = {{0, 0, 1}, {0, 0, -1}, {-1, 0, 0}, {0, 1, 0}, {0.48, -0.6, 0.64}};
    (void)state;
    for (size_t n = 0; n < sizeof normals / sizeof *normals; n++) {
        const struct vec3 normal = normals[n], other = fabs(normal.x) < 0.9 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0),
                          a = vec3_normalize(vec3_cross(normal, other)), b = vec3_cross(normal, a);
        const struct vec3 middle = vec3_add(vec3_scale(normal, -1.25), vec3_add(a, b));
        struct vec3 corners[4];
        for (int i = 0; i < 4; i++)
            corners[i] =
                vec3_add(middle, vec3_add(vec3_scale(a, i == 1 || i == 2 ? 1.5 : -1.5), vec3_scale(b, i > 1 ? 1 : -1)));
        struct flat_outline o = outline_of(normal, -1.25, corners, 4);
        assert_float_equal(flat_outline_area(&o), 6, 1e-9);
        for (int i = 0; i < 4; i++)
            assert_float_equal(vec3_length(vec3_sub(flat_outline_corner(&o, i), corners[i])), 0, 1e-12);
        for (double u = -1.95; u < 2; u += 0.1)
            for (double v = -1.45; v < 1.5; v += 0.1) {
                const struct vec3 p = vec3_add(middle, vec3_add(vec3_scale(a, u), vec3_scale(b, v))),
                                  eye = vec3_add(vec3_add(middle, vec3_scale(normal, 2)), vec3_scale(a, 0.3)),
                                  behind = vec3_sub(middle, normal);
                const bool inside = fabs(u) < 1.5 && fabs(v) < 1;
                double t = 0;
                assert_int_equal(flat_outline_holds(&o, p), inside);
                assert_int_equal(flat_outline_meets(&t, &o, eye, vec3_scale(vec3_sub(p, eye), 0.5)), inside);
                assert_float_equal(t, 2, 1e-9);
                assert_false(flat_outline_meets(NULL, &o, eye, vec3_sub(eye, p)));
                assert_false(flat_outline_meets(NULL, &o, behind, vec3_sub(p, behind))); /* its back */
                assert_false(flat_outline_meets(NULL, &o, p, a));                        /* along the face */
            }
        assert_float_equal(flat_outline_height(&o, vec3_add(middle, vec3_scale(normal, 0.3))), 0.3, 1e-12);
        flat_outline_release(&o);
        assert_int_equal(o.count, 0);
    }
}

static void a_corner_off_the_plane_is_put_on_it(void **state)
{
    static const struct vec3 corners[] = {{0, 0, 1}, {1, 0, -1}, {0, 1, 0.5}};
    struct flat_outline o = outline_of(vec3_make(0, 0, 1), 0.5, corners, 3), copy;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(flat_outline_copy(&copy, &o, &err), err);
    flat_outline_release(&o);
    for (int i = 0; i < 3; i++) {
        const struct vec3 p = flat_outline_corner(&copy, i);
        assert_true(p.x == corners[i].x && p.y == corners[i].y && p.z == 0.5);
    }
    flat_outline_release(&copy);
    assert_ok(flat_outline_copy(&copy, &o, &err), err);
    assert_null(copy.xy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rectangle_is_the_same_on_all_planes),
        cmocka_unit_test(a_corner_off_the_plane_is_put_on_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
