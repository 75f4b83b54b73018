/* shell.c - pictures of painted boxes: what each pixel takes its colour from, and which colour it gets. */
#include "stages/render_model/shell.h"

#include "tests/unit/render_model/painted_room.h"
#include "tests/unit/render_model/shell_doubles.h"

#include "common/base/parallel.h"
#include "stages/render_model/shell_scene.h"

static const struct box room[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"box", "box", {-0.5, 0.4, 0.2}, {0.7, 2, 1.1}, false}};
static const struct box bare[] = {ROOM_OUTSIDE, ROOM_INSIDE};
static const struct outdoors some_outdoors;

/* The view of viewpoint a, that of b beside it, and one between them. */
static struct view view_a(void) { return view_at(vec3_make(-0.4, -0.3, -1.3), 0.1, 0.05, W, H, 60); }
static struct view view_b(void) { return view_at(vec3_make(0.6, -0.1, -1.1), -0.25, -0.02, W, H, 60); }
static struct view view_between(void) { return view_at(vec3_make(0.1, -0.2, -1.2), -0.05, 0.03, W, H, 60); }

static struct shell_scene *make_scene_with(struct solid_mesh mesh, struct texture_map map, const char *vita)
{
    struct shell_scene *scene;
    struct err err = ERR_INIT;
    assert_ok(shell_make(&scene, &mesh, &map, scratch_path("vdta"), vita, 100, &err), err);
    return scene;
}

static struct shell_scene *make_scene(const struct box *boxes, int count)
{
    return make_scene_with(make_boxes(boxes, count), (struct texture_map){0}, scratch_path("vita"));
}

static struct model_picture draw(struct shell_scene *scene, const struct view *camera, const char *a, const char *b,
                                 double t)
{
    const char *const photos[2] = {a, b};
    struct model_picture p = {0};
    struct err err = ERR_INIT;
    assert_ok(shell_draw(&p, scene, camera, photos, t, &some_outdoors, &err), err);
    for (int i = 0; i < 3 * p.width * p.height; i++) assert_true(isfinite(p.rgb[i]) && p.rgb[i] >= 0);
    for (int i = 0; i < p.width * p.height; i++) assert_true(isfinite(p.z[i]) && (p.z[i] > 0) == (p.id[i] > 0));
    return p;
}

/* The room with a box, viewpoints a and b and the VITA in three values. */
static void paint_room(enum paint paint, double a, double b, double vita)
{
    struct solid_mesh mesh = make_boxes(room, 3);
    const struct view from_a = view_a(), from_b = view_b();
    paint_viewpoint(&mesh, &from_a, "a", paint, a);
    paint_viewpoint(&mesh, &from_b, "b", paint, b);
    paint_vita(&mesh, paint, vita, 0.05);
    solid_mesh_release(&mesh);
}

static int pixels_made(const struct model_picture *p, enum picture_made made)
{
    int count = 0;
    for (int i = 0; i < p->width * p->height; i++) count += p->made[i] == made;
    return count;
}

static void assert_same_picture(const struct model_picture *p, const struct model_picture *q)
{
    const size_t pixels = (size_t)(p->width * p->height);
    assert_memory_equal(p->rgb, q->rgb, 3 * pixels * sizeof *p->rgb);
    assert_memory_equal(p->z, q->z, pixels * sizeof *p->z);
    assert_memory_equal(p->id, q->id, pixels * sizeof *p->id);
    assert_memory_equal(p->made, q->made, pixels);
}

/* Pixel (x, y) shows the face of this name. */
static bool shows(const struct shell_scene *s, const struct model_picture *p, int at, const char *name)
{
    for (int i = 0; i < s->mesh.name_count; i++)
        if (s->mesh.names[i].id == (int)p->id[at]) return !strcmp(s->mesh.names[i].name, name);
    return false;
}

/* ------------------------------------------------------------------------------------------------- the two viewpoints */

