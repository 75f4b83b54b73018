/* layer_render.c - rendering of layered depth maps from a novel camera [Colburn 2014, 3.6].
 *
 * Each segment is a plane (1/z linear in its view's pixels), so it projects into the novel camera by a homography. A
 * target pixel is mapped back into the segment's view (segment_project.h), where the segment ids decide whether the
 * pixel belongs to the segment (layer_visibility.h). Two renderers share this:
 *
 *   fast     per view the two nearest surfaces, composited front to back with saturating alpha; across the views that
 *            the view mesh selects for the pixel a soft z-buffer (soft_z.h), weighted by blending weight x w x alpha
 *   offline  the surfaces of these views and of the views nearest to the camera in one soft z-buffer, in which views
 *            vote against surfaces that they see through (soft_z_merge); bicubic texture look-up
 *
 * What differs from the thesis:
 * - the offline renderer blends extra views, and views vote;
 * - blending weights are taken from the view mesh at the corners of a lattice of LATTICE px and are bilinear between;
 * - a view's weight fades towards the border of its picture, so that the border leaves no visible line;
 * - where the views of the mesh leave a pixel below alpha 0.5, the nearest other view (by centre) that covers the pixel
 *   is a fallback, unless most of the mesh's views, by weight, see through its surface at something farther. Surfaces
 *   whose depth is inherited (DEPTH_INHERITED) are no evidence of that, and as fallbacks they come after all others.
 *   Only pixels without a fallback are holes; hole_fill.h fills them as far as the options say.
 *
 * A frame is rendered in independent tiles: each tile draws the mesh's views one after another, then the fallbacks of
 * uncovered pixels, then blends the samples of each pixel, eight pixels at a time. Results therefore do not depend on
 * threads or on how a path is split into jobs.
 *
 * Work that no pixel needs is not done: a view is prepared when a tile first asks for it, the views of the mesh at the
 * frame's start and a fallback at the first hole; a tile projects only the segments that can reach its open pixels
 * (drawn_view.h). Coverage alone goes through a tile's views by falling weight, each for the pixels that are still
 * open, and looks up no colour. */
#include "common/layers/layer_render.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/layers/layer_visibility.h"
#include "common/layers/soft_z.h"
#include "common/math/lanes.h"

#define LATTICE      16 /* px */
#define PATCHES      (TILE_WIDTH / LATTICE)
#define COVERED      0.5f /* min alpha of a covered pixel */
#define MESH_SLOTS   6    /* max views of the mesh per patch of the lattice */
#define SLOTS        (MESH_SLOTS + LAYER_MORE_VIEWS)
#define FALLBACK     SLOTS /* slot of the fallback views */
#define MAX_THROUGH  0.5f  /* max weight of views that see through a fallback's surface, of those that can decide */
#define SIGHT_WIDTHS 8 /* depth uncertainties: a view sees through a surface at what is about twice as far behind it */
#define MIN_INSIDE   1e-3f /* keeps a view visible at its border if it is the only one */
#define MIN_WEIGHT   1e-6f /* keeps a view visible where its blending weight is 0 if it is the only one */
#define EXTRA_WEIGHT 0.5f  /* added to the mesh's weight of the nearest view */
#define MIN_VOTE     0.05f /* of a view at its border */
#define VOTE_INSIDE  0.25f /* a view has its full vote this far inside its picture */

_Static_assert(2 * (SLOTS + 1) <= SOFT_Z_MAX_FRAGMENTS, "room for all fragments of a pixel");
_Static_assert(SLOTS + 1 <= SOFT_Z_MAX_VIEWS, "room for all views of a pixel");
_Static_assert(TILE_HEIGHT == LATTICE && TILE_WIDTH % LATTICE == 0, "a tile is a row of patches");

/* ------------------------------------------------------------------------------------------------- one frame */

struct view_distance {
    int view;
    double distance; /* between its centre and the novel camera's */
};

struct patch { /* a square of the lattice: its views and their blending weights at its corners */
    int count;
    int view[SLOTS];
    float weight[SLOTS][4]; /* upper left, upper right, lower left, lower right */
};

struct slot {                          /* samples of one view per pixel; which view varies by patch */
    struct view_samples front, behind; /* behind: offline only */
    float blend[TILE_PIXELS];          /* blending weight; 0: no sample */
};

struct tile_scratch { /* one per thread */
    struct tile_visibility visibility;
    struct drawn_tile segments; /* of the view that is drawn */
    struct slot *slots;         /* SLOTS + 1; NULL: coverage alone */
    struct view_samples spare;
    struct patch patches[PATCHES];
    uint8_t covered[TILE_PIXELS];
    bool has_fallback[PATCHES]; /* the slot FALLBACK has samples */
    enum status status;         /* ST_NOMEM: the frame is not complete */
};

struct frame_view { /* a view in this frame */
    struct drawn_view drawn;
    atomic_bool ready; /* drawn is prepared, or could not be */
    enum status status;
};

