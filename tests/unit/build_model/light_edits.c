/* light_edits.c - what edits say of light: paint, gloss, lamps and synthetic objects; also through edits that stand on
 * others. */
#include <math.h>

#include "stages/build_model/building/objects.h"
#include "stages/build_model/plan/edit_chain.h"
#include "tests/unit/build_model/textured.h"

#define EDIT "remodel-script 1\n"

static const struct texture_rule *rule_at(const struct made *m, const char *name, struct vec3 p)
{
    const struct texture_face *f = face_of(m, name, p);
    int i = 0;
    while (!texture_rule_holds(&f->rules[i], f->normal, p)) i++;
    return &f->rules[i];
}

static bool is_red(const struct made *m, const char *name, double x, double y, double z)
{
    const struct texture_rule *r = rule_at(m, name, vec3_make(x, y, z));
    return r->kind == TEXTURE_COLOUR && r->albedo[0] == 1 && r->albedo[1] == 0;
}

/* ------------------------------------------------------------------------------------------------------------ paint */

static void paint_covers_a_face_as_a_colour_does(void **state)
{
    struct made a, b;
    (void)state;
    make(&a, ROOM, "box b from 1 1 to 2 2 top 1\npaint wall/west/in 0.5 0.25 0\npaint box/b 1 0 0\n");
    make(&b, ROOM, "box b from 1 1 to 2 2 top 1\ncolour wall/west/in 0.5 0.25 0\ncolour box/b 1 0 0\n");
    struct err err = ERR_INIT;
    char *text[2] = {NULL, NULL};
    const struct texture_map *maps[2] = {&a.map, &b.map};
    for (int i = 0; i < 2; i++) {
        size_t size = 0;
        assert_ok(texture_map_write(maps[i], scratch_path("map.txt"), NULL, &err), err);
        FILE *file = fopen(scratch_path("map.txt"), "r");
        assert_non_null(file);
        assert_true(getdelim(&text[i], &size, '\0', file) > 0);
        fclose(file);
    }
    assert_string_equal(text[0], text[1]);
    for (int i = 0; i < 2; i++) free(text[i]);
    release(&a);
    release(&b);
}

static void a_painted_place_is_a_rectangle_of_the_face(void **state)
{
    struct made m;
    (void)state;
    /* the south wall's left end, seen from inside, is at x 4 */
    make(&m, ROOM,
         "paint wall/south/in from 1 0.5 to 2 1.5 1 0 0\npaint wall/north/out at left 1 width 0.5 from 0 to 2 1 0 0\n"
         "paint floor/hall from 1 1 to 3 2 1 0 0\npaint ceiling/hall from 1 1 to 3 2 1 0 0\n");
    assert_true(is_red(&m, "wall/south/in", 1.5, 0, 1) && is_red(&m, "wall/south/in", 1.01, 0, 1.49));
    assert_false(is_red(&m, "wall/south/in", 0.99, 0, 1) || is_red(&m, "wall/south/in", 1.5, 0, 1.51));
    const struct texture_rule *r = rule_at(&m, "wall/south/in", vec3_make(1.5, 0, 1));
    assert_true(r->limited && r->lit_count == 1);
    for (int i = 0; i < 4; i++) assert_true(r->within[i].y == 0);
    assert_int_equal(rule_at(&m, "wall/south/in", vec3_make(0.5, 0, 1))->kind, TEXTURE_PLACE);
    assert_true(is_red(&m, "wall/north/out", 1.2, 3.2, 1));
    assert_false(is_red(&m, "wall/north/out", 1.6, 3.2, 1) || is_red(&m, "wall/north/out", 0.9, 3.2, 1));
    assert_true(is_red(&m, "floor/hall", 2.9, 1.9, 0) && is_red(&m, "ceiling/hall", 1.1, 1.1, 2.5));
    assert_false(is_red(&m, "floor/hall", 2.9, 2.1, 0) || is_red(&m, "ceiling/hall", 0.9, 1.1, 2.5));
    assert_int_equal(face_of(&m, "floor/hall/bottom", vec3_make(0, 0, 0))->rules[0].kind, TEXTURE_PLACE);
    release(&m);
}

