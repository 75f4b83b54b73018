/* layout.c - the solids that each statement of a model script makes. */
#include <math.h>

#include "tests/unit/build_model/scripted.h"

static void a_room_is_closed_on_all_sides(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM, NULL);
    for (int k = 0; k < 50; k++) { /* air inside; matter in walls, floor, ceiling and all four corners */
        const double t = (k + 0.5) / 50;
        assert_int_equal(inside(&list, "walls", 4 * t, 1.5, 1.2), 0);
        assert_true(inside(&list, "walls", 4.4 * t - 0.2, -0.1, 1.2) > 0);
        assert_true(inside(&list, "walls", 4.4 * t - 0.2, 3.1, 1.2) > 0);
        assert_true(inside(&list, "walls", -0.1, 3.4 * t - 0.2, 1.2) > 0);
        assert_true(inside(&list, "walls", 4.1, 3.4 * t - 0.2, 1.2) > 0);
        assert_true(inside(&list, "walls", 4.4 * t - 0.2, 3.4 * t - 0.2, -0.1) > 0);
        assert_true(inside(&list, "walls", 4.4 * t - 0.2, 3.4 * t - 0.2, 2.6) > 0);
    }
    assert_int_equal(inside(&list, "walls", 2, -0.21, 1), 0);
    assert_int_equal(inside(&list, "walls", 2, 1, -0.21), 0);
    assert_string_equal(face_at(&list, 2, 0, 1), "wall/south/in");
    assert_string_equal(face_at(&list, 2, -0.2, 1), "wall/south/out");
    assert_string_equal(face_at(&list, -0.1, -0.2, 1), "wall/south/out");
    assert_string_equal(face_at(&list, -0.2, -0.1, 1), "wall/west/out"); /* the corner */
    assert_string_equal(face_at(&list, 4.2, 3.1, 1), "wall/east/out");
    assert_string_equal(face_at(&list, 2, 1, 0), "floor/hall");
    assert_string_equal(face_at(&list, 2, 1, 2.5), "ceiling/hall");
    assert_string_equal(face_at(&list, 2, 1, -0.2), "floor/hall/bottom");
    assert_string_equal(face_at(&list, 2, 1, 2.7), "ceiling/hall/top");
    drop(&plan, &list);
}

static void the_inside_is_to_the_right_from_start_to_end(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, "remodel-script 1\nwall a from 0 0 to 3 0 thickness 0.3 foot 0.5 top 2\n", NULL);
    assert_int_equal(list.count, 1);
    assert_string_equal(face_at(&list, 1, 0, 1), "wall/a/in");
    assert_string_equal(face_at(&list, 1, 0.3, 1), "wall/a/out");
    assert_string_equal(face_at(&list, 0, 0.1, 1), "wall/a/start");
    assert_string_equal(face_at(&list, 3, 0.1, 1), "wall/a/end");
    assert_string_equal(face_at(&list, 1, 0.1, 0.5), "wall/a/bottom");
    assert_string_equal(face_at(&list, 1, 0.1, 2), "wall/a/top");
    drop(&plan, &list);
}

static void openings_have_named_reveals(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM "door way on south from 1 0 to 2 2\nwindow sun on south from 2.5 0.9 to 3.5 2.1\n", NULL);
    assert_int_equal(inside(&list, "walls", 1.5, -0.1, 1), 0);
    assert_true(inside(&list, "walls", 1.5, -0.1, 2.1) > 0);
    assert_true(inside(&list, "walls", 2.2, -0.1, 1) > 0);
    assert_int_equal(inside(&list, "walls", 3, -0.1, 1.5), 0);
    assert_true(inside(&list, "walls", 3, -0.1, 0.5) > 0);
    /* seen from inside, x increases to the left along the south wall */
    assert_string_equal(face_at(&list, 1, -0.1, 1), "door/way/right");
    assert_string_equal(face_at(&list, 2, -0.1, 1), "door/way/left");
    assert_string_equal(face_at(&list, 1.5, -0.1, 2), "door/way/head");
    assert_string_equal(face_at(&list, 1.5, -0.1, 0), "floor/hall"); /* continues through the door */
    assert_string_equal(face_at(&list, 3, -0.1, 0.9), "window/sun/sill");
    assert_string_equal(face_at(&list, 3, -0.1, 2.1), "window/sun/head");
    assert_string_equal(face_at(&list, 3.5, -0.1, 1), "window/sun/left");
    /* glass: a separate slab, flush with the outer face */
    assert_int_equal(inside(&list, "glass/sun", 3, -0.19, 1.5), 1);
    assert_int_equal(inside(&list, "glass/sun", 3, -0.17, 1.5), 0);
    assert_string_equal(face_at(&list, 3, -0.2, 1.5), "glass/sun/out");
    assert_string_equal(face_at(&list, 3, -0.18, 1.5), "glass/sun/in");
    drop(&plan, &list);
}

