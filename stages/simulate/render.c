/* render.c - see render.h.
 *
 * Radiance: a block of 8 x 8 pixels has four groups of pixels that share paths (shared_paths.h). Each group has one
 * pixel of each 2 x 2 cell, chosen by a random permutation: neighbours are in different groups, so that their errors
 * are independent, and look like the grain of a photograph instead of squares. A group is the same for all samples, so
 * that its random numbers are stratified over them. Where a pixel is sampled is chosen for each pixel alone.
 *
 * Depth and ids are found by single rays, not by packets (common/light/ray_scene.h): at an edge that two faces share,
 * a packet may find a different face than a single ray. */
#include "stages/simulate/render.h"

#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "stages/simulate/shared_paths.h"

#define BLOCK  8 /* px; a block is the unit of work of a thread */
#define GROUPS 4 /* in a block: one for each pixel of a 2 x 2 cell */
#define CELLS  (BLOCK / 2)
_Static_assert(CELLS *CELLS == SHARED_RAYS, "a group has one pixel of each cell");

#define PARAM_STRUCT struct simulate_params
const struct param simulate_param_table[] = {SIMULATE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct camera_view render_view_make(const struct shoot *s, const struct shoot_photo *photo)
{
    return (struct camera_view){&s->lenses[photo->lens], pose_center(&photo->cam_from_world),
                                mat3_transpose(mat3_from_quat(photo->cam_from_world.rotation))};
}

bool render_view_ray(const struct camera_view *v, double u, double w, struct path_ray *ray)
{
    struct vec3 in_camera;
    if (!shoot_lens_ray(v->lens, u, w, &in_camera)) return false;
    *ray = (struct path_ray){v->centre, mat3_apply(v->world_from_cam, in_camera)};
    return true;
}

struct job {
    const struct world *world;
    const struct camera_view *view;
    struct rng rng;
    int samples, across; /* across: blocks in a row */
    struct image *radiance;
    uint64_t *rays; /* of each block */
    struct progress *progress;
    float *depth;
    uint32_t *ids;
};

struct pixel {
    int x, y;
    struct sobol where; /* group 0: the place within the pixel */
};

/* Pixels have the keys 0, 1, ... of the random numbers, groups of pixels those after. */
static uint64_t group_key(const struct job *job, size_t block, int group)
{
    const uint64_t pixels = (uint64_t)job->radiance->width * (uint64_t)job->radiance->height;
    return pixels + (uint64_t)block * GROUPS + (uint64_t)group;
}

/* Assigns the pixels of a block to groups; those beyond the picture's border are included. */
static void make_groups(struct pixel pixels[GROUPS][SHARED_RAYS], const struct job *job, size_t block)
{
    const int x0 = (int)(block % (size_t)job->across) * BLOCK, y0 = (int)(block / (size_t)job->across) * BLOCK;
    for (int cell = 0; cell < SHARED_RAYS; cell++) {
        const uint32_t random = rng_u32(&job->rng, group_key(job, block, 0), 1 + (uint64_t)cell);
        int group[GROUPS] = {0, 1, 2, 3};
        for (int k = GROUPS - 1; k > 0; k--) {
            const int other = (int)((random >> 8 * k) % (uint32_t)(k + 1)), kept = group[k];
            group[k] = group[other];
            group[other] = kept;
        }
        for (int k = 0; k < GROUPS; k++) {
            const int x = x0 + 2 * (cell % CELLS) + k % 2, y = y0 + 2 * (cell / CELLS) + k / 2;
            const uint64_t key = (uint64_t)y * (uint64_t)job->radiance->width + (uint64_t)x;
            pixels[group[k]][cell] = (struct pixel){x, y, sobol_make(&job->rng, key, job->samples)};
        }
    }
}

/* The camera's rays of one sample. Returns a bit for each ray that exists. */
static uint32_t camera_rays(struct path_ray ray[SHARED_RAYS], struct pixel pixels[SHARED_RAYS], const struct job *job,
                            int sample)
{
    uint32_t active = 0;
    for (int i = 0; i < SHARED_RAYS; i++) {
        struct pixel *p = &pixels[i];
        double u[4];
        if (p->x >= job->radiance->width || p->y >= job->radiance->height) continue;
        p->where.sample = (uint32_t)sample;
        sobol_group(&p->where, 0, u);
        if (render_view_ray(job->view, p->x + u[0], p->y + u[1], &ray[i])) active |= 1u << i;
    }
    return active;
}

static void render_group(const struct job *job, struct pixel pixels[SHARED_RAYS], uint64_t key, uint64_t *rays)
{
    struct rgb sum[SHARED_RAYS] = {{0, 0, 0}};
    struct sobol s = sobol_make(&job->rng, key, job->samples * SHARED_RAYS);
    for (int sample = 0; sample < job->samples; sample++) {
        struct path_ray ray[SHARED_RAYS];
        const uint32_t active = camera_rays(ray, pixels, job, sample);
        s.sample = (uint32_t)sample;
        if (active) shared_paths_radiance(sum, job->world, ray, active, &s, rays);
    }
    for (int i = 0; i < SHARED_RAYS; i++) {
        if (pixels[i].x >= job->radiance->width || pixels[i].y >= job->radiance->height) continue;
        const struct rgb c = rgb_scale(sum[i], 1.0 / job->samples);
        float *to = image_at(job->radiance, pixels[i].x, pixels[i].y);
        to[0] = (float)c.r, to[1] = (float)c.g, to[2] = (float)c.b;
    }
}

static void render_blocks(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct job *job = ctx;
    for (size_t block = begin; block < end; block++) {
        struct pixel pixels[GROUPS][SHARED_RAYS];
        uint64_t rays = 0;
        make_groups(pixels, job, block);
        for (int g = 0; g < GROUPS; g++) render_group(job, pixels[g], group_key(job, block, g), &rays);
        job->rays[block] = rays;
        progress_add(job->progress, 1);
    }
}

enum status render_check_light(const struct image *radiance, const char *name, struct err *err)
{
    const size_t count = (size_t)radiance->width * (size_t)radiance->height * 3;
    for (size_t i = 0; i < count; i++)
        if (radiance->data[i] > 0) return ST_OK;
    return err_set(err, ST_DATA,
                   "no light reaches photo %s: it would be black; check that its camera is not inside a wall or a box, "
                   "and that a lamp or a window lights the room.",
                   name);
}

enum status render_radiance(struct image *radiance, const struct world *w, const struct camera_view *view,
                            const char *name, const struct simulate_params *params, uint64_t *rays, struct err *err)
{
    const int across = (view->lens->width + BLOCK - 1) / BLOCK, down = (view->lens->height + BLOCK - 1) / BLOCK;
    const size_t blocks = (size_t)across * (size_t)down;
    struct progress progress;
    struct job job = {.world = w,
                      .view = view,
                      .samples = params->samples,
                      .across = across,
                      .radiance = radiance,
                      .progress = &progress};
    image_init(radiance, view->lens->width, view->lens->height, 3, err);
    if (!err->status && !(job.rays = calloc(blocks, sizeof *job.rays)))
        err_nomem(err, "blocks of pixels", blocks * sizeof *job.rays);
    if (!err->status) {
        job.rng = rng_make((uint64_t)params->seed, "simulate", name);
        progress_start(&progress, name, (int64_t)blocks, "blocks");
        parallel_for(blocks, 1, render_blocks, &job);
        progress_end(&progress);
        for (size_t i = 0; rays && i < blocks; i++) *rays += job.rays[i];
    }
    free(job.rays);
    return err->status;
}

static void surface_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct job *job = ctx;
    const struct shoot_lens *lens = job->view->lens;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < lens->width; x++) {
            const size_t at = y * (size_t)lens->width + (size_t)x;
            struct vec3 in_camera;
            struct path_ray ray;
            struct ray_hit hit;
            job->depth[at] = 0;
            job->ids[at] = 0;
            if (!shoot_lens_ray(lens, x + 0.5, (double)y + 0.5, &in_camera)) continue;
            ray = (struct path_ray){job->view->centre, mat3_apply(job->view->world_from_cam, in_camera)};
            if (!ray_scene_hit(geometry_seen(&job->world->geometry, job->world->shell), ray.from, ray.direction, &hit))
                continue;
            job->depth[at] = (float)(lens->kind == SHOOT_PINHOLE ? hit.t * in_camera.z : hit.t);
            job->ids[at] = job->world->geometry.faces[hit.id].id;
        }
}

void render_surfaces(float *depth, uint32_t *ids, const struct world *w, const struct camera_view *view)
{
    struct job job = {.world = w, .view = view, .depth = depth, .ids = ids};
    parallel_for((size_t)view->lens->height, 8, surface_rows, &job);
}
