/* things.c - edits that clear, keep, move and copy things: what texture.txt says afterwards, and what is refused. */
#include "stages/build_model/plan/plan_things.h"
#include "tests/unit/build_model/textured.h"

#define EDIT "remodel-script 1\n"

/* The names that the scripts of these tests use; sofa is in line 3. */
#define THINGS                                                          \
    "remodel-marked-things 1\n# furniture\nthing sofa in v02 236 207\n" \
    "thing table in v02 229 268 in v07 10 20\nthing sofa in v03 1 2\nthing low-chair in photo5 0 0\n"

/* The same room as ROOM, in two halves; the floor of the right one is higher. */
#define TWO_FLOORS                                                                                               \
    ROOM "wall middle from 2 1 to 2 2 thickness 0.1\nextend middle start to south\nextend middle end to north\n" \
         "remove hall\nroom left south west north middle\nroom right middle north east south floor 0.25\n"

/* As scripted(), with things between the model and its edit. */
static enum status scripted_things(struct plan *plan, const char *text, const char *things, const char *edit,
                                   struct err *err)
{
    struct script script = {0};
    if (scripted(plan, text, NULL, err) || plan_things_add(plan, scratch_write("things.txt", things), NULL, err))
        return err->status;
    if (edit && !script_read(&script, scratch_write("edit.txt", edit), err)) plan_apply(plan, &script, true, NULL, err);
    script_release(&script);
    return err->status;
}

static void refused_with(const char *text, const char *things, const char *edit, const char *words)
{
    struct plan plan;
    struct err err = ERR_INIT;
    assert_int_not_equal(scripted_things(&plan, text, things, edit, &err), ST_OK);
    assert_err(err, ST_DATA, words);
    plan_release(&plan);
}

static void refused_edit(const char *statements, const char *words)
{
    char edit[512];
    snprintf(edit, sizeof edit, EDIT "%s", statements);
    refused_with(ROOM "box crate from 1 1 to 2 2 top 1\nwindow w on south from 1 1 to 2 2\n", THINGS, edit, words);
}

/* The lines of texture.txt about things, after an edit. The caller frees them. */
static char *lines_after(const char *text, const char *statements)
{
    struct made m = {0};
    struct err err = ERR_INIT;
    char edit[512], *lines = calloc(1, 4096), *line = NULL;
    size_t size = 0;
    assert_non_null(lines);
    snprintf(edit, sizeof edit, EDIT "%s", statements);
    build(&m.base_plan, &m.solids[0], text, NULL);
    assert_ok(scripted_things(&m.plan, text, THINGS, edit, &err), err);
    assert_ok(layout_solids(&m.solids[1], &m.plan, &err), err);
    assert_ok(unite_solids(&m.base, &m.solids[0], NULL, &err), err);
    assert_ok(unite_solids(&m.edited, &m.solids[1], NULL, &err), err);
    assert_ok(solid_mesh_carry_ids(&m.edited, &m.base, &err), err);
    assert_ok(texture_rules_make(&m.map, &m.edited, &m.base, &m.plan, &err), err);
    assert_ok(texture_map_write(&m.map, scratch_path("texture.txt"), NULL, &err), err);
    FILE *file = fopen(scratch_path("texture.txt"), "r");
    assert_non_null(file);
    while (getline(&line, &size, file) > 0)
        if (!strncmp(line, "thing ", 6)) strcat(lines, line);
    fclose(file);
    free(line);
    release(&m);
    return lines;
}

/* wanted: the lines without the script and the line of the statement, which end each of them. */
static void after(const char *text, const char *statements, const char *wanted)
{
    char *lines = lines_after(text, statements), *to = lines;
    for (const char *from = lines; *from;) {
        const char *script = strstr(from, " edit.txt "), *end = strchr(from, '\n');
        assert_true(script && end && script < end);
        memmove(to, from, (size_t)(script - from));
        to += script - from;
        *to++ = '\n';
        from = end + 1;
    }
    *to = 0;
    assert_string_equal(lines, wanted);
    free(lines);
}

/* --------------------------------------------------------------------------------------------------- what edits do */

static void a_thing_that_no_statement_names_has_no_line(void **state)
{
    (void)state;
    after(ROOM, "clear hall\nmove east by 0.5\n", "");
}

