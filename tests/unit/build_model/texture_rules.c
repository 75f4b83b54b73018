/* texture_rules.c - edited faces take the texture of their place in the unedited model. */
#include "stages/build_model/texture/texture_rules.h"

#include <math.h>

#include "tests/unit/build_model/textured.h"
#include "tests/unit/build_model/unions.h"

/* The face shows the unedited face `from` at `to` for its point `at`. */
static void assert_shows(const struct made *m, const char *name, struct vec3 at, const char *from, struct vec3 to)
{
    const struct texture_face *face = face_of(m, name, at);
    assert_int_equal(face->rules[0].kind, TEXTURE_PLACE);
    assert_string_equal(m->base.names[face->rules[0].from - 1].name, from);
    const struct vec3 place = texture_rule_place(&face->rules[0], at);
    assert_true(vec3_length(vec3_sub(place, to)) < 1e-9);
}

static double new_area(const struct texture_face *face)
{
    double area = 0;
    for (int i = 0; i < face->added_count; i++) {
        const struct vec3 *t = face->added[i];
        area += vec3_dot(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])), face->normal) / 2;
    }
    return area;
}

static double all_new_area(const struct made *m)
{
    double area = 0;
    for (int i = 0; i < m->map.face_count; i++) area += new_area(&m->map.faces[i]);
    return area;
}

static void a_face_that_does_not_change_shows_itself(void **state)
{
    struct made m;
    (void)state;
    make(&m, TWO "window w on south from 3 1 to 3.5 2\n", "remove w\n");
    assert_shows(&m, "wall/north/in", vec3_make(1, 3, 1), "wall/north/in", vec3_make(1, 3, 1));
    assert_shows(&m, "floor/left", vec3_make(1, 2, 0), "floor/left", vec3_make(1, 2, 0));
    /* but the wall, where the window was, on both sides */
    assert_true(fabs(all_new_area(&m) - 2 * 0.5) < 1e-9);
    assert_true(fabs(new_area(face_of(&m, "wall/south/in", vec3_make(3, 0, 1))) - 0.5) < 1e-9);
    release(&m);
}

static void a_wall_that_moves_carries_its_texture(void **state)
{
    struct made m;
    (void)state;
    make(&m, TWO, "move west by 0.5\n");
    assert_shows(&m, "wall/west/in", vec3_make(-0.5, 1, 1), "wall/west/in", vec3_make(0, 1, 1));
    assert_shows(&m, "wall/west/out", vec3_make(-0.7, 1, 1), "wall/west/out", vec3_make(-0.2, 1, 1));
    /* the floor stays where it is, and goes on */
    assert_shows(&m, "floor/left", vec3_make(0.1, 1, 0), "floor/left", vec3_make(0.1, 1, 0));
    assert_true(new_area(face_of(&m, "floor/left", vec3_make(0, 1, 0))) > 0.5 * 3 - 1e-9);
    assert_int_equal(face_of(&m, "wall/west/in", vec3_make(-0.5, 1, 1))->added_count, 0);
    release(&m);
}

static void reveals_of_a_wider_opening_move_with_its_sides(void **state)
{
    struct made m;
    (void)state;
    make(&m, TWO "passage p on middle from 1 0 to 2 2\n", "resize p left 0.25\n");
    const struct texture_face *side = NULL;
    for (int i = 0; i < m.map.face_count; i++)
        if (!strcmp(m.map.faces[i].name, "passage/p/left")) side = &m.map.faces[i];
    assert_non_null(side);
    const struct vec3 at = vec3_add(vec3_scale(side->normal, side->offset), vec3_make(2.05, 0, 1));
    const struct vec3 to = texture_rule_place(&side->rules[0], at);
    assert_true(fabs(vec3_length(vec3_sub(at, to)) - 0.25) < 1e-9);
    assert_int_equal(side->added_count, 0);
    release(&m);
}

/* The point of the unedited model that a point of a face shows, by the first rule that holds. */
static struct vec3 place_shown(const struct made *m, const char *name, struct vec3 at)
{
    const struct texture_face *face = face_of(m, name, at);
    int k = 0;
    while (!texture_rule_holds(&face->rules[k], face->normal, at)) k++;
    assert_int_equal(face->rules[k].kind, TEXTURE_PLACE);
    assert_string_equal(m->base.names[face->rules[k].from - 1].name, name);
    return texture_rule_place(&face->rules[k], at);
}

