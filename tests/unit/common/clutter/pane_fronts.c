/* Where a room ends before a pane: an opening 0.5 deep in a wall at x = 2, with its pane at the far side. */
#include "tests/unit/box_solids.h"

#include "common/clutter/pane_fronts.h"

static const struct box window[] = {
    {"walls", "window/sunny", {2, -1, -1}, {2.5, 1, 1}, true},
    {"glass/sunny", "glass/sunny", {2.45, -1, -1}, {2.5, 1, 1}, false},
};

static int id_of(const struct solid_mesh *mesh, const char *name)
{
    for (int i = 0; i < mesh->name_count; i++)
        if (!strcmp(mesh->names[i].name, name)) return mesh->names[i].id;
    fail_msg("there is no face %s", name);
    return 0;
}

/* A camera at (x, 0, 0) that looks along +x; each pixel sees the pane at its depth, but the first one sees a wall. */
static void look_at_pane(struct view_ids *ids, struct view *view, const struct solid_mesh *mesh, double x, double scale)
{
    struct err err = ERR_INIT;
    *view = view_at(vec3_make(x, 0, 0), acos(0), 0, 20, 10, 15);
    assert_ok(view_ids_init(ids, 20, 10, &err), err);
    for (int i = 0; i < 200; i++) {
        ids->id[i] = (uint32_t)id_of(mesh, i ? "glass/sunny/0" : "window/sunny/4");
        ids->z[i] = (float)((2.45 - x) / scale);
    }
}

static void depth_at_a_pane_is_that_of_the_wall_s_inner_face(void **state)
{
    struct err err = ERR_INIT;
    struct solid_mesh mesh = make_boxes(window, 2);
    struct pane_fronts fronts;
    struct view_ids ids;
    struct view view;
    (void)state;
    assert_ok(pane_fronts_find(&fronts, &mesh, &err), err);
    for (int k = 0; k < 2; k++) {
        const double scale = k ? 3 : 1;
        look_at_pane(&ids, &view, &mesh, 0, scale);
        pane_fronts_apply(&ids, &fronts, &view, scale);
        for (int i = 1; i < 200; i++) assert_float_equal(ids.z[i], 2 / scale, 1e-5);
        assert_float_equal(ids.z[0], 2.45 / scale, 1e-5);
        view_ids_release(&ids);
    }
    pane_fronts_release(&fronts);
    solid_mesh_release(&mesh);
}

static void a_camera_in_the_opening_sees_the_pane_itself(void **state)
{
    struct err err = ERR_INIT;
    struct solid_mesh mesh = make_boxes(window, 2);
    struct pane_fronts fronts;
    struct view_ids ids;
    struct view view;
    (void)state;
    assert_ok(pane_fronts_find(&fronts, &mesh, &err), err);
    look_at_pane(&ids, &view, &mesh, 2.2, 1);
    pane_fronts_apply(&ids, &fronts, &view, 1);
    for (int i = 0; i < 200; i++) assert_float_equal(ids.z[i], 0.25, 1e-5);
    view_ids_release(&ids);
    pane_fronts_release(&fronts);
    solid_mesh_release(&mesh);
}

static void a_pane_without_an_opening_stays_where_it_is(void **state)
{
    struct err err = ERR_INIT;
    struct solid_mesh mesh = make_boxes(window + 1, 1);
    struct pane_fronts fronts;
    (void)state;
    assert_ok(pane_fronts_find(&fronts, &mesh, &err), err);
    assert_int_equal(fronts.count, 0);
    pane_fronts_release(&fronts);
    solid_mesh_release(&mesh);
    assert_ok(pane_fronts_find(&fronts, NULL, &err), err);
    assert_int_equal(fronts.count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth_at_a_pane_is_that_of_the_wall_s_inner_face),
        cmocka_unit_test(a_camera_in_the_opening_sees_the_pane_itself),
        cmocka_unit_test(a_pane_without_an_opening_stays_where_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
