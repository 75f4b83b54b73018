/* The table of products: paths from keys, products from paths, and that each row is sound. */
#include "tests/unit/scratch.h"

#include "common/product/product.h"

static void assert_path(enum product_id id, struct product_key key, const char *wanted)
{
    char path[FILE_PATH];
    struct err err = ERR_INIT;

    assert_ok(product_path(path, id, &key, &err), err);
    assert_string_equal(path, wanted);
}

static void test_a_path_is_made_from_its_key(void **state)
{
    (void)state;
    assert_path(PRODUCT_VIEW, (struct product_key){.view = "a@1"}, "views/a@1.exr");
    assert_path(PRODUCT_VIEW, (struct product_key){.view = "a", .views = "holdout/views"}, "holdout/views/a.exr");
    assert_path(PRODUCT_DEPTH, (struct product_key){.view = "a"}, "depth/a.exr");
    assert_path(PRODUCT_SEGMENTS, (struct product_key){.view = "a", .depth = "depth/round2"}, "depth/round2/a.txt");
    assert_path(PRODUCT_PLAN, (struct product_key){0}, "model/plan.txt");
    assert_path(PRODUCT_PLAN, (struct product_key){.model = "remodel/attic"}, "remodel/attic/plan.txt");
    assert_path(PRODUCT_ATLAS_PAGE, (struct product_key){.atlas = "vdta/a", .page = 12}, "vdta/a/page12.exr");
    assert_path(PRODUCT_FRAME, (struct product_key){.film = "parallax/dolly+dim", .frame = "0007"},
                "parallax/dolly+dim/frames/0007.exr");
    assert_path(PRODUCT_PATH_IMAGES, (struct product_key){.film = "remodel/e/tour"}, "remodel/e/tour/path/images.txt");
    assert_path(PRODUCT_IRRADIANCE, (struct product_key){0}, "relight/irradiance.txt");
    assert_path(PRODUCT_METRICS, (struct product_key){0}, "metrics.tsv");
}

static void test_a_folder_stands_for_the_one_of_the_table(void **state)
{
    (void)state;
    char path[FILE_PATH], long_folder[FILE_PATH + 8];
    struct err err = ERR_INIT;

    assert_ok(product_path_in(path, "/tmp/x", PRODUCT_OVERLAY, &(struct product_key){.photo = "a"}, &err), err);
    assert_string_equal(path, "/tmp/x/overlay/a.jpg");
    assert_ok(product_path_in(path, ".", PRODUCT_METRICS, NULL, &err), err);
    assert_string_equal(path, "./metrics.tsv");
    memset(long_folder, 'f', sizeof long_folder);
    long_folder[sizeof long_folder - 1] = '\0';
    assert_int_equal(product_path_in(path, long_folder, PRODUCT_PLAN, NULL, &err), ST_IO);
    assert_err(err, ST_IO, "longer than 4095 bytes");
    err = (struct err)ERR_INIT;
    assert_int_equal(product_path(path, PRODUCT_VIEW, &(struct product_key){.view = long_folder}, &err), ST_IO);
    assert_err(err, ST_IO, "longer than 4095 bytes");
}