/* The south wall is from x 4 to 0, at y 0. A window of 0.8 x 0.8, so with a band of 0.1. */
static void the_frame_of_a_window_moves_with_it(void **state)
{
    static const struct {
        double x, z, to_x, to_z;
    } cases[] = {
        {1.65, 1.5, 0.95, 1.4}, /* the frame's sides, corner, head and sill */
        {2.55, 1.5, 1.85, 1.4}, {1.62, 1.92, 0.92, 1.82}, {2.0, 1.95, 1.3, 1.85},
        {2.0, 1.05, 1.3, 0.95}, {1.2, 1.3, 0.6, 1.3}, /* the old place: its left half mirrors what is left of 0.9 ... */
        {0.95, 1.3, 0.85, 1.3},                       /* ... its frame too ... */
        {1.5, 1.3, 2.3, 1.3},                         /* ... and its right half what is right of 1.9 */
        {3.5, 1.3, 3.5, 1.3},                         /* the rest of the wall stays */
        {1.2, 2.2, 1.2, 2.2},
    };
    struct made m;
    (void)state;
    make(&m, ROOM "window w on south from 1 1 to 1.8 1.8\n", "move w by 0.7 0.1\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int out = 0; out < 2; out++) {
            const double y = out ? -0.2 : 0;
            const struct vec3 p =
                place_shown(&m, out ? "wall/south/out" : "wall/south/in", vec3_make(cases[i].x, y, cases[i].z));
            assert_true(vec3_length(vec3_sub(p, vec3_make(cases[i].to_x, y, cases[i].to_z))) < 1e-9);
        }
    release(&m);
    /* its wall moves too; and one side is mirrored where the other has another window */
    make(&m, ROOM "window w on south from 1 1 to 1.8 1.8\nwindow v on south from 0.2 1 to 0.6 1.8\n",
         "move south by 0.5\nmove w by 0.9\n");
    struct vec3 p = place_shown(&m, "wall/south/in", vec3_make(2.75, -0.5, 1.5));
    assert_true(vec3_length(vec3_sub(p, vec3_make(1.85, 0, 1.5))) < 1e-9);
    p = place_shown(&m, "wall/south/in", vec3_make(1.1, -0.5, 1.5));
    assert_true(vec3_length(vec3_sub(p, vec3_make(2.7, 0, 1.5))) < 1e-9);
    release(&m);
    /* a statement says otherwise; a window that becomes wider keeps the wall's texture in place */
    make(&m, ROOM "window w on south from 1 1 to 1.8 1.8\n", "move w by 0.7\ntexture south crop\n");
    p = place_shown(&m, "wall/south/in", vec3_make(1.65, 0, 1.5));
    assert_true(vec3_length(vec3_sub(p, vec3_make(1.65, 0, 1.5))) < 1e-9);
    release(&m);
    make(&m, ROOM "window w on south from 1 1 to 1.8 1.8\n", "resize w left 0.1\n");
    p = place_shown(&m, "wall/south/in", vec3_make(1.95, 0, 1.5));
    assert_true(vec3_length(vec3_sub(p, vec3_make(1.95, 0, 1.5))) < 1e-9);
    release(&m);
}

static void a_box_that_moves_carries_its_texture(void **state)
{
    struct made m;
    (void)state;
    make(&m, ROOM "box b from 1 1 to 1.5 1.5 top 1\n", "move b by 0.4 0.2\n");
    assert_shows(&m, "box/b/top", vec3_make(1.6, 1.5, 1), "box/b/top", vec3_make(1.2, 1.3, 1));
    assert_shows(&m, "box/b/right", vec3_make(1.9, 1.5, 0.5), "box/b/right", vec3_make(1.5, 1.3, 0.5));
    release(&m);
}

static void a_new_opening_has_sides_of_the_default_colour_lit_by_its_neighbours(void **state)
{
    struct made m;
    (void)state;
    make(&m, TWO, "passage p on middle from 1 0 to 2 2\n");
    for (int i = 0; i < m.map.face_count; i++) {
        const struct texture_face *f = &m.map.faces[i];
        if (strcmp(f->name, "passage/p/left")) continue;
        assert_int_equal(f->rule_count, 1);
        assert_int_equal(f->rules[0].kind, TEXTURE_COLOUR);
        assert_true(f->rules[0].lit_count >= 2);
        assert_true(fabs(new_area(f) - 2 * 0.1) < 1e-9);
    }
    release(&m);
}

