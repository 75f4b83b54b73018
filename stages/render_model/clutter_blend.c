/* clutter_blend.c - clutter of several views over the shell: visibility, votes, blending.
 *
 * Overview. Each view draws its segments of clutter into the picture as planes at their own depths, so nothing is
 * stretched between a sofa and the wall behind it. A pixel then has fragments: of each view the nearest surface and the
 * one behind it, with colour, alpha, depth z and the uncertainty of z. Four questions are answered for each fragment.
 *
 * 1. Does the shell hide it? An edit may have put a wall there. A fragment behind the shell's depth by more than its
 *    uncertainty fades out. One in a zone that is to be cleared is left out.
 * 2. Do the views agree? The fragment's point P is projected into each view. A view whose nearest surface there is
 *    clearly behind P looks through it and denies it, as does one that shows the model's own surface there; one with
 *    clutter at P confirms it; one whose surface is in front, or whose picture P is not in, has no vote. With weights
 *    w_j (below) and confidences c_j,
 *      votes v = sum_confirming w_j / (sum_confirming w_j + sum_denying w_j c_j)
 *      confidence c = sum_confirming w_j c_j / sum_confirming w_j
 *    and the opacity is o = smoothstep(v) smoothstep(c). Without confidence the shell wins, and the pixel is marked.
 *    Where the camera looks outdoors both must be higher: the sky in a window has no texture, and any depth.
 * 3. What hides it? With e_ij in [0, 1] how far two fragments are the same surface (the soft z-buffer's weight of
 *    their depths; 1 for those of one view) and p_j the share of fragment j in its surface, fragment i is left
 *      1 - sum_j p_j a_j o_j (1 - e_ij), over those in front of it.
 * 4. How much does it count? As in unstructured lumigraph rendering [Buehler 2001], views that see P under nearly the
 *    camera's angle count most: w = fade inside / (BLUR^2 + penalty^2), where `penalty` is the angle, with a fee for
 *    distance, `inside` falls to 0 at the border of the view's picture and `fade` with the view's rank
 *    (clutter_choose.c).
 *
 * The pixel's coverage is sum_i p_i a_i o_i with p_i = (w_i / W_i) left_i, where W_i = sum over views of max e_ij w_j:
 * a mean over the views of one surface, a sum over surfaces. Soft borders are those of the layers' alpha.
 *
 * Source: soft z-buffer [Pulli 1997], [Colburn 2014, 3.6]. What differs: the votes; coverage instead of normalised
 * weights, as what is not covered shows the shell.
 *
 * The limits were chosen on the witnesses n0 and n2 of the scene loft.
 *
 * Pixels are independent of each other and the order of sums is that of the views: the same bits for any number of
 * threads. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/layers/soft_z.h"
#include "common/math/lanes.h"
#include "stages/render_model/clutter_scene.h"

#define MIN_ALPHA  0.02f
#define HIDDEN     0.02  /* of the depth: what the shell may be in front of a fragment without hiding it */
#define BEHIND     0.015 /* of the depth: a surface this far behind P is not P's */
#define DENIED     0.45  /* share of the votes up to which a fragment is not there, ... */
#define CONFIRMED  0.75  /* ... and from which it is */
#define UNSURE     0.2   /* the same of the confidence of those who confirm it */
#define SURE       0.45
#define OPEN       0.7 /* the same of both, multiplied, where the camera looks outdoors */
#define OPEN_SURE  0.95
#define BLUR       0.08 /* radians */
#define MIN_INSIDE 1e-3f
#define PRESENT    0.1f    /* fade * inside of a view that is fully present */
#define WIDTHS     8.0f    /* of the soft z-buffer, in uncertainties */
#define MAX_SLACK  0.03    /* of the depth */
#define SELF       2.5     /* voxels before a thing's surface, of more than what is thin */
#define THROUGH    2.5     /* voxels: the most that a thing may be behind the shell */
#define SOLID      (-0.2f) /* distance, in bands, of what is surely within a thing */
#define TOGETHER   0.004f  /* relative difference of depths */

enum { FRAGMENTS = 2 * CLUTTER_VIEWS };

struct blend_tile { /* one per thread */
    struct tile_visibility visibility;
    struct drawn_tile segments; /* of the view that is drawn */
    struct view_samples front[CLUTTER_VIEWS], behind[CLUTTER_VIEWS];
    bool drawn[CLUTTER_VIEWS];
    enum status status; /* ST_NOMEM: the picture is not complete */
};

