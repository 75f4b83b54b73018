/* texture_error.c - texels of a wall against pictures of a room whose radiance is known at every point. */
#include "stages/evaluate/texture/texture_error.h"

#include <math.h>

#include "common/base/parallel.h"
#include "stages/evaluate/texture/texel_facts.h"
#include "stages/evaluate/texture/texel_places.h"
#include "stages/evaluate/texture/texture_seams.h"
#include "tests/unit/scratch.h"

/* The wall y = 3 of a room, seen from inside; the model's frame is the truth's world. A box of furniture stands in
 * front of it, from x = 1.5 to 2.5 and z = 0 to 1, at y = 2. */
enum { W = 160, H = 120, TILE_W = 80, TILE_H = 50, TEXELS = TILE_W * TILE_H };
enum { WALL = 3, BOX = 9 };

static const struct camera pinhole = {CAMERA_PINHOLE, W, H, {90, 90, W / 2.0, H / 2.0}};
static const struct vec3 wall_normal = {0, -1, 0}; /* into the room */
#define WALL_OFFSET (-3.0)

static float gray_of_wall(double x, double z) { return (float)(0.3 + 0.02 * x + 0.03 * z); }

/* A camera at `from` that looks along +y: x right, -z down. */
static struct pose pose_at(struct vec3 from)
{
    const struct mat3 turn = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    const struct vec3 t = mat3_apply(turn, from);
    return (struct pose){quat_from_mat3(turn), {-t.x, -t.y, -t.z}};
}

struct shot { /* a picture of the room, in arrays of W * H */
    struct shell_view view;
    struct image whole; /* radiance with furniture */
};

static bool in_box(double x, double z) { return x > 1.5 && x < 2.5 && z < 1; }

static struct shot shoot(struct vec3 from)
{
    struct true_photo photo = {.lens = pinhole, .pose = pose_at(from)};
    struct shot s = {{0}, {0}};
    struct err err = ERR_INIT;
    struct image shell = {0};
    uint32_t *ids = malloc(2 * W * H * sizeof *ids), *whole = ids + W * H;
    photo.depth = malloc(W * H * sizeof *photo.depth);
    assert_ok(image_init(&s.whole, W, H, 3, &err), err);
    assert_ok(image_init(&shell, W, H, 3, &err), err);
    for (int i = 0; i < W * H; i++) {
        const double dx = (i % W + 0.5 - W / 2.0) / 90, dz = -(i / W + 0.5 - H / 2.0) / 90;
        const double to_wall = 3 - from.y, to_box = 2 - from.y;
        const bool hidden = to_box > 0 && in_box(from.x + to_box * dx, from.z + to_box * dz);
        const float gray = gray_of_wall(from.x + to_wall * dx, from.z + to_wall * dz);
        photo.depth[i] = (float)to_wall;
        ids[i] = WALL;
        whole[i] = hidden ? BOX : WALL;
        for (int c = 0; c < 3; c++) {
            shell.data[3 * i + c] = gray;
            s.whole.data[3 * i + c] = hidden ? 0.05f : gray;
        }
    }
    static float none[W * H];
    uint32_t *faces = malloc(W * H * sizeof *faces);
    for (int i = 0; i < W * H; i++) faces[i] = WALL;
    assert_ok(shell_view_make(&s.view, &photo, &err), err);
    assert_ok(shell_view_mark(&s.view, &(struct shell_pixel_ids){ids, whole, faces, none}, 0.05, &err), err);
    free(faces);
    s.view.rgb = shell;
    free(photo.depth);
    free(ids);
    return s;
}

/* A room with two photos, and an atlas of one tile of the wall as the first photo sees it. */
struct room {
    struct shot shots[2];
    struct shell_view shell_views[2];
    struct shell_points shell;
    struct model_frame frame;
    struct view views[2];
    struct photo_view photo_views[2];
    uint8_t known[2][W * H];
    struct atlas_tile tile;
    struct atlas_page page;
    int source_shell[2];
    bool source_own[2];
    struct texel_truth truth;
    struct texel_facts facts[TEXELS];
};

