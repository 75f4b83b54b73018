/* defocus.c - depth of field by a MIP map, compared with an average over the lens. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/image/exr.h"
#include "stages/render_views/aperture.h"
#include "stages/render_views/defocus.h"

#define W 180
#define H 120

/* A wall, and in front of it a board, a half plane with a slanted edge or a square; uniform or with a pattern. */
struct world {
    double wall, board;
    bool square;
    float wall_color, board_color; /* 0: a pattern */
};

static double pattern(double x, double y)
{
    return 0.4 + 0.2 * sin(13 * x) * cos(9 * y) + (sin(5 * x + 7 * y) > 0.6 ? 0.4 : 0);
}

static bool on_board(const struct world *w, double x, double y)
{
    return w->square ? fabs(x) < 0.25 * w->board && fabs(y) < 0.2 * w->board : x + 0.2 * y < 0;
}

static enum status draw(void *ctx, const struct view *camera, struct rendered_frame *out, struct err *err)
{
    const struct world *w = ctx;

    if (rendered_frame_resize(out, camera->width, camera->height, true, err)) return err->status;
    memset(out->hole, 0, (size_t)out->width * (size_t)out->height);
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++) {
            float *c = out->rgba + 4 * (y * out->width + x);
            double sum = 0;
            int near = 0;
            for (int i = 0; i < 4; i++) {
                const double u = x + (i % 2 + 0.5) / 2, v = y + (i / 2 + 0.5) / 2;
                const struct vec3 a = view_unproject(camera, u, v, w->board), b = view_unproject(camera, u, v, w->wall);
                const bool hit = w->board > 0 && on_board(w, a.x, a.y);
                near += hit;
                if (hit)
                    sum += w->board_color > 0 ? w->board_color : pattern(3 * a.x / w->board + 5, 3 * a.y / w->board);
                else
                    sum += w->wall_color > 0 ? w->wall_color : pattern(3 * b.x / w->wall, 3 * b.y / w->wall);
            }
            for (int k = 0; k < 3; k++) c[k] = (float)(sum / 4 * (1 - 0.2 * k));
            c[3] = 1;
            out->z[y * out->width + x] = (float)(near > 1 ? w->board : w->wall);
        }
    return ST_OK;
}

static struct view a_camera(void)
{
    struct view v = {.name = "0001", .width = W, .height = H, .fx = 150, .fy = 150, .cx = W / 2.0, .cy = H / 2.0};
    v.cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return v;
}

static double psnr(const struct rendered_frame *a, const struct rendered_frame *b)
{
    double sum = 0;
    for (int i = 0; i < 4 * W * H; i++) sum += i % 4 < 3 ? pow(sqrt(a->rgba[i]) - sqrt(b->rgba[i]), 2) : 0;
    return -10 * log10(sum / (3 * W * H) + 1e-20);
}

static void show(const char *name, const struct rendered_frame *f)
{
    const char *folder = getenv("DEFOCUS_SHOW");
    struct exr_image im = {0};
    struct exr_plane *plane;
    struct err err = ERR_INIT;
    char path[4096];

    if (!folder) return;
    snprintf(path, sizeof path, "%s/%s.exr", folder, name);
    assert_ok(exr_image_init(&im, f->width, f->height, &err), err);
    for (int k = 0; k < 4; k++) {
        assert_ok(exr_add_plane(&im, &"R\0G\0B\0A"[2 * k], EXR_HALF, &plane, &err), err);
        for (int p = 0; p < f->width * f->height; p++) plane->f[p] = f->rgba[4 * p + k];
    }
    assert_ok(exr_write(&im, path, NULL, &err), err);
    exr_image_release(&im);
}

