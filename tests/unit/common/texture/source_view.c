/* source_view.c - which pixels of a view may be a source of texels, with things before the model and without. */
#include "common/texture/source_view.h"

#include "common/capture/view_image.h"
#include "common/model/thing_mask.h"
#include "tests/unit/scratch.h"

#include <math.h>

/* Columns of the view are in bands, each of pixels of one kind. A thing shows in the rows up to SHOWN, and rays through
 * the rows from MET on meet another one. */
enum { BAND = 8, HEIGHT = 90, SHOWN = 2, MET = 80, FACE = 5, WIDER = 4 };
static const float WALL = 0.5f, THING = 8;

static const struct band {
    float clutter, jump, clipped;
    uint8_t own, state; /* without things */
} bands[] = {
    {0, VIEW_IDS_FAR, 0, SOURCE_CLEAN, SOURCE_CLEAN},       {0.09f, VIEW_IDS_FAR, 0, SOURCE_CLEAN, SOURCE_CLEAN},
    {0.11f, VIEW_IDS_FAR, 0, SOURCE_LIKELY, SOURCE_LIKELY}, {0.29f, VIEW_IDS_FAR, 0, SOURCE_LIKELY, SOURCE_LIKELY},
    {0.31f, VIEW_IDS_FAR, 0, SOURCE_UNSURE, SOURCE_UNSURE}, {0.59f, VIEW_IDS_FAR, 0, SOURCE_UNSURE, SOURCE_UNSURE},
    {0.61f, VIEW_IDS_FAR, 0, SOURCE_HIDDEN, SOURCE_HIDDEN}, {0, VIEW_IDS_FAR, 1, SOURCE_CLEAN, SOURCE_POOR},
    {0.2f, VIEW_IDS_FAR, 1, SOURCE_LIKELY, SOURCE_POOR},    {0, 4, 0, SOURCE_NONE, SOURCE_NONE},
};
enum { BANDS = sizeof bands / sizeof *bands, WIDTH = BANDS * BAND };

static const struct view camera = {.name = "v",
                                   .width = WIDTH,
                                   .height = HEIGHT,
                                   .fx = 50,
                                   .fy = 50,
                                   .cx = WIDTH / 2.0,
                                   .cy = HEIGHT / 2.0,
                                   .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};

static bool is_thing(int i) { return i / WIDTH < SHOWN; }

static void write_picture(void)
{
    static const char *const names[VIEW_CHANNELS] = {"R", "G", "B", "A", "sigma", "clipped"};
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&im, WIDTH, HEIGHT, &err), err);
    for (int c = 0; c < VIEW_CHANNELS; c++) {
        struct exr_plane *plane;
        assert_ok(exr_add_plane(&im, names[c], EXR_HALF, &plane, &err), err);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            plane->f[i] = c < VIEW_A        ? is_thing(i) ? THING : WALL
                          : c == VIEW_A     ? 1
                          : c == VIEW_SIGMA ? 0.01f
                                            : bands[i % WIDTH / BAND].clipped;
    }
    assert_ok(exr_write(&im, scratch_path("views/v.exr"), NULL, &err), err);
    exr_image_release(&im);
}

static void write_ids(void)
{
    struct view_ids ids;
    struct err err = ERR_INIT;
    assert_ok(view_ids_init(&ids, WIDTH, HEIGHT, &err), err);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        ids.id[i] = FACE;
        ids.z[i] = 2;
        ids.jump[i] = bands[i % WIDTH / BAND].jump;
        ids.clutter[i] = bands[i % WIDTH / BAND].clutter;
    }
    assert_ok(view_ids_write(&ids, &camera, scratch_path("ids/v.exr"), NULL, &err), err);
    view_ids_release(&ids);
}

static void write_mask(const char *name, bool empty)
{
    struct thing_mask mask = {0};
    struct err err = ERR_INIT;
    assert_ok(thing_mask_init(&mask, &camera, &err), err);
    for (int i = 0; i < WIDTH * HEIGHT && !empty; i++) {
        mask.shows[i] = is_thing(i);
        mask.meets[i] = i / WIDTH >= MET ? 2 : 0;
    }
    assert_ok(thing_mask_write(&mask, &camera, scratch_path(name), NULL, &err), err);
    thing_mask_release(&mask);
}

static int write_all(void **state)
{
    if (scratch_make(state)) return -1;
    write_picture();
    write_ids();
    write_mask("things/masks/v.exr", false);
    write_mask("none/masks/v.exr", true);
    return 0;
}

