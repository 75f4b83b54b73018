/* live.c - what a page calls: a room of 4 x 3 x 2.5 m, seen by a camera in its middle that looks south. */
#include <math.h>

#include "tests/unit/build_model/live_room.h"

static const char script_text[] = LIVE_ROOM;

static int make_files(void **state)
{
    return live_room_make(state, script_text, "1 " LIVE_SOUTH "2 1.25 1.5 1 a.exr\n\n",
                          "remodel-lenses 1\na a" LIVE_LENS);
}

static void begin(void)
{
    if (live_begin(scratch_path("views"), scratch_path("axes.txt"), "", "")) fail_msg("%s", live_error());
}

static int build(const char *text) { return live_build(scratch_write("model.txt", text), "", "", "", ""); }

static void a_model_is_built_and_described(void **state)
{
    (void)state;
    begin();
    assert_contains(live_photos(), "\"id\":\"a\",\"width\":400,\"height\":300");
    assert_float_equal(live_ceiling(), 2.5, 0);
    assert_int_equal(build(script_text), 0);
    const char *model = live_model();
    assert_contains(model, "{\"name\":\"south\",\"line\":2,");
    assert_contains(model, "{\"name\":\"sunny\",\"line\":8,\"kind\":\"window\",\"wall\":\"south\",\"fill\":\"glass\"");
    assert_contains(model, "\"name\":\"glass/sunny/in\"");
    assert_contains(model, "\"walls\":[\"south\",\"west\",\"north\",\"east\"]");
    assert_int_equal(live_write(scratch_path("out")), 0);
    assert_int_equal(access(scratch_path("out/model.txt"), R_OK), 0);
}

static void what_is_refused_leaves_the_last_model(void **state)
{
    char text[sizeof script_text + 64];
    (void)state;
    begin();
    assert_null(live_model());
    assert_int_equal(build(script_text), 0);
    snprintf(text, sizeof text, "%swindow b on south from 2 1 to 3.5 2\n", script_text);
    assert_int_not_equal(build(text), 0);
    assert_contains(live_error(), "model.txt:9: ");
    assert_contains(live_model(), "\"name\":\"sunny\"");
    assert_lacks(live_model(), "\"name\":\"b\"");
}

/* The camera is at (2, 1.5, 1.25): the middle of the photo shows the middle of the window, 1.5 m away. */
static void pixels_and_places_belong_together(void **state)
{
    (void)state;
    begin();
    assert_int_equal(live_ray(0, 200, 150), 0);
    const double looks[6] = {2, 1.5, 1.25, 0, -1, 0};
    for (int i = 0; i < 6; i++) assert_float_equal(live_numbers()[i], looks[i], 1e-9);
    assert_int_equal(live_project(0, 0.5, 0, 0.25), 0);
    assert_float_equal(live_numbers()[0], 200 + 200 * 1.5 / 1.5, 1e-6);
    assert_float_equal(live_numbers()[1], 150 + 200 * 1.0 / 1.5, 1e-6);
    assert_int_equal(build(script_text), 0);
    assert_int_equal(live_pick(0, 390, 150), 0); /* x = 2 - 1.5 * 190 / 200 */
    assert_string_equal(live_picked(), "wall/south/in");
    assert_float_equal(live_numbers()[0], 2 - 1.5 * 0.95, 1e-9);
    assert_float_equal(live_numbers()[1], 0, 1e-9);
    assert_int_equal(live_pick(0, 200, 150), 0);
    assert_string_equal(live_picked(), "glass/sunny/in");
    assert_int_not_equal(live_ray(0, 500, 150), 0);
    assert_int_not_equal(live_ray(1, 200, 150), 0);
    assert_contains(live_error(), "found photo 1, wanted 0 to 0");
}

/* The window's head, at z = 2 on the inner face, is a line from u = 66.7 to 333.3 at v = 50. The front of the shelf,
 * from v = 164.3 to 221.4, hides its lower edge at the back, from u = 140 to 260 at v = 200. */
static void edges_are_seen_or_hidden(void **state)
{
    char text[sizeof script_text + 64];
    (void)state;
    begin();
    assert_int_equal(live_edges(0, 1), 0);
    snprintf(text, sizeof text, "%sbox shelf from 1.7 0.5 to 2.3 0.8 foot 1 top 1.2\n", script_text);
    assert_int_equal(build(text), 0);
    const int count = live_edges(0, 1);
    int head = 0, back = 0, back_seen = 0, glass = 0;
    for (int i = 0; i < count; i++) {
        const double *d = live_numbers() + 3 * i;
        const int flags = (int)d[2];
        const bool is_back = fabs(d[1] - 200) < 0.01 && d[0] > 142 && d[0] < 258;
        glass += (flags & 2) != 0;
        head += (flags & 1) && fabs(d[1] - 50) < 0.01 && d[0] > 67 && d[0] < 333;
        back += is_back;
        back_seen += is_back && flags & 1;
    }
    assert_true(head > 200);
    assert_true(back > 80);
    assert_int_equal(back_seen, 0);
    assert_true(glass > 100);
    assert_int_equal(live_edges(3, 1), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_model_is_built_and_described),
        cmocka_unit_test(what_is_refused_leaves_the_last_model),
        cmocka_unit_test(pixels_and_places_belong_together),
        cmocka_unit_test(edges_are_seen_or_hidden),
    };
    return cmocka_run_group_tests_name("live", tests, make_files, live_room_end);
}
