/* plane_match.c - the matching cost on photographs of known planes, at those planes and at others. */
#include "stages/segment_depth/plane_match.h"

#include "tests/unit/segment_depth/scene.h"

#include "common/base/parallel.h"

enum { W = 120, H = 90, FOCAL = 120 };

struct bench {
    struct scene scene;
    struct gamma_image reference;
    struct segmentation segments;
    struct observed_points seen;
    struct matcher matcher;
    struct plane truth; /* of the wall in view 0 */
    double step;        /* of 1/z: a pixel in view 1 */
};

static struct bench b;                                                /* large; zeroed by start() */
static struct segment_params all_neighbours = SEGMENT_PARAMS_DEFAULT; /* but with all neighbours; set by start() */

/* View 0 shows a slanted textured wall only. */
static void start(void)
{
    memset(&b, 0, sizeof b);
    all_neighbours.best_neighbours = MAX_NEIGHBOURS;
    scene_wall(&b.scene, 0, 0, 4, 6, 6, 0.35);
    scene_view(&b.scene, W, H, FOCAL, 0, 0, 0, 0);
}

static double inverse_depth(double u, double v)
{
    int surface;
    return 1 / scene_depth(&b.scene, &b.scene.views[0], u, v, &surface);
}

static void match_all(void)
{
    struct image photo = {0};
    struct err err = ERR_INIT;
    scene_points(&b.scene, 60);
    assert_int_equal(scene_photo(&b.scene, 0, &photo, &err), ST_OK);
    const struct tone tone = gamma_tone_of(&photo);
    assert_int_equal(gamma_image_make(&b.reference, &photo, tone, &err), ST_OK);
    image_release(&photo);
    assert_int_equal(oversegment(&b.segments, &b.reference, 64, 8, &err), ST_OK);
    assert_int_equal(neighbours_find_points(&b.seen, &b.scene.set, 0, &err), ST_OK);
    assert_int_equal(matcher_init(&b.matcher, &b.segments, &b.reference, &all_neighbours, &err), ST_OK);
    for (int k = 1; k < b.scene.set.view_count; k++) {
        struct gamma_image other = {0};
        assert_int_equal(scene_photo(&b.scene, k, &photo, &err), ST_OK);
        const struct tone own = {fmin(tone.exposure, gamma_tone_of(&photo).exposure), tone.power};
        assert_int_equal(gamma_image_make(&other, &photo, own, &err), ST_OK);
        assert_int_equal(matcher_add(&b.matcher, &b.scene.set, 0, k, &b.seen, 0.25, &b.reference, &other, &err), ST_OK);
        image_release(&photo);
        gamma_image_release(&other);
    }
    b.truth.a = inverse_depth(61, 45) - inverse_depth(60, 45); /* 1/z of a plane is linear in the pixel */
    b.truth.b = inverse_depth(60, 46) - inverse_depth(60, 45);
    b.truth.c = inverse_depth(60, 45) - 60 * b.truth.a - 45 * b.truth.b;
    b.step = 1 / (FOCAL * vec3_length(b.scene.views[1].center));
}

static void finish(void)
{
    matcher_release(&b.matcher);
    neighbours_release_points(&b.seen);
    oversegment_release(&b.segments);
    gamma_image_release(&b.reference);
}

static struct plane off_by(double steps)
{
    struct plane p = b.truth;
    p.c += steps * b.step;
    return p;
}

/* Whether the first neighbour sees the whole segment, even if it is a few steps off. */
static bool well_inside(int segment)
{
    const struct segment *g = &b.segments.segments[segment];
    for (int k = 0; k < 4; k++) {
        const double u = k & 1 ? g->x1 + 1 : g->x0, v = k & 2 ? g->y1 + 1 : g->y0;
        double pu = -1, pv = -1;
        const struct vec3 p = view_unproject(&b.scene.views[0], u, v, 1 / inverse_depth(u, v));
        if (!(view_project(&b.scene.views[1], p, &pu, &pv) > 0)) return false;
        const double margin = 8 * b.scene.views[1].fx / FOCAL;
        if (pu < margin || pv < 3 || pu > b.scene.views[1].width - margin || pv > b.scene.views[1].height - 3)
            return false;
    }
    return true;
}