struct blend_job {
    struct clutter_layer *to;
    const float *shell; /* model units */
    struct clutter_scene *scene;
    const struct clutter_choice *choice;
    const struct view *camera;
    const struct clutter_filter *filter;
    bool filters; /* the filter may drop something */
    double scale; /* scene units per model unit */
    int tiles_x, tiles;
    struct blend_tile *tile; /* one per thread */
    enum status prepared[CLUTTER_VIEWS];
};

struct fragment {
    float rgba[4];  /* premultiplied */
    float z, sigma; /* sigma: relative */
    int slot;
    bool open;         /* no shell is behind it */
    struct vec3 point; /* scene frame */
    float weight, opacity, present;
    float raw;   /* what the shell leaves of it */
    float doubt; /* opacity if all confidences were full */
};

static float smooth(double x)
{
    const double t = x < 0 ? 0 : x > 1 ? 1 : x;
    return (float)(t * t * (3 - 2 * t));
}

/* ---------------------------------------------------------------------------------------------------------- drawing */

static void prepare_views(void *ctx, size_t begin, size_t end, int thread)
{
    struct blend_job *job = ctx;
    (void)thread;
    for (size_t k = begin; k < end; k++) {
        const int at = job->choice->view[k];
        const struct clutter_view *v = &job->scene->sources[at].view;
        job->prepared[k] = drawn_view_prepare(&job->scene->drawn[k], &v->depth, &v->layers, &job->scene->set->views[at],
                                              job->camera, NULL);
    }
}

/* Draws the views' segments into a tile; false: there are none. */
static bool draw_tile(const struct blend_job *job, struct blend_tile *t, int tile, int x, int y, int width, int height)
{
    bool any = false;
    for (int k = 0; k < job->choice->count; k++) {
        const struct drawn_view *drawn = &job->scene->drawn[k];
        const struct layer_view *layers = &job->scene->sources[job->choice->view[k]].view.layers;
        t->drawn[k] = false;
        if (!drawn_view_has_tile(drawn, tile)) continue;
        for (size_t i = 0; i < TILE_PIXELS; i++) t->visibility.inverse_front[i] = t->visibility.inverse_behind[i] = 0;
        for (size_t i = 0; i < TILE_PIXELS; i++) t->visibility.front[i] = t->visibility.behind[i] = VISIBLE_NONE;
        for (int row = 0; row < TILE_HEIGHT; row++) {
            t->visibility.first[row] = 0;
            t->visibility.last[row] = row < height ? width - 1 : -1;
        }
        if (visibility_draw(&t->visibility, &t->segments, drawn, tile, NULL)) t->status = ST_NOMEM;
        if (!t->segments.count) continue;
        t->drawn[k] = any = true;
        for (int row = 0; row < height; row++)
            for (int column = 0; column < width; column += 8)
                visibility_sample8(&t->front[k], &t->behind[k], &t->visibility, &t->segments, layers,
                                   (size_t)row * TILE_STRIDE + (size_t)column, x, y);
    }
    return any;
}

/* -------------------------------------------------------------------------------------------------------- fragments */

/* What a depth may be off, relative to it: estimators state more than that (common/layers/depth_sigma.c). */
static double slack(float sigma) { return fmin((double)sigma, MAX_SLACK); }

/* Whether the one thing that is drawn is solid before a point of its surface: its back, which no view shows, hides
 * it. */
static bool is_behind_itself(const struct blend_job *job, struct vec3 p)
{
    const struct thing_volume *v = job->filter->volume;
    const struct vec3 camera = model_from_world_point(&job->scene->axes, job->camera->center);
    const struct vec3 before = vec3_scale(vec3_normalize(vec3_sub(camera, p)), SELF * v->grid.voxel);
    const int64_t at = thing_voxel_at(&v->grid, vec3_add(p, before));
    return at >= 0 && v->id[at] == job->filter->only && v->distance[at] < SOLID;
}