struct frame_job {
    const struct layer_scene *scene;
    struct view novel;
    struct soft_z soft;
    struct view_weights *lattice; /* lattice_width a row */
    int lattice_width, lattice_height;
    struct frame_view *views; /* one per view */
    bool *wanted;             /* per view: some patch blends it */
    pthread_mutex_t lock;     /* held while a view is prepared */
    struct view_distance *by_distance;
    float *extra_weight, *vote_weight; /* per view: addition to the mesh's weight, and weight of its vote */
    bool offline, nearest_alone;
    struct tile_scratch *scratch; /* one per thread */
    size_t threads;
    struct rendered_frame *out;
    int tiles_x, tiles;
};

static int compare_distance(const void *a, const void *b)
{
    const struct view_distance *x = a, *y = b;
    if (x->distance != y->distance) return x->distance < y->distance ? -1 : 1;
    return x->view - y->view;
}

static void prepare_view(struct frame_job *job, int view)
{
    struct frame_view *f = &job->views[view];
    f->status = drawn_view_prepare(&f->drawn, &job->scene->depths[view], &job->scene->views[view],
                                   &job->scene->set->views[view], &job->novel, NULL);
    atomic_store_explicit(&f->ready, true, memory_order_release);
}

/* The view in this frame, prepared now if it was not; NULL: a tile has nothing of it. */
static const struct drawn_view *view_in_tile(struct frame_job *job, int view, int tile)
{
    struct frame_view *f = &job->views[view];
    if (!atomic_load_explicit(&f->ready, memory_order_acquire)) {
        pthread_mutex_lock(&job->lock);
        if (!atomic_load_explicit(&f->ready, memory_order_relaxed)) prepare_view(job, view);
        pthread_mutex_unlock(&job->lock);
    }
    return !f->status && drawn_view_has_tile(&f->drawn, tile) ? &f->drawn : NULL;
}

static void prepare_wanted(void *ctx, size_t begin, size_t end, int thread)
{
    struct frame_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (job->wanted[i]) prepare_view(job, (int)i);
}

static void job_release(struct frame_job *job)
{
    for (int i = 0; job->views && i < job->scene->set->view_count; i++) drawn_view_release(&job->views[i].drawn);
    for (size_t t = 0; job->scratch && t < job->threads; t++) {
        drawn_tile_release(&job->scratch[t].segments);
        free(job->scratch[t].slots);
    }
    free(job->views);
    free(job->wanted);
    free(job->by_distance);
    free(job->scratch);
    free(job->extra_weight);
    free(job->vote_weight);
    free(job->lattice);
    pthread_mutex_destroy(&job->lock);
}

/* Samples the view mesh at the lattice's points, as the pixels of a reduced camera. */
static enum status lattice_init(struct frame_job *job, struct err *err)
{
    const struct view *novel = &job->novel;
    struct view camera = *novel;
    struct view_mesh_camera mesh;

    camera.width = (novel->width + LATTICE - 1) / LATTICE + 1;
    camera.height = (novel->height + LATTICE - 1) / LATTICE + 1;
    camera.fx /= LATTICE;
    camera.fy /= LATTICE;
    camera.cx = novel->cx / LATTICE + 0.5;
    camera.cy = novel->cy / LATTICE + 0.5;
    job->lattice_width = camera.width;
    job->lattice_height = camera.height;
    job->lattice = malloc((size_t)camera.width * (size_t)camera.height * sizeof *job->lattice);
    if (!job->lattice) return err_nomem(err, "a frame's blending weights", sizeof *job->lattice);
    view_mesh_prepare(&mesh, &job->scene->mesh, &camera);
    for (int y = 0; y < camera.height; y++) view_mesh_row(&mesh, y, job->lattice + (size_t)y * (size_t)camera.width);
    return ST_OK;
}

/* Extra weights and votes of the `more` views nearest to the camera. Both fade with distance, to 0 at the first view
 * left out. */
static void weigh_extra_views(struct frame_job *job, int more)
{
    const int views = job->scene->set->view_count;
    const struct view_distance *nearest = job->by_distance;

    for (int n = 0; n < more && n < views; n++) {
        const double edge = more < views ? nearest[more].distance : INFINITY;
        const double fade = nearest[n].distance < edge ? fmin(1, 2 * (1 - nearest[n].distance / edge)) : 0;
        const double near = nearest[n].distance > 0 ? nearest[0].distance / nearest[n].distance : 1;
        job->extra_weight[nearest[n].view] = (float)(EXTRA_WEIGHT * near * fade);
        job->vote_weight[nearest[n].view] = (float)fade;
    }
}

/* Prepares the views that patches blend. */
static void prepare_blended_views(struct frame_job *job)
{
    const size_t points = (size_t)job->lattice_width * (size_t)job->lattice_height;
    const int views = job->scene->set->view_count;

    if (job->nearest_alone)
        job->wanted[job->by_distance[0].view] = true;
    else
        for (size_t i = 0; i < points; i++)
            for (int k = 0; k < job->lattice[i].count; k++)
                job->wanted[job->lattice[i].view[k]] |= job->lattice[i].weight[k] > 0;
    for (int v = 0; v < views; v++) job->wanted[v] |= job->extra_weight[v] > 0;
    parallel_for((size_t)views, 1, prepare_wanted, job);
}

