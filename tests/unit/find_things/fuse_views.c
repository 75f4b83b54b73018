/* Fusion of views of a room with a cube in it, whose depth is exact. */
#include "stages/find_things/fuse_views.h"

#include <math.h>

#include "common/base/parallel.h"
#include "tests/unit/box_solids.h"

enum { W = 160, H = 120, PIXELS = W * H, NX = 80, NY = 80, NZ = 100, VIEWS = 5 };
enum { WALL = 1, CUBE = 2, WALL_ID = 1, PANE_ID = 2, IDS = 3 };

#define VOXEL 0.05

static const struct voxel_grid grid = {{-2, -2, -1}, VOXEL, {NX, NY, NZ}};
static const struct vec3 room[2] = {{-2, -2, -1}, {2, 2, 4}}, cube[2] = {{-0.5, -0.5, 1.5}, {0.5, 0.5, 2.5}};
static const bool is_pane[IDS] = {[PANE_ID] = true};

/* Where a ray enters and leaves a box; false: it misses the box. */
static bool cross(const struct vec3 box[2], struct vec3 from, struct vec3 along, double *enter, double *leave)
{
    *enter = -INFINITY;
    *leave = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double a = (vec3_axis(box[0], k) - vec3_axis(from, k)) / vec3_axis(along, k),
                     b = (vec3_axis(box[1], k) - vec3_axis(from, k)) / vec3_axis(along, k);
        *enter = fmax(*enter, fmin(a, b));
        *leave = fmin(*leave, fmax(a, b));
    }
    return *enter < *leave;
}

struct scene {
    struct view camera;
    struct layered_depth depth;
    struct view_ids ids;
};

/* A view of the room, with the cube or without. */
static void scene_make(struct scene *s, struct view camera, bool with_cube)
{
    struct err err = ERR_INIT;
    *s = (struct scene){.camera = camera};
    assert_ok(layered_depth_init(&s->depth, W, H, &err), err);
    assert_ok(view_ids_init(&s->ids, W, H, &err), err);
    s->depth.segments = calloc(2, sizeof *s->depth.segments);
    s->depth.segment_count = 2;
    for (int k = 0; k < 2; k++)
        s->depth.segments[k] = (struct depth_segment){.id = (uint32_t)k + 1, .sigma = 0.01, .confidence = 1};
    for (int i = 0; i < PIXELS; i++) {
        const struct vec3 along = vec3_sub(view_unproject(&camera, i % W + 0.5, (int)(i / W) + 0.5, 1), camera.center);
        double enter, leave, far;
        assert_true(cross(room, camera.center, along, &enter, &far));
        const bool hit = cross(cube, camera.center, along, &enter, &leave) && with_cube;
        s->ids.id[i] = WALL_ID;
        s->ids.z[i] = (float)far;
        s->ids.clutter[i] = hit;
        s->depth.interior.id[i] = hit ? CUBE : WALL;
        s->depth.interior.z[i] = (float)(hit ? enter : far);
    }
}

static void scene_release(struct scene *s)
{
    layered_depth_release(&s->depth);
    view_ids_release(&s->ids);
}

static struct view camera_of(int i)
{
    static const struct vec3 centers[VIEWS] = {
        {0, 0, -0.8}, {-0.9, 0.1, -0.5}, {1, 0, -0.5}, {0.1, -0.9, -0.6}, {0, 0.8, -0.4}};
    static const double turns[VIEWS] = {0, 0.25, -0.3, 0, 0.05}, nods[VIEWS] = {0, 0.02, 0, 0.2, 0};
    struct view v = view_at(centers[i], turns[i], nods[i], W, H, 130);
    v.cx += 3;
    return v;
}

static void add(struct fused_volume *f, const struct scene *s, double scale)
{
    const struct fused_view view = {s->camera, &s->depth, &s->ids, is_pane, IDS, scale};
    struct err err = ERR_INIT;
    assert_ok(fuse_volume_add(f, &view, &err), err);
}

static void start(struct fused_volume *f)
{
    struct err err = ERR_INIT;
    assert_ok(fuse_volume_init(f, &grid, &err), err);
}