static void openings_that_share_a_side_keep_their_own_reveals(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list,
          ROOM "door way on north from 1 0 to 2 1.8\nwindow light on north from 1 2 to 2 2.4\n"
               "passage beside on north from 2.5 0 to 3 2.5\n",
          NULL);
    assert_string_equal(face_at(&list, 1, 3.1, 1), "door/way/left");
    assert_string_equal(face_at(&list, 1, 3.1, 2.2), "window/light/left");
    assert_string_equal(face_at(&list, 2, 3.1, 2.2), "window/light/right");
    assert_string_equal(face_at(&list, 1.5, 3.1, 1.8), "door/way/head");
    assert_string_equal(face_at(&list, 1.5, 3.1, 2), "window/light/sill");
    assert_true(inside(&list, "walls", 1.5, 3.1, 1.9) > 0);
    assert_true(inside(&list, "walls", 0.5, 3.1, 1.9) > 0);
    assert_int_equal(inside(&list, "walls", 2.7, 3.1, 2.4), 0); /* a passage may reach the ceiling */
    drop(&plan, &list);
}

static void a_wall_that_moves_takes_its_neighbours_ends_along(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM "window w on east from 1 1 to 2 2\n", "remodel-script 1\nmove east by 0.5\n");
    assert_string_equal(face_at(&list, 4.5, 0.5, 1), "wall/east/in");
    assert_string_equal(face_at(&list, 4.4, 0, 1), "wall/south/in");
    assert_string_equal(face_at(&list, 4.4, 3, 1), "wall/north/in");
    assert_string_equal(face_at(&list, 4.4, 1, 0), "floor/hall");
    assert_true(inside(&list, "walls", 4.6, -0.1, 1) > 0);
    assert_int_equal(inside(&list, "walls", 4.8, -0.1, 1), 0);
    assert_int_equal(inside(&list, "walls", 4.6, 1.5, 1.5), 0); /* the window moved too */
    assert_int_equal(inside(&list, "glass/w", 4.69, 1.5, 1.5), 1);
    drop(&plan, &list);
    build(&plan, &list, ROOM, "remodel-script 1\nmove east by -1\n");
    assert_string_equal(face_at(&list, 3, 0.5, 1), "wall/east/in");
    assert_int_equal(inside(&list, "walls", 3.5, -0.1, 1), 0);
    drop(&plan, &list);
}

static void floors_of_two_rooms_meet_in_the_middle_of_their_wall(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, TWO "door d on middle from 1 0 to 2 2\nwindow w on middle from 2.2 1 to 2.8 2\n", NULL);
    /* it goes from y 0 to 3, so its inside, to the right, is x above 2 */
    assert_string_equal(face_at(&list, 2, 0.5, 1), "wall/middle/in");
    assert_string_equal(face_at(&list, 1.9, 2.9, 1), "wall/middle/out");
    assert_string_equal(face_at(&list, 1.92, 1.5, 0), "floor/left");
    assert_string_equal(face_at(&list, 1.97, 1.5, 0), "floor/right");
    assert_string_equal(face_at(&list, 1.2, 1.5, 2.5), "ceiling/left");
    assert_int_equal(inside(&list, "walls", 1.95, 1.5, 1), 0);
    assert_int_equal(inside(&list, "glass/w", 1.91, 2.5, 1.5), 0); /* no glass between rooms */
    drop(&plan, &list);
    /* its ends follow the walls that it meets, also when the wall itself moves */
    build(&plan, &list, TWO, "remodel-script 1\nmove north by 1\nmove middle by 0.5\n");
    assert_string_equal(face_at(&list, 1.5, 3.9, 1), "wall/middle/in");
    assert_string_equal(face_at(&list, 1.4, 0.1, 1), "wall/middle/out");
    drop(&plan, &list);
}