static void a_wall_that_was_split_shows_what_was_there(void **state)
{
    struct made m;
    (void)state;
    make(&m, TWO, "split middle from 1 to 2 into rest\n");
    const struct texture_face *face = NULL;
    for (int i = 0; i < m.map.face_count; i++)
        if (!strcmp(m.map.faces[i].name, "wall/rest/in")) face = &m.map.faces[i];
    assert_non_null(face);
    assert_int_equal(face->rules[0].kind, TEXTURE_PLACE);
    assert_string_equal(m.base.names[face->rules[0].from - 1].name, "wall/middle/in");
    release(&m);
}

static void panes_show_what_lies_outdoors(void **state)
{
    struct made m;
    (void)state;
    make(&m, TWO "window w on south from 3 1 to 3.5 2\n", "resize w left 0.1\n");
    int panes = 0;
    for (int i = 0; i < m.map.face_count; i++) {
        if (strncmp(m.map.faces[i].name, "glass/", 6)) continue;
        assert_int_equal(m.map.faces[i].rules[0].kind, TEXTURE_OUTDOORS);
        panes++;
    }
    assert_int_equal(panes, 6);
    release(&m);
}

/* Every point of every edited face has a rule that covers it, whatever the edit. */
static void every_face_has_a_rule_that_covers_all_of_it(void **state)
{
    static const char *const edits[] = {"remove middle\n",
                                        "move south by 0.3\nmove east by -0.2\n",
                                        "box b from 1 1 to 2 2 top 1\n",
                                        "change left ceiling 3\n",
                                        "wall new parallel to west by 1 between south north\n",
                                        "remove left\n",
                                        "remove south\nremove west\nremove north\nremove east\nremove middle\n"};
    (void)state;
    for (size_t e = 0; e < sizeof edits / sizeof *edits; e++) {
        struct made m;
        make(&m, TWO, edits[e]);
        for (int i = 0; i < m.map.face_count; i++) {
            const struct texture_face *f = &m.map.faces[i];
            const struct texture_rule *last = &f->rules[f->rule_count - 1];
            assert_true(f->rule_count > 0 && last->kind != TEXTURE_PLACE && !last->limited);
            assert_true(!i || m.map.faces[i - 1].id <= f->id);
        }
        release(&m);
    }
}

static double area_of_all(const struct solid_mesh *mesh)
{
    double area = 0;
    for (int i = 0; i < mesh->face_count; i++) area += solid_mesh_area(mesh, i);
    return area;
}

/* The floor and the ceiling remain; no texture comes from the walls that went. */
static void an_edit_that_removes_the_last_wall_leaves_floor_and_ceiling(void **state)
{
    struct made m;
    struct err err = ERR_INIT;
    (void)state;
    make(&m, ROOM, "remove south\nremove west\nremove north\nremove east\n");
    assert_ok(solid_mesh_check(&m.edited, 0, NULL, &err), err);
    for (int i = 0; i < m.map.face_count; i++) {
        const struct texture_face *f = &m.map.faces[i];
        assert_true(!strncmp(f->name, "floor/", 6) || !strncmp(f->name, "ceiling/", 8));
        const bool inside = !strcmp(f->name, "floor/hall") || !strcmp(f->name, "ceiling/hall");
        for (int k = 0; inside && k < f->rule_count; k++)
            if (f->rules[k].kind == TEXTURE_PLACE)
                assert_true(strncmp(m.base.names[f->rules[k].from - 1].name, "wall/", 5) != 0);
    }
    release(&m);
}

/* Two boxes that share an edge: their faces have their own rules, and all of their area is new. */
static void an_edit_whose_solids_touch_in_an_edge_has_rules_for_all_faces(void **state)
{
    struct made m;
    struct err err = ERR_INIT;
    double added = 0;
    (void)state;
    make(&m, ROOM, "box a from 1 1 to 1.5 1.5 foot 0.5 top 1\nbox b from 1.5 1.5 to 2 2 foot 0.5 top 1\n");
    assert_ok(solid_mesh_check(&m.edited, 0, NULL, &err), err);
    for (int i = 0; i < m.map.face_count; i++) {
        const struct texture_face *f = &m.map.faces[i];
        assert_true(f->rule_count > 0);
        added += new_area(f);
    }
    assert_true(fabs(added - (area_of_all(&m.edited) - area_of_all(&m.base))) < 1e-6);
    assert_true(fabs(added - 2 * 6 * 0.25) < 1e-6);
    release(&m);
}