static void fuse_room(struct fused_volume *f)
{
    start(f);
    for (int i = 0; i < VIEWS; i++) {
        struct scene s;
        scene_make(&s, camera_of(i), true);
        add(f, &s, 1);
        scene_release(&s);
    }
}

static size_t at(int x, int y, int z) { return (size_t)((z * NY + y) * NX + x); }

/* Where the distance of a column along z changes from before to behind, first; NAN: nowhere. */
static double crossing(const struct fused_volume *f, int x, int y)
{
    for (int z = 0; z + 1 < NZ; z++) {
        const size_t i = at(x, y, z), k = at(x, y, z + 1);
        if (!(f->weight[i] > 0) || !(f->weight[k] > 0) || !(f->sum[i] >= 0) || f->sum[k] >= 0) continue;
        const double a = (double)f->sum[i] / (double)f->weight[i], b = (double)f->sum[k] / (double)f->weight[k];
        return thing_voxel_centre(&grid, (int64_t)i).z + VOXEL * a / (a - b);
    }
    return NAN;
}

static void the_surface_is_within_a_voxel_of_the_face(void **state)
{
    (void)state;
    struct fused_volume f;
    int columns = 0;
    fuse_room(&f);
    for (int y = 0; y < NY; y++)
        for (int x = 0; x < NX; x++) {
            const struct vec3 c = thing_voxel_centre(&grid, (int64_t)at(x, y, 0));
            if (fabs(c.x) > 0.44 || fabs(c.y) > 0.44) continue;
            const double z = crossing(&f, x, y);
            if (!(fabs(z - cube[0].z) < VOXEL))
                fail_msg("at %g %g the surface is at %g, wanted %g", c.x, c.y, z, cube[0].z);
            columns++;
        }
    assert_int_equal(columns, 18 * 18);
    fuse_volume_release(&f);
    assert_null(f.sum);
    assert_null(f.weight);
    assert_null(f.views);
}

/* The number of views whose picture holds a point. */
static int views_of(struct vec3 p)
{
    int views = 0;
    for (int i = 0; i < VIEWS; i++) {
        const struct view camera = camera_of(i);
        double u, v;
        views += view_project(&camera, p, &u, &v) > 0 && u > 0 && v > 0 && u < W && v < H;
    }
    return views;
}

static void voxels_before_the_face_are_free(void **state)
{
    (void)state;
    struct fused_volume f;
    int64_t voxels = 0;
    fuse_room(&f);
    for (int64_t i = 0; i < (int64_t)voxel_count(&grid); i++) {
        const struct vec3 c = thing_voxel_centre(&grid, i);
        if (fabs(c.x) > 0.4 || fabs(c.y) > 0.4 || c.z < 0.5 || c.z > 1.5 - 4 * VOXEL) continue;
        assert_true(f.weight[i] == (float)views_of(c) && f.weight[i] > 0);
        assert_true(f.sum[i] == f.weight[i]); /* each view says 1 */
        assert_int_equal(f.views[i], 0);
        voxels++;
    }
    assert_true(voxels > 16 * 16 * 15);
    fuse_volume_release(&f);
}

static void voxels_behind_the_face_are_unseen(void **state)
{
    (void)state;
    struct fused_volume f;
    int64_t voxels = 0;
    fuse_room(&f);
    for (int64_t i = 0; i < (int64_t)voxel_count(&grid); i++) {
        const struct vec3 c = thing_voxel_centre(&grid, i);
        /* farther behind than the band, 2.5 voxels, along every camera's axis */
        if (fabs(c.x) > 0.25 || fabs(c.y) > 0.25 || c.z < 1.5 + 4 * VOXEL || c.z > 2.5) continue;
        assert_true(f.weight[i] == 0 && f.sum[i] == 0 && f.views[i] == 0);
        voxels++;
    }
    assert_true(voxels >= 10 * 10 * 16);
    fuse_volume_release(&f);
}

