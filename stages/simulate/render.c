/* render.c - see render.h.
 *
 * Surfaces are found by single rays, not by packets (common/light/ray_scene.h): at an edge that
 * two faces share, a packet may find a different face than a single ray. */
#include "stages/simulate/render.h"

#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"

#define TILE 16 /* px; a tile is the unit of work of a thread */

#define PARAM_STRUCT struct simulate_params
const struct param simulate_param_table[] = {SIMULATE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct camera_view camera_view_make(const struct shoot *s, const struct shoot_photo *photo)
{
    return (struct camera_view){&s->lenses[photo->lens], pose_center(&photo->cam_from_world),
                                mat3_transpose(mat3_from_quat(photo->cam_from_world.rotation))};
}

bool camera_view_ray(const struct camera_view *v, double u, double w, struct path_ray *ray)
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
    int samples, across; /* across: tiles in a row */
    struct image *radiance;
    uint64_t *rays; /* of each tile */
    struct progress *progress;
    float *depth;
    uint32_t *ids;
};

static struct rgb pixel_radiance(const struct job *job, int x, int y, uint64_t *rays)
{
    const uint64_t pixel = (uint64_t)y * (uint64_t)job->view->lens->width + (uint64_t)x;
    struct sobol s = sobol_make(&job->rng, pixel, job->samples);
    struct rgb sum = {0, 0, 0};
    for (; s.sample < (uint32_t)job->samples; s.sample++) {
        double u[4];
        struct path_ray ray;
        sobol_group(&s, 0, u);
        if (camera_view_ray(job->view, x + u[0], y + u[1], &ray))
            sum = rgb_add(sum, path_radiance(job->world, ray, &s, rays));
    }
    return rgb_scale(sum, 1.0 / job->samples);
}

static void render_tiles(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct job *job = ctx;
    for (size_t tile = begin; tile < end; tile++) {
        const int x0 = (int)(tile % (size_t)job->across) * TILE, y0 = (int)(tile / (size_t)job->across) * TILE;
        uint64_t rays = 0;
        for (int y = y0; y < y0 + TILE && y < job->radiance->height; y++)
            for (int x = x0; x < x0 + TILE && x < job->radiance->width; x++) {
                const struct rgb c = pixel_radiance(job, x, y, &rays);
                float *to = image_at(job->radiance, x, y);
                to[0] = (float)c.r, to[1] = (float)c.g, to[2] = (float)c.b;
            }
        job->rays[tile] = rays;
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
    const int across = (view->lens->width + TILE - 1) / TILE, down = (view->lens->height + TILE - 1) / TILE;
    const size_t tiles = (size_t)across * (size_t)down;
    struct progress progress;
    struct job job = {.world = w,
                      .view = view,
                      .samples = params->samples,
                      .across = across,
                      .radiance = radiance,
                      .progress = &progress};
    enum status st = image_init(radiance, view->lens->width, view->lens->height, 3, err);
    if (!st && !(job.rays = calloc(tiles, sizeof *job.rays))) st = err_nomem(err, "tiles", tiles * sizeof *job.rays);
    if (!st) {
        job.rng = rng_make((uint64_t)params->seed, "simulate", name);
        progress_start(&progress, name, (int64_t)tiles, "tiles");
        parallel_for(tiles, 1, render_tiles, &job);
        progress_end(&progress);
        for (size_t i = 0; rays && i < tiles; i++) *rays += job.rays[i];
    }
    free(job.rays);
    return st;
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
