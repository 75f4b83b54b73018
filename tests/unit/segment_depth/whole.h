/* whole.h - runs the whole stage on photographs of synthetic scenes, and checks the invariants of its depth maps. */
#ifndef REMODEL_TESTS_SEGMENT_WHOLE_H
#define REMODEL_TESTS_SEGMENT_WHOLE_H

#include "stages/segment_depth/view_depth.h"
#include "tests/unit/segment_depth/scene.h"

#include "common/base/parallel.h"

enum { W = 160, H = 120, FOCAL = 160 };

struct result {
    struct layered_depth depth;
    int neighbours[MAX_NEIGHBOURS], neighbour_count;
};

static struct scene scene; /* large; zeroed by start() */

static inline void start(void) { memset(&scene, 0, sizeof scene); }

/* `count` views around the first, at a distance of 0.4. */
static inline void place_cameras(int count)
{
    static const double offsets[][2] = {{0, 0}, {0.4, 0}, {-0.4, 0}, {0, 0.4}, {0, -0.4}};
    for (int i = 0; i < count; i++) scene_view(&scene, W, H, FOCAL, offsets[i][0], offsets[i][1], 0, 0);
}

typedef enum status photo_fn(void *ctx, int view_idx, struct image *im, struct err *err);

/* Checks the invariants of every depth map. */
static inline void must_be_sound_of(const struct layered_depth *d, photo_fn *photo_of)
{
    struct image photo;
    struct err err = ERR_INIT;
    assert_int_equal(photo_of(&scene, 0, &photo, &err), ST_OK);
    assert_true(d->width == photo.width && d->height == photo.height);
    for (int i = 0; i < d->segment_count; i++) {
        const struct depth_segment *s = &d->segments[i];
        assert_int_equal(s->id, i + 1);
        assert_true(isfinite(s->plane[0]) && isfinite(s->plane[1]) && isfinite(s->plane[2]));
        assert_true(isfinite(s->sigma) && s->sigma > 0);
        assert_true(s->confidence >= 0 && s->confidence <= 1);
    }
    for (int i = 0; i < d->width * d->height; i++) {
        float sum[4] = {0};
        for (int k = 0; k < 2; k++) {
            const struct layer *l = k ? &d->boundary : &d->interior;
            for (int c = 0; c < 4; c++) sum[c] += l->rgba[4 * i + c];
            assert_true(l->id[i] <= (uint32_t)d->segment_count && (l->id[i] > 0) == (l->rgba[4 * i + 3] > 0));
            assert_true(isfinite(l->z[i]) && (l->id[i] ? l->z[i] > 0 : l->z[i] <= 0));
            if (!l->id[i]) continue;
            const double *p = d->segments[l->id[i] - 1].plane;
            assert_near((double)l->z[i] * (p[0] * (i % d->width + 0.5) + p[1] * (i / d->width + 0.5) + p[2]), 1, 1e-5);
        }
        for (int c = 0; c < 4; c++) assert_near(sum[c], photo.data[4 * i + c], 1e-6 * fmaxf(1, photo.data[4 * i + c]));
    }
    image_release(&photo);
}
static inline void check_invariants(const struct layered_depth *d) { must_be_sound_of(d, scene_photo); }

static inline enum status depth_of(struct result *r, const struct segment_params *params, struct err *err)
{
    const struct view_source source = {.read = scene_photo, .ctx = &scene};
    return view_depth(&r->depth, r->neighbours, &r->neighbour_count, &scene.set, 0, &source, params, err);
}

static inline void must_work(struct result *r)
{
    const struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    if (depth_of(r, &params, &err)) fail_msg("%s", err.text);
    check_invariants(&r->depth);
}

/* Whether another surface, or a depth that differs by more than a tenth, lies within 3 px. */
static inline bool at_jump(int x, int y)
{
    int own, other;
    const double z = scene_depth(&scene, &scene.views[0], x + 0.5, y + 0.5, &own);
    for (int k = 0; k < 16; k++) {
        const double u = x + 0.5 + 3 * cos(k * M_PI / 8), v = y + 0.5 + 3 * sin(k * M_PI / 8);
        const double there = scene_depth(&scene, &scene.views[0], u, v, &other);
        if (other != own && fabs(there / z - 1) > 0.1) return true;
    }
    return false;
}

