/* textures.c - atlases of a box room in which each face has one colour: what they cover, and what they predict. */
#include "stages/evaluate/texture/texture_metrics.h"
#include "tests/unit/evaluate/box_room.h"

/* ------------------------------------------------------------------------------------------------------------ tests */

static void a_vita_predicts_what_it_shows(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    for (int half = 0; half < 2; half++) {
        struct evaluation e = scene_make();
        write_vita(1, half ? 0.5f : 1);
        assert_ok(evaluate_heldout_textures(&e, &err), err);
        const double psnr = metric(&e, "texture.vita.heldout_psnr");
        assert_true(half ? psnr > 5 && psnr < 30 : psnr > 50);
        assert_true(metric(&e, "texture.vita.heldout_filled") == 100);
        assert_true(metric(&e, "texture.heldout_psnr") == -1); /* there is no other atlas */
        scene_release(&e);
    }
}

static void the_nearest_viewpoint_predicts_and_the_vita_fills_the_rest(void **state)
{
    struct err err = ERR_INIT;
    struct evaluation e = scene_make();
    (void)state;
    write_vita(1, 1);
    write_vdta(0, 1);
    write_vdta(1, 0.25f); /* wrong, but farther away */
    assert_ok(evaluate_heldout_textures(&e, &err), err);
    assert_true(metric(&e, "texture.heldout_psnr") > 50);
    assert_true(metric(&e, "texture.heldout_filled") == 100);
    scene_release(&e);
    no_atlases(NULL);
    e = scene_make();
    write_vita(1, 1);
    write_vdta(0, 0.5f); /* wrong, and the nearest */
    assert_ok(evaluate_heldout_textures(&e, &err), err);
    assert_true(metric(&e, "texture.heldout_psnr") < 30 && metric(&e, "texture.heldout_psnr") > 0);
    assert_true(metric(&e, "texture.vita.heldout_psnr") > 50);
    scene_release(&e);
}

static void a_vita_covers_the_share_of_the_model_that_it_holds(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    for (int k = 1; k <= 4; k++) {
        struct evaluation e = scene_make();
        write_vita(k / 4.0, 1);
        assert_ok(evaluate_texture_cover(&e, &err), err);
        assert_true(fabs(metric(&e, "texture.vita.covered") - 25 * k) < 1);
        scene_release(&e);
        no_atlases(NULL);
    }
    struct evaluation e = scene_make();
    write_vita(1, 0); /* texels without light do not count */
    assert_ok(evaluate_texture_cover(&e, &err), err);
    assert_true(metric(&e, "texture.vita.covered") == 0);
    scene_release(&e);
}

/* All points of the view count as revealed; `faces` ids from 1, others as an id that no tile has. */
static void write_reveal(int faces)
{
    struct exr_image im = {0};
    struct exr_plane *id, *z;
    struct err err = ERR_INIT;
    struct vec3 at;
    assert_ok(exr_image_init(&im, W, H, &err), err);
    assert_ok(exr_add_plane(&im, "layer0.id", EXR_UINT, NULL, &err), err);
    assert_ok(exr_add_plane(&im, "layer0.Z", EXR_FLOAT, NULL, &err), err);
    id = exr_find(&im, "layer0.id"), z = exr_find(&im, "layer0.Z");
    for (int i = 0; i < W * H; i++) {
        const int face = face_at(&cameras[0], i, &at) + 1;
        id->u[i] = face <= faces ? (uint32_t)face : 77;
        z->f[i] = (float)(at.y - cameras[0].center.y);
    }
    assert_ok(exr_write(&im, scratch_path("reveal/near.exr"), &prov, &err), err);
    exr_image_release(&im);
}

static void what_edits_reveal_is_looked_up_in_the_viewpoints_atlas(void **state)
{
    struct err err = ERR_INIT;
    struct evaluation e = scene_make();
    struct vec3 at;
    int held = 0;
    (void)state;
    write_vdta(0, 1);
    assert_ok(evaluate_texture_cover(&e, &err), err);
    assert_true(metric(&e, "texture.covered") == -1); /* nothing is revealed */
    assert_true(e.table.note_count == 1);
    scene_release(&e);
    e = scene_make();
    write_reveal(FACES);
    assert_ok(evaluate_texture_cover(&e, &err), err);
    assert_true(metric(&e, "texture.covered") == 100);
    scene_release(&e);
    e = scene_make();
    write_reveal(4); /* floor and ceiling become a face without a tile */
    for (int i = 0; i < W * H; i++) held += face_at(&cameras[0], i, &at) < 4;
    assert_ok(evaluate_texture_cover(&e, &err), err);
    assert_true(fabs(metric(&e, "texture.covered") - 100.0 * held / (W * H)) < 1e-9);
    scene_release(&e);
}

static void a_damaged_picture_of_what_is_revealed_is_refused(void **state)
{
    struct err err = ERR_INIT;
    struct evaluation e = scene_make();
    struct exr_image im = {0};
    (void)state;
    write_vdta(0, 1);
    assert_ok(exr_image_init(&im, W, H, &err), err);
    assert_ok(exr_add_plane(&im, "layer0.id", EXR_UINT, NULL, &err), err);
    assert_ok(exr_write(&im, scratch_path("reveal/near.exr"), &prov, &err), err);
    exr_image_release(&im);
    assert_int_equal(evaluate_texture_cover(&e, &err), ST_DATA);
    assert_non_null(strstr(err.text, "reveal/near.exr"));
    assert_non_null(strstr(err.text, "layer0.Z"));
    scene_release(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(a_vita_predicts_what_it_shows, no_atlases),
        cmocka_unit_test_teardown(the_nearest_viewpoint_predicts_and_the_vita_fills_the_rest, no_atlases),
        cmocka_unit_test_teardown(a_vita_covers_the_share_of_the_model_that_it_holds, no_atlases),
        cmocka_unit_test_teardown(what_edits_reveal_is_looked_up_in_the_viewpoints_atlas, no_atlases),
        cmocka_unit_test_teardown(a_damaged_picture_of_what_is_revealed_is_refused, no_atlases),
    };
    return cmocka_run_group_tests(tests, make_files, scratch_remove);
}