static struct view view_at(struct vec3 from)
{
    const struct pose pose = pose_at(from);
    return (struct view){"v", W, H, 90, 90, W / 2.0, H / 2.0, mat3_from_quat(pose.rotation), pose.translation, from};
}

/* The tile holds pixels (40, 30) to (120, 80) of the view. */
static struct atlas_tile tile_of(const struct view *v)
{
    struct atlas_tile t = {.face = WALL, .width = TILE_W, .height = TILE_H};
    for (int c = 0; c < 4; c++) {
        const double x = c < 3 ? v->cam_from_world.m[0][c] : v->translation.x;
        const double y = c < 3 ? v->cam_from_world.m[1][c] : v->translation.y;
        const double z = c < 3 ? v->cam_from_world.m[2][c] : v->translation.z;
        t.matrix[0][c] = v->fx * x + (v->cx - 40) * z;
        t.matrix[1][c] = v->fy * y + (v->cy - 30) * z;
        t.matrix[2][c] = z;
    }
    return t;
}

static struct vec3 place_of(const struct room *r, int texel)
{
    struct texel_places places;
    struct vec3 p;
    assert_true(texel_places_init(&places, &r->tile, wall_normal, WALL_OFFSET));
    assert_true(texel_place(&p, &places, texel % TILE_W + 0.5, texel / TILE_W + 0.5));
    return p;
}

/* Right texels from the first photo where it shows the wall, and from the second elsewhere. */
static struct room *room_make(void)
{
    static const struct vec3 from[2] = {{2, 0.2, 1.2}, {3.6, 0.2, 1.4}};
    struct room *r = calloc(1, sizeof *r);
    for (int i = 0; i < 2; i++) {
        r->shots[i] = shoot(from[i]);
        r->shell_views[i] = r->shots[i].view;
        r->views[i] = view_at(from[i]);
        memset(r->known[i], 1, W * H);
        r->photo_views[i] = (struct photo_view){&r->views[i], i, r->known[i]};
        r->source_shell[i] = i;
        r->source_own[i] = i == 0;
    }
    r->shell = (struct shell_points){.views = r->shell_views, .count = 2, .tolerance = 0.05};
    r->frame.axes = (struct model_axes){.rotation = {1, 0, 0, 0}, .scale = 1};
    r->frame.truth_from_scene = (struct similarity){.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .scale = 1};
    r->frame.room_from_world = r->frame.truth_from_scene.rotation;
    r->tile = tile_of(&r->views[0]);
    r->page = (struct atlas_page){TILE_W, TILE_H, calloc(3 * TEXELS, sizeof(float)), calloc(TEXELS, sizeof(uint32_t))};
    r->truth = (struct texel_truth){&r->frame,     &r->shell, r->photo_views,    2, 2, 1, NULL, r->source_shell,
                                    r->source_own, 0,         &r->shots[0].whole};
    for (int i = 0; i < TEXELS; i++) {
        const struct vec3 p = place_of(r, i);
        const struct surface_point at = {p, wall_normal, WALL};
        const bool clean = shell_view_sight(&r->shell_views[0], &at) == SHELL_CLEAN;
        r->page.source[i] = ATLAS_VIEWS + (clean ? 0 : 1);
        for (int c = 0; c < 3; c++) r->page.rgb[3 * i + c] = gray_of_wall(p.x, p.z) / 2; /* the scale is 2 */
    }
    return r;
}

static void room_release(struct room *r)
{
    for (int i = 0; i < 2; i++) {
        shell_view_release(&r->shell_views[i]);
        image_release(&r->shots[i].whole);
    }
    free(r->page.rgb);
    free(r->page.source);
    free(r);
}

