/* layer_render.c - novel views of scenes with known geometry, by both renderers. */
#include "tests/unit/common/layers/formula_scene.h"

#include <malloc.h>

#include "common/base/parallel.h"

static const double one[][3] = {{0, 0, 0}};
static const double four[][3] = {{-0.3, -0.2, 0}, {0.3, -0.2, 0}, {-0.3, 0.25, 0}, {0.3, 0.25, 0}};

static const struct shape tilted_planes = {tilted_depth, false, 0.01};
static const struct shape wave_planes = {wave_depth, false, 0.01};
static const struct shape wave_steps = {wave_depth, true, 0.02};
static const struct shape square = {square_depth, true, 0.01};

/* ------------------------------------------------------------------------------------------------------- tests */

static void rendering_an_input_camera_reproduces_its_photo(void **state)
{
    const bool offline = *(const bool *)*state;
    static const struct shape *const shapes[] = {&tilted_planes, &wave_steps, &square};
    for (int k = 0; k < 3; k++) {
        struct scene s;
        struct rendered_frame f = {0};
        scene_make(&s, shapes[k], one, 1);
        render(&f, &s, &s.views[0], offline, 6);
        assert_near(f.hole_fraction, 0, 0);
        assert_true(psnr(&f, &s.views[0], shapes[k], 0) > 65); /* the limit is rounding to half */
        layer_scene_release(&s.layers);

        scene_make(&s, shapes[k], four, 4); /* on the mesh: this view has weight 1 */
        render(&f, &s, &s.views[2], offline, 6);
        assert_true(psnr(&f, &s.views[2], shapes[k], 0) > 45);
        layer_scene_release(&s.layers);
        rendered_frame_release(&f);
    }
}

static void rendered_depth_follows_the_planes(void **state)
{
    const bool offline = *(const bool *)*state;
    struct scene s;
    struct rendered_frame f = {0};
    const struct view novel = view_at(0.1, 0.05, 0.3);
    scene_make(&s, &tilted_planes, four, 4);
    render(&f, &s, &novel, offline, 6);
    for (int y = 15; y < H - 15; y++)
        for (int x = 15; x < W - 15; x++) assert_near(f.z[y * W + x], meet(&novel, x + 0.5, y + 0.5, tilted), 1e-4);
    assert_true(psnr(&f, &novel, &tilted_planes, 15) > 35);
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void a_surface_of_many_segments_shows_no_cracks(void **state)
{
    const bool offline = *(const bool *)*state;
    /* one view, so that no other view closes a crack; tangent planes, then constant z */
    static const struct shape *const shapes[] = {&wave_planes, &wave_steps};
    for (int k = 0; k < 2; k++) {
        struct scene s;
        struct rendered_frame f = {0};
        scene_make(&s, shapes[k], one, 1);
        for (int i = 0; i < 12; i++) { /* up to 17 px of parallax, 0.7 px between neighbours */
            const struct view novel = view_at(0.45 * cos(i), 0.45 * sin(i), 0.2 * sin(2 * i));
            render(&f, &s, &novel, offline, 0);
            assert_int_equal(holes_inside(&f, 30), 0);
            for (int y = 30; y < H - 30; y++)
                for (int x = 30; x < W - 30; x++) {
                    assert_near(f.rgba[4 * (y * W + x) + 3], 1, 0);
                    assert_near(f.rgba[4 * (y * W + x) + 2], 0.8, 0.01);
                }
        }
        layer_scene_release(&s.layers);
        rendered_frame_release(&f);
    }
}

static void a_small_camera_move_changes_the_picture_little(void **state)
{
    const bool offline = *(const bool *)*state;
    static const struct shape *const shapes[] = {&wave_steps, &square};
    static const double steps[] = {1e-2, 1e-3, 1e-4};
    for (int k = 0; k < 2; k++) {
        struct scene s;
        struct rendered_frame a = {0}, b = {0};
        const struct view here = view_at(0.07, 0.03, 0.4);
        scene_make(&s, shapes[k], four, 4);
        render(&a, &s, &here, offline, 6);
        for (int i = 0; i < 3; i++) {
            const struct view there = view_at(0.07 + steps[i], 0.03, 0.4);
            double change = 0;
            render(&b, &s, &there, offline, 6);
            for (int p = 0; p < W * H * 4; p++) change += fabs((double)a.rgba[p] - (double)b.rgba[p]);
            /* parallax of FOCAL / z = 40 px per unit, texture gradient of 0.05 per px */
            assert_true(change / (W * H * 4) < 3 * steps[i]);
        }
        layer_scene_release(&s.layers);
        rendered_frame_release(&a);
        rendered_frame_release(&b);
    }
}

static void any_thread_count_gives_the_same_bits(void **state)
{
    const bool offline = *(const bool *)*state;
    struct scene s;
    struct rendered_frame a = {0}, b = {0};
    const int threads = parallel_threads();
    scene_make(&s, &square, four, 4);
    for (int i = 0; i < 3; i++) {
        const struct view novel = view_at(0.4 * i, 0.1, -0.3 + 0.3 * i);
        parallel_set_threads(1);
        render(&a, &s, &novel, offline, 6);
        parallel_set_threads(3);
        render(&b, &s, &novel, offline, 6);
        assert_memory_equal(a.rgba, b.rgba, sizeof *a.rgba * W * H * 4);
        assert_memory_equal(a.z, b.z, sizeof *a.z * W * H);
        assert_memory_equal(a.hole, b.hole, W * H);
    }
    /* a reused frame, first of another size, gives the same result as a fresh one */
    struct view small = view_at(0, 0.1, -0.3);
    small.width = 64;
    render(&a, &s, &small, offline, 6);
    render(&a, &s, &s.views[0], offline, 6);
    rendered_frame_release(&b);
    render(&b, &s, &s.views[0], offline, 6);
    assert_memory_equal(a.rgba, b.rgba, sizeof *a.rgba * W * H * 4);
    parallel_set_threads(threads);
    layer_scene_release(&s.layers);
    rendered_frame_release(&a);
    rendered_frame_release(&b);
}

/* Fallbacks are prepared by the first tile that has a hole: which one, and how many views, must not matter. */
static void coverage_is_that_of_the_frame_for_any_thread_count(void **state)
{
    (void)state;
    static const double nine[][3] = {{-0.8, -0.2, 0}, {0.8, -0.2, 0}, {-0.8, 0.2, 0}, {0.8, 0.2, 0}, {0, 0, 0},
                                     {0, 0.6, 0.2},   {0, -0.6, 0},   {0.4, 0, -0.3}, {3, 0, 0}};
    const int threads = parallel_threads();
    struct rendered_frame f = {0}, cover = {0};
    struct err err = ERR_INIT;
    int holes = 0;
    for (int count = 1; count <= 9; count += 4) {
        struct scene s;
        scene_make(&s, &square, nine, count);
        for (int i = 0; i < 8; i++) { /* beside the views, in front of them and behind them */
            const struct view novel = view_at(0.5 * cos(i), 0.5 * sin(i), 0.5 * i - 2);
            parallel_set_threads(1);
            render(&f, &s, &novel, false, 0);
            for (int n = 1; n <= 3; n++) {
                parallel_set_threads(n);
                assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 1, &err), ST_OK);
                assert_memory_equal(cover.hole, f.hole, W * H);
                assert_true(cover.hole_fraction == f.hole_fraction);
            }
            holes += (int)(f.hole_fraction * W * H);
        }
        layer_scene_release(&s.layers);
    }
    assert_true(holes > 1000);
    parallel_set_threads(threads);
    rendered_frame_release(&f);
    rendered_frame_release(&cover);
}

