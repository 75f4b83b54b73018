/* scene.h - synthetic scenes of planes and spheres with painted surfaces, photographed by ray casting.
 *
 * Depths, colours, sparse points and occlusion are known exactly. World: x right, y down, z forward. */
#ifndef REMODEL_TESTS_SEGMENT_SCENE_H
#define REMODEL_TESTS_SEGMENT_SCENE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/capture/camera_set.h"
#include "common/image/image.h"

#define assert_near(a, b, tolerance) assert_true(fabs((double)(a) - (double)(b)) <= (tolerance))

enum { MAX_VIEWS = 6, MAX_SURFACES = 6, MAX_POINTS = 400 };

struct painted_surface {
    struct vec3 center, across, down; /* rectangle: center + s across + t down, |s| and |t| <= 1; across, down square */
    double radius;                    /* > 0: a sphere */
    float colour[3];                  /* linear */
    double cell, contrast;            /* value noise: grain size in the world, contrast 0 .. 1; 0: blank */
    double period;                    /* > 0: stripes across x in place of noise */
    double gloss;                     /* > 0: radiance added by the reflection of a light */
    struct vec3 light;
};

struct scene {
    struct painted_surface surfaces[MAX_SURFACES];
    int surface_count;
    struct view views[MAX_VIEWS];
    double gain[MAX_VIEWS]; /* exposure of each photo; 0: black */
    struct camera_set set;
    struct sfm_image images[MAX_VIEWS];
    struct sfm_point points[MAX_POINTS];
    struct sfm_track tracks[MAX_POINTS][MAX_VIEWS];
    struct sfm_observation observations[MAX_VIEWS][MAX_POINTS];
    bool holes; /* photos have an invalid disc in the middle */
};

static inline double scene_hash(int x, int y, int z)
{
    uint32_t h = (uint32_t)x * 0x9e3779b1u ^ (uint32_t)y * 0x85ebca77u ^ (uint32_t)z * 0xc2b2ae3du;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return (double)(h ^ h >> 15) / 4294967296.0;
}

/* Smooth value noise on a unit lattice, 0 .. 1. */
static inline double scene_noise(double x, double y, double z)
{
    const double at[3] = {x, y, z};
    int cell[3];
    double f[3], sum = 0;
    for (int k = 0; k < 3; k++) {
        cell[k] = (int)floor(at[k]);
        f[k] = at[k] - cell[k];
        f[k] = f[k] * f[k] * (3 - 2 * f[k]);
    }
    for (int k = 0; k < 8; k++)
        sum += (k & 1 ? f[0] : 1 - f[0]) * (k & 2 ? f[1] : 1 - f[1]) * (k & 4 ? f[2] : 1 - f[2]) *
               scene_hash(cell[0] + (k & 1), cell[1] + (k >> 1 & 1), cell[2] + (k >> 2));
    return sum;
}

static inline void scene_paint(const struct painted_surface *s, struct vec3 p, float rgb[3])
{
    for (int c = 0; c < 3; c++) {
        double g = 0;
        if (s->period > 0)
            g = sin(2 * M_PI * p.x / s->period);
        else if (s->contrast > 0)
            g = 1.4 * (scene_noise(p.x / s->cell + 17 * c, p.y / s->cell, p.z / s->cell) - 0.5) +
                0.6 * (scene_noise(3 * p.x / s->cell, 3 * p.y / s->cell + 9 * c, 3 * p.z / s->cell) - 0.5);
        rgb[c] = s->colour[c] * (float)(1 + s->contrast * g);
    }
}

/* The highlight of a flat glossy surface, seen from `eye`: a soft spot around the light's reflection. */
static inline double scene_highlight(const struct painted_surface *s, struct vec3 p, struct vec3 eye)
{
    const struct vec3 n = vec3_normalize(vec3_cross(s->across, s->down));
    const struct vec3 in = vec3_sub(p, eye), to_light = vec3_normalize(vec3_sub(s->light, p));
    const struct vec3 out = vec3_normalize(vec3_sub(in, vec3_scale(n, 2 * vec3_dot(n, in))));
    return s->gloss * exp(-(1 - vec3_dot(out, to_light)) / 0.004);
}

