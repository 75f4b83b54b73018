/* thing_volume.c - the volume of things: places and voxels, what is written is read back, damaged files are refused. */
#include "common/model/thing_volume.h"

#include <math.h>

#include "common/image/exr.h"
#include "tests/unit/scratch.h"

enum { NX = 3, NY = 4, NZ = 5, VOXELS = NX * NY * NZ };

static const struct voxel_grid grid = {{-1.5, 2, 0.25}, 0.125, {NX, NY, NZ}};

static void a_voxel_holds_its_centre_and_what_is_up_to_the_next(void **state)
{
    (void)state;
    assert_int_equal(voxel_count(&grid), VOXELS);
    for (int64_t i = 0; i < VOXELS; i++) assert_int_equal(thing_voxel_at(&grid, thing_voxel_centre(&grid, i)), i);
    const struct vec3 c = thing_voxel_centre(&grid, (2 * NY + 1) * NX + 2);
    assert_true(c.x == -1.5 + 2.5 * 0.125 && c.y == 2 + 1.5 * 0.125 && c.z == 0.25 + 2.5 * 0.125);
    assert_int_equal(thing_voxel_at(&grid, grid.origin), 0);
    assert_int_equal(thing_voxel_at(&grid, vec3_make(-1.375, 2, 0.25)), 1);
    assert_int_equal(thing_voxel_at(&grid, vec3_make(-1.5, 2.125, 0.25)), NX);
    assert_int_equal(thing_voxel_at(&grid, vec3_make(-1.5, 2, 0.375)), NX * NY);
}

static void places_outside_of_the_grid_have_no_voxel(void **state)
{
    (void)state;
    const struct vec3 outside[] = {{-1.5001, 2.1, 0.3}, {-1.125, 2.1, 0.3}, {-1.4, 1.999, 0.3}, {-1.4, 2.5, 0.3},
                                   {-1.4, 2.1, 0.2499}, {-1.4, 2.1, 0.875}, {NAN, 2.1, 0.3},    {-1.4, 2.1, INFINITY}};
    const struct thing_volume empty = {0};
    for (size_t i = 0; i < sizeof outside / sizeof *outside; i++)
        assert_int_equal(thing_voxel_at(&grid, outside[i]), -1);
    assert_int_equal(thing_volume_at(&empty, vec3_make(0, 0, 0)), 0);
}

static void what_is_written_is_read_back(void **state)
{
    (void)state;
    uint32_t id[VOXELS];
    float distance[VOXELS];
    struct thing_volume v = {grid, id, distance}, back;
    const struct provenance written = {.stage = "find_things", .version = "1"};
    struct provenance read = {0};
    struct err err = ERR_INIT;
    for (int i = 0; i < VOXELS; i++) {
        id[i] = (uint32_t)i % 4;
        distance[i] = i % 3 ? (float)(i - VOXELS / 2) / 32 : THING_UNSEEN;
    }
    assert_ok(thing_volume_write(&v, scratch_path("volume.exr"), &written, &err), err);
    assert_ok(thing_volume_read(&back, scratch_path("volume.exr"), 3, &read, &err), err);
    assert_memory_equal(&back.grid, &grid, sizeof grid);
    assert_memory_equal(back.id, id, sizeof id);
    assert_memory_equal(back.distance, distance, sizeof distance);
    assert_int_equal(thing_volume_at(&back, thing_voxel_centre(&grid, 7)), 3);
    assert_int_equal(thing_volume_at(&back, vec3_make(0, 0, 0)), 0);
    assert_int_equal(read.count, 1);
    assert_string_equal(read.inputs[0].name, "volume.exr");
    provenance_release(&read);
    thing_volume_release(&back);
    assert_null(back.id);
    assert_null(back.distance);
    thing_volume_release(&back);
    thing_volume_release(NULL);
}

/* A file of 3 columns and 20 rows with these attributes; NULL: it lacks that one. */
struct file {
    enum exr_type id_type, distance_type;
    const char *voxel, *slices, *origin_y;
    uint32_t id;    /* of voxel 7 */
    float distance; /* of voxel 7 */
};

static const struct file good = {EXR_UINT, EXR_HALF, "0.125", "5", "2", 3, 0.5f};

