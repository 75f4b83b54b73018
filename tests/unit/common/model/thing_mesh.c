/* thing_mesh.c - the triangles of a thing, from distances that are known exactly: those of a ball. */
#include "common/model/thing_mesh.h"

#include "tests/unit/scratch.h"

enum { SIDE = 26, VOXELS = SIDE * SIDE * SIDE, BALL = 3 };

#define VOXEL  0.1
#define BAND   0.3 /* of distances, on both sides of the surface */
#define RADIUS 0.83

static const struct vec3 middle = {1.02, -0.51, 0.33};
static uint32_t id[VOXELS];
static float distance[VOXELS];

/* A ball, with a margin of its own around it. All voxels within it are known, as after all views have seen it. */
static struct thing_volume ball(void)
{
    const double half = 0.5 * SIDE * VOXEL;
    struct thing_volume v = {
        {vec3_sub(middle, vec3_make(half + 0.03, half, half)), VOXEL, {SIDE, SIDE, SIDE}}, id, distance};
    for (int64_t i = 0; i < VOXELS; i++) {
        const double d = vec3_length(vec3_sub(thing_voxel_centre(&v.grid, i), middle)) - RADIUS;
        id[i] = d < BAND ? BALL : 0;
        distance[i] = id[i] ? (float)fmax(-1, d / BAND) : THING_UNSEEN;
    }
    return v;
}

static struct thing_mesh mesh_of(const struct thing_volume *v, uint32_t thing)
{
    struct thing_mesh m;
    struct err err = ERR_INIT;
    assert_ok(thing_mesh_make(&m, v, thing, &err), err);
    for (int i = 0; i < m.triangle_count; i++)
        for (int k = 0; k < 3; k++) assert_in_range(m.triangles[i][k], 0, m.vertex_count - 1);
    return m;
}

static void assert_empty(const struct thing_volume *v, uint32_t thing)
{
    struct thing_mesh m = mesh_of(v, thing);
    assert_int_equal(m.triangle_count, 0);
    thing_mesh_release(&m);
}

/* How many triangles have an edge from vertex a to vertex b, in this direction. */
static int count_edges(const struct thing_mesh *m, int a, int b)
{
    int count = 0;
    for (int i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++) count += m->triangles[i][k] == a && m->triangles[i][(k + 1) % 3] == b;
    return count;
}

/* The number of edges that one triangle alone has. Others have two, which go along them in opposite directions. */
static int count_rims(const struct thing_mesh *m)
{
    int rims = 0;
    for (int i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            const int a = m->triangles[i][k], b = m->triangles[i][(k + 1) % 3];
            assert_int_not_equal(a, b);
            assert_int_equal(count_edges(m, a, b), 1);
            const int back = count_edges(m, b, a);
            assert_in_range(back, 0, 1);
            rims += !back;
        }
    return rims;
}

/* Of the closed surface; above 0 if its triangles are counter-clockwise from outside. */
static double volume_of(const struct thing_mesh *m)
{
    double sum = 0;
    for (int i = 0; i < m->triangle_count; i++) {
        struct vec3 p[3];
        for (int k = 0; k < 3; k++) p[k] = vec3_sub(m->vertices[m->triangles[i][k]], middle);
        sum += vec3_dot(p[0], vec3_cross(p[1], p[2])) / 6;
    }
    return sum;
}

static void assert_on_ball(const struct thing_mesh *m)
{
    for (int i = 0; i < m->vertex_count; i++)
        assert_float_equal(vec3_length(vec3_sub(m->vertices[i], middle)), RADIUS, 0.25 * VOXEL);
}

/* Each triangle faces away from the middle. */
static void assert_outwards(const struct thing_mesh *m)
{
    for (int i = 0; i < m->triangle_count; i++) {
        const struct vec3 *p = m->vertices;
        const int *t = m->triangles[i];
        const struct vec3 normal = vec3_cross(vec3_sub(p[t[1]], p[t[0]]), vec3_sub(p[t[2]], p[t[0]]));
        assert_true(vec3_dot(normal, vec3_sub(p[t[0]], middle)) > 0);
    }
}

static void a_ball_has_a_closed_mesh_near_it(void **state)
{
    (void)state;
    const struct thing_volume v = ball();
    struct thing_mesh m = mesh_of(&v, BALL);
    assert_true(m.triangle_count > 500);
    assert_int_equal(m.vertex_count - m.triangle_count / 2, 2); /* Euler's number of a sphere */
    assert_int_equal(count_rims(&m), 0);
    assert_on_ball(&m);
    thing_mesh_release(&m);
}