static void an_original_view_has_the_photos_own_bits(void **state)
{
    (void)state;
    paint_room(NOISE, 0, 0, 0);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_a();
    for (int k = 0; k < 2; k++) { /* beside another viewpoint of no weight, too */
        struct model_picture p = draw(scene, &view, "a", k ? "b" : NULL, 0);
        assert_int_equal(pixels_made(&p, MADE_ORIGINAL), W * H);
        for (int i = 0; i < W * H; i++)
            for (int c = 0; c < 3; c++) assert_true(p.rgb[3 * i + c] == noise_value("a", i % W, i / W, c));
        model_picture_release(&p);
    }
    struct model_picture p = draw(scene, &view, "b", "a", 1);
    for (int i = 0; i < 3 * W * H; i++) assert_true(p.rgb[i] == noise_value("a", i / 3 % W, i / 3 / W, i % 3));
    model_picture_release(&p);
    shell_close(scene);
}

/* Against atlas_find() and atlas_sample() in the same places. */
static void look_ups_agree_with_those_of_the_atlas(void **state)
{
    (void)state;
    paint_room(SMOOTH, 0, 0, 0);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_between();
    struct model_picture p = draw(scene, &view, "a", NULL, 0);
    struct atlas atlas;
    struct atlas_page pages[8];
    struct err err = ERR_INIT;
    char folder[512];
    int compared = 0;
    snprintf(folder, sizeof folder, "%s/a", scratch_path("vdta"));
    assert_ok(atlas_read(&atlas, folder, &err), err);
    assert_true(atlas.page_count <= 8);
    for (int i = 0; i < atlas.page_count; i++) assert_ok(atlas_page_read(&pages[i], &atlas, i, folder, &err), err);
    for (int i = 0; i < W * H; i++) {
        const struct vec3 at = view_unproject(&view, i % W + 0.5, i / W + 0.5, p.z[i]);
        double x, y;
        float rgb[3];
        const struct atlas_tile *t = atlas_find(&atlas, (int)p.id[i], at, &x, &y);
        if (!t || !atlas_sample(rgb, NULL, &pages[t->page], t, x, y)) {
            assert_int_not_equal(p.made[i], MADE_ORIGINAL);
            continue;
        }
        assert_int_equal(p.made[i], MADE_ORIGINAL);
        for (int c = 0; c < 3; c++) assert_true(fabsf(p.rgb[3 * i + c] - rgb[c]) < 1e-3f); /* 1/512 texel */
        compared++;
    }
    assert_true(compared > W * H / 2 && compared < W * H);
    for (int i = 0; i < atlas.page_count; i++) atlas_page_release(&pages[i]);
    atlas_release(&atlas);
    model_picture_release(&p);
    shell_close(scene);
}

static void between_viewpoints_their_textures_are_blended_and_the_vita_fills_the_rest(void **state)
{
    (void)state;
    paint_room(FLAT, 1, 3, 5);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_at(vec3_make(0.1, -0.2, -1.2), -0.05, 0.5, W, H, 45); /* looks lower than both */
    for (int k = 0; k <= 4; k++) {
        const double t = 0.25 * k;
        struct model_picture p = draw(scene, &view, "a", "b", t);
        int both = 0, one = 0, none = 0;
        for (int i = 0; i < W * H; i++) {
            const float value = p.rgb[3 * i];
            both += value == (float)(1 + 2 * t) && p.made[i] == MADE_ORIGINAL;
            one += (value == 1 || value == 3) && p.made[i] == MADE_ORIGINAL;
            none += value == 5 && p.made[i] == MADE_WARPED;
            assert_true(value == (float)(1 + 2 * t) || value == 1 || value == 3 || value == 5);
        }
        assert_true(both > W * H / 10 && one > W * H / 20 && none > W * H / 10);
        assert_true(k == 0 || k == 4 || both + one + none == W * H);
        model_picture_release(&p);
    }
    shell_close(scene);
}