/* Means over the segments that view 1 sees wholly: the cost of the true plane, the additional cost one step off, and
 * the fraction of segments whose minimum cost is at the truth. */
struct verdict {
    double truth, rise, found;
    int count;
};

static struct verdict judge(void)
{
    struct verdict v = {0};
    for (int i = 0; i < b.segments.count; i++) {
        if (!well_inside(i)) continue;
        const double at = (double)match_cost(&b.matcher, i, b.truth, 0);
        const double one =
            (double)fminf(match_cost(&b.matcher, i, off_by(1), 0), match_cost(&b.matcher, i, off_by(-1), 0));
        bool best = true;
        for (int k = -6; k <= 6; k++) best = best && (k == 0 || (double)match_cost(&b.matcher, i, off_by(k), 0) > at);
        assert_true(at >= 0 && at <= 1);
        v.truth += at;
        v.rise += one - at;
        v.found += best;
        v.count++;
    }
    assert_true(v.count >= 40);
    v.truth /= v.count;
    v.rise /= v.count;
    v.found /= v.count;
    if (getenv("VERDICT"))
        print_message("  truth %.4f  rise %.4f  found %.3f of %d\n", v.truth, v.rise, v.found, v.count);
    return v;
}

static void the_true_plane_has_minimum_cost(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, 0);
    match_all();
    const struct verdict v = judge();
    assert_true(v.truth < 0.1 && v.rise > 0.2 && v.found > 0.98);
    finish();
}

static void a_wrong_slant_raises_the_cost(void **state)
{
    (void)state;
    int slanted = 0, count = 0;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.8, 0, 0, 0);
    match_all();
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        if (!well_inside(i) || g->pixels < 60) continue;
        const struct plane flat = {0, 0, plane_at(b.truth, g->cx, g->cy)};
        slanted += match_cost(&b.matcher, i, b.truth, 0) < match_cost(&b.matcher, i, flat, 0);
        count++;
    }
    assert_true(count > 20 && slanted >= 0.9 * count);
    finish();
}

static void the_rough_cost_approximates_the_full_one(void **state)
{
    (void)state;
    double sum = 0;
    int count = 0;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, 0);
    match_all();
    for (int i = 0; i < b.segments.count; i++)
        for (int k = 0; k < b.segments.segments[i].pixels / 4 - 2;
             k++) { /* pixels of even columns and rows come first */
            const int at = b.matcher.first[i] + k;
            assert_true(((int)b.matcher.x[at] % 2 == 0 && (int)b.matcher.y[at] % 2 == 0) ||
                        k > b.segments.segments[i].pixels / 6);
        }
    for (int i = 0; i < b.segments.count; i++)
        for (int k = -4; well_inside(i) && k <= 4; k++, count++)
            sum +=
                fabs((double)(match_cost(&b.matcher, i, off_by(k), 0) - match_cost_rough(&b.matcher, i, off_by(k), 0)));
    assert_true(sum / count < 0.03);
    finish();
}

static void exposure_and_light_colour_do_not_change_the_cost(void **state)
{
    (void)state;
    static const double gains[] = {0.5, 2, 0.3};
    for (int k = 0; k < 3; k++) {
        start();
        scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, 0);
        b.scene.gain[1] = gains[k];
        match_all();
        const struct verdict v = judge();
        assert_true(v.truth < 0.12 && v.rise > 0.2 && v.found > 0.96);
        finish();
    }
}

/* With too few points to compare colours, normalized gradients decide the match. */
static void a_small_exposure_change_matches_without_points(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, 0);
    b.scene.gain[1] = 0.7;
    match_all();
    struct gamma_image other = {0};
    struct image photo = {0};
    const struct observed_points none = {0};
    struct matcher m = {0};
    assert_int_equal(matcher_init(&m, &b.segments, &b.reference, &all_neighbours, &err), ST_OK);
    assert_int_equal(scene_photo(&b.scene, 1, &photo, &err), ST_OK);
    assert_int_equal(gamma_image_make(&other, &photo, (struct tone){0.5, 0.5}, &err), ST_OK);
    assert_int_equal(matcher_add(&m, &b.scene.set, 0, 1, &none, 0.25, &b.reference, &other, &err), ST_OK);
    matcher_release(&b.matcher);
    b.matcher = m;
    assert_true(judge().found > 0.95);
    image_release(&photo);
    gamma_image_release(&other);
    finish();
}