static void the_blur_is_close_to_a_lens_average(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        struct world world;
        double aperture, focus, min_psnr, min_gain; /* dB: of the blurred frame, and more than the sharp frame's */
    } cases[] = {
        {"near-blurred", {4, 1.5, true, 0, 0}, 0.12, 4, 42, 9},
        {"far-blurred", {4, 1.5, true, 0, 0}, 0.3, 1.5, 32, 9},
        {"edge-near", {4, 1.5, false, 0, 0.9f}, 0.15, 4, 42, 9},
        {"edge-far", {4, 1.5, false, 0, 0.9f}, 0.3, 1.5, 32, 9},
        {"both-behind", {8, 2, true, 0, 0.9f}, 0.2, 1, 30, 9},
        {"both-before", {2, 1.5, true, 0, 0.9f}, 0.2, 8, 35, 9},
        {"hardly-near", {4, 1.5, true, 0, 0.9f}, 0.2, 4.2, 36, 9}, /* the wall is in front of the focus, too */
        {"between", {6, 1.2, true, 0, 0}, 0.15, 2.2, 35, 8},
    };
    const struct view v = a_camera();
    const struct aperture_options options = {64, 0};
    struct rendered_frame sharp = {0}, fast = {0}, slow = {0};
    struct defocus d = {0};

    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct world w = cases[i].world;
        struct err err = ERR_INIT;
        char name[64];
        assert_ok(draw(&w, &v, &sharp, &err), err);
        assert_ok(draw(&w, &v, &fast, &err), err);
        assert_ok(aperture_render(&slow, &v, cases[i].aperture, cases[i].focus, &options, draw, &w, NULL, &err), err);
        assert_ok(defocus_apply(&d, &fast, &v, cases[i].aperture, cases[i].focus, &err), err);
        const double with = psnr(&fast, &slow), without = psnr(&sharp, &slow);
        if (getenv("DEFOCUS_SHOW")) print_message("%s: %.1f dB, without blur %.1f\n", cases[i].name, with, without);
        snprintf(name, sizeof name, "%s-sharp", cases[i].name), show(name, &sharp);
        snprintf(name, sizeof name, "%s-fast", cases[i].name), show(name, &fast);
        snprintf(name, sizeof name, "%s-slow", cases[i].name), show(name, &slow);
        if (getenv("DEFOCUS_SHOW")) continue;
        assert_true(with > cases[i].min_psnr && with > without + cases[i].min_gain);
    }
    rendered_frame_release(&sharp);
    rendered_frame_release(&fast);
    rendered_frame_release(&slow);
    defocus_release(&d);
}

/* A board and a wall of the same grey, at any depths, stay uniform. A bright board on a dark wall: no pixel is darker
 * or brighter than both. */
static void silhouettes_have_no_fringes(void **state)
{
    (void)state;
    const struct view v = a_camera();
    const double focus[] = {0.8, 1.5, 2.2, 4, 9};
    struct rendered_frame f = {0};
    struct defocus d = {0};

    for (int i = 0; i < 10; i++) {
        struct world w = {4, 1.5, i & 1, 0.5f, i < 5 ? 0.5f : 0.9f};
        struct err err = ERR_INIT;
        assert_ok(draw(&w, &v, &f, &err), err);
        assert_ok(defocus_apply(&d, &f, &v, 0.2, focus[i % 5], &err), err);
        for (int p = 0; p < 4 * W * H; p++) {
            const float scale = p % 4 < 3 ? 1 - 0.2f * (float)(p % 4) : 1;
            assert_true(f.rgba[p] >= (p % 4 < 3 ? 0.5f * scale : 1) - 1e-5f);
            assert_true(f.rgba[p] <= (p % 4 < 3 ? w.board_color * scale : 1) + 1e-5f);
        }
    }
    rendered_frame_release(&f);
    defocus_release(&d);
}

/* Including unknown, extreme and random depths. */
static void a_uniform_picture_stays_uniform_at_any_depth(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {2, 1}, {1, 7}, {13, 11}, {33, 64}, {200, 3}};
    struct defocus d = {0};

    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        struct view v = a_camera();
        struct rendered_frame f = {0};
        struct err err = ERR_INIT;
        const int w = sizes[s][0], h = sizes[s][1];
        v.width = w, v.height = h;
        assert_ok(rendered_frame_resize(&f, w, h, true, &err), err);
        for (int i = 0; i < w * h; i++) {
            const float depths[] = {0, 1e-30f, 0.5f, 0.99f, 1, 1.01f, 3, 1e30f};
            for (int k = 0; k < 4; k++) f.rgba[4 * i + k] = k < 3 ? 1000 : 1;
            f.z[i] = depths[(i * 5 + i / 7) % 8];
            f.hole[i] = 0;
        }
        assert_ok(defocus_apply(&d, &f, &v, 0.1, 1, &err), err);
        for (int i = 0; i < 4 * w * h; i++) assert_true(fabsf(f.rgba[i] - (i % 4 < 3 ? 1000 : 1)) <= 1e-5f * 1000);
        rendered_frame_release(&f);
    }
    defocus_release(&d);
}

