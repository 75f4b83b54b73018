/* layer_render_hard_cases.c - degenerate positions of views and novel camera, for both renderers. */
#include "tests/unit/common/layers/formula_scene.h"

static const struct shape plane = {tilted_depth, false, 0.01};

/* A view turned to the right by `angle`. */
static struct view turned_view(double x, double y, double z, double angle)
{
    struct view v = view_at(x, y, z);
    v.cam_from_world = (struct mat3){{{cos(angle), 0, -sin(angle)}, {0, 1, 0}, {sin(angle), 0, cos(angle)}}};
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

static void views_make(struct scene *s, const struct view *views, int count)
{
    struct layered_depth depths[MAX_VIEWS] = {0};
    struct err err = ERR_INIT;

    memset(s, 0, sizeof *s);
    for (int i = 0; i < count; i++) {
        s->views[i] = views[i];
        depth_make(&depths[i], &views[i], &plane);
    }
    s->set.views = s->views;
    s->set.view_count = count;
    if (layer_scene_init(&s->layers, &s->set, depths, &err)) fail_msg("%s", err.text);
}

/* Whether some view shows the point, at least a pixel inside its picture. */
static bool is_seen(const struct scene *s, struct vec3 point)
{
    for (int i = 0; i < s->set.view_count; i++) {
        double u, v;
        if (view_project(&s->views[i], point, &u, &v) > 0 && u > 1 && v > 1 && u < W - 1 && v < H - 1) return true;
    }
    return false;
}

/* Checks the picture: finite; complete where a view sees the scene, with the plane's depth and roughly its colour; the
 * same where filled. Returns the covered fraction. */
static double check_from(const struct scene *s, const struct view *novel, bool offline)
{
    struct rendered_frame f = {0};
    int shown = 0;

    render(&f, s, novel, offline, 0);
    frame_is_finite(&f);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int p = y * W + x;
            int surface;
            const double z = tilted_depth(novel, x + 0.5, y + 0.5, &surface);
            if (z > 0 && is_seen(s, view_unproject(novel, x + 0.5, y + 0.5, z)) && f.hole[p])
                fail_msg("a hole at (%d, %d) where a view sees", x, y);
            assert_true(f.rgba[4 * p + 3] == (f.hole[p] ? 0 : 1));
            if (f.hole[p]) continue;
            assert_true(fabs((double)f.z[p] - z) <= 2e-3 * z);
            shown++;
        }
    if (shown > 500) assert_true(psnr(&f, novel, &plane, 0) > 28);
    render(&f, s, novel, offline, 6);
    frame_is_finite(&f);
    for (int p = 0; shown && p < W * H; p++) assert_true(f.rgba[4 * p + 3] == 1 && f.z[p] > 0);
    rendered_frame_release(&f);
    return (double)shown / (W * H);
}

/* Novel cameras that are hard for any set of views around (x, y, z). */
static void check_around(const struct view *views, int count, double x, double y, double z, bool offline)
{
    static const double turns[] = {1.0, 1.3, -1.2,
                                   -0.9}; /* the picture spans 56 degrees, so rays are parallel to the mesh */
    struct scene s;
    struct view novel;

    views_make(&s, views, count);
    for (int i = 0; i < count; i++) { /* at an input view */
        assert_true(check_from(&s, &views[i], offline) > 0.99);
    }
    for (int i = 0; i < 6; i++) { /* in the mesh, and beside it in its plane */
        novel = view_at(x + 0.1 * i - 0.2, y + 0.05 * i, z);
        assert_true(check_from(&s, &novel, offline) > 0.5);
    }
    for (int i = 0; i < 8; i++) { /* near the mesh, on both sides */
        novel = view_at(x + 0.05, y - 0.02, z + pow(10, -1 - i / 2) * (i % 2 ? 1 : -1));
        assert_true(check_from(&s, &novel, offline) > 0.6);
    }
    novel = view_at(x - 0.04, y + 0.05, z + 1.5); /* in front */
    assert_true(check_from(&s, &novel, offline) > 0.99);
    novel = view_at(x + 0.04, y + 0.05, z - 1.5); /* behind */
    assert_true(check_from(&s, &novel, offline) > 0.3);
    for (int i = 0; i < 4; i++) {
        novel = turned_view(x + 0.03, y, z, turns[i]);
        check_from(&s, &novel, offline);
        novel = turned_view(x + 0.03, y, z - 0.4, turns[i]);
        check_from(&s, &novel, offline);
    }
    novel = turned_view(x, y, z, M_PI / 2); /* the viewing direction lies in the mesh */
    check_from(&s, &novel, offline);
    novel = turned_view(x, y, z, M_PI); /* looking away from the scene */
    assert_true(check_from(&s, &novel, offline) == 0);
    layer_scene_release(&s.layers);
}

