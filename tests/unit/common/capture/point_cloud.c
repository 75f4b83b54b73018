/* point_cloud.c - points.ply: its bytes, round trip, errors. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/capture/point_cloud.h"

static const struct cloud_point two[2] = {
    {{1, -2, 0.5}, {0, 0, -1}, {255, 128, 0}, 3, 0.75f},
    {{1e6 + 0.125, 2, 3}, {0.6f, 0, 0.8f}, {1, 2, 3}, 65535, 1},
};

static const char head[] = "ply\n"
                           "format binary_little_endian 1.0\n"
                           "comment remodel-points 1\n"
                           "comment x y z: scene units, in the world's axes, those of views/images.txt\n"
                           "comment nx ny nz: of length 1, towards the cameras that saw the surface\n"
                           "comment red green blue: sRGB, white is 255; views: how many agree; confidence: 0 to 1\n"
                           "comment cell 0.25\n"
                           "comment remodel fuse_points 9.9\n"
                           "comment views = 3\n"
                           "comment cell = 7\n"
                           "comment input depth/a.exr 0123\n"
                           "element vertex 2\n"
                           "property double x\nproperty double y\nproperty double z\n"
                           "property float nx\nproperty float ny\nproperty float nz\n"
                           "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                           "property ushort views\nproperty float confidence\n"
                           "end_header\n";

static const uint8_t first_point[45] = {
    0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0, 0, 0,    0,    0,   0,   0, 0xc0, 0, 0, 0, 0,    0,   0, 0xe0, 0x3f, /* 1 -2 0.5 */
    0, 0, 0, 0, 0, 0, 0,    0,    0, 0, 0x80, 0xbf, 255, 128, 0, 3,    0, 0, 0, 0x40, 0x3f};

static const char *write_two(const char *name)
{
    char file[] = "depth/a.exr", params[] = "[fuse_points]\nviews = 3\ncell = 7\n";
    struct provenance_input input = {file, "0123"};
    const struct provenance prov = {"fuse_points", "9.9", params, &input, 1};
    const struct point_cloud cloud = {(struct cloud_point *)two, 2, 0.25};
    const char *path = scratch_path(name);
    struct err err = ERR_INIT;
    assert_ok(point_cloud_write(&cloud, path, &prov, &err), err);
    return path;
}

static size_t bytes_of(const char *path, char *bytes, size_t room)
{
    FILE *fp = fopen(path, "rb");
    assert_non_null(fp);
    const size_t n = fread(bytes, 1, room, fp);
    fclose(fp);
    return n;
}

static void the_file_has_the_documented_bytes(void **state)
{
    char bytes[4096];
    (void)state;
    const size_t n = bytes_of(write_two("two.ply"), bytes, sizeof bytes);
    assert_int_equal(n, sizeof head - 1 + 90);
    assert_memory_equal(bytes, head, sizeof head - 1);
    assert_memory_equal(bytes + sizeof head - 1, first_point, sizeof first_point);
}

static void points_round_trip(void **state)
{
    struct point_cloud cloud;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(point_cloud_read(&cloud, write_two("two.ply"), NULL, &err), err);
    assert_int_equal(cloud.count, 2);
    assert_true(cloud.cell == 0.25);
    for (int i = 0; i < 2; i++) {
        const struct cloud_point *a = &cloud.points[i], *b = &two[i];
        assert_true(a->position.x == b->position.x && a->position.y == b->position.y && a->position.z == b->position.z);
        assert_memory_equal(a->normal, b->normal, sizeof a->normal);
        assert_memory_equal(a->color, b->color, sizeof a->color);
        assert_true(a->views == b->views && a->confidence == b->confidence);
    }
    point_cloud_release(&cloud);
    point_cloud_release(&cloud);
}

