/* shell_rules.c - pictures of a painted room: panes, what is outdoors, and the rules of texture maps. */
#include "stages/render_model/shell.h"

#include "tests/unit/render_model/shell_pictures.h"

/* -------------------------------------------------------------------------------------------------- glass, outdoors */

static const struct box with_pane[] = {
    ROOM_OUTSIDE, ROOM_INSIDE, {"glass/pane", "pane", {-1, -1, 0}, {1, 1, 0.1}, false}};

static void panes_are_looked_through(void **state)
{
    (void)state;
    paint_room(SMOOTH, 0, 0, 0);
    const struct view view = view_between();
    struct shell_scene *with = make_scene(with_pane, 3), *without = make_scene(bare, 2);
    struct model_picture p = draw(with, &view, NULL, NULL, 0), q = draw(without, &view, NULL, NULL, 0);
    assert_same_picture(&p, &q);
    model_picture_release(&p);
    model_picture_release(&q);
    shell_close(with);
    shell_close(without);
}

static void rays_that_leave_the_model_show_what_is_outdoors(void **state)
{
    (void)state;
    paint_room(FLAT, 1, 3, 5);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_at(vec3_make(1, 0.5, -9), 0.1, 0, W, H, 60); /* from outside */
    struct model_picture p = draw(scene, &view, NULL, NULL, 0);
    int outside = 0;
    for (int i = 0; i < W * H; i++) {
        if (p.made[i] != MADE_OUTDOORS) continue;
        float wanted[3];
        outdoors_formula(wanted, vec3_sub(view_unproject(&view, i % W + 0.5, i / W + 0.5, 1), view.center));
        for (int c = 0; c < 3; c++) assert_true(fabsf(p.rgb[3 * i + c] - wanted[c]) < 1e-6f);
        outside++;
    }
    assert_true(outside > 500 && outside + pixels_made(&p, MADE_WARPED) == W * H);
    model_picture_release(&p);
    const char *const none[2] = {NULL, NULL};
    struct err err = ERR_INIT;
    assert_ok(shell_draw(&p, scene, &view, none, 0, NULL, &err), err);
    assert_int_equal(pixels_made(&p, MADE_NOTHING), outside);
    model_picture_release(&p);
    shell_close(scene);
}

/* What remains when an edit removes the last wall. */
static void a_model_without_faces_shows_what_is_outdoors(void **state)
{
    (void)state;
    paint_room(FLAT, 1, 3, 5);
    struct shell_scene *scene = make_scene_with((struct solid_mesh){0}, (struct texture_map){0}, scratch_path("vita"));
    const struct view view = view_between();
    struct model_picture p = draw(scene, &view, "a", "b", 0.5);
    assert_int_equal(pixels_made(&p, MADE_OUTDOORS), W * H);
    const char *const none[2] = {NULL, NULL};
    struct err err = ERR_INIT;
    assert_ok(shell_draw(&p, scene, &view, none, 0, NULL, &err), err);
    assert_int_equal(pixels_made(&p, MADE_NOTHING), W * H);
    for (int i = 0; i < 3 * W * H; i++) assert_true(p.rgb[i] == 0);
    model_picture_release(&p);
    shell_close(scene);
}

/* ----------------------------------------------------------------------------------------------------- texture maps */

