/* What edits reveal of a room that a screen divides. */
#include "tests/unit/trace_ids/room.h"

#include "stages/trace_ids/reveal.h"

enum { W = 60, H = 40, MIDDLE = 20 * W + 30 };

#define SCREEN                                              \
    {                                                       \
        "screen", "screen", {-1, -1, 1}, {1, 1, 1.1}, false \
    }
#define BOX                                                     \
    {                                                           \
        "box", "box", {-0.3, -0.3, 1.5}, {0.3, 0.3, 1.8}, false \
    }

static const struct box base_boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, SCREEN, BOX};
static struct model_rays base;
static struct view_trace trace;
static struct view view;

static int make_base(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    view = view_at(vec3_make(0, 0, 0), 0, 0, W, H, 100);
    base = make_rays(base_boxes, 4);
    assert_ok(view_trace(&trace, &base, &same_frame, &view, &err), err);
    return 0;
}

static int release_base(void **state)
{
    (void)state;
    view_trace_release(&trace);
    model_rays_release(&base);
    return 0;
}

/* Adds an edit of these boxes, whose names keep their ids. Returns the number of pixels with something new. */
static int64_t add_edit(struct reveal *r, const struct box *boxes, int count)
{
    struct model_rays m = {.mesh = make_boxes(boxes, count)};
    struct view_trace edited = {0};
    struct err err = ERR_INIT;
    int64_t pixels = -1;
    assert_ok(solid_mesh_carry_ids(&m.mesh, &base.mesh, &err), err);
    assert_ok(model_rays_build(&m, MODEL_WITH_GLASS, &err), err);
    assert_ok(view_trace(&edited, &m, &same_frame, &view, &err), err);
    assert_ok(reveal_add(r, &edited, &pixels, &err), err);
    view_trace_release(&edited);
    model_rays_release(&m);
    return pixels;
}

static struct view_reveal result_of(const struct reveal *r)
{
    struct view_reveal v;
    struct err err = ERR_INIT;
    assert_ok(reveal_result(&v, r, &err), err);
    return v;
}

static void without_edits_nothing_is_revealed(void **state)
{
    (void)state;
    struct reveal r = {.base = &trace};
    struct view_reveal v = result_of(&r);
    assert_int_equal(v.layers, 0);
    view_reveal_release(&v);
    reveal_release(&r);
}

static void an_edit_that_changes_nothing_reveals_nothing(void **state)
{
    (void)state;
    struct reveal r = {.base = &trace};
    assert_int_equal(add_edit(&r, base_boxes, 4), 0);
    assert_int_equal(r.layers, 0);
    reveal_release(&r);
}

static void a_removed_screen_reveals_the_box_behind(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, BOX};
    struct reveal r = {.base = &trace};
    assert_true(add_edit(&r, boxes, 3) > 0);
    struct view_reveal v = result_of(&r);
    assert_int_equal(v.layers, 1);
    assert_int_equal(v.id[0][MIDDLE], id_of(&base, "box/4"));
    assert_float_equal(v.z[0][MIDDLE], 1.5, 1e-6);
    assert_int_equal(v.id[0][20 * W], id_of(&base, "in/5")); /* beside the box */
    view_reveal_release(&v);
    reveal_release(&r);
}

static void new_faces_are_left_out(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"new", "new", {-2, -2, 0.5}, {2, 2, 0.6}, false}};
    struct reveal r = {.base = &trace};
    assert_int_equal(add_edit(&r, boxes, 3), 0);
    reveal_release(&r);
}

static void a_face_that_moved_is_left_out(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, {"box", "box", {-1.5, -1.5, 0.9}, {1.5, 1.5, 1.8}, false}};
    struct reveal r = {.base = &trace};
    assert_int_equal(add_edit(&r, boxes, 3), 0);
    reveal_release(&r);
}

static void two_edits_that_reveal_different_things_give_two_layers(void **state)
{
    (void)state;
    const struct box without_screen[] = {ROOM_OUTSIDE, ROOM_INSIDE, BOX}, empty[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct view_reveal v[2];
    for (int order = 0; order < 2; order++) {
        struct reveal r = {.base = &trace};
        assert_true(add_edit(&r, order ? empty : without_screen, order ? 2 : 3) > 0);
        assert_true(add_edit(&r, order ? without_screen : empty, order ? 3 : 2) > 0);
        assert_true(add_edit(&r, empty, 2) > 0); /* again: adds nothing */
        v[order] = result_of(&r);
        assert_int_equal(v[order].layers, 2);
        reveal_release(&r);
    }
    assert_int_equal(v[0].id[0][MIDDLE], id_of(&base, "box/4"));
    assert_int_equal(v[0].id[1][MIDDLE], id_of(&base, "in/5"));
    assert_float_equal(v[0].z[1][MIDDLE], 2, 1e-6);
    for (int k = 0; k < 2; k++) {
        assert_memory_equal(v[0].id[k], v[1].id[k], W * H * sizeof **v[0].id);
        assert_memory_equal(v[0].z[k], v[1].z[k], W * H * sizeof **v[0].z);
    }
    view_reveal_release(&v[0]);
    view_reveal_release(&v[1]);
}

static void a_file_is_replaced_only_if_its_bytes_change(void **state)
{
    (void)state;
    const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE, BOX}, empty[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    struct reveal r = {.base = &trace};
    struct view_reveal none = result_of(&r), back = {0};
    struct err err = ERR_INIT;
    struct stat before, after;
    bool changed = false;
    add_edit(&r, boxes, 3);
    add_edit(&r, empty, 2);
    struct view_reveal v = result_of(&r);
    const char *path = scratch_path("v.exr");
    assert_ok(view_reveal_write(&v, &view, path, NULL, &changed, &err), err);
    assert_true(changed);
    assert_int_equal(stat(path, &before), 0);
    assert_ok(view_reveal_write(&v, &view, path, NULL, &changed, &err), err);
    assert_false(changed);
    assert_int_equal(stat(path, &after), 0);
    assert_int_equal(before.st_ino, after.st_ino);
    assert_int_equal(count_entries(scratch), 1);
    assert_ok(view_reveal_read(&back, &view, path, NULL, &err), err);
    assert_int_equal(back.layers, 2);
    for (int k = 0; k < 2; k++) {
        assert_memory_equal(v.id[k], back.id[k], W * H * sizeof **v.id);
        assert_memory_equal(v.z[k], back.z[k], W * H * sizeof **v.z);
    }
    assert_ok(view_reveal_write(&none, &view, path, NULL, &changed, &err), err);
    assert_true(changed);
    view_reveal_release(&back);
    assert_ok(view_reveal_read(&back, &view, path, NULL, &err), err);
    for (int i = 0; i < W * H; i++) assert_int_equal(back.id[0][i], 0);
    view_reveal_release(&back);
    view_reveal_release(&v);
    view_reveal_release(&none);
    reveal_release(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_edits_nothing_is_revealed),
        cmocka_unit_test(an_edit_that_changes_nothing_reveals_nothing),
        cmocka_unit_test(a_removed_screen_reveals_the_box_behind),
        cmocka_unit_test(new_faces_are_left_out),
        cmocka_unit_test(a_face_that_moved_is_left_out),
        cmocka_unit_test(two_edits_that_reveal_different_things_give_two_layers),
        cmocka_unit_test_setup_teardown(a_file_is_replaced_only_if_its_bytes_change, scratch_make, scratch_remove),
    };
    return cmocka_run_group_tests(tests, make_base, release_base);
}
