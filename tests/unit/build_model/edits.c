/* edits.c - the solids after edits: added walls, heights, sizes, fillings, openings in ceilings and floors. */
#include <math.h>

#include "tests/unit/build_model/scripted.h"

static void a_wall_added_in_a_room_reaches_its_ceiling(void **state)
{
    static const char *const walls[] = {
        "wall new from 1 0.5 to 3 0.5\n", "wall new from 1 0.5 to 3 2 angled\n",
        "wall new from 2 0 to 2 3\nextend new start to south\nextend new end to north\n",
        "wall new from 1 0.5 to 3 0.5\nwindow hole on new from 1.5 1 to 2 2 open\n"};
    (void)state;
    for (int i = 0; i < 4; i++)
        for (int sloped = 0; sloped < 2; sloped++) {
            struct plan plan;
            struct solid_list list;
            char text[1024], edit[256];
            snprintf(text, sizeof text, ROOM "%s", sloped ? "slope hall from west 2 to east 4\n" : "");
            if (!sloped) strcpy(strstr(text, "hall south west north east") + 26, " ceiling 3.5\n");
            snprintf(edit, sizeof edit, "remodel-script 1\n%s", walls[i]);
            build(&plan, &list, text, edit);
            const struct plan_wall *w = &plan.walls[4];
            double span[2], p[2];
            plan_wall_span(&plan, 4, span);
            for (int k = 0; k < 400; k++) {
                const double t = (k % 20 + 0.5) / 20, z = 0.1 + 4 * (k / 20) / 20.0;
                plan_wall_point(w, span[0] + t * (span[1] - span[0]), 0.13, p);
                const bool hole = i == 3 && p[0] > 1.5 && p[0] < 2 && z > 1 && z < 2;
                const double ceiling = sloped ? 2 + 0.5 * p[0] : 3.5;
                if (fabs(z - ceiling) > 1e-3 && z < ceiling + 0.2)
                    assert_int_equal(inside(&list, "walls", p[0], p[1], z) > 0, !hole);
                else if (z > ceiling + 0.25)
                    assert_int_equal(inside(&list, "walls", p[0], p[1], z), 0);
            }
            drop(&plan, &list);
        }
}

static void a_wall_through_two_rooms_and_the_open_follows_each_ceiling(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    /* across the middle wall, and out through the east wall */
    build(&plan, &list, TWO "slope right from middle 3 to east 3.5\n", "remodel-script 1\nwall new from 1 1 to 6 1\n");
    assert_true(inside(&list, "walls", 1.5, 1.1, 2.45) > 0);
    assert_int_equal(inside(&list, "walls", 1.5, 1.1, 2.75), 0);
    assert_true(inside(&list, "walls", 2.5, 1.1, 3.05) > 0);
    assert_true(inside(&list, "walls", 3.9, 1.1, 3.45) > 0);
    assert_true(inside(&list, "walls", 5, 1.1, 2.45) > 0); /* the common height outdoors */
    assert_int_equal(inside(&list, "walls", 5, 1.1, 2.55), 0);
    drop(&plan, &list);
}

static void set_affects_later_statements_only(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM "window w on south from 1 1 to 2 2\ndoor d on north from 1 0 to 2 2 closed\n",
          "remodel-script 1\nset thickness 0.4\nset glass 0.1\nset leaf 0.1\n"
          "wall n from 1 1 to 2 1\ndoor e on west from 1 0 to 2 2 closed\nwindow v on south from 3 1 to 3.5 2\n");
    assert_int_equal(inside(&list, "walls", 1.5, -0.21, 0.5), 0);
    assert_true(inside(&list, "walls", 1.5, 1.39, 0.5) > 0);
    assert_int_equal(inside(&list, "glass/w", 1.5, -0.17, 1.5), 0);
    assert_int_equal(inside(&list, "glass/v", 3.2, -0.11, 1.5), 1);
    assert_int_equal(inside(&list, "walls", 1.5, 3.125, 1), 0);
    assert_int_equal(inside(&list, "walls", -0.06, 1.5, 1), 1);
    drop(&plan, &list);
    build(&plan, &list, ROOM "door d on north from 1 0 to 2 2 closed\n",
          "remodel-script 1\nset leaf 0.1\nopen d\nclose d\n");
    assert_int_equal(inside(&list, "walls", 1.5, 3.125, 1), 1);
    drop(&plan, &list);
}

