/* texture_map.c - texture.txt: what is written is read back; look-ups; what is wrong is named. */
#include "common/texture/texture_map.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/unit/scratch.h"

#define HEAD "remodel-texture 3\nbase none\n"
#define FACE "face 3 0 0 1 0 floor/hall\n"
#define SAME " 1 0 0 0 0 1 0 0 0 0 1 0"

static void reads_back(const char *text, struct texture_map *map)
{
    struct err err = ERR_INIT;
    char *again = NULL;
    size_t size = 0;
    assert_ok(texture_map_read(map, scratch_write("a.txt", text), NULL, &err), err);
    assert_ok(texture_map_write(map, scratch_path("b.txt"), NULL, &err), err);
    FILE *file = fopen(scratch_path("b.txt"), "r");
    assert_non_null(file);
    assert_true(getdelim(&again, &size, '\0', file) > 0);
    fclose(file);
    assert_string_equal(again, text);
    free(again);
}

static void what_is_written_is_read_back(void **state)
{
    static const char text[] =
        "remodel-texture 3\nbase \"open plan\"\n"
        "face 3 0 0 1 0.10000000000000001 floor/hall\n"
        "place 3" SAME "\nedge 7 1 0 0 0.5 0 1 0 0 0 0 1 0 within 0 0 0 1 0 0 1 1 0 0 1 0\n"
        "new 1\ntriangle 0 0 0 1 0 0 0 1 0\n"
        "face 3 0 0 1 2 floor/hall\noutdoors\n"
        "face 9 1 0 0 -2 \"wall/a b/in\"\ncolour 0.5 0.25 0 lit 3 9 within 0 0 0 0 1 0 0 1 1 0 0 1\ncolour 1 1 1 lit\n"
        "clear hall 0 2.5 3 0 0 4 0 4 3\nkeep place -1 1 4 1 1 2 1 2 2 1 2\n";
    struct texture_map map;
    (void)state;
    reads_back(text, &map);
    assert_string_equal(map.base, "open plan");
    assert_int_equal(map.face_count, 3);
    assert_int_equal(map.faces[0].rule_count, 2);
    assert_int_equal(map.faces[2].rules[0].lit_count, 2);
    assert_int_equal(map.zone_count, 2);
    assert_false(map.faces[0].has_gloss);
    texture_map_release(&map);
}

static void lamps_and_gloss_are_read_back(void **state)
{
    static const char text[] = "remodel-texture 3\nbase none\n"
                               "lamp \"over the table\" 0 0 0\nlamp floor 2 0.5 0.10000000000000001\n"
                               "face 3 0 0 1 0 floor/hall\ngloss phong 0.10000000000000001 30\noutdoors\n"
                               "face 4 0 0 1 0 box/b/top\ngloss matt\n"
                               "face 5 0 0 1 0 box/b/left\ngloss ward 0.20000000000000001 0.14999999999999999\n"
                               "face 6 0 0 1 0 box/b/right\noutdoors\n";
    struct texture_map map;
    (void)state;
    reads_back(text, &map);
    assert_int_equal(map.lamp_count, 2);
    assert_true(texture_map_lamp(&map, "over the table")[1] == 0);
    assert_true(texture_map_lamp(&map, "floor")[0] == 2);
    assert_null(texture_map_lamp(&map, "ceiling"));
    assert_true(map.faces[0].has_gloss && map.faces[0].gloss.kind == BRDF_PHONG && map.faces[0].gloss.shape == 30);
    assert_true(map.faces[1].has_gloss && map.faces[1].gloss.kind == BRDF_LAMBERT);
    assert_true(map.faces[2].gloss.kind == BRDF_WARD && map.faces[2].gloss.ks == 0.2);
    assert_false(map.faces[3].has_gloss);
    texture_map_release(&map);
}