/* On both planes of a gable. */
static void a_place_on_a_sloping_ceiling_lies_above_its_rectangle(void **state)
{
    struct made m;
    (void)state;
    make(&m, ROOM "gable hall from south 2.5 to north 2.5 ridge 3.5\n", "paint ceiling/hall from 1 1 to 3 2 1 0 0\n");
    for (int i = 0; i < 2; i++) {
        const double y = i ? 1.9 : 1.1, z = 2.5 + 2.0 / 3 * fmin(y, 3 - y);
        assert_true(is_red(&m, "ceiling/hall", 1.1, y, z) && is_red(&m, "ceiling/hall", 2.9, y, z));
        assert_false(is_red(&m, "ceiling/hall", 0.9, y, z) || is_red(&m, "ceiling/hall", 3.1, y, z));
    }
    assert_false(is_red(&m, "ceiling/hall", 2, 0.9, 2.5 + 0.6) || is_red(&m, "ceiling/hall", 2, 2.1, 2.5 + 0.6));
    release(&m);
}

static void the_last_coat_counts(void **state)
{
    struct made m;
    (void)state;
    make(&m, ROOM, "paint wall/south/in 0 0 1\npaint wall/south/in from 1 0 to 2 2 1 0 0\n");
    assert_true(is_red(&m, "wall/south/in", 1.5, 0, 1));
    assert_true(rule_at(&m, "wall/south/in", vec3_make(0.5, 0, 1))->albedo[2] == 1);
    release(&m);
    make(&m, ROOM, "paint wall/south/in from 1 0 to 2 2 1 0 0\npaint wall/south/in 0 0 1\n");
    assert_false(is_red(&m, "wall/south/in", 1.5, 0, 1));
    release(&m);
}

/* ------------------------------------------------------------------------------------------------------------ gloss */

static void gloss_lies_on_top_of_texture_and_colour(void **state)
{
    struct made m;
    (void)state;
    make(&m, ROOM,
         "box b from 1 1 to 2 2 top 1\nmaterial box/b ward 0.1 0.2\nmaterial box/b/top phong 0.05 40\n"
         "material floor/hall phong 0.1 20\nmaterial floor/hall matt\n");
    const struct texture_face *top = face_of(&m, "box/b/top", vec3_make(1.5, 1.5, 1)),
                              *left = face_of(&m, "box/b/left", vec3_make(1, 1.5, 0.5)),
                              *floor = face_of(&m, "floor/hall", vec3_make(1, 1, 0)),
                              *wall = face_of(&m, "wall/west/in", vec3_make(0, 1, 1));
    assert_true(top->has_gloss && top->gloss.kind == BRDF_PHONG && top->gloss.shape == 40);
    assert_true(left->has_gloss && left->gloss.kind == BRDF_WARD && left->gloss.ks == 0.1);
    assert_int_equal(left->rules[0].kind, TEXTURE_COLOUR);
    assert_true(floor->has_gloss && floor->gloss.kind == BRDF_LAMBERT && floor->gloss.ks == 0);
    assert_int_equal(floor->rules[0].kind, TEXTURE_PLACE);
    assert_false(wall->has_gloss);
    release(&m);
}

/* ------------------------------------------------------------------------------------------------------------ lamps */

static void the_last_statement_about_a_lamp_counts(void **state)
{
    struct made m;
    (void)state;
    make(&m, ROOM,
         "lamp \"over the table\" off\nlamp floor scale 2 1 0.5\nlamp wall scale 2 2 2\nlamp wall off\n"
         "lamp same off\nlamp same scale 1 1 1\n");
    assert_int_equal(m.map.lamp_count, 3);
    for (int c = 0; c < 3; c++) assert_true(texture_map_lamp(&m.map, "over the table")[c] == 0);
    assert_true(texture_map_lamp(&m.map, "floor")[2] == 0.5);
    assert_true(texture_map_lamp(&m.map, "wall")[0] == 0);
    assert_null(texture_map_lamp(&m.map, "same"));
    release(&m);
}

/* ---------------------------------------------------------------------------------------------------------- objects */

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"

