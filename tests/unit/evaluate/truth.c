/* truth.c - folders with a truth: names, kinds of depth, damage. */
#include "stages/evaluate/truth/truth.h"

#include "common/base/outfile.h"
#include "common/image/exr.h"
#include "tests/unit/scratch.h"

enum { W = 4, H = 3 };

static char ids[3][8] = {"a", "b", "c"}, files[3][16] = {"a.jpg", "b.jpg", "c.jpg"};
static struct photo_record records[3] = {
    {.id = ids[0], .file = files[0]}, {.id = ids[1], .file = files[1]}, {.id = ids[2], .file = files[2]}};
static const struct photo_list photos = {records, 3};

static void write_depth(const char *name, int width, const char *kind)
{
    struct exr_image im = {0};
    struct exr_plane *z;
    struct provenance prov = {.stage = "test", .version = "0"};
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&im, width, H, &err), err);
    assert_ok(exr_add_plane(&im, "Z", EXR_FLOAT, &z, &err), err);
    for (int i = 0; i < width * H; i++) z->f[i] = (float)i;
    if (kind) assert_ok(exr_set_attribute(&im, "remodel:depth", kind, &err), err);
    assert_ok(exr_write(&im, scratch_path(name), &prov, &err), err);
    exr_image_release(&im);
}

static enum status read_it(struct truth *t, struct err *err)
{
    struct provenance prov = {0};
    enum status st = truth_read(t, scratch, &photos, 9, &prov, err);
    provenance_release(&prov);
    return st;
}

static void write_cameras(void)
{
    struct err err = ERR_INIT;
    scratch_write("cameras.txt",
                  "# a fisheye and a pinhole\n1 OPENCV_FISHEYE 4 3 2 2 2 1.5 0 0 0 0\n2 PINHOLE 4 3 2 2 2 1.5\n");
    scratch_write("images.txt",
                  "7 1 0 0 0 1 2 3 1 b.png\n\n8 1 0 0 0 0 0 0 2 a.jpg\n\n9 1 0 0 0 0 0 0 2 elsewhere.jpg\n\n");
    assert_ok(outfile_make_folders(scratch_path("depth"), &err), err);
}

static void photos_and_depths_are_read(void **state)
{
    struct truth t;
    struct err err = ERR_INIT;
    (void)state;
    write_cameras();
    write_depth("depth/a.exr", W, NULL);
    write_depth("depth/b.exr", W, NULL);
    assert_ok(read_it(&t, &err), err);
    assert_int_equal(t.images, 3);
    assert_int_equal(t.unknown_images, 1);
    assert_int_equal(t.depths, 2);
    assert_int_equal(t.photos[2].lens.width, 0);
    assert_true(t.photos[1].along_ray && !t.photos[0].along_ray); /* from the lens */
    assert_true(t.photos[1].pose.translation.z == 3);
    assert_true(t.photos[0].depth[9] == 9 && t.photos[0].depth[10] == 0 && t.photos[0].depth[0] == 0); /* far is 9 */
    truth_release(&t);
    truth_release(&t);
    write_depth("depth/b.exr", W, "z"); /* the attribute overrides the lens */
    assert_ok(read_it(&t, &err), err);
    assert_false(t.photos[1].along_ray);
    truth_release(&t);
}

static void damaged_folders_are_refused(void **state)
{
    struct truth t;
    struct err err = ERR_INIT;
    (void)state;
    write_cameras();
    write_depth("depth/b.exr", W, "inches");
    assert_int_equal(read_it(&t, &err), ST_DATA);
    assert_err(err, ST_DATA, "inches");
    err = (struct err)ERR_INIT;
    write_depth("depth/b.exr", W + 1, NULL);
    assert_int_equal(read_it(&t, &err), ST_DATA);
    assert_err(err, ST_DATA, "5 x 3");
    err = (struct err)ERR_INIT;
    scratch_write("images.txt", "7 1 0 0 0 1 2 3 1 b.png\n\n8 1 0 0 0 0 0 0 2 b.jpg\n\n");
    write_depth("depth/b.exr", W, NULL);
    assert_int_equal(read_it(&t, &err), ST_DATA);
    assert_err(err, ST_DATA, "two images");
    err = (struct err)ERR_INIT;
    assert_int_equal(remove(scratch_path("images.txt")), 0);
    assert_int_equal(read_it(&t, &err), ST_IO);
    assert_err(err, ST_IO, "images.txt");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(photos_and_depths_are_read),
        cmocka_unit_test(damaged_folders_are_refused),
    };
    return cmocka_run_group_tests_name("truth", tests, scratch_make, scratch_remove);
}
