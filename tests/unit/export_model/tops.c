/* tops.c - upper edges of walls and parts of ceilings, found again from plan.txt; the IFC file that holds them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stages/build_model/building/plan_file.h"
#include "stages/build_model/solid/unite.h"
#include "stages/export_model/ceiling_parts.h"
#include "stages/export_model/wall_top.h"
#include "stages/export_model/writers.h"
#include "tests/unit/build_model/scripted.h"

struct scene {
    struct plan plan;
    struct solid_list solids;
    struct model_plan read;
};

static void make(struct scene *s, const char *text)
{
    struct err err = ERR_INIT;
    build(&s->plan, &s->solids, text, NULL);
    assert_ok(plan_write(&s->plan, scratch_path("plan.txt"), NULL, &err), err);
    assert_ok(model_plan_read(&s->read, scratch_path("plan.txt"), NULL, &err), err);
}

static void release(struct scene *s)
{
    model_plan_release(&s->read);
    drop(&s->plan, &s->solids);
}

/* The upper edge of a wall is the given one: S and z of its corners. */
static void expect_top(const struct scene *s, const char *wall, double from, double to, const double (*wanted)[2],
                       int count)
{
    double(*top)[2] = NULL;
    int found = -1;
    struct err err = ERR_INIT;
    assert_ok(
        wall_top_find(&top, &found, &s->read, model_plan_find_wall(&s->read, wall), (const double[2]){from, to}, &err),
        err);
    assert_int_equal(found, count);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) assert_float_equal(top[i][k], wanted[i][k], 1e-9);
    free(top);
}

static void walls_under_level_ceilings_are_level(void **state)
{
    struct scene s;
    (void)state;
    make(&s, TWO);
    static const char *const names[] = {"south", "west", "north", "east", "middle"};
    for (int i = 0; i < 5; i++) expect_top(&s, names[i], -0.2, i % 2 ? 3.2 : 4.2, NULL, 0);
    release(&s);
}

/* The room is 4 x 3, its walls are 0.2 thick. */
static void the_wall_of_a_gable_has_a_ridge(void **state)
{
    struct scene s;
    (void)state;
    make(&s, ROOM "gable hall from south 2.5 to north 2.5 ridge 3.5\n");
    const double slope = 1 / 1.5, end = 2.5 - 0.2 * slope;
    expect_top(&s, "west", -0.2, 3.2, (const double[3][2]){{-0.2, end}, {1.5, 3.5}, {3.2, end}}, 3);
    expect_top(&s, "east", -0.2, 3.2, (const double[3][2]){{-0.2, end}, {1.5, 3.5}, {3.2, end}}, 3);
    /* the eaves: level at the inner face */
    expect_top(&s, "south", -0.2, 4.2, (const double[2][2]){{-0.2, 2.5}, {4.2, 2.5}}, 2);
    release(&s);
    make(&s, ROOM "slope hall from south 2 to north 3.5\n");
    expect_top(&s, "east", 0, 3, (const double[2][2]){{0, 2}, {3, 3.5}}, 2);
    release(&s);
}

/* Two rooms of different heights: the outer wall steps in the middle of the partition, which is 0.1 thick at x 2. */
static void a_wall_steps_from_one_ceiling_to_another(void **state)
{
    struct scene s;
    (void)state;
    make(&s, TWO "change right ceiling 3\n");
    const double at = s.read.walls[model_plan_find_wall(&s.read, "middle")].offset; /* its face towards one room */
    double steps[4][2] = {{-0.2, 2.5}, {0, 2.5}, {0, 3}, {4.2, 3}};
    double(*top)[2] = NULL;
    int count;
    struct err err = ERR_INIT;
    assert_ok(
        wall_top_find(&top, &count, &s.read, model_plan_find_wall(&s.read, "north"), (const double[]){-0.2, 4.2}, &err),
        err);
    assert_int_equal(count, 4);
    steps[1][0] = steps[2][0] = top[1][0];
    assert_true(fabs(top[1][0] - fabs(at)) <= 0.1 + 1e-9);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 2; k++) assert_float_equal(top[i][k], steps[i][k], 1e-9);
    free(top);
    expect_top(&s, "middle", 0, 3, (const double[2][2]){{0, 3}, {3, 3}}, 2); /* the higher of both sides */
    release(&s);
}