static void an_object_is_scaled_turned_and_moved(void **state)
{
    struct plan plan;
    struct object_list list = {0};
    struct obj_mesh mesh;
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("chair.obj", TRIANGLE);
    assert_ok(scripted(&plan, ROOM,
                       EDIT
                       "object a chair.obj at 1 2 3 turn 90 scale 2 3 4 phong 0.1 0.2 0.3 0.05 30\n"
                       "object b chair.obj at 1 2 3 scale 2 turn 30 matt 0.1 0.2 0.3\n"
                       "object c chair.obj at 0 0 0 matt 0 0 0\nobject c chair.obj at 0.5 0 0 ward 0 0 0 0.1 0.2\n",
                       &err),
              err);
    assert_ok(objects_make(&list, &plan, scratch, &err), err);
    assert_int_equal(list.count, 3);
    static const double turned[3][4] = {{0, -3, 0, 1}, {2, 0, 0, 2}, {0, 0, 4, 3}};
    assert_memory_equal(list.items[0].matrix, turned, sizeof turned);
    assert_true(list.items[0].brdf.kind == BRDF_PHONG && list.items[0].brdf.albedo.b == 0.3);
    assert_true(fabs(list.items[1].matrix[1][0] - 1) < 1e-15 && list.items[1].matrix[2][2] == 2);
    assert_true(list.items[2].matrix[0][3] == 0.5 && list.items[2].brdf.kind == BRDF_WARD); /* the last one counts */
    assert_ok(object_mesh_read(&mesh, &list.items[0], scratch, &err), err);
    assert_true(mesh.triangles[0][2].x == -2 && mesh.triangles[0][2].y == 2 && mesh.triangles[0][2].z == 3);
    obj_mesh_release(&mesh);
    object_list_release(&list);
    plan_release(&plan);
}

static void objects_of_missing_or_damaged_meshes_are_refused(void **state)
{
    static const char *const cases[][2] = {
        {"missing.obj", "edit.txt:2: found no file"},
        {"damaged.obj", "damaged.obj:2: found \"5\", wanted a vertex from 1 to 1"},
        {"nothing.obj", "has no faces"},
    };
    (void)state;
    scratch_write("damaged.obj", "v 0 0 0\nf 5 1 1\n");
    scratch_write("nothing.obj", "v 0 0 0\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct plan plan;
        struct object_list list = {0};
        struct err err = ERR_INIT;
        char edit[256];
        snprintf(edit, sizeof edit, EDIT "object a %s at 0 0 0 matt 0 0 0\n", cases[i][0]);
        assert_ok(scripted(&plan, ROOM, edit, &err), err);
        assert_int_not_equal(objects_make(&list, &plan, scratch, &err), ST_OK);
        assert_err(err, ST_DATA, cases[i][1]);
        assert_err(err, ST_DATA, "edit.txt:2: ");
        object_list_release(&list);
        err = (struct err)ERR_INIT;
        assert_int_not_equal(objects_make(&list, &plan, NULL, &err), ST_OK);
        assert_err(err, ST_DATA, "give --scene");
        object_list_release(&list);
        plan_release(&plan);
    }
}

/* --------------------------------------------------------------------------------------------- objects of all edits */

/* The plan of ROOM with objects.txt and upper.txt. */
static enum status chained(struct plan *plan, const char *objects, const char *lower, const char *upper,
                           struct err *err)
{
    struct provenance prov = {0};
    plan_begin(plan, NULL);
    scratch_write("lower.txt", lower);
    if (!edit_chain_apply_model(plan, scratch_write("model.txt", ROOM), NULL, &prov, err) &&
        !edit_chain_apply_objects(plan, scratch_write("objects.txt", objects), &prov, err))
        edit_chain_apply_edit(plan, scratch_write("upper.txt", upper), NULL, &prov, err);
    provenance_release(&prov);
    return err->status;
}

