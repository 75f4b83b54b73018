/* draft.c - where an edited room takes the colours of a photo's pixels: a room of 4 x 3 x 2.5 m, seen by two cameras
 * that look south, a from (2, 1.5, 1.25) and b from (0.9, 1.2, 0.6). A point x, y, z is at
 * u = 200 + 200 (cx - x) / (cy - y) and v = 150 + 200 (cz - z) / (cy - y). */
#include <math.h>
#include <string.h>

#include "tests/unit/build_model/live_room.h"

static const char script_text[] = LIVE_ROOM "box chest from 1.9 0.5 to 2.1 0.7 top 0.8\n";
enum { A, B, WIDTH = 400, HEIGHT = 300 };
enum { PIXEL, COLOUR, UNSEEN };
static const double eyes[2][3] = {{2, 1.5, 1.25}, {0.9, 1.2, 0.6}};

static int make_files(void **state)
{
    return live_room_make(state, script_text,
                          "1 " LIVE_SOUTH "2 1.25 1.5 1 a.exr\n\n2 " LIVE_SOUTH "0.9 0.6 1.2 1 b.exr\n\n",
                          "remodel-lenses 1\na a" LIVE_LENS "b b" LIVE_LENS);
}

static void where(double at[2], int photo, double x, double y, double z)
{
    const double *eye = eyes[photo], away = eye[1] - y;
    at[0] = 200 + 200 * (eye[0] - x) / away;
    at[1] = 150 + 200 * (eye[2] - z) / away;
}

/* Furniture: a panel 0.4 m wide at x, 0.5 m before the south wall and 0.9 m high. */
static void add_panel(const char *name, double x)
{
    const float a = (float)x - 0.2f, b = (float)x + 0.2f;
    const float corners[2][9] = {{a, 0.5f, 0, b, 0.5f, 0, b, 0.5f, 0.9f}, {a, 0.5f, 0, b, 0.5f, 0.9f, a, 0.5f, 0.9f}};
    assert_int_equal(live_thing(name, x, 0.5, 0.3, 0.37, 0), 0);
    const int thing = live_draft_gone() - 1;
    float *to = live_thing_corners(thing, 2);
    assert_non_null(to);
    memcpy(to, corners, sizeof corners);
}

static void draft(const char *edit, const char *things)
{
    char text[256], path[512], folder[512], names[512] = "";
    snprintf(text, sizeof text, "remodel-script 1\n%s\n", edit);
    snprintf(path, sizeof path, "%s", scratch_write("edits/e.txt", text));
    snprintf(folder, sizeof folder, "%s", scratch_path("edits"));
    snprintf(text, sizeof text, "remodel-marked-things 1\n%s", things);
    if (*things) snprintf(names, sizeof names, "%s", scratch_write("things.txt", text));
    char *model = strdup(scratch_path("model.txt"));
    if (live_build(model, names, path, folder, "") || live_draft(model, names)) fail_msg("%s", live_error());
    free(model);
}

static void begin(const char *edit)
{
    if (live_begin(scratch_path("views"), scratch_path("axes.txt"), "", "")) fail_msg("%s", live_error());
    draft(edit, "");
}

/* The cell of a photo that is so fine that its middle is the pixel. */
static const double *cell_at(int photo, const double at[2])
{
    const int columns = 100 * WIDTH, rows = 100 * HEIGHT, x = (int)(100 * at[0]), y = (int)(100 * at[1]);
    /* one row has many cells: the numbers of the wanted one */
    assert_int_equal(live_draft_rows(photo, columns, rows, y, 1), columns);
    return live_numbers() + 5 * (size_t)x;
}

static void assert_pixel(const double *cell, int photo, const double at[2])
{
    assert_int_equal((int)cell[0], PIXEL);
    assert_int_equal((int)cell[1], photo);
    /* cells are 0.01 px wide; a place may be twice as near to the other camera */
    assert_float_equal(cell[2], at[0], 0.05);
    assert_float_equal(cell[3], at[1], 0.05);
}

static void what_stays_is_the_photos_own_pixel(void **state)
{
    double at[2];
    (void)state;
    begin("remove chest");
    where(at, A, 3.2, 0, 0.4);
    assert_pixel(cell_at(A, at), A, at);
    where(at, A, 2, 0, 1.5); /* outdoors, through the window */
    assert_pixel(cell_at(A, at), A, at);
}

/* The south wall comes 0.5 m closer, and carries its texture along. */
static void a_wall_that_moves_shows_what_was_on_it(void **state)
{
    double at[2], from[2];
    (void)state;
    begin("move south by -0.5");
    where(at, A, 2.5, 0.5, 0.6);
    where(from, A, 2.5, 0, 0.6);
    assert_pixel(cell_at(A, at), A, from);
}

