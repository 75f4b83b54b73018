/* Exposures of photos of a painted wall whose cameras chose different ones. */
#include "tests/unit/scratch.h"
#include "tests/unit/wall_scene.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/layers/layer_render.h"

enum { VIEWS = 4, COLUMNS = 14, ROWS = 9, POINTS = COLUMNS * ROWS };

static const struct rectangle wall[] = {{0, 0, 10, 40, 40}};
static const struct layer_render_options offline = {.offline = true, .more_views = 12, .soft_z = SOFT_Z_WIDTHS};

struct taken { /* how photos are taken */
    double gain[VIEWS][3], vignetting, contrast, brightness;
    int wrong_every; /* of the points, every so many is another place in odd views; 0: none */
};

static const struct taken uneven = {
    {{0.3, 0.25, 0.2}, {-0.2, -0.2, -0.25}, {0.1, 0, 0.1}, {-0.3, -0.2, 0}}, -0.6, 0.5, 0.25, 0};
static const struct taken even = {{{0}}, 0, 0.5, 0.25, 0};

struct photos {
    struct wall_scene f;
    struct sfm_image images[VIEWS];
    struct sfm_observation observations[VIEWS][POINTS];
    struct sfm_point points[POINTS];
    struct sfm_track tracks[POINTS][VIEWS];
};

static void paint(float rgb[3], double x, double y, const struct taken *t)
{
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(t->brightness * (1 + t->contrast * sin(0.9 * x + c) * cos(1.1 * y - 0.5 * c)));
}

static double tangent2(const struct view *v, double u, double w)
{
    const double x = (u - v->cx) / v->fx, y = (w - v->cy) / v->fy;
    return x * x + y * y;
}

static void photograph(struct layered_depth *d, const struct view *v, const double gain[3], const struct taken *t)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            float *rgba = d->interior.rgba + 4 * (y * W + x);
            const struct vec3 at = view_unproject(v, x + 0.5, y + 0.5, 10);
            paint(rgba, at.x, at.y, t);
            for (int c = 0; c < 3; c++)
                rgba[c] = fminf(1, rgba[c] * (float)exp(gain[c] + t->vignetting * tangent2(v, x + 0.5, y + 0.5)));
        }
}

static void observe(struct photos *p, const struct taken *t)
{
    for (int i = 0; i < POINTS; i++) {
        p->points[i].track = p->tracks[i];
        for (int k = 0; k < VIEWS; k++) {
            struct sfm_observation *o = &p->observations[k][p->images[k].observation_count];
            const bool wrong = t->wrong_every && i % t->wrong_every == 0 && k % 2;
            const struct vec3 at = vec3_make(-6.5 + 13.0 * (i % COLUMNS) / (COLUMNS - 1) + (wrong ? 1.5 : 0),
                                             -3 + 6.0 * (i / COLUMNS) / (ROWS - 1), 10);
            view_project(&p->f.views[k], at, &o->u, &o->v);
            if (o->u < 0 || o->v < 0 || o->u > W || o->v > H) continue;
            p->tracks[i][p->points[i].track_count++] = (struct sfm_track){k, p->images[k].observation_count++};
        }
    }
}

static void take(struct photos *p, const struct taken *t)
{
    struct err err = ERR_INIT;
    *p = (struct photos){0};
    for (int k = 0; k < VIEWS; k++) {
        add_straight(&p->f, k - 1.5, 0.2 * (k % 2), 0);
        make_layers(&p->f.depths[k], &p->f.views[k], wall, 1);
        photograph(&p->f.depths[k], &p->f.views[k], t->gain[k], t);
        p->images[k].observations = p->observations[k];
    }
    observe(p, t);
    p->f.set.model =
        (struct sfm_model){.images = p->images, .points = p->points, .image_count = VIEWS, .point_count = POINTS};
    assert_ok(layer_scene_init(&p->f.scene, &p->f.set, p->f.depths, &err), err);
}

static void match(struct photos *p)
{
    struct err err = ERR_INIT;
    assert_ok(layer_scene_match_exposures(&p->f.scene, &err), err);
}