static void an_edit_changes_what_those_below_it_say(void **state)
{
    struct plan plan;
    struct object_list list = {0};
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("a.obj", TRIANGLE);
    assert_ok(chained(&plan, EDIT "object all a.obj at 1 1 1 matt 0 0 0\nobject gone a.obj at 1 1 1 matt 0 0 0\n",
                      EDIT "lamp l off\nlamp k off\nobject mine a.obj at 2 2 2 matt 0 0 0\nmaterial floor/hall matt\n",
                      EDIT "base lower\nlamp l scale 1 2 3\nremove object gone\nremove object mine\n"
                           "object all a.obj at 3 3 3 matt 0 0 0\n",
                      &err),
              err);
    assert_ok(objects_make(&list, &plan, scratch, &err), err);
    assert_int_equal(list.count, 1);
    assert_string_equal(list.items[0].name, "all");
    assert_true(list.items[0].matrix[0][3] == 3);
    assert_int_equal(plan.lamp_count, 2);
    assert_true(plan.lamps[0].scale[2] == 3 && plan.lamps[1].scale[2] == 0);
    assert_int_equal(plan.wish_count, 1);
    object_list_release(&list);
    plan_release(&plan);
}

static void objects_of_all_edits_are_objects_alone(void **state)
{
    static const char *const cases[][2] = {
        {EDIT "lamp l off\n", "objects.txt:2: found lamp, wanted object"},
        {EDIT "object a a.obj at 0 0 0 matt 0 0 0\nbox b from 1 1 to 2 2\n", "objects.txt:3: found box, wanted object"},
        {EDIT "base lower\n", "objects.txt:2: found base, wanted object"},
        {EDIT "object a a.obj at 0 0 0 matt 0 0 0\nobject a a.obj at 0 0 0 matt 0 0 0\n", "objects.txt:3: "},
        {"object a a.obj at 0 0 0 matt 0 0 0\n", "remodel-script 1"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct plan plan;
        struct err err = ERR_INIT;
        assert_int_not_equal(chained(&plan, cases[i][0], EDIT, EDIT "base lower\n", &err), ST_OK);
        assert_err(err, ST_DATA, cases[i][1]);
        plan_release(&plan);
    }
}

/* --------------------------------------------------------------------------------------------------------- refusals */

/* A lamp that an edit hangs is in texture.txt, and comes back from it; one that is off again is not. */
static void planned_lamps_reach_the_map(void **state)
{
    struct made m;
    struct texture_map map;
    struct err err = ERR_INIT;
    (void)state;
    make(&m, ROOM,
         "lamp a ies a.ies at 1 1 2 aim 0 1 -1 turn 30 colour 1 0.8 0.6\nlamp b ies a.ies at 2 1 2\nlamp b off\n"
         "lamp c ies a.ies at 2 1 2\nlamp c scale 0.5 0.5 0.5\nlamp d off\n"
         "lamp red ies a.ies at 2 1 2 colour 1 0 0\nlamp red scale 0 1 1\n"); /* which leaves nothing of it */
    assert_ok(texture_map_write(&m.map, scratch_path("map.txt"), NULL, &err), err);
    assert_ok(texture_map_read(&map, scratch_path("map.txt"), NULL, &err), err);
    assert_int_equal(map.lamp_count, 1);
    assert_int_equal(map.planned_count, 2);
    assert_string_equal(map.planned[0].name, "a");
    assert_string_equal(map.planned[0].file, "a.ies");
    assert_true(map.planned[0].at[2] == 2 && map.planned[0].aim[1] == 1 && map.planned[0].turn == 30);
    assert_true(map.planned[0].colour[1] == 0.8 && map.planned[0].scale[0] == 1);
    assert_true(map.planned[1].aim[2] == -1 && map.planned[1].scale[2] == 0.5);
    texture_map_release(&map);
    release(&m);
}

static void statements_without_meaning_are_refused(void **state)
{
    static const char *const cases[][2] = {
        {"paint wall/west/in 0 0\n", "wanted a share of blue light"},
        {"paint wall/west/in 0 0 1.5\n", "a share of light, from 0 to 1"},
        {"paint wall/west/in 0 0 1 1\n", "the end of the line"},
        {"paint west 0 0 1\n", "a face, such as wall/south/in"},
        {"paint wall/west/in from 1 1 to 1 2 0 0 1\n", "the place on wall/west/in is 0 wide and 1 high"},
        {"paint wall/wst/in from 1 1 to 2 2 0 0 1\n", "did you mean west?"},
        {"paint box/b/top from 1 1 to 2 2 0 0 1\n",
         "a place on box/b/top cannot be given: only wall/NAME/in and out (S and Z), floor/NAME and ceiling/NAME (X "
         "and "
         "Y) have places. Leave the place out: the whole face gets the colour."},
        {"paint floor/hall in v00 1 1 2 2 0 0 1\n", "no views are known"},
        {"lamp l\n", "lamp NAME off | lamp NAME scale R G B"},
        {"lamp l ies l.obj at 1 1 2\n", "an IES file in the scene's folder, FILE.ies"},
        {"lamp l ies a/l.ies at 1 1 2\n", "an IES file in the scene's folder, FILE.ies"},
        {"lamp l ies L.IES at 1 1 2\n", "FILE.ies, of letters, digits"},
        {"lamp l ies \"a l.ies\" at 1 1 2\n", "FILE.ies, of letters, digits"},
        {"lamp l ies l.ies 1 1 2\n", "found \"1\""},
        {"lamp l ies l.ies at 1 1\n", "a coordinate"},
        {"lamp l ies l.ies at 1 1 2 aim 0 0 0\n", "a direction, such as 0 0 -1"},
        {"lamp l ies l.ies at 1 1 2 colour 0 0 0\n", "a number above 0 in it"},
        {"lamp l ies l.ies at 1 1 2 turn 1 turn 2\n", "each once"},
        {"lamp l ies l.ies at 1 -0.05 2\n", "the lamp l at 1 -0.05 2 is in no room"},
        {"lamp l ies l.ies at 1 1 9\n", "the lamp l at 1 1 9 is in no room"},
        {"lamp l ies l.ies at 1 1 2\nlamp l ies l.ies at 1 1 2\n", "edit.txt:3: the statement changes nothing"},
        {"lamp l scale 0.5 0.5 0.5\nlamp l ies l.ies at 1 1 2\n", "give the planned lamp another name"},
        {"lamp l on\n", "found \"on\""},
        {"lamp l off now\n", "the end of the line"},
        {"lamp l scale 1 1\n", "a factor of 0 or more"},
        {"lamp l scale 1 1 -1\n", "found \"-1\", wanted a factor of 0 or more"},
        {"lamp l scale 1 1 nan\n", "found \"nan\""},
        {"lamp l scale 1 1 inf\n", "found \"inf\""},
        {"lamp \"\" off\n", "the name of a lamp of lights.txt"},
        {"lamp l scale 1 1 1\n", "changes nothing"},
        {"lamp l off\nlamp l scale 0 0 0\n", "edit.txt:3: the statement changes nothing"},
        {"material floor/hall\n", "wanted matt, phong or ward"},
        {"material floor/hall lambert\n", "found \"lambert\", wanted matt, phong or ward"},
        {"material hall matt\n", "a face, such as wall/south/in"},
        {"material floor/hall phong 0.1\n", "N, an exponent"},
        {"material floor/hall phong 0.1 0.5\n", "N, an exponent, a number from 1 to 5000"},
        {"material floor/hall phong 3 1\n", "wanted no more than 1 together"},
        {"material floor/hall ward 0.1 0.01\n", "ALPHA, a roughness, a number from 0.02 to 1"},
        {"material floor/hall ward -0.1 0.1\n", "KS, the strength of the gloss, a number from 0"},
        {"material floor/hall matt 1\n", "the end of the line"},
        {"object a\n", "a mesh, FILE.obj"},
        {"object a /a.obj at 0 0 0 matt 0 0 0\n", "a mesh in the scene's folder"},
        {"object a ../a.obj at 0 0 0 matt 0 0 0\n", "a mesh in the scene's folder"},
        {"object a a.ply at 0 0 0 matt 0 0 0\n", "a mesh in the scene's folder"},
        {"object a a.obj to 0 0 0 matt 0 0 0\n", "found \"to\""},
        {"object a a.obj at 0 0 matt 0 0 0\n", "found \"matt\""},
        {"object a a.obj at 0 0 2000 matt 0 0 0\n", "wanted it within 1000 of the origin"},
        {"object a a.obj at 0 0 0\n", "wanted more words, in a line \"object NAME FILE.obj at X Y Z"},
        {"object a a.obj at 0 0 0 trun 3 matt 0 0 0\n", "found \"trun\""},
        {"object a a.obj at 0 0 0 turn 3 turn 4 matt 0 0 0\n", "each option once"},
        {"object a a.obj at 0 0 0 scale 0 matt 0 0 0\n", "a scale from 1e-6 to 1e6"},
        {"object a a.obj at 0 0 0 scale 1 2 matt 0 0 0\n", "found \"matt\", wanted a scale"},
        {"object a a.obj at 0 0 0 scale 1 -2 1 matt 0 0 0\n", "a scale from 1e-6 to 1e6"},
        {"object a a.obj at 0 0 0 matt 0 0 2\n", "a share of blue light, a number from 0 to 1"},
        {"object a a.obj at 0 0 0 phong 0 0 0.9 0.5 5\n", "no more than 1 together"},
        {"object a a.obj at 0 0 0 matt 0 0 0\nobject a a.obj at 0 0 0 turn 0 matt 0 0 0\n", "edit.txt:3: "},
        {"remove object a\n", "edit.txt:2: no object is named a; objects.txt or the edit that this one stands on"},
        {"object chair a.obj at 0 0 0 matt 0 0 0\nremove object chiar\n", "did you mean chair?"},
        {"object a a.obj at 0 0 0 matt 0 0 0\nremove object a\nremove object a\n",
         "edit.txt:4: the object a was removed"},
        {"remove object a b\n", "the end of the line"},
        {"remove object\n", "nothing is named object"},
        {"pant wall/west/in 0 0 1\n", "did you mean paint?"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char whole[1024];
        snprintf(whole, sizeof whole, EDIT "%s", cases[i][0]);
        refused(ROOM "box b from 1 1 to 2 2 top 1\n", whole, cases[i][1]);
    }
}

static void faces_that_are_not_there_are_named(void **state)
{
    static const char *const cases[][2] = {
        {"paint wall/sout/in 0 0 0\n", "edit.txt:2: the edited model has no face wall/sout/in; did you mean"},
        {"material box/c ward 0.1 0.1\n", "edit.txt:2: the edited model has no face box/c"},
        {"material floor/hal matt\n", "did you mean floor/hall?"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct err err = ERR_INIT;
        struct made m;
        assert_int_not_equal(try_make(&m, ROOM, cases[i][0], &err), ST_OK);
        assert_err(err, ST_DATA, cases[i][1]);
        release(&m);
    }
}

static void the_unedited_model_has_no_statements_about_light(void **state)
{
    static const char *const statements[] = {"paint wall/west/in 0 0 0", "lamp l off", "material wall/west/in matt",
                                             "object a a.obj at 0 0 0 matt 0 0 0"};
    (void)state;
    only_for_edits(ROOM, statements, sizeof statements / sizeof *statements);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paint_covers_a_face_as_a_colour_does),
        cmocka_unit_test(a_painted_place_is_a_rectangle_of_the_face),
        cmocka_unit_test(a_place_on_a_sloping_ceiling_lies_above_its_rectangle),
        cmocka_unit_test(the_last_coat_counts),
        cmocka_unit_test(gloss_lies_on_top_of_texture_and_colour),
        cmocka_unit_test(the_last_statement_about_a_lamp_counts),
        cmocka_unit_test(an_object_is_scaled_turned_and_moved),
        cmocka_unit_test(objects_of_missing_or_damaged_meshes_are_refused),
        cmocka_unit_test(an_edit_changes_what_those_below_it_say),
        cmocka_unit_test(objects_of_all_edits_are_objects_alone),
        cmocka_unit_test(planned_lamps_reach_the_map),
        cmocka_unit_test(statements_without_meaning_are_refused),
        cmocka_unit_test(faces_that_are_not_there_are_named),
        cmocka_unit_test(the_unedited_model_has_no_statements_about_light),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