static enum status job_allocate(struct frame_job *job, bool color, struct err *err)
{
    const size_t count = (size_t)job->scene->set->view_count + 1;

    pthread_mutex_init(&job->lock, NULL);
    job->views = calloc(count, sizeof *job->views);
    job->wanted = calloc(count, sizeof *job->wanted);
    job->by_distance = calloc(count, sizeof *job->by_distance);
    job->extra_weight = calloc(count, sizeof *job->extra_weight);
    job->vote_weight = calloc(count, sizeof *job->vote_weight);
    job->scratch = malloc(job->threads * sizeof *job->scratch);
    for (size_t t = 0; job->scratch && t < job->threads; t++) {
        struct tile_scratch *s = &job->scratch[t];
        s->segments = (struct drawn_tile){0};
        s->slots = NULL;
        s->status = ST_OK;
    }
    bool all = job->views && job->wanted && job->by_distance && job->extra_weight && job->vote_weight && job->scratch;
    for (size_t t = 0; all && color && t < job->threads; t++)
        all = (job->scratch[t].slots = malloc((SLOTS + 1) * sizeof *job->scratch[t].slots)) != NULL;
    return all ? ST_OK
               : err_nomem(err, "a frame's views",
                           count * sizeof *job->views + job->threads * (SLOTS + 1) * sizeof(struct slot));
}

static enum status job_init(struct frame_job *job, struct rendered_frame *out, const struct layer_scene *scene,
                            const struct view *novel, const struct layer_render_options *options, bool color,
                            struct err *err)
{
    const int views = scene->set->view_count;

    *job = (struct frame_job){.scene = scene, .novel = *novel, .out = out, .offline = options->offline};
    job->threads = (size_t)parallel_threads();
    job->nearest_alone = options->nearest_alone;
    job->soft = layer_scene_soft_z(scene, options->soft_z);
    job->tiles_x = (novel->width + TILE_WIDTH - 1) / TILE_WIDTH;
    job->tiles = job->tiles_x * ((novel->height + TILE_HEIGHT - 1) / TILE_HEIGHT);
    if (job_allocate(job, color, err) || rendered_frame_resize(out, novel->width, novel->height, color, err) ||
        lattice_init(job, err))
        return err->status;
    for (int i = 0; i < views; i++) {
        job->by_distance[i].view = i;
        job->by_distance[i].distance = vec3_length(vec3_sub(scene->set->views[i].center, novel->center));
    }
    qsort(job->by_distance, (size_t)views, sizeof *job->by_distance, compare_distance);
    if (job->offline && !job->nearest_alone) weigh_extra_views(job, options->more_views);
    prepare_blended_views(job);
    return ST_OK;
}

/* After the tiles: whether memory was enough for all of them. */
static enum status job_check(const struct frame_job *job, struct err *err)
{
    bool whole = true;
    for (int i = 0; i < job->scene->set->view_count; i++) whole &= !job->views[i].status;
    for (size_t t = 0; t < job->threads; t++) whole &= !job->scratch[t].status;
    return whole ? ST_OK : err_nomem(err, "a view's segments", sizeof(struct drawn_segment));
}

static double hole_fraction(const struct rendered_frame *f)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    size_t holes = 0;
    for (size_t p = 0; p < pixels; p++) holes += f->hole[p];
    return (double)holes / (double)pixels;
}

/* --------------------------------------------------------------------------------------------- views of a tile */

struct tile { /* in pixels of the frame */
    int index, x, y, width, height, patches;
};

static struct tile tile_of(const struct frame_job *job, int tile)
{
    struct tile at = {.index = tile, .x = tile % job->tiles_x * TILE_WIDTH, .y = tile / job->tiles_x * TILE_HEIGHT};
    at.width = job->novel.width - at.x < TILE_WIDTH ? job->novel.width - at.x : TILE_WIDTH;
    at.height = job->novel.height - at.y < TILE_HEIGHT ? job->novel.height - at.y : TILE_HEIGHT;
    at.patches = (at.width + LATTICE - 1) / LATTICE;
    return at;
}

static int patch_slot(const struct patch *p, int view)
{
    for (int k = 0; k < p->count; k++)
        if (p->view[k] == view) return k;
    return -1;
}

static float corner_sum(const float weight[4]) { return weight[0] + weight[1] + weight[2] + weight[3]; }

/* Drops the view of lowest weight. */
static void patch_drop(struct patch *p)
{
    int weakest = 0;
    for (int k = 1; k < p->count; k++)
        if (corner_sum(p->weight[k]) < corner_sum(p->weight[weakest])) weakest = k;
    p->count--;
    memmove(&p->view[weakest], &p->view[weakest + 1], (size_t)(p->count - weakest) * sizeof p->view[0]);
    memmove(&p->weight[weakest], &p->weight[weakest + 1], (size_t)(p->count - weakest) * sizeof p->weight[0]);
}

