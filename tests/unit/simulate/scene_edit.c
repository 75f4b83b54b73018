/* Edits as differences: what they drop and add, the ids and looks that faces keep, and error messages. */
#include "tests/unit/simulate/worlds.h"

#define BASE                                                                                                       \
    "remodel-scene 1\ntexture t plaster 0.2 0.3 1 0.6 0.5 0.4\nmaterial m lambert t\nroom r 0 0 4 3 0 2 m m\n"     \
    "wall w 0 0 4 0 0 2 0.2 m\nopening door w 1 2 0 1.5\nwindow win w 2.5 3.5 0.5 1.5\nwall v 4 0 4 3 0 2 0.2 m\n" \
    "opening gap v 1 2 0 1.5\nbox b 1 1 0 2 1.5 0.9 m\nlamp l quad 3 2 1.9 0 1 0 1 0 0 1 1 1\n"                    \
    "sun -80 40 2 500 450 400\npanorama 1 2 2 2 1 1 1\n"
#define EDIT "remodel-scene 2\nbase scene.txt\n"

static struct world edited_world(const char *text)
{
    struct world w = {0};
    struct err err = ERR_INIT;
    scratch_write("scene.txt", BASE);
    scratch_write("scene-e.txt", text);
    assert_ok(path_world_read(&w, scratch, "scene-e.txt", NULL, &err), err);
    return w;
}

static const struct scene_face *face(const struct world *w, const char *name)
{
    for (int i = 0; i < w->geometry.face_count; i++)
        if (!strcmp(w->geometry.faces[i].name, name)) return &w->geometry.faces[i];
    return NULL;
}

/* Every face of `w` that the base has is there with the base's id and texture; the others have new ids, each its
 * own. */
static void assert_ids_kept(const struct world *base, const struct world *w)
{
    for (int i = 0; i < w->geometry.face_count; i++) {
        const struct scene_face *f = &w->geometry.faces[i], *before = face(base, f->name);
        if (before)
            assert_true(before->id == f->id && before->seed == f->seed);
        else
            assert_true(f->id > (uint32_t)base->geometry.face_count);
        for (int k = 0; k < i; k++) assert_int_not_equal(w->geometry.faces[k].id, f->id);
    }
}

static void an_edit_without_changes_is_its_base(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    struct world w = edited_world(EDIT), base = {0};
    assert_ok(path_world_read(&base, scratch, "scene.txt", NULL, &err), err);
    assert_int_equal(w.geometry.face_count, base.geometry.face_count);
    for (int i = 0; i < w.geometry.face_count; i++) {
        assert_string_equal(w.geometry.faces[i].name, base.geometry.faces[i].name);
        assert_int_equal(w.geometry.faces[i].id, i + 1);
    }
    const struct rgb a = mean_radiance(&base, vec3_make(2, 2, 1), vec3_make(1, -2, 0), 4096, 3),
                     b = mean_radiance(&w, vec3_make(2, 2, 1), vec3_make(1, -2, 0), 4096, 3);
    assert_true(a.r > 0 && a.r == b.r && a.g == b.g && a.b == b.b);
    path_world_release(&w);
    path_world_release(&base);
}

static void dropped_items_are_gone_and_the_others_keep_their_ids(void **state)
{
    struct err err = ERR_INIT;
    struct world base = {0};
    (void)state;
    struct world w = edited_world(EDIT "drop b door sun panorama\nopening door w 0.5 2.2 0 1.8\n"
                                       "box c 3 2 0 3.5 2.5 0.5 m\n");
    assert_ok(path_world_read(&base, scratch, "scene.txt", NULL, &err), err);
    assert_ids_kept(&base, &w);
    assert_null(face(&w, "b.top"));
    assert_non_null(face(&w, "c.top"));
    assert_near(face(&w, "w.left")->area, 8 - 1.7 * 1.8 - 1, 1e-9);
    assert_int_equal(face(&w, "door.head")->id, face(&base, "door.head")->id);
    assert_false(w.scene.sky.has_sun || w.scene.sky.has_panorama);
    path_world_release(&w);

    /* a wall takes its openings with it; the openings of the wall behind it stay in theirs */
    w = edited_world(EDIT "drop w\n");
    assert_ids_kept(&base, &w);
    assert_true(!face(&w, "w.left") && !face(&w, "door.head") && !face(&w, "win.sill"));
    assert_near(face(&w, "v.left")->area, 6 - 1.5, 1e-9);
    path_world_release(&w);
    path_world_release(&base);
}

static void an_edit_is_written_as_a_whole_scene(void **state)
{
    struct err err = ERR_INIT;
    struct world whole = {0};
    (void)state;
    struct world w = edited_world(EDIT "drop w sun\nfurniture on\nbox c 3 2 0 3.5 2.5 0.5 m\n");
    assert_ok(scene_write(&w.scene, scratch, "scene-e.txt", scratch_path("whole.txt"), &err), err);
    assert_ok(path_world_read(&whole, scratch, "whole.txt", NULL, &err), err);
    assert_null(whole.scene.base);
    assert_int_equal(whole.geometry.face_count, w.geometry.face_count);
    for (int i = 0; i < w.geometry.face_count; i++) {
        assert_string_equal(whole.geometry.faces[i].name, w.geometry.faces[i].name);
        assert_near(whole.geometry.faces[i].area, w.geometry.faces[i].area, 1e-12);
    }
    assert_false(whole.scene.sky.has_sun);
    assert_true(whole.scene.sky.has_panorama && whole.geometry.has_furniture);
    path_world_release(&whole);
    path_world_release(&w);
}

