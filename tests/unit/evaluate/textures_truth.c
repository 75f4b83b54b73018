/* textures_truth.c - atlases of a box room against pictures of it without furniture, from files, face by face. */
#include <math.h>

#include "stages/evaluate/texture/texture_metrics.h"
#include "tests/unit/evaluate/box_room.h"

/* True radiance is SCALE times that of the products. The photo "near" shows furniture in a rectangle. */
#define SCALE 2.0
enum { BOX_LEFT = 20, BOX_RIGHT = 44, BOX_TOP = 26, FURNITURE = 99 };

static bool in_furniture(int i) { return i % W >= BOX_LEFT && i % W < BOX_RIGHT && i / W >= BOX_TOP; }

static void write_ids(const char *path, const struct view *v, bool furniture)
{
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    struct vec3 at;
    assert_ok(exr_image_init(&im, W, H, &err), err);
    assert_ok(exr_add_plane(&im, "id", EXR_UINT, NULL, &err), err);
    for (int i = 0; i < W * H; i++)
        im.planes[0].u[i] = furniture && in_furniture(i) ? FURNITURE : (uint32_t)(1 + face_at(v, i, &at));
    assert_ok(exr_write(&im, path, &prov, &err), err);
    exr_image_release(&im);
}

static void write_depth(const char *path, const struct view *v)
{
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    struct vec3 at;
    assert_ok(exr_image_init(&im, W, H, &err), err);
    assert_ok(exr_add_plane(&im, "Z", EXR_FLOAT, NULL, &err), err);
    for (int i = 0; i < W * H; i++) {
        face_at(v, i, &at);
        im.planes[0].f[i] = (float)(at.y - v->center.y);
    }
    assert_ok(exr_write(&im, path, &prov, &err), err);
    exr_image_release(&im);
}

static void write_radiance(const char *path, const struct view *v, double scale, bool furniture)
{
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    struct vec3 at;
    float *rgba = malloc(4 * W * H * sizeof *rgba);
    for (int i = 0; i < W * H; i++) {
        const double gray = furniture && in_furniture(i) ? 0.01 : gray_of(face_at(v, i, &at));
        for (int c = 0; c < 4; c++) rgba[4 * i + c] = c < 3 ? (float)(scale * gray) : 1;
    }
    assert_ok(exr_init_rgba(&im, rgba, W, H, &err), err);
    assert_ok(exr_write(&im, path, &prov, &err), err);
    exr_image_release(&im);
    free(rgba);
}

static void write_truth(void)
{
    static const char *const folders[] = {"truth",           "truth/ids",       "truth/hdr",         "truth/shell",
                                          "truth/shell/ids", "truth/shell/hdr", "truth/shell/depth", "views"};
    char text[1024] = "";
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) mkdir(scratch_path(folders[i]), 0777);
    scratch_write("truth/cameras.txt", "1 PINHOLE 60 44 40 40 30 22\n");
    for (int k = 0; k < 2; k++) {
        const struct view *v = &cameras[k];
        const struct quat q = quat_from_mat3(v->cam_from_world);
        char name[64];
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g 1 %s.jpg\n\n", k + 1, q.w, q.x, q.y, q.z,
                 v->translation.x, v->translation.y, v->translation.z, v->name);
        snprintf(name, sizeof name, "truth/shell/ids/%s.exr", v->name);
        write_ids(scratch_path(name), v, false);
        snprintf(name, sizeof name, "truth/shell/depth/%s.exr", v->name);
        write_depth(scratch_path(name), v);
        snprintf(name, sizeof name, "truth/shell/hdr/%s.exr", v->name);
        write_radiance(scratch_path(name), v, SCALE, false);
        snprintf(name, sizeof name, "truth/ids/%s.exr", v->name);
        write_ids(scratch_path(name), v, k == 0);
        snprintf(name, sizeof name, "truth/hdr/%s.exr", v->name);
        write_radiance(scratch_path(name), v, SCALE, k == 0);
        snprintf(name, sizeof name, "views/%s.exr", v->name);
        write_radiance(scratch_path(name), v, 1, k == 0);
    }
    scratch_write("truth/images.txt", text);
}

static int make_all(void **state)
{
    if (make_files(state)) return -1;
    write_truth();
    return 0;
}

static struct photo_record records[2];
static struct lens lenses[2];
static char names[2][8] = {"far", "near"}, truth_folder[300];

static struct evaluation scene_with_truth(void)
{
    struct evaluation e = scene_make();
    for (int i = 0; i < 2; i++) {
        records[i] = (struct photo_record){.id = names[i], .file = names[i]};
        lenses[i] = (struct lens){names[i], names[i], {CAMERA_PINHOLE, W, H, {40, 40, 30, 22}}, {1, 0, 0, 0}};
    }
    e.photos = (struct photo_list){records, 2};
    e.views.lenses = (struct lens_list){lenses, 2};
    snprintf(truth_folder, sizeof truth_folder, "%s/truth", scratch);
    e.truth_folder = truth_folder;
    e.aligned = true;
    e.truth_from_scene = (struct similarity){.rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .scale = 1};
    e.radiance_scale = SCALE;
    return e;
}