static void a_wall_with_a_top_of_its_own_keeps_it(void **state)
{
    struct scene s;
    (void)state;
    make(&s, TWO "change middle top 2\ngable right from south 2.5 to north 2.5 ridge 3.5\n");
    expect_top(&s, "middle", 0, 3, NULL, 0);
    release(&s);
}

/* --------------------------------------------------------------------------------------------------------- ceilings */

static double area_of(const double (*p)[2], int count)
{
    double twice = 0;
    for (int i = 0; i < count; i++) {
        const double *a = p[i], *b = p[(i + 1) % count];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return twice / 2;
}

static void a_gable_parts_the_outline_at_its_ridge(void **state)
{
    struct scene s;
    struct ceiling_parts parts;
    struct err err = ERR_INIT;
    (void)state;
    make(&s, ROOM "gable hall from south 2.5 to north 2.5 ridge 3.5 at 1\n");
    assert_ok(ceiling_parts_make(&parts, &s.read.rooms[0], &err), err);
    assert_int_equal(parts.outline_count, 6);
    assert_float_equal(area_of((const double(*)[2])parts.outline, 6), 12, 1e-9);
    const double a = area_of((const double(*)[2])parts.corners[0], parts.counts[0]);
    const double b = area_of((const double(*)[2])parts.corners[1], parts.counts[1]);
    assert_float_equal(fmin(a, b), 4, 1e-9);
    assert_float_equal(a + b, 12, 1e-9);
    ceiling_parts_release(&parts);
    release(&s);
    make(&s, ROOM "slope hall from south 2 to north 3\n");
    assert_ok(ceiling_parts_make(&parts, &s.read.rooms[0], &err), err);
    assert_true(parts.outline_count == 4 && parts.counts[0] == 4 && parts.counts[1] == 0);
    ceiling_parts_release(&parts);
    release(&s);
}

/* A room of 4 x 4 without the quarter at its upper right; the ridge runs along x at y 3, through its upper arm. */
static void a_ridge_may_cross_an_outline_with_a_notch(void **state)
{
    struct scene s;
    struct ceiling_parts parts;
    struct err err = ERR_INIT;
    (void)state;
    make(&s, "remodel-script 1\nset thickness 0.2\n"
             "wall a from 4 0 to 0 0\nwall b from 0 0 to 0 4\nwall c from 0 4 to 2 4\nwall d from 2 4 to 2 2\n"
             "wall e from 2 2 to 4 2\nwall f from 4 2 to 4 0\njoin a b c d e f a\nroom hall a b c d e f\n"
             "gable hall from a 2.5 to c 2.5 ridge 3.5 at 3\n");
    assert_ok(ceiling_parts_make(&parts, &s.read.rooms[0], &err), err);
    double areas[2];
    for (int k = 0; k < 2; k++) areas[k] = area_of((const double(*)[2])parts.corners[k], parts.counts[k]);
    assert_float_equal(fmin(areas[0], areas[1]), 2, 1e-9);
    assert_float_equal(fmax(areas[0], areas[1]), 10, 1e-9);
    ceiling_parts_release(&parts);
    release(&s);
}

/* ------------------------------------------------------------------------------------------------------------- IFC */

/* Each number of the file is given once, and those that are named are given; numbers are finite. */
static void expect_whole_step_file(const char *text, int *lines)
{
    enum { MAX_ID = 20000 };
    static bool given[MAX_ID];
    memset(given, 0, sizeof given);
    *lines = 0;
    for (const char *at = strstr(text, "\n#"); at; at = strstr(at + 1, "\n#")) {
        const int id = atoi(at + 2);
        assert_true(id > 0 && id < MAX_ID && !given[id]);
        given[id] = true;
        ++*lines;
    }
    bool quoted = false;
    for (const char *at = strstr(text, "DATA;"); *at; at++) {
        if (*at == '\'') quoted = !quoted;
        if (*at == '#' && !quoted) assert_true(given[atoi(at + 1)]);
    }
    assert_null(strstr(text, "NAN"));
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
}

static int count_words(const char *text, const char *word)
{
    int n = 0;
    for (const char *at = text; (at = strstr(at, word)); at += strlen(word)) n++;
    return n;
}

static void sloping_slabs_leaves_and_panes_are_in_the_ifc_file(void **state)
{
    struct scene s;
    struct solid_mesh mesh = {0};
    struct atlas atlas = {0};
    struct export_faces faces = {0};
    struct err err = ERR_INIT;
    char *text;
    int lines;
    (void)state;
    make(&s, ROOM "gable hall from south 2.5 to north 2.5 ridge 3.5\nskylight sky on hall from 1 0.5 to 1.5 2\n"
                  "hatch trap on hall from 3 1 to 3.5 1.5 closed\ndoor shut on east from 1 0 to 2 2 closed\n"
                  "door ajar on south from 1 0 to 2 2\npassage way on south from 2.5 0 to 3 2\n"
                  "window pane on north from 1 1 to 2 2\nwindow hole on north from 2.5 1 to 3 2 open\n");
    assert_ok(unite_solids(&mesh, &s.solids, NULL, &err), err);
    assert_ok(export_faces_make(&faces, &mesh, NULL, &atlas, &err), err);
    const struct export_objects none = {.meshes = NULL};
    const struct export_things no_things = {.things = NULL};
    const struct export_lamps no_lamps = {.planned = {.count = 0}};
    const struct export_scene scene = {.name = "room",
                                       .mesh = &mesh,
                                       .faces = &faces,
                                       .plan = &s.read,
                                       .objects = &none,
                                       .metric = true,
                                       .out = scratch,
                                       .things = &no_things,
                                       .lamps = &no_lamps};
    assert_ok(write_ifc(&scene, &err), err);
    text = scratch_read(scratch_path("model.ifc"));
    expect_whole_step_file(text, &lines);
    assert_true(lines > 200);
    assert_int_equal(count_words(text, "=IFCSLAB("), 3);
    assert_int_equal(count_words(text, "=IFCPOLYGONALFACESET("), 1); /* the space */
    assert_int_equal(count_words(text, "=IFCINDEXEDPOLYGONALFACE("), 1 + 6 + 2);
    /* the skylight is under both planes; the hatch, the doors, the passage and the windows are in one element each */
    assert_int_equal(count_words(text, "=IFCOPENINGELEMENT("), 2 + 1 + 5);
    assert_int_equal(count_words(text, "=IFCRELVOIDSELEMENT("), 8);
    assert_int_equal(count_words(text, "=IFCDOOR("), 3);
    assert_int_equal(count_words(text, "=IFCWINDOW("), 3);
    assert_int_equal(count_words(text, "=IFCRELFILLSELEMENT("), 6);
    /* what stands open has no body */
    const char *ajar = strstr(strstr(text, "=IFCDOOR("), "'ajar'"), *hole = strstr(text, "'hole'");
    assert_non_null(ajar);
    assert_non_null(strstr(hole, ",$,$,"));
    assert_int_equal(strncmp(strchr(strchr(ajar, '#') + 1, ','), ",$,$,2.,1.,.DOOR.", 17), 0);
    free(text);
    export_faces_release(&faces);
    solid_mesh_release(&mesh);
    release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(walls_under_level_ceilings_are_level),
        cmocka_unit_test(the_wall_of_a_gable_has_a_ridge),
        cmocka_unit_test(a_wall_steps_from_one_ceiling_to_another),
        cmocka_unit_test(a_wall_with_a_top_of_its_own_keeps_it),
        cmocka_unit_test(a_gable_parts_the_outline_at_its_ridge),
        cmocka_unit_test(a_ridge_may_cross_an_outline_with_a_notch),
        cmocka_unit_test(sloping_slabs_leaves_and_panes_are_in_the_ifc_file),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