static void byte_order_marks_do_not_reach_the_whole_scene(void **state)
{
    struct world w = {0};
    struct err err = ERR_INIT;
    char text[4096] = "";
    (void)state;
    scratch_write("scene.txt", "\xEF\xBB\xBF" BASE);
    scratch_write("scene-e.txt", "\xEF\xBB\xBF" EDIT "drop b\n");
    assert_ok(path_world_read(&w, scratch, "scene-e.txt", NULL, &err), err);
    assert_ok(scene_write(&w.scene, scratch, "scene-e.txt", scratch_path("whole.txt"), &err), err);
    FILE *f = fopen(scratch_path("whole.txt"), "r");
    assert_non_null(f);
    assert_true(fread(text, 1, sizeof text - 1, f) > 0);
    fclose(f);
    assert_null(strchr(text, '\xEF'));
    assert_null(strstr(text + 20, "remodel-scene"));
    assert_null(strstr(text, "box b"));
    path_world_release(&w);
}

static void assert_invalid(const char *text, const char *words)
{
    struct scene s;
    struct err err = ERR_INIT;
    scratch_write("scene.txt", BASE);
    scratch_write("scene-e.txt", text);
    if (!scene_read(&s, scratch, "scene-e.txt", NULL, &err)) fail_msg("no error, expected: %s", words);
    assert_err(err, ST_DATA, words);
    assert_true(!s.items && !s.base && !s.dropped);
}

static void errors_of_edits_name_line_and_word(void **state)
{
    (void)state;
    assert_invalid("remodel-scene 1\nbase scene.txt\n", ":2: found \"base\", wanted the header `remodel-scene 2`");
    assert_invalid("remodel-scene 2\ndrop b\n", ":2: found \"drop\", wanted a line `base FILE`");
    assert_invalid("remodel-scene 2\ntexture u rgb 1 1 1\nbase scene.txt\n",
                   ":3: found \"base\", wanted it on the first");
    assert_invalid("remodel-scene 2\nbase ../scene.txt\n", "without a folder");
    assert_invalid("remodel-scene 2\nbase scene-e.txt\n", ":2: found \"base\", wanted a complete description");
    struct scene s;
    struct err err = ERR_INIT;
    scratch_write("scene-e.txt", "remodel-scene 2\nbase none.txt\n");
    assert_true(scene_read(&s, scratch, "scene-e.txt", NULL, &err));
    assert_contains(err.text, "scene-e.txt:2: cannot open");
    assert_invalid(EDIT "drop\n", ":3: found the end of the line, wanted the name of an item");
    assert_invalid(EDIT "drop bb\n", ":3: found \"bb\", wanted the name of an item of the base");
    assert_invalid(EDIT "drop b b\n", ":3: found \"b\", wanted the name of an item of the base");
    assert_invalid(EDIT "drop w door\n", ":3: found \"door\", wanted");
    assert_invalid(EDIT "drop sun sun\n", ":3: found \"sun\", wanted");
    assert_invalid(EDIT "box c 0 0 0 1 1 1 m\ndrop c\n", ":4: found \"c\", wanted");
    assert_invalid(EDIT "box b 0 0 0 1 1 1 m\n", ":3: found \"b\", wanted a name that no other");
    assert_invalid(EDIT "drop l sun panorama\n", "has no light");
    assert_invalid(EDIT "drop sky\n", "found \"sky\"");
    assert_invalid(EDIT "sky 16 1 1 1 0 0 0\n", "found \"a sky beside a panorama\"");
    assert_invalid(EDIT "drop panorama\nsky 17 1 1 1 0 0 0\n", "17");
    assert_invalid(EDIT "drop panorama\nsky 1.5 1 1 1 0 0 0\n", "a whole number");
    assert_invalid(EDIT "drop panorama\nsky grey 1 1 1 0 0 0\n", "grey");
    assert_invalid(EDIT "drop panorama\nsky perez 1 1 1 0 0 0\n", "radiance");
    assert_invalid(EDIT "furniture maybe\n", ":3: found \"maybe\", wanted the state of furniture: one of off, on");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edit_without_changes_is_its_base),
        cmocka_unit_test(dropped_items_are_gone_and_the_others_keep_their_ids),
        cmocka_unit_test(an_edit_is_written_as_a_whole_scene),
        cmocka_unit_test(byte_order_marks_do_not_reach_the_whole_scene),
        cmocka_unit_test(errors_of_edits_name_line_and_word),
    };
    return cmocka_run_group_tests_name("simulate edits", tests, scratch_make, scratch_remove);
}