static struct texture_error measure(struct room *r)
{
    struct texture_error e;
    struct err err = ERR_INIT;
    assert_ok(texture_error_init(&e, WALL + 1, &err), err);
    texel_facts_of_tile(r->facts, &r->truth, &r->page, &r->tile, wall_normal, WALL_OFFSET);
    texture_error_add(&e, WALL, r->facts, TEXELS);
    return e;
}

static int behind_box(const struct room *r, int texel)
{
    const struct vec3 p = place_of(r, texel);
    const struct surface_point at = {p, wall_normal, WALL};
    return shell_view_sight(&r->shell_views[0], &at) == SHELL_CLUTTER;
}

/* ------------------------------------------------------------------------------------------------------------ tests */

static void a_texel_is_where_its_ray_meets_the_face(void **state)
{
    (void)state;
    struct room *r = room_make();
    const struct texel_places none = {{{0}}, {0}};
    struct texel_places places = none;
    struct vec3 p;
    for (int i = 0; i < TEXELS; i += 7) {
        double x, y;
        p = place_of(r, i);
        assert_true(fabs(p.y - 3) < 1e-9);
        assert_true(view_project(&r->views[0], p, &x, &y) > 0);
        assert_true(fabs(x - 40 - (i % TILE_W + 0.5)) < 1e-9 && fabs(y - 30 - (i / TILE_W + 0.5)) < 1e-9);
    }
    /* an orthogonal tile */
    struct atlas_tile flat = {
        .face = WALL, .width = 10, .height = 10, .matrix = {{20, 0, 0, -5}, {0, 0, -20, 50}, {0, 0, 0, 1}}};
    assert_true(texel_places_init(&places, &flat, wall_normal, WALL_OFFSET));
    assert_true(texel_place(&p, &places, 15, 10));
    assert_true(fabs(p.x - 1) < 1e-12 && fabs(p.y - 3) < 1e-12 && fabs(p.z - 2) < 1e-12);
    /* a plane through the camera's centre has no texels */
    assert_false(texel_places_init(&places, &r->tile, vec3_make(1, 0, 0), 2));
    room_release(r);
}

static void right_textures_have_no_error(void **state)
{
    (void)state;
    struct room *r = room_make();
    struct texture_error e = measure(r);
    double db;
    assert_int_equal(e.texels, TEXELS);
    assert_true(e.compared == TEXELS);
    assert_true(texture_face_psnr(&e, WALL, TEXTURE_SEEN, &db) && db > 60); /* half a step of 8 bits at most */
    assert_int_equal(e.faces[WALL][TEXTURE_ORIGINAL].texels + e.faces[WALL][TEXTURE_WARPED].texels, TEXELS);
    assert_true(e.faces[WALL][TEXTURE_ORIGINAL].texels > 1000 && e.faces[WALL][TEXTURE_WARPED].texels > 100);
    uint64_t clutter = 0, avoided = 0; /* the second photo sees a part of what the box hides from the first */
    for (int i = 0; i < TEXELS; i++) {
        const struct surface_point at = {place_of(r, i), wall_normal, WALL};
        if (!(r->facts[i].flags & TEXEL_OWN_CLUTTER)) continue;
        assert_true(behind_box(r, i));
        clutter++;
        avoided += shell_view_sight(&r->shell_views[1], &at) == SHELL_CLEAN;
    }
    assert_true(avoided > 100 && avoided < clutter);
    assert_int_equal(e.clutter, clutter);
    assert_int_equal(e.avoided, avoided);
    assert_int_equal(e.baked, 0);
    assert_int_equal(e.clean_unknown, 0);
    texture_error_release(&e);
    room_release(r);
}

