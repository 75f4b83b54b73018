/* obj_mesh.c - OBJ meshes: faces in all forms become triangles; damaged files are refused with file, line and
 * reason. */
#include "common/light/obj_mesh.h"

#include "common/math/numbers.h"
#include "tests/unit/scratch.h"

static void faces_become_triangles(void **state)
{
    struct obj_mesh mesh;
    struct err err = ERR_INIT;
    (void)state;
    const char *path =
        scratch_write("valid.obj", "# a square and a triangle\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no x\n"
                                   "f 1 2/5 3//1 4/1/1\nf -1 -2 -3\nf 1 1 2\n");
    assert_ok(obj_mesh_read(&mesh, path, &err), err);
    assert_int_equal(mesh.count, 3);
    assert_int_equal(mesh.dropped, 1); /* the triangle without area */
    assert_true(mesh.triangles[1][2].y == 1 && mesh.triangles[2][0].x == 0 && mesh.triangles[2][1].x == 1);
    obj_mesh_release(&mesh);
    assert_null(mesh.triangles);
}

static double area_of(const struct obj_mesh *mesh)
{
    double sum = 0;
    for (int i = 0; i < mesh->count; i++) {
        const struct vec3 *t = mesh->triangles[i];
        sum += 0.5 * vec3_length(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
    }
    return sum;
}

static void a_concave_polygon_keeps_its_notch(void **state)
{
    static const char *const vertices = "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n";
    char text[256];
    (void)state;
    for (int first = 0; first < 6; first++) { /* from whichever corner it begins, and seen from either side */
        struct obj_mesh mesh;
        struct err err = ERR_INIT;
        const int step = first % 2 ? 1 : 5;
        int n = snprintf(text, sizeof text, "%sf", vertices);
        for (int k = 0; k < 6; k++) n += snprintf(text + n, sizeof text - (size_t)n, " %d", (first + k * step) % 6 + 1);
        snprintf(text + n, sizeof text - (size_t)n, "\n");
        assert_ok(obj_mesh_read(&mesh, scratch_write("l.obj", text), &err), err);
        assert_int_equal(mesh.count, 4);
        assert_true(fabs(area_of(&mesh) - 3) < 1e-12);
        for (int i = 0; i < mesh.count; i++) assert_true(mesh.normals[i][0].z == (step == 1 ? 1 : -1));
        obj_mesh_release(&mesh);
    }
}

static void a_polygon_that_crosses_itself_is_read(void **state)
{
    struct obj_mesh mesh;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(obj_mesh_read(&mesh, scratch_write("x.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 2 0\nf 1 2 3 4\n"), &err),
              err);
    assert_int_equal(mesh.count, 2);
    obj_mesh_release(&mesh);
}

static void normals_come_from_the_file(void **state)
{
    struct obj_mesh mesh;
    struct err err = ERR_INIT;
    (void)state;
    const char *text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nvn 3 0 4\nf 1//1 2//-1 3\n";
    assert_ok(obj_mesh_read(&mesh, scratch_write("n.obj", text), &err), err);
    const struct vec3 *n = mesh.normals[0];
    assert_true(n[0].z == 1 && fabs(n[1].x - 0.6) < 1e-15 && fabs(n[1].z - 0.8) < 1e-15 && n[2].z == 1);
    const double m[3][4] = {{2, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}; /* the surface of normal 3 0 4 gets 1.5 0 4 */
    obj_mesh_move(&mesh, m);
    assert_true(fabs(mesh.normals[0][1].x / mesh.normals[0][1].z - 1.5 / 4) < 1e-12);
    obj_mesh_release(&mesh);
}

static void tiny_numbers_give_unit_normals(void **state)
{
    static const char *const texts[] = {
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1e-160 2e-160 0\nvn 0 1e-320 0\nvn 0 0 0\nf 1//1 2//2 3//3\n",
        "v 0 0 0\nv 3e-81 0 0\nv 0 4e-81 1e-81\nv 1 0 0\nf 1 2 3\nf 1 4 3\n"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct obj_mesh mesh;
        struct err err = ERR_INIT;
        assert_ok(obj_mesh_read(&mesh, scratch_write("tiny.obj", texts[i]), &err), err);
        for (int k = 0; k < 3 * mesh.count; k++) assert_true(fabs(vec3_length(mesh.normals[k / 3][k % 3]) - 1) < 1e-12);
        obj_mesh_release(&mesh);
    }
}

/* Two squares that meet in the y axis: the second leans by an angle. */
static struct vec3 normal_at_an_edge(double degrees)
{
    struct obj_mesh mesh;
    struct err err = ERR_INIT;
    char text[256];
    const double c = cos(degrees * DEGREE), s = sin(degrees * DEGREE);
    snprintf(text, sizeof text,
             "v -1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv %.17g 0 %.17g\nv %.17g 1 %.17g\nf 1 2 3 4\nf 2 5 6 3\n", c, -s, c,
             -s);
    assert_ok(obj_mesh_read(&mesh, scratch_write("e.obj", text), &err), err);
    const struct vec3 n = mesh.normals[0][1]; /* of vertex 2 */
    obj_mesh_release(&mesh);
    return n;
}

static void a_bend_is_round_and_an_edge_is_sharp(void **state)
{
    (void)state;
    const struct vec3 bend = normal_at_an_edge(30), edge = normal_at_an_edge(60);
    assert_true(bend.x > 0.1 && bend.z > 0.9);
    assert_true(edge.x == 0 && edge.z == 1);
}

static void a_mesh_is_moved_by_a_matrix(void **state)
{
    struct obj_mesh mesh;
    struct err err = ERR_INIT;
    const double m[3][4] = {{0, -2, 0, 5}, {2, 0, 0, 6}, {0, 0, 3, 7}};
    (void)state;
    assert_ok(obj_mesh_read(&mesh, scratch_write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n"), &err), err);
    obj_mesh_move(&mesh, m);
    const struct vec3 *t = mesh.triangles[0];
    assert_true(t[0].x == 5 && t[0].y == 6 && t[0].z == 7);
    assert_true(t[1].x == 5 && t[1].y == 8 && t[1].z == 7);
    assert_true(t[2].x == 3 && t[2].y == 6 && t[2].z == 10);
    obj_mesh_release(&mesh);
}

static void damaged_meshes_are_refused(void **state)
{
    static const char *const bad[][2] = {
        {"v 0 0\n", ":1: found the end of the line, wanted a vertex's coordinate"},
        {"v 0 0 0\nf 1 2 1\n",
         ":2: found \"2\", wanted a vertex from 1 to 1, or from -1 backwards, of the lines v above"},
        {"v 0 0 0\nf 0 1 1\n", ":2: found \"0\""},
        {"v 0 0 0\nf 1 -2 1\n", ":2: found \"-2\""},
        {"v 0 0 0\nf 1 9223372036854775807 1\n", ":2: found \"9223372036854775807\""},
        {"v 0 0 0\nf 1 -9223372036854775808 1\n", ":2: found \"-9223372036854775808\""},
        {"v 0 0 0\nf 1 /2 1\n", ":2: found \"\""},
        {"v 0 0 0\nf 1 1\n", ":2: found the end of the line, wanted a face's vertex, three or more"},
        {"f 1 2 3\nv 0 0 0\n", ":1: found \"1\", wanted lines v with the vertices before the faces"},
        {"v 0 0 nan\n", ":1: found \"nan\""},
        {"v 0 0 1e9\n", ":1: found \"a larger number\", wanted a vertex's coordinate, at most 100000"},
        {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\n",
         ":4: found \"1\", wanted a normal from 1 to 0, or from -1 backwards, of the lines vn above"},
        {"vn 0 x 0\n", ":1: found \"x\", wanted a normal's coordinate"},
        {"v 0 0 0\n", "has no faces with an area (lines that begin with f); export it"},
        {"v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n", "has no faces with an area"},
        {"", "has no faces"},
    };
    struct obj_mesh mesh;
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err err = ERR_INIT;
        const char *path = scratch_write("bad.obj", bad[i][0]);
        assert_true(obj_mesh_read(&mesh, path, &err));
        assert_err(err, ST_DATA, bad[i][1]);
        assert_err(err, ST_DATA, path);
        assert_null(mesh.triangles);
    }
    struct err err = ERR_INIT;
    assert_true(obj_mesh_read(&mesh, scratch_path("missing.obj"), &err));
    assert_err(err, ST_IO, "missing.obj");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_become_triangles),
        cmocka_unit_test(a_concave_polygon_keeps_its_notch),
        cmocka_unit_test(a_polygon_that_crosses_itself_is_read),
        cmocka_unit_test(normals_come_from_the_file),
        cmocka_unit_test(tiny_numbers_give_unit_normals),
        cmocka_unit_test(a_bend_is_round_and_an_edge_is_sharp),
        cmocka_unit_test(a_mesh_is_moved_by_a_matrix),
        cmocka_unit_test(damaged_meshes_are_refused),
    };
    return cmocka_run_group_tests_name("light obj_mesh", tests, scratch_make, scratch_remove);
}