static void patch_init(struct patch *p, const struct frame_job *job, int x, int y)
{
    p->count = 0;
    if (job->nearest_alone) {
        *p = (struct patch){.count = 1, .view = {job->by_distance[0].view}, .weight = {{1, 1, 1, 1}}};
        return;
    }
    for (int corner = 0; corner < 4; corner++) {
        const struct view_weights *w =
            &job->lattice[(size_t)(y + corner / 2) * (size_t)job->lattice_width + (size_t)(x + corner % 2)];
        for (int i = 0; i < w->count; i++) {
            if (!(w->weight[i] > 0)) continue;
            int k = patch_slot(p, w->view[i]);
            if (k < 0) {
                if (p->count == MESH_SLOTS) patch_drop(p);
                k = p->count++;
                p->view[k] = w->view[i];
                memset(p->weight[k], 0, sizeof p->weight[k]);
            }
            p->weight[k][corner] = w->weight[i];
        }
    }
    for (int v = 0; job->offline && v < job->scene->set->view_count; v++) {
        if (!(job->extra_weight[v] > 0)) continue;
        int k = patch_slot(p, v);
        if (k < 0) {
            k = p->count++;
            p->view[k] = v;
            memset(p->weight[k], 0, sizeof p->weight[k]);
        }
        for (int corner = 0; corner < 4; corner++) p->weight[k][corner] += job->extra_weight[v];
    }
}

/* A view's blending weights at the eight pixels of a patch from (x, y) on, relative to its upper left corner. */
static inline f32x8 patch_weights(const float weight[4], int x, int y)
{
    const float v = ((float)y + 0.5f) / LATTICE;
    const float left = weight[0] + v * (weight[2] - weight[0]), right = weight[1] + v * (weight[3] - weight[1]);
    const f32x8 lanes = {0, 1, 2, 3, 4, 5, 6, 7};
    const f32x8 u = (lanes + ((float)x + 0.5f)) * (1.0f / LATTICE);
    const f32x8 w = left + u * (right - left);
    return f32x8_max(w, f32x8_all(MIN_WEIGHT));
}

/* Marks those of eight pixels that the samples cover. */
static inline void mark_covered(uint8_t *covered, const float *alpha, const float *behind)
{
    for (int k = 0; k < 8; k++) covered[k] |= alpha[k] + (behind ? behind[k] : 0) >= COVERED;
}

static bool any_visible(const struct tile_visibility *v, size_t i)
{
    const i32x8 indices = i32x8_load(v->front + i);
    return i32x8_signs(indices == -1) != 0xFF;
}

static void clear_tile(struct tile_visibility *v, size_t begin, size_t end, float inverse)
{
    for (size_t i = begin; i < end; i++) v->inverse_front[i] = v->inverse_behind[i] = inverse;
    for (size_t i = begin; i < end; i++) v->front[i] = v->behind[i] = VISIBLE_NONE;
}

static int patch_end(const struct tile *at, int k) /* in the tile's columns */
{
    return (k + 1) * LATTICE < at->width ? (k + 1) * LATTICE : at->width;
}

/* Clears the patches that blend the view and disables those between them; false: no patch blends it. */
static bool clear_patches_of(struct tile_scratch *s, const struct tile *at, int view, int *first, int *last)
{
    *first = PATCHES;
    *last = -1;
    for (int k = 0; k < at->patches; k++) {
        if (patch_slot(&s->patches[k], view) < 0) continue;
        if (*first > k) *first = k;
        *last = k;
    }
    for (int y = 0; y < at->height; y++)
        for (int k = *first; k <= *last; k++) {
            const size_t begin = (size_t)y * TILE_STRIDE + (size_t)k * LATTICE;
            clear_tile(&s->visibility, begin, begin + LATTICE, patch_slot(&s->patches[k], view) < 0 ? INFINITY : 0);
        }
    for (int y = 0; y < TILE_HEIGHT; y++) {
        s->visibility.first[y] = *first * LATTICE;
        s->visibility.last[y] = y < at->height && *last >= 0 ? patch_end(at, *last) - 1 : -1;
    }
    return *last >= 0;
}

/* Draws a view into the tile's open pixels. */
static void draw_open(struct tile_scratch *s, const struct tile *at, const struct drawn_view *drawn)
{
    if (visibility_draw(&s->visibility, &s->segments, drawn, at->index, NULL)) s->status = ST_NOMEM;
}