static void a_wrong_factor_has_the_error_of_that_factor(void **state)
{
    (void)state;
    struct room *r = room_make();
    struct err err = ERR_INIT;
    double sum = 0, db;
    bool found;
    for (int i = 0; i < 3 * TEXELS; i++) r->page.rgb[i] *= 1.3f;
    struct texture_error e = measure(r);
    for (int i = 0; i < TEXELS; i++) {
        const struct vec3 p = place_of(r, i);
        const double d =
            255 * (srgb_from_linear(1.3f * gray_of_wall(p.x, p.z)) - srgb_from_linear(gray_of_wall(p.x, p.z)));
        sum += d * d;
    }
    assert_ok(texture_median_psnr(&e, TEXTURE_SEEN, &db, &found, &err), err);
    assert_true(found && fabs(db - 10 * log10(255.0 * 255.0 * TEXELS / sum)) < 0.1);
    assert_ok(texture_median_psnr(&e, TEXTURE_SYNTHESISED, &db, &found, &err), err);
    assert_false(found);
    texture_error_release(&e);
    room_release(r);
}

static void a_smeared_box_is_counted_as_baked_clutter(void **state)
{
    (void)state;
    struct room *r = room_make();
    uint64_t smeared = 0, differing = 0;
    double db;
    for (int i = 0; i < TEXELS; i++) {
        if (!behind_box(r, i)) continue;
        r->page.source[i] = ATLAS_VIEWS;
        for (int c = 0; c < 3; c++) r->page.rgb[3 * i + c] = 0.025f;
        smeared++;
    }
    struct texture_error e = measure(r);
    for (int i = 0; i < TEXELS; i++) differing += (r->facts[i].flags & TEXEL_OWN_CLUTTER) != 0;
    assert_int_equal(e.baked, smeared);
    assert_true(differing > 0.8 * (double)smeared && differing <= smeared); /* but for blended outlines */
    assert_int_equal(e.clutter, differing);
    assert_int_equal(e.avoided, 0);
    /* texels whose source shows furniture are none of the seen ones */
    assert_true(texture_face_psnr(&e, WALL, TEXTURE_SEEN, &db) && db > 60);
    texture_error_release(&e);
    room_release(r);
}

static void synthesised_texels_avoid_clutter_but_not_where_a_photo_is_clean(void **state)
{
    (void)state;
    struct room *r = room_make();
    uint64_t filled = 0, clean = 0;
    for (int i = 0; i < TEXELS; i++) {
        if (!behind_box(r, i)) continue;
        const struct surface_point at = {place_of(r, i), wall_normal, WALL};
        r->page.source[i] = ATLAS_SYNTHESISED;
        filled++;
        clean += shell_view_sight(&r->shell_views[1], &at) == SHELL_CLEAN;
    }
    struct texture_error e = measure(r);
    assert_int_equal(e.avoided, e.clutter);
    assert_true(clean > 0 && clean < filled);
    assert_int_equal(e.clean_unknown, clean);
    assert_int_equal(e.faces[WALL][TEXTURE_SYNTHESISED].texels, filled);
    texture_error_release(&e);
    memset(r->known[1], 0, sizeof r->known[1]); /* the second photo is clipped: nothing shows these texels */
    e = measure(r);
    assert_int_equal(e.clean_unknown, 0);
    assert_int_equal(e.clean, TEXELS - filled);
    texture_error_release(&e);
    room_release(r);
}

static void a_point_behind_another_wall_has_no_true_radiance(void **state)
{
    (void)state;
    struct room *r = room_make();
    const struct surface_point behind = {{2, 3.2, 1.8}, {0, -1, 0}, WALL}, turned = {{2, 3, 1.8}, {0, 1, 0}, WALL};
    float rgb[3];
    assert_false(shell_radiance(rgb, &r->shell, &behind, -1));
    assert_false(shell_radiance(rgb, &r->shell, &turned, -1));
    const struct surface_point there = {{2, 3.01, 1.8}, {0, -1, 0}, WALL}; /* within the tolerance */
    assert_true(shell_radiance(rgb, &r->shell, &there, -1));
    assert_true(fabsf(rgb[0] - gray_of_wall(2, 1.8)) < 1e-3f);
    room_release(r);
}

