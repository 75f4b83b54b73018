/* sfm_model_given.c - models of other programs: text without blank lines or points, COLMAP's binary files. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/capture/sfm_model.h"

static const char cameras[] = "1 PINHOLE 64 48 50 50 32 24\n2 OPENCV 64 48 50 51 32 24 -0.1 0.01 0.001 0.002\n";

static void write_text(const char *images, const char *points)
{
    scratch_write("cameras.txt", cameras);
    scratch_write("images.txt", images);
    if (points)
        scratch_write("points3D.txt", points);
    else
        unlink(scratch_path("points3D.txt"));
}

static void blank_lines_may_be_missing(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err = ERR_INIT;
    long long loose = 1;
    /* the second image has a name with a blank, the third its second line, the last one's ends the file */
    write_text("# Image list\n4 1 0 0 0 0 0 0 1 d.jpg\n3 1 0 0 0 1 0 0 2 c and d.jpg\r\n"
               "2 1 0 0 0 2 0 0 1 b.jpg\n10 20 -1 30 40 -1\n1 1 0 0 0 3 0 0 1 a.jpg",
               NULL);
    assert_ok(sfm_model_read_given_text(&m, scratch, &loose, &err), err);
    assert_int_equal(m.image_count, 4);
    assert_int_equal(m.point_count, 0);
    assert_int_equal(loose, 0);
    assert_string_equal(m.images[0].name, "a.jpg");
    assert_string_equal(m.images[2].name, "c and d.jpg");
    assert_int_equal(m.images[1].observation_count, 2);
    assert_int_equal(m.images[2].observation_count, 0);
    assert_true(m.images[2].cam_from_world.translation.x == 1);
    sfm_model_release(&m);
}

/* Nine numbers are three observations, and numbers only are no image. */
static void observations_are_not_taken_for_images(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err = ERR_INIT;
    long long loose = 0;
    write_text("1 1 0 0 0 0 0 0 1 a.jpg\n1 2 -1 3 4 -1 5 6 -1\n2 1 0 0 0 1 0 0 1 b.jpg\n"
               "1 2 -1 3 4 -1 5 6 -1 7 8 -1\n",
               NULL);
    assert_ok(sfm_model_read_given_text(&m, scratch, &loose, &err), err);
    assert_int_equal(m.image_count, 2);
    assert_int_equal(m.images[0].observation_count, 3);
    assert_int_equal(m.images[1].observation_count, 4);
    sfm_model_release(&m);
}

static void errors_name_the_users_file_and_line(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err = ERR_INIT;
    long long loose = 0;
    char wanted[512];
    write_text("1 1 0 0 0 0 0 0 1 a.jpg\n2 1 0 0 0 1 0 zero 1 b.jpg\n", NULL);
    assert_int_equal(sfm_model_read_given_text(&m, scratch, &loose, &err), ST_DATA);
    snprintf(wanted, sizeof wanted, "%s/images.txt:2", scratch);
    assert_err(err, ST_DATA, wanted);
}

static const char images[] = "5 1 0 0 0 0.5 0 2 1 b one.jpg\n10.5 20.25 9 30 40 -1 50 60 4\n"
                             "2 0 0 1 0 1 2 3 2 a.jpg\n1 2 4 3 4 9\n";
static const char points[] = "9 1 2 3 255 0 128 0.75 5 0 2 1\n4 -1 -2 3.5 1 2 3 -1 2 0 5 2\n";

static void what_tracks_refer_to_may_be_missing(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err = ERR_INIT;
    long long loose = 0;
    /* an image that is not there, an observation that is not there, one of another point */
    write_text(images, "9 1 2 3 255 0 128 0.75 5 0 2 1 77 0 5 9\n4 -1 -2 3.5 1 2 3 -1 2 0 5 1\n");
    assert_ok(sfm_model_read_given_text(&m, scratch, &loose, &err), err);
    assert_int_equal(loose, 3);
    assert_int_equal(m.points[1].track_count, 2);
    assert_int_equal(m.points[0].track_count, 1);
    assert_int_equal(m.images[1].observations[2].point_id, -1); /* no track lists it */
    sfm_model_release(&m);
    assert_int_equal(sfm_model_read_text(&m, scratch, NULL, &err), ST_DATA); /* our own files have no such thing */
}

