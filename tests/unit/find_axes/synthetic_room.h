/* synthetic_room.h - a room of points with known axes, floor and ceiling, and cameras in it. */
#ifndef REMODEL_TESTS_SYNTHETIC_ROOM_H
#define REMODEL_TESTS_SYNTHETIC_ROOM_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "common/base/rng.h"
#include "stages/find_axes/directions.h"
#include "stages/find_axes/room_axes.h"

enum { ROOM_VIEWS = 4 };

struct room_spec { /* parameters of a room; metres and degrees */
    double noise, normal_noise;
    double outliers;  /* part of all points */
    double furniture; /* part of the floor's points that are moved to tables and chairs */
    bool bed;         /* nine tenths of them lie on a bed */
    double ceiling;   /* part of the ceiling's points that exist */
    bool one_wall_direction;
    struct mat3 world_from_room; /* a rotation */
    double scale;                /* scene units per metre */
    struct vec3 origin;          /* of the room, world */
    uint64_t seed;
};

struct synthetic_room {
    struct point_cloud cloud;
    struct view views[ROOM_VIEWS];
    struct lens lenses[ROOM_VIEWS];
    struct vec3 ups[ROOM_VIEWS];
    struct sfm_image images[ROOM_VIEWS];
    struct camera_set set;
    struct lens_list list;
    struct room_spec spec;
};

static const struct mat3 ROOM_IDENTITY = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
enum { ROOM_POINTS = 60000 };
static const double ROOM_SIZE[3] = {5, 4, 2.6};

static inline struct vec3 room_world(const struct room_spec *m, struct vec3 p)
{
    return vec3_add(mat3_apply(m->world_from_room, vec3_scale(p, m->scale)), m->origin);
}

/* A normally distributed number (Box-Muller). */
static inline double room_gauss(const struct rng *rng, uint64_t i, uint64_t k)
{
    const double u = 1 - rng_uniform(rng, i, k), v = rng_uniform(rng, i, k + 1);
    return sqrt(-2 * log(u)) * cos(2 * M_PI * v);
}

static inline struct vec3 room_direction(const struct rng *rng, uint64_t i, uint64_t k)
{
    return vec3_normalize(vec3_make(room_gauss(rng, i, k), room_gauss(rng, i, k + 2), room_gauss(rng, i, k + 4)));
}

/* The i-th point of the room's surfaces and its normal; false: there is none. */
static inline bool room_point(const struct room_spec *m, const struct rng *rng, uint64_t i, double p[3], double n[3])
{
    const double pick = rng_uniform(rng, i, 0);
    const int axis = pick < 0.3 ? 2 : pick < 0.65 ? 0 : 1;
    const bool high = rng_uniform(rng, i, 1) < 0.5;
    for (int k = 0; k < 3; k++) p[k] = ROOM_SIZE[k] * rng_uniform(rng, i, 2 + (uint64_t)k);
    n[0] = n[1] = n[2] = 0;
    n[axis] = high ? -1 : 1;
    p[axis] = high ? ROOM_SIZE[axis] : 0;
    if (axis == 1 && m->one_wall_direction) return false;
    if (axis == 2 && high && rng_uniform(rng, i, 5) >= m->ceiling) return false;
    if (axis == 2 && !high && rng_uniform(rng, i, 5) < m->furniture) /* tops of a chair, a table and a board */
        p[2] = rng_uniform(rng, i, 6) < 0.4 || (m->bed && rng_uniform(rng, i, 6) < 0.9) ? 0.45
               : rng_uniform(rng, i, 6) < 0.8                                           ? 0.75
                                                                                        : 1.2;
    for (int k = 0; k < 3; k++) p[k] += m->noise * room_gauss(rng, i, 10 + 2 * (uint64_t)k);
    const struct vec3 off =
        vec3_scale(vec3_make(room_gauss(rng, i, 20), room_gauss(rng, i, 22), room_gauss(rng, i, 24)),
                   m->normal_noise * M_PI / 180);
    const struct vec3 normal = vec3_normalize(vec3_add(vec3_make(n[0], n[1], n[2]), off));
    n[0] = normal.x;
    n[1] = normal.y;
    n[2] = normal.z;
    if (rng_uniform(rng, i, 7) < m->outliers) { /* at a random position, with a random normal */
        const struct vec3 d = room_direction(rng, i, 30);
        for (int k = 0; k < 3; k++) p[k] = ROOM_SIZE[k] * (1.4 * rng_uniform(rng, i, 40 + (uint64_t)k) - 0.2);
        n[0] = d.x;
        n[1] = d.y;
        n[2] = d.z;
    }
    return true;
}

