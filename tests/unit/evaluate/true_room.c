/* true_room.c - floors and ceilings of true rooms, from either file. */
#include "stages/evaluate/truth/true_room.h"

#include "tests/unit/scratch.h"

static void a_described_scene_has_the_frame_of_the_world(void **state)
{
    (void)state;
    struct true_room room;
    struct err err = ERR_INIT;
    assert_ok(true_room_read_file(&room,
                                  scratch_write("scene.txt", "remodel-scene 1\nroom a 0 0 5 4  0 2.7  floor ceiling\n"
                                                             "box b 1 2 3 4 5 6 wood\nroom c 5 0 8 4  0 2.7  f c\n"),
                                  false, &err),
              err);
    assert_true(room.known && room.count == 1 && room.origin.x == 0);
    assert_true(room.heights[0].floor == 0 && room.heights[0].ceiling == 2.7);
    assert_true(room.room_from_world.m[0][0] == 1 && room.room_from_world.m[0][1] == 0);
    true_room_release(&room);
}

static void rooms_can_have_a_frame_of_their_own(void **state)
{
    (void)state;
    struct true_room room;
    struct err err = ERR_INIT;
    assert_ok(true_room_read_file(&room,
                                  scratch_write("scene-truth.txt",
                                                "# metres\nyaw_degrees 90\nt 3 -1 0.5\nliving 0 0 0 5 4 2.6\n"
                                                "partition x 5 5.15\nsun direction 0 0 -1 angular 1 radiance 9 8 7\n"),
                                  true, &err),
              err);
    assert_true(room.known && room.count == 1 && room.heights[0].floor == 0 && room.heights[0].ceiling == 2.6);
    /* the room's x is the world's y */
    const struct vec3 p = mat3_apply(room.room_from_world, vec3_sub(vec3_make(3, 1, 0.5), room.origin));
    assert_true(fabs(p.x - 2) < 1e-12 && fabs(p.y) < 1e-12 && fabs(p.z) < 1e-12);
    true_room_release(&room);
}

static void rooms_may_have_different_heights(void **state)
{
    (void)state;
    struct true_room room;
    struct err err = ERR_INIT;
    const char *path = scratch_write("scene.txt", "room a 0 0 1 1 0 2\nroom b 0 0 1 1 0.4 3\nroom c 1 1 2 2 0 2\n");
    assert_ok(true_room_read_file(&room, path, false, &err), err);
    assert_int_equal(room.count, 2);
    assert_true(room.heights[1].floor == 0.4 && room.heights[1].ceiling == 3);
    true_room_release(&room);
    assert_false(room.known);
}

static void damaged_rooms_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *error;
        bool frame;
    } cases[] = {
        {"room a 0 0 1 1 2 2\n", "wanted a ceiling above the floor", false}, {"room a 0 0 1 1 0\n", ":1:", false},
        {"yaw_degrees north\n", ":1: found \"yaw_degrees\"", true},          {"t 1 2\n", ":1: found \"t\"", true},
        {"a 0 0 1 1 1 0\n", ":1: found \"heights from 1 to 0\"", true},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct true_room room;
        struct err err = ERR_INIT;
        assert_int_equal(true_room_read_file(&room, scratch_write("room.txt", cases[i].text), cases[i].frame, &err),
                         ST_DATA);
        assert_err(err, ST_DATA, cases[i].error);
        assert_false(room.known);
    }
}

static void a_truth_may_lack_rooms(void **state)
{
    (void)state;
    struct true_room room;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    assert_ok(true_room_read(&room, scratch_path("nowhere"), &prov, &err), err);
    assert_false(room.known);
    assert_int_equal(prov.count, 0);
    provenance_release(&prov);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_described_scene_has_the_frame_of_the_world),
        cmocka_unit_test(rooms_can_have_a_frame_of_their_own),
        cmocka_unit_test(rooms_may_have_different_heights),
        cmocka_unit_test(damaged_rooms_are_refused),
        cmocka_unit_test(a_truth_may_lack_rooms),
    };
    return cmocka_run_group_tests_name("true_room", tests, scratch_make, scratch_remove);
}