/* Depth along the view's axis and surface at a pixel; HUGE_VAL and -1 where there is none. */
static inline double scene_depth(const struct scene *scene, const struct view *v, double u, double w, int *surface)
{
    const struct vec3 d = vec3_sub(view_unproject(v, u, w, 1), v->center); /* of depth 1 */
    double nearest = HUGE_VAL;
    *surface = -1;
    for (int i = 0; i < scene->surface_count; i++) {
        const struct painted_surface *s = &scene->surfaces[i];
        const struct vec3 to = vec3_sub(s->center, v->center);
        double t;
        if (s->radius > 0) {
            const double dd = vec3_dot(d, d), dt = vec3_dot(d, to),
                         root = dt * dt - dd * (vec3_dot(to, to) - s->radius * s->radius);
            if (!(root >= 0)) continue;
            t = (dt - sqrt(root)) / dd;
        } else {
            const struct vec3 n = vec3_cross(s->across, s->down);
            t = vec3_dot(n, to) / vec3_dot(n, d);
            const struct vec3 p = vec3_sub(vec3_scale(d, t), to);
            if (!(fabs(vec3_dot(p, s->across)) <= vec3_dot(s->across, s->across))) continue;
            if (!(fabs(vec3_dot(p, s->down)) <= vec3_dot(s->down, s->down))) continue;
        }
        if (t > 1e-6 && t < nearest) {
            nearest = t;
            *surface = i;
        }
    }
    return nearest;
}

/* Whether a view other than the first sees what the first shows at (u, v). */
static inline bool scene_seen_elsewhere(const struct scene *scene, double u, double v)
{
    const struct view *first = &scene->views[0];
    int at;
    const struct vec3 p = view_unproject(first, u, v, scene_depth(scene, first, u, v, &at));
    for (int k = 1; k < scene->set.view_count; k++) {
        const struct view *other = &scene->views[k];
        double pu = -1, pv = -1;
        const double z = view_project(other, p, &pu, &pv);
        if (!(z > 0 && pu >= 0 && pv >= 0 && pu < other->width && pv < other->height)) continue;
        if (fabs(scene_depth(scene, other, pu, pv, &at) / z - 1) < 1e-6) return true;
    }
    return false;
}

static inline struct painted_surface *scene_surface(struct scene *s, struct vec3 center)
{
    struct painted_surface *f = &s->surfaces[s->surface_count++];
    *f = (struct painted_surface){.center = center, .colour = {0.35f, 0.3f, 0.25f}, .cell = 0.25, .contrast = 0.8};
    return f;
}

/* A rectangle perpendicular to the z axis, or slanted: its depth grows by `lean` along x. */
static inline struct painted_surface *scene_wall(struct scene *s, double x, double y, double z, double half_x,
                                                 double half_y, double lean)
{
    struct painted_surface *f = scene_surface(s, vec3_make(x, y, z));
    f->across = vec3_make(half_x, 0, half_x * lean);
    f->down = vec3_make(0, half_y, 0);
    return f;
}

/* A view at a position, rotated from the z axis by `yaw` radians about the y axis (to the right). */
static inline struct view *scene_view(struct scene *s, int width, int height, double focal, double x, double y,
                                      double z, double yaw)
{
    static const char *const names[MAX_VIEWS] = {"a", "b", "c", "d", "e", "f"};
    const int i = s->set.view_count++;
    struct view *v = &s->views[i];
    *v = (struct view){.name = names[i], .width = width, .height = height, .fx = focal, .fy = focal};
    v->cx = width / 2.0;
    v->cy = height / 2.0;
    v->cam_from_world = (struct mat3){{{cos(yaw), 0, -sin(yaw)}, {0, 1, 0}, {sin(yaw), 0, cos(yaw)}}};
    v->center = vec3_make(x, y, z);
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
    s->gain[i] = 1;
    s->set.views = s->views;
    s->images[i] = (struct sfm_image){.id = i + 1, .observations = s->observations[i]};
    s->set.model.images = s->images;
    s->set.model.image_count = s->set.view_count;
    return v;
}

/* Adds a point that the views of `mask` observe. */
static inline void scene_point(struct scene *s, struct vec3 position, unsigned mask)
{
    struct sfm_model *m = &s->set.model;
    struct sfm_point *p = &s->points[m->point_count];
    *p = (struct sfm_point){.id = 10 + 3 * m->point_count, .position = position, .track = s->tracks[m->point_count]};
    assert_true(m->point_count++ < MAX_POINTS);
    m->points = s->points;
    for (int i = 0; i < s->set.view_count; i++) {
        double u = 0, w = 0;
        if (!(mask >> i & 1) || !(view_project(&s->views[i], position, &u, &w) > 0)) continue;
        struct sfm_image *image = &s->images[i];
        p->track[p->track_count++] = (struct sfm_track){i, image->observation_count};
        image->observations[image->observation_count++] = (struct sfm_observation){u, w, p->id};
    }
}

