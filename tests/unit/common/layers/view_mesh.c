/* view_mesh.c - blending weights of cameras at a view, between views, in front of and behind them, and degenerate
 * sets. */
#include "common/layers/view_mesh.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "common/base/rng.h"

enum { W = 64, H = 48, MAX_VIEWS = 64 };

struct fixture {
    struct view views[MAX_VIEWS];
    struct camera_set set;
    struct view_mesh mesh;
};

/* A camera at `center` looking at `target`, y down. */
static struct view look(struct vec3 center, struct vec3 target)
{
    struct view v = {.name = "v", .width = W, .height = H, .fx = W, .fy = W, .cx = W / 2.0, .cy = H / 2.0};
    struct vec3 z = vec3_normalize(vec3_sub(target, center));
    struct vec3 down = fabs(z.y) < 0.9 ? vec3_make(0, 1, 0) : vec3_make(0, 0, 1);
    struct vec3 x = vec3_normalize(vec3_cross(down, z)), y = vec3_cross(z, x);
    v.cam_from_world = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    v.center = center;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, center), -1);
    return v;
}

static void add(struct fixture *f, double x, double y, double z)
{
    f->views[f->set.view_count++] = look(vec3_make(x, y, z), vec3_make(x, y, z + 1));
    f->set.views = f->views;
}

static void build(struct fixture *f)
{
    struct err err = ERR_INIT;
    assert_int_equal(view_mesh_build(&f->mesh, &f->set, &err), ST_OK);
}

/* Checks that every pixel's weights are finite, >= 0, sum to 1, and are sorted by view. mean: mean weight of each
 * view. */
static void mean_weights(const struct fixture *f, const struct view *novel, double mean[MAX_VIEWS])
{
    struct view_mesh_camera mc;
    struct view_weights *row = calloc((size_t)novel->width, sizeof *row);
    assert_non_null(row);
    memset(mean, 0, MAX_VIEWS * sizeof *mean);
    view_mesh_prepare(&mc, &f->mesh, novel);
    assert_true(mc.fade >= 0 && mc.fade <= 1 && isfinite(mc.height));
    for (int y = 0; y < novel->height; y++) {
        view_mesh_row(&mc, y, row);
        for (int x = 0; x < novel->width; x++) {
            double sum = 0;
            assert_in_range(row[x].count, 1, VIEW_WEIGHTS_MAX);
            for (int k = 0; k < row[x].count; k++) {
                assert_true(row[x].view[k] >= 0 && row[x].view[k] < f->set.view_count);
                if (k) assert_true(row[x].view[k] > row[x].view[k - 1]);
                assert_true(isfinite(row[x].weight[k]) && row[x].weight[k] >= 0);
                sum += (double)row[x].weight[k];
                mean[row[x].view[k]] += (double)row[x].weight[k] / (novel->width * novel->height);
            }
            assert_float_equal(sum, 1, 1e-5);
        }
    }
    free(row);
}

static double weight_of(const struct view_weights *w, int view)
{
    double sum = 0;
    for (int k = 0; k < w->count; k++)
        if (w->view[k] == view) sum += (double)w->weight[k];
    return sum;
}

static double pixel_weight(const struct fixture *f, const struct view *novel, int x, int y, int view)
{
    struct view_mesh_camera mc;
    struct view_weights row[W];
    view_mesh_prepare(&mc, &f->mesh, novel);
    view_mesh_row(&mc, y, row);
    return weight_of(&row[x], view);
}

