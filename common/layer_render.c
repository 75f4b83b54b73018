/* layer_render.c - see layer_render.h: a frame, band of rows by band of rows.
 *
 * A band draws one view after another: each only where the view mesh names it, then, in what is still a hole, the
 * other views. What a view shows of a pixel becomes one sample; the soft z blends a pixel's samples. Bands are cut by
 * height alone and share nothing, so threads and the split of a path into jobs do not change a bit. */
#include "common/layer_render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/hole_fill.h"
#include "common/layer_raster.h"
#include "common/parallel.h"
#include "common/soft_z.h"

#define BAND_ROWS    16
#define COVERED      0.5f  /* alpha from which a view covers a pixel */
#define MAX_SAMPLES  7     /* six that the view mesh names, or fewer and another view in a hole */
#define AGAINST_MOST 0.5f  /* part, by weight, of the views that can tell that may see through what fills a hole */
#define LEAST_INSIDE 1e-3f /* a view alone at its border still shows */

/* ------------------------------------------------------------------------------------------------- one frame */

struct other_view {
    int view;
    double distance; /* of its centre to the novel one's */
};

struct scratch { /* of one thread, for a band */
    struct view_weights *weights;
    struct raster_pixel *pixels;
    float *skip;
    struct soft_z_sample *samples; /* [MAX_SAMPLES][band pixels] */
    uint8_t *counts, *covered;
    bool *named; /* a view */
    int spans[BAND_ROWS][2];
};

struct frame_job {
    const struct layer_scene *scene;
    struct view novel;
    struct soft_z soft;
    struct view_mesh_camera mesh;
    struct raster_view *rasters; /* a view */
    struct other_view *by_distance;
    struct scratch *scratch; /* a thread */
    struct rendered_frame *out;
    enum status *prepared; /* a view */
};

static int compare_distance(const void *a, const void *b)
{
    const struct other_view *x = a, *y = b;
    if (x->distance != y->distance) return x->distance < y->distance ? -1 : 1;
    return x->view - y->view;
}

static void scratch_release(struct scratch *s)
{
    free(s->weights);
    free(s->pixels);
    free(s->skip);
    free(s->samples);
    free(s->counts);
    free(s->covered);
    free(s->named);
}

static enum status scratch_init(struct scratch *s, int width, int views, struct err *err)
{
    const size_t n = (size_t)BAND_ROWS * (size_t)width;
    s->weights = malloc(n * sizeof *s->weights);
    s->pixels = malloc(n * sizeof *s->pixels);
    s->skip = malloc(n * sizeof *s->skip);
    s->samples = malloc(n * MAX_SAMPLES * sizeof *s->samples);
    s->counts = malloc(n);
    s->covered = malloc(n);
    s->named = malloc((size_t)views * sizeof *s->named + 1);
    if (!s->weights || !s->pixels || !s->skip || !s->samples || !s->counts || !s->covered || !s->named)
        return err_nomem(err, "a band of a frame", n * (sizeof *s->pixels + MAX_SAMPLES * sizeof *s->samples));
    return ST_OK;
}

static void prepare_views(void *ctx, size_t begin, size_t end, int thread)
{
    struct frame_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        job->prepared[i] = raster_view_prepare(&job->rasters[i], &job->scene->depths[i], &job->scene->views[i],
                                               &job->scene->set->views[i], &job->novel, NULL);
}

static void job_release(struct frame_job *job)
{
    for (int i = 0; job->rasters && i < job->scene->set->view_count; i++) raster_view_release(&job->rasters[i]);
    for (int i = 0; job->scratch && i < parallel_threads(); i++) scratch_release(&job->scratch[i]);
    free(job->rasters);
    free(job->by_distance);
    free(job->scratch);
    free(job->prepared);
}

static enum status job_init(struct frame_job *job, struct rendered_frame *out, const struct layer_scene *scene,
                            const struct view *novel, double soft_z, bool color, struct err *err)
{
    const int views = scene->set->view_count;
    const size_t count = (size_t)views + 1, threads = (size_t)parallel_threads();
    enum status st = ST_OK;

    *job = (struct frame_job){.scene = scene, .novel = *novel, .out = out};
    job->soft.widths = (float)soft_z;
    job->soft.range = (float)fmax(scene->far_depth - scene->near_depth, 1e-6 * scene->far_depth);
    job->rasters = calloc(count, sizeof *job->rasters);
    job->by_distance = calloc(count, sizeof *job->by_distance);
    job->prepared = calloc(count, sizeof *job->prepared);
    job->scratch = calloc(threads, sizeof *job->scratch);
    if (!job->rasters || !job->by_distance || !job->prepared || !job->scratch)
        return err_nomem(err, "a frame's views", count * sizeof *job->rasters);

    for (size_t i = 0; !st && i < threads; i++) st = scratch_init(&job->scratch[i], novel->width, views, err);
    if (st || (st = rendered_frame_resize(out, novel->width, novel->height, color, err))) return st;
    parallel_for((size_t)views, 1, prepare_views, job);
    for (int i = 0; i < views; i++) {
        if (job->prepared[i]) return err_nomem(err, "a view's segments", sizeof(struct raster_segment));
        job->by_distance[i].view = i;
        job->by_distance[i].distance = vec3_length(vec3_sub(scene->set->views[i].center, novel->center));
    }
    qsort(job->by_distance, (size_t)views, sizeof *job->by_distance, compare_distance);
    return ST_OK;
}

