/* Which pixels show a thing, and which view shows it best. */
#include "stages/find_things/thing_views.h"

#include "common/image/exr.h"
#include "tests/unit/box_solids.h"
#include "tests/unit/find_things/voxel_blocks.h"

enum { W = 100, H = 80, PIXELS = W * H, N = 20 };

static const struct voxel_grid grid = {{-1, -1, 0}, 0.1, {N, N, N}};

static struct view front(void) { return view_at(vec3_make(0, 0, -1), 0, 0, W, H, 100); }

/* The thing's block is at depths 2 to 2.5 of the view; pixels have depths and clutter of a few kinds. */
static void pixels_show_the_thing_that_their_point_is_in(void **state)
{
    (void)state;
    static uint32_t ids[N * N * N], mask[PIXELS];
    const struct thing_volume v = {grid, ids, NULL};
    const struct view camera = front();
    struct layered_depth d = {0};
    struct view_ids seen = {0};
    struct err err = ERR_INIT;
    put_block(ids, &grid, (struct block){5, 5, 10, 14, 14, 14}, 7);
    assert_ok(layered_depth_init(&d, W, H, &err), err);
    assert_ok(view_ids_init(&seen, W, H, &err), err);
    for (int scale = 1; scale <= 2; scale++) {
        memset(mask, 0xa5, sizeof mask);
        for (int i = 0; i < PIXELS; i++) {
            seen.clutter[i] = i % 4 == 0 ? CLUTTER_UNSURE : 0.75f;
            d.interior.z[i] = (i % 4 == 1 ? 0 : i % 4 == 2 ? 3.0f : 2.05f) / (float)scale;
        }
        assert_ok(thing_shows_find(mask, &v, &camera, &d, &seen, scale, &err), err);
        for (int i = 0; i < PIXELS; i++) {
            const double x = 2.05 * (i % W + 0.5 - W / 2) / 100, y = 2.05 * ((int)(i / W) + 0.5 - H / 2) / 100;
            assert_int_equal(mask[i], i % 4 == 3 && fabs(x) < 0.5 && fabs(y) < 0.5 ? 7 : 0);
        }
    }
    layered_depth_release(&d);
    view_ids_release(&seen);
}

/* Segments are bands of four rows; the first have depth of the thing in three of four columns, the others in one. */
static void a_segment_that_shows_half_of_a_thing_shows_it_whole(void **state)
{
    (void)state;
    static uint32_t ids[N * N * N], mask[PIXELS];
    const struct thing_volume v = {grid, ids, NULL};
    const struct view camera = front();
    struct layered_depth d = {0};
    struct view_ids seen = {0};
    struct err err = ERR_INIT;
    for (int i = 0; i < N * N * N; i++) ids[i] = 7;
    assert_ok(layered_depth_init(&d, W, H, &err), err);
    assert_ok(view_ids_init(&seen, W, H, &err), err);
    d.segment_count = (H + 3) / 4;
    d.segments = calloc((size_t)d.segment_count, sizeof *d.segments);
    assert_non_null(d.segments);
    for (int i = 0; i < PIXELS; i++) {
        const int band = i / W / 4;
        const bool shown = band < 2 ? i % 4 != 0 : i % 4 == 0;
        d.interior.id[i] = (uint32_t)band + 1;
        d.interior.z[i] = shown ? 1.5f : 90.0f; /* far beyond the volume */
        seen.clutter[i] = 1;
    }
    assert_ok(thing_shows_find(mask, &v, &camera, &d, &seen, 1, &err), err);
    for (int i = 0; i < PIXELS; i++) {
        const bool whole = i / W / 4 < 2, seen_there = i % 4 == 0;
        assert_int_equal(mask[i], whole || seen_there ? 7 : 0);
    }
    layered_depth_release(&d);
    view_ids_release(&seen);
}