/* Moving the camera by a millionth of the spacing must not change the mean weights by more than `slope` times that. */
static void check_continuous(const struct fixture *f, struct vec3 center, struct vec3 target, double slope)
{
    double a[MAX_VIEWS], b[MAX_VIEWS], eps = 1e-5;
    double scale = f->mesh.spacing > 0 ? f->mesh.spacing : 1;
    const struct vec3 ways[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0.6, 0.5, 0.7}};
    struct view novel = look(center, target);
    mean_weights(f, &novel, a);
    for (int i = 0; i < 4; i++) {
        novel = look(vec3_add(center, vec3_scale(ways[i], eps * scale)), target);
        mean_weights(f, &novel, b);
        for (int v = 0; v < f->set.view_count; v++) {
            if (!(fabs(a[v] - b[v]) <= slope * eps + 2e-6))
                print_error("view %d: %g to %g at %g %g %g, way %d\n", v, a[v], b[v], center.x, center.y, center.z, i);
            assert_true(fabs(a[v] - b[v]) <= slope * eps + 2e-6);
        }
    }
}

/* Cameras in, near, behind, in front of and beside the mesh, looking at the scene, along the mesh and away. */
static void check_everywhere(const struct fixture *f, double slope)
{
    struct rng rng = rng_make(7, "test", "view_mesh");
    double size = 0, mean[MAX_VIEWS];
    for (int i = 0; i < f->set.view_count; i++)
        size = fmax(size, vec3_length(vec3_sub(f->views[i].center, f->mesh.centroid)));
    if (size == 0) size = 1;
    for (uint64_t i = 0; i < 60; i++) {
        double r[6];
        for (uint64_t k = 0; k < 6; k++) r[k] = 2 * rng_uniform(&rng, i, k) - 1;
        double depth = i % 5 == 0 ? 0 : i % 5 == 1 ? 1e-3 * r[2] : i % 5 == 2 ? -2 * fabs(r[2]) : 2 * r[2];
        struct vec3 at = f->mesh.centroid;
        at = vec3_add(at, vec3_scale(f->mesh.axis_x, 1.5 * size * r[0]));
        at = vec3_add(at, vec3_scale(f->mesh.axis_y, 1.5 * size * r[1]));
        at = vec3_add(at, vec3_scale(f->mesh.normal, size * depth));
        struct vec3 ahead =
            vec3_add(vec3_scale(f->mesh.normal, 8 * size), vec3_make(size * r[3], size * r[4], size * r[5]));
        check_continuous(f, at, vec3_add(at, ahead), slope);
        struct vec3 along = vec3_add(vec3_scale(f->mesh.axis_x, r[3]), vec3_scale(f->mesh.axis_y, r[4]));
        struct view novel = look(at, vec3_add(at, along)); /* rays parallel to the mesh */
        mean_weights(f, &novel, mean);
        novel = look(at, vec3_sub(at, ahead));
        mean_weights(f, &novel, mean);
    }
}

static void check_vertices(const struct fixture *f)
{
    for (int i = 0; i < f->set.view_count; i++) {
        double mean[MAX_VIEWS];
        mean_weights(f, &f->views[i], mean);
        assert_float_equal(mean[i], 1, 1e-4);
    }
}

static void grid(struct fixture *f, int columns, int rows, double bump)
{
    for (int i = 0; i < columns * rows; i++) {
        double x = i % columns, y = i / columns;
        add(f, x, y, bump * sin(2.3 * x + 1.1 * y));
    }
}

static void a_single_view_has_weight_one(void **state)
{
    (void)state;
    struct fixture f = {0};
    add(&f, 1, 2, 3);
    build(&f);
    assert_int_equal(f.mesh.rank, 0);
    assert_int_equal(f.mesh.triangle_count, 0);
    check_vertices(&f);
    check_everywhere(&f, 1);
    view_mesh_release(&f.mesh);
}

static void weights_of_two_views_are_linear_between_them(void **state)
{
    (void)state;
    struct fixture f = {0};
    add(&f, 0, 0, 0);
    add(&f, 2, 0, 0);
    build(&f);
    assert_int_equal(f.mesh.rank, 1);
    assert_float_equal(f.mesh.spacing, 2, 1e-12);
    check_vertices(&f);
    double mean[MAX_VIEWS];
    struct view novel = look(vec3_make(0.5, 0, 0), vec3_make(0.5, 0, 1));
    mean_weights(&f, &novel, mean); /* on the line: linear in the position */
    assert_float_equal(mean[0], 0.75, 1e-5);
    check_everywhere(&f, 12);
    view_mesh_release(&f.mesh);
}