static const struct texture_rule in_place = {.matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/* A map with rules for one face of the mesh. */
static struct texture_map map_face(const struct solid_mesh *mesh, const char *name, const struct texture_rule *rules,
                                   int count)
{
    struct texture_map map = {.faces = calloc(1, sizeof *map.faces), .face_count = 1};
    assert_non_null(map.faces);
    for (int i = 0; i < mesh->face_count; i++) {
        if (strcmp(solid_face_name(mesh, i), name)) continue;
        map.faces[0] = (struct texture_face){.id = solid_face_id(mesh, i),
                                             .normal = mesh->faces[i].normal,
                                             .offset = mesh->faces[i].offset,
                                             .rules = calloc((size_t)count, sizeof *rules),
                                             .rule_count = count};
        assert_non_null(map.faces[0].rules);
        memcpy(map.faces[0].rules, rules, (size_t)count * sizeof *rules);
    }
    assert_int_not_equal(map.faces[0].id, 0);
    return map;
}

static int id_named(const struct solid_mesh *mesh, const char *name)
{
    for (int i = 0; i < mesh->name_count; i++)
        if (!strcmp(mesh->names[i].name, name)) return mesh->names[i].id;
    fail_msg("no face %s", name);
    return 0;
}

/* The wall in/5, z = 2, was moved to z = 1.5 and carries its texture along. */
static void a_moved_wall_carries_its_texture_along(void **state)
{
    (void)state;
    static const struct box moved[] = {ROOM_OUTSIDE, {"walls", "in", {-2, -2, -2}, {2, 2, 1.5}, true}};
    const struct view view = view_between();
    paint_room(SMOOTH, 0, 0, 0);
    struct solid_mesh mesh = make_boxes(moved, 2);
    struct texture_rule rule = in_place;
    rule.from = id_named(&mesh, "in/5");
    rule.matrix[2][3] = 0.5;
    const struct texture_map map = map_face(&mesh, "in/5", &rule, 1);
    struct shell_scene *scene = make_scene_with(mesh, map, scratch_path("vita"));
    for (int k = 0; k < 2; k++) {
        struct model_picture p = draw(scene, &view, k ? "a" : NULL, k ? "b" : NULL, 0.3);
        int shown = 0;
        for (int i = 0; i < W * H; i++) {
            struct vec3 at = view_unproject(&view, i % W + 0.5, i / W + 0.5, p.z[i]);
            if (!shows(scene, &p, i, "in/5")) continue;
            assert_true(fabs(at.z - 1.5) < 1e-5);
            at.z = 2;
            if (fmax(fabs(at.x), fabs(at.y)) > 1.9) continue; /* at its edge a look-up has fewer than four texels */
            for (int c = 0; c < 3; c++) assert_true(fabs(p.rgb[3 * i + c] - smooth_value(at, c)) < 1e-2);
            shown++;
        }
        assert_true(shown > 1000);
        model_picture_release(&p);
    }
    shell_close(scene);
}

/* A colour in a quadrilateral of a wall, given in either turn; the next rule elsewhere. */
static void a_rule_counts_within_its_limits_and_the_next_one_elsewhere(void **state)
{
    (void)state;
    const struct view view = view_between();
    paint_room(SMOOTH, 0, 0, 0);
    for (int turn = 0; turn < 2; turn++) {
        struct solid_mesh mesh = make_boxes(bare, 2);
        struct texture_rule rules[2] = {{.kind = TEXTURE_COLOUR, .albedo = {0.6f, 0.3f, 0}, .limited = true}, in_place};
        const struct vec3 corners[4] = {{-1, -0.5, 2}, {0.5, -0.5, 2}, {0.5, 0.75, 2}, {-1, 0.75, 2}};
        for (int k = 0; k < 4; k++) rules[0].within[k] = corners[turn ? 3 - k : k];
        rules[0].lit = calloc(1, sizeof *rules[0].lit);
        assert_non_null(rules[0].lit);
        rules[0].lit[0] = id_named(&mesh, "in/5");
        rules[0].lit_count = 1;
        rules[1].from = id_named(&mesh, "in/5");
        const struct texture_map map = map_face(&mesh, "in/5", rules, 2);
        struct shell_scene *scene = make_scene_with(mesh, map, scratch_path("vita"));
        struct model_picture p = draw(scene, &view, "a", "b", 0.3);
        int coloured = 0;
        for (int i = 0; i < W * H; i++) {
            const struct vec3 at = view_unproject(&view, i % W + 0.5, i / W + 0.5, p.z[i]);
            const bool inside = at.x > -1 && at.x < 0.5 && at.y > -0.5 && at.y < 0.75 && at.z > 1.99;
            assert_int_equal(p.made[i] == MADE_COLOUR, inside);
            coloured += inside;
        }
        assert_true(coloured > 500);
        model_picture_release(&p);
        shell_close(scene);
    }
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* The median of a channel of the VITA's texels on a face, 0: on all. */
static float vita_median(int face, int channel)
{
    struct atlas atlas;
    struct err err = ERR_INIT;
    size_t count = 0;
    assert_ok(atlas_read(&atlas, scratch_path("vita"), NULL, &err), err);
    float *values = calloc((size_t)atlas.page_count, ATLAS_PAGE * ATLAS_PAGE * sizeof *values);
    assert_non_null(values);
    for (int i = 0; i < atlas.tile_count; i++) {
        const struct atlas_tile *t = &atlas.tiles[i];
        struct atlas_page page;
        if (face && t->face != face) continue;
        assert_ok(atlas_page_read(&page, &atlas, t->page, scratch_path("vita"), NULL, &err), err);
        for (int k = 0; k < t->width * t->height; k++) {
            const int at = (t->y + k / t->width) * page.width + t->x + k % t->width;
            values[count++] = page.rgb[3 * at + channel];
        }
        atlas_page_release(&page);
    }
    qsort(values, count, sizeof *values, compare_floats);
    const float median = values[(count - 1) / 2];
    free(values);
    atlas_release(&atlas);
    return median;
}

static void a_colour_is_shown_under_the_median_radiance_of_the_lit_faces(void **state)
{
    (void)state;
    const struct view view = view_between();
    paint_room(SMOOTH, 0, 0, 0);
    for (int all = 0; all < 2; all++) {
        struct solid_mesh mesh = make_boxes(bare, 2);
        struct texture_rule rule = {.kind = TEXTURE_COLOUR, .albedo = {0.6f, 0.3f, 0.12f}};
        const int lit = all ? 0 : id_named(&mesh, "in/0");
        if (lit) {
            rule.lit = calloc(1, sizeof *rule.lit);
            assert_non_null(rule.lit);
            rule.lit[0] = lit;
            rule.lit_count = 1;
        }
        const struct texture_map map = map_face(&mesh, "in/5", &rule, 1);
        struct shell_scene *scene = make_scene_with(mesh, map, scratch_path("vita"));
        struct model_picture p = draw(scene, &view, "a", NULL, 0);
        float wanted[3];
        for (int c = 0; c < 3; c++) wanted[c] = vita_median(lit, c) * rule.albedo[c] / 0.6f;
        for (int i = 0; i < W * H; i++) {
            if (!shows(scene, &p, i, "in/5")) continue;
            assert_int_equal(p.made[i], MADE_COLOUR);
            for (int c = 0; c < 3; c++) assert_true(fabsf(p.rgb[3 * i + c] - wanted[c]) < 1e-5f);
        }
        assert_true(pixels_made(&p, MADE_COLOUR) > 1000);
        model_picture_release(&p);
        shell_close(scene);
    }
}

/* The wall in/5 was widened beyond its texels: they go on as those of its edge. */
static void beyond_its_texels_a_face_repeats_those_of_its_edge(void **state)
{
    (void)state;
    static const struct box wide[] = {{"walls", "out", {-5, -3, -3}, {5, 3, 3}, false},
                                      {"walls", "in", {-4, -2, -2}, {4, 2, 2}, true}};
    const struct view view = view_at(vec3_make(0, 0, -1), 0, 0, W, H, 30);
    paint_room(SMOOTH, 0, 0, 0);
    struct solid_mesh mesh = make_boxes(wide, 2);
    struct texture_rule rules[2] = {in_place, in_place};
    rules[0].from = rules[1].from = id_named(&mesh, "in/5");
    rules[1].kind = TEXTURE_EDGE;
    const struct texture_map map = map_face(&mesh, "in/5", rules, 2);
    struct shell_scene *scene = make_scene_with(mesh, map, scratch_path("vita"));
    struct model_picture p = draw(scene, &view, NULL, NULL, 0);
    int beyond = 0;
    for (int i = 0; i < W * H; i++) {
        struct vec3 at = view_unproject(&view, i % W + 0.5, i / W + 0.5, p.z[i]);
        if (!shows(scene, &p, i, "in/5")) continue;
        const bool known = fabs(at.x) < 2.1;
        if (fabs(fabs(at.x) - 2.1) < 0.06) continue; /* the end of the margin */
        assert_int_equal(p.made[i], known ? MADE_WARPED : MADE_SYNTHESISED);
        beyond += !known;
        at.x = fmin(fmax(at.x, -2.025), 2.025);
        for (int c = 0; c < 3; c++) assert_true(fabs(p.rgb[3 * i + c] - smooth_value(at, c)) < 0.06);
    }
    assert_true(beyond > 500);
    model_picture_release(&p);
    shell_close(scene);
}

static void a_pane_with_a_texture_of_its_own_is_drawn(void **state)
{
    (void)state;
    const struct view view = view_between();
    struct solid_mesh mesh = make_boxes(with_pane, 3);
    struct texture_rule rule = in_place;
    paint_vita(&mesh, FLAT, 5, 0.1);
    rule.from = id_named(&mesh, "pane/4");
    const struct texture_map map = map_face(&mesh, "pane/4", &rule, 1);
    struct shell_scene *scene = make_scene_with(mesh, map, scratch_path("vita"));
    struct model_picture p = draw(scene, &view, NULL, NULL, 0);
    int shown = 0;
    for (int i = 0; i < W * H; i++) shown += shows(scene, &p, i, "pane/4");
    assert_true(shown > 1000);
    model_picture_release(&p);
    shell_close(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(panes_are_looked_through),
        cmocka_unit_test(rays_that_leave_the_model_show_what_is_outdoors),
        cmocka_unit_test(a_model_without_faces_shows_what_is_outdoors),
        cmocka_unit_test(a_moved_wall_carries_its_texture_along),
        cmocka_unit_test(a_rule_counts_within_its_limits_and_the_next_one_elsewhere),
        cmocka_unit_test(a_colour_is_shown_under_the_median_radiance_of_the_lit_faces),
        cmocka_unit_test(beyond_its_texels_a_face_repeats_those_of_its_edge),
        cmocka_unit_test(a_pane_with_a_texture_of_its_own_is_drawn),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
