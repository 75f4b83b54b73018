/* visible.c - which faces are seen, against ray tracing and closed forms; cameras in planes, in walls and in solids. */
#include "stages/render_model/visible.h"

#include "tests/unit/box_solids.h"

#include "common/base/parallel.h"
#include "common/light/model_rays.h"

enum { W = 200, H = 150 };

static const struct box furnished[] = {
    ROOM_OUTSIDE,
    ROOM_INSIDE,
    {"box", "box", {-0.5, 1, 0.2}, {0.7, 2, 1.1}, false},
    {"tower", "tower", {-1.6, -1.3, -1}, {-1.1, 2, -0.4}, false},
    {"thin", "thin", {0.2, -2, 0.5}, {1.9, 1.5, 0.51}, false},
};
enum { FURNISHED = sizeof furnished / sizeof *furnished };

struct drawn {
    struct solid_mesh mesh;
    struct visible_model model;
    struct visible seen;
};

static struct drawn draw(const struct box *boxes, int count, const struct view *view)
{
    struct drawn d = {.mesh = make_boxes(boxes, count)};
    struct err err = ERR_INIT;
    assert_ok(visible_model_make(&d.model, &d.mesh, NULL, &err), err);
    d.model.mesh = &d.mesh;
    assert_ok(visible_draw(&d.seen, &d.model, view, &err), err);
    return d;
}

static void drawn_release(struct drawn *d)
{
    visible_release(&d->seen);
    visible_model_release(&d->model);
    solid_mesh_release(&d->mesh);
}

static size_t place(const struct visible *v, int x, int y)
{
    const int tile = y / VISIBLE_TILE * v->columns + x / VISIBLE_TILE;
    return (size_t)tile * VISIBLE_PIXELS + (size_t)(y % VISIBLE_TILE * VISIBLE_TILE + x % VISIBLE_TILE);
}

static uint32_t face_at(const struct visible *v, int x, int y) { return v->face[place(v, x, y)]; }
static double depth_at(const struct visible *v, int x, int y) { return 1 / (double)v->inverse_z[place(v, x, y)]; }

/* Name of the face that a pixel shows; "" for none. */
static const char *name_at(const struct drawn *d, int x, int y)
{
    const uint32_t face = face_at(&d->seen, x, y);
    return face ? solid_face_name(&d->mesh, (int)face - 1) : "";
}

/* The number of pixels whose face differs from the one that rays find, though no neighbour of the pixel shows that
 * face. Depths of equal faces must agree. */
static int wrong_pixels(const struct drawn *d, const struct view *view, int *edges)
{
    struct model_rays rays = {.mesh = d->mesh};
    struct err err = ERR_INIT;
    uint32_t *faces = malloc(sizeof *faces * (size_t)(view->width * view->height));
    int wrong = 0;
    assert_non_null(faces);
    assert_ok(model_rays_build(&rays, MODEL_WITH_GLASS, &err), err);
    model_rays_view(faces, &rays, view);
    *edges = 0;
    for (int y = 1; y < view->height - 1; y++)
        for (int x = 1; x < view->width - 1; x++) {
            const uint32_t traced = faces[y * view->width + x];
            if (traced == face_at(&d->seen, x, y)) {
                if (!traced) continue;
                struct ray_hit hit;
                const struct vec3 p = view_unproject(view, x + 0.5, y + 0.5, 1);
                assert_true(ray_scene_hit(&rays.rays, view->center, vec3_sub(p, view->center), &hit));
                if (hit.id + 1 == traced) assert_true(fabs(depth_at(&d->seen, x, y) - hit.t) <= 2e-6 * hit.t);
                continue;
            }
            bool near = false;
            for (int k = 0; k < 9; k++) near |= face_at(&d->seen, x + k % 3 - 1, y + k / 3 - 1) == traced;
            ++*(near ? edges : &wrong);
        }
    ray_scene_release(&rays.rays);
    free(faces);
    return wrong;
}

static void faces_and_depths_agree_with_ray_tracing(void **state)
{
    (void)state;
    int edges = 0, all = 0;
    for (int i = 0; i < 40; i++) {
        const struct vec3 p = {1.7 * sin(i), 0.9 * cos(2.3 * i), -1.9 + 0.02 * i};
        const struct view view = view_at(p, 0.7 * i + 0.2, 0.3 * sin(1.1 * i + 0.1), W, H, 90);
        struct drawn d = draw(furnished, FURNISHED, &view);
        int found;
        assert_int_equal(wrong_pixels(&d, &view, &found), 0);
        edges += found;
        all += W * H;
        drawn_release(&d);
    }
    print_message("%d of %d pixels, all on edges, have the face of a neighbour\n", edges, all);
    assert_true(edges < all / 5000);
}

/* In a closed room nothing is left open between triangles, whichever way the camera looks. */
static void a_closed_room_has_no_gaps(void **state)
{
    (void)state;
    for (int i = 0; i < 60; i++) {
        const struct view view = view_at(vec3_make(0.01 * i, -0.3, 0.02 * i), 0.1047 * i, 0.02 * i, W, H, 40 + i);
        struct drawn d = draw(furnished, 2, &view);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) assert_int_not_equal(face_at(&d.seen, x, y), 0);
        drawn_release(&d);
    }
}