static double hole_fraction(const struct rendered_frame *f)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    size_t holes = 0;
    for (size_t p = 0; p < pixels; p++) holes += f->hole[p];
    return (double)holes / (double)pixels;
}

/* ------------------------------------------------------------------------------------------- one view, one band */

/* Draws a view where skip is not INFINITY; the spans follow from it. False if it is INFINITY everywhere. */
static bool draw_view(const struct frame_job *job, struct scratch *s, int view, int y0, int y1)
{
    const int w = job->novel.width;
    bool any = false;

    for (int y = y0; y < y1; y++) {
        const size_t row = (size_t)(y - y0) * (size_t)w;
        int first = w, last = -1;
        for (int x = 0; x < w; x++) {
            if (isinf(s->skip[row + (size_t)x])) continue;
            if (first > x) first = x;
            last = x;
            s->pixels[row + (size_t)x] = (struct raster_pixel){0};
        }
        s->spans[y - y0][0] = first;
        s->spans[y - y0][1] = last;
        any |= first <= last;
    }
    const struct raster_target target = {y0, y1, w, s->pixels, s->skip, (const int(*)[2])s->spans};
    if (any) raster_rows(&target, &job->rasters[view], &job->scene->views[view], &job->soft);
    return any;
}

static void add_sample(struct scratch *s, size_t n, size_t p, float blend)
{
    const struct raster_pixel *from = &s->pixels[p];
    const struct raster_surface *surface = raster_visible(from);
    struct soft_z_sample *to = &s->samples[s->counts[p]++ * n + p];
    memcpy(to->rgba, from->rgba, sizeof to->rgba);
    to->z = surface->z;
    to->sigma = surface->sigma;
    to->blend = blend * fmaxf(LEAST_INSIDE, from->inside / from->rgba[3]);
}

static float weight_of(const struct view_weights *w, int view)
{
    for (int k = 0; k < w->count; k++)
        if (w->view[k] == view) return w->weight[k];
    return 0;
}

static void draw_named_views(const struct frame_job *job, struct scratch *s, int y0, int y1)
{
    const int w = job->novel.width, views = job->scene->set->view_count;
    const size_t n = (size_t)(y1 - y0) * (size_t)w;

    memset(s->named, 0, (size_t)views * sizeof *s->named);
    for (int y = y0; y < y1; y++) view_mesh_row(&job->mesh, y, s->weights + (size_t)(y - y0) * (size_t)w);
    for (size_t p = 0; p < n; p++)
        for (int k = 0; k < s->weights[p].count; k++) s->named[s->weights[p].view[k]] |= s->weights[p].weight[k] > 0;
    for (int v = 0; v < views; v++) {
        if (!s->named[v]) continue;
        for (size_t p = 0; p < n; p++) s->skip[p] = weight_of(&s->weights[p], v) > 0 ? 0 : INFINITY;
        const bool drawn = draw_view(job, s, v, y0, y1);
        for (size_t p = 0; drawn && p < n; p++) {
            const float blend = weight_of(&s->weights[p], v);
            if (!(blend > 0) || !(s->pixels[p].rgba[3] > 0)) continue;
            s->covered[p] |= s->pixels[p].rgba[3] >= COVERED;
            add_sample(s, n, p, blend);
        }
    }
}

enum sight { SIGHT_NONE, SIGHT_THROUGH, SIGHT_STOPPED };

/* Whether a view looks through this world point, at a surface clearly farther: then nothing can be there. It cannot
 * tell if the point is outside its picture or it has no depth there. */
static enum sight sight_of(const struct frame_job *job, int view, struct vec3 point, float sigma)
{
    const struct layer_view *lv = &job->scene->views[view];
    double u, v;
    const double z = view_project(&job->scene->set->views[view], point, &u, &v);
    if (!(z > 0) || !(u >= 0 && v >= 0 && u < lv->width && v < lv->height)) return SIGHT_NONE;

    const struct texel *t = &lv->texels[((size_t)v + 1) * (size_t)lv->stride + (size_t)u + 1];
    const uint32_t id = t->id[0] & ~TEXEL_JOINED;
    if (!id) return SIGHT_NONE;
    const struct depth_segment *seg = &job->scene->depths[view].segments[id - 1];
    const double inverse = seg->plane[0] * u + seg->plane[1] * v + seg->plane[2];
    if (!(inverse > 0)) return SIGHT_THROUGH;
    const float rho = soft_z_rho(&job->soft, (float)z, sigma, (float)(1 / inverse), (float)seg->sigma);
    return soft_z_weight((float)(1 / inverse - z), 0.1f * rho, rho) == 0 ? SIGHT_THROUGH : SIGHT_STOPPED;
}