/* The blur of a dot of light has the variance of a disk, is centred, and keeps the energy. */
static void a_dot_has_the_variance_of_its_circle_of_confusion(void **state)
{
    (void)state;
    const struct view v = a_camera();
    struct rendered_frame f = {0};
    struct defocus d = {0};
    struct err err = ERR_INIT;

    for (int i = 0; i < 12; i++) {
        const double diameter = 1 + 2 * i, focus = i & 1 ? 1 : 4,
                     z = i & 1 ? 4 : 1; /* behind the focus, in front of it */
        const int at[2] = {W / 2 + i, H / 2 - i};
        double sum = 0, mean[2] = {0}, square[2] = {0};
        assert_ok(rendered_frame_resize(&f, W, H, true, &err), err);
        for (int p = 0; p < W * H; p++) {
            for (int k = 0; k < 4; k++) f.rgba[4 * p + k] = k < 3 ? p == at[1] * W + at[0] : 1;
            f.z[p] = (float)z;
            f.hole[p] = 0;
        }
        assert_ok(defocus_apply(&d, &f, &v, diameter * z * focus / (v.fx * fabs(z - focus)), focus, &err), err);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                const double light = f.rgba[4 * (y * W + x)], dx = x - at[0], dy = y - at[1];
                sum += light;
                mean[0] += light * dx, mean[1] += light * dy;
                square[0] += light * dx * dx, square[1] += light * dy * dy;
            }
        assert_true(fabs(sum - 1) < 1e-3);
        for (int k = 0; k < 2; k++) {
            assert_true(fabs(mean[k]) < 1e-3);
            assert_true(fabs(square[k] - diameter * diameter / 16) < 0.01 * diameter * diameter + 1e-3);
        }
    }
    rendered_frame_release(&f);
    defocus_release(&d);
}

/* A white board in focus does not bleed into a black wall out of focus, and keeps its own pixels. */
static void surfaces_in_focus_stay_sharp_and_do_not_bleed(void **state)
{
    (void)state;
    const struct view v = a_camera();
    struct rendered_frame f = {0};
    struct defocus d = {0};
    struct err err = ERR_INIT;

    assert_ok(rendered_frame_resize(&f, W, H, true, &err), err);
    for (int p = 0; p < W * H; p++) {
        const bool board = p % W > 50 && p % W < 110 && p / W > 20 && p / W < 80;
        for (int k = 0; k < 4; k++) f.rgba[4 * p + k] = k == 3 || board;
        f.z[p] = board ? 1 : 10;
        f.hole[p] = 0;
    }
    assert_ok(defocus_apply(&d, &f, &v, 0.1, 1, &err), err); /* the wall's circle of confusion is 13.5 px */
    for (int p = 0; p < W * H; p++) {
        const bool board = p % W > 50 && p % W < 110 && p / W > 20 && p / W < 80;
        if (board)
            assert_true(f.rgba[4 * p] == 1);
        else
            assert_true(f.rgba[4 * p] < 0.05f);
    }
    rendered_frame_release(&f);
    defocus_release(&d);
}

static void aperture_0_changes_nothing(void **state)
{
    (void)state;
    const struct view v = a_camera();
    struct world w = {4, 1.5, true, 0, 0};
    struct rendered_frame f = {0}, sharp = {0};
    struct defocus d = {0};
    struct err err = ERR_INIT;

    assert_ok(draw(&w, &v, &f, &err), err);
    assert_ok(draw(&w, &v, &sharp, &err), err);
    assert_ok(defocus_apply(&d, &f, &v, 0, 0, &err), err);
    assert_memory_equal(f.rgba, sharp.rgba, 4 * W * H * sizeof(float));
    const double bad[][2] = {{-1, 2}, {NAN, 2}, {INFINITY, 2}, {0.1, 0}, {0.1, -2}, {0.1, NAN}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err why = ERR_INIT;
        assert_int_equal(defocus_apply(&d, &f, &v, bad[i][0], bad[i][1], &why), ST_DATA);
        assert_err(why, ST_DATA, "frame 0001");
    }
    assert_memory_equal(f.rgba, sharp.rgba, 4 * W * H * sizeof(float));
    rendered_frame_release(&f);
    rendered_frame_release(&sharp);
}

static void any_thread_count_gives_the_same_bits(void **state)
{
    (void)state;
    const struct view v = a_camera();
    const int threads = parallel_threads();
    struct world w = {6, 1.2, true, 0, 0};
    struct rendered_frame f[2] = {{0}};
    struct err err = ERR_INIT;

    for (int i = 0; i < 2; i++) {
        struct defocus d = {0};
        parallel_set_threads(1 + 2 * i);
        assert_ok(draw(&w, &v, &f[i], &err), err);
        assert_ok(defocus_apply(&d, &f[i], &v, 0.2, 2, &err), err);
        defocus_release(&d);
    }
    parallel_set_threads(threads);
    assert_memory_equal(f[0].rgba, f[1].rgba, 4 * W * H * sizeof(float));
    for (int i = 0; i < 2; i++) rendered_frame_release(&f[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_blur_is_close_to_a_lens_average),
        cmocka_unit_test(silhouettes_have_no_fringes),
        cmocka_unit_test(a_uniform_picture_stays_uniform_at_any_depth),
        cmocka_unit_test(a_dot_has_the_variance_of_its_circle_of_confusion),
        cmocka_unit_test(surfaces_in_focus_stay_sharp_and_do_not_bleed),
        cmocka_unit_test(aperture_0_changes_nothing),
        cmocka_unit_test(any_thread_count_gives_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