static void the_views_that_show_the_face_are_counted(void **state)
{
    (void)state;
    struct fused_volume f;
    fuse_room(&f);
    const size_t behind = at(NX / 2, NY / 2, 50), before = at(NX / 2, NY / 2, 49); /* centres at 1.525 and 1.475 */
    assert_int_equal(f.views[behind], VIEWS);
    assert_int_equal(f.views[before], VIEWS);
    assert_true(f.sum[behind] < 0 && f.sum[before] > 0);
    assert_float_equal(f.weight[behind], VIEWS, 1e-5);
    const size_t wall = at(NX / 2, 5, NZ - 1); /* before the far wall, which is part of the model */
    assert_true(f.weight[wall] > 0);
    assert_int_equal(f.views[wall], 0);
    fuse_volume_release(&f);
}

static void a_view_says_nothing_of_what_it_does_not_hold(void **state)
{
    (void)state;
    struct fused_volume f;
    struct scene s;
    start(&f);
    scene_make(&s, camera_of(2), true);
    add(&f, &s, 1);
    for (int64_t i = 0; i < (int64_t)voxel_count(&grid); i++) {
        const struct vec3 c = thing_voxel_centre(&grid, i);
        double u, v;
        const double z = view_project(&s.camera, c, &u, &v);
        const bool outside = z <= 0 || u < -1e-6 || v < -1e-6 || u > W + 1e-6 || v > H + 1e-6;
        const bool inside = z > VOXEL && u > 1e-6 && v > 1e-6 && u < W - 1e-6 && v < H - 1e-6;
        if (outside) assert_true(f.weight[i] == 0);
        if (!inside) continue;
        const double depth = (double)s.depth.interior.z[(int)v * W + (int)u];
        const double away = (depth - z) / (2.5 * VOXEL); /* of all segments, 0.0039 z is less */
        if (away < -1.0001)
            assert_true(f.weight[i] == 0);
        else if (away > -0.9999)
            assert_true(f.weight[i] == 1 && fabs((double)f.sum[i] - fmin(1, away)) < 1e-4);
    }
    scene_release(&s);
    fuse_volume_release(&f);
}

/* Axes of the model in the length unit of the scene: the volume depends on neither. */
static void depth_is_scaled_to_the_model(void **state)
{
    (void)state;
    struct fused_volume f, g;
    struct scene s;
    start(&f);
    start(&g);
    scene_make(&s, camera_of(1), true);
    add(&f, &s, 1);
    for (int i = 0; i < PIXELS; i++) {
        s.ids.z[i] /= 4;
        s.depth.interior.z[i] /= 4;
    }
    add(&g, &s, 4);
    assert_memory_equal(f.sum, g.sum, voxel_count(&grid) * sizeof *f.sum);
    assert_memory_equal(f.views, g.views, voxel_count(&grid));
    scene_release(&s);
    fuse_volume_release(&f);
    fuse_volume_release(&g);
}

/* ---------------------------------------------------------------------------------------------- what is not a thing */

/* The number of voxels of which the front view says that a thing is there, where all of the far wall is called clutter
 * of depth `nearer`, a share of its own, before it. */
struct wall {
    double nearer, sigma, confidence;
    float clutter;
    uint32_t id;
};

static int64_t voxels_of_things(const struct wall *w)
{
    struct fused_volume f;
    struct scene s;
    int64_t voxels = 0;
    start(&f);
    scene_make(&s, camera_of(0), false);
    s.depth.segments[WALL - 1].sigma = w->sigma;
    s.depth.segments[WALL - 1].confidence = w->confidence;
    for (int i = 0; i < PIXELS; i++) {
        s.ids.id[i] = w->id;
        s.ids.clutter[i] = w->clutter;
        s.depth.interior.z[i] = (float)((1 - w->nearer) * (double)s.ids.z[i]);
    }
    add(&f, &s, 1);
    for (size_t i = 0; i < voxel_count(&grid); i++) voxels += f.views[i] > 0;
    scene_release(&s);
    fuse_volume_release(&f);
    return voxels;
}