/* Of two gaps, the one of two pixels is closed where there may be clutter, the one of twenty is not. */
static void narrow_gaps_of_a_thing_are_closed(void **state)
{
    enum { WIDE = 500, TALL = 80, GAP = 250 };
    (void)state;
    static uint32_t ids[N * N * N], mask[WIDE * TALL];
    const struct thing_volume v = {grid, ids, NULL};
    const struct view camera = view_at(vec3_make(0, 0, -1), 0, 0, WIDE, TALL, 1000);
    struct layered_depth d = {0};
    struct view_ids seen = {0};
    struct err err = ERR_INIT;
    for (int i = 0; i < N * N * N; i++) ids[i] = 7;
    assert_ok(layered_depth_init(&d, WIDE, TALL, &err), err);
    assert_ok(view_ids_init(&seen, WIDE, TALL, &err), err);
    for (int i = 0; i < WIDE * TALL; i++) {
        const int x = i % WIDE, y = i / WIDE;
        const bool gap = (x >= GAP && x < GAP + 2) || (x >= GAP + 40 && x < GAP + 60);
        d.interior.z[i] = gap ? 90.0f : 1.5f;
        seen.clutter[i] = y < TALL / 2 ? 1 : gap ? 0 : 1;
    }
    assert_ok(thing_shows_find(mask, &v, &camera, &d, &seen, 1, &err), err);
    for (int y = 0; y < TALL; y++) {
        const uint32_t *row = mask + y * WIDE;
        assert_int_equal(row[GAP - 1], 7);
        assert_int_equal(row[GAP], y < TALL / 2 ? 7 : 0);
        assert_int_equal(row[GAP + 50], 0); /* too wide */
    }
    layered_depth_release(&d);
    view_ids_release(&seen);
}