/* What the shell, and the filter, leave of a fragment. */
static float left_by_shell(const struct blend_job *job, const struct fragment *f, float shell)
{
    double spare = HIDDEN + slack(f->sigma);
    if (job->filter->only && shell > 0) /* one thing: what stands behind a wall does not show through it */
        spare = fmin(spare, THROUGH * job->filter->volume->grid.voxel * job->scale / (double)shell);
    const double over = shell > 0 ? (double)f->z / (double)shell - 1 : 0;
    const float left = over > spare ? 1 - smooth((over - spare) / spare) : 1;
    if (!(left > 0) || !job->filters) return left;
    const struct vec3 p = model_from_world_point(&job->scene->axes, f->point);
    if (clutter_filter_drops(job->filter, p)) return 0;
    return job->filter->only && is_behind_itself(job, p) ? 0 : left;
}

static int add_fragment(const struct blend_job *job, struct fragment *list, int count, const struct view_samples *from,
                        size_t i, int slot, float inside, int x, int y)
{
    struct fragment *f = &list[count];
    const float alpha = from->rgba[i][3];
    if (!(from->alpha[i] > 0) || !(alpha > MIN_ALPHA)) return count;
    if (job->filter->gone && job->filter->gone[(size_t)y * (size_t)job->camera->width + (size_t)x]) return count;
    *f = (struct fragment){.z = from->z[i], .sigma = from->sigma[i], .slot = slot};
    memcpy(f->rgba, from->rgba[i], sizeof f->rgba);
    f->point = view_unproject(job->camera, x + 0.5, y + 0.5, (double)f->z);
    const float shell = job->shell[(size_t)y * (size_t)job->camera->width + (size_t)x] * (float)job->scale;
    f->open = !(shell > 0);
    f->raw = left_by_shell(job, f, shell);
    const float standing = job->choice->fade[slot] * fmaxf(MIN_INSIDE, inside);
    f->present = fminf(1, standing / PRESENT);
    return f->raw > 0 ? count + 1 : count;
}

/* Gives a view's fragments at a pixel the share that the view's clutter has there. Where two surfaces meet in an edge,
 * the pieces of each may cover less than both together. */
static void complete(const struct blend_job *job, struct fragment *list, int count)
{
    const int at = job->choice->view[list[0].slot];
    double u, v;
    float sum = 0;
    for (int k = 0; k < count; k++) sum += list[k].rgba[3];
    const struct view *view = &job->scene->set->views[at];
    if (!(view_project(view, list[0].point, &u, &v) > 0) || !(u >= 0 && v >= 0 && u < view->width && v < view->height))
        return;
    float here[4];
    clutter_view_sample(here, &job->scene->sources[at].view, u, v);
    const float cover = fminf(1, here[3]);
    for (int k = 0; k < count && cover > sum; k++)
        for (int c = 0; c < 4; c++) list[k].rgba[c] *= cover / sum;
}

/* Near to far; of equal depths in the order of the views. */
static void sort_fragments(struct fragment *list, int count)
{
    for (int i = 1; i < count; i++) {
        const struct fragment f = list[i];
        int k = i;
        for (; k > 0 && f.z < list[k - 1].z; k--) list[k] = list[k - 1];
        list[k] = f;
    }
}

static float border(const struct view *v, double x, double y)
{
    const double across = 0.05 * (v->width > v->height ? v->width : v->height);
    const double at = fmin(fmin(x, v->width - x), fmin(y, v->height - y)) / across;
    return at < (double)MIN_INSIDE ? MIN_INSIDE : at < 1 ? (float)at : 1;
}

static float opaque(double support, double from, double to) { return smooth((support - from) / (to - from)); }

struct votes {
    double confirmed, agreeing, denied;
};

/* The vote of view k on a fragment; own: the view shows it itself. Returns the view's weight there. */
static double vote(struct votes *votes, const struct blend_job *job, const struct fragment *f, int k, bool own)
{
    const int at = job->choice->view[k];
    const struct view *view = &job->scene->set->views[at];
    const struct clutter_view *source = &job->scene->sources[at].view;
    double u, v;
    const double z = view_project(view, f->point, &u, &v);
    if (!(z > 0) || !(u >= 0 && v >= 0 && u < view->width && v < view->height)) return 0;
    const struct clutter_sight *sight = &source->sight[(size_t)v * (size_t)view->width + (size_t)u];
    const double nearest = (double)sight->nearest, sure = (double)sight->sure / (double)CLUTTER_SURE;
    const double tolerance = BEHIND + slack(f->sigma), beyond = nearest > 0 ? 1 / (z * nearest) - 1 : 0;
    const bool blind = !(nearest > 0) || beyond < -tolerance; /* it knows nothing of P, or P is hidden from it */
    if (blind && !own) return 0;
    const double penalty = clutter_penalty(f->point, job->camera->center, view->center);
    const double weight = (double)(job->choice->fade[k] * border(view, u, v)) / (BLUR * BLUR + penalty * penalty);
    const double through = own ? 0 : (double)smooth((beyond - tolerance) / tolerance);
    const double here = (1 - through) * (own ? 1 : (double)sight->shows / (double)CLUTTER_SURE);
    votes->confirmed += weight * sure * here;
    votes->agreeing += weight * here;
    votes->denied += weight * sure * (1 - here);
    return weight;
}

