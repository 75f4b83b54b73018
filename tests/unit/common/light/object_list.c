/* object_list.c - objects.txt: what is written is read back; what is wrong is named; meshes are placed. */
#include "common/light/object_list.h"

#include "tests/unit/scratch.h"

#define HEAD "remodel-objects 1\n"
#define HASH " 0123456789abcdef0123456789abcdef"
#define SAME " 1 0 0 0 0 1 0 0 0 0 1 0"

static void what_is_written_is_read_back(void **state)
{
    static const char text[] = HEAD
        "object chair meshes/chair-2.obj" HASH " 0.10000000000000001 0 0 2 0 0.5 0 3 0 0 1 -1 matt 0.5 0.25 0\n"
        "object \"a b\" b.obj" HASH SAME " phong 0.10000000000000001 0.20000000000000001 0 0.050000000000000003 30\n"
        "object c b.obj" HASH SAME " ward 0 0 0 0.10000000000000001 0.20000000000000001\n";
    struct object_list list;
    struct err err = ERR_INIT;
    char *again = NULL;
    size_t size = 0;
    (void)state;
    assert_ok(object_list_read(&list, scratch_write("a.txt", text), NULL, &err), err);
    assert_int_equal(list.count, 3);
    assert_string_equal(list.items[0].file, "meshes/chair-2.obj");
    assert_true(list.items[0].matrix[1][3] == 3 && list.items[0].brdf.kind == BRDF_LAMBERT);
    assert_true(list.items[1].brdf.kind == BRDF_PHONG && list.items[1].brdf.shape == 30);
    assert_true(list.items[1].brdf.gloss == brdf_gloss_albedo(BRDF_PHONG, 0.05, 30));
    assert_true(list.items[2].brdf.kind == BRDF_WARD && list.items[2].brdf.ks == 0.1);
    assert_ok(object_list_write(&list, scratch_path("b.txt"), NULL, &err), err);
    object_list_release(&list);
    FILE *file = fopen(scratch_path("b.txt"), "r");
    assert_non_null(file);
    assert_true(getdelim(&again, &size, '\0', file) > 0);
    fclose(file);
    assert_string_equal(again, text);
    free(again);
}

static void an_empty_list_is_read_back(void **state)
{
    struct object_list list = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(object_list_write(&list, scratch_path("empty.txt"), NULL, &err), err);
    assert_ok(object_list_read(&list, scratch_path("empty.txt"), NULL, &err), err);
    assert_int_equal(list.count, 0);
    object_list_release(&list);
}

static void what_is_wrong_is_named_with_its_line(void **state)
{
    static const char *const cases[][2] = {
        {"remodel-objects 2\n", "a.txt:1"},
        {HEAD "objekt\n", "a.txt:2: found \"objekt\""},
        {HEAD "object a a.obj 0123" SAME " matt 0 0 0\n", "a hash of 32 hexadecimal digits"},
        {HEAD "object a /a.obj" HASH SAME " matt 0 0 0\n", "the path of a mesh in the scene's folder"},
        {HEAD "object a ../a.obj" HASH SAME " matt 0 0 0\n", "the path of a mesh"},
        {HEAD "object a b//a.obj" HASH SAME " matt 0 0 0\n", "the path of a mesh"},
        {HEAD "object a b/.obj" HASH SAME " matt 0 0 0\n", "the path of a mesh"},
        {HEAD "object a a.ply" HASH SAME " matt 0 0 0\n", "the path of a mesh"},
        {HEAD "object a a$b.obj" HASH SAME " matt 0 0 0\n", "the path of a mesh"},
        {HEAD "object a a.obj" HASH " 1 0 0 0 0 1 0 0 0 0 -1 0 matt 0 0 0\n", "a matrix of determinant above 0"},
        {HEAD "object a a.obj" HASH " 1 0 0 0 0 1 0 0 0 0 0 0 matt 0 0 0\n", "found \"0\", wanted a matrix"},
        {HEAD "object a a.obj" HASH " 1 0 0 0 0 1 0 0 0 0 nan 0 matt 0 0 0\n", "found \"nan\""},
        {HEAD "object a a.obj" HASH SAME " matt 0 0 1.5\n", "a share of blue light, a number from 0 to 1"},
        {HEAD "object a a.obj" HASH SAME " lambert 0 0 1\n", "found \"lambert\", wanted matt, phong or ward"},
        {HEAD "object a a.obj" HASH SAME " phong 0 0 0.5 0.5 5\n", "no more than 1 together"},
        {HEAD "object a a.obj" HASH SAME " matt 0 0 1 0\n", "wanted the end of the line"},
        {HEAD "object a a.obj" HASH SAME " matt 0 0 0\nobject a a.obj" HASH SAME " matt 0 0 0\n",
         "a.txt:3: found \"a\", wanted a name that no line above has"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct object_list list;
        struct err err = ERR_INIT;
        assert_int_not_equal(object_list_read(&list, scratch_write("a.txt", cases[i][0]), NULL, &err), ST_OK);
        assert_err(err, ST_DATA, cases[i][1]);
        assert_err(err, ST_DATA, "a.txt:");
        assert_true(!list.items && !list.count);
    }
}

static void a_mesh_is_placed_unless_it_has_changed(void **state)
{
    char name[] = "t", file[] = "t.obj";
    struct object o = {.name = name, .file = file, .matrix = {{2, 0, 0, 1}, {0, 2, 0, 1}, {0, 0, 2, 1}}};
    struct obj_mesh mesh;
    struct err err = ERR_INIT;
    (void)state;
    const char *path = scratch_write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_ok(hash_file(o.hash, path, &err), err);
    assert_ok(object_mesh_read(&mesh, &o, scratch, &err), err);
    assert_true(mesh.count == 1 && mesh.triangles[0][1].x == 3 && mesh.triangles[0][1].z == 1);
    obj_mesh_release(&mesh);
    scratch_write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
    assert_int_equal(object_mesh_read(&mesh, &o, scratch, &err), ST_DATA);
    assert_err(err, ST_DATA, "t.obj has changed since the object t was placed; make the model again");
    assert_null(mesh.triangles);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read_back),
        cmocka_unit_test(an_empty_list_is_read_back),
        cmocka_unit_test(what_is_wrong_is_named_with_its_line),
        cmocka_unit_test(a_mesh_is_placed_unless_it_has_changed),
    };
    return cmocka_run_group_tests_name("light object_list", tests, scratch_make, scratch_remove);
}