/* ---------------------------------------------------------------------------------------------------- binary files */

struct bytes {
    unsigned char at[4096];
    size_t size;
};

static void put(struct bytes *b, const void *value, size_t size)
{
    memcpy(b->at + b->size, value, size);
    b->size += size;
}
static void put_32(struct bytes *b, uint32_t v) { put(b, &v, sizeof v); }
static void put_64(struct bytes *b, uint64_t v) { put(b, &v, sizeof v); }
static void put_double(struct bytes *b, double v) { put(b, &v, sizeof v); }

/* The model of `cameras`, `images` and `points` as COLMAP writes it. */
static void binary_model(struct bytes b[3])
{
    static const double lens[2][8] = {{50, 50, 32, 24}, {50, 51, 32, 24, -0.1, 0.01, 0.001, 0.002}};
    static const double pose[2][7] = {{1, 0, 0, 0, 0.5, 0, 2}, {0, 0, 1, 0, 1, 2, 3}};
    static const double seen[2][3][2] = {{{10.5, 20.25}, {30, 40}, {50, 60}}, {{1, 2}, {3, 4}}};
    static const int64_t of[2][3] = {{9, -1, 4}, {4, 9}};
    static const double position[2][3] = {{1, 2, 3}, {-1, -2, 3.5}};
    static const unsigned char rgb[2][3] = {{255, 0, 128}, {1, 2, 3}};
    static const uint32_t track[2][4] = {{5, 0, 2, 1}, {2, 0, 5, 2}};
    memset(b, 0, 3 * sizeof *b);
    for (int f = 0; f < 3; f++) put_64(&b[f], 2);
    for (int i = 0; i < 2; i++) {
        put_32(&b[0], (uint32_t)i + 1);
        put_32(&b[0], i ? 4 : 1);
        put_64(&b[0], 64);
        put_64(&b[0], 48);
        for (int k = 0; k < (i ? 8 : 4); k++) put_double(&b[0], lens[i][k]);
        put_32(&b[1], i ? 2 : 5);
        for (int k = 0; k < 7; k++) put_double(&b[1], pose[i][k]);
        put_32(&b[1], (uint32_t)i + 1);
        put(&b[1], i ? "a.jpg" : "b one.jpg", i ? 6 : 10);
        put_64(&b[1], i ? 2 : 3);
        for (int k = 0; k < (i ? 2 : 3); k++) {
            put_double(&b[1], seen[i][k][0]);
            put_double(&b[1], seen[i][k][1]);
            put_64(&b[1], (uint64_t)of[i][k]);
        }
        put_64(&b[2], i ? 4 : 9);
        for (int k = 0; k < 3; k++) put_double(&b[2], position[i][k]);
        put(&b[2], rgb[i], 3);
        put_double(&b[2], i ? -1 : 0.75);
        put_64(&b[2], 2);
        for (int k = 0; k < 4; k++) put_32(&b[2], track[i][k]);
    }
}

static const char *const files[] = {"cameras.bin", "images.bin", "points3D.bin"};

static void write_binary(const struct bytes b[3])
{
    for (int f = 0; f < 3; f++) scratch_write_bytes(files[f], b[f].at, b[f].size);
}

static void a_binary_model_equals_its_text(void **state)
{
    (void)state;
    struct bytes b[3];
    struct sfm_model m, text;
    struct err err = ERR_INIT;
    long long loose = 1;
    binary_model(b);
    write_binary(b);
    scratch_write("rigs.bin", "of no interest"); /* since COLMAP 3.12 */
    scratch_write("frames.bin", "neither");
    write_text(images, points);
    assert_ok(sfm_model_read_given_binary(&m, scratch, &loose, &err), err);
    assert_ok(sfm_model_read_text(&text, scratch, NULL, &err), err);
    assert_int_equal(loose, 0);
    mkdir(scratch_path("1"), 0777);
    mkdir(scratch_path("2"), 0777);
    assert_ok(sfm_model_write_text(&m, scratch_path("1"), NULL, &err), err);
    assert_ok(sfm_model_write_text(&text, scratch_path("2"), NULL, &err), err);
    for (int f = 0; f < 3; f++) {
        char name[2][32], *words[2];
        for (int k = 0; k < 2; k++) {
            snprintf(name[k], sizeof name[k], "%d/%.*s.txt", k + 1, (int)strlen(files[f]) - 4, files[f]);
            words[k] = scratch_read(scratch_path(name[k]));
        }
        assert_string_equal(words[0], words[1]);
        free(words[0]);
        free(words[1]);
    }
    sfm_model_release(&m);
    sfm_model_release(&text);
}