/* Lets the views vote on fragments at nearly one place; sets their weights and opacities. */
static void judge(const struct blend_job *job, struct fragment *list, int count)
{
    struct votes votes = {0};
    for (int k = 0; k < job->choice->count; k++) {
        bool own = false;
        for (int i = 0; i < count; i++) own |= list[i].slot == k;
        const double weight = vote(&votes, job, &list[0], k, own);
        for (int i = 0; i < count; i++)
            if (list[i].slot == k) list[i].weight = (float)weight;
    }
    if (!(votes.agreeing > 0)) return;
    const double sure = votes.confirmed / votes.agreeing, share = votes.agreeing / (votes.agreeing + votes.denied);
    for (int i = 0; i < count; i++) {
        struct fragment *f = &list[i];
        f->doubt = opaque(share, DENIED, CONFIRMED);
        f->opacity = f->doubt * opaque(sure, UNSURE, SURE);
        if (f->open) f->opacity *= opaque(sure * share, OPEN, OPEN_SURE);
    }
}

/* Judges sorted fragments; those within TOGETHER of each other at once, as most of a pixel's are. */
static void judge_all(const struct blend_job *job, struct fragment *list, int count)
{
    for (int first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && list[end].z < list[first].z * (1 + TOGETHER); end++) continue;
        judge(job, list + first, end - first);
    }
}

/* How far two fragments are the same surface, b behind a. Those of one view share the pixel's area already. */
static float same_surface(const struct fragment *a, const struct fragment *b)
{
    if (a->slot == b->slot) return 1;
    const float sa = fmaxf(a->sigma, SOFT_Z_MIN_SIGMA) * a->z, sb = fmaxf(b->sigma, SOFT_Z_MIN_SIGMA) * b->z;
    const float rho = 2 * WIDTHS * sqrtf(sa * sa + sb * sb), gamma = 0.1f * rho;
    return 1 - smooth((double)((b->z - a->z - gamma) / (rho - 2 * gamma)));
}

/* --------------------------------------------------------------------------------------------------------- blending */

/* The weights of the views that show a surface, each once: a view's two fragments share the pixel. */
static float weight_of_surface(const struct fragment *list, const float *same, int count)
{
    float of_view[CLUTTER_VIEWS] = {0}, sum = 0;
    for (int j = 0; j < count; j++) of_view[list[j].slot] = fmaxf(of_view[list[j].slot], same[j] * list[j].weight);
    for (int k = 0; k < CLUTTER_VIEWS; k++) sum += of_view[k];
    return sum;
}

/* Composites sorted fragments: premultiplied colour and coverage; *z: their mean depth; *doubtful: coverage if all
 * depths were sure. */
static void composite(float rgba[4], float *z, float *doubtful, const struct fragment *list, int count)
{
    float inverse = 0;
    float same[FRAGMENTS][FRAGMENTS], share[FRAGMENTS];
    memset(rgba, 0, 4 * sizeof *rgba);
    *doubtful = 0;
    for (int i = 0; i < count; i++) {
        same[i][i] = 1;
        for (int j = 0; j < i; j++) same[i][j] = same[j][i] = same_surface(&list[j], &list[i]);
    }
    for (int i = 0; i < count; i++) {
        const struct fragment *f = &list[i];
        const float sum = weight_of_surface(list, same[i], count);
        float hidden = 0;
        for (int j = 0; j < i; j++) hidden += share[j] * list[j].opacity * list[j].rgba[3] * (1 - same[i][j]);
        share[i] = sum > 0 ? f->weight / sum * f->raw * f->present * fmaxf(0, 1 - hidden) : 0;
        for (int c = 0; c < 4; c++) rgba[c] += share[i] * f->opacity * f->rgba[c];
        inverse += share[i] * f->opacity * f->rgba[3] / f->z;
        *doubtful += share[i] * f->doubt * f->rgba[3];
    }
    *z = inverse > 0 ? rgba[3] / inverse : 0;
    if (rgba[3] > 1)
        for (int c = 3; c >= 0; c--) rgba[c] /= rgba[3];
}