/* Behind the chest, a sees the wall nowhere, and b does. */
static void what_comes_to_light_is_taken_from_another_photo(void **state)
{
    double at[2], from[2];
    (void)state;
    begin("remove chest");
    where(at, A, 2, 0.7, 0.75);
    where(from, B, 2, 0, 0.3125);
    assert_pixel(cell_at(A, at), B, from);
    /* b sees only furniture there */
    assert_int_equal(live_thing("sofa", 1, 0.5, 0.3, 0.4, 0), 0);
    unsigned char *mask = live_mask(B, 40, 30);
    memset(mask, 1, 40 * 30);
    assert_int_equal((int)cell_at(A, at)[0], UNSEEN);
}

static void furniture_stays_or_goes(void **state)
{
    double at[2], from[2];
    (void)state;
    begin("clear all");
    live_thing("sofa", 2, 0.4, 0.3, 0.3, 0);
    live_thing("beam", 2, 0.4, 2.4, 0.3, 1);
    memset(live_mask(A, 1, 1), 1, 1);
    char *model = strdup(scratch_path("model.txt"));
    if (live_draft(model, "")) fail_msg("%s", live_error());
    free(model);
    assert_int_equal(live_draft_gone(), 2);
    assert_true(live_numbers()[0] == 1 && live_numbers()[1] == 0);
    where(at, A, 1.5, 0, 0.4); /* wall that a shows as furniture, and b as it is */
    where(from, B, 1.5, 0, 0.4);
    assert_pixel(cell_at(A, at), B, from);
    begin("clear from 0 2 to 4 3"); /* elsewhere: the sofa stays */
    live_thing("sofa", 2, 0.4, 0.3, 0.3, 0);
    memset(live_mask(A, 1, 1), 1, 1);
    assert_pixel(cell_at(A, at), A, at);
}

/* A panel at x = 1.4 goes to x = 2.8: there a sees it as b sees it where it was, because b looks at it
 * more as a does. */
static void furniture_stands_at_its_new_place(void **state)
{
    double at[2], from[2];
    (void)state;
    begin("remove chest");
    add_panel("sofa", 1.4);
    memset(live_mask(A, 1, 1), 1, 1);
    memset(live_mask(B, 1, 1), 1, 1);
    draft("remove chest\nmove sofa by 1.4 0", "thing sofa in a 200 200\n");
    where(at, A, 2.7, 0.5, 0.7);
    where(from, B, 1.3, 0.5, 0.7);
    assert_pixel(cell_at(A, at), B, from);
    assert_int_equal(live_draft_placed(), 1);
    const double *n = live_numbers();
    assert_true(n[0] == 0 && fabs(n[1] - 2.8) < 1e-9 && fabs(n[2] - 0.5) < 1e-9);
    /* turned by half a turn: its left end is its right one, and its back is seen, which no photo shows from there: a
     * panel has no thickness, so the nearest photo counts */
    draft("remove chest\nmove sofa by 1.4 0 turn 180", "thing sofa in a 200 200\n");
    where(from, B, 1.5, 0.5, 0.7);
    const double *cell = cell_at(A, at);
    assert_int_equal((int)cell[0], PIXEL);
    if ((int)cell[1] == A) where(from, A, 1.5, 0.5, 0.7);
    assert_float_equal(cell[2], from[0], 0.05);
    assert_float_equal(cell[3], from[1], 0.05);
}

/* A copy; the first one stays, and stands before it. */
static void furniture_that_stays_hides_a_copy_behind_it(void **state)
{
    double at[2], from[2];
    (void)state;
    begin("remove chest");
    add_panel("sofa", 1.4);
    memset(live_mask(A, 1, 1), 1, 1);
    memset(live_mask(B, 1, 1), 1, 1);
    draft("remove chest\ncopy sofa as other by 0.1 -0.2", "thing sofa in a 200 200\n");
    assert_int_equal(live_draft_placed(), 1);
    where(at, A, 1.4, 0.5, 0.7);
    assert_pixel(cell_at(A, at), A, at);
    draft("remove chest\ncopy sofa as other by 0.1 0.2", "thing sofa in a 200 200\n");
    where(at, A, 1.4, 0.7, 0.7); /* before it: 0.1 left of where the first one has it */
    where(from, A, 1.3, 0.5, 0.7);
    const double *cell = cell_at(A, at);
    if ((int)cell[1] == B) where(from, B, 1.3, 0.5, 0.7);
    assert_pixel(cell, (int)cell[1], from);
}