static void test_a_path_says_which_product_it_is(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        enum product_id id;
    } cases[] = {
        {"out/scene+draft/views/a@1.exr", PRODUCT_VIEW},
        {"views/a.exr", PRODUCT_VIEW},
        {"/x/out/s/holdout/frames/a.exr", PRODUCT_HELD_FRAME},
        {"out/s/depth/round3/a.round", PRODUCT_DEPTH_ROUND},
        {"out/s/depth/a.exr", PRODUCT_DEPTH},
        {"out/s/simulated/truth/edited-e/depth/a.exr", PRODUCT_TRUE_DEPTH},
        {"out/s/ids/index.txt", PRODUCT_FACE_INDEX},
        {"out/s/ids/indexed.txt", PRODUCT_VIEW_FACES},
        {"out/s/photos/list.txt", PRODUCT_PHOTO_LIST},
        {"out/s/lri/photos/a.txt", PRODUCT_PHOTO},
        {"out/s/lri/a.exr", PRODUCT_LRI},
        {"out/s/vdta/a/page12.exr", PRODUCT_ATLAS_PAGE},
        {"out/s/vdta/a/atlas.txt", PRODUCT_ATLAS},
        {"out/s/relight/e/vita/atlas.txt", PRODUCT_ATLAS},
        {"out/s/remodel/e/objects.txt", PRODUCT_OBJECTS},
        {"out/s/relight/e/objects.txt", PRODUCT_OBJECT_LIGHT},
        {"out/s/relight/e/a-ratio.exr", PRODUCT_RELIT_RATIO},
        {"out/s/relight/e/a.exr", PRODUCT_RELIT},
        {"out/s/relight/e/unlit/a.exr", PRODUCT_PICTURE},
        {"out/s/relight/irradiance/a.exr", PRODUCT_IRRADIANCE_VIEW},
        {"out/s/relight/irradiance/a.light.txt", PRODUCT_LIGHT_RECORD},
        {"out/s/relight/irradiance-parts.txt", PRODUCT_IRRADIANCE_PARTS},
        {"out/s/remodel/e/cameras/pictures.txt", PRODUCT_PICTURE_LIST},
        {"out/s/parallax/dolly/frames/0001.exr", PRODUCT_FRAME},
        {"out/s/parallax/dolly/pan_scan/video.mp4", PRODUCT_PAN_SCAN_VIDEO},
        {"out/s/remodel/e/tour/video.mp4", PRODUCT_VIDEO},
        {"out/s/metrics.tsv", PRODUCT_METRICS},
        {"out/s/remodel/index.html", PRODUCT_REMODEL_PAGE},
        {"out/s/views/notes.doc", PRODUCT_COUNT},
        {"out/s/vdta/a/pagex.exr", PRODUCT_COUNT},
        {"out/s/views/", PRODUCT_COUNT},
        {"", PRODUCT_COUNT},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (product_at(cases[i].path) != cases[i].id) fail_msg("%s", cases[i].path);
}

static void test_each_row_is_found_by_its_own_path(void **state)
{
    (void)state;
    const struct product_key key = {.photo = "p0",
                                    .view = "v0",
                                    .edit = "e0",
                                    .move = "m0",
                                    .frame = "0001",
                                    .page = 1,
                                    .name = "n0",
                                    .film = "parallax/dolly",
                                    .relit = "relight/e0"};
    char path[FILE_PATH], pattern[FILE_PATH];
    struct err err = ERR_INIT;

    for (enum product_id id = 0; id < PRODUCT_COUNT; id++) {
        assert_ok(product_path(path, id, &key, &err), err);
        if (product_at(path) != id) fail_msg("%s: the path of another product", path);
        assert_ok(product_pattern(pattern, id, &err), err);
        assert_null(strpbrk(pattern, "{}"));
        assert_true(product_made_by(id, products[id].stages) || strchr(products[id].stages, ' '));
        if (products[id].head) {
            int version;
            assert_int_equal(sscanf(products[id].head, "remodel-%*[a-z-] %d", &version), 1);
        }
    }
}

static void test_keys_and_stages(void **state)
{
    (void)state;
    char pattern[FILE_PATH];
    struct err err = ERR_INIT;

    assert_int_equal(product_keys(PRODUCT_METRICS), 0);
    assert_int_equal(product_keys(PRODUCT_VIEW), 1u << PRODUCT_HAS_view | 1u << PRODUCT_HAS_views);
    assert_int_equal(product_keys(PRODUCT_OVERLAY), 1u << PRODUCT_HAS_model | 1u << PRODUCT_HAS_photo);
    assert_true(product_made_by(PRODUCT_PATH, "plan_path"));
    assert_true(product_made_by(PRODUCT_PATH, "plan_tour"));
    assert_false(product_made_by(PRODUCT_PATH, "plan"));
    assert_false(product_made_by(PRODUCT_VIEW, "segment_depth"));
    assert_ok(product_pattern(pattern, PRODUCT_PAN_SCAN_FRAME, &err), err);
    assert_string_equal(pattern, "FILM/pan_scan/frames/NNNN.exr");
}

