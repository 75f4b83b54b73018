/* flow_match.c - flow of synthetic pairs: soft epipolar term, occlusion, and degenerate cases. */
#include "../scratch.h"
#include "made_pair.h"
#include "stages/morph_views/morph.h"

struct flows {
    struct image linear[2], matched_images[2];
    struct flow flow[2];
};

static void release(struct flows *f)
{
    for (int i = 0; i < 2; i++) {
        image_release(&f->linear[i]);
        image_release(&f->matched_images[i]);
        flow_release(&f->flow[i]);
    }
}

static void match(struct flows *f, const struct pair_geometry *g, const struct morph_params *params)
{
    struct err err = ERR_INIT;
    for (int i = 0; i < 2; i++) assert_ok(match_image(&f->matched_images[i], &f->linear[i], &err), err);
    assert_ok(match_pictures(f->flow, f->matched_images, g, NULL, 0, params, &err), err);
    for (int i = 0; i < 2; i++)
        for (int p = 0; p < 2 * MADE_WIDTH * MADE_HEIGHT; p++) assert_true(isfinite(f->flow[i].uv[p]));
}

static void make(struct flows *f, const struct made_pair *pair)
{
    struct err err = ERR_INIT;
    *f = (struct flows){0};
    for (int i = 0; i < 2; i++) {
        assert_ok(image_init(&f->linear[i], MADE_WIDTH, MADE_HEIGHT, 3, &err), err);
        made_picture(&f->linear[i], pair, i);
    }
}

/* Makes a pair and matches it with default parameters. */
static void make_and_match(struct flows *f, const struct made_pair *pair, const struct pair_geometry *g)
{
    const struct morph_params params = MORPH_PARAMS_DEFAULT;
    make(f, pair);
    match(f, g, &params);
}

static double confident_fraction(const struct flow *f)
{
    double confident = 0;
    for (int p = 0; p < MADE_WIDTH * MADE_HEIGHT; p++) confident += f->confidence[p] >= 0.5f;
    return confident / (MADE_WIDTH * MADE_HEIGHT);
}

static void assert_still(const struct flow *f)
{
    for (int p = 0; p < 2 * MADE_WIDTH * MADE_HEIGHT; p++) assert_true(fabsf(f->uv[p]) < 1e-3f);
    assert_true(confident_fraction(f) == 1);
}

static void assert_right(const struct flows *f, const struct made_pair *pair, double within)
{
    assert_true(made_right(&f->flow[0], pair, false, within) > 0.95);
    assert_true(made_right(&f->flow[0], pair, true, within) > 0.95);
}

static void a_static_scene_is_matched_with_subpixel_precision(void **state)
{
    const struct made_pair pair = {{-4.4, 0}, {-11.7, 0}, true, 1};
    const struct pair_geometry g = made_side_by_side();
    struct flows f;
    (void)state;
    make_and_match(&f, &pair, &g);
    assert_right(&f, &pair, 0.35);
    release(&f);
}

static void motion_off_the_epipolar_line_is_matched_by_a_soft_term_only(void **state)
{
    const struct made_pair pair = {{-5, 0}, {-11, 9}, true, 1};
    struct morph_params params = MORPH_PARAMS_DEFAULT;
    const struct pair_geometry g = made_side_by_side();
    struct flows f;
    (void)state;
    make_and_match(&f, &pair, &g);
    assert_right(&f, &pair, 0.5);
    for (int i = 0; i < 2; i++) flow_release(&f.flow[i]);
    for (int i = 0; i < 2; i++) image_release(&f.matched_images[i]);
    params.epipolar = 10; /* more than any data cost */
    params.epipolar_width = 1;
    match(&f, &g, &params);
    assert_true(made_right(&f.flow[0], &pair, true, 0.5) < 0.05);
    release(&f);
}

static void occluded_pixels_move_with_the_far_side(void **state)
{
    const struct made_pair pair = {{-4, 0}, {-14, 0}, true, 1};
    const struct pair_geometry g = made_side_by_side();
    struct flows f;
    int far = 0, count = 0;
    (void)state;
    make_and_match(&f, &pair, &g);
    for (int y = 48; y < 78; y++) /* in the second picture the square covers ten columns to its left */
        for (int x = 52; x < 58; x++, count++) far += fabsf(f.flow[0].uv[2 * (y * MADE_WIDTH + x)] + 4) < 1.5f;
    assert_true(far > 0.8 * count);
    release(&f);
}