static void heights_of_rooms_walls_and_boxes_change(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM "slope hall from west 2.5 to east 3\nbox b from 1 1 to 2 2 top 1\n",
          "remodel-script 1\nchange hall ceiling 3\nchange b foot 0.2 top 1.5\nchange north top 2.8 thickness 0.3\n");
    assert_true(inside(&list, "walls", 2, -0.1, 2.95) > 0); /* the walls follow */
    assert_int_equal(inside(&list, "walls", 2, 2.5, 2.95), 0);
    assert_string_equal(face_at(&list, 2, 2.5, 3), "ceiling/hall");
    assert_true(inside(&list, "walls", 1.5, 1.5, 1.4) > 0);
    assert_string_equal(face_at(&list, 1.5, 1.5, 0.2), "box/b/bottom");
    assert_true(inside(&list, "walls", 2, 3.25, 2.75) > 0);
    assert_int_equal(inside(&list, "walls", 2, 3.25, 2.85), 0); /* its own top */
    drop(&plan, &list);
    /* an opening that was too high fits below a raised ceiling */
    build(&plan, &list, ROOM, "remodel-script 1\nchange hall ceiling 3.2\nwindow w on south from 1 2.6 to 2 3 open\n");
    assert_int_equal(inside(&list, "walls", 1.5, -0.1, 2.8), 0);
    drop(&plan, &list);
}

static void an_opening_is_resized_by_its_sides_and_moves_up(void **state)
{
    /* seen from inside, the left of the south wall is at higher x, that of the north wall at lower x */
    static const char *const walls[] = {"south", "north"};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct plan plan;
        struct solid_list list;
        char text[1024];
        snprintf(text, sizeof text, ROOM "window w on %s from 1 1 to 2 2\n", walls[i]);
        build(&plan, &list, text,
              "remodel-script 1\nresize w left 0.3 right 0.1 bottom 0.2 top -0.25\nmove w by 0.5 0.125\n");
        const struct plan_opening *o = &plan.openings[0];
        assert_true(fabs(o->s[0] - (i ? 1.2 : 1.4)) < 1e-12 && fabs(o->s[1] - (i ? 2.6 : 2.8)) < 1e-12);
        assert_true(fabs(o->z[0] - 0.925) < 1e-12 && fabs(o->z[1] - 1.875) < 1e-12);
        drop(&plan, &list);
    }
    refused(ROOM "window w on south from 1 1 to 2 2\n", "remodel-script 1\nresize w front 0.2\n",
            ":2: found front, which w does not have; wanted left, right, bottom or top");
    refused(ROOM "window w on south from 1 1 to 2 2\n", "remodel-script 1\nresize w left -2\n", "edit.txt:2: ");
}

static void places_are_measured_from_walls_and_their_ends(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list,
          ROOM "passage p on south at left 0.5 width 0.8 from 0 to 2\nwindow w on east at right 0.25 "
               "width 1 from 1 to 2\n",
          "remodel-script 1\nwall new parallel to east by 1.5 between south north thickness 0.12\n");
    /* the south wall's left end is at x = 4; the east wall, seen from inside, has its right end at y = 0 */
    assert_int_equal(inside(&list, "walls", 3.45, -0.1, 1), 0);
    assert_int_equal(inside(&list, "walls", 2.75, -0.1, 1), 0);
    assert_true(inside(&list, "walls", 3.55, -0.1, 1) > 0 && inside(&list, "walls", 2.65, -0.1, 1) > 0);
    assert_int_equal(inside(&list, "walls", 4.1, 0.3, 1.5), 0);
    assert_int_equal(inside(&list, "walls", 4.1, 1.2, 1.5), 0);
    assert_true(inside(&list, "walls", 4.1, 0.2, 1.5) > 0 && inside(&list, "walls", 4.1, 1.3, 1.5) > 0);
    /* in front of the east wall, facing west as that does; it meets both walls */
    assert_string_equal(face_at(&list, 2.5, 1.5, 1), "wall/new/in");
    assert_string_equal(face_at(&list, 2.62, 1.5, 1), "wall/new/out");
    assert_true(inside(&list, "walls", 2.56, 0.001, 1) > 0 && inside(&list, "walls", 2.56, 2.999, 2.499) > 0);
    drop(&plan, &list);
    refused(ROOM "wall new parallel to east by 1.5 between south south\n", NULL, "name a wall for each of its ends");
    refused(ROOM "wall new parallel to east by 1.5 between south west\n", NULL, "cannot end at wall west");
    refused(ROOM "box b at left 1 width 1 from 0 to 2\n", NULL, "wanted \"in VIEW\" or \"from\"");
    refused(ROOM "window w on south at left 1 width 0 from 0 to 2\n", NULL, "found the width 0");
    refused(ROOM "window w on south at left 1 width 1 from 0 to 2\n",
            "remodel-script 1\nadjust south at left 0 width 1 from 0 to 1\n", "south is a wall");
}