static void write_file(const struct file *f)
{
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&im, NX, NY * NZ, &err), err);
    assert_ok(exr_add_plane(&im, "id", f->id_type, NULL, &err), err);
    assert_ok(exr_add_plane(&im, "distance", f->distance_type, NULL, &err), err);
    if (f->voxel) assert_ok(exr_set_attribute(&im, "voxel", f->voxel, &err), err);
    if (f->slices) assert_ok(exr_set_attribute(&im, "slices", f->slices, &err), err);
    if (f->origin_y) assert_ok(exr_set_attribute(&im, "origin_y", f->origin_y, &err), err);
    assert_ok(exr_set_number(&im, "origin_x", -1.5, &err), err);
    assert_ok(exr_set_number(&im, "origin_z", 0.25, &err), err);
    if (f->id_type == EXR_UINT) im.planes[0].u[7] = f->id;
    if (f->distance_type != EXR_UINT) im.planes[1].f[7] = f->distance;
    assert_ok(exr_write(&im, scratch_path("damaged.exr"), NULL, &err), err);
    exr_image_release(&im);
}

static void is_refused(const struct file *f, const char *text)
{
    struct thing_volume v;
    struct err err = ERR_INIT;
    write_file(f);
    assert_int_equal(thing_volume_read(&v, scratch_path("damaged.exr"), 3, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, text);
    assert_contains(err.text, "damaged.exr");
    assert_contains(err.text, "run find_things again");
    assert_null(v.id);
    assert_null(v.distance);
    assert_int_equal(v.grid.size[0] + v.grid.size[1] + v.grid.size[2], 0);
}

static void damaged_files_are_refused(void **state)
{
    (void)state;
    struct thing_volume v;
    struct err err = ERR_INIT;
    write_file(&good);
    assert_ok(thing_volume_read(&v, scratch_path("damaged.exr"), 3, NULL, &err), err);
    assert_int_equal(thing_volume_at(&v, thing_voxel_centre(&grid, 7)), 3);
    thing_volume_release(&v);
    struct file f;
#define CASE(field, value, text) f = good, f.field = value, is_refused(&f, text)
    CASE(id, 4, "voxel 7 is of thing 4, but there are 3");
    CASE(distance, -1.5f, "voxel 7 has distance -1.5, wanted -1 to 1, or 2");
    CASE(distance, 2.5f, "voxel 7 has distance 2.5, wanted -1 to 1, or 2");
    CASE(voxel, NULL, "attribute voxel is missing, wanted a number");
    CASE(voxel, "0.1m", "attribute voxel is 0.1m, wanted a number");
    CASE(voxel, "nan", "attribute voxel is nan, wanted a number");
    CASE(voxel, "0", "20 rows for 5 slices of voxels of 0; wanted as many rows in each");
    CASE(voxel, "-1", "slices of voxels of -1");
    CASE(slices, NULL, "attribute slices is missing");
    CASE(slices, "3", "20 rows for 3 slices");
    CASE(slices, "0", "20 rows for 0 slices");
    CASE(slices, "2.5", "20 rows for 2.5 slices");
    CASE(slices, "40", "20 rows for 40 slices");
    CASE(origin_y, NULL, "attribute origin_y is missing");
    CASE(origin_y, "inf", "attribute origin_y is inf, wanted a number");
    CASE(id_type, EXR_HALF, "channel id has the wrong type");
    CASE(distance_type, EXR_UINT, "channel distance has the wrong type");
#undef CASE
}

static void pictures_that_are_no_volume_are_refused(void **state)
{
    (void)state;
    struct exr_image im = {0};
    struct thing_volume v;
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&im, NX, NY, &err), err);
    assert_ok(exr_add_plane(&im, "id", EXR_UINT, NULL, &err), err);
    assert_ok(exr_write(&im, scratch_path("mask.exr"), NULL, &err), err);
    exr_image_release(&im);
    assert_int_equal(thing_volume_read(&v, scratch_path("mask.exr"), 3, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "distance");
    assert_null(v.id);
    err = (struct err)ERR_INIT;
    assert_int_equal(thing_volume_read(&v, scratch_path("none.exr"), 3, NULL, &err), ST_IO);
    assert_err(err, ST_IO, "none.exr");
    assert_null(v.id);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_voxel_holds_its_centre_and_what_is_up_to_the_next),
        cmocka_unit_test(places_outside_of_the_grid_have_no_voxel),
        cmocka_unit_test(what_is_written_is_read_back),
        cmocka_unit_test(damaged_files_are_refused),
        cmocka_unit_test(pictures_that_are_no_volume_are_refused),
    };
    return cmocka_run_group_tests_name("thing_volume", tests, scratch_make, scratch_remove);
}
