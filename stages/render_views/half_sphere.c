/* half_sphere.c - a half-sphere from the five faces of a cube.
 *
 * The front face is N x N pixels, the four others are the halves next to it. Their pixels are smaller than those of the
 * equirectangular picture, by 1.6 in the middle of a face and 3.1 at its corners, so each pixel is the mean of 2 x 2
 * directions, interpolated linearly in their faces, which overlap by a pixel. Depth and holes are those of the nearest
 * pixel: means of depths would lie between surfaces. */
#include "stages/render_views/half_sphere.h"

#include <math.h>

#include "common/base/parallel.h"

enum { FACES = 5, SAMPLES = 2, MARGIN = 1 };

/* Axes of the faces in the camera's frame: right, down, forward. */
static const struct mat3 face_from_cam[FACES] = {
    {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},  /* front */
    {{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}}, /* left: its right half */
    {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}}, /* right: its left half */
    {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}, /* up: its lower half */
    {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}}, /* down: its upper half */
};

static struct view face_camera(const struct view *camera, int face)
{
    const int n = camera->width, half = n / 2;
    struct view v = *camera;
    v.cam_from_world = mat3_multiply(face_from_cam[face], camera->cam_from_world);
    v.translation = mat3_apply(face_from_cam[face], camera->translation);
    v.fx = v.fy = v.cx = v.cy = n / 2.0;
    if (face == 1 || face == 2) v.width = n - half;
    if (face == 3 || face == 4) v.height = n - half;
    if (face == 1) v.cx = 0;
    if (face == 2) v.cx = n - half;
    if (face == 3) v.cy = 0;
    if (face == 4) v.cy = n - half;
    v.width += 2 * MARGIN;
    v.height += 2 * MARGIN;
    v.cx += MARGIN;
    v.cy += MARGIN;
    return v;
}

struct sphere_job {
    struct rendered_frame *out;
    struct view cameras[FACES];
    struct rendered_frame faces[FACES];
};

/* The face that a direction in the camera's frame meets, and its pixel there. */
static int find_face(const struct sphere_job *job, struct vec3 d, double *u, double *v)
{
    const double ax = fabs(d.x), ay = fabs(d.y);
    const int face = d.z >= ax && d.z >= ay ? 0 : ax >= ay ? (d.x < 0 ? 1 : 2) : d.y < 0 ? 3 : 4;
    const struct view *c = &job->cameras[face];
    const struct vec3 q = mat3_apply(face_from_cam[face], d);
    *u = c->cx + c->fx * q.x / q.z;
    *v = c->cy + c->fy * q.y / q.z;
    return face;
}

static int clamp_int(int i, int below) { return i < 0 ? 0 : i < below ? i : below - 1; }

/* Adds a quarter of the colour at a place of a face. */
static void add_colour(double sum[4], const struct rendered_frame *f, double u, double v)
{
    const double fx = floor(u - 0.5), fy = floor(v - 0.5), a = u - 0.5 - fx, b = v - 0.5 - fy;
    const int x0 = clamp_int((int)fx, f->width), x1 = clamp_int((int)fx + 1, f->width);
    const int y0 = clamp_int((int)fy, f->height), y1 = clamp_int((int)fy + 1, f->height);
    const size_t w = (size_t)f->width;
    const float *p00 = f->rgba + 4 * ((size_t)y0 * w + (size_t)x0), *p10 = f->rgba + 4 * ((size_t)y0 * w + (size_t)x1);
    const float *p01 = f->rgba + 4 * ((size_t)y1 * w + (size_t)x0), *p11 = f->rgba + 4 * ((size_t)y1 * w + (size_t)x1);
    for (int k = 0; k < 4; k++)
        sum[k] += (1 - b) * ((1 - a) * p00[k] + a * p10[k]) + b * ((1 - a) * p01[k] + a * p11[k]);
}

static struct vec3 direction(double x, double y, int n)
{
    const double half_turn = acos(-1), lon = (x / n - 0.5) * half_turn, lat = (y / n - 0.5) * half_turn;
    return vec3_make(cos(lat) * sin(lon), sin(lat), cos(lat) * cos(lon));
}

static void fill_row(const struct sphere_job *job, size_t row)
{
    struct rendered_frame *out = job->out;
    const int n = out->width;
    double u, v;
    for (int x = 0; x < n; x++) {
        const size_t p = row * (size_t)n + (size_t)x;
        double sum[4] = {0};
        for (int s = 0; s < SAMPLES * SAMPLES; s++) {
            const double sx = x + (s % SAMPLES + 0.5) / SAMPLES, sy = (double)row + (s / SAMPLES + 0.5) / SAMPLES;
            const int face = find_face(job, direction(sx, sy, n), &u, &v);
            add_colour(sum, &job->faces[face], u, v);
        }
        for (int k = 0; k < 4; k++) out->rgba[4 * p + (size_t)k] = (float)(sum[k] / (SAMPLES * SAMPLES));
        const struct vec3 d = direction(x + 0.5, (double)row + 0.5, n);
        const int face = find_face(job, d, &u, &v);
        const struct rendered_frame *f = &job->faces[face];
        const size_t at = (size_t)clamp_int((int)v, f->height) * (size_t)f->width + (size_t)clamp_int((int)u, f->width);
        out->z[p] = (float)(f->z[at] * d.z / mat3_apply(face_from_cam[face], d).z);
        out->hole[p] = f->hole[at];
    }
}

static void fill_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    for (size_t row = begin; row < end; row++) fill_row(ctx, row);
}

static void measure(struct rendered_frame *out)
{
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    size_t holes = 0, unfilled = 0;
    for (size_t p = 0; p < pixels; p++) {
        holes += out->hole[p] != 0;
        unfilled += !(out->rgba[4 * p + 3] > 0);
    }
    out->hole_fraction = (double)holes / (double)pixels;
    out->unfilled_fraction = (double)unfilled / (double)pixels;
}

enum status half_sphere_render(struct rendered_frame *out, const struct view *camera, half_sphere_face *face, void *ctx,
                               struct err *err)
{
    struct sphere_job job = {.out = out};
    if (camera->width != camera->height)
        return err_set(err, ST_DATA,
                       "the camera of a half-sphere has %d x %d pixels, wanted a square; plan the eyes again.",
                       camera->width, camera->height);
    rendered_frame_resize(out, camera->width, camera->height, true, err);
    for (int i = 0; !err->status && i < FACES; i++) {
        job.cameras[i] = face_camera(camera, i);
        face(ctx, &job.cameras[i], &job.faces[i], err);
    }
    if (!err->status) {
        parallel_for((size_t)camera->height, 16, fill_rows, &job);
        measure(out);
    }
    for (int i = 0; i < FACES; i++) rendered_frame_release(&job.faces[i]);
    return err->status;
}