static void test_a_path_names_the_product_in_the_provenance(void **state)
{
    (void)state;
    assert_string_equal(product_name(PRODUCT_VIEW, "/x/out/s+draft/views/a.exr"), "views/a.exr");
    assert_string_equal(product_name(PRODUCT_MODEL, "out/s/remodel/e/model.txt"), "remodel/e/model.txt");
    assert_string_equal(product_name(PRODUCT_MODEL, "model/model.txt"), "model/model.txt");
    assert_string_equal(product_name(PRODUCT_MODEL, "/tmp/test/model.txt"), "model.txt");
    assert_string_equal(product_name(PRODUCT_MODEL, "model.txt"), "model.txt");
    assert_string_equal(product_name(PRODUCT_OVERLAY, "/tmp/test/overlay/a.jpg"), "overlay/a.jpg");
    assert_string_equal(product_name(PRODUCT_OVERLAY, "a.jpg"), "a.jpg");
    assert_string_equal(product_name(PRODUCT_COUNT, "/tmp/test/views/a.exr"), "a.exr");
}

static void test_a_text_product_is_written_and_read(void **state)
{
    (void)state;
    struct provenance maker = {.stage = "s", .version = "1"}, prov = {0};
    struct err err = ERR_INIT;
    struct textfile t = {0};
    struct outfile f = {0};
    const char *path = scratch_path("model/axes.txt");
    char hash[HASH_TEXT];
    int version = 0;

    assert_ok(product_begin(&f, PRODUCT_AXES, path, &maker, &err), err);
    fputs("more\n", f.fp);
    assert_ok(outfile_commit(&f, &err), err);
    outfile_discard(&f);
    assert_file_text(path, "# remodel s 1\nremodel-axes 1\nmore\n");

    assert_ok(product_open(&t, &version, PRODUCT_AXES, path, &prov, &err), err);
    assert_int_equal(version, 1);
    assert_true(textfile_next(&t));
    assert_ok(textfile_expect(&t, "more", &err), err);
    textfile_release(&t);
    assert_int_equal(prov.count, 1);
    assert_string_equal(prov.inputs[0].name, "model/axes.txt");
    assert_ok(hash_file(hash, path, &err), err);
    assert_string_equal(prov.inputs[0].hash, hash);
    assert_ok(product_open(&t, NULL, PRODUCT_AXES, path, &prov, &err), err);
    textfile_release(&t);
    assert_int_equal(prov.count, 1);
    provenance_release(&prov);
}

static void test_another_first_line_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *wanted;
    } cases[] = {
        {"remodel-axis 1\n", "found \"remodel-axis\", wanted a line \"remodel-axes ...\""},
        {"remodel-axes 2\n", "found \"2\", wanted the version, an integer from 1 to 1"},
        {"remodel-axes 1 1\n", "wanted the end of the line"},
        {"", "empty file"},
    };

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct err err = ERR_INIT;
        struct textfile t = {0};
        const char *path = scratch_write("axes.txt", cases[i].text);
        assert_int_equal(product_open(&t, NULL, PRODUCT_AXES, path, NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i].wanted);
        assert_null(t.bytes);
    }
    struct err err = ERR_INIT;
    struct textfile t = {0};
    int version = 0;
    const char *path = scratch_write("plan.txt", "# of an earlier release\nremodel-plan 1\n");
    assert_ok(product_open(&t, &version, PRODUCT_PLAN, path, NULL, &err), err);
    assert_int_equal(version, 1);
    textfile_release(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_path_is_made_from_its_key),
        cmocka_unit_test(test_a_folder_stands_for_the_one_of_the_table),
        cmocka_unit_test(test_a_path_says_which_product_it_is),
        cmocka_unit_test(test_each_row_is_found_by_its_own_path),
        cmocka_unit_test(test_keys_and_stages),
        cmocka_unit_test(test_a_path_names_the_product_in_the_provenance),
        cmocka_unit_test(test_a_text_product_is_written_and_read),
        cmocka_unit_test(test_another_first_line_is_refused),
    };
    return cmocka_run_group_tests_name("product", tests, scratch_make, scratch_remove);
}