static void things_are_read_back(void **state)
{
    static const char text[] = HEAD FACE "outdoors\nclear hall 0 2.5 3 0 0 4 0 4 3\n"
                                         "thing stool clear e.txt 2\nthing \"old sofa\" keep \"open plan.txt\" 3\n"
                                         "thing table move table 0.10000000000000001 -0.80000000000000004 0 0 e.txt 4\n"
                                         "thing \"second table\" move table 1 0 0.25 -90 e.txt 5\n"
                                         "thing chair place chair 3 1.5 0.25 30.5 e.txt 6\n"
                                         "thing other place \"old sofa\" -3 1.5 0 0 e.txt 7\n";
    struct texture_map map;
    (void)state;
    reads_back(text, &map);
    assert_int_equal(map.thing_count, 6);
    assert_int_equal(map.things[0].kind, TEXTURE_THING_CLEAR);
    assert_string_equal(map.things[0].from, "stool");
    assert_int_equal(map.things[1].kind, TEXTURE_THING_KEEP);
    assert_string_equal(map.things[1].name, "old sofa");
    assert_int_equal(map.things[2].kind, TEXTURE_THING_MOVE);
    assert_true(map.things[2].by[0] == 0.1 && map.things[2].by[1] == -0.8 && map.things[2].by[2] == 0);
    assert_string_equal(map.things[3].name, "second table");
    assert_string_equal(map.things[3].from, "table");
    assert_true(map.things[3].turn == -90);
    assert_string_equal(map.things[1].script, "open plan.txt");
    assert_int_equal(map.things[1].line, 3);
    assert_string_equal(map.things[3].script, "e.txt");
    assert_int_equal(map.things[3].line, 5);
    assert_int_equal(map.things[4].kind, TEXTURE_THING_PLACE);
    assert_true(map.things[4].by[2] == 0.25 && map.things[4].turn == 30.5);
    assert_string_equal(map.things[5].from, "old sofa");
    texture_map_release(&map);
    assert_int_equal(map.thing_count, 0);
}

static void a_thing_that_is_added_is_a_copy(void **state)
{
    char name[] = "b", from[] = "sofa", script[] = "e.txt";
    const struct texture_thing thing = {TEXTURE_THING_PLACE, name, from, {1, 2, 3}, 45, script, 6};
    struct texture_map map = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(texture_map_add_thing(&map, &thing, &err), err);
    name[0] = from[0] = script[0] = 'x';
    assert_int_equal(map.thing_count, 1);
    assert_string_equal(map.things[0].name, "b");
    assert_string_equal(map.things[0].from, "sofa");
    assert_string_equal(map.things[0].script, "e.txt");
    assert_int_equal(map.things[0].line, 6);
    assert_true(map.things[0].kind == TEXTURE_THING_PLACE && map.things[0].by[1] == 2 && map.things[0].turn == 45);
    texture_map_release(&map);
}