static void identical_photos_have_zero_flow(void **state)
{
    const struct made_pair pair = {{0, 0}, {0, 0}, false, 1};
    const struct pair_geometry g = {.kind = EPIPOLAR_NONE};
    struct flows f;
    (void)state;
    make_and_match(&f, &pair, &g);
    assert_still(&f.flow[0]);
    release(&f);
}

static void a_textureless_pair_has_zero_flow(void **state)
{
    const struct made_pair pair = {{0, 0}, {0, 0}, false, 1};
    const struct morph_params params = MORPH_PARAMS_DEFAULT;
    const struct pair_geometry g = {.kind = EPIPOLAR_NONE};
    struct flows f;
    (void)state;
    make(&f, &pair);
    for (int i = 0; i < 2; i++)
        for (int p = 0; p < 3 * MADE_WIDTH * MADE_HEIGHT; p++) f.linear[i].data[p] = 0.3f;
    match(&f, &g, &params);
    assert_still(&f.flow[0]);
    release(&f);
}

static void a_black_picture_is_accepted(void **state)
{
    const struct made_pair pair = {{0, 0}, {0, 0}, false, 0}; /* the second picture is black */
    const struct pair_geometry g = {.kind = EPIPOLAR_NONE};
    struct flows f;
    (void)state;
    make_and_match(&f, &pair, &g);
    release(&f);
}

static void a_different_exposure_is_matched_and_measured(void **state)
{
    const struct made_pair pair = {{-6, 0}, {-13, 0}, true, 0.4};
    const struct pair_geometry g = made_side_by_side();
    struct flows f;
    (void)state;
    make_and_match(&f, &pair, &g);
    assert_right(&f, &pair, 0.5);
    struct morph m = {.pictures = {f.linear[0], f.linear[1]}, .flows = {f.flow[0], f.flow[1]}};
    morph_find_gain(&m);
    for (int c = 0; c < 3; c++) assert_true(fabs(m.gain[c] - 0.4) < 0.02);
    release(&f);
}

/* Film pixels equal photo pixels; the camera is not rotated. */
static const struct film_picture same_pixels = {.photo_from_film = {{1, 0, 0}, {0, 1, 0}},
                                                .film_from_photo = {{1, 0, 0}, {0, 1, 0}}};
static const struct mat3 unturned = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static void a_pure_rotation_is_matched_without_epipolar_lines(void **state)
{
    const double focal = 200, angle = 0.05; /* about the vertical, 10 px */
    const struct made_pair pair = {{0, 0}, {0, 0}, false, 1};
    const struct morph_params params = MORPH_PARAMS_DEFAULT;
    const struct camera lens = {
        CAMERA_PINHOLE, MADE_WIDTH, MADE_HEIGHT, {focal, focal, MADE_WIDTH / 2., MADE_HEIGHT / 2.}};
    const struct mat3 turn = {{{cos(angle), 0, -sin(angle)}, {0, 1, 0}, {sin(angle), 0, cos(angle)}}};
    const struct pair_geometry g = {.kind = EPIPOLAR_POSED,
                                    .width = MADE_WIDTH,
                                    .height = MADE_HEIGHT,
                                    .photos = {{lens, unturned, {0, 0, 0}, 1, 10}, {lens, turn, {0, 0, 0}, 1, 10}},
                                    .films = {&same_pixels, &same_pixels}};
    struct epipolar_line line;
    struct flows f;
    int right = 0, count = 0;
    (void)state;
    assert_false(epipolar_line_at(&g, 0, 80, 60, NULL, &line));
    make(&f, &pair);
    for (int y = 0; y < MADE_HEIGHT; y++)
        for (int x = 0; x < MADE_WIDTH; x++) {
            struct vec3 ray = {(x + 0.5 - MADE_WIDTH / 2.) / focal, (y + 0.5 - MADE_HEIGHT / 2.) / focal, 1};
            struct vec3 p = mat3_apply(mat3_transpose(turn), ray);
            double u = focal * p.x / p.z + MADE_WIDTH / 2. - 0.5, v = focal * p.y / p.z + MADE_HEIGHT / 2. - 0.5;
            for (int c = 0; c < 3; c++) image_at(&f.linear[1], x, y)[c] = (float)made_texture(u, v, 7 * c);
        }
    match(&f, &g, &params);
    for (int y = 24; y < MADE_HEIGHT - 24; y++)
        for (int x = 24; x < MADE_WIDTH - 24; x++, count++) {
            struct vec3 ray = {(x + 0.5 - MADE_WIDTH / 2.) / focal, (y + 0.5 - MADE_HEIGHT / 2.) / focal, 1};
            struct vec3 p = mat3_apply(turn, ray);
            const float *uv = f.flow[0].uv + 2 * (y * MADE_WIDTH + x);
            right += hypot(focal * p.x / p.z + MADE_WIDTH / 2. - 0.5 - x - uv[0],
                           focal * p.y / p.z + MADE_HEIGHT / 2. - 0.5 - y - uv[1]) < 0.5;
        }
    assert_true(right > 0.95 * count);
    release(&f);
}