/* ------------------------------------------------------------------------------------------------------ statements */

static void a_colour_covers_a_face_or_all_of_a_box(void **state)
{
    struct made m;
    (void)state;
    make(&m, ROOM, "box b from 1 1 to 2 2 top 1\ncolour box/b 0.2 0.4 0.6\ncolour wall/west/in 1 0 0\n");
    int sides = 0;
    for (int i = 0; i < m.map.face_count; i++) {
        const struct texture_face *f = &m.map.faces[i];
        if (strncmp(f->name, "box/b/", 6)) continue;
        sides++;
        assert_int_equal(f->rules[0].kind, TEXTURE_COLOUR);
        assert_true(fabsf(f->rules[0].albedo[2] - 0.6F) < 1e-6F);
    }
    assert_int_equal(sides, 5);
    /* a face with a place of its own is lit like itself */
    const struct texture_face *west = face_of(&m, "wall/west/in", vec3_make(0, 1, 1));
    assert_int_equal(west->rules[0].kind, TEXTURE_COLOUR);
    assert_int_equal(west->rules[0].lit_count, 1);
    assert_int_equal(west->rules[0].lit[0], west->id);
    release(&m);
}

static void the_default_colour_is_that_of_the_script(void **state)
{
    struct made m;
    (void)state;
    make(&m, ROOM, "set colour 0.5 0.25 0\nbox b from 1 1 to 2 2 top 1\n");
    for (int i = 0; i < m.map.face_count; i++)
        if (!strncmp(m.map.faces[i].name, "box/b/", 6))
            assert_true(fabsf(m.map.faces[i].rules[0].albedo[1] - 0.25F) < 1e-6F);
    release(&m);
}

/* The point of the base that the first rule shows which holds `at`. */
static struct vec3 shown_at(const struct made *m, const char *name, struct vec3 at, int *from)
{
    const struct texture_face *f = face_of(m, name, at);
    for (int i = 0; i < f->rule_count; i++) {
        if (!texture_rule_holds(&f->rules[i], f->normal, at)) continue;
        *from = f->rules[i].from;
        return texture_rule_place(&f->rules[i], at);
    }
    fail_msg("no rule of %s holds the point", name);
    return at;
}

static void a_copied_patch_keeps_its_scale_and_is_repeated(void **state)
{
    struct made m;
    int from;
    (void)state;
    /* the wall runs from x 4 to x 0: seen from inside, its left is at x 4 */
    make(&m, ROOM, "copy texture wall/south/in from 1 1 to 2 1.5 to wall/north/in from 0.5 0.5 to 3 1.25\n");
    struct vec3 p = shown_at(&m, "wall/north/in", vec3_make(0.5, 3, 0.5), &from);
    assert_string_equal(m.base.names[from - 1].name, "wall/south/in");
    assert_true(vec3_length(vec3_sub(p, vec3_make(2, 0, 1))) < 1e-9); /* the left corner of both */
    p = shown_at(&m, "wall/north/in", vec3_make(0.7, 3, 0.6), &from);
    assert_true(vec3_length(vec3_sub(p, vec3_make(1.8, 0, 1.1))) < 1e-9);
    p = shown_at(&m, "wall/north/in", vec3_make(1.7, 3, 1.1), &from); /* the next copy, and the one above */
    assert_true(vec3_length(vec3_sub(p, vec3_make(1.8, 0, 1.1))) < 1e-9);
    p = shown_at(&m, "wall/north/in", vec3_make(3.5, 3, 1), &from); /* outside of the place */
    assert_string_equal(m.base.names[from - 1].name, "wall/north/in");
    release(&m);
}