static void a_finer_neighbour_is_halved(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, 4 * W + 2, 4 * H + 2, 4 * FOCAL, 0.5, 0, 0, 0);
    match_all();
    assert_int_equal(b.matcher.neighbours[0].width, 2 * W / 2 + 0);
    const struct verdict v = judge();
    assert_true(v.truth < 0.15 && v.rise > 0.2 && v.found > 0.97);
    finish();
}

static void a_coarser_neighbour_matches(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, W / 2, H / 2, FOCAL / 2.0, 1, 0, 0, 0);
    match_all();
    b.step *= 2;
    assert_true(judge().found > 0.9);
    finish();
}

static void a_neighbour_rotated_by_90_degrees_matches(void **state)
{
    (void)state;
    start();
    struct view *v = scene_view(&b.scene, H, W, FOCAL, 0.5, 0, 0, 0);
    v->cam_from_world = (struct mat3){{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
    match_all();
    const struct verdict j = judge();
    assert_true(j.truth < 0.12 && j.rise > 0.2 && j.found > 0.97);
    finish();
}

static void a_rotated_and_advanced_neighbour_matches(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.6, 0.1, 0.5, -0.12);
    match_all();
    const struct verdict v = judge();
    assert_true(v.truth < 0.15 && v.found > 0.95);
    finish();
}

static void neighbours_that_do_not_see_the_segment_cost_the_same_for_any_plane(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, M_PI);       /* faces backwards */
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, M_PI / 2.5); /* faces sideways */
    match_all();
    const float unseen = match_cost(&b.matcher, 0, b.truth, 0);
    assert_true(unseen > 0.1f && unseen < 0.9f); /* between a good match and a chance one */
    for (int i = 0; i < b.segments.count; i++)
        for (int k = -1; k <= 1; k++) {
            assert_near(match_cost(&b.matcher, i, off_by(k), 0), unseen, 1e-7);
            assert_near(match_cost_rough(&b.matcher, i, off_by(k), 0), unseen, 1e-7);
        }
    const struct plane behind = {0, 0, -1};
    assert_near(match_cost(&b.matcher, 5, behind, 0), unseen, 1e-7);
    assert_near(match_shift(&b.matcher, 0.1, 0.5), 0, 0);
    finish();
}

static void a_worse_neighbour_has_a_lower_weight(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, 0);
    scene_view(&b.scene, W, H, FOCAL, -0.5, 0, 0, 0);
    b.scene.gain[2] = 0; /* black: all pixels mismatch */
    match_all();
    const struct verdict v = judge();
    assert_true(v.truth > 0.15 && v.truth < 0.35 && v.found > 0.95);
    finish();
}

static void any_plane_has_a_cost_between_0_and_1(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0.1, 3.9, 0.3); /* the wall passes behind it */
    b.scene.holes = true;
    match_all();
    static const double sizes[] = {0, 1e-9, 1e-3, 0.3, 20, 1e6, 1e15, 1e30, 1e300};
    for (int i = 0; i < b.segments.count; i += 7)
        for (int k = 0; k < 9 * 9; k++) {
            const struct plane p = {sizes[k % 9] * (k % 2 ? 1 : -1), -0.5 * sizes[k % 9], sizes[k / 9]};
            const float cost = match_cost(&b.matcher, i, p, 0), half = match_cost_rough(&b.matcher, i, p, 0);
            assert_true(cost >= 0 && cost <= 1 && half >= 0 && half <= 1);
        }
    assert_true(isfinite(match_shift(&b.matcher, 1e-9, 1e9)));
    finish();
}

/* After calibration a good match costs about 0 and a chance one about 1, for any noise; two depths far off are chance
 * matches. Calibrated costs are a linear function of the raw ones. */