static double face_metric(const struct evaluation *e, const char *face, const char *name)
{
    for (int i = 0; i < e->table.count; i++)
        if (!strcmp(e->table.metrics[i].view, face) && !strcmp(e->table.metrics[i].name, name))
            return e->table.metrics[i].value;
    return -1;
}

/* ------------------------------------------------------------------------------------------------------------ tests */

static void each_face_has_the_error_of_its_colour(void **state)
{
    struct err err = ERR_INIT;
    int measured = 0;
    (void)state;
    struct evaluation e = scene_with_truth();
    write_vita(1, 0.5f);
    assert_ok(evaluate_textures(&e, &err), err);
    for (int i = 0; i < FACES; i++) {
        char face[16];
        snprintf(face, sizeof face, "face/%s", face_names[i]);
        const double found = face_metric(&e, face, "texture.vita.psnr_warped");
        const double d = 40 + 30 * i - nearbyint(255 * srgb_from_linear(0.5f * gray_of(i)));
        if (found < 0) continue;
        assert_true(fabs(found - 20 * log10(255 / d)) < 0.15); /* colours are halves, which may round the other way */
        measured++;
    }
    assert_true(measured >= 3);
    assert_true(metric(&e, "texture.vita.psnr_warped") > 0);
    assert_true(metric(&e, "texture.vita.compared") > 20 && metric(&e, "texture.vita.compared") < 100);
    assert_true(metric(&e, "texture.vita.seam_energy") == -1);
    assert_true(metric(&e, "texture.atlases") == -1 && metric(&e, "texture.vita.atlases") == 1);
    assert_true(fabs(metric(&e, "texture.vita.megapixels") - 6e-6 * TILE * TILE) < 1e-12);
    scene_release(&e);
}

static void right_colours_from_a_clean_view_have_no_error(void **state)
{
    struct err err = ERR_INIT;
    struct evaluation e = scene_with_truth();
    (void)state;
    write_vita(1, 1);
    assert_ok(evaluate_textures(&e, &err), err);
    assert_true(metric(&e, "texture.vita.psnr_warped") > 48); /* at most one step of 8 bits, by rounding to half */
    assert_true(metric(&e, "texture.vita.psnr_seen") > 48);
    assert_true(metric(&e, "texture.vita.clutter_baked") == 0);
    assert_true(metric(&e, "texture.vita.unknown_clean") == 0);
    assert_true(metric(&e, "texture.vita.psnr_synthesised") == -1);
    scene_release(&e);
}

static void furniture_that_is_copied_is_not_avoided_and_baked(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct evaluation e = scene_with_truth();
        texel_source = k ? ATLAS_SYNTHESISED : ATLAS_VIEWS + 1; /* near: the viewpoint's own */
        write_vdta(0, 0.1f);
        assert_ok(evaluate_textures(&e, &err), err);
        assert_true(metric(&e, "texture.clutter_avoided") == (k ? 100 : 0));
        if (k)
            assert_true(metric(&e, "texture.clutter_baked") == -1);
        else
            assert_true(metric(&e, "texture.clutter_baked") > 3 && metric(&e, "texture.clutter_baked") < 40);
        assert_true(metric(&e, "texture.unknown_clean") == (k ? 100 : 0));
        assert_true(metric(&e, "texture.psnr_warped") == -1);
        scene_release(&e);
        no_atlases(NULL);
        texel_source = ATLAS_VIEWS;
    }
}

static void without_a_truth_the_reason_is_noted(void **state)
{
    struct err err = ERR_INIT;
    struct evaluation e = scene_with_truth();
    (void)state;
    write_vita(1, 1);
    e.truth_folder = NULL;
    assert_ok(evaluate_textures(&e, &err), err);
    assert_string_equal(e.table.notes[0], "skipped errors of textures: no TRUTH is given");
    assert_true(metric(&e, "texture.vita.atlases") == 1 && metric(&e, "texture.vita.psnr_seen") == -1);
    scene_release(&e);
    no_atlases(NULL);
    e = scene_with_truth();
    assert_ok(evaluate_textures(&e, &err), err);
    assert_string_equal(e.table.notes[0], "skipped textures: both vdta and vita are missing");
    assert_int_equal(e.table.count, 0);
    scene_release(&e);
}

static void a_source_that_is_no_view_is_refused(void **state)
{
    struct err err = ERR_INIT;
    struct evaluation e = scene_with_truth();
    (void)state;
    write_vita(1, 1);
    e.views.cameras.view_count = 1; /* "near" is gone */
    assert_int_equal(evaluate_textures(&e, &err), ST_DATA);
    assert_string_equal(err.text, "vita: source near is none of the scene's views; bake it again.");
    scene_release(&e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(each_face_has_the_error_of_its_colour, no_atlases),
        cmocka_unit_test_teardown(right_colours_from_a_clean_view_have_no_error, no_atlases),
        cmocka_unit_test_teardown(furniture_that_is_copied_is_not_avoided_and_baked, no_atlases),
        cmocka_unit_test_teardown(without_a_truth_the_reason_is_noted, no_atlases),
        cmocka_unit_test_teardown(a_source_that_is_no_view_is_refused, no_atlases),
    };
    return cmocka_run_group_tests(tests, make_all, scratch_remove);
}
