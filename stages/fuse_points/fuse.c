/* fuse.c - fusion of depth maps into points, by votes of the views.
 *
 * Each view in turn is the reference. Every pixel that is not mixed (alpha 1) and whose segment is confident proposes
 * the point P = C + z D, where D is its ray with z = 1. Each other view o into which P projects votes by its confident
 * segment there, with its plane's depth z_o against P's depth z_P:
 *   |z_P / z_o - 1| <= tolerance sqrt(sigma^2 + sigma_o^2)   it agrees, if its plane faces the reference
 *   z_P larger than that                                     P is occluded: no vote
 *   z_P smaller than that                                    it sees through P: its confidence counts against P
 * A point is kept if enough views agree and few see through it. Its depth is the mean of the intersections of its ray
 * with the agreeing planes, weighted by confidence / sigma^2: so the points of several views on one surface coincide,
 * which merging alone would not achieve, since cells are much smaller than sigma. Its normal is the mean of the same
 * planes' normals, corrected by the depths around it (normal_fit.h).
 *
 * Votes are added view by view in the set's order, so that the result does not depend on threads, and one depth map in
 * memory is enough; a cache of others saves reading them again. Memory: the reference's interior layer and 60 bytes per
 * pixel, 4 bytes per pixel and a record per segment of the cached views, and the merged points.
 *
 * The three kinds of votes are those of [Merrell 2007]. What differs from the source: votes come from planes with
 * uncertainties, and the mean is taken along the reference's ray. */
#include "stages/fuse_points/fuse.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/base/sort.h"
#include "stages/fuse_points/normal_fit.h"
#include "stages/fuse_points/point_grid.h"

#define PARAM_STRUCT struct fuse_params
const struct param fuse_param_table[] = {FUSE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define OVERLAP_STEP 8    /* px between the points that decide whether two views overlap */
#define MEDIAN_STEP  4    /* px between the pixels of a view's median depth */
#define ROWS         16   /* rows per chunk */
#define NOISE        0.25 /* standard deviation of a fused point's depth, in its segment's sigma */

struct vote {
    float weight, offset; /* sums of confidence / sigma^2, and times (z_ray / z - 1) */
    float normal[3];
    float support, against; /* sums of confidence of the views that agree, and that see through the point */
    int views;              /* number of views that agree; 0: no point here */
};

struct reference {
    const struct surface *surface;
    const struct layer *interior;
    struct vote *votes; /* w * h */
    float *inverse_z;   /* w * h: inverse depth of the points that are kept, 0 for others */
    const struct surface *other;
    const struct fuse_params *params;
};

/* The direction of a pixel's ray, of z = 1 along the view's axis. */
static struct vec3 ray_of(const struct view *v, double u, double y)
{
    return mat3_apply(mat3_transpose(v->cam_from_world), vec3_make((u - v->cx) / v->fx, (y - v->cy) / v->fy, 1));
}

static double weight_of(const struct surface_plane *p) { return p->confidence / ((double)p->sigma * p->sigma); }

static void add_vote(struct vote *vote, const struct surface_plane *p, double offset)
{
    const double w = weight_of(p);
    vote->weight += (float)w;
    vote->offset += (float)(w * offset);
    vote->normal[0] += (float)(w * p->normal.x);
    vote->normal[1] += (float)(w * p->normal.y);
    vote->normal[2] += (float)(w * p->normal.z);
    vote->support += p->confidence;
    vote->views++;
}

static void init_votes(void *ctx, size_t begin, size_t end, int thread)
{
    const struct reference *r = ctx;
    const struct surface *s = r->surface;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < (size_t)s->view->width; x++) {
            const size_t i = y * (size_t)s->view->width + x;
            r->votes[i] = (struct vote){0};
            if (!s->id[i] || r->interior->rgba[4 * i + 3] < 1) continue;
            const struct surface_plane *p = &s->planes[s->id[i] - 1];
            if (p->confidence < r->params->min_confidence || !(p->confidence > 0)) continue;
            const struct vec3 ray = ray_of(s->view, (double)x + 0.5, (double)y + 0.5);
            if (surface_plane_z(p, (double)x + 0.5, (double)y + 0.5) > 0 && vec3_dot(p->normal, ray) < 0)
                add_vote(&r->votes[i], p, 0);
        }
}

/* Adds the other view's vote on the point at depth z on the ray. */
static void compare_depth(const struct reference *r, struct vote *vote, const struct surface_plane *own, double z,
                          struct vec3 ray)
{
    const struct view *at = r->surface->view, *view = r->other->view;
    double u, v;
    const double seen_z = view_project(view, vec3_add(at->center, vec3_scale(ray, z)), &u, &v);
    if (!(seen_z > 0 && u >= 0 && v >= 0 && u < view->width && v < view->height)) return;
    const uint32_t id = r->other->id[(size_t)v * (size_t)view->width + (size_t)u];
    if (!id) return;
    const struct surface_plane *p = &r->other->planes[id - 1];
    const double z_other = surface_plane_z(p, u, v);
    if (!(z_other > 0) || p->confidence < r->params->min_confidence || !(p->confidence > 0)) return;
    const double gap = seen_z / z_other - 1;
    const double most = r->params->tolerance * sqrt((double)own->sigma * own->sigma + (double)p->sigma * p->sigma);
    if (gap < -most) {
        vote->against += p->confidence;
    } else if (gap <= most) {
        const double facing = vec3_dot(p->normal, ray);
        if (!(facing < 0)) return;
        /* the intersection with a plane at a grazing angle is unstable; the difference in the other view replaces it */
        double offset = (p->offset - vec3_dot(p->normal, at->center)) / facing / z - 1;
        if (!(fabs(offset) <= 2 * most)) offset = -gap;
        add_vote(vote, p, offset);
    }
}