static void collinear_centers_work(void **state)
{
    (void)state;
    struct fixture f = {0};
    for (int i = 0; i < 7; i++) add(&f, 0.5 * i * i, 0.1 * i * i, 3); /* a dolly rail */
    build(&f);
    assert_int_equal(f.mesh.rank, 1);
    check_vertices(&f);
    check_everywhere(&f, 30);
    view_mesh_release(&f.mesh);
}

static void rail_weights_follow_the_position_along_it(void **state)
{
    (void)state;
    struct fixture f = {0};
    for (int i = 0; i < 5; i++) add(&f, i, 0, 0);
    build(&f);
    struct view novel = look(vec3_make(2, 0, -4), vec3_make(2, 0, 1)); /* a pixel is 4 / 64 wide at the rail */
    for (int y = 0; y < H; y += 7)
        for (int x = 0; x < W; x++) {
            double at = 2 + 4 * (x + 0.5 - W / 2) / W;
            for (int v = 1; v < 4; v++)
                assert_float_equal(pixel_weight(&f, &novel, x, y, v), fmax(0, 1 - fabs(at - v)), 1e-5);
        }
    view_mesh_release(&f.mesh);
}

static void a_straight_move_into_the_scene_works(void **state)
{
    (void)state;
    struct fixture f = {0};
    for (int i = 0; i < 5; i++) add(&f, 0, 0, i);
    build(&f);
    assert_int_equal(f.mesh.rank, 1);
    check_vertices(&f);
    double mean[MAX_VIEWS];
    struct view novel = look(vec3_make(0, 0, 2.25), vec3_make(0, 0, 9));
    mean_weights(&f, &novel, mean);
    assert_float_equal(mean[2], 0.75, 1e-5);
    assert_float_equal(mean[3], 0.25, 1e-5);
    check_everywhere(&f, 30);
    view_mesh_release(&f.mesh);
}

static void coincident_centers_work(void **state)
{
    (void)state;
    struct fixture f = {0};
    for (int i = 0; i < 9; i++) { /* a tripod: the camera turns */
        double angle = 0.3 * (i - 4);
        f.views[i] = look(vec3_make(1, 1, 1), vec3_make(1 + sin(angle), 1, 1 + cos(angle)));
    }
    f.set = (struct camera_set){.views = f.views, .view_count = 9};
    build(&f);
    assert_int_equal(f.mesh.rank, 0);
    assert_true(f.mesh.spacing == 0);
    for (int i = 0; i < 9; i++) { /* in the middle of its picture each view has the greatest weight */
        double best = pixel_weight(&f, &f.views[i], W / 2, H / 2, i);
        for (int j = 0; j < 9; j++)
            if (j != i) assert_true(best > 1.5 * pixel_weight(&f, &f.views[i], W / 2, H / 2, j));
    }
    double mean[MAX_VIEWS];
    mean_weights(&f, &f.views[0], mean);
    assert_true(mean[8] < 0.01); /* looks elsewhere */
    check_everywhere(&f, 20);
    view_mesh_release(&f.mesh);
}

static void identical_views_work(void **state)
{
    (void)state;
    struct fixture f = {0};
    for (int i = 0; i < 6; i++) add(&f, 0, 0, 0);
    build(&f);
    check_everywhere(&f, 20);
    view_mesh_release(&f.mesh);
}