/* The offline renderer reads more of a fallback's sample than the fast one does. */
static void frames_do_not_depend_on_what_memory_held(void **state)
{
    const bool offline = *(const bool *)*state;
    static const double nine[][3] = {{-0.8, -0.2, 0}, {0.8, -0.2, 0}, {-0.8, 0.2, 0}, {0.8, 0.2, 0}, {0, 0, 0},
                                     {0, 0.6, 0.2},   {0, -0.6, 0},   {0.4, 0, -0.3}, {3, 0, 0}};
    static const int fills[] = {0x3F, 0xC0, 0}; /* of new memory, inverted; 0 leaves it as it is */
    struct rendered_frame f[3] = {{0}};
    struct scene s;
    scene_make(&s, &square, nine, 9);
    mallopt(M_MMAP_THRESHOLD, 1 << 30); /* fresh pages would be zero */
    for (int i = 0; i < 8; i++) {
        const struct view novel = view_at(0.5 * cos(i), 0.5 * sin(i), 0.5 * i - 2);
        for (int k = 0; k < 3; k++) {
            mallopt(M_PERTURB, fills[k]);
            render(&f[k], &s, &novel, offline, 0);
        }
        for (int k = 1; k < 3; k++) {
            assert_memory_equal(f[k].rgba, f[0].rgba, sizeof *f[0].rgba * W * H * 4);
            assert_memory_equal(f[k].z, f[0].z, sizeof *f[0].z * W * H);
        }
    }
    for (int k = 0; k < 3; k++) rendered_frame_release(&f[k]);
    layer_scene_release(&s.layers);
}

static void disoccluded_pixels_are_holes_filled_from_the_far_side(void **state)
{
    const bool offline = *(const bool *)*state;
    struct scene s;
    struct rendered_frame f = {0}, cover = {0};
    struct err err = ERR_INIT;
    const double shift = 0.2;
    const struct view novel = view_at(shift, 0, 0);
    const int disparity = 5; /* FOCAL shift (1/3 - 1/6) */
    scene_make(&s, &square, one, 1);
    assert_near(s.layers.near_depth, 3, 1e-9);
    assert_near(s.layers.far_depth, 6, 1e-9);

    render(&f, &s, &novel, offline, 0);
    /* a strip of `disparity` px right of the square (35..45 px wide picture of half width 25), and the border's
     * FOCAL shift / 6 = 5 */
    assert_near(f.hole_fraction * W * H, 50 * disparity + H * 5, 80);
    assert_near(f.unfilled_fraction, f.hole_fraction, 0);
    const int left = W / 2 + 25 - 10, middle = H / 2; /* the square's right edge moves by FOCAL shift / 3 = 10 */
    assert_int_equal(f.hole[middle * W + left + 2], 1);
    assert_near(f.rgba[4 * (middle * W + left + 2) + 3], 0, 0);
    assert_near(f.z[middle * W + left + 2], 0, 0);
    assert_near(f.z[middle * W + left - 2], 3, 1e-5);

    assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 1, &err), ST_OK);
    assert_memory_equal(cover.hole, f.hole, W * H);
    assert_near(cover.hole_fraction, f.hole_fraction, 0);
    assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 0.5, &err), ST_OK);
    assert_int_equal(cover.width, W / 2);
    assert_near(cover.hole_fraction, f.hole_fraction, 0.01);

    render(&f, &s, &novel, offline, 6);
    assert_near(f.unfilled_fraction, 0, 0);
    assert_int_equal(f.hole[middle * W + left + 2], 1);
    for (int x = left + 1; x < left + disparity; x++) {
        assert_near(f.z[middle * W + x], 6, 0.01);
        assert_near(f.rgba[4 * (middle * W + x) + 2], 0.8, 0.02); /* the wall's blue, not the square's */
    }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
    rendered_frame_release(&cover);
}