static void a_mask_is_read_back_or_refused(void **state)
{
    (void)state;
    static uint32_t mask[PIXELS], other_mask[PIXELS];
    const struct view camera = front();
    struct view other = camera;
    const struct thing_mask written = {mask, other_mask};
    struct thing_mask again = {0};
    struct err err = ERR_INIT;
    other.width = W / 2;
    for (int i = 0; i < PIXELS; i++) mask[i] = (uint32_t)i % 5, other_mask[i] = (uint32_t)i % 3;
    assert_ok(thing_mask_write(&written, &camera, scratch_path("v.exr"), NULL, &err), err);
    assert_ok(thing_mask_read(&again, &camera, scratch_path("v.exr"), 4, NULL, &err), err);
    assert_memory_equal(again.shows, mask, sizeof mask);
    assert_memory_equal(again.meets, other_mask, sizeof mask);
    thing_mask_release(&again);
    assert_int_equal(thing_mask_read(&again, &camera, scratch_path("v.exr"), 3, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "v.exr: pixel (4, 0) is of thing 4, but there are 3; run find_things again.");
    assert_true(!again.shows && !again.meets);
    err = (struct err)ERR_INIT;
    assert_int_equal(thing_mask_read(&again, &other, scratch_path("v.exr"), 4, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "px, but the view is");
    assert_true(!again.shows && !again.meets);
}

static void a_mask_is_written_with_its_camera(void **state)
{
    (void)state;
    static uint32_t mask[PIXELS];
    static const char *const names[] = {"id"};
    const struct thing_mask written = {mask, mask};
    const struct view camera = front();
    struct exr_image im;
    struct err err = ERR_INIT;
    for (int i = 0; i < PIXELS; i++) mask[i] = (uint32_t)i % 5;
    assert_ok(thing_mask_write(&written, &camera, scratch_path("v.exr"), NULL, &err), err);
    assert_ok(exr_read(&im, scratch_path("v.exr"), names, 1, &err), err);
    assert_true(im.width == W && im.height == H && im.has_world_to_camera);
    assert_memory_equal(im.planes[0].u, mask, sizeof mask);
    exr_image_release(&im);
}

/* ------------------------------------------------------------------------------------------------------------ meets */

#define VOXEL 0.1

struct meeting {
    uint32_t meets[PIXELS];
    float nearest[PIXELS];
};

/* The model is a wall at the depth `wall` (scene units) all over the view. */
static void meet(struct meeting *m, const struct surface_voxel *voxels, size_t count, const struct view *camera,
                 double scale, float wall)
{
    struct view_ids seen = {0};
    struct err err = ERR_INIT;
    assert_ok(view_ids_init(&seen, W, H, &err), err);
    for (int i = 0; i < PIXELS; i++) seen.z[i] = wall;
    memset(m, 0xa5, sizeof *m);
    thing_meets_find(m->meets, voxels, count, VOXEL, camera, &seen, scale, m->nearest);
    view_ids_release(&seen);
}

/* What the ray of the view's middle meets, of two voxels on it at these depths. */
static uint32_t met_of(double first, double second, double scale, float wall)
{
    static struct meeting m;
    const struct view camera = front();
    const struct surface_voxel voxels[] = {{{0, 0, first - 1}, 7}, {{0, 0, second - 1}, 8}};
    const size_t middle = (size_t)H / 2 * W + W / 2;
    meet(&m, voxels, 2, &camera, scale, wall);
    if (!m.meets[middle]) assert_true(isinf(m.nearest[middle]));
    if (m.meets[middle]) assert_float_equal(m.nearest[middle], m.meets[middle] == 7 ? first : second, 1e-6);
    assert_int_equal(m.meets[0], 0);
    return m.meets[middle];
}

static void a_ray_meets_the_first_of_two_things(void **state)
{
    (void)state;
    assert_int_equal(met_of(2, 3, 1, 9), 7);
    assert_int_equal(met_of(3, 2, 1, 9), 8);
    assert_int_equal(met_of(2, 2, 1, 9), 7); /* of equals the first that is listed */
    /* what is behind the camera, or in its plane, is not met */
    assert_int_equal(met_of(-2, 3, 1, 9), 8);
    assert_int_equal(met_of(0.04, 3, 1, 9), 8);
}

static void what_the_model_hides_is_not_met(void **state)
{
    (void)state;
    assert_int_equal(met_of(3, 4, 1, 2), 0);
    assert_int_equal(met_of(3, 2, 1, 2.5f), 8);
    /* the model's depth is in scene units */
    assert_int_equal(met_of(3, 4, 2, 2), 7);
    assert_int_equal(met_of(3, 4, 0.5, 2), 0);
    assert_int_equal(met_of(2, 3, 1, 0), 0); /* there is no model that a thing could be before */
}

/* It must be more than a voxel before the model, whose own surface it may be. */
static void a_surface_near_that_of_the_model_is_not_met(void **state)
{
    (void)state;
    assert_int_equal(met_of(2, 4, 1, 2.05f), 0);
    assert_int_equal(met_of(2, 4, 1, 2.09f), 0);
    assert_int_equal(met_of(2, 4, 1, 2.11f), 7);
}

/* A plane of voxels, 2.1 x 2.1, that is turned by `turn` about the y axis, `away` before the camera. All pixels whose
 * ray goes through it meet it, nearly at its depth; if it faces the camera, others do not, but for a rim. */
static void assert_no_holes(double away, double turn)
{
    enum { SIDE = 21 };
    static struct surface_voxel plane[SIDE * SIDE];
    static struct meeting m;
    const struct view camera = front();
    const double half = 0.5 * SIDE * VOXEL, rim = VOXEL + away / 100;
    int inside = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double x = VOXEL * (i % SIDE - SIDE / 2), y = VOXEL * ((int)(i / SIDE) - SIDE / 2);
        plane[i] = (struct surface_voxel){{cos(turn) * x, y, away - 1 + sin(turn) * x}, 9};
    }
    meet(&m, plane, SIDE * SIDE, &camera, 1, 99);
    for (int i = 0; i < PIXELS; i++) {
        const double u = (i % W + 0.5 - W / 2) / 100, v = ((int)(i / W) + 0.5 - H / 2) / 100;
        const double x = u * away / (cos(turn) - u * sin(turn)), z = away + sin(turn) * x; /* along the plane; depth */
        if (fabs(x) < half && fabs(v * z) < half) {
            assert_int_equal(m.meets[i], 9);
            assert_float_equal(m.nearest[i], z, 2 * VOXEL);
            inside++;
        } else if (turn == 0 && (fabs(x) > half + rim || fabs(v * z) > half + rim))
            assert_int_equal(m.meets[i], 0);
    }
    assert_true(inside > 0);
}

static void a_plane_of_voxels_has_no_holes_from_near_or_afar(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        const double turn = 0.4 * k;
        assert_no_holes(1, turn); /* a voxel is 10 px wide */
        assert_no_holes(4, turn);
        assert_no_holes(10, turn); /* 1 px */
        assert_no_holes(25, turn); /* 0.4 px */
    }
}