/* The fraction of a surface's pixels (-1: all), away from depth edges, whose relative depth error is within
 * `tolerance`. */
static inline double fraction_correct(const struct layered_depth *d, int surface, double tolerance)
{
    int good = 0, count = 0;
    for (int y = 0; y < d->height; y++)
        for (int x = 0; x < d->width; x++) {
            int at;
            const double z = scene_depth(&scene, &scene.views[0], x + 0.5, y + 0.5, &at);
            if (at < 0 || (surface >= 0 && at != surface) || at_jump(x, y)) continue;
            good += fabs((double)d->interior.z[y * d->width + x] / z - 1) <= tolerance;
            count++;
        }
    assert_true(count > 0);
    if (getenv("VERDICT"))
        print_message("  surface %d: %.4f of %d within %g\n", surface, (double)good / count, count, tolerance);
    return (double)good / count;
}

static inline double mean_confidence(const struct layered_depth *d)
{
    double sum = 0, pixels = 0;
    for (int i = 0; i < d->segment_count; i++) {
        sum += d->segments[i].confidence * d->segments[i].pixels;
        pixels += d->segments[i].pixels;
    }
    if (getenv("VERDICT")) print_message("  confidence %.3f\n", sum / pixels);
    return sum / pixels;
}

/* ------------------------------------------------------------------------------------------------------------
 * rounds */

struct rounds { /* the views' depth in the previous round */
    const struct scene *scene;
    photo_fn *photo; /* NULL: scene_photo */
    struct layered_depth depth[MAX_VIEWS];
};

static inline enum status rounds_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    const struct rounds *r = ctx;
    return (r->photo ? r->photo : scene_photo)((void *)r->scene, view_idx, im, err);
}

/* As stored on disk: segments and the interior's ids. */
static inline enum status rounds_depth(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    const struct layered_depth *from = &((const struct rounds *)ctx)->depth[view_idx];
    const size_t pixels = (size_t)from->width * (size_t)from->height;
    (void)err;
    *d = (struct layered_depth){.width = from->width, .height = from->height, .segment_count = from->segment_count};
    d->interior.id = malloc(pixels * sizeof *d->interior.id);
    d->segments = malloc(((size_t)from->segment_count + 1) * sizeof *d->segments);
    assert_true(d->interior.id && d->segments);
    memcpy(d->interior.id, from->interior.id, pixels * sizeof *d->interior.id);
    memcpy(d->segments, from->segments, (size_t)from->segment_count * sizeof *d->segments);
    return ST_OK;
}

/* The first view's depth after the first round, and after each of `more` rounds of all views. */
static inline void must_work_in_rounds_of(struct layered_depth *first_view, int more,
                                          const struct segment_params *params, photo_fn *photo)
{
    static struct rounds now, next;
    memset(&now, 0, sizeof now);
    for (int round = 0; round <= more; round++) {
        now.scene = next.scene = &scene;
        now.photo = next.photo = photo;
        for (int k = 0; k < scene.set.view_count; k++) {
            const struct view_source source = {
                .read = rounds_photo, .read_depth = round ? rounds_depth : NULL, .ctx = &now};
            int neighbours[MAX_NEIGHBOURS], count;
            struct err err = ERR_INIT;
            if (round == more && k > 0) break;
            if (view_depth(&next.depth[k], neighbours, &count, &scene.set, k, &source, params, &err))
                fail_msg("round %d, view %d: %s", round, k, err.text);
        }
        must_be_sound_of(&next.depth[0], photo);
        for (int k = 0; k < scene.set.view_count; k++) { /* the first view's is returned below */
            if (k || round == 0) layered_depth_release(&now.depth[k]);
            now.depth[k] = next.depth[k];
            next.depth[k] = (struct layered_depth){0};
        }
        first_view[round] = now.depth[0];
    }
    for (int k = 1; k < scene.set.view_count; k++) layered_depth_release(&now.depth[k]);
}
static inline void must_work_in_rounds(struct layered_depth *first_view, int more, const struct segment_params *params)
{
    must_work_in_rounds_of(first_view, more, params, scene_photo);
}

#endif