static void photos_split_into_several_views_work(void **state)
{
    (void)state;
    struct fixture f = {0};
    for (int i = 0; i < 12; i++) { /* four wide photos in rows of two, three views each */
        int photo = i / 3;
        double angle = 0.8 * (i % 3 - 1);
        struct vec3 c = vec3_make(photo % 2, photo / 2, 0);
        f.views[i] = look(c, vec3_add(c, vec3_make(sin(angle), 0, cos(angle))));
    }
    f.set = (struct camera_set){.views = f.views, .view_count = 12};
    build(&f);
    assert_int_equal(f.mesh.rank, 2);
    assert_true(f.mesh.shared);
    double mean[MAX_VIEWS];
    for (int i = 0; i < 12; i++) {
        mean_weights(&f, &f.views[i], mean); /* only that photo's views, mostly the one that looks there */
        int first = i / 3 * 3;
        assert_float_equal(mean[first] + mean[first + 1] + mean[first + 2], 1, 1e-4);
        assert_true(mean[i] > 0.6);
    }
    check_everywhere(&f, 40);
    view_mesh_release(&f.mesh);
}

static void a_plane_of_views_works(void **state)
{
    (void)state;
    struct fixture f = {0};
    grid(&f, 4, 3, 0);
    build(&f);
    assert_int_equal(f.mesh.rank, 2);
    assert_float_equal(f.mesh.spacing, 1, 1e-9);
    assert_float_equal(f.mesh.normal.z, 1, 1e-9);
    struct vec3 turned = vec3_cross(f.mesh.axis_x, f.mesh.axis_y);
    assert_float_equal(vec3_dot(turned, f.mesh.normal), 1, 1e-9);
    check_vertices(&f);
    check_everywhere(&f, 30);
    view_mesh_release(&f.mesh);
}

static void a_bent_mesh_works(void **state)
{
    (void)state;
    struct fixture f = {0};
    grid(&f, 5, 4, 0.3);
    build(&f);
    check_vertices(&f);
    check_everywhere(&f, 60);
    view_mesh_release(&f.mesh);
}

static void the_mesh_of_an_orbit_faces_the_scene(void **state)
{
    (void)state;
    struct fixture f = {0};
    for (int i = 0; i < 10; i++) { /* 150 degrees around a statue at the origin */
        double angle = (i - 4.5) * 15 * M_PI / 180;
        f.views[i] = look(vec3_make(sin(angle), 0.05 * (i % 3), -cos(angle)), vec3_make(0, 0, 0));
    }
    f.set = (struct camera_set){.views = f.views, .view_count = 10};
    build(&f);
    assert_true(f.mesh.normal.z > 0.95);
    check_vertices(&f);
    check_everywhere(&f, 100);
    view_mesh_release(&f.mesh);
}

static void a_wide_and_low_set_of_views_works(void **state)
{
    (void)state;
    struct fixture f = {0};
    for (int i = 0; i < 11; i++) add(&f, i, 0.6 * sin(2.0 * i), 0.1 * cos(3.0 * i));
    build(&f);
    assert_int_equal(f.mesh.rank, 2);
    check_vertices(&f);
    check_everywhere(&f, 60);
    view_mesh_release(&f.mesh);
}

static void weights_in_front_and_behind_are_as_computed_by_hand(void **state)
{
    (void)state;
    struct fixture f = {0};
    add(&f, 0, 0, 0);
    add(&f, 3, 0, 0);
    add(&f, 0, 3, 0);
    build(&f);
    struct vec3 centroid = f.mesh.centroid;
    /* all three views where the ray meets the centroid, from both sides */
    for (int side = -1; side <= 1; side += 2) {
        struct view novel = look(vec3_make(centroid.x, centroid.y, 2.5 * side), vec3_make(centroid.x, centroid.y, 20));
        novel.cx += 0.5; /* the pixel's centre on the axis */
        novel.cy += 0.5;
        for (int v = 0; v < 3; v++) assert_float_equal(pixel_weight(&f, &novel, W / 2, H / 2, v), 1 / 3.0, 1e-5);
        /* behind the mesh, a ray to the right crosses it on the right; in front, it comes from the left */
        double right = pixel_weight(&f, &novel, W / 2 + 10, H / 2, 1);
        assert_true(side < 0 ? right > 0.4 : right < 0.3);
    }
    view_mesh_release(&f.mesh);
}

