/* plan.c - the script language, and the errors of invalid scripts and plans, with line and reason. */
#include "stages/build_model/script/verbs.h"
#include "tests/unit/build_model/scripted.h"

#define BARE "remodel-script 1\nset thickness 0.2\nset ceiling 2.5\n"

static void invalid_statements_are_refused(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", "remodel-script 1"},
        {"remodel-model 1\n", ":1: found \"remodel-model\""},
        {"remodel-script 2\n", ":1: found \"2\""},
        {"remodel-script 1\nwal a from 0 0 to 1 0\n", ":2: found \"wal\", wanted a statement; did you mean wall?"},
        {"remodel-script 1\nwall a from 0 0 to 1\n", ":2: "},
        {"remodel-script 1\nwall a from 0 0 up 1 0\n", "wanted \"to\""},
        {"remodel-script 1\nwall a at 0 0 to 1 0\n", "wanted \"in VIEW\" or \"from\""},
        {"remodel-script 1\nwall a/b from 0 0 to 1 0\n", "letters, digits"},
        {"remodel-script 1\nwall 12 from 0 0 to 1 0\n", "not a number"},
        {"remodel-script 1\nwall a from 0 0 to 1 nan\n", "nan"},
        {"remodel-script 1\nwall a from 0 0 to 1e7 0\n", "within 1e6"},
        {"remodel-script 1\nwall a from 0 0 to 1 0 thicknes 1\n", "did you mean thickness?"},
        {"remodel-script 1\nwall a from 0 0 to 1 0 top 1 top 2\n", "each option once"},
        {"remodel-script 1\nwall a from 0 0 to 1 0 angled angled\n", "each option once"},
        {"remodel-script 1\nwall a from 0 0 to 1 0 closed\n", "found \"closed\""},
        {"remodel-script 1\nwall a in v1 30 10 20 40\n", ":2: found the rectangle 30 10 20 40"},
        {"remodel-script 1\nset width 3\n", "set thickness|slab"},
        {"remodel-script 1\nroom r a b\n", "room NAME WALL WALL WALL"},
        {"remodel-script 1\njoin a\n", "join WALL WALL"},
        {"remodel-script 1\nextend a top to b\n", "\"start\" or \"end\""},
        {"remodel-script 1\nsplit a from 1 to 2\n", "more words"},
        {"remodel-script 1\nopen\n", "a name"},
        {"remodel-script 1\nremove a b\n", "found \"b\""},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct script script;
        struct err err = ERR_INIT;
        assert_int_not_equal(script_read(&script, scratch_write("bad.txt", cases[i].text), &err), ST_OK);
        assert_err(err, ST_DATA, cases[i].words);
        assert_contains(err.text, "bad.txt:");
        assert_true(!script.statements && !script.count);
    }
}

static void the_whole_language_is_read(void **state)
{
    struct script s;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(script_read(&s,
                          scratch_write("good.txt",
                                        "# words\nremodel-script 1\n\nset glass 0.01\n  wall a in \"v 1\" 1 2 3 4 "
                                        "angled top 2.5\nroom r a b c ceiling 3 floor 0.1\nslope r from a 2 to b "
                                        "3\nwindow w on a from 1 2 to 3 4 open interior\nextend a start to -2.5\n"
                                        "extend a end to b\nmove x by 1 2\nbox q in v 1 2 3 4 at 0.7 turn 45\n"),
                          &err),
              err);
    assert_int_equal(s.count, 9);
    assert_true(!strcmp(s.statements[0].verb->word, "set") && s.statements[0].line == 4 &&
                s.statements[0].values[0] == 0.01);
    assert_string_equal(s.statements[1].place.view, "v 1");
    assert_true(s.statements[1].by_points && !s.statements[8].by_points && !s.statements[1].mesh);
    assert_true(s.statements[1].has_option[OPTION_ANGLED] && s.statements[1].options[OPTION_TOP] == 2.5 &&
                s.statements[1].place.a[3] == 4);
    assert_int_equal(s.statements[2].name_count, 3);
    assert_true(s.statements[2].has_option[OPTION_CEILING] && s.statements[2].options[OPTION_FLOOR] == 0.1);
    assert_string_equal(s.statements[3].names[1], "b");
    assert_true(s.statements[3].values[1] == 3);
    assert_true(s.statements[4].has_option[OPTION_OPEN] && s.statements[4].has_option[OPTION_INTERIOR] &&
                !strcmp(s.statements[4].other, "a"));
    assert_true(s.statements[5].end == END_START && s.statements[5].values[0] == -2.5 && !s.statements[5].other);
    assert_true(s.statements[6].end == END_END && !strcmp(s.statements[6].other, "b"));
    assert_true(s.statements[7].value_count == 2 && s.statements[8].options[OPTION_TURN] == 45);
    script_release(&s);
}