/* A thing that no photo shows is striped at its new place. */
static void furniture_that_no_mask_shows_is_unseen(void **state)
{
    double at[2];
    (void)state;
    begin("remove chest");
    add_panel("sofa", 1.4);
    draft("remove chest\nmove sofa by 1.4 0", "thing sofa in a 200 200\n");
    where(at, A, 2.7, 0.5, 0.7);
    assert_int_equal((int)cell_at(A, at)[0], UNSEEN);
}

/* A square of 0.4 m that faces north, its colour brightest where it faces the camera. */
static void an_object_is_a_shaded_shape(void **state)
{
    double at[2];
    (void)state;
    begin("remove chest");
    scratch_write("edits/card.obj", "v -0.2 0 0\nv -0.2 0 0.4\nv 0.2 0 0.4\nv 0.2 0 0\nf 1 2 3 4\n");
    draft("remove chest\nobject card card.obj at 2.8 0.5 0.5 matt 0.2 0.4 0.6", "");
    where(at, A, 2.7, 0.5, 0.7);
    const double *cell = cell_at(A, at), away = sqrt(0.7 * 0.7 + 1 + 0.55 * 0.55), light = 0.5 + 0.25 / away;
    assert_int_equal((int)cell[0], COLOUR);
    for (int c = 0; c < 3; c++) assert_float_equal(cell[2 + c], 0.2 * (c + 1) * light, 1e-4);
    where(at, A, 2.5, 0.5, 0.7); /* beside it is the wall */
    assert_int_equal((int)cell_at(A, at)[0], PIXEL);
    assert_int_equal(live_draft_placed(), 1);
    assert_true(live_numbers()[0] == -1 && fabs(live_numbers()[3] - 0.7) < 1e-9);
}

static void a_painted_surface_has_its_colour(void **state)
{
    double at[2];
    (void)state;
    begin("colour box/chest 0.1 0.2 0.3");
    where(at, A, 2, 0.7, 0.75);
    const double *cell = cell_at(A, at);
    assert_int_equal((int)cell[0], COLOUR);
    for (int c = 0; c < 3; c++) assert_float_equal(cell[2 + c], 0.1 * (c + 1), 1e-6);
}

/* Of the wider window, b sees what lies outdoors in the same direction, at the same pixel: both look the same way. */
static void outdoors_is_looked_up_by_direction(void **state)
{
    double at[2];
    (void)state;
    begin("resize sunny left 0.4");
    where(at, A, 3.2, 0, 1.9);
    assert_pixel(cell_at(A, at), B, at);
}

static void two_photos_share_places(void **state)
{
    (void)state;
    begin("remove chest");
    const int count = live_shared(A, B, 20, 15);
    assert_true(count > 20);
    int on_wall = 0;
    for (int i = 0; i < count; i++) {
        /* of the south wall, whose place follows from the first pixel */
        const double *p = live_numbers() + 4 * i, x = 2 - (p[0] - 200) * 1.5 / 200, z = 1.25 - (p[1] - 150) * 1.5 / 200;
        double at[2];
        if (x < 0.1 || x > 3.9 || z < 0.1 || z > 2.4 || (x > 0.9 && x < 3.1 && z > 0.9 && z < 2.1)) continue;
        if (fabs(x - 2) < 0.5 && z < 1) continue; /* the chest */
        where(at, B, x, 0, z);
        assert_float_equal(p[2], at[0], 1e-6);
        assert_float_equal(p[3], at[1], 1e-6);
        on_wall++;
    }
    assert_true(on_wall > 5);
}

static void without_a_model_there_is_no_draft(void **state)
{
    (void)state;
    begin("remove chest");
    char *model = strdup(scratch_path("model.txt"));
    assert_int_equal(live_build(model, "", "", "", ""), 0);
    free(model);
    assert_int_equal(live_draft_rows(A, 4, 3, 0, 3), -1);
    assert_contains(live_error(), "the draft of an edit was not begun");
    assert_null(live_mask(7, 4, 3));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_stays_is_the_photos_own_pixel),
        cmocka_unit_test(a_wall_that_moves_shows_what_was_on_it),
        cmocka_unit_test(what_comes_to_light_is_taken_from_another_photo),
        cmocka_unit_test(furniture_stays_or_goes),
        cmocka_unit_test(furniture_stands_at_its_new_place),
        cmocka_unit_test(furniture_that_stays_hides_a_copy_behind_it),
        cmocka_unit_test(furniture_that_no_mask_shows_is_unseen),
        cmocka_unit_test(an_object_is_a_shaded_shape),
        cmocka_unit_test(a_painted_surface_has_its_colour),
        cmocka_unit_test(outdoors_is_looked_up_by_direction),
        cmocka_unit_test(two_photos_share_places),
        cmocka_unit_test(without_a_model_there_is_no_draft),
    };
    return cmocka_run_group_tests_name("draft", tests, make_files, live_room_end);
}