static void draw_view(struct frame_job *job, struct tile_scratch *s, const struct tile *at, int view)
{
    const struct drawn_view *drawn;
    const struct layer_view *lv = &job->scene->views[view];
    const f32x8 min_inside = f32x8_all(MIN_INSIDE);
    int first, last;

    if (!clear_patches_of(s, at, view, &first, &last)) return;
    if ((drawn = view_in_tile(job, view, at->index))) draw_open(s, at, drawn);
    for (int k = first; k <= last; k++) {
        const int n = patch_slot(&s->patches[k], view);
        if (n < 0) continue;
        struct slot *slot = &s->slots[n];
        for (int y = 0; y < at->height; y++)
            for (int x = 0; x < LATTICE; x += 8) {
                const size_t i = (size_t)y * TILE_STRIDE + (size_t)(k * LATTICE + x);
                visibility_sample8(&slot->front, job->offline ? &slot->behind : NULL, &s->visibility, &s->segments, lv,
                                   i, at->x, at->y);
                mark_covered(s->covered + i, slot->front.alpha + i, job->offline ? slot->behind.alpha + i : NULL);
                f32x8 alpha = f32x8_load(slot->front.alpha + i);
                if (job->offline) alpha += f32x8_load(slot->behind.alpha + i);
                const i32x8 present = alpha > 0;
                const f32x8 weight = patch_weights(s->patches[k].weight[n], x, y) *
                                     f32x8_max(min_inside, f32x8_load(slot->front.inside + i));
                f32x8_store(slot->blend + i, f32x8_where(present, weight));
            }
    }
}

static void draw_mesh_views(struct frame_job *job, struct tile_scratch *s, const struct tile *at)
{
    for (int k = 0; k < at->patches; k++) patch_init(&s->patches[k], job, at->x / LATTICE + k, at->y / LATTICE);
    for (int v = 0; v < job->scene->set->view_count; v++) draw_view(job, s, at, v);
}

enum sight { SIGHT_UNKNOWN, SIGHT_THROUGH, SIGHT_BLOCKED };

/* SIGHT_THROUGH: the view sees a clearly farther surface along the ray to this world point, so there is no surface at
 * the point. SIGHT_UNKNOWN: the point is outside of its picture, or the view knows no depth there, or inherits it. */
static enum sight sight_of(const struct frame_job *job, int view, struct vec3 point, float sigma)
{
    const struct layer_view *lv = &job->scene->views[view];
    double u, v;
    const double z = view_project(&job->scene->set->views[view], point, &u, &v);
    if (!(z > 0) || !(u >= 0 && v >= 0 && u < lv->width && v < lv->height)) return SIGHT_UNKNOWN;

    const struct texel *t = &lv->texels[((size_t)v + 1) * (size_t)lv->stride + (size_t)u + 1];
    const uint32_t id = t->id[0] & ~TEXEL_JOINED;
    if (!id) return SIGHT_UNKNOWN;
    const struct depth_segment *seg = &job->scene->depths[view].segments[id - 1];
    const double inverse = seg->plane[0] * u + seg->plane[1] * v + seg->plane[2];
    if (seg->confidence < DEPTH_INHERITED) return SIGHT_UNKNOWN;
    if (!(inverse > 0)) return SIGHT_THROUGH;
    const struct soft_z soft = {SIGHT_WIDTHS, job->soft.range};
    const float rho = soft_z_rho(&soft, (float)z, sigma, (float)(1 / inverse), (float)seg->sigma);
    return soft_z_weight((float)(1 / inverse - z), 0.1f * rho, rho) == 0 ? SIGHT_THROUGH : SIGHT_BLOCKED;
}

/* Whether the patch's views do not contradict a fallback's surface at (x, y): by most of the weight of those that can
 * decide, they do not see through it. It must have been hidden from them, behind what they show; otherwise it is a
 * segment at a wrong depth, which would float in the hole. */
static bool is_consistent(const struct frame_job *job, const struct patch *patch, const struct tile *at, int x, int y,
                          float z, float sigma)
{
    const struct vec3 point = view_unproject(&job->novel, at->x + x + 0.5, at->y + y + 0.5, z);
    float sum[3] = {0};
    for (int k = 0; k < patch->count; k++)
        sum[sight_of(job, patch->view[k], point, sigma)] += patch_weights(patch->weight[k], x % LATTICE, y)[0];
    return !(sum[SIGHT_THROUGH] > MAX_THROUGH * (sum[SIGHT_THROUGH] + sum[SIGHT_BLOCKED]));
}

static bool any_hole(const struct tile_scratch *s, const struct tile *at)
{
    for (int y = 0; y < at->height; y++)
        if (memchr(s->covered + (size_t)y * TILE_STRIDE, 0, (size_t)at->width)) return true;
    return false;
}

/* Enables the uncovered pixels of the patches that blend the view (mesh_view) or of those that do not, and sets the
 * range of columns. False: there are none. */