static void coincident_viewpoints_are_one_at_any_t(void **state)
{
    (void)state;
    paint_room(NOISE, 0, 0, 0);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_between();
    struct model_picture alone = draw(scene, &view, "a", NULL, 0);
    for (int k = 0; k <= 3; k++) {
        struct model_picture p = draw(scene, &view, "a", "a", k / 3.0), q = draw(scene, &view, NULL, "a", k / 3.0);
        assert_same_picture(&alone, &p);
        assert_same_picture(&alone, &q);
        model_picture_release(&p);
        model_picture_release(&q);
    }
    model_picture_release(&alone);
    shell_close(scene);
}

static void without_viewpoints_the_vita_alone_is_shown(void **state)
{
    (void)state;
    paint_room(SMOOTH, 0, 0, 0);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_between();
    struct model_picture p = draw(scene, &view, NULL, NULL, 0.5);
    assert_int_equal(pixels_made(&p, MADE_WARPED), W * H);
    for (int i = 0; i < W * H; i++) {
        const struct vec3 at = view_unproject(&view, i % W + 0.5, i / W + 0.5, p.z[i]);
        for (int c = 0; c < 3; c++) assert_true(fabs(p.rgb[3 * i + c] - smooth_value(at, c)) < 5e-3);
    }
    model_picture_release(&p);
    shell_close(scene);
}

/* A viewpoint that looks the other way: the matrices of its tiles take the picture's points to w < 0, and to w = 0 in the
 * plane of its centre. */
static void what_is_behind_a_viewpoint_is_not_looked_up(void **state)
{
    (void)state;
    struct solid_mesh mesh = make_boxes(bare, 2);
    const struct view back = view_at(vec3_make(0, 0, 0), M_PI, 0, W, H, 60),
                      ahead = view_at(vec3_make(0, 0, 0), 0, 0, W, H, 60);
    const struct view aside =
        view_at(vec3_make(0, 0, 0), M_PI / 2, 0, W + 1, H + 1, 20); /* the middle column has w = 0 */
    paint_viewpoint(&mesh, &back, "a", FLAT, 1);
    paint_vita(&mesh, FLAT, 5, 0.1);
    struct shell_scene *scene = make_scene(bare, 2);
    struct model_picture p = draw(scene, &ahead, "a", NULL, 0);
    for (int i = 0; i < W * H; i++) assert_true(p.rgb[3 * i] == 5);
    model_picture_release(&p);
    p = draw(scene, &aside, "a", NULL, 0);
    int seen = 0;
    for (int i = 0; i < (W + 1) * (H + 1); i++) {
        const int x = i % (W + 1);
        assert_true(p.rgb[3 * i] == 5 || (p.rgb[3 * i] == 1 && x != W / 2));
        seen += p.rgb[3 * i] == 1;
    }
    assert_true(seen > 100);
    model_picture_release(&p);
    shell_close(scene);
    solid_mesh_release(&mesh);
}

static void a_viewpoint_without_an_atlas_is_an_error(void **state)
{
    (void)state;
    paint_room(FLAT, 1, 3, 5);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_a();
    const char *const photos[2] = {"a", "absent"};
    struct model_picture p = {0};
    struct err err = ERR_INIT;
    assert_int_not_equal(shell_draw(&p, scene, &view, photos, 0.5, NULL, &err), ST_OK);
    assert_err(err, ST_DATA, "viewpoint absent has no atlas");
    model_picture_release(&p);
    shell_close(scene);
}

/* ------------------------------------------------------------------------------------------------------ hard cameras */

static void a_camera_in_a_faces_plane_has_a_whole_picture(void **state)
{
    (void)state;
    paint_room(SMOOTH, 0, 0, 0);
    struct shell_scene *scene = make_scene(room, 3);
    /* in the plane of the box's front, and in that of its side */
    const struct view views[] = {view_at(vec3_make(-1.2, 0.5, 0.2), 1.2, 0.1, W, H, 40),
                                 view_at(vec3_make(-0.5, 0.5, -1), 0, 0, W + 1, H + 1, 40)};
    for (int k = 0; k < 2; k++) {
        struct model_picture p = draw(scene, &views[k], "a", "b", 0.4);
        assert_int_equal(pixels_made(&p, MADE_NOTHING), 0);
        model_picture_release(&p);
    }
    shell_close(scene);
}