static void crossing_the_mesh_is_smooth(void **state)
{
    (void)state;
    struct fixture f = {0};
    grid(&f, 4, 4, 0.1);
    build(&f);
    double last[MAX_VIEWS], mean[MAX_VIEWS];
    for (int i = 0; i <= 400; i++) {
        struct view novel = look(vec3_make(1.3, 1.7, -1 + i / 200.0), vec3_make(1.5, 1.5, 10));
        mean_weights(&f, &novel, mean);
        for (int v = 0; v < f.set.view_count && i; v++) assert_true(fabs(mean[v] - last[v]) < 0.01);
        memcpy(last, mean, sizeof last);
    }
    view_mesh_release(&f.mesh);
}

static void neighbouring_pixels_have_similar_weights(void **state)
{
    (void)state;
    struct fixture f = {0};
    struct view_weights *row = calloc(640, sizeof *row);
    assert_non_null(row);
    grid(&f, 4, 4, 0);
    build(&f);
    for (int i = 0; i < 12; i++) {
        struct view novel = look(vec3_make(1.2 + 0.3 * i, 1.4, -3 + 0.45 * i), vec3_make(1.5, 1.5, 10));
        novel.width = 640, novel.fx = novel.fy = 640, novel.cx = 320;
        struct view_mesh_camera mc;
        view_mesh_prepare(&mc, &f.mesh, &novel);
        view_mesh_row(&mc, 20, row);
        for (int x = 1; x < 640; x++)
            for (int v = 0; v < 16; v++) assert_true(fabs(weight_of(&row[x], v) - weight_of(&row[x - 1], v)) < 0.05);
    }
    free(row);
    view_mesh_release(&f.mesh);
}

static void rows_may_be_wider_than_a_chunk(void **state)
{
    (void)state;
    struct fixture f = {0};
    grid(&f, 4, 4, 0.1);
    build(&f);
    enum { WIDE = 5000 };
    struct view_weights *row = calloc(WIDE, sizeof *row);
    assert_non_null(row);
    struct view novel = look(vec3_make(1.3, 1.4, -3), vec3_make(1.5, 1.5, 10));
    novel.width = WIDE, novel.fx = WIDE, novel.cx = WIDE / 2.0;
    struct view_mesh_camera mc;
    view_mesh_prepare(&mc, &f.mesh, &novel);
    view_mesh_row(&mc, 7, row);
    for (int x = 1; x < WIDE; x++)
        for (int v = 0; v < 16; v++) assert_true(fabs(weight_of(&row[x], v) - weight_of(&row[x - 1], v)) < 0.01);
    free(row);
    view_mesh_release(&f.mesh);
}

static void no_views_is_an_error(void **state)
{
    (void)state;
    struct fixture f = {0};
    struct err err = ERR_INIT;
    assert_int_equal(view_mesh_build(&f.mesh, &f.set, &err), ST_DATA);
    view_mesh_release(&f.mesh);
    view_mesh_release(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_single_view_has_weight_one),
        cmocka_unit_test(weights_of_two_views_are_linear_between_them),
        cmocka_unit_test(collinear_centers_work),
        cmocka_unit_test(rail_weights_follow_the_position_along_it),
        cmocka_unit_test(a_straight_move_into_the_scene_works),
        cmocka_unit_test(coincident_centers_work),
        cmocka_unit_test(identical_views_work),
        cmocka_unit_test(photos_split_into_several_views_work),
        cmocka_unit_test(a_plane_of_views_works),
        cmocka_unit_test(a_bent_mesh_works),
        cmocka_unit_test(the_mesh_of_an_orbit_faces_the_scene),
        cmocka_unit_test(a_wide_and_low_set_of_views_works),
        cmocka_unit_test(weights_in_front_and_behind_are_as_computed_by_hand),
        cmocka_unit_test(crossing_the_mesh_is_smooth),
        cmocka_unit_test(neighbouring_pixels_have_similar_weights),
        cmocka_unit_test(rows_may_be_wider_than_a_chunk),
        cmocka_unit_test(no_views_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
