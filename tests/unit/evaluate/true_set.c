/* true_set.c - folders of true pictures in both layouts, and lists of true faces. */
#include "stages/evaluate/truth/true_set.h"

#include "stages/evaluate/truth/true_faces.h"
#include "tests/unit/scratch.h"

#define CAMERAS         "1 PINHOLE 40 30 20 20 20 15\n"
#define IMAGE(id, name) #id " 1 0 0 0 0 0 " #id " 1 " name "\n\n"

static void folder(const char *name) { assert_int_equal(mkdir(scratch_path(name), 0777), 0); }

static int make_truth(void **state)
{
    if (scratch_make(state)) return -1;
    static const char *const folders[] = {"t",          "t/novel",      "t/hdr",         "t/edited-b",
                                          "t/edited-a", "t/edited-a b", "t/shell",       "t/shell/ids",
                                          "u",          "u/novel",      "t/edited-a/hdr"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) folder(folders[i]);
    scratch_write("t/cameras.txt", CAMERAS);
    scratch_write("t/images.txt", IMAGE(1, "b.jpg") IMAGE(2, "a.jpg"));
    scratch_write("t/novel/cameras.txt", CAMERAS);
    scratch_write("t/novel/images.txt", IMAGE(3, "w"));
    scratch_write("t/hdr/a.exr", "x");
    scratch_write("t/a.exr", "x");
    scratch_write("t/shell/ids/w.exr", "x");
    scratch_write("u/novel-cameras.txt", CAMERAS);
    scratch_write("u/novel-images.txt", IMAGE(1, "n0"));
    scratch_write("u/novel/n0.exr", "x");
    scratch_write("u/novel/n0-depth.exr", "x");
    return 0;
}

static void both_layouts_are_read(void **state)
{
    (void)state;
    struct true_set set;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    char path[FILE_PATH];
    assert_ok(true_set_read(&set, scratch_path("t"), "", &prov, &err), err);
    assert_true(set.count == 2 && set.own_cameras);
    assert_string_equal(set.pictures[0].name, "a");
    assert_true(set.pictures[0].pose.translation.z == 2);
    assert_true(true_set_file(path, &set, "hdr", "a") && !true_set_file(path, &set, "hdr", "b"));
    true_set_release(&set);

    assert_ok(true_set_read(&set, scratch_path("u"), "novel", &prov, &err), err);
    assert_true(set.count == 1 && set.own_cameras);
    assert_true(true_set_file(path, &set, "hdr", "n0") && strstr(path, "/novel/n0.exr"));
    assert_true(true_set_file(path, &set, "depth", "n0") && strstr(path, "/n0-depth.exr"));
    assert_false(true_set_file(path, &set, "ids", "n0"));
    assert_non_null(true_set_find(&set, "n0"));
    assert_null(true_set_find(&set, "n1"));
    true_set_release(&set);

    assert_ok(true_set_read(&set, scratch_path("u"), "shell", &prov, &err), err);
    assert_int_equal(set.count, 0);
    provenance_release(&prov);
}

static void a_folder_without_cameras_has_those_of_the_photos_and_of_new_views(void **state)
{
    (void)state;
    struct true_set set;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    char path[FILE_PATH];
    assert_ok(true_set_read(&set, scratch_path("t"), "shell", &prov, &err), err);
    assert_true(set.count == 3 && !set.own_cameras);
    assert_string_equal(set.pictures[2].name, "w");
    assert_string_equal(set.prefix, "shell");
    assert_true(true_set_file(path, &set, "ids", "w"));
    true_set_release(&set);
    assert_ok(true_set_read(&set, scratch_path("t"), "edited-a", &prov, &err), err);
    assert_string_equal(set.prefix, "edited.a");
    assert_string_equal(set.where, "edited-a");
    true_set_release(&set);
    provenance_release(&prov);
}

static void edits_are_listed_by_name(void **state)
{
    (void)state;
    struct true_edits list;
    struct err err = ERR_INIT;
    assert_ok(true_edits_find(&list, scratch_path("t"), &err), err);
    assert_int_equal(list.count, 2);
    assert_int_equal(list.others, 1);
    assert_string_equal(list.names[0], "a");
    assert_string_equal(list.names[1], "b");
    true_edits_release(&list);
    assert_int_not_equal(true_edits_find(&list, scratch_path("nowhere"), &err), ST_OK);
}

static void faces_have_ids_of_their_own(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"remodel-faces 2\n", ":1: found \"2\""},
        {"remodel-faces 1\n2 a 1 0 0 1\n2 b 1 0 0 1\n", ":3: found \"2\", wanted an id that is on no line above"},
        {"remodel-faces 1\n0 a 1 0 0 1\n", ":2: found \"0\""},
        {"remodel-faces 1\n1 a 1 0 0\n", ":2: "},
        {"remodel-faces 1\n1 a 1 0 0 1 5\n", ":2: found \"5\""},
    };
    struct true_faces faces;
    struct err err = ERR_INIT;
    const char *path = scratch_write("faces.txt", "remodel-faces 1\n# c\n4 chair 0.5 0 0 0\n1 hall.floor 12 0 0 1\n");
    assert_ok(true_faces_read(&faces, path, &err), err);
    assert_int_equal(faces.count, 4);
    assert_string_equal(faces.faces[0].name, "hall.floor");
    assert_null(faces.faces[1].name);
    assert_true(faces.faces[0].normal.z == 1 && faces.faces[3].normal.z == 0);
    true_faces_release(&faces);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct err why = ERR_INIT;
        assert_int_equal(true_faces_read(&faces, scratch_write("faces.txt", cases[i][0]), &why), ST_DATA);
        assert_err(why, ST_DATA, cases[i][1]);
        assert_int_equal(faces.count, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_layouts_are_read),
        cmocka_unit_test(a_folder_without_cameras_has_those_of_the_photos_and_of_new_views),
        cmocka_unit_test(edits_are_listed_by_name),
        cmocka_unit_test(faces_have_ids_of_their_own),
    };
    return cmocka_run_group_tests_name("true_set", tests, make_truth, scratch_remove);
}
