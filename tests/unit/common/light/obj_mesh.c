/* obj_mesh.c - OBJ meshes: faces in all forms become triangles; damaged files are refused with file, line and
 * reason. */
#include "common/light/obj_mesh.h"

#include "tests/unit/scratch.h"

static void faces_become_triangles(void **state)
{
    struct obj_mesh mesh;
    struct err err = ERR_INIT;
    (void)state;
    const char *path =
        scratch_write("valid.obj", "# a square and a triangle\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no x\n"
                                   "f 1 2/5 3//6 4/1/1\nf -1 -2 -3\nf 1 1 2\n");
    assert_ok(obj_mesh_read(&mesh, path, &err), err);
    assert_int_equal(mesh.count, 3);
    assert_int_equal(mesh.dropped, 1); /* the triangle without area */
    assert_true(mesh.triangles[1][2].y == 1 && mesh.triangles[2][0].x == 0 && mesh.triangles[2][1].x == 1);
    obj_mesh_release(&mesh);
    assert_null(mesh.triangles);
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
        cmocka_unit_test(a_mesh_is_moved_by_a_matrix),
        cmocka_unit_test(damaged_meshes_are_refused),
    };
    return cmocka_run_group_tests_name("light obj_mesh", tests, scratch_make, scratch_remove);
}