/* In pixels that the named views leave a hole: the nearest of the other views that shows something there through which
 * the named views that can tell, by most of their weight, do not see. What is there was hidden from them, so it must lie behind what
 * they show; else a segment at a wrong depth would hang in the hole. */
static void draw_other_views(const struct frame_job *job, struct scratch *s, int y0, int y1)
{
    const int w = job->novel.width;
    const size_t n = (size_t)(y1 - y0) * (size_t)w;

    for (int i = 0; i < job->scene->set->view_count; i++) {
        const int view = job->by_distance[i].view;
        for (size_t p = 0; p < n; p++) s->skip[p] = s->covered[p] || weight_of(&s->weights[p], view) > 0 ? INFINITY : 0;
        if (!draw_view(job, s, view, y0, y1)) continue;
        for (size_t p = 0; p < n; p++) {
            const struct view_weights *named = &s->weights[p];
            if (s->covered[p] || weight_of(named, view) > 0 || s->pixels[p].rgba[3] < COVERED) continue;
            const struct raster_surface *surface = raster_visible(&s->pixels[p]);
            const struct vec3 point = view_unproject(&job->novel, (double)(p % (size_t)w) + 0.5,
                                                     y0 + (double)(p / (size_t)w) + 0.5, surface->z);
            float told[3] = {0};
            for (int k = 0; k < named->count; k++)
                if (named->weight[k] > 0)
                    told[sight_of(job, named->view[k], point, surface->sigma)] += named->weight[k];
            if (told[SIGHT_THROUGH] > AGAINST_MOST * (told[SIGHT_THROUGH] + told[SIGHT_STOPPED])) continue;
            s->covered[p] = 1;
            add_sample(s, n, p, 1);
        }
    }
}

/* The band's samples, and which pixels are covered. */
static void draw_band(const struct frame_job *job, struct scratch *s, int y0, int y1)
{
    const size_t n = (size_t)(y1 - y0) * (size_t)job->novel.width;
    bool holes = false;

    memset(s->counts, 0, n);
    memset(s->covered, 0, n);
    draw_named_views(job, s, y0, y1);
    for (size_t p = 0; p < n; p++) holes |= !s->covered[p];
    if (holes) draw_other_views(job, s, y0, y1);
}

static void render_bands(void *ctx, size_t begin, size_t end, int thread)
{
    struct frame_job *job = ctx;
    struct scratch *s = &job->scratch[thread];
    const size_t first = begin * (size_t)job->novel.width, n = (end - begin) * (size_t)job->novel.width;

    draw_band(job, s, (int)begin, (int)end);
    for (size_t p = 0; p < n; p++) {
        float *rgba = job->out->rgba + 4 * (first + p), *z = &job->out->z[first + p];
        struct soft_z_sample samples[MAX_SAMPLES];
        job->out->hole[first + p] = !s->covered[p];
        if (!s->covered[p]) {
            memset(rgba, 0, 4 * sizeof *rgba);
            *z = 0;
            continue;
        }
        for (int k = 0; k < s->counts[p]; k++) samples[k] = s->samples[(size_t)k * n + p];
        soft_z_blend(&job->soft, samples, s->counts[p], rgba, z);
    }
}

enum status layer_render(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                         const struct layer_render_options *options, struct err *err)
{
    struct frame_job job;
    enum status st = job_init(&job, out, scene, novel, options->soft_z, true, err);

    if (!st) {
        view_mesh_prepare(&job.mesh, &scene->mesh, novel);
        parallel_for((size_t)novel->height, BAND_ROWS, render_bands, &job);
        out->hole_fraction = hole_fraction(out);
        st = hole_fill(out, &job.soft, (float)scene->sigma, options->fill_diameter, err);
    }
    job_release(&job);
    return st;
}

/* ------------------------------------------------------------------------------------------------- coverage */

static void cover_bands(void *ctx, size_t begin, size_t end, int thread)
{
    const struct frame_job *job = ctx;
    const struct scratch *s = &job->scratch[thread];
    const size_t first = begin * (size_t)job->novel.width, n = (end - begin) * (size_t)job->novel.width;

    draw_band(job, &job->scratch[thread], (int)begin, (int)end);
    for (size_t p = 0; p < n; p++) job->out->hole[first + p] = !s->covered[p];
}

enum status layer_coverage(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                           double scale, struct err *err)
{
    struct view reduced = *novel;
    struct frame_job job;

    reduced.width = (int)fmax(1, lround(novel->width * scale));
    reduced.height = (int)fmax(1, lround(novel->height * scale));
    const double sx = (double)reduced.width / novel->width, sy = (double)reduced.height / novel->height;
    reduced.fx *= sx;
    reduced.cx *= sx;
    reduced.fy *= sy;
    reduced.cy *= sy;

    const enum status st = job_init(&job, out, scene, &reduced, SOFT_Z_WIDTHS, false, err);
    if (!st) {
        view_mesh_prepare(&job.mesh, &scene->mesh, &reduced);
        parallel_for((size_t)reduced.height, BAND_ROWS, cover_bands, &job);
        out->hole_fraction = hole_fraction(out);
        out->unfilled_fraction = out->hole_fraction;
    }
    job_release(&job);
    return st;
}