/* Corners of the room lie on pixel centres: each pixel on an edge is given to one face, by the top-left rule. */
static void pixels_on_an_edge_belong_to_the_face_to_the_right_or_below(void **state)
{
    (void)state;
    /* the wall z = 2 spans 2 / 2 * 32 px about (64.5, 64.5), edges exactly through pixel centres */
    struct view view = view_at(vec3_make(0, 0, 0), 0, 0, 129, 129, 32);
    view.cx = view.cy = 64.5;
    struct drawn d = draw(furnished, 2, &view);
    assert_string_equal(name_at(&d, 32, 64), "in/5"); /* its left edge */
    assert_string_equal(name_at(&d, 96, 64), "in/1"); /* its right edge is the right wall's left one */
    assert_string_equal(name_at(&d, 64, 32), "in/5");
    assert_string_equal(name_at(&d, 64, 96), "in/3");
    drawn_release(&d);
}

static void threads_do_not_change_a_bit(void **state)
{
    (void)state;
    const struct view view = view_at(vec3_make(0.3, 0.1, -1), 0.4, 0.2, W, H, 70);
    parallel_set_threads(1);
    struct drawn a = draw(furnished, FURNISHED, &view);
    parallel_set_threads(5);
    struct drawn b = draw(furnished, FURNISHED, &view);
    parallel_set_threads(0);
    const size_t pixels = (size_t)(a.seen.columns * a.seen.rows) * VISIBLE_PIXELS;
    assert_memory_equal(a.seen.face, b.seen.face, pixels * sizeof *a.seen.face);
    assert_memory_equal(a.seen.inverse_z, b.seen.inverse_z, pixels * sizeof *a.seen.inverse_z);
    drawn_release(&a);
    drawn_release(&b);
}

/* A camera exactly in the plane of the tower's front: the plane is a line, the rest is as rays see it. */
static void a_camera_in_the_plane_of_a_face_sees_what_is_beside_it(void **state)
{
    (void)state;
    const struct view view = view_at(vec3_make(0.9, -1.1, -1), -1.2, 0.1, W, H, 60); /* z = -1 is the tower's side 4 */
    struct drawn d = draw(furnished, FURNISHED, &view);
    int edges;
    assert_int_equal(wrong_pixels(&d, &view, &edges), 0);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) assert_string_not_equal(name_at(&d, x, y), "tower/4");
    drawn_release(&d);
}

static void a_view_exactly_along_a_wall_sees_the_other_walls(void **state)
{
    (void)state;
    /* on the wall x = 2, along +z: the left half shows the room, the right half nothing but what is behind the wall */
    const struct view view = view_at(vec3_make(2, 0.25, -1), 0, 0, 201, 151, 80);
    struct drawn d = draw(furnished, 2, &view);
    assert_string_equal(name_at(&d, 90, 75), "in/5");
    assert_true(fabs(depth_at(&d.seen, 90, 75) - 3) < 1e-6);
    assert_string_equal(name_at(&d, 110, 75), "");
    for (int y = 0; y < 151; y++)
        for (int x = 0; x < 201; x++) assert_string_not_equal(name_at(&d, x, y), "in/1");
    drawn_release(&d);
}

static void a_camera_inside_a_solid_looks_through_it(void **state)
{
    (void)state;
    const struct view view = view_at(vec3_make(0.1, 1.5, 0.6), 0, 0, W, H, 60); /* in the box */
    struct drawn with = draw(furnished, FURNISHED, &view), without = draw(furnished, 2, &view);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            if (strncmp(name_at(&with, x, y), "t", 1)) /* tower, thin */
                assert_string_equal(name_at(&with, x, y), name_at(&without, x, y));
    drawn_release(&with);
    drawn_release(&without);
}

static void faces_that_are_not_drawn_are_looked_through(void **state)
{
    (void)state;
    const struct view view = view_at(vec3_make(0, 1.5, -1), 0, 0, W, H, 60);
    struct solid_mesh mesh = make_boxes(furnished, 3);
    struct visible_model model;
    struct visible seen = {0};
    struct err err = ERR_INIT;
    bool drawn[18];
    for (int i = 0; i < 18; i++) drawn[i] = i < 12;
    assert_ok(visible_model_make(&model, &mesh, drawn, &err), err);
    assert_ok(visible_draw(&seen, &model, &view, &err), err);
    assert_string_equal(solid_face_name(&mesh, (int)face_at(&seen, W / 2, H / 2) - 1), "in/5");
    visible_release(&seen);
    visible_model_release(&model);
    solid_mesh_release(&mesh);
}

static void of_faces_in_one_place_the_first_is_seen(void **state)
{
    (void)state;
    const struct box twice[] = {{"a", "a", {-1, -1, 2}, {1, 1, 3}, false}, {"b", "b", {-1, -1, 2}, {1, 1, 3}, false}};
    const struct view view = view_at(vec3_make(0, 0, 0), 0.1, 0.05, W, H, 60);
    struct drawn d = draw(twice, 2, &view);
    int shown = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            assert_string_not_equal(name_at(&d, x, y), "b/4");
            shown += !strcmp(name_at(&d, x, y), "a/4");
        }
    assert_true(shown > 1000);
    drawn_release(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_and_depths_agree_with_ray_tracing),
        cmocka_unit_test(a_closed_room_has_no_gaps),
        cmocka_unit_test(pixels_on_an_edge_belong_to_the_face_to_the_right_or_below),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(a_camera_in_the_plane_of_a_face_sees_what_is_beside_it),
        cmocka_unit_test(a_view_exactly_along_a_wall_sees_the_other_walls),
        cmocka_unit_test(a_camera_inside_a_solid_looks_through_it),
        cmocka_unit_test(faces_that_are_not_drawn_are_looked_through),
        cmocka_unit_test(of_faces_in_one_place_the_first_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