static void a_plane_before_the_camera_covers_the_view(void **state)
{
    enum { SIDE = 41 };
    static struct surface_voxel plane[SIDE * SIDE];
    static struct meeting m;
    const struct view camera = front();
    (void)state;
    for (int i = 0; i < SIDE * SIDE; i++) /* 0.06 before it: wider than the view */
        plane[i] =
            (struct surface_voxel){{VOXEL * (i % SIDE - SIDE / 2), VOXEL * ((int)(i / SIDE) - SIDE / 2), 0.06 - 1}, 9};
    meet(&m, plane, SIDE * SIDE, &camera, 1, 1);
    for (int i = 0; i < PIXELS; i++) assert_int_equal(m.meets[i], 9);
}

/* ----------------------------------------------------------------------------------------------------------- sights */

struct patch {
    int left, top, right, bottom;
    uint32_t id;
};

static void see(struct thing_sight *sights, int count, const struct patch *patches, int patch_count, int view_index)
{
    static uint32_t mask[PIXELS];
    const struct view camera = front();
    struct err err = ERR_INIT;
    memset(mask, 0, sizeof mask);
    for (int k = 0; k < patch_count; k++)
        for (int y = patches[k].top; y <= patches[k].bottom; y++)
            for (int x = patches[k].left; x <= patches[k].right; x++) mask[y * W + x] = patches[k].id;
    assert_ok(thing_sights_add(sights, count, mask, &camera, view_index, &err), err);
}

static void is_at(const struct thing_sight *s, int left, int top, int right, int bottom)
{
    assert_true(s->low[0] == left && s->low[1] == top && s->high[0] == right && s->high[1] == bottom);
}

static void the_view_with_most_of_a_thing_is_the_best(void **state)
{
    (void)state;
    struct thing_sight s[3] = {{0}};
    see(s, 3, (struct patch[]){{10, 10, 19, 19, 1}, {50, 50, 52, 53, 2}}, 2, 4);
    see(s, 3, (struct patch[]){{5, 20, 24, 39, 1}}, 1, 5);
    see(s, 3, (struct patch[]){{5, 20, 9, 29, 1}, {60, 20, 80, 40, 2}, {95, 60, 96, 61, 2}}, 3, 6);
    assert_int_equal(s[0].views, 3);
    assert_int_equal(s[0].best, 5);
    assert_float_equal(s[0].score, 400.0 / PIXELS, 1e-12);
    is_at(&s[0], 5, 20, 24, 39);
    assert_int_equal(s[1].views, 2);
    assert_int_equal(s[1].best, 6);
    is_at(&s[1], 60, 20, 96, 61); /* around both of its parts */
    assert_int_equal(s[2].views, 0);
}

static void of_equal_views_the_first_is_the_best(void **state)
{
    (void)state;
    struct thing_sight s = {0};
    see(&s, 1, (struct patch[]){{10, 10, 19, 19, 1}}, 1, 2);
    see(&s, 1, (struct patch[]){{30, 30, 39, 39, 1}}, 1, 3);
    assert_int_equal(s.best, 2);
    is_at(&s, 10, 10, 19, 19);
}