static void the_last_statement_about_a_face_counts(void **state)
{
    struct made m;
    int from;
    (void)state;
    make(&m, ROOM,
         "copy texture wall/south/in from 1 1 to 2 2 to wall/north/in\n"
         "copy texture wall/west/in from 1 1 to 2 2 to wall/north/in from 0.5 0.5 to 1.5 1.5\n");
    shown_at(&m, "wall/north/in", vec3_make(1, 3, 1), &from);
    assert_string_equal(m.base.names[from - 1].name, "wall/west/in");
    shown_at(&m, "wall/north/in", vec3_make(2, 3, 1), &from);
    assert_string_equal(m.base.names[from - 1].name, "wall/south/in");
    release(&m);
}

static void a_stretched_pane_shows_its_whole_picture(void **state)
{
    struct made m;
    (void)state;
    make(&m, ROOM "window w on south from 1 1 to 2 2\n", "resize w right 1 top 0.25\ntexture w stretch\n");
    for (int i = 0; i < m.map.face_count; i++) {
        const struct texture_face *f = &m.map.faces[i];
        if (strcmp(f->name, "glass/w/in")) continue;
        assert_int_equal(f->rules[0].kind, TEXTURE_PLACE);
        /* seen from inside, right is towards smaller x: the pane is now from x 0 to 2 */
        const struct vec3 low = texture_rule_place(&f->rules[0], vec3_make(0, f->offset * f->normal.y, 1));
        const struct vec3 high = texture_rule_place(&f->rules[0], vec3_make(2, f->offset * f->normal.y, 2.25));
        assert_true(fabs(low.x - 1) < 1e-5 && fabs(low.z - 1) < 1e-5);
        assert_true(fabs(high.x - 2) < 1e-5 && fabs(high.z - 2) < 1e-5);
        release(&m);
        return;
    }
    fail_msg("there is no pane");
}

/* The partition between the rooms makes two faces of the long wall. */
static void a_face_in_two_parts_is_stretched_and_covered_as_one(void **state)
{
    struct made m;
    int from;
    (void)state;
    make(&m, TWO,
         "texture north stretch\ncopy texture wall/west/in from 1 1 to 2 2 to wall/south/in\nmove east by 0.5\n");
    assert_true(faces_called(&m.edited, "wall/north/in") == 2 && faces_called(&m.edited, "wall/south/in") == 2);
    /* the wall was from x 0 to 4, and is now from 0 to 4.5 */
    for (int i = 1; i < 9; i++) {
        const struct vec3 p = shown_at(&m, "wall/north/in", vec3_make(0.5 * i, 3, 1), &from);
        assert_true(vec3_length(vec3_sub(p, vec3_make(0.5 * i * 4 / 4.5, 3, 1))) < 1e-5);
        shown_at(&m, "wall/south/in", vec3_make(0.5 * i - 0.1, 0, 1.1), &from);
        assert_string_equal(m.base.names[from - 1].name, "wall/west/in");
    }
    release(&m);
}

/* The gable's planes rise by 1 over 1.5, from y 0 and from y 3. */
static void a_patch_of_a_sloping_ceiling_keeps_its_scale(void **state)
{
    struct made m;
    int from;
    (void)state;
    make(&m, ROOM "gable hall from south 2.5 to north 2.5 ridge 3.5\n",
         "copy texture ceiling/hall from 1 2 to 2 2.75 to wall/west/in from 0.5 0 to 2.5 1\n");
    /* the patch is 0.75 wide in plan, and sqrt(1 + 4 / 9) times as wide along the slope */
    const struct vec3 a = shown_at(&m, "wall/west/in", vec3_make(0, 1.5 - 1e-9, 0.1), &from);
    const struct vec3 b = shown_at(&m, "wall/west/in", vec3_make(0, 1.5 - 1e-9, 0.6), &from);
    assert_string_equal(m.base.names[from - 1].name, "ceiling/hall");
    assert_true(fabs(vec3_length(vec3_sub(a, b)) - 0.5) < 1e-9);
    for (int i = 0; i < 40; i++) {
        const struct vec3 at = vec3_make(0, 0.5 + 0.05 * i + 0.02, 0.4);
        const struct vec3 p = shown_at(&m, "wall/west/in", at, &from);
        assert_true(p.x >= 1 && p.x <= 2 && p.y >= 2 && p.y <= 2.75);
        assert_true(fabs(p.z - (2.5 + (3 - p.y) * 2 / 3)) < 1e-9); /* in the plane above the patch */
    }
    release(&m);
}