static void things_are_cleared_and_kept_by_name(void **state)
{
    (void)state;
    after(ROOM, "clear table\nkeep low-chair\nclear hall\n", "thing table clear\nthing low-chair keep\n");
    after(ROOM, "keep sofa\nclear sofa\n", "thing sofa clear\n");
}

static void the_place_that_a_zone_keeps_is_still_a_zone(void **state)
{
    struct plan plan;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(
        scripted_things(&plan, ROOM, THINGS, EDIT "clear all\nclear sofa\nkeep from 1 1 to 2 2\nkeep table\n", &err),
        err);
    assert_int_equal(plan.zone_count, 2);
    assert_true(plan.zones[0].all && plan.zones[1].keep);
    assert_int_equal(plan.things[0].state, PLAN_THING_CLEARED);
    assert_int_equal(plan.things[1].state, PLAN_THING_KEPT);
    assert_int_equal(plan.things[2].state, PLAN_THING_LEFT);
    plan_release(&plan);
}

static void moves_add_up(void **state)
{
    (void)state;
    after(ROOM, "move sofa by 0.5 -0.25\n", "thing sofa move sofa 0.5 -0.25 0 0\n");
    after(ROOM, "move sofa by 0.5 -0.25\nmove sofa by 1 1 0.125\n", "thing sofa move sofa 1.5 0.75 0.125 0\n");
    after(ROOM, "move sofa by 0.5 0 0.5\nmove sofa by -0.5 1 -0.5\n", "thing sofa move sofa 0 1 0 0\n");
    after(ROOM, "keep sofa\nmove sofa by 0.5 1\n", "thing sofa move sofa 0.5 1 0 0\n");
}

static void turns_add_up(void **state)
{
    (void)state;
    after(ROOM, "move table by 0 0 turn 30\n", "thing table move table 0 0 0 30\n");
    after(ROOM, "move table by 0 1 turn 30\nmove table by 0.5 0 0.25 turn -45\n",
          "thing table move table 0.5 1 0.25 -15\n");
}

static void a_move_to_a_room_gives_the_place_and_its_floor(void **state)
{
    (void)state;
    after(TWO_FLOORS, "move table to left at 1 2\n", "thing table place table 1 2 0 0\n");
    after(TWO_FLOORS, "move table to right at 3 1.5 turn 90\n", "thing table place table 3 1.5 0.25 90\n");
    /* what was said before no longer matters, and what is said later counts from there */
    after(TWO_FLOORS, "move table by 5 5 5\nmove table to right at 3 1.5\n", "thing table place table 3 1.5 0.25 0\n");
    after(TWO_FLOORS, "move table to left at 1 2 turn 10\nmove table by 0.5 -0.5 0.25 turn 20\n",
          "thing table place table 1.5 1.5 0.25 30\n");
}

static void a_copy_stands_beside_its_thing(void **state)
{
    (void)state;
    after(ROOM, "copy sofa as second by 1 0\n", "thing second move sofa 1 0 0 0\n");
    after(ROOM, "copy sofa as second by 1 0 0.5 turn 180\n", "thing second move sofa 1 0 0.5 180\n");
    after(ROOM, "copy sofa as second by 1 0\nclear sofa\n", "thing sofa clear\nthing second move sofa 1 0 0 0\n");
}

static void a_copy_of_what_was_moved_stands_beside_the_new_place(void **state)
{
    (void)state;
    after(ROOM, "move sofa by 0.5 0.25 turn 30\ncopy sofa as second by 1 0 turn 15\nmove sofa by 0 0.5\n",
          "thing sofa move sofa 0.5 0.75 0 30\nthing second move sofa 1.5 0.25 0 45\n");
    after(TWO_FLOORS, "move sofa to right at 3 1\ncopy sofa as second by 0 1\n",
          "thing sofa place sofa 3 1 0.25 0\nthing second place sofa 3 2 0.25 0\n");
}

static void a_copy_is_moved_copied_and_cleared_like_a_thing(void **state)
{
    (void)state;
    after(ROOM, "copy sofa as second by 1 0\nmove second by 0 1\ncopy second as third by 0.5 0\n",
          "thing second move sofa 1 1 0 0\nthing third move sofa 1.5 1 0 0\n");
    after(TWO_FLOORS, "copy sofa as second by 1 0\nmove second to right at 3 1\n",
          "thing second place sofa 3 1 0.25 0\n");
    after(ROOM, "copy sofa as second by 1 0\ncopy second as third by 0.5 0\nclear second\n",
          "thing third move sofa 1.5 0 0 0\n");
}