static void there_is_no_hole_along_a_rail(void **state)
{
    const bool offline = *(const bool *)*state;
    /* on the rail and in front of it; coverage and rendering agree in every pixel */
    static const double rail[][3] = {{-0.6, 0, 0}, {-0.3, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}};
    struct scene s;
    struct rendered_frame f = {0};
    scene_make(&s, &square, rail, 4);
    for (int i = 0; i < 9; i++) {
        const struct view novel = view_at(-0.6 + 0.15 * i, 0, 0.2);
        struct rendered_frame cover = {0};
        struct err err = ERR_INIT;
        render(&f, &s, &novel, offline, 0);
        assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 1, &err), ST_OK);
        assert_memory_equal(cover.hole, f.hole, W * H);
        assert_int_equal(holes_inside(&f, 30), 0);
        assert_true(psnr(&f, &novel, &square, 30) > 25);
        rendered_frame_release(&cover);
    }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void picture_borders_leave_no_visible_line(void **state)
{
    const bool offline = *(const bool *)*state;
    /* the right views are a fifth darker: there must be no step where their pictures end */
    static const double rail[][3] = {{-0.8, 0, 0}, {0.8, 0, 0}};
    const struct view novel = view_at(-0.2, 0, 0);
    struct scene s;
    struct layered_depth depths[2];
    struct rendered_frame f = {0};
    struct err err = ERR_INIT;

    memset(&s, 0, sizeof s);
    for (int i = 0; i < 2; i++) {
        s.views[i] = view_at(rail[i][0], rail[i][1], rail[i][2]);
        depth_make(&depths[i], &s.views[i], &tilted_planes);
        for (int p = 0; p < W * H * 4; p++)
            if (p % 4 != 3) depths[i].interior.rgba[p] = i ? 0.8f : 1;
    }
    s.set.views = s.views;
    s.set.view_count = 2;
    assert_int_equal(layer_scene_init(&s.layers, &s.set, depths, &err), ST_OK);
    render(&f, &s, &novel, offline, 6);
    for (int y = 4; y < H - 4; y++) /* not the corners, where both borders fade */
        for (int x = 1; x < W; x++)
            assert_near(f.rgba[4 * (y * W + x)], f.rgba[4 * (y * W + x - 1)], 0.06); /* 0.2 over 8 px of fading */
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void erase(struct layered_depth *d, int x0, int y0, int x1, int y1)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            const size_t p = (size_t)(y * W + x);
            d->interior.id[p] = 0;
            memset(d->interior.rgba + 4 * p, 0, 4 * sizeof(float));
        }
}

static void a_hole_takes_the_nearest_consistent_fallback_view(void **state)
{
    const bool offline = *(const bool *)*state;
    /* the two views of the mesh lack the same patch of wall above the square: novel [70, 90) x [18, 30) */
    static const double rail[][3] = {{-0.6, 0, 0}, {-0.3, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}};
    const struct view novel = view_at(0.05, 0, 0.001);
    const struct layer_render_options options = {.offline = offline, .soft_z = SOFT_Z_WIDTHS}; /* no extra views */
    for (int phantom = 0; phantom < 2; phantom++) {
        struct scene s;
        struct layered_depth depths[4];
        struct rendered_frame f = {0};
        struct err err = ERR_INIT;

        memset(&s, 0, sizeof s);
        for (int i = 0; i < 4; i++) {
            s.views[i] = view_at(rail[i][0], rail[i][1], rail[i][2]);
            depth_make(&depths[i], &s.views[i], &square);
        }
        erase(&depths[1], 78, 18, 100, 30); /* FOCAL 0.3 / 6 = 7.5 px on both sides */
        erase(&depths[2], 62, 18, 84, 30);
        for (int i = 0; phantom && i < depths[3].segment_count;
             i++) /* the wall of the nearest other view is in front of everything */
            if (fabs(depths[3].segments[i].plane[2] - 1.0 / 6) < 1e-6) depths[3].segments[i].plane[2] = 1 / 1.5;
        s.set.views = s.views;
        s.set.view_count = 4;
        assert_int_equal(layer_scene_init(&s.layers, &s.set, depths, &err), ST_OK);
        if (layer_render(&f, &s.layers, &novel, &options, &err)) fail_msg("%s", err.text);
        assert_int_equal(holes_inside(&f, 10), 0);
        for (int y = 19; y < 29; y++)
            for (int x = 72; x < 88; x++) assert_near(f.z[y * W + x], 6, 0.01);
        assert_true(psnr(&f, &novel, &square, 10) > 30);
        layer_scene_release(&s.layers);
        rendered_frame_release(&f);
    }
}

/* Moves a patch of a depth map to depth z, as a segment of its own. */
static void move_patch(struct layered_depth *d, int x0, int y0, int x1, int y1, double z, double confidence)
{
    d->segments = realloc(d->segments, ((size_t)d->segment_count + 1) * sizeof *d->segments);
    assert_non_null(d->segments);
    struct depth_segment *added = &d->segments[d->segment_count++];
    *added = d->segments[d->interior.id[y0 * W + x0] - 1];
    *added = (struct depth_segment){.id = (uint32_t)d->segment_count,
                                    .pixels = (x1 - x0) * (y1 - y0),
                                    .plane = {0, 0, 1 / z},
                                    .sigma = added->sigma,
                                    .confidence = confidence};
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            d->interior.id[y * W + x] = added->id;
            d->interior.z[y * W + x] = (float)z;
        }
}

/* As above, but one of the mesh's views has the patch at a far depth, and so sees through the wall that the other views
 * have there. It does not if it only inherited that depth. Of the other views, the nearest has the patch too near: if
 * it inherited that, it comes after the next one. */