static void calibration_maps_good_matches_to_0_and_chance_to_1(void **state)
{
    (void)state;
    static const double contrasts[] = {0.8, 0.2, 0.05};
    struct err err = ERR_INIT;
    for (int c = 0; c < 3; c++) {
        double good = 0, chance = 0, worst_fit = 0;
        int count = 0;
        start();
        b.scene.surfaces[0].contrast = contrasts[c];
        scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, 0);
        match_all();
        static float raw[2][1000];
        assert_true(b.segments.count < 1000);
        for (int i = 0; i < b.segments.count; i++)
            for (int k = 0; k < 2; k++) raw[k][i] = match_cost(&b.matcher, i, off_by(5 * k), 0);
        assert_int_equal(match_calibrate(&b.matcher, 0.15, 0.4, &err), ST_OK);
        assert_true(b.matcher.good_cost >= 0 && b.matcher.chance_cost > b.matcher.good_cost &&
                    b.matcher.chance_cost <= 1);
        for (int i = 0; i < b.segments.count; i++) {
            if (!well_inside(i)) continue;
            const float at = match_cost(&b.matcher, i, b.truth, 0), off = match_cost(&b.matcher, i, off_by(5), 0);
            const float wanted = (raw[1][i] - b.matcher.good_cost) / (b.matcher.chance_cost - b.matcher.good_cost);
            worst_fit = fmax(worst_fit, fabs((double)(off - fminf(wanted, MATCH_WORST))));
            good += (double)at;
            chance += (double)off;
            count++;
        }
        if (getenv("VERDICT")) print_message("  good %.3f chance %.3f\n", good / count, chance / count);
        assert_near(good / count, 0, 0.1);
        assert_near(chance / count, 1, 0.25);
        assert_near(worst_fit, 0, 1e-5);
        finish();
    }
}

/* Neighbours see the view's surface at few of the depths from 10 to 1/3, as they do a strip of a fisheye picture. */
static void views_that_neighbours_see_at_few_depths_are_calibrated(void **state)
{
    struct err err = ERR_INIT;
    double good = 0, chance = 0;
    int count = 0;
    (void)state;
    start();
    scene_view(&b.scene, W, H, FOCAL, 1, 0, 0, 0);
    match_all();
    assert_int_equal(match_calibrate(&b.matcher, 0.1, 3, &err), ST_OK);
    assert_true(b.matcher.good_cost > 0 && b.matcher.chance_cost < 1);
    for (int i = 0; i < b.segments.count; i++) {
        if (b.segments.segments[i].cx < 0.6 * W || !well_inside(i)) continue;
        good += (double)match_cost(&b.matcher, i, b.truth, 0);
        chance += (double)match_cost(&b.matcher, i, off_by(5), 0);
        count++;
    }
    assert_true(count > 10);
    assert_near(good / count, -0.2, 0.3);
    assert_near(chance / count, 1, 0.35);
    finish();
}

/* No visible segment, or no texture: costs stay finite and bounded. */
static void calibration_without_texture_stays_finite(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    for (int which = 0; which < 3; which++) {
        start();
        if (which == 0) b.scene.surfaces[0].contrast = 0;
        scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, which == 1 ? M_PI : 0); /* faces backwards */
        if (which == 2) b.scene.gain[1] = 0;                                 /* black */
        match_all();
        assert_int_equal(match_calibrate(&b.matcher, 0.15, 0.4, &err), ST_OK);
        assert_true(b.matcher.chance_cost - b.matcher.good_cost > 0.01f);
        for (int i = 0; i < b.segments.count; i += 3)
            for (int k = -6; k <= 6; k += 3) {
                const float cost = match_cost(&b.matcher, i, off_by(k), 0);
                assert_true(cost >= MATCH_BEST && cost <= MATCH_WORST);
            }
        finish();
    }
}

/* With raw costs (not calibrated), so that black is equal everywhere. Neighbour 1 is black: it costs less if it is
 * declared occluded; the other one costs more if it is declared occluded. All occluded: a fixed cost between a good
 * match and a chance one, for any plane. */
