/* fuse_views.c - signed distances of voxels from what the views show; see fuse_views.h.
 *
 * A view says of each voxel that its picture holds how far it is before the surface of its pixel, d, or behind it. As
 * in volumetric range images [Curless 1996] the volume sums weighted distances, cut to a band about the surface, and
 * voxels behind the band stay as they are: what is there is not seen. Noise of single views averages out, and a view
 * that looks through a voxel votes against those that see a surface there.
 *
 * What differs: the band is as wide as the depth is unsure, BAND sigma, at least MIN_BAND voxels. The surface is the
 * model's own where depth does not say for sure that something stands before it, so that noise of bare walls makes no
 * surfaces. Only pixels that show clutter count as evidence of a thing.
 *
 * A row of voxels is a line in the camera, so a row is clipped to the picture once and its voxels need no tests. */
#include "stages/find_things/fuse_views.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/layers/depth_sigma.h"

#define TOLERANCE   0.02 /* of the depth: errors of the model and the cameras */
#define SIGMAS      1.5  /* the same in uncertainties of the depth */
#define BEFORE_PANE 0.08 /* TOLERANCE before a pane of glass */
#define GRADE       0.6f /* of a pixel of clutter, from trace_ids */
#define BAND        1.5  /* half width, in uncertainties of the depth */
#define MIN_BAND    2.5  /* voxels */
#define MAX_BAND    10.0 /* voxels */
#define DOUBT       0.3  /* weight of inherited depth */
#define SHARP       0.04 /* relative uncertainty of depth that has its full weight */
#define NEAREST     1e-3 /* voxels from the camera's plane */

struct fused_pixel {
    float z, per_band, weight; /* depth, model units; 1 / half width of the band; weight 0: nothing is known */
    uint32_t thing;            /* 1: it shows clutter */
};

enum status fuse_volume_init(struct fused_volume *f, const struct voxel_grid *grid, struct err *err)
{
    const size_t n = voxel_count(grid);
    *f = (struct fused_volume){.grid = *grid};
    f->sum = calloc(n, sizeof *f->sum);
    f->weight = calloc(n, sizeof *f->weight);
    f->views = calloc(n, sizeof *f->views);
    if (f->sum && f->weight && f->views) return ST_OK;
    fuse_volume_release(f);
    return err_nomem(err, "a volume of voxels", n * 9);
}

void fuse_volume_release(struct fused_volume *f)
{
    free(f->sum);
    free(f->weight);
    free(f->views);
    *f = (struct fused_volume){0};
}

static double weight_of(const struct depth_segment *s)
{
    const double rise = (s->confidence - DEPTH_INHERITED) / (DEPTH_SURE - DEPTH_INHERITED), sigma = depth_width(s);
    return (DOUBT + (1 - DOUBT) * fmin(1, fmax(0, rise))) * (sigma > SHARP ? SHARP / sigma : 1);
}

/* Whether a pixel shows something that stands before the model: by the grade of its clutter, and by its depth, which
 * must be nearer than its own uncertainty explains. What shows through a window often has the depth of its frame. */
static bool shows_thing(const struct fused_view *view, size_t i)
{
    const struct layered_depth *d = view->depth;
    const struct view_ids *ids = view->ids;
    if (!(ids->clutter[i] > GRADE)) return false;
    const struct depth_segment *s = &d->segments[d->interior.id[i] - 1];
    const bool pane = ids->id[i] < (uint32_t)view->id_count && view->is_pane[ids->id[i]];
    const double nearer = 1 - (double)d->interior.z[i] / (double)ids->z[i];
    return nearer > (pane ? BEFORE_PANE : TOLERANCE) + SIGMAS * depth_width(s) &&
           (!pane || s->confidence >= DEPTH_SURE);
}

static struct fused_pixel pixel_of(const struct fused_view *view, size_t i, double voxel)
{
    const struct layered_depth *d = view->depth;
    const uint32_t id = d->interior.id[i];
    if (!id || !(d->interior.z[i] > 0) || !(view->ids->z[i] > 0)) return (struct fused_pixel){0};
    const struct depth_segment *s = &d->segments[id - 1];
    const bool thing = shows_thing(view, i);
    const double z = view->scale * (double)(thing ? d->interior.z[i] : view->ids->z[i]);
    const double band = fmin(MAX_BAND * voxel, fmax(MIN_BAND * voxel, BAND * depth_width(s) * z));
    return (struct fused_pixel){(float)z, (float)(1 / band), (float)weight_of(s), thing};
}