static void inherited_depth_is_no_evidence_against_a_fallback(void **state)
{
    const bool offline = *(const bool *)*state;
    static const double rail[][3] = {{-0.6, 0, 0}, {-0.3, 0, 0}, {0.3, 0, 0}, {0.6, 0, 0}};
    const struct view novel = view_at(0.05, 0, 0.001);
    const struct layer_render_options options = {.offline = offline, .soft_z = SOFT_Z_WIDTHS};
    for (int sure = 0; sure < 2; sure++) {
        struct scene s;
        struct layered_depth depths[4];
        struct rendered_frame f = {0};
        struct err err = ERR_INIT;
        int holes = 0, right = 0;

        memset(&s, 0, sizeof s);
        for (int i = 0; i < 4; i++) {
            s.views[i] = view_at(rail[i][0], rail[i][1], rail[i][2]);
            depth_make(&depths[i], &s.views[i], &square);
        }
        move_patch(&depths[1], 78, 18, 100, 30, 60, sure ? 1 : 0.05);
        erase(&depths[2], 62, 18, 84, 30);
        move_patch(&depths[3], 48, 18, 76, 30, 5, 0.05);
        s.set.views = s.views;
        s.set.view_count = 4;
        assert_int_equal(layer_scene_init(&s.layers, &s.set, depths, &err), ST_OK);
        if (layer_render(&f, &s.layers, &novel, &options, &err)) fail_msg("%s", err.text);
        for (int y = 20; y < 28; y++)
            for (int x = 71; x < 76; x++) {
                holes += f.hole[y * W + x];
                right += fabs((double)f.z[y * W + x] - 6) < 0.01;
            }
        assert_int_equal(holes, sure ? 40 : 0);
        assert_int_equal(right, sure ? 0 : 40);
        layer_scene_release(&s.layers);
        rendered_frame_release(&f);
    }
}

/* Renders a view at the origin in its own camera. Takes ownership of the depth map. */
static void render_own(struct rendered_frame *f, struct layered_depth *d, bool offline)
{
    struct scene s = {.views = {view_at(0, 0, 0)}, .set = {.view_count = 1}};
    struct err err = ERR_INIT;

    s.set.views = s.views;
    assert_int_equal(layer_scene_init(&s.layers, &s.set, d, &err), ST_OK);
    render(f, &s, &s.views[0], offline, 6);
    layer_scene_release(&s.layers);
}

static void boundary_layers_composite_to_the_photo(void **state)
{
    const bool offline = *(const bool *)*state;
    /* the square's boundary, two pixels wide, is matted: half in each layer */
    const struct view v = view_at(0, 0, 0);
    struct layered_depth d;
    struct rendered_frame f = {0};
    float *photo = malloc(sizeof *photo * W * H * 4);

    depth_make(&d, &v, &square);
    memcpy(photo, d.interior.rgba, sizeof *photo * W * H * 4);
    for (int y = 0; y < H; y++)
        for (int x = 1; x + 1 < W; x++) {
            const size_t p = (size_t)(y * W + x);
            const uint32_t side[2] = {d.interior.id[p - 1], d.interior.id[p + 1]};
            const uint32_t other = side[0] != d.interior.id[p] ? side[0] : side[1];
            if (other == d.interior.id[p] || (other & 1) == (d.interior.id[p] & 1)) continue;
            d.boundary.id[p] = other;
            d.boundary.z[p] = (float)(1 / d.segments[other - 1].plane[2]);
            for (int k = 0; k < 4; k++) {
                d.boundary.rgba[4 * p + (size_t)k] = 0.375f * photo[4 * p + (size_t)k];
                d.interior.rgba[4 * p + (size_t)k] = 0.625f * photo[4 * p + (size_t)k];
            }
        }
    render_own(&f, &d, offline);
    for (int p = 0; p < W * H; p++) {
        for (int k = 0; k < 3; k++) assert_near(f.rgba[4 * p + k], photo[4 * p + k], 1.0 / 1024);
        assert_true(fabsf(f.z[p] - 3) < 1e-4f || fabsf(f.z[p] - 6) < 1e-4f);
    }
    free(photo);
    rendered_frame_release(&f);
}

