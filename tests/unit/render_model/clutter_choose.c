/* clutter_choose.c - views that a wall hides a place from lend no clutter to it. */
#include "stages/render_model/clutter_scene.h"

#include "tests/unit/box_solids.h"

enum { VIEWS = 2, W = 160, H = 120, CLEAR = 0, HIDDEN = 1 };

/* Between the place and the second view there is a wall, or a pane, or a pane with the wall behind it. */
#define WALL                                             \
    {                                                    \
        "walls", "new", {0.4, -2, 0}, {2, 2, 0.1}, false \
    }
#define PANE                                                       \
    {                                                              \
        "glass/big", "pane", {0.2, -2, -0.3}, {2, 2, -0.29}, false \
    }
static const struct box plain[] = {ROOM_OUTSIDE, ROOM_INSIDE}, walled[] = {ROOM_OUTSIDE, ROOM_INSIDE, WALL},
                        glazed[] = {ROOM_OUTSIDE, ROOM_INSIDE, PANE}, both[] = {ROOM_OUTSIDE, ROOM_INSIDE, WALL, PANE};
static const struct vec3 place = {0.3, 0, 1.5};

struct scene {
    struct clutter_scene clutter;
    struct camera_set set;
    struct view views[VIEWS];
    struct model_rays model;
};

/* Two views that look along +z at the place, 0.3 to each side of the camera. scale: model units per scene unit. */
static void scene_make(struct scene *s, const struct box *boxes, int count, double scale)
{
    const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .translation = {0.5, -0.25, 0.125}, .scale = scale};
    *s = (struct scene){.model = {.ids = 0}};
    for (int k = 0; k < VIEWS; k++)
        s->views[k] = view_at(world_from_model_point(&axes, vec3_make(k ? 0.6 : 0.2, 0, -1.5)), 0, 0, W, H, 100);
    s->set = (struct camera_set){.views = s->views, .view_count = VIEWS};
    if (count) s->model = make_rays(boxes, count);
    s->clutter = (struct clutter_scene){.set = &s->set, .axes = axes, .walls = count ? &s->model : NULL};
}

/* Whether the views are chosen for a place, seen from beside the second one. */
static void choose(bool chosen[VIEWS], const struct scene *s, struct vec3 at)
{
    const struct vec3 camera = world_from_model_point(&s->clutter.axes, vec3_make(0.55, 0, -1.5)),
                      point = world_from_model_point(&s->clutter.axes, at);
    struct clutter_choice choice;
    struct err err = ERR_INIT;
    assert_ok(clutter_choose_for(&choice, &s->clutter, camera, &point, 1, CLUTTER_VIEWS, &err), err);
    for (int k = 0; k < VIEWS; k++) chosen[k] = false;
    for (int k = 0; k < choice.count; k++) {
        assert_true(choice.fade[k] > 0);
        chosen[choice.view[k]] = true;
    }
}

static void assert_chosen(const struct box *boxes, int count, struct vec3 at, bool clear, bool hidden)
{
    for (double scale = 0.5; scale <= 2; scale *= 2) {
        bool chosen[VIEWS];
        struct scene s;
        scene_make(&s, boxes, count, scale);
        choose(chosen, &s, at);
        assert_int_equal(chosen[CLEAR], clear);
        assert_int_equal(chosen[HIDDEN], hidden);
        model_rays_release(&s.model);
    }
}

static void a_view_behind_a_wall_is_not_chosen(void **state)
{
    (void)state;
    assert_chosen(plain, 2, place, true, true);
    assert_chosen(walled, 3, place, true, false);
    assert_chosen(NULL, 0, place, true, true); /* no walls are known */
}

static void nothing_is_chosen_where_walls_hide_all_views(void **state)
{
    (void)state;
    assert_chosen(walled, 3, vec3_make(1, 0, 1.5), false, false);
}

static void a_place_before_the_wall_or_on_it_is_not_hidden(void **state)
{
    (void)state;
    assert_chosen(walled, 3, vec3_make(0.6, 0, -0.5), true, true);
    assert_chosen(walled, 3, vec3_make(0.6, 0, 0), true, true);
    assert_chosen(plain, 2, vec3_make(0.3, 0, 2), true, true); /* the room's own wall */
}

static void a_pane_hides_nothing_but_a_wall_behind_it_does(void **state)
{
    (void)state;
    assert_chosen(glazed, 3, place, true, true);
    assert_chosen(both, 4, place, true, false);
}

/* One column of the picture has a shell. Of its places those on the shell are behind the wall, those half way to it are
 * before the wall. */
static void a_picture_prefers_views_that_no_wall_hides(void **state)
{
    enum { COLUMN = 75 };
    (void)state;
    static float z[W * H];
    const struct vec3 at = vec3_make(0.55, 0, -1.5);
    for (int y = 0; y < H; y++) z[y * W + COLUMN] = 2.8f;
    for (int with_wall = 0; with_wall < 2; with_wall++) {
        struct scene s;
        struct clutter_choice choice;
        struct err err = ERR_INIT;
        scene_make(&s, with_wall ? walled : plain, with_wall ? 3 : 2, 1);
        const struct view camera = view_at(world_from_model_point(&s.clutter.axes, at), 0, 0, W, H, 100);
        assert_ok(clutter_choose(&choice, &s.clutter, &camera, z, 1, 1, &err), err);
        assert_int_equal(choice.count, 1);
        assert_int_equal(choice.view[0], with_wall ? CLEAR : HIDDEN); /* without it, the one that is nearer */
        model_rays_release(&s.model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_view_behind_a_wall_is_not_chosen),
        cmocka_unit_test(nothing_is_chosen_where_walls_hide_all_views),
        cmocka_unit_test(a_place_before_the_wall_or_on_it_is_not_hidden),
        cmocka_unit_test(a_pane_hides_nothing_but_a_wall_behind_it_does),
        cmocka_unit_test(a_picture_prefers_views_that_no_wall_hides),
    };
    return cmocka_run_group_tests_name("clutter_choose", tests, NULL, NULL);
}