static void noise_of_a_wall_within_its_uncertainty_is_no_thing(void **state)
{
    (void)state;
    /* 0.02 and 1.5 times 0.39 sigma, which is 0.049 */
    assert_int_equal(voxels_of_things(&(struct wall){0.015, 0.001, 1, 1, WALL_ID}), 0);
    assert_int_equal(voxels_of_things(&(struct wall){0.047, 0.05, 1, 1, WALL_ID}), 0);
    assert_int_equal(voxels_of_things(&(struct wall){-0.2, 0.05, 1, 1, WALL_ID}), 0);
    assert_true(voxels_of_things(&(struct wall){0.051, 0.05, 1, 1, WALL_ID}) > 100);
    assert_true(voxels_of_things(&(struct wall){0.025, 0.001, 1, 1, WALL_ID}) > 100);
}

static void what_is_hardly_graded_as_clutter_is_no_thing(void **state)
{
    (void)state;
    assert_int_equal(voxels_of_things(&(struct wall){0.3, 0.01, 1, CLUTTER_UNSURE, WALL_ID}), 0);
    assert_true(voxels_of_things(&(struct wall){0.3, 0.01, 1, 0.7f, WALL_ID}) > 100);
}

static void a_pane_of_slightly_nearer_depth_is_no_thing(void **state)
{
    (void)state;
    /* 0.08 and 1.5 times 0.39 sigma, which is 0.086 */
    assert_int_equal(voxels_of_things(&(struct wall){0.084, 0.01, 1, 1, PANE_ID}), 0);
    assert_true(voxels_of_things(&(struct wall){0.084, 0.01, 1, 1, WALL_ID}) > 100);
    assert_true(voxels_of_things(&(struct wall){0.09, 0.01, 1, 1, PANE_ID}) > 100);
    /* unless the depth is sure */
    assert_int_equal(voxels_of_things(&(struct wall){0.3, 0.01, 0.49, 1, PANE_ID}), 0);
    assert_true(voxels_of_things(&(struct wall){0.3, 0.01, 0.49, 1, WALL_ID}) > 100);
    /* ids that the model does not have are no panes */
    assert_true(voxels_of_things(&(struct wall){0.084, 0.01, 1, 1, IDS + 4}) > 100);
}

/* The wall's own depth is taken where no thing stands before it. */
static void a_bare_wall_is_where_the_model_has_it(void **state)
{
    (void)state;
    struct fused_volume exact, noisy;
    struct scene s;
    start(&exact);
    start(&noisy);
    scene_make(&s, camera_of(0), false);
    s.depth.segments[WALL - 1].sigma = 0.05;
    add(&exact, &s, 1);
    for (int i = 0; i < PIXELS; i++) {
        s.ids.clutter[i] = 1;
        s.depth.interior.z[i] *= 1 - 0.047f * (float)(i * 7 % 11) / 11;
    }
    add(&noisy, &s, 1);
    assert_memory_equal(exact.sum, noisy.sum, voxel_count(&grid) * sizeof *exact.sum);
    scene_release(&s);
    fuse_volume_release(&exact);
    fuse_volume_release(&noisy);
}

static void pixels_without_depth_or_model_say_nothing(void **state)
{
    (void)state;
    for (int what = 0; what < 3; what++) {
        struct fused_volume f;
        struct scene s;
        start(&f);
        scene_make(&s, camera_of(0), true);
        for (int i = 0; i < PIXELS; i++) {
            if (what == 0) s.depth.interior.id[i] = 0;
            if (what == 1) s.depth.interior.z[i] = 0;
            if (what == 2) s.ids.z[i] = 0;
        }
        add(&f, &s, 1);
        for (size_t i = 0; i < voxel_count(&grid); i++) assert_true(f.weight[i] == 0 && f.views[i] == 0);
        scene_release(&s);
        fuse_volume_release(&f);
    }
}

static float weight_at_face(double sigma, double confidence)
{
    struct fused_volume f;
    struct scene s;
    start(&f);
    scene_make(&s, camera_of(0), true);
    s.depth.segments[CUBE - 1].sigma = sigma;
    s.depth.segments[CUBE - 1].confidence = confidence;
    add(&f, &s, 1);
    const float weight = f.weight[at(NX / 2, NY / 2, 49)];
    scene_release(&s);
    fuse_volume_release(&f);
    return weight;
}