static void a_split_leaves_two_walls_on_one_line(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, TWO "split middle from 1 to 2 into rest\n", NULL);
    assert_int_equal(inside(&list, "walls", 1.95, 1.5, 1), 0);
    assert_string_equal(face_at(&list, 2, 0.5, 1), "wall/middle/in");
    assert_string_equal(face_at(&list, 2, 2.5, 1), "wall/rest/in");
    assert_string_equal(face_at(&list, 1.95, 1, 1), "wall/middle/end");
    assert_string_equal(face_at(&list, 1.95, 2, 1), "wall/rest/start");
    assert_string_equal(face_at(&list, 1.97, 1.5, 0), "floor/right");
    drop(&plan, &list);
    /* walls joined to the new part stay joined to it; openings stay in their part */
    build(&plan, &list, ROOM "window w on south from 3 1 to 3.5 2\n",
          "remodel-script 1\nsplit south from 1 to 2 into other\nmove west by 1\n");
    assert_string_equal(face_at(&list, -0.5, 0, 1), "wall/other/in");
    assert_string_equal(face_at(&list, 3.2, -0.1, 1), "window/w/sill");
    assert_int_equal(plan.openings[0].wall, 0);
    drop(&plan, &list);
}

static void doors_and_windows_open_and_close(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM "door d on south from 1 0 to 2 2 closed\nwindow w on north from 1 1 to 2 2\n", NULL);
    assert_int_equal(inside(&list, "walls", 1.5, -0.1, 1), 1);
    assert_int_equal(inside(&list, "walls", 1.5, -0.05, 1), 0);
    assert_string_equal(face_at(&list, 1.5, -0.08, 1), "door/d/leaf-in");
    drop(&plan, &list);
    build(&plan, &list, ROOM "door d on south from 1 0 to 2 2 closed\nwindow w on north from 1 1 to 2 2\n",
          "remodel-script 1\nopen d\nopen w\nadjust d from 1.2 0 to 1.9 2.1\n");
    assert_int_equal(inside(&list, "walls", 1.5, -0.1, 1), 0);
    assert_int_equal(inside(&list, "glass/w", 1.5, 3.19, 1.5), 0);
    assert_string_equal(face_at(&list, 1.5, -0.1, 2.1), "door/d/head");
    assert_string_equal(face_at(&list, 1.2, -0.1, 2), "door/d/right");
    drop(&plan, &list);
    build(&plan, &list, ROOM "door d on south from 1 0 to 2 2\n", "remodel-script 1\nremove d\n");
    assert_true(inside(&list, "walls", 1.5, -0.1, 1) > 0);
    drop(&plan, &list);
}

static void a_removed_wall_leaves_its_rooms(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, TWO "door d on middle from 1 0 to 2 2\n", "remodel-script 1\nremove middle\n");
    assert_int_equal(inside(&list, "walls", 1.95, 0.5, 1), 0);
    assert_string_equal(face_at(&list, 1.92, 1.5, 0), "floor/left");
    assert_string_equal(face_at(&list, 1.97, 1.5, 0), "floor/right");
    drop(&plan, &list);
}

static void a_room_with_a_reflex_corner_has_a_whole_floor(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    /* an L: 0..4 x 0..2 and 0..2 x 2..4 */
    build(&plan, &list,
          "remodel-script 1\nset thickness 0.2\nset ceiling 2.5\nwall a from 4 0 to 0 0\nwall b from 0 0 to 0 4\n"
          "wall c from 0 4 to 2 4\nwall d from 2 4 to 2 2\nwall e from 2 2 to 4 2\nwall f from 4 2 to 4 0\n"
          "join a b c d e f a\nroom ell a b c d e f\n",
          NULL);
    for (int i = 0; i < 40; i++)
        for (int k = 0; k < 40; k++) {
            const double x = -0.5 + 5 * (i + 0.37) / 40, y = -0.5 + 5 * (k + 0.37) / 40;
            const bool room = x > 0 && y > 0 && x < 4 && y < 4 && (x < 2 || y < 2);
            const bool all = x > -0.2 && y > -0.2 && x < 4.2 && y < 4.2 && (x < 2.2 || y < 2.2);
            assert_int_equal(inside(&list, "walls", x, y, 1) > 0, all && !room);
            assert_int_equal(inside(&list, "walls", x, y, -0.1) > 0, all);
            assert_int_equal(inside(&list, "walls", x, y, 2.6) > 0, all);
        }
    assert_string_equal(face_at(&list, 2, 3, 1), "wall/d/in");
    assert_string_equal(face_at(&list, 3, 2, 1), "wall/e/in");
    assert_string_equal(face_at(&list, 2.2, 3, 1), "wall/d/out");
    drop(&plan, &list);
}