/* The caller releases v. things: a scratch folder; NULL: no things are known. Returns the number of files read. */
static int read_view(struct source_view *v, const char *things, double margin)
{
    const struct source_files files = {scratch_path("views"), scratch_path("ids"),
                                       things ? scratch_path(things) : NULL};
    struct texture_params params = TEXTURE_PARAMS_DEFAULT;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    params.thing_margin = margin;
    assert_ok(source_view_read(v, NULL, &files, &camera, &params, &prov, &err), err);
    const int count = prov.count;
    provenance_release(&prov);
    return count;
}

/* Where masks hold no thing, clutter is the view's word alone. */
static int without_thing(int state, bool masks) { return masks && state == SOURCE_HIDDEN ? SOURCE_ALLEGED : state; }

static void without_things_clutter_and_jumps_decide(void **state)
{
    (void)state;
    static const char *const folders[] = {NULL, "none"};
    for (int k = 0; k < 2; k++) {
        struct source_view v;
        assert_int_equal(read_view(&v, folders[k], 3), 2 + k);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            assert_int_equal(v.own[i], without_thing(bands[i % WIDTH / BAND].own, k));
            assert_int_equal(v.state[i], without_thing(bands[i % WIDTH / BAND].state, k));
        }
        assert_true(source_view_shows(&v, FACE));
        source_view_release(&v);
    }
}

/* Of a pixel in row y, which without things has the state `before`. */
static int state_beside_things(int before, int y, double margin)
{
    const int away = y < SHOWN || y >= MET ? 0 : y - SHOWN + 1 < MET - y ? y - SHOWN + 1 : MET - y;
    const double rim = before == SOURCE_CLEAN ? margin : WIDER * margin;
    if (before != SOURCE_NONE && away <= rim) return SOURCE_HIDDEN;
    return before == SOURCE_HIDDEN ? SOURCE_ALLEGED : before;
}

static void pixels_of_things_are_hidden_with_a_rim_that_is_wider_where_depth_is_not_sure(void **state)
{
    (void)state;
    static const double margins[] = {0, 3, 4.5};
    for (int k = 0; k < 3; k++) {
        struct source_view v;
        assert_int_equal(read_view(&v, "things", margins[k]), 3);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const struct band *band = &bands[i % WIDTH / BAND];
            assert_int_equal(v.own[i], state_beside_things(band->own, i / WIDTH, margins[k]));
            assert_int_equal(v.state[i], state_beside_things(band->state, i / WIDTH, margins[k]));
        }
        assert_true(source_view_shows(&v, FACE));
        source_view_release(&v);
    }
}

/* In the first band, whose pixels are clean. The finest level has all pixels of the photo. */
static void the_colour_of_a_thing_does_not_leak_into_coarser_levels(void **state)
{
    (void)state;
    const double x = BAND / 2.0;
    struct source_view with, without;
    float rgb[3];
    read_view(&without, NULL, 3);
    read_view(&with, "things", 3);
    assert_true(source_view_sample(rgb, &without, x, 1, 2));
    assert_float_equal(rgb[0], THING, 1e-6);
    assert_false(source_view_sample(rgb, &with, x, 1, 2));
    assert_true(source_view_sample(rgb, &with, x, 0.5, 1));
    assert_float_equal(rgb[0], THING, 1e-6);
    assert_int_equal(with.level_count, SOURCE_LEVELS);
    for (int level = 1; level < SOURCE_LEVELS; level++) {
        assert_true(source_view_sample(rgb, &with, x, HEIGHT / 2.0, 1 << level));
        for (double y = 0; y < MET; y += 0.5)
            if (source_view_sample(rgb, &with, x, y, 1 << level)) assert_float_equal(rgb[0], WALL, 1e-6);
    }
    source_view_release(&with);
    source_view_release(&without);
}

static void things_without_a_mask_of_the_view_are_an_error(void **state)
{
    (void)state;
    const struct source_files files = {scratch_path("views"), scratch_path("ids"), scratch_path("nowhere")};
    const struct texture_params params = TEXTURE_PARAMS_DEFAULT;
    struct source_view v;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    assert_int_not_equal(source_view_read(&v, NULL, &files, &camera, &params, &prov, &err), ST_OK);
    assert_contains(err.text, "nowhere/masks/v.exr");
    source_view_release(&v);
    provenance_release(&prov);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_things_clutter_and_jumps_decide),
        cmocka_unit_test(pixels_of_things_are_hidden_with_a_rim_that_is_wider_where_depth_is_not_sure),
        cmocka_unit_test(the_colour_of_a_thing_does_not_leak_into_coarser_levels),
        cmocka_unit_test(things_without_a_mask_of_the_view_are_an_error),
    };
    return cmocka_run_group_tests_name("source_view", tests, write_all, scratch_remove);
}