static void binary_points_may_be_missing(void **state)
{
    (void)state;
    struct bytes b[3];
    struct sfm_model m;
    struct err err = ERR_INIT;
    long long loose = 0;
    binary_model(b);
    write_binary(b);
    unlink(scratch_path("points3D.bin"));
    assert_ok(sfm_model_read_given_binary(&m, scratch, &loose, &err), err);
    assert_int_equal(m.image_count, 2);
    assert_int_equal(m.point_count, 0);
    assert_int_equal(m.images[1].observations[0].point_id, -1);
    sfm_model_release(&m);
}

static void an_unknown_lens_is_named(void **state)
{
    (void)state;
    struct bytes b[3];
    struct sfm_model m;
    struct err err = ERR_INIT;
    long long loose = 0;
    binary_model(b);
    b[0].at[12] = 11; /* the first camera's model */
    write_binary(b);
    assert_int_equal(sfm_model_read_given_binary(&m, scratch, &loose, &err), ST_DATA);
    assert_err(err, ST_DATA, "cameras.bin: camera 1 has COLMAP's lens model number 11, RAD_TAN_THIN_PRISM_FISHEYE,");
    err = (struct err)ERR_INIT;
    b[0].at[12] = 99;
    write_binary(b);
    assert_int_equal(sfm_model_read_given_binary(&m, scratch, &loose, &err), ST_DATA);
    assert_err(err, ST_DATA, "lens model number 99 which is not supported; wanted one of SIMPLE_PINHOLE");
}

/* However many bytes a copy has, it is whole or the error names its file. */
static void files_that_were_cut_off_are_named(void **state)
{
    (void)state;
    struct bytes b[3];
    struct sfm_model m;
    long long loose = 0;
    binary_model(b);
    for (int f = 0; f < 3; f++) {
        write_binary(b);
        for (size_t size = 0; size < b[f].size; size++) {
            struct err err = ERR_INIT;
            scratch_write_bytes(files[f], b[f].at, size);
            assert_int_equal(sfm_model_read_given_binary(&m, scratch, &loose, &err), ST_DATA);
            assert_non_null(strstr(err.text, files[f]));
            assert_int_equal(m.image_count + m.camera_count + m.point_count, 0);
        }
        struct bytes more = b[f];
        struct err err = ERR_INIT;
        put_32(&more, 0);
        scratch_write_bytes(files[f], more.at, more.size);
        assert_int_equal(sfm_model_read_given_binary(&m, scratch, &loose, &err), ST_DATA);
        assert_err(err, ST_DATA, "has 4 bytes after its 2");
    }
}

/* A count of 2^61 observations must not become an allocation. */
static void counts_are_believed_as_far_as_the_file_goes(void **state)
{
    (void)state;
    struct bytes b[3];
    struct sfm_model m;
    struct err err = ERR_INIT;
    long long loose = 0;
    binary_model(b);
    const uint64_t many = (uint64_t)1 << 61;
    memcpy(b[1].at + 8 + 4 + 56 + 4 + 10, &many, sizeof many);
    write_binary(b);
    assert_int_equal(sfm_model_read_given_binary(&m, scratch, &loose, &err), ST_DATA);
    assert_err(err, ST_DATA, "images.bin ends in image 1 of 2");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blank_lines_may_be_missing),
        cmocka_unit_test(observations_are_not_taken_for_images),
        cmocka_unit_test(errors_name_the_users_file_and_line),
        cmocka_unit_test(what_tracks_refer_to_may_be_missing),
        cmocka_unit_test(a_binary_model_equals_its_text),
        cmocka_unit_test(binary_points_may_be_missing),
        cmocka_unit_test(an_unknown_lens_is_named),
        cmocka_unit_test(files_that_were_cut_off_are_named),
        cmocka_unit_test(counts_are_believed_as_far_as_the_file_goes),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