static void a_patch_lies_where_the_unedited_model_has_it(void **state)
{
    struct made m;
    int from;
    (void)state;
    /* the patch is 0.5 from the north wall's left end, x 0; its left neighbour then moves */
    make(&m, TWO, "move west by 0.5\ncopy texture wall/north/in at left 0.5 width 1 from 1 to 2 to wall/east/in\n");
    const struct vec3 p = shown_at(&m, "wall/east/in", vec3_make(4, 3 - 0.25, 0.25), &from);
    assert_string_equal(m.base.names[from - 1].name, "wall/north/in");
    assert_true(vec3_length(vec3_sub(p, vec3_make(0.75, 3, 1.25))) < 1e-9);
    release(&m);
    /* also of a wall that is gone */
    make(&m, TWO, "remove middle\ncopy texture wall/middle/in from 1 1 to 2 2 to wall/east/in\n");
    shown_at(&m, "wall/east/in", vec3_make(4, 1, 1), &from);
    assert_string_equal(m.base.names[from - 1].name, "wall/middle/in");
    release(&m);
}

static void rooms_are_cleared_but_for_what_is_kept(void **state)
{
    struct made m;
    (void)state;
    make(&m, TWO, "clear left\nkeep from 0.5 0.5 to 1 1 top 1\n");
    assert_true(texture_map_clears(&m.map, vec3_make(1.5, 1.5, 0.5)));
    assert_false(texture_map_clears(&m.map, vec3_make(3, 1.5, 0.5)));     /* the other room */
    assert_false(texture_map_clears(&m.map, vec3_make(0.75, 0.75, 0.5))); /* kept */
    assert_true(texture_map_clears(&m.map, vec3_make(0.75, 0.75, 1.5)));  /* above that */
    release(&m);
    make(&m, TWO, "clear all\n");
    assert_true(texture_map_clears(&m.map, vec3_make(1.5, 1.5, 0.5)));
    assert_true(texture_map_clears(&m.map, vec3_make(3, 1.5, 0.5)));
    release(&m);
}

/* The wall `middle` between the rooms is at x = 2, thickness as TWO says; the passage goes from y = 1 to 1.5. */
static void the_space_before_an_opening_is_cleared_on_both_sides(void **state)
{
    struct made m;
    (void)state;
    make(&m, TWO, "passage p on middle from 1 0 to 1.5 2\nclear before p by 0.5 top 1.8\n");
    for (int side = -1; side <= 1; side += 2) {
        const double middle = 2, x = middle + side * 0.4;
        assert_true(texture_map_clears(&m.map, vec3_make(x, 1.25, 1)));
        assert_true(texture_map_clears(&m.map, vec3_make(x, 0.96, 1)));
        assert_false(texture_map_clears(&m.map, vec3_make(x, 0.94, 1)));
        assert_false(texture_map_clears(&m.map, vec3_make(x, 1.25, 1.9)));
        assert_false(texture_map_clears(&m.map, vec3_make(middle + side * 0.9, 1.25, 1)));
    }
    release(&m);
}