static void its_volume_is_right_and_its_outside_is_counter_clockwise(void **state)
{
    (void)state;
    const struct thing_volume v = ball();
    const double wanted = 4 * M_PI / 3 * pow(RADIUS, 3);
    struct thing_mesh m = mesh_of(&v, BALL);
    assert_float_equal(volume_of(&m), wanted, 0.03 * wanted);
    assert_outwards(&m);
    thing_mesh_release(&m);
}

/* Views from one side leave the other one unseen, in turn for each of the six sides. */
static void what_is_seen_from_one_side_alone_has_an_open_mesh(void **state)
{
    (void)state;
    for (int side = 0; side < 6; side++) {
        const struct thing_volume v = ball();
        const double sign = side % 2 ? 1 : -1;
        for (int64_t i = 0; i < VOXELS; i++) {
            const struct vec3 p = vec3_sub(thing_voxel_centre(&v.grid, i), middle);
            if (sign * (side < 2 ? p.x : side < 4 ? p.y : p.z) < 0) distance[i] = THING_UNSEEN;
        }
        struct thing_mesh m = mesh_of(&v, BALL);
        assert_true(m.triangle_count > 250);
        assert_true(count_rims(&m) > 20);
        assert_on_ball(&m);
        assert_outwards(&m);
        for (int i = 0; i < m.vertex_count; i++) {
            const struct vec3 p = vec3_sub(m.vertices[i], middle);
            assert_true(sign * (side < 2 ? p.x : side < 4 ? p.y : p.z) > 0);
        }
        thing_mesh_release(&m);
    }
}

/* Between the ball and a thing that touches it there is no surface of either. */
static void another_thing_ends_the_mesh(void **state)
{
    (void)state;
    const struct thing_volume v = ball();
    for (int64_t i = 0; i < VOXELS; i++)
        if (id[i] && thing_voxel_centre(&v.grid, i).x > middle.x) id[i] = BALL + 1;
    struct thing_mesh west = mesh_of(&v, BALL), east = mesh_of(&v, BALL + 1);
    assert_true(west.triangle_count > 250 && east.triangle_count > 250);
    for (int i = 0; i < west.vertex_count; i++) assert_true(west.vertices[i].x < middle.x);
    for (int i = 0; i < east.vertex_count; i++) assert_true(east.vertices[i].x > middle.x);
    assert_outwards(&west);
    assert_outwards(&east);
    thing_mesh_release(&west);
    thing_mesh_release(&east);
}

static void a_thing_that_no_view_has_seen_has_no_triangle(void **state)
{
    (void)state;
    const struct thing_volume v = ball();
    assert_empty(&v, BALL + 1); /* another one */
    for (int64_t i = 0; i < VOXELS; i++) distance[i] = THING_UNSEEN;
    assert_empty(&v, BALL);
    for (int64_t i = 0; i < VOXELS; i++) distance[i] = -1; /* solid everywhere: it has no side */
    assert_empty(&v, BALL);
}

static void a_thing_that_is_one_voxel_wide_or_has_none_is_empty(void **state)
{
    (void)state;
    const struct thing_volume v = ball();
    struct thing_mesh m;
    memset(id, 0, sizeof id);
    assert_empty(&v, BALL);
    for (int i = 0; i < SIDE; i++) id[i] = BALL, distance[i] = i % 2 ? 0.5f : -0.5f; /* a row at the grid's border */
    assert_empty(&v, BALL);
    id[VOXELS - 1] = BALL; /* and its last voxel */
    assert_empty(&v, BALL);
    m = mesh_of(&v, BALL);
    thing_mesh_release(&m);
    thing_mesh_release(&m);
    assert_true(!m.vertices && !m.triangles && !m.vertex_count && !m.triangle_count);
}

static void a_thing_may_fill_the_grid(void **state)
{
    (void)state;
    const struct thing_volume v = ball();
    for (int64_t i = 0; i < VOXELS; i++) {
        const double d = vec3_length(vec3_sub(thing_voxel_centre(&v.grid, i), middle)) - RADIUS;
        id[i] = BALL;
        distance[i] = (float)fmin(1, fmax(-1, d / BAND));
    }
    struct thing_mesh m = mesh_of(&v, BALL);
    assert_int_equal(count_rims(&m), 0);
    assert_on_ball(&m);
    thing_mesh_release(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_has_a_closed_mesh_near_it),
        cmocka_unit_test(its_volume_is_right_and_its_outside_is_counter_clockwise),
        cmocka_unit_test(what_is_seen_from_one_side_alone_has_an_open_mesh),
        cmocka_unit_test(another_thing_ends_the_mesh),
        cmocka_unit_test(a_thing_that_no_view_has_seen_has_no_triangle),
        cmocka_unit_test(a_thing_that_is_one_voxel_wide_or_has_none_is_empty),
        cmocka_unit_test(a_thing_may_fill_the_grid),
    };
    return cmocka_run_group_tests_name("thing_mesh", tests, NULL, NULL);
}