static void openings_are_filled_with_leaf_glass_or_wall(void **state)
{
    static const char text[] = ROOM "door d on south from 1 0 to 2 2\nwindow w on north from 1 1 to 2 2\n";
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, text, "remodel-script 1\nfill d with glass\nfill w with leaf\n");
    assert_int_equal(inside(&list, "glass/d", 1.5, -0.1, 1), 1);
    assert_int_equal(inside(&list, "walls", 1.5, -0.1, 1), 0);
    assert_int_equal(inside(&list, "walls", 1.5, 3.1, 1.5), 1);
    assert_int_equal(inside(&list, "glass/w", 1.5, 3.19, 1.5), 0);
    assert_string_equal(face_at(&list, 1.5, 3.08, 1.5), "window/w/leaf-in");
    drop(&plan, &list);
    build(&plan, &list, text, "remodel-script 1\nfill d with wall\nfill w with wall\n");
    assert_true(inside(&list, "walls", 1.5, -0.1, 1) > 0 && inside(&list, "walls", 1.5, 3.1, 1.5) > 0);
    assert_string_equal(face_at(&list, 1.5, 3, 1.5), "wall/north/in");
    drop(&plan, &list);
    build(&plan, &list, text, "remodel-script 1\nfill w with wall\nopen w\n");
    assert_int_equal(inside(&list, "walls", 1.5, 3.1, 1.5), 0);
    drop(&plan, &list);
    /* glass between two rooms only where it is asked for */
    build(&plan, &list, TWO "window w on middle from 1 1 to 2 2 open\n", "remodel-script 1\nfill w with glass\n");
    assert_int_equal(inside(&list, "glass/w", 1.95, 1.5, 1.5), 1);
    drop(&plan, &list);
    refused(text, "remodel-script 1\nfill w with glass\n", "window w is filled with glass already");
    refused(text, "remodel-script 1\nfill w with bricks\n", "fill NAME with leaf|glass|wall|nothing");
}