static bool clear_uncovered(struct tile_scratch *s, const struct tile *at, int view, bool mesh_view)
{
    const f32x8 shut = f32x8_all(INFINITY);
    const i32x8 none = i32x8_all(-1), lanes = {0, 1, 2, 3, 4, 5, 6, 7};
    bool open[PATCHES], any = false;

    for (int y = 0; y < TILE_HEIGHT; y++) {
        s->visibility.first[y] = at->width;
        s->visibility.last[y] = -1;
    }
    if (!any_hole(s, at)) return false;
    for (int k = 0; k < at->patches; k++) open[k] = (patch_slot(&s->patches[k], view) >= 0) == mesh_view;
    for (int y = 0; y < at->height; y++)
        for (int x = 0; x < at->width; x += 8) {
            const size_t i = (size_t)y * TILE_STRIDE + (size_t)x;
            const i32x8 covered = i32x8_from_u8(s->covered + i);
            const i32x8 within = lanes < (open[x / LATTICE] ? at->width - x : 0);
            const i32x8 is_open = (covered == 0) & within;
            const f32x8 inverse = f32x8_unless(is_open, shut);
            const unsigned bits = i32x8_signs(is_open);
            f32x8_store(s->visibility.inverse_front + i, inverse);
            f32x8_store(s->visibility.inverse_behind + i, inverse);
            i32x8_store(s->visibility.front + i, none);
            i32x8_store(s->visibility.behind + i, none);
            if (!bits) continue;
            any = true;
            if (s->visibility.last[y] < 0) s->visibility.first[y] = x;
            s->visibility.last[y] = x + 7 < at->width ? x + 7 : at->width - 1;
        }
    return any;
}

/* Clears the patch in the slot FALLBACK before its first sample. */
static void open_fallback(struct tile_scratch *s, int patch)
{
    struct slot *slot = &s->slots[FALLBACK];
    if (s->has_fallback[patch]) return;
    s->has_fallback[patch] = true;
    for (int y = 0; y < TILE_HEIGHT; y++)
        for (int x = patch * LATTICE; x < (patch + 1) * LATTICE; x++) {
            const size_t i = (size_t)y * TILE_STRIDE + (size_t)x;
            memset(slot->front.rgba[i], 0, sizeof slot->front.rgba[i]);
            slot->front.alpha[i] = slot->front.z[i] = slot->front.sigma[i] = slot->blend[i] = 0;
            slot->front.inside[i] = 0; /* a fallback has the smallest vote */
        }
}

/* Accepts the samples of another view at eight uncovered pixels where they cover the pixel, are consistent, and sure if
 * they have to be. */
static void accept_fallback(const struct frame_job *job, struct tile_scratch *s, const struct tile *at,
                            const struct layered_depth *depth, size_t i, bool sure, bool color)
{
    struct slot *slot = &s->slots[FALLBACK];
    const struct view_samples *from = &s->spare;
    const int y = (int)(i / TILE_STRIDE);

    for (size_t p = i; p < i + 8; p++) {
        const int x = (int)(p % TILE_STRIDE);
        if (!(from->alpha[p] >= COVERED) || x >= at->width) continue;
        const struct drawn_segment *segment = &s->segments.segments[s->visibility.front[p] & ~VISIBLE_FULL];
        if (sure && depth->segments[segment->id - 1].confidence < DEPTH_INHERITED) continue;
        if (!is_consistent(job, &s->patches[x / LATTICE], at, x, y, from->z[p], from->sigma[p])) continue;
        s->covered[p] = 1;
        if (!color) continue;
        open_fallback(s, x / LATTICE);
        memcpy(slot->front.rgba[p], from->rgba[p], sizeof from->rgba[p]);
        slot->front.alpha[p] = from->alpha[p];
        slot->front.z[p] = from->z[p];
        slot->front.sigma[p] = from->sigma[p];
        slot->blend[p] = from->inside[p] > MIN_INSIDE ? from->inside[p] : MIN_INSIDE;
    }
}

/* Fallbacks of the pixels that the mesh's views leave uncovered: other views, the nearest first. sure: only what they
 * have not inherited. */
static void draw_fallbacks(struct frame_job *job, struct tile_scratch *s, const struct tile *at, bool sure, bool color)
{
    for (int n = 0; n < job->scene->set->view_count && any_hole(s, at); n++) {
        const int view = job->by_distance[n].view;
        const struct layer_view *lv = &job->scene->views[view];
        const struct drawn_view *drawn = view_in_tile(job, view, at->index);
        if (!drawn || !clear_uncovered(s, at, view, false)) continue;
        draw_open(s, at, drawn);
        if (!s->segments.count) continue;
        for (int y = 0; y < at->height; y++)
            for (int x = s->visibility.first[y]; x <= s->visibility.last[y]; x += 8) {
                const size_t i = (size_t)y * TILE_STRIDE + (size_t)x;
                if (!any_visible(&s->visibility, i)) continue;
                if (color)
                    visibility_sample8(&s->spare, NULL, &s->visibility, &s->segments, lv, i, at->x, at->y);
                else
                    visibility_cover8(&s->spare, &s->visibility, &s->segments, lv, i, at->x, at->y);
                accept_fallback(job, s, at, drawn->depth, i, sure, color);
            }
    }
}

static void draw_fallback_views(struct frame_job *job, struct tile_scratch *s, const struct tile *at, bool color)
{
    draw_fallbacks(job, s, at, true, color);
    draw_fallbacks(job, s, at, false, color);
}

/* ------------------------------------------------------------------------------------------------------- blending */

