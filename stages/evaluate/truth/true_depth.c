/* true_depth.c - see true_depth.h.
 *
 * Whether another photo sees a point: with that photo's true depth map, the point is hidden if all known depths of
 * the 3 x 3 pixels around its projection are nearer than the point by more than HIDDEN; a pixel without depth shows
 * something distant. Without one, all points are warped forward into that photo, each to one pixel, and each pixel
 * keeps the nearest; the point is hidden if its pixel, or both its left and right neighbours, or both the upper and
 * lower one (the gaps between points that spread), hold a point that is nearer by more than HIDDEN. */
#include "stages/evaluate/truth/true_depth.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

enum { CHUNK = 8192, ROWS = 8 };
#define HIDDEN 0.02 /* of the distance */

struct points_job {
    struct vec3 *points;
    const struct true_photo *photo;
};

static void points_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct points_job *job = ctx;
    const struct camera *c = &job->photo->lens;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < c->width; x++) {
            size_t i = y * (size_t)c->width + (size_t)x;
            double depth = job->photo->depth[i];
            struct vec3 ray;
            job->points[i] = vec3_make(0, 0, 0);
            if (!(depth > 0) || !camera_unproject(c, x + 0.5, (double)y + 0.5, &ray)) continue;
            if (!job->photo->along_ray) {
                if (!(ray.z > 0)) continue;
                ray = vec3_scale(ray, 1 / ray.z);
            }
            job->points[i] = vec3_scale(ray, depth);
        }
}

void true_points(struct vec3 *points, const struct true_photo *photo)
{
    struct points_job job = {points, photo};
    parallel_for((size_t)photo->lens.height, ROWS, points_rows, &job);
}

struct projection { /* of a point into another photo: its pixel, -1 outside the picture, and its distance */
    int x, y;
    float range;
};

struct warp_job {
    struct projection *projections;
    const struct vec3 *points;
    struct mat3 rotation; /* other_from_photo */
    struct vec3 translation;
    const struct camera *lens;
};

static void warp_points(void *ctx, size_t begin, size_t end, int thread)
{
    const struct warp_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct projection *to = &job->projections[i];
        double u, v;
        *to = (struct projection){-1, -1, 0};
        if (vec3_length(job->points[i]) <= 0) continue;
        struct vec3 p = vec3_add(mat3_apply(job->rotation, job->points[i]), job->translation);
        if (!camera_project(job->lens, p, &u, &v) ||
            !(u >= 0 && v >= 0 && u < job->lens->width && v < job->lens->height))
            continue;
        *to = (struct projection){(int)u, (int)v, (float)vec3_length(p)};
    }
}

/* nearest: distance of the nearest warped point in each pixel of the other photo; INFINITY: none. */
static void draw_points(float *nearest, const struct camera *lens, const struct projection *projections, size_t count)
{
    size_t pixels = (size_t)lens->width * (size_t)lens->height;
    for (size_t i = 0; i < pixels; i++) nearest[i] = INFINITY;
    for (size_t i = 0; i < count; i++) {
        if (projections[i].x < 0) continue;
        float *at = &nearest[(size_t)projections[i].y * (size_t)lens->width + (size_t)projections[i].x];
        *at = fminf(*at, projections[i].range);
    }
}

static bool nearer(const float *nearest, const struct camera *lens, int x, int y, double range)
{
    if (x < 0 || y < 0 || x >= lens->width || y >= lens->height) return false;
    return nearest[(size_t)y * (size_t)lens->width + (size_t)x] < range * (1 - HIDDEN);
}

static bool hidden_by_points(const float *nearest, const struct camera *lens, const struct projection *p)
{
    int x = p->x, y = p->y;
    double r = p->range;
    return nearer(nearest, lens, x, y, r) ||
           (nearer(nearest, lens, x - 1, y, r) && nearer(nearest, lens, x + 1, y, r)) ||
           (nearer(nearest, lens, x, y - 1, r) && nearer(nearest, lens, x, y + 1, r));
}

/* ranges: true distances from the centre of the other photo; INFINITY: unknown. */
static bool hidden_by_truth(const float *ranges, const struct camera *lens, const struct projection *p)
{
    for (int y = p->y - 1; y <= p->y + 1; y++)
        for (int x = p->x - 1; x <= p->x + 1; x++)
            if (x >= 0 && y >= 0 && x < lens->width && y < lens->height && !nearer(ranges, lens, x, y, p->range))
                return false;
    return true;
}

