/* made_room.h - a room of points with known axes, floor and ceiling, and cameras in it. */
#ifndef REMODEL_TESTS_MADE_ROOM_H
#define REMODEL_TESTS_MADE_ROOM_H

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
#include "stages/find_axes/room.h"

enum { MADE_VIEWS = 4 };

struct made { /* what to make; metres and degrees */
    double noise, normal_noise;
    double outliers;  /* part of all points */
    double furniture; /* part of the floor's points that stand on tables and chairs in its place */
    double ceiling;   /* part of the ceiling's points that are there */
    bool one_wall_direction;
    struct mat3 world_from_room; /* a rotation */
    double scale;                /* scene units per metre */
    struct vec3 origin;          /* of the room, world */
    uint64_t seed;
};

struct made_room {
    struct point_cloud cloud;
    struct view views[MADE_VIEWS];
    struct lens lenses[MADE_VIEWS];
    struct vec3 ups[MADE_VIEWS];
    struct sfm_image images[MADE_VIEWS];
    struct camera_set set;
    struct lens_list list;
    struct made made;
};

static const struct mat3 MADE_IDENTITY = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
enum { MADE_POINTS = 60000 };
static const double MADE_SIZE[3] = {5, 4, 2.6};

static inline struct vec3 made_world(const struct made *m, struct vec3 p)
{
    return vec3_add(mat3_apply(m->world_from_room, vec3_scale(p, m->scale)), m->origin);
}

/* Of the normal distribution, by Box and Muller. */
static inline double made_gauss(const struct rng *rng, uint64_t i, uint64_t k)
{
    const double u = 1 - rng_uniform(rng, i, k), v = rng_uniform(rng, i, k + 1);
    return sqrt(-2 * log(u)) * cos(2 * M_PI * v);
}

static inline struct vec3 made_direction(const struct rng *rng, uint64_t i, uint64_t k)
{
    return vec3_normalize(vec3_make(made_gauss(rng, i, k), made_gauss(rng, i, k + 2), made_gauss(rng, i, k + 4)));
}

/* A point of the room's surfaces and its normal; false: there is none. */
static inline bool made_point(const struct made *m, const struct rng *rng, uint64_t i, double p[3], double n[3])
{
    const double pick = rng_uniform(rng, i, 0);
    const int axis = pick < 0.3 ? 2 : pick < 0.65 ? 0 : 1;
    const bool high = rng_uniform(rng, i, 1) < 0.5;
    for (int k = 0; k < 3; k++) p[k] = MADE_SIZE[k] * rng_uniform(rng, i, 2 + (uint64_t)k);
    n[0] = n[1] = n[2] = 0;
    n[axis] = high ? -1 : 1;
    p[axis] = high ? MADE_SIZE[axis] : 0;
    if (axis == 1 && m->one_wall_direction) return false;
    if (axis == 2 && high && rng_uniform(rng, i, 5) >= m->ceiling) return false;
    if (axis == 2 && !high && rng_uniform(rng, i, 5) < m->furniture) /* tops of a chair, a table and a board */
        p[2] = rng_uniform(rng, i, 6) < 0.4 ? 0.45 : rng_uniform(rng, i, 6) < 0.8 ? 0.75 : 1.2;
    for (int k = 0; k < 3; k++) p[k] += m->noise * made_gauss(rng, i, 10 + 2 * (uint64_t)k);
    const struct vec3 off =
        vec3_scale(vec3_make(made_gauss(rng, i, 20), made_gauss(rng, i, 22), made_gauss(rng, i, 24)),
                   m->normal_noise * M_PI / 180);
    const struct vec3 normal = vec3_normalize(vec3_add(vec3_make(n[0], n[1], n[2]), off));
    n[0] = normal.x;
    n[1] = normal.y;
    n[2] = normal.z;
    if (rng_uniform(rng, i, 7) < m->outliers) { /* anywhere, looking anywhere */
        const struct vec3 d = made_direction(rng, i, 30);
        for (int k = 0; k < 3; k++) p[k] = MADE_SIZE[k] * (1.4 * rng_uniform(rng, i, 40 + (uint64_t)k) - 0.2);
        n[0] = d.x;
        n[1] = d.y;
        n[2] = d.z;
    }
    return true;
}