static void each_line_names_the_statement_that_said_so_last(void **state)
{
    char *lines = lines_after(ROOM, "clear table\nmove sofa by 1 0\n\n# beside it\ncopy sofa as second by 0 1\n"
                                    "move sofa by 0 0.5\nkeep low-chair\n");
    struct plan plan;
    struct script script = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_string_equal(lines, "thing sofa move sofa 1 0.5 0 0 edit.txt 7\nthing table clear edit.txt 2\n"
                               "thing low-chair keep edit.txt 8\nthing second move sofa 1 1 0 0 edit.txt 6\n");
    free(lines);
    /* an edit that stands on another one */
    assert_ok(scripted_things(&plan, ROOM, THINGS, EDIT "move sofa by 1 0\nmove table by 1 0\n", &err), err);
    assert_ok(script_read(&script, scratch_write("more.txt", EDIT "\n\nmove table by 0 1\n"), &err), err);
    assert_ok(plan_apply(&plan, &script, true, NULL, &err), err);
    assert_string_equal(plan.things[0].script, "edit.txt");
    assert_int_equal(plan.things[0].said, 2);
    assert_string_equal(plan.things[1].script, "more.txt");
    assert_int_equal(plan.things[1].said, 4);
    assert_null(plan.things[2].script);
    script_release(&script);
    plan_release(&plan);
}

/* --------------------------------------------------------------------------------------------------------- refusals */

static void unknown_names_are_refused(void **state)
{
    (void)state;
    refused_edit("move sofaa by 1 1\n", "edit.txt:2: nothing is named sofaa yet; did you mean sofa?");
    refused_edit("clear sofaa\n", "edit.txt:2: nothing is named sofaa yet; did you mean sofa?");
    refused_edit("copy chiar as other by 1 1\n", "edit.txt:2: nothing is named chiar yet");
    refused_edit("keep tabel\n", "edit.txt:2: found tabel, wanted a thing of things.txt");
    refused_edit("move sofa to hal at 1 1\n", "edit.txt:2: nothing is named hal yet; did you mean hall?");
    refused_edit("move sofa to crate at 1 1\n", "edit.txt:2: crate is a box; wanted a room");
    refused_edit("copy crate as other by 1 1\n", "edit.txt:2: crate is a box; wanted \"texture\", or a thing");
}