static void unusual_cameras_are_rendered(void **state)
{
    const bool offline = *(const bool *)*state;
    struct scene s;
    struct rendered_frame f = {0};
    scene_make(&s, &square, four, 4);

    struct view away = view_at(0, 0, 0); /* looking away from the scene */
    away.cam_from_world = (struct mat3){{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
    away.translation = vec3_make(0, 0, 0);
    render(&f, &s, &away, offline, 6);
    assert_near(f.hole_fraction, 1, 0);
    assert_near(f.unfilled_fraction, 1, 0);

    struct view behind = view_at(0, 0, 9); /* behind the wall, looking away from it */
    render(&f, &s, &behind, offline, 6);
    assert_near(f.hole_fraction, 1, 0);

    const struct view places[] = {view_at(0, 0, 3), view_at(0.1, 0, 2.999999), view_at(0, 0, 6), view_at(0, 0, -50),
                                  view_at(1e4, 0, 0)}; /* in the square, in the wall, far away */
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        render(&f, &s, &places[i], offline, 6);
        for (int p = 0; p < W * H; p++) {
            assert_true(isfinite(f.z[p]) && f.z[p] >= 0);
            for (int k = 0; k < 4; k++) assert_true(isfinite(f.rgba[4 * p + k]));
        }
    }
    struct view pixel = view_at(0, 0, 0);
    pixel.width = pixel.height = 1;
    pixel.cx = pixel.cy = 0.5;
    render(&f, &s, &pixel, offline, 6);
    assert_near(f.z[0], 3, 1e-4);
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void inconsistent_depth_maps_are_rejected(void **state)
{
    (void)state;
    struct view v = view_at(0, 0, 0);
    struct camera_set set = {.views = &v, .view_count = 1};
    struct layer_scene layers = {0};
    struct layered_depth d;
    struct err err = ERR_INIT;

    depth_make(&d, &v, &square);
    d.boundary.id[7] = (uint32_t)d.segment_count + 1;
    assert_int_equal(layer_scene_init(&layers, &set, &d, &err), ST_DATA);
    assert_non_null(strstr(err.text, "pixel (7, 0)"));
    assert_null(d.segments);

    err = (struct err)ERR_INIT;
    depth_make(&d, &v, &square);
    v.width = W + 1;
    assert_int_equal(layer_scene_init(&layers, &set, &d, &err), ST_DATA);
    assert_non_null(strstr(err.text, "160 x 120"));
    layer_scene_release(&layers);
}

/* --------------------------------------------------------------------------------------- continuity, extra views */

static const double nine[][3] = {{-0.3, -0.3, 0}, {0, -0.3, 0},   {0.3, -0.3, 0}, {-0.3, 0, 0}, {0, 0, 0},
                                 {0.3, 0, 0},     {-0.3, 0.3, 0}, {0, 0.3, 0},    {0.3, 0.3, 0}};

/* As scene_make, with view i brighter by (i % 3) / 10, so that each view's weight shows. */
static const float uneven[3] = {1, 1.1f, 1.2f};

/* Mean absolute difference of the pictures from two positions. */
static double change(const struct scene *s, struct vec3 a, struct vec3 b, const struct layer_render_options *options)
{
    struct rendered_frame f = {0}, g = {0};
    struct err err = ERR_INIT;
    double sum = 0;
    const struct view from = view_at(a.x, a.y, a.z), to = view_at(b.x, b.y, b.z);
    if (layer_render(&f, &s->layers, &from, options, &err)) fail_msg("%s", err.text);
    if (layer_render(&g, &s->layers, &to, options, &err)) fail_msg("%s", err.text);
    for (int p = 0; p < W * H * 4; p++) sum += fabs((double)f.rgba[p] - (double)g.rgba[p]);
    rendered_frame_release(&f);
    rendered_frame_release(&g);
    return sum / (W * H * 4);
}

/* Ever smaller moves across and away from a position must change the picture ever less. A parallax of 40 px per unit on
 * a texture of 0.05 per px changes a channel by at most 2 per unit; weights that pass between views a fifth apart
 * within 0.3 units, by 0.7. */
static void check_moves(const struct scene *s, struct vec3 at, struct vec3 way,
                        const struct layer_render_options *options)
{
    static const double steps[] = {1e-2, 1e-3, 1e-4, 1e-5};
    for (int i = 0; i < 4; i++) {
        const struct vec3 half = vec3_scale(way, 0.5 * steps[i]), end = vec3_scale(way, steps[i]);
        const double across = change(s, vec3_sub(at, half), vec3_add(at, half), options);
        const double from = change(s, at, vec3_add(at, end), options);
        if (!(across < 3 * steps[i] && from < 3 * steps[i]))
            fail_msg("at %g %g %g by %g: %g across, %g from it", at.x, at.y, at.z, steps[i], across, from);
    }
}

static const struct vec3 right = {1, 0, 0}, ahead = {0, 0, 1}, aslant = {0.6, 0.48, 0.64};

static void crossing_an_edge_of_the_view_mesh_is_smooth(void **state)
{
    const bool offline = *(const bool *)*state;
    struct scene s;
    scene_make_uneven(&s, &square, nine, 9, uneven);
    check_moves(&s, vec3_make(0, 0.1, 0), right, &renderers[offline]);         /* in the mesh, across an edge */
    check_moves(&s, vec3_make(0, 0.1, 0.3), right, &renderers[offline]);       /* in front of it */
    check_moves(&s, vec3_make(0.3, 0.1, 0), right, &renderers[offline]);       /* across its boundary */
    check_moves(&s, vec3_make(0.1071, 0.0532, 0), ahead, &renderers[offline]); /* through it */
    check_moves(&s, vec3_make(0.1, 0.1, -0.2), aslant, &renderers[offline]);   /* behind it */
    layer_scene_release(&s.layers);
}

static void passing_an_input_view_is_smooth(void **state)
{
    const bool offline = *(const bool *)*state;
    struct scene s;
    scene_make_uneven(&s, &square, nine, 9, uneven);
    check_moves(&s, vec3_make(0, 0, 0), right, &renderers[offline]);
    check_moves(&s, vec3_make(0, 0, 0), ahead, &renderers[offline]);
    check_moves(&s, vec3_make(0.3, -0.3, 0), aslant, &renderers[offline]); /* at the mesh's corner */
    layer_scene_release(&s.layers);
}

static void a_view_joins_the_nearest_views_smoothly(void **state)
{
    static const int more[] = {1, 3, 5};
    struct scene s;
    (void)state;
    scene_make_uneven(&s, &square, nine, 9, uneven);
    for (int i = 0; i < 3; i++) {
        struct layer_render_options options = renderers[true];
        options.more_views = more[i];
        /* x = 0.15 is halfway between the middle and the right column: (0, 0) and (0.3, 0) are nearest, then (0, 0.3)
         * and (0.3, 0.3), then (0, -0.3) and (0.3, -0.3) */
        check_moves(&s, vec3_make(0.15, 0.1, 0), right, &options);
        check_moves(&s, vec3_make(0.15, 0.1, 0.25), right, &options);
    }
    layer_scene_release(&s.layers);
}

static void blending_weights_sum_to_one(void **state)
{
    const bool offline = *(const bool *)*state;
    static const double three[][3] = {{-0.2, -0.15, 0}, {0.2, -0.15, 0}, {0, 0.2, 0}};
    const struct layer_render_options options = {.offline = offline,
                                                 .soft_z = SOFT_Z_WIDTHS}; /* only the mesh's views */
    struct layered_depth depths[3] = {0};
    struct scene s;
    struct rendered_frame f = {0};
    struct err err = ERR_INIT;

    memset(&s, 0, sizeof s);
    for (int i = 0; i < 3; i++) { /* red, green and blue */
        s.views[i] = view_at(three[i][0], three[i][1], three[i][2]);
        depth_make(&depths[i], &s.views[i], &tilted_planes);
        for (int p = 0; p < W * H; p++)
            for (int k = 0; k < 3; k++) depths[i].interior.rgba[4 * p + k] = k == i;
    }
    s.set.views = s.views;
    s.set.view_count = 3;
    assert_int_equal(layer_scene_init(&s.layers, &s.set, depths, &err), ST_OK);
    for (int i = 0; i < 6; i++) {
        const struct view novel = view_at(0.03 * i, 0.02 * i - 0.05, 0.1 * i - 0.3);
        struct view_mesh_camera mesh;
        struct view_weights row[W];
        assert_int_equal(layer_render(&f, &s.layers, &novel, &options, &err), ST_OK);
        view_mesh_prepare(&mesh, &s.layers.mesh, &novel);
        for (int y = 0; y < H; y++) {
            view_mesh_row(&mesh, y, row);
            for (int x = 0; x < W; x++) {
                const float *c = f.rgba + 4 * (y * W + x);
                double weight[3] = {0}, sum = 0;
                if (f.hole[y * W + x]) continue;
                for (int k = 0; k < row[x].count; k++) weight[row[x].view[k]] += (double)row[x].weight[k];
                for (int k = 0; k < 3; k++) sum += offline ? sqrt((double)c[k]) : (double)c[k];
                assert_near(sum, 1, 1e-5);
                if (x < 30 || y < 30 || x >= W - 30 || y >= H - 30)
                    continue; /* only where no view fades towards its border */
                for (int k = 0; k < 3; k++)
                    assert_near(offline ? sqrt((double)c[k]) : (double)c[k], weight[k],
                                0.04); /* bilinear within 16 px, also across kinks */
            }
        }
    }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void a_surface_that_all_other_views_see_through_is_not_visible(void **state)
{
    struct layered_depth depths[9] = {0};
    struct layer_render_options options = renderers[true];
    struct scene s;
    struct rendered_frame f = {0};
    struct err err = ERR_INIT;

    (void)state;
    options.more_views = LAYER_MORE_VIEWS;
    memset(&s, 0, sizeof s);
    for (int i = 0; i < 9; i++) {
        s.views[i] = view_at(nine[i][0], nine[i][1], nine[i][2]);
        depth_make(&depths[i], &s.views[i], &tilted_planes);
    }
    int moved = 0; /* in the middle view every fifth segment floats in front of the scene, and is white */
    for (int k = 0; k < depths[4].segment_count; k++)
        if (depths[4].segments[k].pixels && k / 2 % 5 == 0) {
            memcpy(depths[4].segments[k].plane, (const double[3]){0, 0, 1 / 2.0}, sizeof depths[4].segments[k].plane);
            moved++;
            for (int p = 0; p < W * H; p++)
                if (depths[4].interior.id[p] == (uint32_t)k + 1)
                    for (int c = 0; c < 3; c++) depths[4].interior.rgba[4 * p + c] = 5;
        }
    assert_true(moved > 8);
    s.set.views = s.views;
    s.set.view_count = 9;
    assert_int_equal(layer_scene_init(&s.layers, &s.set, depths, &err), ST_OK);
    for (int i = 0; i < 4; i++) {
        const struct view novel = view_at(0.1 + 0.02 * i, 0.07, 0.03 * i);
        assert_int_equal(layer_render(&f, &s.layers, &novel, &options, &err), ST_OK);
        assert_int_equal(holes_inside(&f, 15), 0);
        for (int y = 15; y < H - 15; y++)
            for (int x = 15; x < W - 15; x++) {
                const float *c = f.rgba + 4 * (y * W + x);
                assert_near(f.z[y * W + x], meet(&novel, x + 0.5, y + 0.5, tilted), 0.02);
                assert_true(c[0] < 0.85f && c[1] < 0.8f && c[2] < 0.9f); /* at most 0.1 above the texture */
            }
    }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

/* ------------------------------------------------------------------------------------------------- frame sizes */

static void frames_of_any_size_have_the_same_bits_for_any_thread_count(void **state)
{
    const bool offline = *(const bool *)*state;
    static const int sizes[][2] = {{1, 1},    {7, 5},    {8, 16},   {9, 17},   {15, 1},     {16, 16}, {250, 33},
                                   {256, 16}, {257, 17}, {263, 31}, {513, 15}, {20000, 16}, {3, 3000}};
    const int threads = parallel_threads();
    struct scene s;
    struct rendered_frame a = {0}, b = {0}, cover = {0};
    struct err err = ERR_INIT;

    scene_make(&s, &square, four, 4);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct view novel = view_at(0.02, -0.03, 0.3); /* the same field of view */
        const size_t pixels = (size_t)sizes[i][0] * (size_t)sizes[i][1];
        novel.width = sizes[i][0];
        novel.height = sizes[i][1];
        novel.fx = FOCAL * novel.width / W;
        novel.fy = FOCAL * novel.height / H;
        novel.cx = 0.5 * novel.width;
        novel.cy = 0.5 * novel.height;
        parallel_set_threads(1);
        render(&a, &s, &novel, offline, 0);
        parallel_set_threads(2);
        rendered_frame_release(&b);
        render(&b, &s, &novel, offline, 0);
        assert_memory_equal(a.rgba, b.rgba, sizeof *a.rgba * pixels * 4);
        assert_memory_equal(a.z, b.z, sizeof *a.z * pixels);
        assert_memory_equal(a.hole, b.hole, pixels);
        assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 1, &err), ST_OK);
        assert_memory_equal(a.hole, cover.hole, pixels);
        frame_is_finite(&a);
        for (size_t p = 0; p < pixels; p++) {
            int surface;
            const double u = (double)(p % (size_t)novel.width) + 0.5, w = (double)(p / (size_t)novel.width) + 0.5;
            const double z = square_depth(&novel, u, w, &surface);
            const double x = novel.center.x + (u - novel.cx) / novel.fx * z, y = (w - novel.cy) / novel.fy * z;
            const double rim = fmin(fabs(fabs(x) - 0.5), fabs(fabs(y + novel.center.y) - 0.5));
            if (surface == 0 || rim > 0.05) assert_int_equal(a.hole[p], 0);
            if (surface && rim > 0.05) assert_near(a.z[p], z, 1e-3);
            if (!surface && (fabs(x) > 1.2 || fabs(y) > 1.2)) assert_near(a.z[p], z, 1e-3);
            assert_near(a.rgba[4 * p + 3], !a.hole[p], 0);
        }
    }
    parallel_set_threads(threads);
    layer_scene_release(&s.layers);
    rendered_frame_release(&a);
    rendered_frame_release(&b);
    rendered_frame_release(&cover);
}

static void coverage_has_the_same_holes_as_rendering(void **state)
{
    const bool offline = *(const bool *)*state;
    struct scene s;
    struct rendered_frame f = {0}, cover = {0};
    struct err err = ERR_INIT;
    int holes = 0;

    scene_make(&s, &square, nine, 9);
    for (int i = 0; i < 24; i++) { /* around the views, near and far */
        const double far = 0.3 + 0.1 * (i % 6);
        const struct view novel = view_at(far * cos(i), far * sin(i), 0.4 * sin(3 * i));
        render(&f, &s, &novel, offline, 0);
        assert_int_equal(layer_coverage(&cover, &s.layers, &novel, 1, &err), ST_OK);
        assert_memory_equal(cover.hole, f.hole, W * H);
        assert_near(cover.hole_fraction, f.hole_fraction, 0);
        for (int p = 0; p < W * H; p++) holes += f.hole[p];
    }
    assert_true(holes > 1000);
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
    rendered_frame_release(&cover);
}

/* ---------------------------------------------------------------------------------------------------- silhouettes */

#define EDGE 80.3 /* px, in a view at x = 0, of a red half plane at depth 3; to the right of it blue at depth 6 */

static void silhouette_make(struct scene *s, const double *xs, int count)
{
    struct layered_depth depths[2] = {0};
    struct err err = ERR_INIT;

    memset(s, 0, sizeof *s);
    for (int i = 0; i < count; i++) {
        struct layered_depth *d = &depths[i];
        const double edge = EDGE - FOCAL * xs[i] / 3;
        s->views[i] = view_at(xs[i], 0, 0);
        assert_int_equal(layered_depth_init(d, W, H, &err), ST_OK);
        d->segments = calloc(2, sizeof *d->segments);
        d->segment_count = 2;
        for (int k = 0; k < 2; k++)
            d->segments[k] =
                (struct depth_segment){.id = (uint32_t)k + 1, .plane = {0, 0, k ? 1 / 6.0 : 1 / 3.0}, .sigma = 0.01};
        for (int p = 0; p < W * H; p++) {
            const float red = (float)fmax(0, fmin(1, edge - p % W)); /* coverage of the near half plane */
            const bool near = red >= 0.5f;
            d->interior.id[p] = near ? 1 : 2;
            d->interior.rgba[4 * p + (near ? 0 : 2)] = d->interior.rgba[4 * p + 3] = near ? red : 1 - red;
            if (red == 0 || red == 1) continue;
            d->boundary.id[p] = near ? 2 : 1;
            d->boundary.rgba[4 * p + (near ? 2 : 0)] = d->boundary.rgba[4 * p + 3] = near ? 1 - red : red;
        }
    }
    s->set.views = s->views;
    s->set.view_count = count;
    if (layer_scene_init(&s->layers, &s->set, depths, &err)) fail_msg("%s", err.text);
}

static void a_matted_silhouette_is_reproduced_in_its_own_camera(void **state)
{
    const bool offline = *(const bool *)*state;
    static const double origin[] = {0};
    struct scene s;
    struct rendered_frame f = {0};

    silhouette_make(&s, origin, 1);
    render(&f, &s, &s.views[0], offline, 0);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const float *c = f.rgba + 4 * (y * W + x), red = (float)fmax(0, fmin(1, EDGE - x));
            assert_near(c[0], red, 1.0 / 1024);
            assert_near(c[2], 1 - red, 1.0 / 1024);
            assert_near(c[1], 0, 0);
            assert_near(c[3], 1, 0);
        }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void a_silhouette_keeps_its_coverage_in_a_shifted_view(void **state)
{
    const bool offline = *(const bool *)*state;
    static const double origin[] = {0};
    struct scene s;
    struct rendered_frame f = {0};

    silhouette_make(&s, origin, 1);
    for (int i = 0; i <= 24; i++) { /* to the left: the near half plane moves over the background, up to 9 px */
        const double shift = 0.0075 * i, edge = EDGE + FOCAL * shift / 3;
        const struct view novel = view_at(-shift, 0, 0);
        render(&f, &s, &novel, offline, 0);
        for (int y = 0; y < H; y++) {
            double sum = 0;
            for (int x = 60; x < 110; x++) {
                const float *c = f.rgba + 4 * (y * W + x);
                const double covered = fmax(0, fmin(1, edge - x));
                sum += (double)c[0];
                assert_near(c[0], covered, 0.255); /* bilinear between coverages: error at most f (1 - f) */
                assert_near(c[0] + c[2], 1, 1e-3);
                assert_near(c[1], 0, 0);
                assert_near(c[3], 1, 0);
            }
            assert_near(60 + sum, edge, 2e-3); /* position of the edge */
        }
    }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

static void a_silhouette_between_two_views_is_a_clean_edge(void **state)
{
    const bool offline = *(const bool *)*state;
    static const double pair[] = {-0.1, 0.1};
    struct scene s;
    struct rendered_frame f = {0};

    silhouette_make(&s, pair, 2);
    /* The left view has nothing behind the edge. With the fast renderer its boundary hides what others have there:
     * completely from half coverage on (half a pixel of error), in proportion below (a quarter). */
    for (int i = 0; i <= 20; i++) {
        const double x0 = -0.09 + 0.009 * i, edge = EDGE - FOCAL * x0 / 3;
        const struct view novel = view_at(x0, 0, 0);
        render(&f, &s, &novel, offline, 0);
        for (int y = 4; y < H - 4; y++) {
            double sum = 0;
            for (int x = 60; x < 110; x++) {
                const float *c = f.rgba + 4 * (y * W + x);
                sum += (double)c[0];
                assert_near(c[0] + c[2], 1, 0.5); /* mean of square roots where views disagree */
                assert_true(x == 60 || c[0] <= c[-4] + 1e-3f);
                if (fabs(x + 0.5 - edge) > 2) assert_near(c[0], x < edge, 1e-3);
            }
            assert_near(60 + sum, edge, offline ? 0.5 : 0.75);
        }
    }
    layer_scene_release(&s.layers);
    rendered_frame_release(&f);
}

/* -------------------------------------------------------------------------------------------------- invalid colours */

static void infinite_colours_do_not_reach_a_frame(void **state)
{
    const bool offline = *(const bool *)*state;
    static const double bad[] = {NAN, INFINITY, -INFINITY, 1e300, -1, 0};
    for (int k = 0; k < 6; k++) {
        struct layered_depth depths[4] = {0};
        struct scene s;
        struct rendered_frame f = {0};
        struct err err = ERR_INIT;
        memset(&s, 0, sizeof s);
        for (int i = 0; i < 4; i++) {
            s.views[i] = view_at(four[i][0], four[i][1], four[i][2]);
            depth_make(&depths[i], &s.views[i], &square);
            for (int n = i; n < depths[i].segment_count; n += 3) depths[i].segments[n].sigma = bad[k];
            for (int p = 7 * i; p < W * H; p += 5) depths[i].interior.rgba[4 * p + p % 3] = (float)bad[k];
            for (int p = 11 * i; p < W * H; p += 13) { /* both layers at once */
                depths[i].boundary.id[p] = depths[i].interior.id[p];
                for (int c = 0; c < 4; c++) depths[i].boundary.rgba[4 * p + c] = c < 3 ? (float)bad[k] : 0.5f;
            }
        }
        s.set.views = s.views;
        s.set.view_count = 4;
        assert_int_equal(layer_scene_init(&s.layers, &s.set, depths, &err), ST_OK);
        for (int i = 0; i < 5; i++) {
            const struct view novel = view_at(0.1 * i - 0.2, 0.05 * i, 0.2 * i - 0.3);
            render(&f, &s, i == 4 ? &s.views[1] : &novel, offline, 6);
            for (int p = 0; p < W * H; p++) {
                assert_true(isfinite(f.z[p]) && f.z[p] >= 0);
                for (int c = 0; c < 4; c++) assert_true(isfinite(f.rgba[4 * p + c]));
            }
        }
        layer_scene_release(&s.layers);
        rendered_frame_release(&f);
    }
}

static void a_nan_colour_is_black(void **state)
{
    const bool offline = *(const bool *)*state;
    const struct view v = view_at(0, 0, 0);
    struct layered_depth d;
    struct rendered_frame f = {0};

    depth_make(&d, &v, &square);
    d.interior.rgba[4 * (20 * W + 30)] = NAN;
    render_own(&f, &d, offline);
    assert_near(f.rgba[4 * (20 * W + 30)], 0, 1e-3);
    rendered_frame_release(&f);
}

static bool fast = false, offline = true;
#define BOTH(test) \
    {#test " (fast)", test, NULL, NULL, &fast}, { #test " (offline)", test, NULL, NULL, &offline }

int main(void)
{
    const struct CMUnitTest tests[] = {
        BOTH(rendering_an_input_camera_reproduces_its_photo),
        BOTH(rendered_depth_follows_the_planes),
        BOTH(a_surface_of_many_segments_shows_no_cracks),
        BOTH(a_small_camera_move_changes_the_picture_little),
        BOTH(any_thread_count_gives_the_same_bits),
        BOTH(frames_do_not_depend_on_what_memory_held),
        BOTH(disoccluded_pixels_are_holes_filled_from_the_far_side),
        BOTH(there_is_no_hole_along_a_rail),
        BOTH(picture_borders_leave_no_visible_line),
        BOTH(a_hole_takes_the_nearest_consistent_fallback_view),
        BOTH(inherited_depth_is_no_evidence_against_a_fallback),
        BOTH(boundary_layers_composite_to_the_photo),
        BOTH(unusual_cameras_are_rendered),
        BOTH(crossing_an_edge_of_the_view_mesh_is_smooth),
        BOTH(passing_an_input_view_is_smooth),
        BOTH(blending_weights_sum_to_one),
        BOTH(frames_of_any_size_have_the_same_bits_for_any_thread_count),
        BOTH(coverage_has_the_same_holes_as_rendering),
        BOTH(a_matted_silhouette_is_reproduced_in_its_own_camera),
        BOTH(a_silhouette_keeps_its_coverage_in_a_shifted_view),
        BOTH(a_silhouette_between_two_views_is_a_clean_edge),
        BOTH(infinite_colours_do_not_reach_a_frame),
        BOTH(a_nan_colour_is_black),
        cmocka_unit_test(coverage_is_that_of_the_frame_for_any_thread_count),
        cmocka_unit_test(a_view_joins_the_nearest_views_smoothly),
        cmocka_unit_test(a_surface_that_all_other_views_see_through_is_not_visible),
        cmocka_unit_test(inconsistent_depth_maps_are_rejected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