static inline void add_room_point(struct synthetic_room *r, struct vec3 at, struct vec3 normal)
{
    struct cloud_point *q = &r->cloud.points[r->cloud.count++];
    *q = (struct cloud_point){.position = room_world(&r->spec, at), .views = 3, .confidence = 1};
    cloud_set_normal(q, mat3_apply(r->spec.world_from_room, normal));
}

/* Four upright cameras at about 1.5 m, turned by 20 to 290 degrees, each a photo with the same pinhole lens. */
static inline void make_cameras(struct synthetic_room *r)
{
    static const double at[ROOM_VIEWS][3] = {{2.4, 1.9, 1.5}, {1, 1, 1.4}, {4, 1, 1.5}, {2, 3, 1.6}};
    static const double turns[ROOM_VIEWS] = {20, 60, 130, 290};
    static char names[ROOM_VIEWS][2] = {"a", "b", "c", "d"};
    for (int i = 0; i < ROOM_VIEWS; i++) {
        const double c = cos(turns[i] * M_PI / 180), s = sin(turns[i] * M_PI / 180), tilt = -0.2;
        struct view *v = &r->views[i];
        /* rows: right, down, forward; the camera looks along (c, s) and slightly down */
        const struct vec3 right = vec3_make(s, -c, 0), forward = vec3_normalize(vec3_make(c, s, tilt));
        const struct vec3 down = vec3_cross(forward, right);
        const struct mat3 cam_from_room = {
            {{right.x, right.y, right.z}, {down.x, down.y, down.z}, {forward.x, forward.y, forward.z}}};
        *v = (struct view){.name = names[i], .width = 800, .height = 600, .fx = 400, .fy = 400, .cx = 400, .cy = 300};
        v->cam_from_world = mat3_multiply(cam_from_room, mat3_transpose(r->spec.world_from_room));
        v->center = room_world(&r->spec, vec3_make(at[i][0], at[i][1], at[i][2]));
        v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
        r->ups[i] = vec3_make(0, -1, 0);
        r->lenses[i] =
            (struct lens){names[i], names[i], {CAMERA_PINHOLE, 800, 600, {400, 400, 400, 300}}, {1, 0, 0, 0}};
    }
    r->set = (struct camera_set){.views = r->views, .view_count = ROOM_VIEWS};
    r->list = (struct lens_list){r->lenses, ROOM_VIEWS};
}

static inline void synthetic_room_make(struct synthetic_room *r, const struct room_spec *spec)
{
    const struct rng rng = rng_make(spec->seed, "test", "room");
    *r = (struct synthetic_room){.spec = *spec};
    r->cloud.points = calloc(ROOM_POINTS, sizeof *r->cloud.points);
    r->cloud.cell = 0.01 * spec->scale;
    assert_non_null(r->cloud.points);
    for (uint64_t i = 0; i < ROOM_POINTS; i++) {
        double p[3], n[3];
        if (room_point(spec, &rng, i, p, n))
            add_room_point(r, vec3_make(p[0], p[1], p[2]), vec3_make(n[0], n[1], n[2]));
    }
    make_cameras(r);
}

static inline struct room_inputs room_inputs(const struct synthetic_room *r)
{
    return (struct room_inputs){.set = &r->set, .lenses = &r->list, .ups = r->ups, .cloud = &r->cloud};
}

/* The pixel of a room's point in a view. */
static inline void room_pixel(const struct synthetic_room *r, int view, struct vec3 p, double *u, double *v)
{
    assert_true(view_project(&r->views[view], room_world(&r->spec, p), u, v) > 0);
}

/* Degrees between the found axes and the true ones, at the best of four quarter turns. */
static inline double room_angle(const struct synthetic_room *r, const struct model_axes *a)
{
    const struct mat3 found = mat3_multiply(mat3_from_quat(a->rotation), r->spec.world_from_room);
    double worst = 0;
    for (int k = 0; k < 3; k++) {
        const double c = fmax(fabs(found.m[k][0]), fmax(fabs(found.m[k][1]), fabs(found.m[k][2])));
        worst = fmax(worst, acos(fmin(c, 1)) * 180 / M_PI);
    }
    assert_true(found.m[2][2] > 0.9);
    return worst;
}

/* Metres from the true floor to the found one. */
static inline double room_floor(const struct synthetic_room *r, const struct model_axes *a)
{
    const struct vec3 middle = room_world(&r->spec, vec3_make(ROOM_SIZE[0] / 2, ROOM_SIZE[1] / 2, 0));
    return -model_from_world_point(a, middle).z / a->scale / r->spec.scale;
}

static inline void synthetic_room_release(struct synthetic_room *r) { point_cloud_release(&r->cloud); }

#endif