static void a_ceiling_slopes_and_walls_reach_it(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM "slope hall from west 2 to east 4\n", NULL);
    for (int i = 0; i < 20; i++) {
        const double x = 4.4 * (i + 0.4) / 20 - 0.2, z = 2 + 0.5 * x;
        assert_true(inside(&list, "walls", x, 1.5, z + 0.1) > 0);
        assert_int_equal(inside(&list, "walls", x, -0.1, z - 0.01) > 0, 1);
        if (x > 0 && x < 4) assert_int_equal(inside(&list, "walls", x, 1.5, z - 0.01), 0);
        assert_int_equal(inside(&list, "walls", x, 1.5, z + 0.25), 0);
    }
    assert_string_equal(face_at(&list, 2, 1, 3), "ceiling/hall");
    assert_string_equal(face_at(&list, 3.9, 0, 3.9), "wall/south/in");
    drop(&plan, &list);
    /* a wall along two rooms reaches the ceiling of each */
    build(&plan, &list, TWO "slope right from middle 2.5 to east 3.5\n", NULL);
    assert_true(inside(&list, "walls", 3, -0.1, 2.95) > 0);
    assert_int_equal(inside(&list, "walls", 1, -0.1, 2.75), 0);
    drop(&plan, &list);
}

static void an_angled_wall_is_joined_at_its_planes(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    /* a room of four walls, the east one from (4, 0) to (3, 3) */
    build(&plan, &list,
          "remodel-script 1\nset thickness 0.2\nset ceiling 2.5\nwall a from 4 0 to 0 0\nwall b from 0 0 to 0 3\n"
          "wall c from 0 3 to 3 3\nwall d from 3 3 to 4 0 angled\njoin a b c d a\nroom r a b c d\n"
          "window w on d from 1 1 to 2 2\n",
          NULL);
    const double n[2] = {-3 / sqrt(10), -1 / sqrt(10)}; /* into the room */
    for (int i = 0; i < 60; i++)
        for (int k = 0; k < 60; k++) {
            const double x = -0.5 + 5.5 * (i + 0.37) / 60, y = -0.5 + 4 * (k + 0.37) / 60;
            const double h = n[0] * (x - 4) + n[1] * y; /* before the wall's in face */
            const bool room = x > 0 && y > 0 && y < 3 && h > 0, all = x > -0.2 && y > -0.2 && y < 3.2 && h > -0.2;
            assert_int_equal(inside(&list, "walls", x, y, 0.5) > 0, all && !room);
            assert_int_equal(inside(&list, "walls", x, y, -0.1) > 0, all);
        }
    /* S is the distance from its first point, (3, 3) */
    const double at[2] = {3 + 1.5 / sqrt(10), 3 - 4.5 / sqrt(10)};
    assert_int_equal(inside(&list, "walls", at[0] - 0.1 * n[0], at[1] - 0.1 * n[1], 1.5), 0);
    assert_int_equal(inside(&list, "glass/w", at[0] - 0.19 * n[0], at[1] - 0.19 * n[1], 1.5), 1);
    assert_string_equal(face_at(&list, at[0] - 0.1 * n[0], at[1] - 0.1 * n[1], 1), "window/w/sill");
    drop(&plan, &list);
}

static void boxes_may_be_turned(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM "box beam from 1 0 to 1.2 3 foot 2.3\nbox chest from 2 1 to 3 1.4 top 0.8 turn 90\n",
          "remodel-script 1\nmove chest by 0.5 0.25\n");
    assert_string_equal(face_at(&list, 1.1, 1, 2.3), "box/beam/bottom");
    assert_string_equal(face_at(&list, 1, 1, 2.4), "box/beam/left");
    assert_string_equal(face_at(&list, 1.2, 1, 2.4), "box/beam/right");
    /* turned by 90 degrees about (3, 1.45): its right side faces +y */
    assert_string_equal(face_at(&list, 3, 1.95, 0.4), "box/chest/right");
    assert_string_equal(face_at(&list, 2.8, 1.45, 0.4), "box/chest/back");
    assert_string_equal(face_at(&list, 3, 1.45, 0.8), "box/chest/top");
    drop(&plan, &list);
}

/* The corner of a wall remains where an opening begins beside it, even if the other wall does not fill it. */
static void an_opening_beside_a_corner_leaves_the_corner(void **state)
{
    static const char *const others[] = {"", "extend west start to south\n", "remove west\n"};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct plan plan;
        struct solid_list list;
        char text[1024];
        snprintf(text, sizeof text, ROOM "%swindow w on south from 0 0 to 1 2 open\n", others[i]);
        build(&plan, &list, text, NULL);
        assert_true(inside(&list, "walls", -0.1, -0.1, 1) > 0);
        assert_int_equal(inside(&list, "walls", 0.5, -0.1, 1), 0);
        assert_string_equal(face_at(&list, 0, -0.1, 1), i == 2 ? "window/w/right" : "wall/west/in");
        drop(&plan, &list);
    }
}