static void a_view_exactly_along_a_wall_is_finite(void **state)
{
    (void)state;
    paint_room(SMOOTH, 0, 0, 0);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_at(vec3_make(2, 0, -1), 0, 0, W + 1, H + 1, 40); /* in the wall x = 2 */
    struct model_picture p = draw(scene, &view, "a", "b", 0.4);
    for (int i = 0; i < p.width * p.height; i++)
        assert_int_equal(p.made[i] == MADE_OUTDOORS, i % p.width > W / 2 || !p.id[i]);
    assert_true(pixels_made(&p, MADE_NOTHING) == 0);
    model_picture_release(&p);
    shell_close(scene);
}

static void a_viewpoint_inside_what_an_edit_adds_sees_the_room(void **state)
{
    (void)state;
    const struct view view = view_at(vec3_make(0.1, 1.1, 0.6), 0.3, 0, W, H, 60); /* in the box */
    paint_room(SMOOTH, 0, 0, 0);
    struct shell_scene *with = make_scene(room, 3), *without = make_scene(bare, 2);
    struct model_picture p = draw(with, &view, NULL, NULL, 0), q = draw(without, &view, NULL, NULL, 0);
    assert_same_picture(&p, &q);
    model_picture_release(&p);
    model_picture_release(&q);
    shell_close(with);
    shell_close(without);
}

/* --------------------------------------------------------------------------------------------------- glass, outdoors */

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

/* ------------------------------------------------------------------------------------------------------- texture maps */

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

