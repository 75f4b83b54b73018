/* own_pixels.c - which pixels of a photo an edit leaves alone: by face, by plane, by texture. */
#include "stages/render_model/own_pixels.h"

#include "tests/unit/render_model/shell_pictures.h"

static const struct texture_rule in_place = {.matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
static const struct texture_rule red = {.kind = TEXTURE_COLOUR, .albedo = {0.6f, 0.1f, 0.1f}};

/* A map of one face of the room, its back wall in/5, z = 2. The rules may name the face by from = 0. */
static struct texture_map back_wall(const struct solid_mesh *mesh, const struct texture_rule *rules, int count)
{
    struct texture_map map = {.faces = calloc(1, sizeof *map.faces), .face_count = 1};
    assert_non_null(map.faces);
    const int face = 11; /* of the second box, its sixth side */
    assert_string_equal(solid_face_name(mesh, face), "in/5");
    map.faces[0] = (struct texture_face){.id = solid_face_id(mesh, face),
                                         .normal = mesh->faces[face].normal,
                                         .offset = mesh->faces[face].offset,
                                         .rules = calloc((size_t)count, sizeof *rules),
                                         .rule_count = count};
    assert_non_null(map.faces[0].rules);
    for (int k = 0; k < count; k++) {
        map.faces[0].rules[k] = rules[k];
        if (rules[k].kind <= TEXTURE_EDGE && !rules[k].from) map.faces[0].rules[k].from = map.faces[0].id;
    }
    return map;
}

/* Where the photo of view_between() is kept when the room stands as it was, under a map. The caller frees it. */
static uint8_t *find_same(const struct texture_rule *rules, int count, double margin)
{
    struct render_model_params params = RENDER_MODEL_PARAMS_DEFAULT;
    struct view camera = view_between();
    struct room drawn = {.files = {.base = "model.txt"}, .params = &params, .cameras = &camera};
    struct solid_mesh mesh = make_boxes(bare, 2);
    const struct texture_map map = count ? back_wall(&mesh, rules, count) : (struct texture_map){0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    uint8_t *same = malloc((size_t)(W * H));
    assert_non_null(same);
    params.margin = margin;
    drawn.base = make_rays(bare, 2);
    drawn.model = make_rays(bare, 2);
    drawn.shell = make_scene_with(mesh, map, scratch_path("vita"));
    assert_ok(own_pixels_find(same, &drawn, 0, &prov, &err), err);
    shell_close(drawn.shell);
    model_rays_release(&drawn.base);
    model_rays_release(&drawn.model);
    return same;
}

/* Where a pixel of the view meets the inside of the room; *back: on its back wall. */
static struct vec3 seen_at(int i, bool *back)
{
    const struct view camera = view_between();
    const struct vec3 d = vec3_sub(view_unproject(&camera, i % W + 0.5, i / W + 0.5, 1), camera.center);
    double t = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double along = vec3_axis(d, k), from = vec3_axis(camera.center, k);
        t = fmin(t, along > 0 ? (2 - from) / along : along < 0 ? (-2 - from) / along : INFINITY);
    }
    const struct vec3 at = vec3_add(camera.center, vec3_scale(d, t));
    *back = at.z > 2 - 1e-9;
    return at;
}

static void a_wall_with_its_own_texture_in_place_keeps_the_photo(void **state)
{
    (void)state;
    const struct texture_rule own[2] = {in_place, {.kind = TEXTURE_EDGE, .matrix = {{1}, {0, 1}, {0, 0, 1}}}};
    const struct texture_rule pane = {.kind = TEXTURE_OUTDOORS};
    for (int k = 0; k < 3; k++) {
        uint8_t *same = k == 2 ? find_same(&pane, 1, 5) : find_same(own, 2 * k, 5);
        for (int i = 0; i < W * H; i++) assert_int_equal(same[i], 1);
        free(same);
    }
}

static void a_painted_wall_does_not_show_the_photo(void **state)
{
    (void)state;
    uint8_t *same = find_same(&red, 1, 0);
    int painted = 0;
    for (int i = 0; i < W * H; i++) {
        bool back;
        seen_at(i, &back);
        assert_int_equal(same[i], !back);
        painted += back;
    }
    assert_true(painted > 1000 && painted < W * H);
    free(same);
}

static void the_photo_ends_a_margin_before_the_paint(void **state)
{
    (void)state;
    uint8_t *none = find_same(&red, 1, 0), *some = find_same(&red, 1, 3);
    int between = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            bool near = false;
            for (int v = -3; v <= 3; v++)
                for (int u = -3; u <= 3; u++)
                    near |= x + u >= 0 && x + u < W && y + v >= 0 && y + v < H && u * u + v * v <= 9 &&
                            !none[(y + v) * W + x + u];
            assert_int_equal(some[y * W + x], !near);
            between += near && none[y * W + x];
        }
    assert_true(between > 100);
    free(none);
    free(some);
}

static void a_painted_rectangle_leaves_the_rest_of_the_wall(void **state)
{
    (void)state;
    struct texture_rule rules[2] = {red, in_place};
    const struct vec3 corners[4] = {{-1, -0.5, 2}, {0.5, -0.5, 2}, {0.5, 0.75, 2}, {-1, 0.75, 2}};
    rules[0].limited = true;
    memcpy(rules[0].within, corners, sizeof corners);
    uint8_t *same = find_same(rules, 2, 0);
    int painted = 0;
    for (int i = 0; i < W * H; i++) {
        bool back;
        const struct vec3 p = seen_at(i, &back);
        const bool inside = back && p.x >= -1 && p.x <= 0.5 && p.y >= -0.5 && p.y <= 0.75;
        assert_int_equal(same[i], !inside);
        painted += inside;
    }
    assert_true(painted > 200);
    free(same);
}

static void a_texture_that_is_moved_scaled_or_another_faces_is_not_the_photos(void **state)
{
    (void)state;
    struct texture_rule rules[3] = {in_place, in_place, in_place};
    rules[0].matrix[0][3] = 0.01;
    rules[1].matrix[0][0] = 1.1;
    rules[2].from = 1; /* another face, at the same place */
    for (int k = 0; k < 3; k++) {
        uint8_t *same = find_same(&rules[k], 1, 0);
        int wrong = 0;
        for (int i = 0; i < W * H; i++) {
            bool back;
            const struct vec3 p = seen_at(i, &back);
            wrong += same[i] != !back && !(k == 1 && fabs(p.x) < 1e-3); /* where the scale moves nothing */
        }
        assert_int_equal(wrong, 0);
        free(same);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_with_its_own_texture_in_place_keeps_the_photo),
        cmocka_unit_test(a_painted_wall_does_not_show_the_photo),
        cmocka_unit_test(the_photo_ends_a_margin_before_the_paint),
        cmocka_unit_test(a_painted_rectangle_leaves_the_rest_of_the_wall),
        cmocka_unit_test(a_texture_that_is_moved_scaled_or_another_faces_is_not_the_photos),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
