/* renderer.c - finished frames of a path, with filled holes, depth of field and effect layers, in any order. */
#include "tests/unit/common/layers/formula_scene.h"
#include "tests/unit/scratch.h"

#include "common/base/parallel.h"
#include "stages/render_views/renderer.h"

enum { FRAMES = 7 };

struct film {
    struct scene scene;
    struct camera_path path;
    struct effects effects;
    struct render_params params;
};

static const struct shape square = {square_depth, true, 0.01};

/* Three views of the square, and a path across them with holes beside the square; an opening lens, and effect
 * layers. */
static void film_make(struct film *film, const char *renderer, bool lens, bool layers)
{
    static const double centers[][3] = {{0, -0.1, 0}, {0.1, 0.1, 0}, {-0.05, 0.1, 0}};
    const struct render_params usual = RENDER_PARAMS_DEFAULT;
    struct err err = ERR_INIT;

    memset(film, 0, sizeof *film);
    scene_make(&film->scene, &square, centers, 3);
    film->params = usual;
    snprintf(film->params.renderer, sizeof film->params.renderer, "%s", renderer);
    film->params.fill_anchor_spacing = 3;
    film->params.aperture_samples = 12;
    assert_ok(camera_path_init(&film->path, "test", 30, FRAMES, &err), err);
    for (int i = 0; i < FRAMES; i++) {
        struct path_frame *f = &film->path.frames[i];
        const char *name = f->camera.name;
        f->camera = view_at(0.1 * i - 0.3, 0.02 * i, 0.05 * i);
        f->camera.name = name;
        f->aperture = lens ? 0.05 * i : 0; /* 0 in the first frame */
        f->focus = lens && i ? 3 : 0;
    }
    if (!layers) return;
    static const char text[] = "remodel-effects 1\n"
                               "layer grey saturation\n"
                               "region outside -0.5 -0.5 2.5 0.5 0.5 3.5 0.2\n"
                               "key 0 1\n"
                               "key 0.2 0\n";
    assert_ok(effects_read(&film->effects, scratch_write("effects.txt", text), NULL, &err), err);
}

static void film_drop(struct film *film)
{
    layer_scene_release(&film->scene.layers);
    camera_path_release(&film->path);
    effects_release(&film->effects);
}

static void start(struct renderer *r, const struct film *film)
{
    renderer_init(r, &film->scene.layers, &film->path, &film->effects, &film->params);
}

static void assert_same(const struct rendered_frame *a, const struct rendered_frame *b)
{
    const size_t pixels = (size_t)a->width * (size_t)a->height;
    assert_true(a->width == b->width && a->height == b->height);
    assert_memory_equal(a->rgba, b->rgba, pixels * 4 * sizeof *a->rgba);
    assert_memory_equal(a->z, b->z, pixels * sizeof *a->z);
    assert_memory_equal(a->hole, b->hole, pixels);
    assert_true(a->hole_fraction == b->hole_fraction && a->unfilled_fraction == b->unfilled_fraction);
}

/* Renders all frames in order, then backwards, one by one with a new renderer each, and with another thread count. */
static void check_splits(const struct film *film)
{
    static const int ranges[][2] = {{5, 7}, {2, 5}, {0, 2}};
    const int threads = parallel_threads();
    struct rendered_frame whole[FRAMES] = {0}, f = {0};
    struct renderer r;
    struct err err = ERR_INIT;

    parallel_set_threads(1);
    start(&r, film);
    for (int i = 0; i < FRAMES; i++) {
        assert_ok(renderer_frame(&r, i, &whole[i], &err), err);
        frame_is_finite(&whole[i]);
        assert_true(whole[i].hole_fraction < 0.5 && (whole[i].hole_fraction > 0.01 || i > 1));
        assert_true(whole[i].unfilled_fraction == 0);
    }
    renderer_release(&r);
    parallel_set_threads(2);
    for (int n = 0; n < 3; n++) {
        start(&r, film);
        for (int i = ranges[n][0]; i < ranges[n][1]; i++) {
            assert_ok(renderer_frame(&r, i, &f, &err), err);
            assert_same(&f, &whole[i]);
        }
        renderer_release(&r);
    }
    start(&r, film);
    for (int i = FRAMES - 1; i >= 0; i -= 2) {
        assert_ok(renderer_frame(&r, i, &f, &err), err);
        assert_same(&f, &whole[i]);
    }
    renderer_release(&r);
    parallel_set_threads(threads);
    rendered_frame_release(&f);
    for (int i = 0; i < FRAMES; i++) rendered_frame_release(&whole[i]);
}

