/* Samples on faces and the interpolation between them: linear functions, holes, tiny and narrow faces, points
 * beyond. */
#include "stages/update_vita/face_nets.h"
#include "common/base/rng.h"
#include "tests/unit/edit_room.h"

static void make_nets(struct face_nets *n, const struct solid_mesh *mesh, double spacing)
{
    bool wanted[6 * MAX_BOXES];
    struct err err = ERR_INIT;
    for (int i = 0; i < mesh->face_count; i++) wanted[i] = true;
    assert_ok(face_nets_make(n, mesh, wanted, spacing, &err), err);
}

static double linear(struct vec3 p) { return 3 + 2 * p.x - 5 * p.y + 0.7 * p.z; }

static double interpolated(const struct face_nets *n, int face, struct vec3 p)
{
    struct net_weights w;
    double sum = 0, weights = 0;
    assert_true(face_nets_find(n, face, p, &w));
    for (int k = 0; k < 3; k++) {
        assert_true(w.weight[k] >= 0 && w.weight[k] <= 1);
        assert_true(w.sample[k] >= 0 && w.sample[k] < n->sample_count);
        assert_int_equal(n->samples[w.sample[k]].face, face);
        weights += w.weight[k];
        sum += w.weight[k] * linear(n->samples[w.sample[k]].at);
    }
    assert_near(weights, 1, 1e-12);
    return sum;
}

/* Within the outermost samples, 1/16 of the spacing from the edges. */
static void linear_functions_are_reproduced(void **state)
{
    static const double spacings[] = {0.1, 0.37, 1, 5};
    struct solid_mesh mesh = make_slabs(closed_room, COUNT(closed_room));
    const struct rng rng = rng_make(1, "face_nets", "points");
    const int floor = face_named(&mesh, "floor/5"), west = face_named(&mesh, "west/1");
    (void)state;
    for (int s = 0; s < 4; s++) {
        struct face_nets n;
        make_nets(&n, &mesh, spacings[s]);
        const double half = 2 - spacings[s] / 16;
        for (uint64_t i = 0; i < 500; i++) {
            const double a = half * (2 * rng_uniform(&rng, i, 0) - 1), b = half * (2 * rng_uniform(&rng, i, 1) - 1);
            const struct vec3 p = {a, b, -2}, q = {-2, a, b};
            assert_true(fabs(interpolated(&n, floor, p) - linear(p)) < 1e-9);
            assert_true(fabs(interpolated(&n, west, q) - linear(q)) < 1e-9);
        }
        face_nets_release(&n);
    }
    solid_mesh_release(&mesh);
}

static void added_samples_are_interpolated_between(void **state)
{
    struct solid_mesh mesh = make_slabs(closed_room, COUNT(closed_room));
    const struct rng rng = rng_make(2, "face_nets", "points");
    const int floor = face_named(&mesh, "floor/5");
    struct face_nets n;
    struct err err = ERR_INIT;
    (void)state;
    make_nets(&n, &mesh, 1);
    const int before = n.sample_count;
    for (uint64_t i = 0; i < 100; i++) {
        const struct vec3 p = {3.8 * rng_uniform(&rng, i, 0) - 1.9, 3.8 * rng_uniform(&rng, i, 1) - 1.9, -2};
        assert_ok(face_nets_add(&n, floor, p, &err), err);
    }
    assert_ok(face_nets_connect(&n, &err), err);
    assert_int_equal(n.sample_count, before + 100);
    for (int i = before; i < n.sample_count; i++) {
        struct net_weights w;
        assert_true(face_nets_find(&n, floor, n.samples[i].at, &w));
        const int k = w.weight[0] > 0.5 ? 0 : w.weight[1] > 0.5 ? 1 : 2;
        assert_int_equal(w.sample[k], i);
        assert_near(w.weight[k], 1, 1e-9);
    }
    face_nets_release(&n);
    solid_mesh_release(&mesh);
}

static void beyond_the_samples_values_stay_between_theirs(void **state)
{
    struct solid_mesh mesh = make_slabs(closed_room, COUNT(closed_room));
    const int floor = face_named(&mesh, "floor/5");
    struct face_nets n;
    (void)state;
    make_nets(&n, &mesh, 0.5);
    for (int i = 0; i < 360; i++) {
        const struct vec3 p = {9 * cos(i), 9 * sin(i), -2};
        const double v = interpolated(&n, floor, p);
        assert_true(v >= 3 - 4 - 10 - 1.4 - 1e-9 && v <= 3 + 4 + 10 - 1.4 + 1e-9);
    }
    face_nets_release(&n);
    solid_mesh_release(&mesh);
}