static void render(struct rendered_frame *f, const struct photos *p, const struct view *camera)
{
    struct err err = ERR_INIT;
    assert_ok(layer_render(f, &p->f.scene, camera, &offline, &err), err);
    photo_exposures_apply(&p->f.scene.exposures, &p->f.scene.mesh, camera, f);
}

static struct view between_views(const struct photos *p)
{
    struct wall_scene at = {0};
    (void)p;
    add_straight(&at, 0.1, 0.1, 0);
    return at.views[0];
}

/* Largest relative difference of a frame, less its gain, from the paint, R G B, over its middle. */
static double worst_difference(const struct rendered_frame *f, const struct view *v, const struct taken *t)
{
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = -INFINITY;
        for (int y = 2; y < H - 2; y++)
            for (int x = 2; x < W - 2; x++) {
                float rgb[3];
                const struct vec3 at = view_unproject(v, x + 0.5, y + 0.5, 10);
                paint(rgb, at.x, at.y, t);
                const double ratio = log((double)f->rgba[4 * (y * W + x) + c] / (double)rgb[c]) -
                                     t->vignetting * tangent2(v, x + 0.5, y + 0.5);
                low = fmin(low, ratio);
                high = fmax(high, ratio);
            }
        worst = fmax(worst, high - low);
    }
    return worst;
}

static void gains_balance_and_vignetting_are_found(void **state)
{
    struct photos p;
    (void)state;
    take(&p, &uneven);
    match(&p);
    const struct photo_exposures *e = &p.f.scene.exposures;
    assert_non_null(e->gain);
    assert_float_equal(e->vignetting, uneven.vignetting, 0.01);
    for (int k = 1; k < VIEWS; k++)
        for (int c = 0; c < 3; c++)
            assert_float_equal(e->gain[k][c] - e->gain[0][c], uneven.gain[k][c] - uneven.gain[0][c], 0.005);
    layer_scene_release(&p.f.scene);
}

static void matched_photos_blend_without_borders(void **state)
{
    struct photos p;
    struct rendered_frame f = {0};
    (void)state;
    take(&p, &uneven);
    const struct view camera = between_views(&p);
    render(&f, &p, &camera);
    assert_true(worst_difference(&f, &camera, &uneven) > 0.2);
    match(&p);
    render(&f, &p, &camera);
    assert_true(worst_difference(&f, &camera, &uneven) < 0.01);
    rendered_frame_release(&f);
    layer_scene_release(&p.f.scene);
}

static void the_camera_of_a_photo_shows_its_brightness(void **state)
{
    struct photos p;
    struct rendered_frame f = {0};
    (void)state;
    take(&p, &uneven);
    match(&p);
    for (int k = 0; k < VIEWS; k++) {
        const struct view *v = &p.f.views[k];
        const size_t middle = (size_t)(H / 2) * W + W / 2;
        const struct vec3 at = view_unproject(v, W / 2 + 0.5, H / 2 + 0.5, 10);
        float rgb[3];
        paint(rgb, at.x, at.y, &uneven);
        render(&f, &p, v);
        for (size_t c = 0; c < 3; c++)
            assert_float_equal(f.rgba[4 * middle + c] / (rgb[c] * (float)exp(uneven.gain[k][c])), 1, 0.02);
        assert_float_equal(f.rgba[4 * middle + 3], 1, 1e-6);
    }
    rendered_frame_release(&f);
    layer_scene_release(&p.f.scene);
}

static void photos_of_one_exposure_keep_their_bytes(void **state)
{
    struct photos p;
    struct rendered_frame a = {0}, b = {0};
    (void)state;
    take(&p, &even);
    const struct view camera = between_views(&p);
    render(&a, &p, &camera);
    match(&p);
    assert_null(p.f.scene.exposures.gain);
    render(&b, &p, &camera);
    assert_memory_equal(a.rgba, b.rgba, sizeof *a.rgba * W * H * 4);
    rendered_frame_release(&a);
    rendered_frame_release(&b);
    layer_scene_release(&p.f.scene);
}