static void faces_that_are_not_there_are_named(void **state)
{
    static const struct {
        const char *edit, *words;
    } cases[] = {
        {"colour wall/sout/in 0 0 0\n",
         "edit.txt:2: the edited model has no face wall/sout/in; did you mean wall/south/in?"},
        {"remove west\ncolour wall/west/in 0 0 0\n", "the edited model has no face wall/west/in"},
        {"box b from 1 1 to 2 2\ncopy texture wall/east/in from 1 1 to 2 2 to box/c/top\n", "no face box/c/top"},
        {"copy texture wall/west/in from 1 1 to 1.01 1.01 to wall/east/in\n", "repeated"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct err err = ERR_INIT;
        struct made m;
        assert_int_not_equal(try_make(&m, ROOM, cases[i].edit, &err), ST_OK);
        assert_err(err, ST_DATA, cases[i].words);
        release(&m);
    }
}

static void statements_without_meaning_are_refused(void **state)
{
    static const struct {
        const char *edit, *words;
    } cases[] = {
        {"texture west strech\n", "\"stretch\" or \"crop\""},
        {"texture wst crop\n", "did you mean west?"},
        {"colour wall/west/in 0 0 1.5\n", "a share of light, from 0 to 1"},
        {"colour west 0 0 0\n", "a face, such as wall/south/in"},
        {"clear hal\n", "did you mean hall?"},
        {"keep hall\n", "\"in VIEW\" or \"from\""},
        {"clear before hall by 1\n", "a door, passage or window"},
        {"passage p on west from 1 0 to 1.5 2\nclear before p by 0\n", "a distance of 0 from the wall"},
        {"keep from 1 1 to 2 2 foot 2 top 1\n", "a top above the foot"},
        {"copy texture box/b/top from 0 0 to 1 1 to wall/west/in\n", "a place on box/b/top cannot be given"},
        {"copy texture wall/west/in from 1 1 to 2 2 to wall/east/start from 0 0 to 1 1\n",
         "a place on wall/east/start cannot be given"},
        {"copy texture floor/hall/bottom from 0 0 to 1 1 to wall/west/in\n", "a place on floor/hall/bottom cannot"},
        {"wall new parallel to west by 1 between south north\n"
         "copy texture wall/new/in from 0 0 to 1 1 to wall/west/in\n",
         "edit.txt:3: new is not in the unedited model, whose texture is copied."},
        {"copy texture wall/wst/in from 0 0 to 1 1 to wall/west/in\n", "did you mean west?"},
        {"remove west\nbase other\n", "as the first statement"},
        {"base none\n", "edit.txt:2: found \"none\", wanted the name of another edit"},
        {"set colour 1 1\n", "a share of blue light"},
        {"set colour 0.5 0.5 0.5\nset colour 0.5 0.5 0.5\n", "changes nothing"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char whole[1024];
        snprintf(whole, sizeof whole, "remodel-script 1\n%s", cases[i].edit);
        refused(ROOM, whole, cases[i].words);
    }
    refused("remodel-script 1\nset ceiling 2.5\nset thickness 0.2\nwall w from 0 0 to 4 0\n",
            "remodel-script 1\nclear all\n", "edit.txt:2: the model has no rooms that could be");
}

static void the_unedited_model_has_no_statements_about_textures(void **state)
{
    static const char *const statements[] = {"set colour 1 1 1",
                                             "texture west stretch",
                                             "colour wall/west/in 0 0 0",
                                             "copy texture wall/west/in from 1 1 to 2 2 to wall/east/in",
                                             "clear all",
                                             "keep from 1 1 to 2 2"};
    (void)state;
    only_for_edits(ROOM, statements, sizeof statements / sizeof *statements);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_face_that_does_not_change_shows_itself),
        cmocka_unit_test(a_wall_that_moves_carries_its_texture),
        cmocka_unit_test(the_frame_of_a_window_moves_with_it),
        cmocka_unit_test(reveals_of_a_wider_opening_move_with_its_sides),
        cmocka_unit_test(a_box_that_moves_carries_its_texture),
        cmocka_unit_test(a_new_opening_has_sides_of_the_default_colour_lit_by_its_neighbours),
        cmocka_unit_test(a_wall_that_was_split_shows_what_was_there),
        cmocka_unit_test(panes_show_what_lies_outdoors),
        cmocka_unit_test(every_face_has_a_rule_that_covers_all_of_it),
        cmocka_unit_test(an_edit_that_removes_the_last_wall_leaves_floor_and_ceiling),
        cmocka_unit_test(an_edit_whose_solids_touch_in_an_edge_has_rules_for_all_faces),
        cmocka_unit_test(a_colour_covers_a_face_or_all_of_a_box),
        cmocka_unit_test(the_default_colour_is_that_of_the_script),
        cmocka_unit_test(a_copied_patch_keeps_its_scale_and_is_repeated),
        cmocka_unit_test(the_last_statement_about_a_face_counts),
        cmocka_unit_test(a_stretched_pane_shows_its_whole_picture),
        cmocka_unit_test(a_face_in_two_parts_is_stretched_and_covered_as_one),
        cmocka_unit_test(a_patch_of_a_sloping_ceiling_keeps_its_scale),
        cmocka_unit_test(a_patch_lies_where_the_unedited_model_has_it),
        cmocka_unit_test(rooms_are_cleared_but_for_what_is_kept),
        cmocka_unit_test(the_space_before_an_opening_is_cleared_on_both_sides),
        cmocka_unit_test(faces_that_are_not_there_are_named),
        cmocka_unit_test(statements_without_meaning_are_refused),
        cmocka_unit_test(the_unedited_model_has_no_statements_about_textures),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