static void a_face_is_found_by_its_plane(void **state)
{
    struct texture_map map;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(texture_map_read(
                  &map, scratch_write("a.txt", HEAD FACE "outdoors\nface 3 0 0 1 2 floor/hall\nface 9 0 0 1 5 x/y\n"),
                  NULL, &err),
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
        {"remodel-texture 2\n", "a.txt:1: found \"2\", wanted version 3"},
        {"remodel-texture 4\n", "a.txt:1"},
        {HEAD "place 3" SAME "\n", "a.txt:3: found \"place\", wanted a line \"face\" before it"},
        {HEAD FACE "place 0" SAME "\n", "a.txt:4"},
        {HEAD FACE "place 3 1 0 0\n", "a.txt:4"},
        {HEAD FACE "colour 0 0 1.5 lit\n", "a share of light, a number from 0 to 1"},
        {HEAD FACE "colour 0 0 1 lit 0\n", "the id of a face"},
        {HEAD FACE "colour 0 0 1 lit 3.0\n", "found \"3.0\", wanted the id of a face, or \"within\""},
        {HEAD FACE "colour 0 0 1 lit 0x3\n", "found \"0x3\""},
        {HEAD FACE "colour 0 0 1 lit 3 \" 4\"\n", "found \" 4\""},
        {HEAD FACE "colour 0 0 1 lit 3000000000\n", "found \"3000000000\""},
        {HEAD FACE "colour 0 0 1 lit 99999999999999999999\n", "the id of a face"},
        {HEAD FACE "new 100001\n", "a.txt:4"},
        {HEAD FACE "outdoors indeed\n", "a.txt:4"},
        {HEAD FACE "new 2\ntriangle 0 0 0 1 0 0 0 1 0\n", "triangle"},
        {HEAD "face 3 0 0 2 0 floor/hall\n", "a normal of length 1"},
        {HEAD FACE "face 2 0 0 1 0 floor/x\n", "faces are in order"},
        {HEAD "clear hall 0 2 2 0 0 1 1\n", "a.txt:3"},
        {HEAD "clear hall 2 0 3 0 0 1 1 1 0\n", "a height above the lowest"},
        {HEAD "keep a 0 1 3 0 0 1 1 1 0\n" FACE, "faces before the lines"},
        {HEAD FACE "place 3" SAME " within 1 1 0 1 1 0 1 1 0 1 1 0\n", "four corners around an area"},
        {HEAD "lamp l 1 1\n", "a.txt:3: found the end of the line, wanted a factor"},
        {HEAD "lamp l 1 1 -1\n", "found \"-1\", wanted a factor, a number of at least 0"},
        {HEAD "lamp l 1 1 inf\n", "found \"inf\""},
        {HEAD "lamp l 1 1 1 1\n", "a.txt:3: found \"1\""},
        {HEAD "lamp l 1 1 1\nlamp l 0 0 0\n", "a.txt:4: found \"l\", wanted a lamp that no line above has"},
        {HEAD FACE "lamp l 1 1 1\n", "lamps before the lines \"face\""},
        {HEAD "gloss matt\n", "a.txt:3: found \"gloss\", wanted a line \"face\" before it"},
        {HEAD FACE "gloss satin\n", "found \"satin\", wanted matt, phong or ward"},
        {HEAD FACE "gloss matt 1\n", "found \"1\", wanted the end of the line"},
        {HEAD FACE "gloss phong 0.1 0.5\n", "found \"0.5\", wanted N, an exponent, a number from 1 to 5000"},
        {HEAD FACE "gloss ward 0.1 2\n", "found \"2\", wanted ALPHA, a roughness, a number from 0.02 to 1"},
        {HEAD FACE "gloss ward -1 0.1\n", "wanted KS, the strength of the gloss, a number from 0"},
        {HEAD FACE "gloss matt\ngloss matt\n",
         "a.txt:5: found \"gloss\", wanted one line \"gloss\" right after the face"},
        {HEAD FACE "outdoors\ngloss matt\n", "right after the face's line"},
        {HEAD "fcae 3\n", "lamp, planned, face, gloss, place, edge"},
        {HEAD "fcae 3\n", "clear, keep or thing"},
        {HEAD "thing\n", "a.txt:3: found the end of the line, wanted the name of a thing"},
        {HEAD "thing sofa\n", "a.txt:3: found the end of the line, wanted what happens to it"},
        {HEAD "thing sofa lift\n", "a.txt:3: found \"lift\", wanted clear, keep, move or place"},
        {HEAD "thing sofa clear sofa\n", "a.txt:3: found the end of the line, wanted a line of the script"},
        {HEAD "thing sofa keep e.txt 0\n", "a.txt:3: found \"0\""},
        {HEAD "thing sofa move\n", "a.txt:3: found the end of the line, wanted the name of a thing"},
        {HEAD "thing sofa move sofa\n", "a.txt:3: found the end of the line, wanted a coordinate"},
        {HEAD "thing sofa move sofa 1 2\n", "a.txt:3: found the end of the line, wanted a coordinate"},
        {HEAD "thing sofa move sofa 1 2 up 0\n", "a.txt:3: found \"up\", wanted a coordinate"},
        {HEAD "thing sofa move sofa 1 inf 0 0\n", "a.txt:3: found \"inf\""},
        {HEAD "thing sofa place sofa 1 2 0\n", "a.txt:3: found the end of the line, wanted a turn"},
        {HEAD "thing sofa place sofa 1 2 0 nan\n", "a.txt:3: found \"nan\", wanted a turn"},
        {HEAD "thing sofa clear\n", "a.txt:3: found the end of the line, wanted the name of a script"},
        {HEAD "thing a clear e.txt 1\nthing sofa place sofa 1 2 0 0 e.txt 2 0\n",
         "a.txt:4: found \"0\", wanted the end of the line"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct texture_map map;
        struct err err = ERR_INIT;
        assert_int_not_equal(texture_map_read(&map, scratch_write("a.txt", cases[i].text), NULL, &err), ST_OK);
        assert_err(err, ST_DATA, cases[i].words);
        assert_int_equal(map.face_count, 0);
        assert_null(map.things);
    }
}

static void refused_to_write(const struct texture_map *map, const char *words)
{
    const char *path = scratch_path("refused.txt");
    struct err err = ERR_INIT;
    assert_int_equal(texture_map_write(map, path, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
    assert_int_not_equal(access(path, F_OK), 0);
}

static void what_the_reader_refuses_is_not_written(void **state)
{
    enum { MAX_COUNT = 100000 };
    static struct vec3 added[MAX_COUNT + 1][3];
    static double corners[MAX_COUNT + 1][2];
    char face_name[] = "wall/a/in", zone_name[] = "hall", base[] = "none";
    struct texture_rule rule = {.kind = TEXTURE_OUTDOORS};
    struct texture_face face = {
        .id = 3, .name = face_name, .normal = {0, 0, 1}, .rules = &rule, .rule_count = 1, .added = added};
    struct texture_zone zone = {.name = zone_name, .high = 1, .corners = corners};
    struct texture_map map = {.faces = &face, .face_count = 1, .zones = &zone, .zone_count = 1}, read;
    struct err err = ERR_INIT;
    (void)state;
    zone.corner_count = face.added_count = MAX_COUNT; /* the most that can be read */
    assert_ok(texture_map_write(&map, scratch_path("most.txt"), NULL, &err), err);
    assert_ok(texture_map_read(&read, scratch_path("most.txt"), NULL, &err), err);
    assert_true(read.faces[0].added_count == MAX_COUNT && read.zones[0].corner_count == MAX_COUNT);
    texture_map_release(&read);
    face.added_count = MAX_COUNT + 1;
    refused_to_write(&map, "refused.txt: the face wall/a/in has 100001 triangles of new area, wanted at most 100000");
    face.added_count = 0;
    zone.corner_count = MAX_COUNT + 1;
    refused_to_write(&map, "the footprint of hall has 100001 corners, wanted 3 to 100000");
    zone.corner_count = 2;
    refused_to_write(&map, "the footprint of hall has 2 corners");
    zone.corner_count = 3;
    map.base = base;
    refused_to_write(&map, "the edit stands on an edit named \"none\"");
    map.base = NULL;
    struct texture_lamp lamp = {.name = zone_name, .scale = {1, -1, 1}};
    map.lamps = &lamp;
    map.lamp_count = 1;
    refused_to_write(&map, "found a factor of -1 for the lamp hall");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read_back),
        cmocka_unit_test(lamps_and_gloss_are_read_back),
        cmocka_unit_test(things_are_read_back),
        cmocka_unit_test(a_thing_that_is_added_is_a_copy),
        cmocka_unit_test(a_face_is_found_by_its_plane),
        cmocka_unit_test(limits_hold_points_in_either_direction),
        cmocka_unit_test(what_is_wrong_is_named_with_its_line),
        cmocka_unit_test(what_the_reader_refuses_is_not_written),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
