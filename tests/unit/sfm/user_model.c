/* user_model.c - import of existing models, and replacement of an older folder of models. */
#include "tests/unit/scratch.h"

#include "stages/sfm/user_model.h"

static const char cameras[] = "1 PINHOLE 64 48 50 50 32 24\n";
static const char images[] = "1 1 0 0 0 0 0 0 1 x/a.jpg\n32 24 7\n2 1 0 0 0 1 0 0 1 b.jpg\n40 24 7\n";

static char ids[2][2] = {"a", "b"}, files[2][8] = {"a.jpg", "b.jpg"};
static struct photo_record records[] = {
    {.id = ids[0], .file = files[0], .hash = "00", .info = {.width = 64, .height = 48}},
    {.id = ids[1], .file = files[1], .hash = "11", .info = {.width = 64, .height = 48}},
};
static const struct photo_list photos = {records, 2};
static const struct sfm_params params = SFM_PARAMS_DEFAULT;

static const char *folder(const char *name)
{
    mkdir(scratch_path(name), 0777);
    return scratch_path(name);
}

static void write_text_model(const char *name)
{
    char file[64];
    folder(name);
    snprintf(file, sizeof file, "%s/cameras.txt", name);
    scratch_write(file, cameras);
    snprintf(file, sizeof file, "%s/images.txt", name);
    scratch_write(file, images);
    snprintf(file, sizeof file, "%s/points3D.txt", name);
    scratch_write(file, "7 0 0 5 1 2 3 0.5 1 0 2 0\n");
}

/* Imports `from` as the product `out`. */
static enum status import(const char *from, const char *out, struct err *err)
{
    struct provenance prov = {.stage = "sfm", .version = "0"};
    struct sfm_folder f = {0};
    struct sfm_input in = {.photos = scratch, .list = &photos, .params = &params, .prov = &prov};
    if (!sfm_folder_open(&f, scratch_path(out), err) && !user_model_add(&f, scratch_path(from), &in, &prov, err))
        sfm_folder_commit(&f, &photos, &prov, err);
    sfm_folder_release(&f);
    provenance_release(&prov);
    return err->status;
}

static void a_text_model_is_imported(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct sfm_model m;
    write_text_model("text");
    assert_ok(import("text", "sfm", &err), err);
    char *models = scratch_read(scratch_path("sfm/models.txt")), *list = scratch_read(scratch_path("sfm/photos.txt"));
    assert_contains(models, "remodel-sfm 2\n0 colmap model\n");
    assert_contains(models, "# input model/0/images.txt ");
    assert_contains(list, "\na 00\nb 11\n");
    free(models);
    free(list);
    assert_ok(sfm_model_read_text(&m, scratch_path("sfm/0"), NULL, &err), err);
    assert_int_equal(m.image_count, 2);
    assert_string_equal(m.images[1].name, "x/a.jpg");
    sfm_model_release(&m);
    assert_int_equal(count_entries(scratch_path("sfm")), 3);
    assert_int_equal(access(scratch_path("sfm.work"), F_OK), -1);
}

static void all_numbered_models_are_imported(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    folder("many");
    write_text_model("many/0");
    write_text_model("many/1");
    write_text_model("many/3"); /* 2 is missing: not part of the series */
    assert_ok(import("many", "sfm-many", &err), err);
    assert_int_equal(count_entries(scratch_path("sfm-many")), 4);
    assert_int_equal(access(scratch_path("sfm-many/1/images.txt"), F_OK), 0);
}

static void a_bundler_model_needs_its_list_of_images(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct sfm_model m;
    folder("bundler");
    scratch_write("bundler/other.out", "not a Bundler file\n");
    folder("bundler/bundle");
    scratch_write("bundler/bundle/bundle.out",
                  "# Bundle file v0.3\n3 0\n"
                  "60 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n60 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n"
                  "60 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n");
    assert_int_equal(import("bundler", "sfm-bundler", &err), ST_DATA);
    assert_err(err, ST_DATA, "has no list of its images");
    err = (struct err)ERR_INIT;
    scratch_write("bundler/my-list.txt", "./b.jpg 0 660.8\n./stranger.jpg\n./a.jpg\n");
    assert_ok(import("bundler", "sfm-bundler", &err), err);
    assert_ok(sfm_model_read_text(&m, scratch_path("sfm-bundler/0"), NULL, &err), err);
    assert_int_equal(m.image_count, 2); /* stranger.jpg is not a photo: its size is unknown */
    assert_string_equal(m.images[0].name, "./a.jpg");
    assert_int_equal(m.cameras[0].camera.width, 64);
    sfm_model_release(&m);
    scratch_write("bundler/my-list.txt", "s.jpg\nt.jpg\nu.jpg\n");
    assert_int_equal(import("bundler", "sfm-bundler", &err), ST_DATA);
    assert_err(err, ST_DATA, "none of the 3 images");
}

static void invalid_models_are_rejected_and_the_old_folder_stays(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    write_text_model("good");
    assert_ok(import("good", "kept", &err), err);
    char *before = scratch_read(scratch_path("kept/0/images.txt"));

    folder("empty");
    assert_int_equal(import("empty", "kept", &err), ST_DATA);
    assert_err(err, ST_DATA, "contains no structure-from-motion model");
    err = (struct err)ERR_INIT;
    assert_int_equal(import("absent", "kept", &err), ST_IO);
    err = (struct err)ERR_INIT;
    scratch_write("good/images.txt", "1 1 0 0 0 0 0 0 9 a.jpg\n\n");
    assert_int_equal(import("good", "kept", &err), ST_DATA);
    assert_err(err, ST_DATA, "images.txt:1");
    assert_file_text(scratch_path("kept/0/images.txt"), before);
    free(before);

    /* a valid one replaces it, here with fewer models than before */
    err = (struct err)ERR_INIT;
    assert_ok(import("many", "kept", &err), err);
    write_text_model("good");
    assert_ok(import("good", "kept", &err), err);
    assert_int_equal(count_entries(scratch_path("kept")), 3);
}

static void a_folder_with_other_files_is_not_replaced(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    write_text_model("good");
    folder("precious");
    scratch_write("precious/photo.jpg", "x");
    assert_int_equal(import("good", "precious", &err), ST_USAGE);
    assert_err(err, ST_USAGE, "it would be replaced as a whole");
    assert_file_text(scratch_path("precious/photo.jpg"), "x");
}

/* The work folder contains links to photos. */
static void removing_a_folder_keeps_the_targets_of_links(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    folder("user");
    scratch_write("user/photo.jpg", "x");
    folder("work");
    assert_int_equal(symlink(scratch_path("user"), scratch_path("work/folder")), 0);
    assert_int_equal(symlink(scratch_path("user/photo.jpg"), scratch_path("work/photo")), 0);
    assert_ok(sfm_remove_tree(scratch_path("work"), &err), err);
    assert_int_equal(access(scratch_path("work"), F_OK), -1);
    assert_file_text(scratch_path("user/photo.jpg"), "x");
    assert_ok(sfm_remove_tree(scratch_path("work"), &err), err);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_text_model_is_imported),
        cmocka_unit_test(all_numbered_models_are_imported),
        cmocka_unit_test(a_bundler_model_needs_its_list_of_images),
        cmocka_unit_test(invalid_models_are_rejected_and_the_old_folder_stays),
        cmocka_unit_test(a_folder_with_other_files_is_not_replaced),
        cmocka_unit_test(removing_a_folder_keeps_the_targets_of_links),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
