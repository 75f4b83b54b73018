/* own_pixels.c - which pixels of a photo an edit leaves alone: by face, by plane, by texture, by thing. */
#include "stages/render_model/own_pixels.h"

#include "common/model/thing_mask.h"

#include "common/layers/layered_depth.h"
#include "common/texture/view_ids.h"
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
    static uint8_t gone[W * H];
    assert_ok(own_pixels_find(same, gone, &drawn, 0, &prov, &err), err);
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

/* ----------------------------------------------------------------------------------------------------------- things */

enum { GONE = 1, KEPT, CELLS = 16 };

#define VOXEL 0.25

/* Posts from floor to ceiling, 0.25 x 0.25, about 2.3 before the camera: one that is gone, one that is kept, and one
 * that is gone behind two that are kept. */
static struct placed_things posts(void)
{
    static const double places[][3] = {
        {0.1, 1.1, GONE}, {-0.9, 0.6, KEPT}, {0.4, 0.6, KEPT}, {0.6, 0.6, KEPT}, {0.6, 1.1, GONE}};
    struct placed_things t = {.volume = {.grid = {{-2, -2, -2}, VOXEL, {CELLS, CELLS, CELLS}}}};
    t.volume.id = calloc(CELLS * CELLS * CELLS, sizeof *t.volume.id);
    t.fate = calloc(3, sizeof *t.fate);
    assert_true(t.volume.id && t.fate);
    t.fate[GONE] = THING_IS_GONE;
    t.fate[KEPT] = THING_IS_KEPT;
    for (int k = 0; k < 5; k++)
        for (int y = 0; y < CELLS; y++) {
            const struct vec3 p = vec3_make(places[k][0], -2 + (y + 0.5) * VOXEL, places[k][1]);
            t.volume.id[thing_voxel_at(&t.volume.grid, p)] = (uint32_t)places[k][2];
        }
    return t;
}

/* The depth at which the ray of a pixel of view_between() is at z, one of the model's. */
static double depth_at(int i, double z)
{
    const struct view camera = view_between();
    const struct vec3 way = vec3_sub(view_unproject(&camera, i % W + 0.5, i / W + 0.5, 1), camera.center);
    return (z - camera.center.z) / way.z;
}

static double x_at(int i, double z)
{
    const struct view camera = view_between();
    return view_unproject(&camera, i % W + 0.5, i / W + 0.5, depth_at(i, z)).x;
}

/* Where the photo is kept when posts are gone. The view's depth shows the room alone; clutter: it is at z = 1.125
 * everywhere, in the posts that are gone, and all of it is clutter. masked: columns at the left that show what is gone
 * by the mask of the view; 0: there is no mask. The caller frees it. */