static void a_single_view_is_rendered(void **state)
{
    const struct view views[] = {view_at(0, 0, 0)};
    check_around(views, 1, 0, 0, 0, *(const bool *)*state);
}

static void two_views_are_rendered(void **state)
{
    const struct view views[] = {view_at(-0.3, 0, 0), view_at(0.3, 0.1, 0)};
    check_around(views, 2, 0, 0.05, 0, *(const bool *)*state);
}

static void collinear_centers_are_rendered(void **state)
{
    const struct view views[] = {view_at(-0.6, -0.06, 0), view_at(-0.3, -0.03, 0), view_at(0, 0, 0),
                                 view_at(0.1, 0.01, 0), view_at(0.6, 0.06, 0)};
    check_around(views, 5, 0, 0, 0, *(const bool *)*state);
}

static void a_straight_move_into_the_scene_is_rendered(void **state)
{
    const struct view views[] = {view_at(0, 0, -0.6), view_at(0, 0, -0.3), view_at(0, 0, 0), view_at(0, 0, 0.4)};
    check_around(views, 4, 0, 0, 0, *(const bool *)*state);
}

static void coincident_centers_are_rendered(void **state)
{
    const struct view views[] = {turned_view(0, 0, 0, -0.5), turned_view(0, 0, 0, -0.2), view_at(0, 0, 0),
                                 turned_view(0, 0, 0, 0.3)};
    check_around(views, 4, 0, 0, 0, *(const bool *)*state);
}

static void identical_views_are_rendered(void **state)
{
    const struct view views[] = {view_at(0, 0, 0), view_at(0, 0, 0), view_at(0, 0, 0)};
    check_around(views, 3, 0, 0, 0, *(const bool *)*state);
}

static void a_plane_of_views_is_rendered(void **state)
{
    const struct view views[] = {view_at(-0.3, -0.3, 0), view_at(0, -0.3, 0), view_at(0.3, -0.3, 0),
                                 view_at(-0.3, 0, 0),    view_at(0, 0, 0),    view_at(0.3, 0, 0),
                                 view_at(-0.3, 0.3, 0),  view_at(0, 0.3, 0),  view_at(0.3, 0.3, 0)};
    check_around(views, 9, 0, 0, 0, *(const bool *)*state);
}

static void a_bent_mesh_is_rendered(void **state)
{
    const struct view views[] = {view_at(-0.3, -0.3, 0.1), view_at(0.3, -0.3, -0.1), view_at(0, 0, 0.15),
                                 view_at(-0.3, 0.3, -0.1), view_at(0.3, 0.3, 0.05)};
    check_around(views, 5, 0, 0, 0, *(const bool *)*state);
}

static bool fast = false, offline = true;
#define BOTH(test) \
    {#test " (fast)", test, NULL, NULL, &fast}, { #test " (offline)", test, NULL, NULL, &offline }

int main(void)
{
    const struct CMUnitTest tests[] = {
        BOTH(a_single_view_is_rendered),       BOTH(two_views_are_rendered),
        BOTH(collinear_centers_are_rendered),  BOTH(a_straight_move_into_the_scene_is_rendered),
        BOTH(coincident_centers_are_rendered), BOTH(identical_views_are_rendered),
        BOTH(a_plane_of_views_is_rendered),    BOTH(a_bent_mesh_is_rendered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
