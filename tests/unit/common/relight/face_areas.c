/* The nearest point on the faces of an id: inside, beside an edge, beside a corner, of several faces, of a random
 * triangle. */
#include "common/relight/face_areas.h"
#include "common/base/rng.h"
#include "tests/unit/edit_room.h"

static void a_point_on_a_face_is_itself_bit_for_bit(void **state)
{
    struct solid_mesh mesh = make_slabs(split_room, COUNT(split_room));
    struct face_areas a;
    struct err err = ERR_INIT;
    const struct rng rng = rng_make(1, "face_areas", "points");
    (void)state;
    assert_ok(face_areas_make(&a, &mesh, &err), err);
    for (uint64_t i = 0; i < 200; i++) {
        const struct vec3 p = {0.2 + 1.8 * rng_uniform(&rng, i, 0), -2 + 4 * rng_uniform(&rng, i, 1), -2};
        struct vec3 q;
        int face;
        bool on;
        assert_true(face_areas_nearest(&a, FLOOR, p, &q, &face, &on));
        assert_true(on);
        assert_memory_equal(&p, &q, sizeof p);
        assert_int_equal(solid_face_id(&mesh, face), FLOOR);
    }
    face_areas_release(&a);
    solid_mesh_release(&mesh);
}

static void beside_a_face_the_nearest_point_is_on_its_rim(void **state)
{
    static const struct vec3 from[] = {{0.15, 1, -2}, {-0.15, -1, -2}, {3, 1, -2},
                                       {4, 5, -2},    {-3, -3, -2},    {1, -7, -2}};
    static const struct vec3 to[] = {{0.2, 1, -2}, {-0.2, -1, -2}, {2, 1, -2}, {2, 2, -2}, {-2, -2, -2}, {1, -2, -2}};
    struct solid_mesh mesh = make_slabs(split_room, COUNT(split_room));
    struct face_areas a;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(face_areas_make(&a, &mesh, &err), err);
    for (int i = 0; i < 6; i++) {
        struct vec3 q;
        int face;
        bool on;
        assert_true(face_areas_nearest(&a, FLOOR, from[i], &q, &face, &on));
        assert_false(on);
        assert_true(vec3_length(vec3_sub(q, to[i])) < 1e-12);
        assert_near(face_areas_distance(&a, face, from[i], &q), vec3_length(vec3_sub(from[i], to[i])), 1e-12);
    }
    face_areas_release(&a);
    solid_mesh_release(&mesh);
}

static void an_id_that_no_face_has_is_refused(void **state)
{
    struct solid_mesh mesh = make_slabs(closed_room, COUNT(closed_room));
    struct face_areas a;
    struct err err = ERR_INIT;
    struct vec3 q;
    int face;
    bool on;
    (void)state;
    assert_ok(face_areas_make(&a, &mesh, &err), err);
    assert_false(face_areas_nearest(&a, 0, q = vec3_make(0, 0, 0), &q, &face, &on));
    assert_false(face_areas_nearest(&a, -1, q, &q, &face, &on));
    assert_false(face_areas_nearest(&a, 99999, q, &q, &face, &on));
    face_areas_release(&a);
    face_areas_release(&a);
    face_areas_release(NULL);
    solid_mesh_release(&mesh);
}

/* No point of a face is nearer than the one that is found. */
static void no_other_point_is_nearer(void **state)
{
    struct solid_mesh mesh = make_slabs(closed_room, COUNT(closed_room));
    struct face_areas a;
    struct err err = ERR_INIT;
    const struct rng rng = rng_make(2, "face_areas", "points");
    const int face = face_named(&mesh, "floor/5");
    (void)state;
    assert_ok(face_areas_make(&a, &mesh, &err), err);
    for (uint64_t i = 0; i < 300; i++) {
        struct vec3 q;
        const struct vec3 p = {10 * rng_uniform(&rng, i, 0) - 5, 10 * rng_uniform(&rng, i, 1) - 5,
                               4 * rng_uniform(&rng, i, 2) - 4};
        const double d = face_areas_distance(&a, face, p, &q);
        const double dx = fmax(fabs(p.x) - 2, 0), dy = fmax(fabs(p.y) - 2, 0), dz = p.z + 2;
        assert_true(fabs(d - sqrt(dx * dx + dy * dy + dz * dz)) < 1e-12);
        assert_true(fabs(vec3_length(vec3_sub(p, q)) - d) < 1e-12);
    }
    face_areas_release(&a);
    solid_mesh_release(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_point_on_a_face_is_itself_bit_for_bit),
        cmocka_unit_test(beside_a_face_the_nearest_point_is_on_its_rim),
        cmocka_unit_test(an_id_that_no_face_has_is_refused),
        cmocka_unit_test(no_other_point_is_nearer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