struct fuse_job {
    struct fused_volume *f;
    const struct view *camera;
    const struct fused_pixel *pixels;
};

/* Cuts [*from, *to] to where a + b t >= 0. */
static void clip(double *from, double *to, double a, double b)
{
    if (b > 0)
        *from = fmax(*from, -a / b);
    else if (b < 0)
        *to = fmin(*to, -a / b);
    else if (a < 0)
        *to = -INFINITY;
}

static void fuse_row(const struct fuse_job *job, int y, int z)
{
    const struct voxel_grid *g = &job->f->grid;
    const struct view *c = job->camera;
    const size_t row = ((size_t)z * (size_t)g->size[1] + (size_t)y) * (size_t)g->size[0];
    const struct vec3 first = thing_voxel_centre(g, (int64_t)row);
    const struct vec3 p = vec3_add(mat3_apply(c->cam_from_world, first), c->translation);
    const struct vec3 d = vec3_scale(
        vec3_make(c->cam_from_world.m[0][0], c->cam_from_world.m[1][0], c->cam_from_world.m[2][0]), g->voxel);
    double from = 0, to = g->size[0] - 1;
    clip(&from, &to, p.z - NEAREST * g->voxel, d.z);
    clip(&from, &to, c->fx * p.x + c->cx * p.z, c->fx * d.x + c->cx * d.z);
    clip(&from, &to, (c->width - c->cx) * p.z - c->fx * p.x, (c->width - c->cx) * d.z - c->fx * d.x);
    clip(&from, &to, c->fy * p.y + c->cy * p.z, c->fy * d.y + c->cy * d.z);
    clip(&from, &to, (c->height - c->cy) * p.z - c->fy * p.y, (c->height - c->cy) * d.z - c->fy * d.y);
    if (!(from <= to)) return;
    for (int x = (int)ceil(from); x <= (int)floor(to); x++) {
        const double depth = p.z + x * d.z, u = c->fx * (p.x + x * d.x) / depth + c->cx,
                     v = c->fy * (p.y + x * d.y) / depth + c->cy;
        const int column = u < c->width - 1 ? (int)u : c->width - 1, line = v < c->height - 1 ? (int)v : c->height - 1;
        if (!(depth > 0) || column < 0 || line < 0) continue;
        const struct fused_pixel *s = &job->pixels[(size_t)line * (size_t)c->width + (size_t)column];
        const float away = (s->z - (float)depth) * s->per_band;
        if (!(s->weight > 0) || away < -1) continue;
        const size_t i = row + (size_t)x;
        job->f->sum[i] += s->weight * fminf(1, away);
        job->f->weight[i] += s->weight;
        job->f->views[i] += s->thing && away < 1 && job->f->views[i] < UINT8_MAX;
    }
}

static void fuse_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct fuse_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        fuse_row(job, (int)(i % (size_t)job->f->grid.size[1]), (int)(i / (size_t)job->f->grid.size[1]));
}

enum status fuse_volume_add(struct fused_volume *f, const struct fused_view *view, struct err *err)
{
    const struct view *camera = &view->camera;
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    if (view->depth->width != camera->width || view->depth->height != camera->height ||
        view->ids->width != camera->width || view->ids->height != camera->height)
        return err_set(err, ST_DATA,
                       "the depth of view %s has %d x %d px, and its faces %d x %d, but the view has %d x %d. Run make "
                       "ids again.",
                       camera->name, view->depth->width, view->depth->height, view->ids->width, view->ids->height,
                       camera->width, camera->height);
    struct fused_pixel *list = malloc(pixels * sizeof *list);
    if (!list) return err_nomem(err, "pixels of a view", pixels * sizeof *list);
    for (size_t i = 0; i < pixels; i++) list[i] = pixel_of(view, i, f->grid.voxel);
    struct fuse_job job = {f, camera, list};
    parallel_for((size_t)f->grid.size[1] * (size_t)f->grid.size[2], 64, fuse_rows, &job);
    free(list);
    return ST_OK;
}
