/* shell.c - pictures of a painted room: which viewpoint a pixel takes its colour from, and which colour; hard
 * cameras. */
#include "stages/render_model/shell.h"

#include "tests/unit/render_model/shell_pictures.h"

#include "common/base/parallel.h"

/* ----------------------------------------------------------------------------------------------- the two viewpoints */

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
    assert_ok(atlas_read(&atlas, folder, NULL, &err), err);
    assert_true(atlas.page_count <= 8);
    for (int i = 0; i < atlas.page_count; i++)
        assert_ok(atlas_page_read(&pages[i], &atlas, i, folder, NULL, &err), err);
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

/* A viewpoint that looks the other way: the matrices of its tiles take the picture's points to w < 0, and to w = 0 in
 * the plane of its centre. */
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

/* ----------------------------------------------------------------------------------------------------- hard cameras */

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

/* --------------------------------------------------------------------------------------------------------- the rest */

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
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(samples_average_radiance),
        cmocka_unit_test(pages_of_faces_that_are_not_seen_are_not_read),
        cmocka_unit_test(a_share_beyond_one_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