static void empty_and_large_clouds_round_trip(void **state)
{
    enum { MANY = 10000 };
    struct point_cloud cloud = {calloc(MANY, sizeof *cloud.points), MANY, 0}, read;
    const char *path = scratch_path("many.ply");
    struct err err = ERR_INIT;
    (void)state;
    for (int i = 0; i < MANY; i++)
        cloud.points[i] = (struct cloud_point){{i, 0.1 * i, -i}, {0, 1, 0}, {1, 2, 3}, 1, 0.5f};
    assert_ok(point_cloud_write(&cloud, path, NULL, &err) || point_cloud_read(&read, path, NULL, &err), err);
    assert_int_equal(read.count, MANY);
    for (int i = 0; i < MANY; i++) assert_true(read.points[i].position.y == 0.1 * i);
    point_cloud_release(&read);
    cloud.count = 0;
    assert_ok(point_cloud_write(&cloud, path, NULL, &err) || point_cloud_read(&read, path, NULL, &err), err);
    assert_int_equal(read.count, 0);
    point_cloud_release(&read);
    cloud.count = MANY;
    cloud.points[5000].normal[0] = 1;
    assert_int_equal(point_cloud_write(&cloud, scratch_path("bad.ply"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "point 5000");
    assert_int_equal(access(scratch_path("bad.ply"), F_OK), -1);
    point_cloud_release(&cloud);
}

static void assert_rejected(const char *bytes, size_t size, const char *message)
{
    struct point_cloud cloud = {(struct cloud_point *)two, 7, 1};
    struct err err = ERR_INIT;
    assert_int_equal(point_cloud_read(&cloud, scratch_write_bytes("broken.ply", bytes, size), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, message);
    assert_contains(err.text, "broken.ply");
    assert_true(!cloud.points && !cloud.count);
}

/* The valid file with one part of its header replaced. */
static void assert_header_rejected(const char *old, const char *new, const char *message)
{
    char bytes[4096], broken[4096];
    const size_t n = bytes_of(write_two("two.ply"), bytes, sizeof bytes);
    const char *at = memmem(bytes, n, old, strlen(old));
    assert_non_null(at);
    const size_t before = (size_t)(at - bytes), after = n - before - strlen(old);
    memcpy(broken, bytes, before);
    memcpy(broken + before, new, strlen(new));
    memcpy(broken + before + strlen(new), at + strlen(old), after);
    assert_rejected(broken, before + strlen(new) + after, message);
}

static void assert_point_rejected(size_t at, const void *value, size_t size)
{
    char bytes[4096];
    const size_t n = bytes_of(write_two("two.ply"), bytes, sizeof bytes);
    memcpy(bytes + sizeof head - 1 + 45 + at, value, size);
    assert_rejected(bytes, n, "point 1 ");
}

static void broken_files_are_rejected_with_a_reason(void **state)
{
    char bytes[4096];
    const size_t n = bytes_of(write_two("two.ply"), bytes, sizeof bytes);
    (void)state;
    assert_rejected("", 0, ":1: found the end of the file, wanted \"ply\"");
    assert_rejected("ply", 3, ":1:");
    assert_rejected("ply\0\n", 5, ":1:");
    assert_header_rejected("binary_little_endian", "ascii", ":2: found");
    assert_header_rejected("binary_little_endian", "binary_big_endian", ":2: found");
    assert_header_rejected("remodel-points 1", "remodel-points 2", ":3: found");
    assert_header_rejected("comment cell 0.25\n", "", "a cell size");
    assert_header_rejected("comment cell 0.25", "comment cell -1", "a cell size");
    assert_header_rejected("comment cell 0.25", "comment cell nan", "a cell size");
    assert_header_rejected("comment cell 0.25\ncomment remodel fuse_points 9.9\ncomment views = 3\ncomment cell = 7\n",
                           "", "comment cell SIZE");
    assert_header_rejected("element vertex 2", "element face 2", "element vertex COUNT");
    assert_header_rejected("element vertex 2", "element vertex -2", "element vertex COUNT");
    assert_header_rejected("element vertex 2", "element vertex 2x", "element vertex COUNT");
    assert_header_rejected("element vertex 2", "element vertex 3", "wanted 45 for each of 3 points");
    assert_header_rejected("element vertex 2", "element vertex 9000000000000000000", "9000000000000000000 points");
    assert_header_rejected("element vertex 2", "element vertex 1", "90 bytes");
    assert_header_rejected("double y", "float y", "property double y");
    assert_header_rejected("property ushort views\n", "", "property ushort views");
    assert_header_rejected("end_header\n", "element face 0\nend_header\n", "end_header");
    for (size_t cut = 1; cut < n; cut++) assert_rejected(bytes, n - cut, "wanted");
    memcpy(bytes + n, "x", 1);
    assert_rejected(bytes, n + 1, "91 bytes");

    const double no_number = NAN;
    const float far = INFINITY, long_normal = 0.9f, negative = -0.1f, too_sure = 1.5f;
    const uint16_t no_view = 0;
    assert_point_rejected(8, &no_number, 8);
    assert_point_rejected(24, &far, 4);
    assert_point_rejected(24, &long_normal, 4);
    assert_point_rejected(39, &no_view, 2);
    assert_point_rejected(41, &negative, 4);
    assert_point_rejected(41, &too_sure, 4);
}

static void a_missing_file_is_named(void **state)
{
    struct point_cloud cloud;
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(point_cloud_read(&cloud, scratch_path("nowhere.ply"), NULL, &err), ST_IO);
    assert_err(err, ST_IO, "nowhere.ply");
    err = (struct err)ERR_INIT;
    assert_int_not_equal(point_cloud_read(&cloud, scratch, NULL, &err), ST_OK); /* a folder */
}

static void an_even_share_is_kept(void **state)
{
    struct cloud_point points[10];
    (void)state;
    for (int i = 0; i < 10; i++)
        points[i] = (struct cloud_point){.position = {i, 0, 0}, .normal = {0, 0, 1}, .views = 1};
    struct point_cloud cloud = {points, 10, 0.25};
    assert_int_equal(point_cloud_thin(&cloud, 10), 1);
    assert_int_equal(cloud.count, 10);
    assert_int_equal(point_cloud_thin(&cloud, 4), 3);
    assert_int_equal(cloud.count, 4);
    for (int i = 0; i < 4; i++) assert_float_equal(cloud.points[i].position.x, 3 * i, 0);
    assert_int_equal(point_cloud_thin(&cloud, 0), 4);
    assert_int_equal(cloud.count, 1);
    cloud.count = 0;
    assert_int_equal(point_cloud_thin(&cloud, 5), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_file_has_the_documented_bytes), cmocka_unit_test(points_round_trip),
        cmocka_unit_test(empty_and_large_clouds_round_trip), cmocka_unit_test(broken_files_are_rejected_with_a_reason),
        cmocka_unit_test(a_missing_file_is_named),           cmocka_unit_test(an_even_share_is_kept),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