static uint8_t *same_without_posts(bool clutter, int masked)
{
    static const struct provenance no_inputs = {.stage = "test", .version = "1"};
    struct render_model_params params = RENDER_MODEL_PARAMS_DEFAULT;
    struct view camera = view_between();
    struct room drawn = {.files = {.base = "model.txt"}, .params = &params, .cameras = &camera};
    struct layered_depth depth = {0};
    struct view_ids ids = {0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    uint8_t *same = malloc((size_t)(W * H));
    assert_non_null(same);
    mkdir(scratch_path("depth"), 0777);
    mkdir(scratch_path("ids"), 0777);
    assert_ok(layered_depth_init(&depth, W, H, &err), err);
    assert_ok(view_ids_init(&ids, W, H, &err), err);
    depth.segments = calloc(1, sizeof *depth.segments);
    assert_non_null(depth.segments);
    depth.segment_count = 1;
    depth.segments[0] =
        (struct depth_segment){.id = 1, .plane = {0, 0, 0.5}, .sigma = 0.002, .confidence = 1, .pixels = W * H};
    for (int i = 0; i < W * H; i++) {
        bool back;
        const struct vec3 ahead = vec3_sub(seen_at(i, &back), camera.center);
        const double z = mat3_apply(camera.cam_from_world, ahead).z;
        depth.interior.id[i] = ids.id[i] = 1;
        ids.z[i] = (float)z;
        ids.clutter[i] = clutter;
        depth.interior.z[i] = (float)(clutter ? depth_at(i, 1.125) : z);
        for (int c = 0; c < 4; c++) depth.interior.rgba[4 * i + c] = 1;
    }
    assert_ok(layered_depth_write(&depth, &camera, scratch_path("depth/v.exr"), &no_inputs, &err), err);
    assert_ok(view_ids_write(&ids, &camera, scratch_path("ids/v.exr"), &no_inputs, &err), err);
    layered_depth_release(&depth);
    view_ids_release(&ids);
    drawn.files.depth = scratch_path("depth");
    drawn.files.ids = scratch_path("ids");
    drawn.in.set = (struct camera_set){.views = &camera, .view_count = 1};
    drawn.in.axes = (struct model_axes){.rotation = {1, 0, 0, 0}, .scale = 1};
    drawn.base = make_rays(bare, 2);
    drawn.model = make_rays(bare, 2);
    drawn.shell = make_scene(bare, 2);
    drawn.things = posts();
    drawn.things.list = (struct thing_list){calloc(2, sizeof(struct thing)), 2};
    assert_non_null(drawn.things.list.things);
    if (masked) {
        static uint32_t mask[W * H];
        for (int i = 0; i < W * H; i++) mask[i] = i % W < masked ? GONE : 0;
        drawn.files.things = scratch_path("things");
        const struct thing_mask written = {mask, mask};
        assert_ok(thing_mask_write(&written, &camera, scratch_path("things/masks/v.exr"), NULL, &err), err);
    }
    static uint8_t gone[W * H];
    assert_ok(own_pixels_find(same, gone, &drawn, 0, &prov, &err), err);
    placed_things_release(&drawn.things);
    shell_close(drawn.shell);
    model_rays_release(&drawn.base);
    model_rays_release(&drawn.model);
    provenance_release(&prov);
    return same;
}

static void the_photo_is_not_kept_where_a_thing_is_gone_that_its_depth_misses(void **state)
{
    int hit = 0, far = 0;
    (void)state;
    uint8_t *same = same_without_posts(false, 0);
    for (int i = 0; i < W * H; i++) {
        bool back;
        seen_at(i, &back);
        if (!back) continue;
        const double front = x_at(i, 1), behind = x_at(i, 1.25);
        if (front > 0 && front < 0.25 && behind > 0 && behind < 0.25) {
            assert_int_equal(same[i], 0);
            hit++;
        } else if (front < -0.25 ||
                   front > 0.5) { /* 0.25 is more than ten pixels; the other post hides one behind it */
            assert_int_equal(same[i], 1);
            far++;
        }
    }
    assert_true(hit > 200 && far > 1000);
    free(same);
}

/* Also behind a thing that stays. */
static void the_photo_is_not_kept_where_its_depth_is_in_a_thing_that_is_gone(void **state)
{
    int hit = 0, far = 0;
    (void)state;
    uint8_t *same = same_without_posts(true, 0);
    for (int i = 0; i < W * H; i++) {
        bool back;
        seen_at(i, &back);
        const double x = x_at(i, 1.125);
        if (!back) continue;
        if ((x > 0 && x < 0.25) || (x > 0.5 && x < 0.75)) {
            assert_int_equal(same[i], 0);
            hit++;
        } else if (x < -0.5) {
            assert_int_equal(same[i], 1);
            far++;
        }
    }
    assert_true(hit > 400 && far > 500);
    free(same);
}

static void the_photo_is_not_kept_where_the_mask_shows_what_is_gone(void **state)
{
    enum { MASKED = 6 };
    (void)state;
    uint8_t *without = same_without_posts(false, 0), *same = same_without_posts(false, MASKED);
    int kept = 0;
    for (int i = 0; i < W * H; i++) {
        if (i % W < MASKED) assert_int_equal(same[i], 0);
        if (i % W < MASKED) kept += without[i];
        if (i % W > MASKED + 5) assert_int_equal(same[i], without[i]); /* beyond the margin of what is cleared */
    }
    assert_true(kept > 100);
    free(without);
    free(same);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_photo_is_not_kept_where_the_mask_shows_what_is_gone),
        cmocka_unit_test(a_wall_with_its_own_texture_in_place_keeps_the_photo),
        cmocka_unit_test(a_painted_wall_does_not_show_the_photo),
        cmocka_unit_test(the_photo_ends_a_margin_before_the_paint),
        cmocka_unit_test(a_painted_rectangle_leaves_the_rest_of_the_wall),
        cmocka_unit_test(a_texture_that_is_moved_scaled_or_another_faces_is_not_the_photos),
        cmocka_unit_test(the_photo_is_not_kept_where_a_thing_is_gone_that_its_depth_misses),
        cmocka_unit_test(the_photo_is_not_kept_where_its_depth_is_in_a_thing_that_is_gone),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
