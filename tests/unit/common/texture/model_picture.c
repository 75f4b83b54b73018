/* model_picture.c - pictures of a model on disk. */
#include "common/texture/model_picture.h"

#include "tests/unit/scratch.h"

#include "common/image/exr.h"

static const struct view camera = {.name = "v",
                                   .width = 5,
                                   .height = 4,
                                   .fx = 4,
                                   .fy = 4,
                                   .cx = 2.5,
                                   .cy = 2,
                                   .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                   .translation = {1, 2, 3}};
static const struct provenance prov = {.stage = "test", .version = "1"};

static struct model_picture make_picture(void)
{
    struct model_picture p = {0};
    struct err err = ERR_INIT;
    assert_ok(model_picture_resize(&p, 5, 4, &err), err);
    for (int i = 0; i < 20; i++) {
        p.made[i] = (uint8_t)(i % MADE_COUNT);
        if (p.made[i] == MADE_NOTHING) continue;
        for (int c = 0; c < 3; c++) p.rgb[3 * i + c] = 0.25f * (float)(i + c);
        if (p.made[i] == MADE_OUTDOORS) continue;
        p.z[i] = 1.7f + (float)i;
        p.id[i] = (uint32_t)(100000 + i);
    }
    return p;
}

static void a_picture_is_read_as_it_was_written(void **state)
{
    (void)state;
    struct model_picture p = make_picture(), q = {0};
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_path("p.exr");
    assert_ok(model_picture_write(&p, &camera, path, &prov, &err), err);
    assert_ok(model_picture_read(&q, path, NULL, &err), err);
    assert_int_equal(q.width, 5);
    assert_int_equal(q.height, 4);
    assert_memory_equal(p.rgb, q.rgb, 60 * sizeof *p.rgb);
    assert_memory_equal(p.z, q.z, 20 * sizeof *p.z);
    assert_memory_equal(p.id, q.id, 20 * sizeof *p.id);
    assert_memory_equal(p.made, q.made, 20);
    assert_ok(exr_read(&im, path, NULL, 0, &err), err);
    assert_true(im.has_world_to_camera && im.world_to_camera[12] == 1 && im.world_to_camera[14] == 3);
    exr_image_release(&im);
    model_picture_release(&p);
    model_picture_release(&q);
}

static void a_resized_picture_is_empty(void **state)
{
    (void)state;
    struct model_picture p = make_picture();
    struct err err = ERR_INIT;
    const float *before = p.rgb;
    assert_ok(model_picture_resize(&p, 5, 4, &err), err);
    assert_ptr_equal(before, p.rgb);
    for (int i = 0; i < 20; i++)
        assert_true(p.rgb[3 * i] == 0 && p.z[i] == 0 && p.id[i] == 0 && p.made[i] == MADE_NOTHING);
    assert_ok(model_picture_resize(&p, 2, 3, &err), err);
    assert_int_equal(p.width * p.height, 6);
    assert_int_not_equal(model_picture_resize(&p, 0, 3, &err), ST_OK);
    assert_err(err, ST_DATA, "0 x 3");
    model_picture_release(&p);
}

/* Writes a picture with one wrong pixel; reading it must name the pixel. */
static void refuse(void (*spoil)(struct model_picture *p))
{
    struct model_picture p = make_picture(), q = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_path("bad.exr");
    spoil(&p);
    assert_ok(model_picture_write(&p, &camera, path, &prov, &err), err);
    assert_int_not_equal(model_picture_read(&q, path, NULL, &err), ST_OK);
    assert_err(err, ST_DATA, "pixel (2, 1)");
    assert_null(q.rgb);
    model_picture_release(&p);
}

static void spoil_made(struct model_picture *p) { p->made[7] = MADE_COUNT; }
static void spoil_z(struct model_picture *p) { p->z[7] = 0, p->id[7] = 3; }
static void spoil_id(struct model_picture *p) { p->z[7] = 1, p->id[7] = 0; }
static void spoil_nothing(struct model_picture *p) { p->rgb[21] = 1, p->made[7] = MADE_NOTHING; }

static void wrong_pixels_are_named(void **state)
{
    (void)state;
    refuse(spoil_made);
    refuse(spoil_z);
    refuse(spoil_id);
    refuse(spoil_nothing);
}

/* Colours outside of Rec.709 become displayable ones; a file with others is not one of these. */
static void colours_are_0_or_more(void **state)
{
    struct model_picture p = make_picture(), q = {0};
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_path("bad.exr");
    (void)state;
    p.rgb[22] = -1;
    assert_ok(model_picture_write(&p, &camera, path, &prov, &err), err);
    assert_ok(model_picture_read(&q, path, NULL, &err), err);
    assert_true(q.rgb[22] == 0 && q.rgb[21] == p.rgb[21]);
    model_picture_release(&q);
    assert_ok(exr_read(&im, path, NULL, 0, &err), err);
    exr_find(&im, "G")->f[7] = -1;
    assert_ok(exr_write(&im, path, &prov, &err), err);
    exr_image_release(&im);
    assert_int_not_equal(model_picture_read(&q, path, NULL, &err), ST_OK);
    assert_err(err, ST_DATA, "pixel (2, 1)");
    model_picture_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_is_read_as_it_was_written),
        cmocka_unit_test(a_resized_picture_is_empty),
        cmocka_unit_test(wrong_pixels_are_named),
        cmocka_unit_test(colours_are_0_or_more),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