/* Fast: blends the samples of `slots` in the eight pixels from i on. Called with constants for the usual counts. */
static inline __attribute__((always_inline)) void blend_eight(const struct frame_job *job, const struct tile_scratch *s,
                                                              const int *slots, int count, size_t i, float (*rgba)[4],
                                                              float *z)
{
    struct soft_z_samples8 views[SOFT_Z_MAX_VIEWS];
    for (int k = 0; k < count; k++) {
        const struct slot *slot = &s->slots[slots[k]];
        const struct view_samples *front = &slot->front;
        views[k] = (struct soft_z_samples8){front->rgba + i, front->alpha + i, front->z + i, front->sigma + i,
                                            slot->blend + i};
    }
    soft_z_blend8(&job->soft, views, count, rgba, z);
}

/* A view's fragment of pixel i. */
static void fragment_init(struct soft_z_fragment *f, const struct view_samples *from, size_t i, float blend, float vote)
{
    memcpy(f->rgba, from->rgba[i], sizeof f->rgba);
    f->z = from->z[i];
    f->sigma = from->sigma[i];
    f->blend = blend;
    f->vote = vote;
    f->front_alpha = 0;
}

/* Offline: merges all fragments of the views in `slots` in pixel i. */
static void merge_pixel(const struct frame_job *job, const struct tile_scratch *s, const struct patch *patch,
                        const int *slots, int count, size_t i, float rgba[4], float *z)
{
    struct soft_z_fragment fragments[2 * (SLOTS + 1)];
    int n = 0;

    for (int k = 0; k < count; k++) {
        const struct slot *slot = &s->slots[slots[k]];
        const float blend = slot->blend[i];
        const bool behind = slots[k] != FALLBACK && slot->behind.alpha[i] > 0; /* possibly with nothing in front */
        if (!(slot->front.alpha[i] > 0) && !behind) continue;
        const float weight = slots[k] == FALLBACK ? 1 : job->vote_weight[patch->view[slots[k]]];
        const float inside = fminf(1, fmaxf(MIN_VOTE, slot->front.inside[i] / VOTE_INSIDE));
        const float vote = inside * fmaxf(weight, fminf(1, blend / SOFT_Z_FULL_BLEND));
        if (slot->front.alpha[i] > 0) fragment_init(&fragments[n++], &slot->front, i, blend, vote);
        if (!behind) continue;
        fragment_init(&fragments[n], &slot->behind, i, blend, vote);
        fragments[n++].front_alpha = slot->front.alpha[i];
    }
    if (n) soft_z_merge(&job->soft, fragments, n, rgba, z);
}

static void blend_patch(const struct frame_job *job, const struct tile_scratch *s, const struct tile *at, int k)
{
    const int begin = k * LATTICE, end = patch_end(at, k);
    int slots[SLOTS + 1], count = 0;

    for (int n = 0; n < s->patches[k].count; n++) slots[count++] = n;
    if (s->has_fallback[k]) slots[count++] = FALLBACK;
    for (int y = 0; y < at->height; y++)
        for (int x0 = begin; x0 < end; x0 += 8) {
            const size_t i = (size_t)y * TILE_STRIDE + (size_t)x0;
            const size_t p = (size_t)(at->y + y) * (size_t)job->novel.width + (size_t)(at->x + x0);
            const int n = end - x0 < 8 ? end - x0 : 8;
            float rgba[8][4], z[8];
            if (job->offline)
                for (size_t x = 0; x < (size_t)n; x++)
                    merge_pixel(job, s, &s->patches[k], slots, count, i + x, rgba[x], &z[x]);
            else if (count == 1)
                blend_eight(job, s, slots, 1, i, rgba, z);
            else if (count == 2)
                blend_eight(job, s, slots, 2, i, rgba, z);
            else if (count == 3)
                blend_eight(job, s, slots, 3, i, rgba, z);
            else
                blend_eight(job, s, slots, count, i, rgba, z);
            for (int x = 0; x < n; x++)
                if (!s->covered[i + (size_t)x]) {
                    memset(rgba[x], 0, sizeof rgba[x]);
                    z[x] = 0;
                }
            memcpy(job->out->rgba + 4 * p, rgba, (size_t)n * sizeof rgba[0]);
            memcpy(job->out->z + p, z, (size_t)n * sizeof z[0]);
        }
}

static void write_holes(const struct frame_job *job, const struct tile_scratch *s, const struct tile *at)
{
    for (int y = 0; y < at->height; y++) {
        uint8_t *hole = job->out->hole + (size_t)(at->y + y) * (size_t)job->novel.width + (size_t)at->x;
        for (int x = 0; x < at->width; x++) hole[x] = !s->covered[y * TILE_STRIDE + x];
    }
}

static void render_tiles(void *ctx, size_t begin, size_t end, int thread)
{
    struct frame_job *job = ctx;
    struct tile_scratch *s = &job->scratch[thread];

    for (size_t t = begin; t < end; t++) {
        const struct tile at = tile_of(job, (int)t);
        memset(s->covered, 0, sizeof s->covered);
        memset(s->has_fallback, 0, sizeof s->has_fallback);
        draw_mesh_views(job, s, &at);
        if (!job->nearest_alone && any_hole(s, &at)) draw_fallback_views(job, s, &at, true);
        for (int k = 0; k < at.patches; k++) blend_patch(job, s, &at, k);
        write_holes(job, s, &at);
    }
}