static void an_occluded_neighbour_costs_a_fixed_amount(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, 0);
    scene_view(&b.scene, W, H, FOCAL, -0.5, 0, 0, 0);
    b.scene.gain[2] = 0;
    match_all();
    const float hidden = match_cost(&b.matcher, 0, b.truth, 3);
    assert_true(hidden > 0.1f && hidden < 1);
    for (int i = 0; i < b.segments.count; i++) {
        for (int k = -9; k <= 9; k += 3) assert_near(match_cost(&b.matcher, i, off_by(k), 3), hidden, 1e-6);
        assert_near(match_cost(&b.matcher, i, (struct plane){1, 2, 3}, 3), hidden,
                    1e-6); /* a plane outside the neighbours' frames */
        assert_near(match_cost_rough(&b.matcher, i, b.truth, 3), hidden, 1e-6);
        if (!well_inside(i)) continue;
        assert_true(match_cost(&b.matcher, i, b.truth, 1) > match_cost(&b.matcher, i, b.truth, 0));
        assert_near(match_cost(&b.matcher, i, b.truth, 4), match_cost(&b.matcher, i, b.truth, 0),
                    0); /* a bit of no neighbour */
    }
    finish();
}

static void the_disparity_of_a_sideways_step_is_focal_length_times_baseline(void **state)
{
    (void)state;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0.5, 0, 0, 0);
    scene_view(&b.scene, W, H, FOCAL, -0.2, 0, 0, 0);
    match_all();
    assert_near(match_shift(&b.matcher, 0.2, 0.35), FOCAL * 0.5 * 0.15, 1e-9);
    assert_near(match_shift(&b.matcher, 0.2, 0.2), 0, 1e-9);
    finish();
}

static void pictures_of_one_pixel_and_of_none_are_matched(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct image photo = {0};
        struct err err = ERR_INIT;
        struct gamma_image other = {0};
        memset(&b, 0, sizeof b);
        scene_wall(&b.scene, 0, 0, 4, 6, 6, 0);
        for (int i = 0; i < 2; i++) scene_view(&b.scene, 1 + 2 * k, 1 + 2 * k, 1, 0.5 * i, 0, 0, 0);
        assert_int_equal(scene_photo(&b.scene, 0, &photo, &err), ST_OK);
        for (int i = 0; k && i < 9; i++) photo.data[4 * i + 3] = 0;
        assert_int_equal(gamma_image_make(&b.reference, &photo, (struct tone){1, 0.5}, &err), ST_OK);
        assert_int_equal(gamma_image_make(&other, &photo, (struct tone){1, 0.5}, &err), ST_OK);
        assert_int_equal(oversegment(&b.segments, &b.reference, 64, 8, &err), ST_OK);
        assert_int_equal(matcher_init(&b.matcher, &b.segments, &b.reference, &all_neighbours, &err), ST_OK);
        assert_int_equal(matcher_add(&b.matcher, &b.scene.set, 0, 1, &b.seen, 0.25, &b.reference, &other, &err), ST_OK);
        assert_int_equal(b.segments.count, k ? 0 : 1);
        if (!k) assert_near(match_cost(&b.matcher, 0, (struct plane){0, 0, 0.25}, 0), 0, 1e-3);
        image_release(&photo);
        gamma_image_release(&other);
        finish();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_true_plane_has_minimum_cost),
        cmocka_unit_test(a_wrong_slant_raises_the_cost),
        cmocka_unit_test(the_rough_cost_approximates_the_full_one),
        cmocka_unit_test(exposure_and_light_colour_do_not_change_the_cost),
        cmocka_unit_test(a_small_exposure_change_matches_without_points),
        cmocka_unit_test(a_finer_neighbour_is_halved),
        cmocka_unit_test(a_coarser_neighbour_matches),
        cmocka_unit_test(a_neighbour_rotated_by_90_degrees_matches),
        cmocka_unit_test(a_rotated_and_advanced_neighbour_matches),
        cmocka_unit_test(neighbours_that_do_not_see_the_segment_cost_the_same_for_any_plane),
        cmocka_unit_test(a_worse_neighbour_has_a_lower_weight),
        cmocka_unit_test(any_plane_has_a_cost_between_0_and_1),
        cmocka_unit_test(calibration_maps_good_matches_to_0_and_chance_to_1),
        cmocka_unit_test(views_that_neighbours_see_at_few_depths_are_calibrated),
        cmocka_unit_test(calibration_without_texture_stays_finite),
        cmocka_unit_test(an_occluded_neighbour_costs_a_fixed_amount),
        cmocka_unit_test(the_disparity_of_a_sideways_step_is_focal_length_times_baseline),
        cmocka_unit_test(pictures_of_one_pixel_and_of_none_are_matched),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