static void wrong_matches_hardly_count(void **state)
{
    struct photos p;
    struct taken t = uneven;
    (void)state;
    t.wrong_every = 6;
    take(&p, &t);
    match(&p);
    const struct photo_exposures *e = &p.f.scene.exposures;
    assert_non_null(e->gain);
    for (int k = 1; k < VIEWS; k++)
        for (int c = 0; c < 3; c++)
            assert_float_equal(e->gain[k][c] - e->gain[0][c], t.gain[k][c] - t.gain[0][c], 0.03);
    layer_scene_release(&p.f.scene);
}

static void without_points_photos_stay_as_they_were_taken(void **state)
{
    struct photos p;
    (void)state;
    take(&p, &uneven);
    p.f.set.model.point_count = 0;
    match(&p);
    assert_null(p.f.scene.exposures.gain);
    layer_scene_release(&p.f.scene);
}

static void clipped_and_dark_places_tell_nothing(void **state)
{
    static const double brightness[] = {1.5, 0.001};
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct photos p;
        struct taken t = uneven;
        t.brightness = brightness[i];
        t.contrast = t.vignetting = 0;
        take(&p, &t);
        match(&p);
        assert_null(p.f.scene.exposures.gain);
        layer_scene_release(&p.f.scene);
    }
}

static void a_view_without_points_has_a_finite_exposure(void **state)
{
    struct photos p;
    (void)state;
    take(&p, &uneven);
    for (int i = 0; i < POINTS; i++)
        if (p.points[i].track_count && p.tracks[i][p.points[i].track_count - 1].image_idx == VIEWS - 1)
            p.points[i].track_count--;
    match(&p);
    const struct photo_exposures *e = &p.f.scene.exposures;
    assert_non_null(e->gain);
    for (int c = 0; c < 3; c++) assert_float_equal(e->gain[VIEWS - 1][c], 0, 1e-9);
    assert_float_equal(e->gain[1][0] - e->gain[0][0], uneven.gain[1][0] - uneven.gain[0][0], 0.01);
    layer_scene_release(&p.f.scene);
}

static void clipped_white_takes_no_tint(void **state)
{
    struct photos p;
    struct err err = ERR_INIT;
    float rgba[4];
    (void)state;
    take(&p, &uneven);
    const struct photo_exposures e = {.gain = (double[][3]){{0.4, 0, -0.4}, {0}, {0}, {0}}};
    layer_view_photo(&p.f.scene.views[0], 5, 5, rgba);
    const float up[3] = {1 / rgba[0], 1 / rgba[1], 1 / rgba[2]};
    layer_view_scale(&p.f.scene.views[0], 5, 5, up);
    assert_ok(photo_exposures_remove(&e, 0, &p.f.views[0], &p.f.scene.views[0], &err), err);
    layer_view_photo(&p.f.scene.views[0], 5, 5, rgba);
    for (int c = 0; c < 3; c++) assert_float_equal(rgba[c], 1, 0.02);
    layer_scene_release(&p.f.scene);
}

static void any_thread_count_gives_the_same_bits(void **state)
{
    struct rendered_frame f[2] = {{0}, {0}};
    const int threads = parallel_threads();
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct photos p;
        parallel_set_threads(i ? 3 : 1);
        take(&p, &uneven);
        match(&p);
        const struct view camera = between_views(&p);
        render(&f[i], &p, &camera);
        layer_scene_release(&p.f.scene);
    }
    parallel_set_threads(threads);
    assert_memory_equal(f[0].rgba, f[1].rgba, sizeof *f[0].rgba * W * H * 4);
    for (int i = 0; i < 2; i++) rendered_frame_release(&f[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gains_balance_and_vignetting_are_found),
        cmocka_unit_test(matched_photos_blend_without_borders),
        cmocka_unit_test(the_camera_of_a_photo_shows_its_brightness),
        cmocka_unit_test(photos_of_one_exposure_keep_their_bytes),
        cmocka_unit_test(wrong_matches_hardly_count),
        cmocka_unit_test(without_points_photos_stay_as_they_were_taken),
        cmocka_unit_test(clipped_and_dark_places_tell_nothing),
        cmocka_unit_test(a_view_without_points_has_a_finite_exposure),
        cmocka_unit_test(clipped_white_takes_no_tint),
        cmocka_unit_test(any_thread_count_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