static void compare_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct reference *r = ctx;
    const struct surface *s = r->surface;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < (size_t)s->view->width; x++) {
            const size_t i = y * (size_t)s->view->width + x;
            if (!r->votes[i].views) continue;
            const struct surface_plane *p = &s->planes[s->id[i] - 1];
            const double u = (double)x + 0.5, v = (double)y + 0.5;
            compare_depth(r, &r->votes[i], p, surface_plane_z(p, u, v), ray_of(s->view, u, v));
        }
}

static bool overlaps(const struct reference *r, const struct view *other)
{
    const struct surface *s = r->surface;
    for (int y = OVERLAP_STEP / 2; y < s->view->height + OVERLAP_STEP / 2; y += OVERLAP_STEP)
        for (int x = OVERLAP_STEP / 2; x < s->view->width + OVERLAP_STEP / 2; x += OVERLAP_STEP) {
            const int px = x < s->view->width ? x : s->view->width - 1,
                      py = y < s->view->height ? y : s->view->height - 1;
            const size_t i = (size_t)py * (size_t)s->view->width + (size_t)px;
            if (!r->votes[i].views) continue;
            double u, v;
            const double z = surface_plane_z(&s->planes[s->id[i] - 1], px + 0.5, py + 0.5);
            if (view_project(other, view_unproject(s->view, px + 0.5, py + 0.5, z), &u, &v) > 0 && u >= 0 && v >= 0 &&
                u < other->width && v < other->height)
                return true;
        }
    return false;
}

/* Sets inverse_z: the fused inverse depth of the points that are kept, 0 for the others. */
static void select_points(struct reference *r, struct fuse_stats *stats)
{
    const struct surface *s = r->surface;
    for (int y = 0; y < s->view->height; y++)
        for (int x = 0; x < s->view->width; x++) {
            const size_t i = (size_t)y * (size_t)s->view->width + (size_t)x;
            const struct vote *vote = &r->votes[i];
            r->inverse_z[i] = 0;
            if (!vote->views) continue;
            stats->samples++;
            if (vote->views < stats->views) {
                stats->unsupported++;
            } else if ((double)vote->against > r->params->max_seen_through * (double)vote->support) {
                stats->seen_through++;
            } else {
                const double z = surface_plane_z(&s->planes[s->id[i] - 1], x + 0.5, y + 0.5);
                r->inverse_z[i] = (float)(1 / (z * (1 + (double)vote->offset / (double)vote->weight)));
            }
        }
}

/* Turns the votes' sums of normals into the points' normals. */
static void normal_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct reference *r = ctx;
    const struct surface *s = r->surface;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < (size_t)s->view->width; x++) {
            const size_t i = y * (size_t)s->view->width + x;
            struct vote *vote = &r->votes[i];
            if (!(r->inverse_z[i] > 0)) continue;
            struct vec3 n = vec3_normalize(vec3_make(vote->normal[0], vote->normal[1], vote->normal[2]));
            if (r->params->normal_window > 0)
                n = normal_fit(n, r->inverse_z, s->view, (int)x, (int)y, r->params->normal_window,
                               NOISE * (double)s->planes[s->id[i] - 1].sigma);
            vote->normal[0] = (float)n.x;
            vote->normal[1] = (float)n.y;
            vote->normal[2] = (float)n.z;
        }
}

/* Adds the kept points to the grid, in the order of the pixels. */
static enum status add_points(struct point_grid *grid, const struct reference *r, struct err *err)
{
    const struct view *view = r->surface->view;
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++) {
            const size_t i = (size_t)y * (size_t)view->width + (size_t)x;
            const struct vote *vote = &r->votes[i];
            if (!(r->inverse_z[i] > 0)) continue;
            const float *rgb = r->interior->rgba + 4 * i;
            const struct fused_sample sample = {
                .position = view_unproject(view, x + 0.5, y + 0.5, 1 / (double)r->inverse_z[i]),
                .normal = vec3_make(vote->normal[0], vote->normal[1], vote->normal[2]),
                .color = {rgb[0], rgb[1], rgb[2]},
                .confidence = vote->support / (float)vote->views * vote->support / (vote->support + vote->against),
                .views = vote->views,
            };
            if (point_grid_add(grid, &sample, err)) return err->status;
        }
    return ST_OK;
}