static void invalid_buildings_are_refused(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {BARE "wall a from 0 0 to 3 1\n", ":4: wall a from 0 0 to 3 1 is not along an axis; add the word angled"},
        {BARE "wall a from 1 1 to 1 1\n", ":4: wall a would have no length"},
        {BARE "wall a from 1 1 to 1.0005 1\n", ":4: wall a would be shorter than 0.001"},
        {BARE "wall a from 0 1 to 2000 1\n", ":4: wall a reaches to 2000; a model lies within 1000 units"},
        {ROOM "box b from 999 0 to 999.5 1 turn 45\n", ":10: box b reaches to 10"},
        {ROOM "box b from 0 0 to 1 1 top 1e5\n", ":10: box b reaches to 100000"},
        {BARE "wall a from 6 0 to 0 0\nwall b from 0 0 to 0 4\nwall c from 0 4 to 2 4\nwall d from 2 4 to 2 2\n"
              "wall e from 2 2 to 2.5 2\nwall f from 2.3 2 to 2.3 4\nwall g from 2.3 4 to 6 4\nwall h from 6 4 to 6 0\n"
              "join a b c d e f g h a\nextend e end to 4\nroom hall a b c d e f g h\n",
         ":14: walls g and d of room hall overlap"},
        {ROOM "slope hall from south 500 to north 1000\n", ":9: room hall reaches to 1033"},
        {BARE "wall a from 0 0 to 3 0\nwall a from 0 1 to 3 1\n",
         ":5: the name a is used already, for a wall (line 4)"},
        {BARE "wall a from 0 0 to 3 0\nbox a from 0 1 to 3 2\n", ":5: the name a is used already, for a wall"},
        {BARE "wall a from 0 0 to 3 0 top -1\n", "wanted a top above its foot"},
        {BARE "wall a from 0 0 to 3 0 thickness 0\n", "found thickness 0"},
        {BARE "wall a in v1 0 0 10 10\n", ":4: the statement names the view v1, but no views are known"},
        {BARE "wall ab from 0 0 to 3 0\ndoor d on ac from 0 0 to 1 2\n", "did you mean ab?"},
        {BARE "wall a from 0 0 to 3 0\nbox b from 0 1 to 3 2\ndoor d on b from 0 0 to 1 2\n",
         ":6: b is a box; wanted a wall"},
        {BARE "wall a from 0 0 to 3 0\nwall b from 0 1 to 3 1\njoin a b\n",
         ":6: walls a and b cannot be joined: they are parallel"},
        {BARE "wall a from 0 0 to 3 0\njoin a a\n", "cannot be joined to itself"},
        {ROOM "wall x from 1 1 to 1 2\njoin south x\n", ":11: walls south and x cannot be joined: both ends of south"},
        {ROOM "wall x from 1 1 to 1 2\nextend x end to south\nextend x start to south\n",
         ":12: wall x cannot be extended to south: its other end is there"},
        {BARE "wall a from 0 0 to 3 0\nwall b from 5 1 to 5 4\nextend b start to a\n",
         "the start of wall b does not meet wall a, which goes from 0 to 3"},
        {ROOM "door d on south from 3.5 0 to 4.5 2\n",
         ":10: door d, from 3.5 to 4.5, is outside its wall south, which goes from 0 to 4"},
        {ROOM "window w on south from 1 1 to 2 2.6\n", ":10: window w, from 1 up to 2.6, is outside its wall south"},
        {ROOM "window w on south from 1 -0.1 to 2 2\n", ":10: window w, from -0.1"},
        {ROOM "window w on south from 1 1 to 1 2\n", ":10: window w would be 0 wide"},
        {ROOM "window w on south from 1 1 to 2 2\ndoor d on south from 1.5 0 to 3 2\n",
         ":11: window w and door d, on wall south, overlap"},
        {ROOM "window w on south from 1 1 to 2 2\nwall x from 1.5 1 to 1.5 2\nextend x start to south\n",
         ":10: window w, from 1 to 2 on wall south, overlaps wall x, which meets it"},
        {ROOM "split south from 3 to 5 into rest\n", ":10: the gap from 3 to 5 does not lie in wall south"},
        {ROOM "door d on south from 1 0 to 2 2\nsplit south from 1.5 to 2.5 into rest\n",
         ":11: the gap from 1.5 to 2.5 cuts door d"},
        {ROOM "set glass 0.5\nwindow w on south from 1 1 to 2 2\n", ":11: window w is thicker than its wall south"},
        {ROOM "room again south west north south\n", ":10: room again names wall south twice"},
        {ROOM "room again south north west east\n",
         "walls south and north, which follow each other round room again, are parallel"},
        {BARE "wall a from 3 0 to 0 0\nwall b from 0 0 to 0 3\nwall c from 0 3 to 3 0 angled\njoin a b\nroom r a b c\n",
         ":8: walls b and c, which follow each other round room r, do not meet"},
        {ROOM "slope hall from south 2 to west 3\n", ":10: a ceiling slopes between two parallel walls"},
        {ROOM "slope hall from south 2 to north -1\n", "not above the floor"},
        {ROOM "room r south west north ceiling 0\n", ":10: "},
        {ROOM "box b from 1 1 to 1 2\n", ":10: box b would be 0 x 1 x 2.5 large"},
        {ROOM "move hall by 1\n", "hall is a room; wanted a wall, an opening or a box"},
        {ROOM "adjust south from 0 0 to 1 1\n", "not parallel to wall south"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) refused(cases[i].text, NULL, cases[i].words);
}