/* A square of side 4 about the origin with a square hole of side 2, above a pit of the hole's outline. */
static struct solid_mesh make_holed(void)
{
    static const struct vec3 v[] = {{-2, -2, 0},  {2, -2, 0},  {2, 2, 0},    {-2, 2, 0},  {-1, -1, 0}, {1, -1, 0},
                                    {1, 1, 0},    {-1, 1, 0},  {-2, -2, -3}, {2, -2, -3}, {2, 2, -3},  {-2, 2, -3},
                                    {-1, -1, -1}, {1, -1, -1}, {1, 1, -1},   {-1, 1, -1}};
    static const int top[8] = {0, 1, 2, 3, 7, 6, 5, 4}, four[2] = {4, 4};
    static const int quads[10][4] = {{11, 10, 9, 8},   {0, 8, 9, 1},   {1, 9, 10, 2},  {2, 10, 11, 3}, {3, 11, 8, 0},
                                     {12, 13, 14, 15}, {4, 5, 13, 12}, {5, 6, 14, 13}, {6, 7, 15, 14}, {7, 4, 12, 15}};
    static const struct vec3 normals[10] = {{0, 0, -1}, {0, -1, 0}, {1, 0, 0},  {0, 1, 0},  {-1, 0, 0},
                                            {0, 0, 1},  {0, 1, 0},  {-1, 0, 0}, {0, -1, 0}, {1, 0, 0}};
    static char names[11][16];
    struct solid_polygon p[11] = {{"top", "block", {0, 0, 1}, 0, top, four, 2}};
    struct solid_mesh mesh = {0};
    struct err err = ERR_INIT;
    for (int i = 0; i < 10; i++) {
        snprintf(names[i], sizeof names[i], "side%d", i);
        p[i + 1] = (struct solid_polygon){names[i], "block", normals[i], vec3_dot(normals[i], v[quads[i][0]]),
                                          quads[i], four,    1};
    }
    assert_ok(solid_mesh_make(&mesh, v, 16, p, 11, NULL, &err), err);
    return mesh;
}

static void a_hole_has_no_samples_and_does_not_disturb_those_around_it(void **state)
{
    struct solid_mesh mesh = make_holed();
    const struct rng rng = rng_make(3, "face_nets", "points");
    struct face_nets n;
    int rim = 0;
    (void)state;
    make_nets(&n, &mesh, 0.4);
    for (int i = 0; i < n.nets[0].count; i++) {
        const struct vec3 p = n.samples[n.nets[0].samples[i]].at;
        const double out = fmax(fabs(p.x), fabs(p.y));
        assert_true(out > 1 && out < 2);
        rim += out < 1.05;
    }
    assert_true(rim >= 4 * 5);
    for (uint64_t i = 0; i < 500; i++) {
        const struct vec3 p = {3.9 * rng_uniform(&rng, i, 0) - 1.95, 3.9 * rng_uniform(&rng, i, 1) - 1.95, 0};
        assert_true(fabs(interpolated(&n, 0, p) - linear(p)) < 1e-9);
    }
    face_nets_release(&n);
    solid_mesh_release(&mesh);
}

static void tiny_and_narrow_faces_have_samples(void **state)
{
    static const struct box small[] = {{"a", "tiny", {0, 0, 0}, {1e-3, 1e-3, 1e-3}, false},
                                       {"b", "narrow", {1, 1, 1}, {3, 1 + 1e-6, 1 + 1e-6}, false},
                                       {"c", "sheet", {5, 0, 0}, {9, 4, 1e-9}, false}};
    struct solid_mesh mesh = make_boxes(small, 3);
    struct face_nets n;
    (void)state;
    make_nets(&n, &mesh, 0.3);
    for (int i = 0; i < mesh.face_count; i++) {
        const int first = mesh.loops[mesh.faces[i].loop].half_edge;
        const struct vec3 corner = mesh.vertices[mesh.half_edges[first].origin].p;
        assert_true(n.nets[i].count >= 1);
        assert_true(isfinite(interpolated(&n, i, corner)));
        for (int k = 0; k < n.nets[i].count; k++) {
            const struct vec3 p = n.samples[n.nets[i].samples[k]].at;
            assert_true(fabs(vec3_dot(mesh.faces[i].normal, p) - mesh.faces[i].offset) < 1e-12);
        }
    }
    face_nets_release(&n);
    solid_mesh_release(&mesh);
}

/* Between samples in a line there is no triangle: the nearest one counts. */
static void of_samples_in_a_line_the_nearest_counts(void **state)
{
    struct solid_mesh mesh = make_slabs(closed_room, COUNT(closed_room));
    const int floor = face_named(&mesh, "floor/5");
    bool wanted[6 * MAX_BOXES] = {false};
    struct face_nets n;
    struct err err = ERR_INIT;
    struct net_weights w;
    (void)state;
    assert_ok(face_nets_make(&n, &mesh, wanted, 1, &err), err);
    assert_int_equal(n.sample_count, 0);
    assert_false(face_nets_find(&n, floor, vec3_make(0, 0, -2), &w));
    n.nets[floor].u = vec3_make(1, 0, 0), n.nets[floor].v = vec3_make(0, 1, 0);
    for (int i = 0; i < 5; i++) assert_ok(face_nets_add(&n, floor, vec3_make(i - 2, i - 2, -2), &err), err);
    assert_ok(face_nets_connect(&n, &err), err);
    assert_true(face_nets_find(&n, floor, vec3_make(0.8, 1.1, -2), &w));
    assert_int_equal(w.sample[0], 3);
    assert_near(w.weight[0], 1, 0);
    face_nets_release(&n);
    face_nets_release(&n);
    face_nets_release(NULL);
    solid_mesh_release(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_functions_are_reproduced),
        cmocka_unit_test(added_samples_are_interpolated_between),
        cmocka_unit_test(beyond_the_samples_values_stay_between_theirs),
        cmocka_unit_test(a_hole_has_no_samples_and_does_not_disturb_those_around_it),
        cmocka_unit_test(tiny_and_narrow_faces_have_samples),
        cmocka_unit_test(of_samples_in_a_line_the_nearest_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