static enum status fuse_view(struct point_grid *grid, int view_idx, struct surface_cache *cache,
                             const struct fuse_params *params, struct fuse_stats *stats, struct progress *progress,
                             struct err *err)
{
    const struct camera_set *set = cache->set;
    const struct view *view = &set->views[view_idx];
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    struct layered_depth depth = {0};
    struct surface surface = {0};
    struct reference r = {.surface = &surface, .interior = &depth.interior, .params = params};
    if (!cache->source->read_interior(cache->source->ctx, view_idx, &depth, err) &&
        !surface_make(&surface, view, &depth, err)) {
        r.votes = malloc(pixels * sizeof *r.votes);
        r.inverse_z = malloc(pixels * sizeof *r.inverse_z);
        if (!r.votes || !r.inverse_z) err_nomem(err, "the views' votes", pixels * sizeof *r.votes);
    }
    if (!err->status) parallel_for((size_t)view->height, ROWS, init_votes, &r);
    for (int i = 0; !err->status && i < set->view_count; i++) {
        if (i != view_idx && overlaps(&r, &set->views[i]) && !surface_cache_get(cache, i, &r.other, err))
            parallel_for((size_t)view->height, ROWS, compare_rows, &r);
        progress_add(progress, 1);
    }
    if (!err->status) {
        select_points(&r, stats);
        parallel_for((size_t)view->height, ROWS, normal_rows, &r);
        add_points(grid, &r, err);
    }
    free(r.votes);
    free(r.inverse_z);
    surface_release(&surface);
    layered_depth_release(&depth);
    return err->status;
}

/* Median depth of the confident pixels; 0 if there are none. */
static enum status view_median(double *median, const struct surface *s, const struct fuse_params *params,
                               struct err *err)
{
    const size_t most = ((size_t)s->view->width / MEDIAN_STEP + 1) * ((size_t)s->view->height / MEDIAN_STEP + 1);
    double *depths = malloc(most * sizeof *depths);
    size_t count = 0;
    if (!depths) return err_nomem(err, "a view's depths", most * sizeof *depths);
    for (int y = 0; y < s->view->height; y += MEDIAN_STEP)
        for (int x = 0; x < s->view->width; x += MEDIAN_STEP) {
            const uint32_t id = s->id[(size_t)y * (size_t)s->view->width + (size_t)x];
            if (!id || s->planes[id - 1].confidence < params->min_confidence) continue;
            const double z = surface_plane_z(&s->planes[id - 1], x + 0.5, y + 0.5);
            if (z > 0) depths[count++] = z;
        }
    sort_doubles(depths, count);
    *median = count ? depths[count / 2] : 0;
    free(depths);
    return ST_OK;
}

/* The median of the views' medians. Reads every depth map, so that a bad one is reported at once. */
static enum status scene_depth(double *depth, struct surface_cache *cache, const struct fuse_params *params,
                               struct err *err)
{
    double *medians = malloc(((size_t)cache->set->view_count + 1) * sizeof *medians);
    struct progress progress = {0};
    int count = 0;
    if (!medians) return err_nomem(err, "the views' depths", (size_t)cache->set->view_count * sizeof *medians);
    progress_start(&progress, "reading depth maps", cache->set->view_count, "views");
    for (int i = 0; !err->status && i < cache->set->view_count; i++) {
        const struct surface *s;
        if (!surface_cache_get(cache, i, &s, err) && !view_median(&medians[count], s, params, err))
            count += medians[count] > 0;
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    sort_doubles(medians, (size_t)count);
    *depth = count ? medians[count / 2] : 0;
    free(medians);
    if (!err->status && !count)
        err_set(err, ST_DATA,
                "no view has a segment of confidence %g or more, so there is nothing to fuse; check the depth maps, or "
                "lower [fuse_points] min_confidence.",
                params->min_confidence);
    return err->status;
}

enum status fuse_points(struct point_cloud *cloud, struct fuse_stats *stats, const struct camera_set *set,
                        const struct depth_reader *source, const struct fuse_params *params, size_t max_bytes,
                        struct err *err)
{
    struct surface_cache cache = {0};
    struct point_grid grid = {0};
    struct progress progress = {0};
    *stats = (struct fuse_stats){.views = params->min_views < set->view_count ? params->min_views : set->view_count};
    if (!surface_cache_init(&cache, set, source, max_bytes, err) && !scene_depth(&stats->depth, &cache, params, err) &&
        !point_grid_init(&grid, params->grid_size > 0 ? params->grid_size : params->grid * stats->depth, err))
        progress_start(&progress, "fusing", (int64_t)set->view_count * set->view_count, "pairs of views");
    for (int i = 0; !err->status && i < set->view_count; i++)
        fuse_view(&grid, i, &cache, params, stats, &progress, err);
    progress_end(&progress);
    stats->reads = cache.reads;
    if (!err->status && !grid.count)
        err_set(err, ST_DATA,
                "none of %lld confident pixels has a depth on which %d views agree; check the depth maps and the "
                "cameras, or "
                "lower [fuse_points] min_views.",
                (long long)stats->samples, stats->views);
    surface_cache_release(&cache); /* frees its memory before the points are allocated */
    if (!err->status) point_grid_points(cloud, &grid, err);
    point_grid_release(&grid);
    return err->status;
}