static void blend_pixel(const struct blend_job *job, const struct blend_tile *t, size_t i, int x, int y)
{
    struct fragment list[FRAGMENTS];
    int count = 0;
    for (int k = 0; k < job->choice->count; k++) {
        if (!t->drawn[k]) continue;
        const float inside = t->front[k].inside[i];
        const int first = count;
        count = add_fragment(job, list, count, &t->front[k], i, k, inside, x, y);
        count = add_fragment(job, list, count, &t->behind[k], i, k, inside, x, y);
        if (count > first) complete(job, list + first, count - first);
    }
    if (!count) return;
    sort_fragments(list, count);
    judge_all(job, list, count);
    const size_t at = (size_t)y * (size_t)job->camera->width + (size_t)x;
    composite(job->to->rgba + 4 * at, &job->to->z[at], &job->to->doubt[at], list, count);
}

static void blend_tiles(void *ctx, size_t begin, size_t end, int thread)
{
    const struct blend_job *job = ctx;
    struct blend_tile *t = &job->tile[thread];
    for (size_t tile = begin; tile < end; tile++) {
        const int x = (int)tile % job->tiles_x * TILE_WIDTH, y = (int)tile / job->tiles_x * TILE_HEIGHT;
        const int width = job->camera->width - x < TILE_WIDTH ? job->camera->width - x : TILE_WIDTH;
        const int height = job->camera->height - y < TILE_HEIGHT ? job->camera->height - y : TILE_HEIGHT;
        if (!draw_tile(job, t, (int)tile, x, y, width, height)) continue;
        for (int row = 0; row < height; row++)
            for (int column = 0; column < width; column++)
                blend_pixel(job, t, (size_t)row * TILE_STRIDE + (size_t)column, x + column, y + row);
    }
}

enum status clutter_layer_init(struct clutter_layer *l, int width, int height, struct err *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *l = (struct clutter_layer){calloc(4 * pixels, sizeof *l->rgba), calloc(pixels, sizeof *l->z),
                                calloc(pixels, sizeof *l->doubt)};
    if (l->rgba && l->z && l->doubt) return ST_OK;
    clutter_layer_release(l);
    return err_nomem(err, "clutter", 6 * pixels * sizeof *l->rgba);
}

void clutter_layer_release(struct clutter_layer *l)
{
    free(l->rgba);
    free(l->z);
    free(l->doubt);
    *l = (struct clutter_layer){0};
}

enum status clutter_blend(struct clutter_layer *to, const float *shell, struct clutter_scene *scene,
                          const struct clutter_choice *choice, const struct view *camera,
                          const struct clutter_filter *filter, struct err *err)
{
    const size_t threads = (size_t)parallel_threads();
    struct blend_job job = {.to = to, .shell = shell, .scene = scene, .choice = choice, .camera = camera};
    job.filter = filter;
    job.filters = clutter_filter_is_needed(filter);
    job.scale = 1 / scene->axes.scale;
    job.tiles_x = (camera->width + TILE_WIDTH - 1) / TILE_WIDTH;
    job.tiles = job.tiles_x * ((camera->height + TILE_HEIGHT - 1) / TILE_HEIGHT);
    job.tile = malloc(threads * sizeof *job.tile);
    if (!job.tile) return err_nomem(err, "tiles of clutter", threads * sizeof *job.tile);
    for (size_t t = 0; t < threads; t++) {
        job.tile[t].segments = (struct drawn_tile){0};
        job.tile[t].status = ST_OK;
    }
    parallel_for((size_t)choice->count, 1, prepare_views, &job);
    for (int k = 0; !err->status && k < choice->count; k++)
        if (job.prepared[k]) err_nomem(err, "a view's segments", sizeof(struct drawn_segment));
    if (!err->status) parallel_for((size_t)job.tiles, 1, blend_tiles, &job);
    for (size_t t = 0; t < threads; t++) {
        if (!err->status && job.tile[t].status) err_nomem(err, "a view's segments", sizeof(struct drawn_segment));
        drawn_tile_release(&job.tile[t].segments);
    }
    free(job.tile);
    return err->status;
}
