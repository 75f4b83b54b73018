/* room_frame.c - frame.txt and the lines of views, written and read. */
#include "common/capture/room_frame.h"
#include "common/capture/line_list.h"
#include "tests/unit/scratch.h"

static void a_frame_is_read_back_to_the_last_bit(void **state)
{
    (void)state;
    struct frame_heading headings[2] = {{{0.6, 0.8, 0}, 0.001, 0.25}, {{-0.8, 0.6, 0}, 0.001, 0.125}};
    struct frame_wall walls[1] = {{1, -1, 1.0 / 3, -2.5, 0.7, 4}};
    const struct room_frame f = {.known = true,
                                 .up = {0, 0, 1},
                                 .up_error = 0.0005,
                                 .headings = headings,
                                 .heading_count = 2,
                                 .floor = {true, -1.1, 0.01},
                                 .walls = walls,
                                 .wall_count = 1};
    struct room_frame back, none = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_path("frame.txt");
    assert_ok(room_frame_write(&f, path, NULL, &err), err);
    assert_ok(room_frame_read(&back, path, NULL, &err), err);
    assert_true(back.known && back.floor.known && !back.ceiling.known);
    assert_memory_equal(&back.up, &f.up, sizeof f.up);
    assert_int_equal(back.heading_count, 2);
    assert_memory_equal(&back.headings[1].along, &headings[1].along, sizeof headings[1].along);
    assert_int_equal(back.wall_count, 1);
    assert_true(back.walls[0].offset == walls[0].offset && back.walls[0].side == -1 && back.walls[0].heading == 1);
    assert_true(back.floor.height == f.floor.height);
    room_frame_release(&back);
    assert_ok(room_frame_write(&none, path, NULL, &err), err);
    assert_ok(room_frame_read(&back, path, NULL, &err), err);
    assert_false(back.known);
    room_frame_release(&back);
}

static void damaged_frames_are_refused_with_their_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"remodel-frame 1\nup 0 0 2 0\n", "frame.txt:2: found \"2\""},
        {"remodel-frame 1\nup 0 0 1 0\nheading 0 0 1 0 0\n", "frame.txt:3: found \"1\""},
        {"remodel-frame 1\nup 0 0 1 0\nwall 0 1 2 0 1 3\n", "frame.txt:3"},
        {"remodel-frame 1\nup 0 0 1 0\nheading 1 0 0 0 0\nwall 0 1 2 1 1 3\n", "frame.txt:4"},
        {"remodel-frame 1\nroof 2 0\n", "found \"roof\""},
        {"remodel-frame 9\n", "frame.txt"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct room_frame f;
        struct err err = ERR_INIT;
        const char *path = scratch_write("frame.txt", cases[i].text);
        room_frame_read(&f, path, NULL, &err);
        assert_err(err, ST_DATA, cases[i].words);
        assert_int_equal(f.heading_count, 0);
    }
}

static void lines_are_read_back(void **state)
{
    (void)state;
    struct line_list list = {0}, back;
    struct err err = ERR_INIT;
    const char *path = scratch_path("v.txt");
    for (int i = 0; i < 5; i++)
        assert_ok(line_list_add(&list, &(struct view_line){0.5 * i, 2, 30.25, i + 1}, &err), err);
    assert_ok(line_list_write(&list, path, NULL, &err), err);
    assert_ok(line_list_read(&back, path, NULL, &err), err);
    assert_int_equal(back.count, 5);
    assert_memory_equal(back.lines, list.lines, 5 * sizeof *list.lines);
    line_list_release(&list);
    line_list_release(&back);
    line_list_read(&back, scratch_write("v.txt", "remodel-lines 1\nline 1 2 1 2\n"), NULL, &err);
    assert_err(err, ST_DATA, "v.txt:2");
}

/* How much a frame counts in a scene whose two views observe so many points each. */
static double trust_of(int points)
{
    enum { MOST = 100 };
    static struct sfm_point list[MOST];
    static struct sfm_track tracks[MOST][2];
    struct err err = ERR_INIT;
    double trust;
    for (int i = 0; i < points; i++) {
        for (int k = 0; k < 2; k++) tracks[i][k].image_idx = k;
        list[i] = (struct sfm_point){.track = tracks[i], .track_count = 2};
    }
    const struct sfm_model model = {.points = list, .point_count = points, .image_count = 2};
    assert_ok(room_frame_trust(&trust, &model, &err), err);
    return trust;
}

static void a_frame_counts_where_views_observe_few_points(void **state)
{
    (void)state;
    assert_true(trust_of(0) >= 1 && trust_of(20) >= 1);
    assert_true(trust_of(30) < 1 && trust_of(35) < trust_of(30) && trust_of(35) > 0);
    assert_true(trust_of(50) <= 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_is_read_back_to_the_last_bit),
        cmocka_unit_test(damaged_frames_are_refused_with_their_line),
        cmocka_unit_test(lines_are_read_back),
        cmocka_unit_test(a_frame_counts_where_views_observe_few_points),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