static void ceilings_and_floors_have_openings(void **state)
{
    static const char *const shapes[] = {"", "slope hall from west 2.5 to east 3\n",
                                         "gable hall from west 2.5 to east 2.5 ridge 3.5\n"};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct plan plan;
        struct solid_list list;
        char text[1024];
        snprintf(text, sizeof text,
                 ROOM "%sskylight light on hall from 1.5 1 to 2.5 2\nhatch trap on hall from 3 1 to 3.5 2 closed\n",
                 shapes[i]);
        build(&plan, &list, text, NULL);
        for (int k = 0; k < 400; k++) {
            const double x = 4 * (k % 20 + 0.4) / 20, y = 3 * (k / 20 + 0.4) / 20;
            const double low = i == 0 ? 2.5 : i == 1 ? 2.5 + x / 8 : 3.5 - fabs(x - 2) / 2;
            const bool sky = x > 1.5 && x < 2.5 && y > 1 && y<2, trap = x> 3 && x < 3.5 && y > 1 && y < 2;
            assert_int_equal(inside(&list, "walls", x, y, low + 0.1) > 0, !sky);
            assert_int_equal(inside(&list, "walls", x, y, low - 0.01) > 0, 0);
            assert_int_equal(inside(&list, "walls", x, y, low + 0.21) > 0, 0);
            assert_int_equal(inside(&list, "glass/light", x, y, low + 0.19) > 0, sky);
            assert_int_equal(inside(&list, "glass/light", x, y, low + 0.17) > 0, 0);
            assert_int_equal(inside(&list, "walls", x, y, -0.1) > 0, !trap);
            assert_true(inside(&list, "walls", x, y, -0.02) > 0); /* the leaf */
        }
        assert_string_equal(face_at(&list, 1.5, 1.5, i == 2 ? 3.3 : i ? 2.75 : 2.6), "skylight/light/left");
        assert_string_equal(face_at(&list, 3.2, 2, -0.1), "hatch/trap/back");
        assert_string_equal(face_at(&list, 3.2, 1.5, 0), "hatch/trap/leaf-in");
        drop(&plan, &list);
        build(
            &plan, &list, text,
            "remodel-script 1\nresize light left 0.5 back 0.25\nmove trap by -0.25 0\nopen trap\nfill light with wall\n"
            "fill light with nothing\n");
        assert_int_equal(inside(&list, "walls", 1.1, 2.2, i == 2 ? 3.1 : i ? 2.7 : 2.6), 0);
        assert_int_equal(inside(&list, "walls", 2.8, 1.5, -0.02), 0);
        drop(&plan, &list);
    }
    refused(ROOM "skylight s on hall from 3.5 1 to 4.5 2\n", NULL,
            ":10: skylight s, from 3.5 1 to 4.5 2, does not lie between");
    refused(ROOM "skylight s on south from 3.5 1 to 4.5 2\n", NULL, "south is a wall; wanted a room");
    refused(ROOM "hatch s on hall from 1 1 to 2 2\nhatch t on hall from 1.5 1.5 to 3 3\n", NULL, "does not lie");
    refused(ROOM "hatch s on hall from 1 1 to 2 2\nhatch t on hall from 1.5 1.5 to 3 2.5\n", NULL, "overlap");
    refused(ROOM "hatch s on hall from 1 1 to 2 2\n", "remodel-script 1\nmove s by 5 0\n", "edit.txt:2: hatch s");
    refused(ROOM "hatch s on hall from 1 1 to 2 2\n", "remodel-script 1\nmove s by 1\n", "moves by two distances");
}

static void a_gable_has_two_planes_and_walls_reach_them(void **state)
{
    struct plan plan;
    struct solid_list list;
    (void)state;
    build(&plan, &list, ROOM,
          "remodel-script 1\ngable hall from west 2.5 to east 3 ridge 4 at 1\n"
          "wall new from 0.5 1 to 3.5 1\n");
    for (int i = 0; i < 44; i++) {
        const double x = 4.4 * (i + 0.4) / 44 - 0.2, z = fmin(2.5 + 1.5 * x, 4 - (x - 1) / 3);
        assert_true(inside(&list, "walls", x, 1.5, z + 0.1) > 0);
        assert_true(inside(&list, "walls", x, -0.1, z - 0.01) > 0);
        assert_int_equal(inside(&list, "walls", x, 1.5, z + 0.21), 0);
        if (x > 0 && x < 4) assert_int_equal(inside(&list, "walls", x, 1.5, z - 0.01), 0);
        if (x > 0.5 && x < 3.5) assert_true(inside(&list, "walls", x, 1.1, z - 0.01) > 0);
    }
    assert_string_equal(face_at(&list, 0.5, 2, 3.25), "ceiling/hall");
    assert_string_equal(face_at(&list, 2.5, 2, 3.5), "ceiling/hall");
    drop(&plan, &list);
    refused(ROOM "gable hall from west 2.5 to east 3 ridge 3\n", NULL, "the ridge of hall would be at 3");
    refused(ROOM "gable hall from west 2.5 to east 3 ridge 4 at 4\n", NULL, "is not between its walls, 4 apart");
    refused(ROOM "gable hall from west 2.5 to south 3 ridge 4\n", NULL, "not parallel");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_added_in_a_room_reaches_its_ceiling),
        cmocka_unit_test(a_wall_through_two_rooms_and_the_open_follows_each_ceiling),
        cmocka_unit_test(set_affects_later_statements_only),
        cmocka_unit_test(heights_of_rooms_walls_and_boxes_change),
        cmocka_unit_test(an_opening_is_resized_by_its_sides_and_moves_up),
        cmocka_unit_test(places_are_measured_from_walls_and_their_ends),
        cmocka_unit_test(openings_are_filled_with_leaf_glass_or_wall),
        cmocka_unit_test(ceilings_and_floors_have_openings),
        cmocka_unit_test(a_gable_has_two_planes_and_walls_reach_them),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