/* The points that structure from motion would find: about `count` on textured surfaces, spread over the first view,
 * observed by the views that see them. */
static inline void scene_points(struct scene *s, int count)
{
    const struct view *v = &s->views[0];
    for (int i = 0; i < count; i++) {
        const double u = v->width * scene_hash(i, 1, 2), w = v->height * scene_hash(i, 3, 4);
        unsigned mask = 0;
        int at, seen;
        const double z = scene_depth(s, v, u, w, &at);
        if (at < 0 || !(s->surfaces[at].contrast > 0)) continue;
        const struct vec3 p = view_unproject(v, u, w, z);
        for (int k = 0; k < s->set.view_count; k++) {
            double pu = -1, pw = -1;
            const double there = view_project(&s->views[k], p, &pu, &pw);
            if (!(there > 0 && pu >= 0 && pw >= 0 && pu < s->views[k].width && pw < s->views[k].height)) continue;
            if (fabs(scene_depth(s, &s->views[k], pu, pw, &seen) / there - 1) < 1e-6) mask |= 1u << k;
        }
        if (mask & (mask - 1)) scene_point(s, p, mask);
    }
}

static inline void scene_expose(const struct scene *s, int view_idx, struct image *im)
{
    const struct view *v = &s->views[view_idx];
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            float *rgba = image_at(im, x, y);
            if (s->holes && hypot(x + 0.5 - v->cx, y + 0.5 - v->cy) < v->height / 6.0) continue;
            for (int k = 0; k < 9; k++) {
                float rgb[3] = {0};
                int at;
                const double u = x + (k % 3 + 0.5) / 3, w = y + (k / 3 + 0.5) / 3, z = scene_depth(s, v, u, w, &at);
                if (at >= 0) scene_paint(&s->surfaces[at], view_unproject(v, u, w, z), rgb);
                if (at >= 0 && s->surfaces[at].gloss > 0)
                    for (int c = 0; c < 3; c++)
                        rgb[c] += (float)scene_highlight(&s->surfaces[at], view_unproject(v, u, w, z), v->center);
                for (int c = 0; c < 3; c++) rgba[c] += (float)s->gain[view_idx] * rgb[c] / 9;
            }
            for (int c = 0; c < 3; c++) rgba[c] = linear_from_srgb(rintf(255 * srgb_from_linear(rgba[c])) / 255);
            rgba[3] = 1;
        }
}

/* What a photo depends on, and the photo. */
struct scene_shot {
    struct painted_surface surfaces[MAX_SURFACES];
    struct view view;
    double gain;
    bool holes;
    struct image photo; /* released by nobody: later tests may ask for it */
};

enum { KEPT_SHOTS = 32 };

/* The photo: 3 x 3 rays per pixel, quantized to 8 bits in sRGB, as linear R G B A of at most 1. To make one takes
 * longer than to find the depth, and tests ask for the same one again and again: the last ones are kept. */
static inline enum status scene_photo(void *ctx, int view_idx, struct image *im, struct err *err)
{
    static struct scene_shot kept[KEPT_SHOTS];
    static int next;
    const struct scene *s = ctx;
    const struct view *v = &s->views[view_idx];
    const size_t key = offsetof(struct scene_shot, photo), size = (size_t)v->width * v->height * 4 * sizeof(float);
    struct scene_shot shot;
    bool found = false;
    if (image_init(im, v->width, v->height, 4, err)) return err->status;
    memset(&shot, 0, sizeof shot);
    memcpy(shot.surfaces, s->surfaces, (size_t)s->surface_count * sizeof *s->surfaces);
    memcpy(&shot.view, v, sizeof *v);
    shot.gain = s->gain[view_idx];
    shot.holes = s->holes;
#pragma omp critical(scene_photo)
    for (int i = 0; i < KEPT_SHOTS && !found; i++) {
        found = kept[i].photo.data && !memcmp(&kept[i], &shot, key);
        if (found) memcpy(im->data, kept[i].photo.data, size);
    }
    if (found) return ST_OK;
    scene_expose(s, view_idx, im);
    if (image_init(&shot.photo, v->width, v->height, 4, err)) {
        image_release(im);
        return err->status;
    }
    memcpy(shot.photo.data, im->data, size);
#pragma omp critical(scene_photo)
    {
        image_release(&kept[next].photo);
        memcpy(&kept[next], &shot, sizeof shot);
        next = (next + 1) % KEPT_SHOTS;
    }
    return ST_OK;
}

#endif