/* Texels of in/5 are 2, 4 and 9 by thirds, in three channels alike: the median is 4. */
static void a_colour_is_shown_under_the_median_radiance_of_the_lit_faces(void **state)
{
    (void)state;
    const struct view view = view_between();
    paint_room(FLAT, 1, 3, 5);
    for (int all = 0; all < 2; all++) {
        struct solid_mesh mesh = make_boxes(bare, 2);
        struct texture_rule rule = {.kind = TEXTURE_COLOUR, .albedo = {0.6f, 0.3f, 0.12f}};
        if (!all) {
            rule.lit = calloc(1, sizeof *rule.lit);
            assert_non_null(rule.lit);
            rule.lit[0] = id_named(&mesh, "in/0");
            rule.lit_count = 1;
        }
        const struct texture_map map = map_face(&mesh, "in/5", &rule, 1);
        struct shell_scene *scene = make_scene_with(mesh, map, scratch_path("vita"));
        struct model_picture p = draw(scene, &view, "a", NULL, 0);
        for (int i = 0; i < W * H; i++) {
            if (!shows(scene, &p, i, "in/5")) continue;
            assert_int_equal(p.made[i], MADE_COLOUR);
            for (int c = 0; c < 3; c++) assert_true(fabsf(p.rgb[3 * i + c] - 5 / 0.6f * rule.albedo[c]) < 1e-5f);
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

/* ---------------------------------------------------------------------------------------------------------- the rest */

static void threads_do_not_change_a_bit(void **state)
{
    (void)state;
    paint_room(SMOOTH, 0, 0, 0);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_between();
    parallel_set_threads(1);
    struct model_picture p = draw(scene, &view, "a", "b", 0.3);
    parallel_set_threads(4);
    struct model_picture q = draw(scene, &view, "a", "b", 0.3);
    parallel_set_threads(0);
    assert_same_picture(&p, &q);
    model_picture_release(&p);
    model_picture_release(&q);
    shell_close(scene);
}

static void samples_average_radiance(void **state)
{
    (void)state;
    paint_room(SMOOTH, 0, 0, 0);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_between();
    struct view fine = view;
    view_resize(&fine, 3 * W, 3 * H);
    struct model_picture one = draw(scene, &view, "a", "b", 0.3), nine = draw(scene, &fine, "a", "b", 0.3);
    shell_set_samples(scene, 3);
    struct model_picture p = draw(scene, &view, "a", "b", 0.3);
    for (int i = 0; i < 3 * W * H; i++) {
        const int x = i / 3 % W, y = i / 3 / W;
        double sum = 0;
        for (int k = 0; k < 9; k++) sum += nine.rgb[3 * ((3 * y + k / 3) * 3 * W + 3 * x + k % 3) + i % 3];
        assert_true(fabs(p.rgb[i] - sum / 9) < 2e-3);
    }
    assert_memory_equal(one.z, p.z, W * H * sizeof *p.z);
    assert_memory_equal(one.id, p.id, W * H * sizeof *p.id);
    assert_memory_equal(one.made, p.made, W * H);
    model_picture_release(&one);
    model_picture_release(&nine);
    model_picture_release(&p);
    shell_close(scene);
}

static void pages_of_faces_that_are_not_seen_are_not_read(void **state)
{
    (void)state;
    struct solid_mesh mesh = make_boxes(bare, 2);
    const struct view view = view_at(vec3_make(0, 0, -1), 0, 0, 700, 700, 2000); /* sees in/5 alone */
    paint_viewpoint(&mesh, &view, "large", FLAT, 1);                             /* a page for each face */
    paint_vita(&mesh, FLAT, 5, 0.1);
    struct shell_scene *scene = make_scene(bare, 2);
    struct model_picture p = draw(scene, &view, "large", NULL, 0);
    assert_int_equal(page_cache_stats(scene->pages).pages_read, 1);
    assert_int_equal(pixels_made(&p, MADE_ORIGINAL), 700 * 700);
    const char *const photos[2] = {"large", NULL};
    struct err err = ERR_INIT;
    assert_ok(shell_prepare(scene, photos, &err), err);
    assert_int_equal(page_cache_stats(scene->pages).pages_read, 12);
    model_picture_release(&p);
    shell_close(scene);
    solid_mesh_release(&mesh);
}

static void a_share_beyond_one_is_refused(void **state)
{
    (void)state;
    paint_room(FLAT, 1, 3, 5);
    struct shell_scene *scene = make_scene(room, 3);
    const struct view view = view_a();
    const char *const photos[2] = {"a", "b"};
    struct model_picture p = {0};
    struct err err = ERR_INIT;
    assert_int_not_equal(shell_draw(&p, scene, &view, photos, 1.5, NULL, &err), ST_OK);
    assert_err(err, ST_DATA, "1.5, wanted 0 to 1");
    shell_close(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_original_view_has_the_photos_own_bits),
        cmocka_unit_test(look_ups_agree_with_those_of_the_atlas),
        cmocka_unit_test(between_viewpoints_their_textures_are_blended_and_the_vita_fills_the_rest),
        cmocka_unit_test(coincident_viewpoints_are_one_at_any_t),
        cmocka_unit_test(without_viewpoints_the_vita_alone_is_shown),
        cmocka_unit_test(what_is_behind_a_viewpoint_is_not_looked_up),
        cmocka_unit_test(a_viewpoint_without_an_atlas_is_an_error),
        cmocka_unit_test(a_camera_in_a_faces_plane_has_a_whole_picture),
        cmocka_unit_test(a_view_exactly_along_a_wall_is_finite),
        cmocka_unit_test(a_viewpoint_inside_what_an_edit_adds_sees_the_room),
        cmocka_unit_test(panes_are_looked_through),
        cmocka_unit_test(rays_that_leave_the_model_show_what_is_outdoors),
        cmocka_unit_test(a_moved_wall_carries_its_texture_along),
        cmocka_unit_test(a_rule_counts_within_its_limits_and_the_next_one_elsewhere),
        cmocka_unit_test(a_colour_is_shown_under_the_median_radiance_of_the_lit_faces),
        cmocka_unit_test(beyond_its_texels_a_face_repeats_those_of_its_edge),
        cmocka_unit_test(a_pane_with_a_texture_of_its_own_is_drawn),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(samples_average_radiance),
        cmocka_unit_test(pages_of_faces_that_are_not_seen_are_not_read),
        cmocka_unit_test(a_share_beyond_one_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
