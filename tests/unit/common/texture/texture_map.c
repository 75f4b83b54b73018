/* texture_map.c - texture.txt: what is written is read back; look-ups; what is wrong is named. */
#include "common/texture/texture_map.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/unit/scratch.h"

#define HEAD "remodel-texture 1\nbase none\n"
#define FACE "face 3 0 0 1 0 floor/hall\n"
#define SAME " 1 0 0 0 0 1 0 0 0 0 1 0"

static void what_is_written_is_read_back(void **state)
{
    static const char text[] =
        "remodel-texture 1\nbase \"open plan\"\n"
        "face 3 0 0 1 0.10000000000000001 floor/hall\n"
        "place 3" SAME "\nedge 7 1 0 0 0.5 0 1 0 0 0 0 1 0 within 0 0 0 1 0 0 1 1 0 0 1 0\n"
        "new 1\ntriangle 0 0 0 1 0 0 0 1 0\n"
        "face 3 0 0 1 2 floor/hall\noutdoors\n"
        "face 9 1 0 0 -2 \"wall/a b/in\"\ncolour 0.5 0.25 0 lit 3 9 within 0 0 0 0 1 0 0 1 1 0 0 1\ncolour 1 1 1 lit\n"
        "clear hall 0 2.5 3 0 0 4 0 4 3\nkeep place -1 1 4 1 1 2 1 2 2 1 2\n";
    struct texture_map map;
    struct err err = ERR_INIT;
    char *again = NULL;
    (void)state;
    assert_ok(texture_map_read(&map, scratch_write("a.txt", text), &err), err);
    assert_string_equal(map.base, "open plan");
    assert_int_equal(map.face_count, 3);
    assert_int_equal(map.faces[0].rule_count, 2);
    assert_int_equal(map.faces[2].rules[0].lit_count, 2);
    assert_int_equal(map.zone_count, 2);
    assert_ok(texture_map_write(&map, scratch_path("b.txt"), NULL, &err), err);
    texture_map_release(&map);
    FILE *file = fopen(scratch_path("b.txt"), "r");
    size_t size = 0;
    assert_non_null(file);
    assert_true(getdelim(&again, &size, '\0', file) > 0);
    fclose(file);
    assert_string_equal(again, text);
    free(again);
}

static void a_face_is_found_by_its_plane(void **state)
{
    struct texture_map map;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(
        texture_map_read(
            &map, scratch_write("a.txt", HEAD FACE "outdoors\nface 3 0 0 1 2 floor/hall\nface 9 0 0 1 5 x/y\n"), &err),
        err);
    assert_ptr_equal(texture_map_find(&map, 3, vec3_make(7, 7, 0.1)), &map.faces[0]);
    assert_ptr_equal(texture_map_find(&map, 3, vec3_make(7, 7, 1.9)), &map.faces[1]);
    assert_null(texture_map_find(&map, 4, vec3_make(7, 7, 1.9)));
    texture_map_release(&map);
}

static void limits_hold_points_in_either_direction(void **state)
{
    const struct vec3 up = {0, 0, 1}, in = {0.5, 0.5, 0}, out = {1.5, 0.5, 0};
    struct texture_rule rule = {.limited = true, .within = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    (void)state;
    assert_true(texture_rule_holds(&rule, up, in));
    assert_false(texture_rule_holds(&rule, up, out));
    const struct vec3 swap = rule.within[1];
    rule.within[1] = rule.within[3];
    rule.within[3] = swap;
    assert_true(texture_rule_holds(&rule, up, in));
    assert_false(texture_rule_holds(&rule, up, out));
    rule.limited = false;
    assert_true(texture_rule_holds(&rule, up, out));
}

static void what_is_wrong_is_named_with_its_line(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"remodel-texture 2\n", "a.txt:1"},
        {HEAD "place 3" SAME "\n", "a.txt:3: found \"place\", wanted a line \"face\" before it"},
        {HEAD FACE "place 0" SAME "\n", "a.txt:4"},
        {HEAD FACE "place 3 1 0 0\n", "a.txt:4"},
        {HEAD FACE "colour 0 0 1.5 lit\n", "a share of light, from 0 to 1"},
        {HEAD FACE "colour 0 0 1 lit 0\n", "the id of a face"},
        {HEAD FACE "outdoors indeed\n", "a.txt:4"},
        {HEAD FACE "new 2\ntriangle 0 0 0 1 0 0 0 1 0\n", "triangle"},
        {HEAD "face 3 0 0 2 0 floor/hall\n", "a normal of length 1"},
        {HEAD FACE "face 2 0 0 1 0 floor/x\n", "faces are in order"},
        {HEAD "clear hall 0 2 2 0 0 1 1\n", "a.txt:3"},
        {HEAD "clear hall 2 0 3 0 0 1 1 1 0\n", "a height above the lowest"},
        {HEAD "keep a 0 1 3 0 0 1 1 1 0\n" FACE, "faces before the lines"},
        {HEAD FACE "place 3" SAME " within 1 1 0 1 1 0 1 1 0 1 1 0\n", "four corners around an area"},
        {HEAD "fcae 3\n", "face, place, edge"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct texture_map map;
        struct err err = ERR_INIT;
        assert_int_not_equal(texture_map_read(&map, scratch_write("a.txt", cases[i].text), &err), ST_OK);
        assert_err(err, ST_DATA, cases[i].words);
        assert_int_equal(map.face_count, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read_back),
        cmocka_unit_test(a_face_is_found_by_its_plane),
        cmocka_unit_test(limits_hold_points_in_either_direction),
        cmocka_unit_test(what_is_wrong_is_named_with_its_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