static void the_top_of_a_wall_steps_between_ceilings_of_two_rooms(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list,
          ROOM "remove hall\nwall mid from 2 1 to 2 2\nextend mid start to south\nextend mid end to north\n"
               "room low south west north mid\nroom high south mid north east ceiling 3.5\n",
          NULL);
    assert_int_equal(inside(&list, "walls", 1, -0.1, 3), 0);
    assert_true(inside(&list, "walls", 3, -0.1, 3) > 0);
    assert_string_equal(face_at(&list, 1.9, -0.1, 3), "wall/south/top"); /* at the middle of mid, which is 1.8 to 2 */
    drop(&plan, &list);
}

static void a_round_room_has_many_walls(void **state)
{
    enum { WALLS = 24 };
    struct plan plan;
    struct solid_list list;
    char text[8192] = "remodel-script 1\nset ceiling 2.5\nset thickness 0.1\n", loop[1024] = "";
    (void)state;
    for (int i = 0; i < WALLS; i++) {
        const double a = 2 * M_PI * (i + 1) / WALLS, b = 2 * M_PI * i / WALLS;
        snprintf(text + strlen(text), sizeof text - strlen(text), "wall w%d from %.6f %.6f to %.6f %.6f angled\n", i,
                 4 * cos(a), 4 * sin(a), 4 * cos(b), 4 * sin(b));
        snprintf(loop + strlen(loop), sizeof loop - strlen(loop), " w%d", i);
    }
    snprintf(text + strlen(text), sizeof text - strlen(text), "join%s w0\nroom round%s\n", loop, loop);
    build(&plan, &list, text, NULL);
    assert_int_equal(list.count, WALLS + 2);
    assert_int_equal(inside(&list, "walls", 3.9, 0, -0.05), 1);
    assert_int_equal(inside(&list, "walls", 0, 0, 1), 0);
    drop(&plan, &list);
}

/* Two of its walls are on one line, but not consecutive. */
static void a_room_may_surround_three_sides_of_a_yard(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list,
          "remodel-script 1\nset thickness 0.2\nset ceiling 2.5\nwall a from 6 0 to 0 0\nwall b from 0 0 to 0 4\n"
          "wall c from 0 4 to 2 4\nwall d from 2 4 to 2 2\nwall e from 2 2 to 4 2\nwall f from 4 2 to 4 4\n"
          "wall g from 4 4 to 6 4\nwall h from 6 4 to 6 0\njoin a b c d e f g h a\n"
          "room hall a b c d e f g h ceiling 3\n",
          NULL);
    for (int i = 0; i < 2; i++) {
        assert_true(inside(&list, "walls", 1 + 4 * i, 4.1, 2.9) > 0);
        assert_int_equal(inside(&list, "walls", 1 + 4 * i, 3, 1), 0);
    }
    assert_int_equal(inside(&list, "walls", 3, 3, -0.1), 0); /* the yard */
    assert_string_equal(face_at(&list, 3, 1, 0), "floor/hall");
    drop(&plan, &list);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_room_is_closed_on_all_sides),
        cmocka_unit_test(the_inside_is_to_the_right_from_start_to_end),
        cmocka_unit_test(openings_have_named_reveals),
        cmocka_unit_test(openings_that_share_a_side_keep_their_own_reveals),
        cmocka_unit_test(a_wall_that_moves_takes_its_neighbours_ends_along),
        cmocka_unit_test(floors_of_two_rooms_meet_in_the_middle_of_their_wall),
        cmocka_unit_test(a_split_leaves_two_walls_on_one_line),
        cmocka_unit_test(doors_and_windows_open_and_close),
        cmocka_unit_test(a_removed_wall_leaves_its_rooms),
        cmocka_unit_test(a_room_with_a_reflex_corner_has_a_whole_floor),
        cmocka_unit_test(a_ceiling_slopes_and_walls_reach_it),
        cmocka_unit_test(an_angled_wall_is_joined_at_its_planes),
        cmocka_unit_test(boxes_may_be_turned),
        cmocka_unit_test(an_opening_beside_a_corner_leaves_the_corner),
        cmocka_unit_test(the_top_of_a_wall_steps_between_ceilings_of_two_rooms),
        cmocka_unit_test(a_room_may_surround_three_sides_of_a_yard),
        cmocka_unit_test(a_round_room_has_many_walls),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