static void a_thing_that_the_border_cuts_counts_less(void **state)
{
    (void)state;
    const struct patch cut[] = {
        {0, 20, 14, 33, 1}, {85, 20, 99, 33, 1}, {20, 0, 34, 13, 1}, {20, 66, 34, 79, 1}}; /* 210 px */
    for (int k = 0; k < 4; k++) {
        struct thing_sight s = {0};
        see(&s, 1, &cut[k], 1, 0);
        see(&s, 1, (struct patch[]){{40, 40, 49, 48, 1}}, 1, 1); /* 90 px, more than 0.4 of them */
        assert_int_equal(s.best, 1);
        see(&s, 1, (struct patch[]){{0, 20, 14, 38, 1}}, 1, 2); /* 285 px */
        assert_int_equal(s.best, 2);
    }
}

/* Of 8000 px, 0.0005 is 4. */
static const struct patch few = {40, 40, 42, 40, 1}, enough = {40, 40, 43, 40, 1};

/* The views of a thing of which each view shows a patch, and the best of them. */
static void expect_sights(const struct patch *const *patches, int count, int views, int best)
{
    struct thing_sight s = {0};
    for (int i = 0; i < count; i++) see(&s, 1, patches[i], 1, i);
    assert_int_equal(s.views, views);
    assert_int_equal(s.best, best);
}

static void a_few_pixels_do_not_count_as_a_view(void **state)
{
    (void)state;
    expect_sights((const struct patch *const[]){&enough, &few, &enough}, 3, 2, 0);
}

static void the_order_of_views_does_not_change_their_number(void **state)
{
    (void)state;
    expect_sights((const struct patch *const[]){&few, &enough}, 2, 1, 1);
}

/* The sums are of all views; a pixel that the photo does not have adds nothing. */
static void the_radiance_of_a_thing_is_that_of_its_pixels(void **state)
{
    (void)state;
    static uint32_t mask[6] = {1, 2, 0, 2, 1, 2};
    float rgba[4 * 6];
    const struct image photo = {.width = 3, .height = 2, .channels = 4, .data = rgba};
    struct thing_sight s[3] = {{0}};
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < 4; c++) rgba[4 * i + c] = c == 3 ? i != 5 : (float)(i + 1) * (float)(c + 1) / 4;
    for (int view = 1; view <= 2; view++) {
        thing_sights_add_radiance(s, mask, &photo, NULL);
        assert_int_equal(s[0].pixels, 2 * view);
        assert_int_equal(s[1].pixels, 2 * view); /* not the last */
        for (int c = 0; c < 3; c++) {
            assert_float_equal(s[0].sum[c], view * (1 + 5) * (c + 1) / 4.0, 1e-9);
            assert_float_equal(s[1].sum[c], view * (2 + 4) * (c + 1) / 4.0, 1e-9);
        }
    }
    assert_true(!s[2].pixels && s[2].sum[0] == 0 && !s[0].views);
}

