/* true_irradiance.c - true irradiance: pictures from cameras, and points of a file.
 *
 * Irradiance is the integral of radiance times cosine over the directions in front of a surface, which path_trace.h
 * estimates. Before and after an edit the same random numbers belong to a pixel (common random numbers), so that the
 * noise of the ratio is smaller than that of either picture, and a room without changes has a ratio of exactly 1. An
 * edited scene shows the same surface at a pixel if its face there has the same name and lies at the same point. */
#include "stages/simulate/true_irradiance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/light/surface_points.h"
#include "common/product/product.h"

#define SAME_POINT 1e-5 /* of the distance: points closer together are the same */

static int samples_of(const struct simulate_params *params)
{
    return params->truth_samples ? params->truth_samples : params->samples;
}

static struct rgb mean_irradiance(const struct world *w, struct vec3 point, struct vec3 normal, struct sobol s,
                                  int samples)
{
    struct rgb sum = {0, 0, 0};
    uint64_t rays = 0;
    for (; s.sample < (uint32_t)samples; s.sample++) sum = rgb_add(sum, path_irradiance(w, point, normal, &s, &rays));
    return rgb_scale(sum, 1.0 / samples);
}

/* --------------------------------------------------------------------------------------------------------- pictures */

struct picture {
    const struct world *world, *edited; /* edited: NULL, or the scene whose light it is */
    struct camera_view view;
    struct rng rng;
    int samples;
    struct image *to;
    struct progress *progress;
};

/* The surface that a camera sees through the centre of a pixel; false: none, or a lamp. */
static bool seen_surface(const struct world *w, struct path_ray ray, struct ray_hit *hit)
{
    return ray_scene_hit(&w->geometry.rays, ray.from, ray.direction, hit) && w->geometry.faces[hit->id].material >= 0;
}

static bool same_surface(const struct picture *p, struct path_ray ray, const struct ray_hit *before)
{
    struct ray_hit after;
    return seen_surface(p->edited, ray, &after) && fabs(after.t - before->t) <= SAME_POINT * before->t &&
           !strcmp(p->edited->geometry.faces[after.id].name, p->world->geometry.faces[before->id].name);
}

static void picture_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct picture *p = ctx;
    for (size_t y = begin; y < end; y++) {
        for (int x = 0; x < p->to->width; x++) {
            const uint64_t pixel = y * (uint64_t)p->to->width + (uint64_t)x;
            struct path_ray ray;
            struct ray_hit hit;
            if (!render_view_ray(&p->view, x + 0.5, (double)y + 0.5, &ray)) continue;
            if (!seen_surface(p->world, ray, &hit) || (p->edited && !same_surface(p, ray, &hit))) continue;
            const struct rgb e = mean_irradiance(p->edited ? p->edited : p->world, hit.point, hit.normal,
                                                 sobol_make(&p->rng, pixel, p->samples), p->samples);
            float *to = image_at(p->to, x, (int)y);
            to[0] = (float)e.r, to[1] = (float)e.g, to[2] = (float)e.b;
        }
        progress_add(p->progress, 1);
    }
}

enum status irradiance_picture(const struct picture_job *job, const struct world *w, const struct world *edited,
                               const struct shoot_photo *photo, const char *folder, struct err *err)
{
    struct image image = {0};
    struct progress progress;
    char truth[FILE_PATH], path[FILE_PATH], *key = NULL;
    const struct product_key of_photo = {.name = photo->name};
    const struct camera_view view = render_view_make(job->shoot, photo);
    if (asprintf(&key, "irradiance %s", photo->name) < 0) return err_nomem(err, "a name", strlen(photo->name));
    if (!file_path(truth, job->out, folder, "", err) &&
        !product_path_in(path, truth, PRODUCT_TRUE_IRRADIANCE, &of_photo, err) &&
        !image_init(&image, view.lens->width, view.lens->height, 3, err)) {
        struct picture p = {.world = w, .edited = edited, .view = view, .to = &image, .progress = &progress};
        p.rng = rng_make((uint64_t)job->params->seed, "simulate", key);
        p.samples = samples_of(job->params);
        progress_start(&progress, key, view.lens->height, "rows");
        parallel_for((size_t)view.lens->height, 1, picture_rows, &p);
        progress_end(&progress);
        photo_write_colour(&image, false, path, job->prov, err);
    }
    image_release(&image);
    free(key);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- points */

/* A point at which to compute irradiance. */
struct probe {
    struct vec3 at, normal; /* unit */
    struct rgb irradiance;
};

struct point_list {
    struct probe *list;
    int count, samples;
    const struct world *world;
    struct rng rng;
};

static enum status read_points(struct point_list *l, const char *path, struct err *err)
{
    struct surface_points points = {0};
    if (surface_points_read(&points, path, err)) return err->status;
    l->list = calloc((size_t)points.count, sizeof *l->list);
    for (int i = 0; l->list && i < points.count; i++)
        l->list[i] = (struct probe){points.list[i].at, points.list[i].normal, {0, 0, 0}};
    l->count = points.count;
    surface_points_release(&points);
    return l->list ? ST_OK : err_nomem(err, "points", (size_t)l->count * sizeof *l->list);
}

static void find_points(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    struct point_list *l = ctx;
    for (size_t i = begin; i < end; i++)
        l->list[i].irradiance =
            mean_irradiance(l->world, l->list[i].at, l->list[i].normal, sobol_make(&l->rng, i, l->samples), l->samples);
}

static enum status write_points(const struct point_list *l, const char *path, const struct provenance *prov,
                                struct err *err)
{
    struct outfile f = {0};
    outfile_open(&f, path, err);
    if (!err->status) {
        if (prov) provenance_print(prov, f.fp);
        fputs("# world position, normal, irradiance E rgb = integral L cos (same units as hdr radiance, no 1/pi)\n",
              f.fp);
        for (int i = 0; i < l->count; i++) {
            const struct probe *p = &l->list[i];
            fprintf(f.fp, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", p->at.x, p->at.y, p->at.z, p->normal.x,
                    p->normal.y, p->normal.z, p->irradiance.r, p->irradiance.g, p->irradiance.b);
        }
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

enum status irradiance_points(const struct picture_job *job, const struct world *w, const char *points,
                              const char *folder, struct err *err)
{
    struct point_list l = {.world = w, .samples = job->params->irradiance_samples};
    char truth[FILE_PATH], path[FILE_PATH];
    if (!read_points(&l, points, err) && !file_path(truth, job->out, folder, "", err) &&
        !file_path(path, truth, "irradiance-points.txt", "", err)) {
        l.rng = rng_make((uint64_t)job->params->seed, "simulate", "irradiance points");
        parallel_for((size_t)l.count, 1, find_points, &l);
        write_points(&l, path, job->prov, err);
    }
    free(l.list);
    return err->status;
}