static void doubtful_depth_weighs_less(void **state)
{
    (void)state;
    assert_float_equal(weight_at_face(0.01, 1), 1, 1e-6);
    assert_float_equal(weight_at_face(0.01, 0.5), 1, 1e-6);
    assert_float_equal(weight_at_face(0.01, 0.3), 0.65, 1e-6);
    assert_float_equal(weight_at_face(0.01, 0.05), 0.3, 1e-6);
    assert_float_equal(weight_at_face(0.08 / 0.39, 1), 0.5, 1e-6); /* twice as unsure as what weighs 1 */
}

/* A view that looks through a voxel counts against those that see a surface there. */
static void a_wrong_surface_is_outvoted(void **state)
{
    (void)state;
    struct fused_volume f;
    struct scene s;
    start(&f);
    const size_t inside = at(NX / 2, NY / 2, 50);
    scene_make(&s, camera_of(0), true);
    add(&f, &s, 1);
    scene_release(&s);
    assert_true(f.sum[inside] < 0);
    scene_make(&s, camera_of(1), false);
    add(&f, &s, 1);
    scene_release(&s);
    assert_true(f.sum[inside] > 0);
    assert_int_equal(f.views[inside], 1);
    fuse_volume_release(&f);
}

static void other_sizes_are_refused(void **state)
{
    (void)state;
    struct fused_volume f;
    struct scene s;
    start(&f);
    scene_make(&s, camera_of(0), true);
    for (int what = 0; what < 2; what++) {
        struct fused_view view = {s.camera, &s.depth, &s.ids, is_pane, IDS, 1};
        struct err err = ERR_INIT;
        s.depth.width += what == 0;
        s.ids.height += what == 1;
        assert_int_equal(fuse_volume_add(&f, &view, &err), ST_DATA);
        assert_err(err, ST_DATA,
                   what ? "the depth of view v has 160 x 120 px, and its faces 160 x 121, but the view has 160 x 120"
                        : "the depth of view v has 161 x 120 px, and its faces 160 x 120, but the view has 160 x 120");
        s.depth.width -= what == 0;
        s.ids.height -= what == 1;
    }
    for (size_t i = 0; i < voxel_count(&grid); i++) assert_true(f.weight[i] == 0);
    scene_release(&s);
    fuse_volume_release(&f);
}

static void thread_counts_give_the_same_bits(void **state)
{
    (void)state;
    struct fused_volume f[2];
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(k ? 3 : 1);
        fuse_room(&f[k]);
    }
    parallel_set_threads(0);
    assert_memory_equal(f[0].sum, f[1].sum, voxel_count(&grid) * sizeof *f[0].sum);
    assert_memory_equal(f[0].weight, f[1].weight, voxel_count(&grid) * sizeof *f[0].weight);
    assert_memory_equal(f[0].views, f[1].views, voxel_count(&grid));
    for (int k = 0; k < 2; k++) fuse_volume_release(&f[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_surface_is_within_a_voxel_of_the_face),
        cmocka_unit_test(voxels_before_the_face_are_free),
        cmocka_unit_test(voxels_behind_the_face_are_unseen),
        cmocka_unit_test(the_views_that_show_the_face_are_counted),
        cmocka_unit_test(a_view_says_nothing_of_what_it_does_not_hold),
        cmocka_unit_test(depth_is_scaled_to_the_model),
        cmocka_unit_test(noise_of_a_wall_within_its_uncertainty_is_no_thing),
        cmocka_unit_test(what_is_hardly_graded_as_clutter_is_no_thing),
        cmocka_unit_test(a_pane_of_slightly_nearer_depth_is_no_thing),
        cmocka_unit_test(a_bare_wall_is_where_the_model_has_it),
        cmocka_unit_test(pixels_without_depth_or_model_say_nothing),
        cmocka_unit_test(doubtful_depth_weighs_less),
        cmocka_unit_test(a_wrong_surface_is_outvoted),
        cmocka_unit_test(other_sizes_are_refused),
        cmocka_unit_test(thread_counts_give_the_same_bits),
    };
    return cmocka_run_group_tests_name("fuse_views", tests, NULL, NULL);
}