static void lines_from_cameras_and_from_the_fundamental_matrix_agree(void **state)
{
    const double focal = 200;
    const struct camera lens = {
        CAMERA_PINHOLE, MADE_WIDTH, MADE_HEIGHT, {focal, focal, MADE_WIDTH / 2., MADE_HEIGHT / 2.}};
    const struct pair_geometry g = {
        .kind = EPIPOLAR_POSED,
        .photos = {{lens, unturned, {0, 0, 0}, 2, 50}, {lens, unturned, {-0.2, 0, 0}, 2, 50}},
        .films = {&same_pixels, &same_pixels}};
    const struct pair_geometry f = made_side_by_side();
    (void)state;
    for (int from = 0; from < 2; from++)
        for (int k = 0; k < 5; k++) {
            struct epipolar_line a, b;
            assert_true(epipolar_line_at(&g, from, 20 + 25 * k, 11 + 20 * k, NULL, &a));
            assert_true(epipolar_line_at(&f, from, 20 + 25 * k, 11 + 20 * k, NULL, &b));
            assert_true(fabsf(a.dx - b.dx) < 1e-4f && fabsf(a.dy - b.dy) < 1e-4f && fabsf(a.c - b.c) < 1e-3f);
            assert_true(a.dx ==
                        (from ? 1 : -1)); /* nearer is to the left in the second picture, to the right in the first */
        }
}

static void with_lens_distortion_a_line_is_the_tangent_of_the_curve(void **state)
{
    const struct camera lens = {
        CAMERA_SIMPLE_RADIAL, MADE_WIDTH, MADE_HEIGHT, {150, MADE_WIDTH / 2., MADE_HEIGHT / 2., -0.3}};
    const struct pair_geometry g = {
        .kind = EPIPOLAR_POSED,
        .photos = {{lens, unturned, {0, 0, 0}, 1, 100}, {lens, unturned, {-0.5, 0, 0}, 1, 100}},
        .films = {&same_pixels, &same_pixels}};
    struct vec3 ray;
    double at[2], worst = 0, chord = 0;
    (void)state;
    assert_true(camera_unproject(&lens, 130, 100, &ray));
    for (double z = 1.1; z < 20; z *= 1.3) {
        struct vec3 p = vec3_scale(ray, z / ray.z);
        struct epipolar_line line;
        assert_true(camera_project(&lens, vec3_add(p, vec3_make(-0.5, 0, 0)), &at[0], &at[1]));
        assert_true(epipolar_line_at(&g, 0, 130, 100, at, &line));
        worst = fmax(worst, fabs(line.dx * at[1] - line.dy * at[0] + line.c));
        assert_true(epipolar_line_at(&g, 0, 130, 100, NULL, &line));
        chord = fmax(chord, fabs(line.dx * at[1] - line.dy * at[0] + line.c));
    }
    assert_true(worst < 0.05);
    assert_true(chord > 0.5); /* the chord would be wrong */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_static_scene_is_matched_with_subpixel_precision),
        cmocka_unit_test(motion_off_the_epipolar_line_is_matched_by_a_soft_term_only),
        cmocka_unit_test(occluded_pixels_move_with_the_far_side),
        cmocka_unit_test(identical_photos_have_zero_flow),
        cmocka_unit_test(a_textureless_pair_has_zero_flow),
        cmocka_unit_test(a_black_picture_is_accepted),
        cmocka_unit_test(a_different_exposure_is_matched_and_measured),
        cmocka_unit_test(a_pure_rotation_is_matched_without_epipolar_lines),
        cmocka_unit_test(with_lens_distortion_a_line_is_the_tangent_of_the_curve),
        cmocka_unit_test(lines_from_cameras_and_from_the_fundamental_matrix_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