static void a_thing_shares_its_name_with_nothing_in_the_model(void **state)
{
    static const char model[] = ROOM "box crate from 1 1 to 2 2 top 1\nwindow pane on south from 1 1 to 2 2\n"
                                     "hatch trap on hall from 3 1 to 3.5 2\n";
    static const struct {
        const char *name, *words;
    } cases[] = {
        {"north", "things.txt:3: the name north is used already, for a wall (line 6)"},
        {"hall", "things.txt:3: the name hall is used already, for a room (line 9)"},
        {"crate", "things.txt:3: the name crate is used already, for a box (line 10)"},
        {"pane", "things.txt:3: the name pane is used already, for an opening (line 11)"},
        {"trap", "things.txt:3: the name trap is used already, for an opening in a room (line 12)"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char things[256];
        snprintf(things, sizeof things, "remodel-marked-things 1\nthing sofa in v 1 1\nthing %s in v 1 1\n",
                 cases[i].name);
        refused_with(model, things, NULL, cases[i].words);
    }
}

static void what_an_edit_adds_does_not_take_the_name_of_a_thing(void **state)
{
    (void)state;
    refused_edit("move east by 0.5\nwall sofa from 1 0.5 to 3 0.5\n",
                 "edit.txt:3: the name sofa is used already, for a thing (line 3)");
    refused_edit("box table from 3 1 to 3.5 1.5 top 1\n",
                 "edit.txt:2: the name table is used already, for a thing (line 4)");
    refused_edit("clear low-chair\nwindow low-chair on north from 1 1 to 2 2\n",
                 "edit.txt:3: the name low-chair is used already, for a thing (line 6)");
}

static void a_copy_has_a_new_name(void **state)
{
    (void)state;
    refused_edit("copy sofa as table by 1 1\n", "edit.txt:2: the name table is used already, for a thing (line 4)");
    refused_edit("copy sofa as sofa by 1 1\n", "edit.txt:2: the name sofa is used already, for a thing (line 3)");
    refused_edit("copy sofa as hall by 1 1\n", "edit.txt:2: the name hall is used already, for a room (line 9)");
    refused_edit("copy sofa as crate by 1 1\n", "edit.txt:2: the name crate is used already, for a box");
    refused_edit("copy sofa as b by 1 1\ncopy table as b by 1 1\n",
                 "edit.txt:3: the name b is used already, for a thing (line 2)");
    refused_edit("copy sofa as b by 1 1\nbox b from 3 1 to 3.5 1.5 top 1\n",
                 "edit.txt:3: the name b is used already, for a thing (line 2)");
    refused_edit("remove crate\ncopy sofa as crate by 1 1\n",
                 "edit.txt:3: the name crate is used already, for a box that was removed (line 10)");
}

static void what_was_cleared_moves_no_more(void **state)
{
    (void)state;
    refused_edit("clear sofa\nmove sofa by 1 1\n", "edit.txt:3: sofa was cleared, so it cannot be moved");
    refused_edit("clear sofa\nmove sofa to hall at 1 1\n", "edit.txt:3: sofa was cleared, so it cannot be moved");
    refused_edit("clear sofa\ncopy sofa as second by 1 0\n", "edit.txt:3: sofa was cleared before");
    refused_edit("clear sofa\nkeep sofa\n", "edit.txt:3: sofa was cleared before, so it cannot be kept where it is");
}

static void only_a_thing_at_its_place_is_kept(void **state)
{
    (void)state;
    refused_edit("move sofa by 1 1\nkeep sofa\n", "edit.txt:3: sofa was moved before, so it cannot be kept");
    refused_edit("move sofa to hall at 1 1\nkeep sofa\n", "edit.txt:3: sofa was moved before, so it cannot be kept");
    refused_edit("copy sofa as b by 1 1\nkeep b\n", "edit.txt:3: b was moved before, so it cannot be kept");
    refused_edit("keep sofa\nkeep sofa\n", "edit.txt:3: sofa was kept before");
    refused_edit("keep hall\n", "edit.txt:2: found hall, wanted a thing of things.txt, \"in VIEW\" or \"from\"");
    refused_edit("keep all\n", "edit.txt:2: found all, wanted a thing of things.txt");
}

static void a_thing_moves_by_two_distances_or_more(void **state)
{
    (void)state;
    refused_edit("move sofa by 1\n", "edit.txt:2: a thing moves by two distances, in x and y: \"move sofa by DX DY");
    refused_edit("move sofa by 1 turn 30\n", "edit.txt:2: a thing moves by two distances");
    refused_edit("move sofa by turn 30\n", "edit.txt:2: ");
    refused_edit("move sofa by 1 2 3 4\n", "edit.txt:2: ");
    refused_edit("move sofa to hall at 1\n", "edit.txt:2: ");
    refused_edit("copy sofa as b by 1\n", "edit.txt:2: ");
    refused_edit("copy sofa as b by 1 turn 30\n", "edit.txt:2: ");
}

static void a_thing_is_cleared_and_kept_whole(void **state)
{
    (void)state;
    refused_edit("clear sofa foot 0.5\n", "edit.txt:2: sofa is a thing, which is cleared or kept whole");
    refused_edit("clear sofa top 0.5\n", "edit.txt:2: sofa is a thing, which is cleared or kept whole");
    refused_edit("keep sofa foot 0.1 top 0.5\n", "edit.txt:2: sofa is a thing, which is cleared or kept whole");
}

static void only_things_turn_and_move_to_rooms(void **state)
{
    (void)state;
    refused_edit("move south by 0.5 turn 30\n", "edit.txt:2: south is not a thing");
    refused_edit("move crate by 0.5 0.5 turn 30\n", "\"change crate turn DEGREES\"");
    refused_edit("move w by 0.1 turn 30\n", "edit.txt:2: w is not a thing");
    refused_edit("move crate to hall at 1 1\n", "edit.txt:2: crate is not a thing. Only things move to a room");
    refused_edit("copy texture wall/west/in from 1 1 to 2 2 to wall/east/in from 1 1 to 2 2 turn 30\n",
                 "edit.txt:2: a texture is not turned");
}

static void other_statements_do_not_take_things(void **state)
{
    static const char *const statements[] = {"change sofa top 1",  "adjust sofa from 1 1 to 2 2", "open sofa",
                                             "resize sofa left 1", "fill sofa with wall",         "join sofa east"};
    (void)state;
    for (size_t i = 0; i < sizeof statements / sizeof *statements; i++) {
        char line[64];
        snprintf(line, sizeof line, "%s\n", statements[i]);
        refused_edit(line, "edit.txt:2: sofa is a thing; wanted ");
    }
    refused_edit("texture sofa stretch\n", "edit.txt:2: sofa is a thing; wanted ");
    refused_edit("remove sofa\n", "edit.txt:2: sofa is a thing, which is left out by \"clear sofa\"");
}

static void a_statement_that_leaves_a_thing_as_it_was_is_refused(void **state)
{
    (void)state;
    refused_edit("move sofa by 0 0\n", "edit.txt:2: the statement changes nothing");
    refused_edit("clear sofa\nclear sofa\n", "edit.txt:3: the statement changes nothing");
    refused_edit("move sofa by 1 1\nmove sofa by 0 0\n", "edit.txt:3: the statement changes nothing");
    refused_edit("move sofa to hall at 1 1\nmove sofa to hall at 1 1\n", "edit.txt:3: the statement changes nothing");
}

static void the_unedited_model_moves_no_things(void **state)
{
    static const char *const edits[] = {"copy sofa as b by 1 1", "clear sofa", "keep sofa"};
    struct plan plan;
    struct script script = {0};
    struct err err = ERR_INIT;
    (void)state;
    only_for_edits(ROOM, edits, sizeof edits / sizeof *edits);
    /* the script of the model is read before the names of things are known */
    refused(ROOM "move sofa by 1 1\n", NULL, "model.txt:10: nothing is named sofa yet");
    assert_ok(scripted_things(&plan, ROOM, THINGS, NULL, &err), err);
    assert_ok(script_read(&script, scratch_write("more.txt", EDIT "move sofa by 1 1\n"), &err), err);
    assert_int_equal(plan_apply(&plan, &script, false, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "more.txt:2: \"move THING\" is for edits");
    script_release(&script);
    plan_release(&plan);
}

static void a_file_of_names_that_is_wrong_is_refused_with_its_line(void **state)
{
    (void)state;
    refused_with(ROOM, "remodel-marked-things 2\n", NULL, "things.txt:1: ");
    refused_with(ROOM, "remodel-marked-things 1\nthing 7 in v 1 1\n", NULL, "things.txt:2: found \"7\"");
    refused_with(ROOM, "remodel-marked-things 1\nthing sofa in v 1 1\nthing sofa at v 1 1\n", NULL, "things.txt:3: ");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_thing_that_no_statement_names_has_no_line),
        cmocka_unit_test(things_are_cleared_and_kept_by_name),
        cmocka_unit_test(the_place_that_a_zone_keeps_is_still_a_zone),
        cmocka_unit_test(moves_add_up),
        cmocka_unit_test(turns_add_up),
        cmocka_unit_test(a_move_to_a_room_gives_the_place_and_its_floor),
        cmocka_unit_test(a_copy_stands_beside_its_thing),
        cmocka_unit_test(a_copy_of_what_was_moved_stands_beside_the_new_place),
        cmocka_unit_test(a_copy_is_moved_copied_and_cleared_like_a_thing),
        cmocka_unit_test(each_line_names_the_statement_that_said_so_last),
        cmocka_unit_test(unknown_names_are_refused),
        cmocka_unit_test(a_thing_shares_its_name_with_nothing_in_the_model),
        cmocka_unit_test(what_an_edit_adds_does_not_take_the_name_of_a_thing),
        cmocka_unit_test(a_copy_has_a_new_name),
        cmocka_unit_test(what_was_cleared_moves_no_more),
        cmocka_unit_test(only_a_thing_at_its_place_is_kept),
        cmocka_unit_test(a_thing_moves_by_two_distances_or_more),
        cmocka_unit_test(a_thing_is_cleared_and_kept_whole),
        cmocka_unit_test(only_things_turn_and_move_to_rooms),
        cmocka_unit_test(other_statements_do_not_take_things),
        cmocka_unit_test(a_statement_that_leaves_a_thing_as_it_was_is_refused),
        cmocka_unit_test(the_unedited_model_moves_no_things),
        cmocka_unit_test(a_file_of_names_that_is_wrong_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