static inline void add_made_point(struct made_room *r, struct vec3 at, struct vec3 normal)
{
    struct cloud_point *q = &r->cloud.points[r->cloud.count++];
    *q = (struct cloud_point){.position = made_world(&r->made, at), .views = 3, .confidence = 1};
    cloud_set_normal(q, mat3_apply(r->made.world_from_room, normal));
}

/* Four cameras at 1.5 m, turned by 20 to 350 degrees, upright; each its own photo, with the same pinhole lens. */
static inline void make_cameras(struct made_room *r)
{
    static const double at[MADE_VIEWS][3] = {{2.4, 1.9, 1.5}, {1, 1, 1.4}, {4, 1, 1.5}, {2, 3, 1.6}};
    static const double turns[MADE_VIEWS] = {20, 60, 130, 290};
    static char names[MADE_VIEWS][2] = {"a", "b", "c", "d"};
    for (int i = 0; i < MADE_VIEWS; i++) {
        const double c = cos(turns[i] * M_PI / 180), s = sin(turns[i] * M_PI / 180), tilt = -0.2;
        struct view *v = &r->views[i];
        /* rows: right, down, forward; looking along (c, s) and a little down */
        const struct vec3 right = vec3_make(s, -c, 0), forward = vec3_normalize(vec3_make(c, s, tilt));
        const struct vec3 down = vec3_cross(forward, right);
        const struct mat3 cam_from_room = {
            {{right.x, right.y, right.z}, {down.x, down.y, down.z}, {forward.x, forward.y, forward.z}}};
        *v = (struct view){.name = names[i], .width = 800, .height = 600, .fx = 400, .fy = 400, .cx = 400, .cy = 300};
        v->cam_from_world = mat3_multiply(cam_from_room, mat3_transpose(r->made.world_from_room));
        v->center = made_world(&r->made, vec3_make(at[i][0], at[i][1], at[i][2]));
        v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
        r->ups[i] = vec3_make(0, -1, 0);
        r->lenses[i] =
            (struct lens){names[i], names[i], {CAMERA_PINHOLE, 800, 600, {400, 400, 400, 300}}, {1, 0, 0, 0}};
    }
    r->set = (struct camera_set){.views = r->views, .view_count = MADE_VIEWS};
    r->list = (struct lens_list){r->lenses, MADE_VIEWS};
}

static inline void make_room(struct made_room *r, const struct made *made)
{
    const struct rng rng = rng_make(made->seed, "test", "room");
    *r = (struct made_room){.made = *made};
    r->cloud.points = calloc(MADE_POINTS, sizeof *r->cloud.points);
    r->cloud.cell = 0.01 * made->scale;
    assert_non_null(r->cloud.points);
    for (uint64_t i = 0; i < MADE_POINTS; i++) {
        double p[3], n[3];
        if (made_point(made, &rng, i, p, n))
            add_made_point(r, vec3_make(p[0], p[1], p[2]), vec3_make(n[0], n[1], n[2]));
    }
    make_cameras(r);
}

static inline struct room_inputs made_inputs(const struct made_room *r)
{
    return (struct room_inputs){.set = &r->set, .lenses = &r->list, .ups = r->ups, .cloud = &r->cloud};
}

/* The pixel of a room's point in a view. */
static inline void made_pixel(const struct made_room *r, int view, struct vec3 p, double *u, double *v)
{
    assert_true(view_project(&r->views[view], made_world(&r->made, p), u, v) > 0);
}

/* Degrees between the axes that were found and the true ones, at the best of four quarter turns. */
static inline double made_angle(const struct made_room *r, const struct model_axes *a)
{
    const struct mat3 found = mat3_multiply(mat3_from_quat(a->rotation), r->made.world_from_room);
    double worst = 0;
    for (int k = 0; k < 3; k++) {
        const double c = fmax(fabs(found.m[k][0]), fmax(fabs(found.m[k][1]), fabs(found.m[k][2])));
        worst = fmax(worst, acos(fmin(c, 1)) * 180 / M_PI);
    }
    assert_true(found.m[2][2] > 0.9);
    return worst;
}

/* Metres from the true floor to the one that was found. */
static inline double made_floor(const struct made_room *r, const struct model_axes *a)
{
    const struct vec3 middle = made_world(&r->made, vec3_make(MADE_SIZE[0] / 2, MADE_SIZE[1] / 2, 0));
    return -model_from_world_point(a, middle).z / a->scale / r->made.scale;
}

static inline void made_release(struct made_room *r) { point_cloud_release(&r->cloud); }

#endif