/* A slanted surface faces the camera, three fifths of the way east: its pixels tell of east and down alone. */
static void the_sides_of_a_thing_have_the_radiance_of_what_faces_their_way(void **state)
{
    static uint32_t id[N * N * N], mask[PIXELS];
    static float distance[N * N * N], z[PIXELS], rgba[4 * PIXELS];
    const struct thing_volume v = {grid, id, distance};
    const struct view camera = front();
    const struct image photo = {.width = W, .height = H, .channels = 4, .data = rgba};
    const struct thing_geometry geometry = {&v, &camera, z, 2};
    const struct vec3 normal = vec3_make(0.6, 0, -0.8);
    enum { EAST, WEST, NORTH, DOWN = 5 };
    static const int own[] = {0, 7, 14, 21, 28, 35}; /* of the products of a side's weight with itself */
    struct thing_sight s = {0};
    struct thing t = {0};
    (void)state;
    for (int i = 0; i < N * N * N; i++) {
        id[i] = 1;
        distance[i] = (float)(0.3 * vec3_dot(normal, vec3_sub(thing_voxel_centre(&grid, i), vec3_make(0, 0, 1))));
    }
    for (int i = 0; i < PIXELS; i++) {
        mask[i] = 1;
        z[i] = (float)(0.5 * 1.6 / (0.8 - 0.6 * (i % W + 0.5 - W / 2) / 100)); /* scene units of two */
        for (int c = 0; c < 4; c++) rgba[4 * i + c] = c == 3 ? 1 : (float)c + 0.5F;
    }
    thing_sights_add_radiance(&s, mask, &photo, &geometry);
    assert_true(s.pixels == PIXELS && s.side_weights[own[EAST]] > 0.36 * 0.36 * PIXELS / 10);
    assert_true(fabs(s.side_weights[own[EAST]] / s.side_weights[own[DOWN]] - 0.36 * 0.36 / (0.64 * 0.64)) < 1e-3);
    thing_sight_radiance(&t, &s);
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(t.radiance[c] - (c + 0.5)) < 1e-6);
        for (int k = 0; k < THING_SIDES; k++) assert_true(fabs(t.sides[k][c] - (c + 0.5)) < 1e-6);
    }
    for (int k = 1; k < DOWN; k++) assert_true(s.side_weights[own[k]] < 1e-3 * s.side_weights[own[EAST]]);
    /* the same surface in another colour, seen from where it faces west: blended sides have the colours of both */
    for (int i = 0; i < N * N * N; i++) {
        const struct vec3 p = vec3_sub(thing_voxel_centre(&grid, i), vec3_make(0, 0, 1));
        distance[i] = (float)(0.3 * vec3_dot(vec3_make(-0.6, 0, -0.8), p));
    }
    for (int i = 0; i < PIXELS; i++) {
        z[i] = (float)(0.5 * 1.6 / (0.8 + 0.6 * (i % W + 0.5 - W / 2) / 100));
        rgba[4 * i] = 1;
    }
    thing_sights_add_radiance(&s, mask, &photo, &geometry);
    thing_sight_radiance(&t, &s);
    const double down = 0.64 * t.sides[DOWN][0];
    assert_true(fabs(0.36 * t.sides[EAST][0] + down - 0.5) < 0.01 && fabs(0.36 * t.sides[WEST][0] + down - 1) < 0.01);
    assert_true(fabs(t.sides[EAST][1] - 1.5) < 1e-6 && fabs(t.sides[NORTH][0] - t.radiance[0]) < 1e-2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_show_the_thing_that_their_point_is_in),
        cmocka_unit_test(narrow_gaps_of_a_thing_are_closed),
        cmocka_unit_test(a_segment_that_shows_half_of_a_thing_shows_it_whole),
        cmocka_unit_test_setup_teardown(a_mask_is_read_back_or_refused, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(a_mask_is_written_with_its_camera, scratch_make, scratch_remove),
        cmocka_unit_test(a_ray_meets_the_first_of_two_things),
        cmocka_unit_test(what_the_model_hides_is_not_met),
        cmocka_unit_test(a_surface_near_that_of_the_model_is_not_met),
        cmocka_unit_test(a_plane_of_voxels_has_no_holes_from_near_or_afar),
        cmocka_unit_test(a_plane_before_the_camera_covers_the_view),
        cmocka_unit_test(the_radiance_of_a_thing_is_that_of_its_pixels),
        cmocka_unit_test(the_sides_of_a_thing_have_the_radiance_of_what_faces_their_way),
        cmocka_unit_test(the_view_with_most_of_a_thing_is_the_best),
        cmocka_unit_test(of_equal_views_the_first_is_the_best),
        cmocka_unit_test(a_thing_that_the_border_cuts_counts_less),
        cmocka_unit_test(a_few_pixels_do_not_count_as_a_view),
        cmocka_unit_test(the_order_of_views_does_not_change_their_number),
    };
    return cmocka_run_group_tests_name("thing_views", tests, NULL, NULL);
}