struct hole_photos layer_photos(const struct layer_scene *scene, const struct view *novel,
                                const struct layer_render_options *options)
{
    const struct view *views = scene->set->views;
    int nearest = 0;

    if (!options->nearest_alone) return (struct hole_photos){views, scene->set->view_count, novel};
    for (int i = 1; i < scene->set->view_count; i++)
        if (vec3_length(vec3_sub(views[i].center, novel->center)) <
            vec3_length(vec3_sub(views[nearest].center, novel->center)))
            nearest = i;
    return (struct hole_photos){views + nearest, 1, novel};
}

enum status layer_render(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                         const struct layer_render_options *options, struct err *err)
{
    struct frame_job job;
    job_init(&job, out, scene, novel, options, true, err);

    if (!err->status) {
        parallel_for((size_t)job.tiles, 1, render_tiles, &job);
        job_check(&job, err);
    }
    if (!err->status) {
        out->hole_fraction = hole_fraction(out);
        const struct soft_z soft = layer_scene_soft_z(scene, SOFT_Z_FILL_WIDTHS);
        const struct hole_photos photos = layer_photos(scene, novel, options);
        hole_fill(out, &photos, &soft, (float)scene->sigma, options->fill_diameter, err);
    }
    job_release(&job);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- coverage */

static void cover_view(struct frame_job *job, struct tile_scratch *s, const struct tile *at, int view)
{
    const struct layer_view *lv = &job->scene->views[view];
    const struct drawn_view *drawn = view_in_tile(job, view, at->index);

    if (!drawn || !clear_uncovered(s, at, view, true)) return;
    draw_open(s, at, drawn);
    for (int y = 0; y < at->height; y++)
        for (int x = s->visibility.first[y]; x <= s->visibility.last[y]; x += 8) {
            const size_t i = (size_t)y * TILE_STRIDE + (size_t)x;
            const i32x8 indices = i32x8_load(s->visibility.front + i);
            const i32x8 none = indices == -1;
            const int present = ~i32x8_signs(none) & 0xFF;
            const int full = i32x8_signs(indices) & present;
            for (int k = 0; k < 8; k++) s->covered[i + (size_t)k] |= full >> k & 1;
            if (full == present) continue;
            visibility_cover8(&s->spare, &s->visibility, &s->segments, lv, i, at->x, at->y);
            mark_covered(s->covered + i, s->spare.alpha + i, NULL);
        }
}

/* The views of the tile's patches in order of weight: the first covers nearly all pixels. */
static void cover_mesh_views(struct frame_job *job, struct tile_scratch *s, const struct tile *at)
{
    int views[PATCHES * SLOTS], count = 0;
    float sums[PATCHES * SLOTS];

    for (int k = 0; k < at->patches; k++) {
        patch_init(&s->patches[k], job, at->x / LATTICE + k, at->y / LATTICE);
        for (int n = 0; n < s->patches[k].count; n++) {
            int i = 0;
            while (i < count && views[i] != s->patches[k].view[n]) i++;
            if (i == count) {
                views[count] = s->patches[k].view[n];
                sums[count++] = 0;
            }
            sums[i] += corner_sum(s->patches[k].weight[n]);
        }
    }
    for (; count > 0; count--) {
        int best = 0;
        for (int i = 1; i < count; i++)
            if (sums[i] > sums[best]) best = i;
        cover_view(job, s, at, views[best]);
        views[best] = views[count - 1];
        sums[best] = sums[count - 1];
    }
}

static void cover_tiles(void *ctx, size_t begin, size_t end, int thread)
{
    struct frame_job *job = ctx;
    struct tile_scratch *s = &job->scratch[thread];

    for (size_t t = begin; t < end; t++) {
        const struct tile at = tile_of(job, (int)t);
        memset(s->covered, 0, sizeof s->covered);
        cover_mesh_views(job, s, &at);
        if (any_hole(s, &at)) draw_fallback_views(job, s, &at, false);
        write_holes(job, s, &at);
    }
}

enum status layer_coverage(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                           double scale, struct err *err)
{
    struct view reduced = *novel;
    struct frame_job job;

    view_resize(&reduced, (int)fmax(1, lround(novel->width * scale)), (int)fmax(1, lround(novel->height * scale)));
    const struct layer_render_options options = {.soft_z = SOFT_Z_WIDTHS};
    job_init(&job, out, scene, &reduced, &options, false, err);
    if (!err->status) {
        parallel_for((size_t)job.tiles, 1, cover_tiles, &job);
        job_check(&job, err);
    }
    if (!err->status) {
        out->hole_fraction = hole_fraction(out);
        out->unfilled_fraction = out->hole_fraction;
    }
    job_release(&job);
    return err->status;
}
