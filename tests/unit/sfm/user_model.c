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

/* Bundler's file of three cameras, of which none sees a point. */
static const char three_cameras[] = "# Bundle file v0.3\n3 0\n"
                                    "60 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n60 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0\n"
                                    "60 0 0\n1 0 0\n0 1 0\n0 0 1\n2 0 0\n";

/* Imports the Bundler model with a list of images; a.jpg is the third one, b.jpg the first. */
static void expect_list(const char *name, const char *list)
{
    struct err err = ERR_INIT;
    struct sfm_model m;
    folder("lists");
    scratch_write("lists/bundle.out", three_cameras);
    scratch_write(name, list);
    assert_ok(import("lists", "sfm-lists", &err), err);
    unlink(scratch_path(name));
    assert_ok(sfm_model_read_text(&m, scratch_path("sfm-lists/0"), NULL, &err), err);
    assert_int_equal(m.image_count, 2);
    for (int i = 0; i < 2; i++) {
        const bool is_a = strstr(m.images[i].name, "a.jpg");
        assert_true(is_a || strstr(m.images[i].name, "b.jpg"));
        assert_true(m.images[i].cam_from_world.translation.x == (is_a ? 2 : 0));
    }
    sfm_model_release(&m);
}

static void lists_of_images_may_have_any_systems_paths(void **state)
{
    (void)state;
    expect_list("lists/images.lst", "C:\\Users\\Ann\\b.jpg\r\nC:\\Users\\Ann\\other.jpg\r\nC:\\Users\\Ann\\a.jpg\r\n");
    expect_list("lists/list.txt", "C:\\Ann Lee\\My 2 Photos\\b.jpg\nD:\\x y.jpg\nC:\\Ann Lee\\My 2 Photos\\a.jpg\n");
    expect_list("lists/list.txt", "\"C:\\new folder\\b.jpg\"\n\"C:\\x\"\n\"C:\\new folder\\a.jpg\"\n");
    expect_list("lists/list.txt", "# photos\n\n./my photos/b.jpg 0 660.8\n./x.jpg 0 1\n  ./my photos/a.jpg  0\n");
    expect_list("lists/PHOTOS.LST", "\xEF\xBB\xBF/home/ann/b.jpg\n/home/ann/c.jpg\n/home/ann/a.jpg\n");
}

static void a_model_may_be_in_a_folder_sparse(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    folder("project");
    folder("project/sparse");
    write_text_model("project/sparse/0");
    scratch_write("project/images.txt", "");
    assert_int_equal(import("project", "sfm-project", &err), ST_DATA);
    assert_err(err, ST_DATA, "has images.txt but no cameras.txt");
    unlink(scratch_path("project/images.txt"));
    err = (struct err)ERR_INIT;
    assert_ok(import("project", "sfm-project", &err), err);
    assert_int_equal(count_entries(scratch_path("sfm-project")), 3);
}

/* Eight points that both photos see suffice; with seven the photos are matched. */
static void models_are_judged_by_their_points(void **state)
{
    (void)state;
    for (int points = 7; points <= 8; points++) {
        struct err err = ERR_INIT;
        bool suffice = points == 7;
        char of_points[512] = "", of_images[2][256] = {"", ""}, text[1024];
        for (int i = 1; i <= points; i++) {
            const size_t n = strlen(of_points);
            snprintf(of_points + n, sizeof of_points - n, "%d 0 0 5 1 2 3 0.5 1 %d 2 %d\n", i, i - 1, i - 1);
            for (int k = 0; k < 2; k++) snprintf(of_images[k] + strlen(of_images[k]), 16, "%d 2 %d ", i, i);
        }
        snprintf(text, sizeof text, "1 1 0 0 0 0 0 0 1 a.jpg\n%s\n2 1 0 0 0 1 0 0 1 b.jpg\n%s\n", of_images[0],
                 of_images[1]);
        folder("judged");
        scratch_write("judged/cameras.txt", cameras);
        scratch_write("judged/images.txt", text);
        scratch_write("judged/points3D.txt", of_points);
        assert_ok(user_model_judge(&suffice, scratch_path("judged"), &photos, &err), err);
        assert_int_equal(suffice, points == 8);
    }
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
        cmocka_unit_test(lists_of_images_may_have_any_systems_paths),
        cmocka_unit_test(a_model_may_be_in_a_folder_sparse),
        cmocka_unit_test(models_are_judged_by_their_points),
        cmocka_unit_test(invalid_models_are_rejected_and_the_old_folder_stays),
        cmocka_unit_test(a_folder_with_other_files_is_not_replaced),
        cmocka_unit_test(removing_a_folder_keeps_the_targets_of_links),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