static enum status true_ranges(float *ranges, const struct true_photo *photo, struct err *err)
{
    size_t pixels = (size_t)photo->lens.width * (size_t)photo->lens.height;
    struct vec3 *points = photo->along_ray ? NULL : malloc(pixels * sizeof *points);
    if (!photo->along_ray && !points) return err_nomem(err, "true points", pixels * sizeof *points);
    if (points) true_points(points, photo);
    for (size_t i = 0; i < pixels; i++) {
        float range = points ? (float)vec3_length(points[i]) : photo->depth[i];
        ranges[i] = range > 0 ? range : INFINITY;
    }
    free(points);
    return ST_OK;
}

enum status true_occlusion(uint8_t *occluded, const struct true_photo *photo, const struct vec3 *points,
                           const struct true_photo *const *others, int count, struct err *err)
{
    size_t pixels = (size_t)photo->lens.width * (size_t)photo->lens.height, candidates = 0;
    struct mat3 world_from_photo = mat3_transpose(mat3_from_quat(photo->pose.rotation));
    struct projection *projections = malloc(pixels * sizeof *projections);
    float *ranges = NULL;
    if (!projections) err_nomem(err, "warped points", pixels * sizeof *projections);

    for (size_t i = 0; i < pixels; i++) candidates += occluded[i] = vec3_length(points[i]) > 0;
    for (int k = 0; !err->status && candidates && k < count; k++) {
        const struct true_photo *other = others[k];
        size_t size = (size_t)other->lens.width * (size_t)other->lens.height * sizeof *ranges;
        struct warp_job job = {.projections = projections, .points = points, .lens = &other->lens};
        job.rotation = mat3_multiply(mat3_from_quat(other->pose.rotation), world_from_photo);
        job.translation = vec3_sub(other->pose.translation, mat3_apply(job.rotation, photo->pose.translation));
        parallel_for(pixels, CHUNK, warp_points, &job);
        float *grown = realloc(ranges, size);
        if (!grown) {
            err_nomem(err, "depths of another photo", size);
            break;
        }
        ranges = grown;
        if (!other->depth)
            draw_points(ranges, &other->lens, projections, pixels);
        else if (true_ranges(ranges, other, err))
            break;
        for (size_t i = 0; i < pixels; i++) {
            if (!occluded[i] || projections[i].x < 0) continue;
            if (other->depth ? hidden_by_truth(ranges, &other->lens, &projections[i])
                             : hidden_by_points(ranges, &other->lens, &projections[i]))
                continue;
            occluded[i] = 0;
            candidates--;
        }
    }
    free(ranges);
    free(projections);
    return err->status;
}

struct view_job {
    float *z;
    uint8_t *occluded;
    const struct view *view;
    const struct lens *lens;
    const struct true_photo *photo;
    const struct vec3 *points;
    const uint8_t *photo_occluded;
};

static void view_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct view_job *job = ctx;
    const struct view *v = job->view;
    const struct camera *c = &job->lens->camera, *t = &job->photo->lens;
    struct mat3 view_from_photo = mat3_from_quat(job->lens->view_from_photo);
    struct mat3 photo_from_view = mat3_transpose(view_from_photo);
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < v->width; x++) {
            size_t i = y * (size_t)v->width + (size_t)x;
            struct vec3 ray = {(x + 0.5 - v->cx) / v->fx, ((double)y + 0.5 - v->cy) / v->fy, 1};
            double px, py;
            job->z[i] = 0;
            job->occluded[i] = 0;
            if (!camera_project(c, mat3_apply(photo_from_view, ray), &px, &py)) continue;
            px *= (double)t->width / c->width; /* the truth may have another size than the photo */
            py *= (double)t->height / c->height;
            if (!(px >= 0 && py >= 0 && px < t->width && py < t->height)) continue;
            size_t at = (size_t)py * (size_t)t->width + (size_t)px;
            double z = mat3_apply(view_from_photo, job->points[at]).z;
            if (!(z > 0)) continue;
            job->z[i] = (float)z;
            job->occluded[i] = job->photo_occluded[at];
        }
}

void true_depth_in_view(float *z, uint8_t *occluded, const struct view *view, const struct lens *lens,
                        const struct true_photo *photo, const struct vec3 *points, const uint8_t *photo_occluded)
{
    struct view_job job = {z, occluded, view, lens, photo, points, photo_occluded};
    parallel_for((size_t)view->height, ROWS, view_rows, &job);
}