static void ranges_of_frames_give_the_same_bytes(void **state)
{
    struct film film;
    film_make(&film, *state, false, false);
    check_splits(&film);
    film_drop(&film);
}

static void ranges_with_lens_and_effects_give_the_same_bytes(void **state)
{
    struct film film;
    film_make(&film, *state, true, true);
    check_splits(&film);
    film_drop(&film);
}

static void effects_and_lens_change_only_their_regions(void **state)
{
    struct film film, plain;
    struct renderer r;
    struct rendered_frame with = {0}, without = {0};
    struct err err = ERR_INIT;
    double inside = 0, outside = 0;

    film_make(&film, *state, false, true);
    film_make(&plain, *state, false, false);
    start(&r, &film);
    assert_ok(renderer_frame(&r, FRAMES - 1, &with, &err), err); /* at 0.2 s: grey except for the square */
    renderer_release(&r);
    start(&r, &plain);
    assert_ok(renderer_frame(&r, FRAMES - 1, &without, &err), err);
    renderer_release(&r);
    assert_memory_equal(with.z, without.z, sizeof *with.z * W * H);
    for (int p = 0; p < W * H; p++) {
        const float *a = with.rgba + 4 * p, *b = without.rgba + 4 * p;
        const double change = fabs((double)(a[0] - b[0])) + fabs((double)(a[2] - b[2]));
        if (with.hole[p]) continue;
        if (with.z[p] < 4)
            inside = fmax(inside, change);
        else
            outside += change / (W * H);
    }
    assert_true(inside < 2e-3 && outside > 0.05); /* the square's edge is up to half a pixel outside of the box */
    film_drop(&plain);

    /* focused at the square, the lens blurs the wall but not the square */
    film_make(&plain, *state, true, false);
    start(&r, &plain);
    assert_ok(renderer_frame(&r, FRAMES - 1, &with, &err), err);
    double sharp = 0, blurred = 0, changed = 0;
    for (int y = 5; y < H - 5; y++)
        for (int x = 5; x < W - 5; x++) {
            const int p = y * W + x;
            if (without.z[p] > 4 && without.z[p - 1] > 4) {
                sharp += fabs((double)(without.rgba[4 * p] - without.rgba[4 * p - 4]));
                blurred += fabs((double)(with.rgba[4 * p] - with.rgba[4 * p - 4]));
            }
            if (fabs(plain.path.frames[FRAMES - 1].camera.center.x + (x + 0.5 - W / 2.0) / FOCAL * 2.7) < 0.35 &&
                fabs(plain.path.frames[FRAMES - 1].camera.center.y + (y + 0.5 - H / 2.0) / FOCAL * 2.7) < 0.35)
                changed = fmax(changed, fabs((double)(with.rgba[4 * p] - without.rgba[4 * p])));
        }
    assert_true(blurred < 0.9 * sharp);
    assert_true(changed < 0.12);
    renderer_release(&r);
    rendered_frame_release(&with);
    rendered_frame_release(&without);
    film_drop(&plain);
    film_drop(&film);
}

static void a_frame_that_sees_nothing_stays_empty(void **state)
{
    struct film film;
    struct renderer r;
    struct rendered_frame f = {0};
    struct err err = ERR_INIT;

    film_make(&film, *state, true, true);
    for (int i = 1; i < FRAMES; i++) { /* the first frame sees the scene; the others are behind the wall */
        const char *name = film.path.frames[i].camera.name;
        film.path.frames[i].camera = view_at(0, 0, 9);
        film.path.frames[i].camera.name = name;
    }
    start(&r, &film);
    for (int i = FRAMES - 1; i >= 0; i--) {
        assert_ok(renderer_frame(&r, i, &f, &err), err);
        frame_is_finite(&f);
        assert_true(i ? f.hole_fraction == 1 : f.hole_fraction < 0.5);
        for (int p = 0; i && p < W * H; p++) assert_true(f.hole[p] && f.rgba[4 * p] == 0);
    }
    renderer_release(&r);
    rendered_frame_release(&f);
    film_drop(&film);
    renderer_release(&r);
    renderer_release(NULL);
}

static char fast[] = "fast", offline[] = "offline";
#define BOTH(test) \
    {#test " (fast)", test, NULL, NULL, fast}, { #test " (offline)", test, NULL, NULL, offline }

int main(void)
{
    const struct CMUnitTest tests[] = {
        BOTH(ranges_of_frames_give_the_same_bytes),
        BOTH(ranges_with_lens_and_effects_give_the_same_bytes),
        BOTH(effects_and_lens_change_only_their_regions),
        BOTH(a_frame_that_sees_nothing_stays_empty),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