static void what_the_model_lacks_is_clutter_and_another_face_hides(void **state)
{
    (void)state;
    struct room *r = room_make();
    struct err err = ERR_INIT;
    static uint32_t same[W * H], faces[W * H];
    static float distance[W * H];
    for (int i = 0; i < W * H; i++) {
        same[i] = WALL;
        faces[i] = i / W < 20 ? WALL + 1 : WALL;    /* the upper rows show another face of the model */
        distance[i] = i % W < W / 2 ? 0.2f : 0.04f; /* a lamp in the left half */
    }
    struct shell_view *v = &r->shell_views[0];
    free(v->faces);
    free(v->clutter);
    assert_ok(shell_view_mark(v, &(struct shell_pixel_ids){same, same, faces, distance}, 0.05, &err), err);
    const struct surface_point left = {{1.5, 3, 1.2}, wall_normal, WALL}, right = {{2.5, 3, 1.2}, wall_normal, WALL};
    const struct surface_point high = {{2.5, 3, 2.5}, wall_normal, WALL};
    assert_int_equal(shell_view_sight(v, &left), SHELL_CLUTTER);
    assert_int_equal(shell_view_sight(v, &right), SHELL_CLEAN);
    assert_int_equal(shell_view_sight(v, &high), SHELL_HIDDEN_POINT);
    room_release(r);
}

static void a_step_between_sources_has_more_energy_than_a_ramp(void **state)
{
    (void)state;
    enum { N = 12, M = 5 };
    float rgb[3 * N * M];
    uint32_t source[N * M];
    struct atlas_page page = {N, M, rgb, source};
    const struct atlas_tile tile = {.width = N, .height = M};
    struct texture_seams s = {0};
    double ratio;
    for (int step = 0; step < 2; step++) {
        for (int i = 0; i < N * M; i++) {
            const int x = i % N;
            source[i] = ATLAS_VIEWS + (uint32_t)(x >= 6);
            for (int c = 0; c < 3; c++)
                rgb[3 * i + c] = linear_from_srgb(0.3f + 0.02f * (float)x + (step && x >= 6 ? 0.02f : 0));
        }
        s = (struct texture_seams){0};
        texture_seams_add(&s, &page, &tile, 1);
        assert_int_equal(s.across_pairs, M);
        assert_int_equal(s.beside_pairs, 6 * M);
        assert_true(texture_seams_ratio(&s, &ratio));
        assert_true(fabs(ratio - (step ? 4 : 1)) < 1e-3);
    }
    for (int i = 0; i < N * M; i++) source[i] = i % N >= 6 ? ATLAS_SYNTHESISED : ATLAS_VIEWS;
    s = (struct texture_seams){0};
    texture_seams_add(&s, &page, &tile, 1);
    assert_false(texture_seams_ratio(&s, &ratio)); /* one view alone has no seam */
}

static void one_and_two_threads_find_the_same(void **state)
{
    (void)state;
    struct room *r = room_make();
    struct texel_facts one[TEXELS];
    parallel_set_threads(1);
    texel_facts_of_tile(one, &r->truth, &r->page, &r->tile, wall_normal, WALL_OFFSET);
    parallel_set_threads(2);
    texel_facts_of_tile(r->facts, &r->truth, &r->page, &r->tile, wall_normal, WALL_OFFSET);
    assert_memory_equal(one, r->facts, sizeof one);
    room_release(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texel_is_where_its_ray_meets_the_face),
        cmocka_unit_test(right_textures_have_no_error),
        cmocka_unit_test(a_wrong_factor_has_the_error_of_that_factor),
        cmocka_unit_test(a_smeared_box_is_counted_as_baked_clutter),
        cmocka_unit_test(synthesised_texels_avoid_clutter_but_not_where_a_photo_is_clean),
        cmocka_unit_test(a_point_behind_another_wall_has_no_true_radiance),
        cmocka_unit_test(what_the_model_lacks_is_clutter_and_another_face_hides),
        cmocka_unit_test(a_step_between_sources_has_more_energy_than_a_ramp),
        cmocka_unit_test(one_and_two_threads_find_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
