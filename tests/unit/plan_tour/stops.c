/* Where a tour stops: in each room that can be reached, or where tour.txt says. */
#include "tests/unit/plan_tour/walk.h"

static const struct box open_flat[] = {HALL_OUTSIDE, HALL_INSIDE, PARTITION_WITH_GAP};
static const struct box parted_flat[] = {HALL_OUTSIDE, HALL_INSIDE, PARTITION};
/* p1 and p2 in the west, p2 nearer to its middle; p3 in the gap; p4 in the east */
static const struct place places[] = {
    {"p1", {-2.5, -1.5, 1.5}, 0}, {"p2", {-1.4, 0.2, 1.5}, 0}, {"p3", {0, 1.4, 1.5}, 0}, {"p4", {2, 0, 1.5}, 90}};

static struct model_room_corner west_corners[] = {
    {.x = -3, .y = -2}, {.x = 0, .y = -2}, {.x = 0, .y = 2}, {.x = -3, .y = 2}};
static struct model_room_corner east_corners[] = {
    {.x = 0.01, .y = -2}, {.x = 3, .y = -2}, {.x = 3, .y = 2}, {.x = 0.01, .y = 2}};
static struct model_room rooms[] = {
    {.name = (char *)"west", .ceiling = {{2.5, 0, 0}}, .ceilings = 1, .corners = west_corners, .corner_count = 4},
    {.name = (char *)"east", .ceiling = {{2.5, 0, 0}}, .ceilings = 1, .corners = east_corners, .corner_count = 4}};
static const struct model_plan plan = {.rooms = rooms, .room_count = 2};

struct trial {
    struct walk w;
    struct err err;
    enum status status;
};

/* script: the text of tour.txt; NULL: none. The graph keeps pointers to parts of *t. */
static void run(struct trial *t, const struct box *flat, const char *script)
{
    *t = (struct trial){.err = ERR_INIT};
    walk_make(&t->w, flat, 3, places, 4);
    assert_ok(walk_graph(&t->w, &t->err), t->err);
    t->status = tour_stops_find(&t->w.stops, &t->w.stop_count, &t->w.g, &plan, t->w.params.speed,
                                script ? scratch_write("tour.txt", script) : NULL, NULL, &t->err);
}

static void a_tour_visits_each_room(void **state)
{
    (void)state;
    struct trial t;
    bool seen[2] = {false, false};
    run(&t, open_flat, NULL);
    assert_int_equal(t.status, ST_OK);
    for (int i = 0; i < t.w.stop_count; i++)
        for (int r = 0; r < 2; r++) seen[r] |= tour_room_holds(&rooms[r], t.w.g.nodes[t.w.stops[i].node].centre);
    assert_true(seen[0] && seen[1]);
    for (int i = 0; i < 4; i++) assert_true(t.w.g.nodes[t.w.stops[0].node].open >= t.w.g.nodes[i].open);
    walk_release(&t.w);
}

static int tour_of_parted_rooms(void *ctx)
{
    struct trial t;
    (void)ctx;
    run(&t, parted_flat, NULL);
    const int count = t.w.stop_count;
    walk_release(&t.w);
    return t.status ? 50 : count;
}

static void disconnected_rooms_are_named_and_left_out(void **state)
{
    (void)state;
    char *output;
    const int stops = child_run(tour_of_parted_rooms, NULL, &output);
    assert_true(stops >= 1 && stops < 50);
    assert_contains(output, "is left out of the tour: no way between viewpoints leads there");
    assert_true(!strstr(output, "room west is") != !strstr(output, "room east is"));
    free(output);
}

static void a_script_names_rooms_and_photos_in_order(void **state)
{
    (void)state;
    struct trial t;
    run(&t, open_flat, "remodel-tour 1\n# east, then back\nroom east\nspeed 0.5\nphoto p1\nroom west\n");
    assert_int_equal(t.status, ST_OK);
    assert_int_equal(t.w.stop_count, 3);
    assert_string_equal(t.w.g.nodes[t.w.stops[0].node].photo, "p4");
    assert_string_equal(t.w.g.nodes[t.w.stops[1].node].photo, "p1");
    assert_string_equal(t.w.g.nodes[t.w.stops[2].node].photo, "p2");
    assert_true(t.w.stops[0].speed == t.w.params.speed);
    assert_true(t.w.stops[1].speed == 0.5 && t.w.stops[2].speed == 0.5);
    walk_release(&t.w);
}

static void a_script_that_asks_for_a_disconnected_room_is_refused(void **state)
{
    (void)state;
    struct trial t;
    run(&t, parted_flat, "remodel-tour 1\nroom west\nroom east\n");
    assert_err(t.err, ST_DATA, "tour.txt:3: found \"p4\", wanted a stop that a way leads to");
    walk_release(&t.w);
}

static void errors_name_the_file_and_the_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *part;
    } wrong[] = {
        {"remodel-tour 2\nroom west\n", "tour.txt:1: "},
        {"remodel-tour 1\n", "wanted \"room NAME\""},
        {"remodel-tour 1\nroom wets\n", "tour.txt:2: found \"wets\", wanted a room of the model; did you mean west?"},
        {"remodel-tour 1\nphoto p9\n", "tour.txt:2: found \"p9\", wanted a photo's id; did you mean p"},
        {"remodel-tour 1\nview p1\n", "tour.txt:2: found \"view\""},
        {"remodel-tour 1\nroom west east\n", "tour.txt:2: found \"east\""},
        {"remodel-tour 1\nphoto\n", "tour.txt:2: "},
        {"remodel-tour 1\nspeed 0\nroom west\n", "tour.txt:2: found \"0\", wanted a speed, a number from 0.01 to 100"},
        {"remodel-tour 1\nspeed fast\n", "tour.txt:2: found \"fast\""},
        {"remodel-tour 1\nspeed 1 2\n", "tour.txt:2: found \"2\""},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct trial t;
        run(&t, open_flat, wrong[i].text);
        assert_err(t.err, ST_DATA, wrong[i].part);
        walk_release(&t.w);
    }
}

static void a_photo_in_what_an_edit_adds_is_refused_by_name(void **state)
{
    (void)state;
    const struct box pier[] = {HALL_OUTSIDE, HALL_INSIDE, {"box/pier", "pier", {-0.5, 1, 0.001}, {0.5, 1.9, 2}, false}};
    struct trial t;
    run(&t, pier, "remodel-tour 1\nphoto p1\nphoto p3\n");
    assert_err(t.err, ST_DATA, "tour.txt:3: found \"p3\", wanted a photo that was not taken inside a wall");
    walk_release(&t.w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tour_visits_each_room),
        cmocka_unit_test(disconnected_rooms_are_named_and_left_out),
        cmocka_unit_test(a_script_names_rooms_and_photos_in_order),
        cmocka_unit_test(a_script_that_asks_for_a_disconnected_room_is_refused),
        cmocka_unit_test(errors_name_the_file_and_the_line),
        cmocka_unit_test(a_photo_in_what_an_edit_adds_is_refused_by_name),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