static void an_edit_that_breaks_the_building_is_refused(void **state)
{
    static const char base[] = ROOM "door d on south from 3 0 to 3.9 2\nwindow w on north from 1 1 to 2 2\n"
                                    "passage p on west from 1 0 to 2 2\n";
    static const struct {
        const char *edit, *words;
    } cases[] = {
        {"remodel-script 1\nmove east by -0.2\n", "edit.txt:2: door d, from 3 to 3.9, is outside its wall south"},
        {"remodel-script 1\nmove east by -5\n", "edit.txt:2: "},
        {"remodel-script 1\nmove d by 0.5\n", "edit.txt:2: door d"},
        {"remodel-script 1\nopen d\n", "door d is open already"},
        {"remodel-script 1\nclose p\n", "passage p has no leaf that could be closed"},
        {"remodel-script 1\nclose w\n", "window w is closed already"},
        {"remodel-script 1\nclose south\n", "south is a wall; wanted a door or a window"},
        {"remodel-script 1\nremove d\nopen d\n", "edit.txt:3: d was removed"},
        {"remodel-script 1\nremove d\ndoor d on south from 1 0 to 2 2\n", "for an opening that was removed (line 10)"},
        {"remodel-script 1\nmove south by 1 1\n", "a wall moves along its normal"},
        {"remodel-script 1\nmove d by 1 1 1\n", "an opening moves along its wall"},
        {"remodel-script 1\nextend west start to 1\n", "edit.txt:2: "},
        {"remodel-script 1\nroom r2 south west\n", "edit.txt:2: "},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) refused(base, cases[i].edit, cases[i].words);
}

static void a_statement_of_an_edit_that_changes_nothing_is_refused(void **state)
{
    static const char base[] = ROOM "door d on south from 3 0 to 3.9 2\nbox b from 1 1 to 2 2 top 1\n"
                                    "wall x from 1 0 to 1 2\nwindow i on north from 1 1 to 2 2 interior\n";
    static const struct {
        const char *edit, *words;
    } cases[] = {
        {"set ceiling 3\n", "edit.txt:2: \"set ceiling\" changes nothing"},
        {"set ceiling 3\nset ceiling 3.2\nwall y from 2 1 to 3 1\n", "edit.txt:2: \"set ceiling\" changes nothing"},
        {"set glass 0.01\nwall y from 2 1 to 3 1\n", "edit.txt:2: \"set glass\" changes nothing"},
        {"set ceiling 2.5\nwall y from 2 1 to 3 1\n",
         "edit.txt:2: the statement changes nothing: ceiling is 2.5 already"},
        {"move x by 0\n", "edit.txt:2: the statement changes nothing"},
        {"move d by 0 0\n", "changes nothing"},
        {"adjust d from 3 0 to 3.9 2\n", "changes nothing"},
        {"change b top 1\n", "changes nothing"},
        {"change hall ceiling 2.5\n", "changes nothing"},
        {"change x thickness 0.2\n", "changes nothing"},
        {"resize d left 0\n", "changes nothing"},
        {"join south west\n", "changes nothing"},
        {"close i\n", "interior and has no glass"},
    };
    struct plan plan;
    struct err err = ERR_INIT;
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char edit[256];
        snprintf(edit, sizeof edit, "remodel-script 1\n%s", cases[i].edit);
        refused(base, edit, cases[i].words);
    }
    assert_ok(scripted(&plan, base, "remodel-script 1\n# nothing yet\n", &err), err);
    plan_release(&plan);
    assert_ok(scripted(&plan, base, "remodel-script 1\nset ceiling 3\nchange x top 2.4\nbox c from 2 2 to 3 3\n", &err),
              err);
    plan_release(&plan);
}

static void without_a_scale_lengths_must_be_set(void **state)
{
    const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1};
    static const char *const texts[] = {"remodel-script 1\nwall a from 0 0 to 1 0\n",
                                        "remodel-script 1\nset thickness 1\nwall a from 0 0 to 1 0\n"};
    static const char *const words[] = {"set thickness NUMBER", "set ceiling NUMBER"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct plan plan;
        struct script script;
        struct err err = ERR_INIT;
        plan_begin(&plan, &axes);
        assert_ok(script_read(&script, scratch_write("m.txt", texts[i]), &err), err);
        assert_int_not_equal(plan_apply(&plan, &script, false, NULL, &err), ST_OK);
        assert_err(err, ST_DATA, words[i]);
        script_release(&script);
        plan_release(&plan);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(invalid_statements_are_refused),
        cmocka_unit_test(the_whole_language_is_read),
        cmocka_unit_test(invalid_buildings_are_refused),
        cmocka_unit_test(an_edit_that_breaks_the_building_is_refused),
        cmocka_unit_test(a_statement_of_an_edit_that_changes_nothing_is_refused),
        cmocka_unit_test(without_a_scale_lengths_must_be_set),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
