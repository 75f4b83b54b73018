/* line_room.h - the straight edges of an empty room, as cameras at a few places see them. */
#ifndef REMODEL_TESTS_LINE_ROOM_H
#define REMODEL_TESTS_LINE_ROOM_H

#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "common/math/rotation_fit.h"
#include "stages/find_frame/foot_lines.h"
#include "stages/find_frame/frame_levels.h"
#include "stages/find_frame/frame_room.h"
#include "stages/find_frame/frame_walls.h"
#include "stages/find_frame/line_directions.h"
#include "tests/unit/scratch.h"

enum { ROOM_STATIONS = 5, ROOM_TURNS = 6, ROOM_VIEWS = ROOM_STATIONS * ROOM_TURNS, ROOM_EDGES = 64 };

#define ROOM_FLOOR   (-0.4)
#define ROOM_CEILING 2.2

struct line_room_spec {
    uint64_t seed;
    double noise;      /* px, standard deviation of a line's ends */
    double pose_error; /* degrees, of each view */
    double stray;      /* lines of no common direction, as a part of all lines */
    double tilt;       /* degrees: the room leans away from how the cameras are held */
    double heading;    /* degrees: turn of the room about its vertical */
    int stations;
    double moulding; /* 0: none; otherwise two more edges, this far and twice this far below the ceiling */
    double above;    /* 0: none; otherwise a short edge over each wall, this far above the ceiling */
    bool posters;    /* in place of the room's edges, short level ones on the floor, none in line with another */
};

struct line_room {
    struct view views[ROOM_VIEWS];
    struct camera_set set;
    struct world_lines lines;
    struct mat3 room_from_world;
};

/* An edge of the room, in its own frame. */
struct room_edge {
    struct vec3 a, b;
};

static inline double room_normal(const struct rng *rng, uint64_t a, uint64_t b)
{
    return sqrt(-2 * log(1 - rng_uniform(rng, a, 2 * b))) * cos(2 * PI * rng_uniform(rng, a, 2 * b + 1));
}

/* The room: x from -2 to 3, y from -2.5 to 1.5, with a niche in the corner of large x and y; a door and a window. */
static inline int room_edges(struct room_edge edges[ROOM_EDGES], const struct line_room_spec *spec)
{
    static const double corners[][2] = {{-2, -2.5}, {3, -2.5}, {3, 0.5}, {1.8, 0.5}, {1.8, 1.5}, {-2, 1.5}};
    enum { CORNERS = sizeof corners / sizeof *corners };
    int n = 0;
    for (int k = 0; spec->posters && k < 16; k++) {
        const double x = -2 + 0.3 * k, y = k % 2 ? 1.3 - 0.05 * k : -2.4 + 0.05 * k;
        edges[n++] = (struct room_edge){{x, y, ROOM_FLOOR}, {x + 0.3, y, ROOM_FLOOR}};
        edges[n++] = (struct room_edge){{x, y, ROOM_FLOOR}, {x, y + 0.3, ROOM_FLOOR}};
        edges[n++] = (struct room_edge){{x, y, ROOM_FLOOR + 1}, {x, y, ROOM_FLOOR + 1.4}};
    }
    if (spec->posters) return n;
    for (int k = 0; k < CORNERS; k++) {
        const double *p = corners[k], *q = corners[(k + 1) % CORNERS];
        edges[n++] = (struct room_edge){{p[0], p[1], ROOM_FLOOR}, {q[0], q[1], ROOM_FLOOR}};
        edges[n++] = (struct room_edge){{p[0], p[1], ROOM_CEILING}, {q[0], q[1], ROOM_CEILING}};
        edges[n++] = (struct room_edge){{p[0], p[1], ROOM_FLOOR}, {p[0], p[1], ROOM_CEILING}};
        for (int m = 1; spec->moulding > 0 && m < 3; m++)
            edges[n++] = (struct room_edge){{p[0], p[1], ROOM_CEILING - m * spec->moulding},
                                            {q[0], q[1], ROOM_CEILING - m * spec->moulding}};
        const double x = (p[0] + q[0]) / 2, y = (p[1] + q[1]) / 2, high = ROOM_CEILING + spec->above;
        if (spec->above > 0)
            edges[n++] = (struct room_edge){{x, y, high}, {x + 0.2 * (q[0] - p[0]), y + 0.2 * (q[1] - p[1]), high}};
    }
    /* a door in the wall at x = -2, a window in that at y = -2.5 */
    edges[n++] = (struct room_edge){{-2, -1, ROOM_FLOOR}, {-2, -1, 1.6}};
    edges[n++] = (struct room_edge){{-2, -0.1, ROOM_FLOOR}, {-2, -0.1, 1.6}};
    edges[n++] = (struct room_edge){{-2, -1, 1.6}, {-2, -0.1, 1.6}};
    for (int k = 0; k < 2; k++) {
        edges[n++] = (struct room_edge){{0.2 + 1.4 * k, -2.5, 0.5}, {0.2 + 1.4 * k, -2.5, 1.6}};
        edges[n++] = (struct room_edge){{0.2, -2.5, 0.5 + 1.1 * k}, {1.6, -2.5, 0.5 + 1.1 * k}};
    }
    return n;
}

static inline struct mat3 room_rotation(struct vec3 axis, double degrees)
{
    const struct mat3 identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return rotation_turn(identity, vec3_scale(axis, degrees * DEGREE));
}

/* The part of an edge that a view shows; false: none, or too short a one. */
static inline bool room_edge_seen(struct view_line *l, const struct view *view, struct vec3 a, struct vec3 b)
{
    enum { STEPS = 200 };
    int seen = 0;
    for (int k = 0; k <= STEPS; k++) {
        double u, v;
        const struct vec3 p = vec3_add(a, vec3_scale(vec3_sub(b, a), (double)k / STEPS));
        if (!(view_project(view, p, &u, &v) > 0) || !(u > 0 && v > 0 && u < view->width && v < view->height)) {
            if (seen) break;
            continue;
        }
        if (!seen++) l->u0 = u, l->v0 = v;
        l->u1 = u;
        l->v1 = v;
    }
    return seen && hypot(l->u1 - l->u0, l->v1 - l->v0) > 20;
}

static inline void line_room_make(struct line_room *r, const struct line_room_spec *spec)
{
    static const double places[ROOM_STATIONS][3] = {
        {0, 0, 1}, {-1.1, -0.9, 0.9}, {1.6, -1.2, 1.1}, {-0.6, 0.8, 1.05}, {2.1, -0.3, 0.95}};
    const struct rng rng = rng_make(spec->seed, "test", "line_room");
    const struct mat3 world_from_room =
        mat3_multiply(room_rotation(vec3_make(1, 0, 0), spec->tilt), room_rotation(vec3_make(0, 0, 1), spec->heading));
    struct room_edge edges[ROOM_EDGES];
    const int count = room_edges(edges, spec);
    struct err err = ERR_INIT;
    memset(r, 0, sizeof *r);
    r->room_from_world = mat3_transpose(world_from_room);
    r->set.views = r->views;
    for (int s = 0; s < spec->stations; s++)
        for (int t = 0; t < ROOM_TURNS; t++) {
            const int i = r->set.view_count++;
            const double yaw = (360.0 / ROOM_TURNS * t + 17 * s) * DEGREE;
            const struct vec3 ahead = vec3_make(cos(yaw), sin(yaw), 0), down = vec3_make(0, 0, -1),
                              right = vec3_cross(down, ahead);
            const struct mat3 level = {
                {{right.x, right.y, right.z}, {down.x, down.y, down.z}, {ahead.x, ahead.y, ahead.z}}};
            struct view *v = &r->views[i];
            *v = (struct view){.name = "v", .width = 640, .height = 640, .fx = 320, .fy = 320, .cx = 320, .cy = 320};
            v->center = mat3_apply(world_from_room, vec3_make(places[s][0], places[s][1], places[s][2]));
            v->cam_from_world = level;
            v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
            struct line_list list = {0};
            for (int e = 0; e < count; e++) {
                struct view_line l;
                if (!room_edge_seen(&l, v, mat3_apply(world_from_room, edges[e].a),
                                    mat3_apply(world_from_room, edges[e].b)))
                    continue;
                const uint64_t key = (uint64_t)(i * ROOM_EDGES + e);
                l.u0 += spec->noise * room_normal(&rng, key, 0);
                l.v0 += spec->noise * room_normal(&rng, key, 1);
                l.u1 += spec->noise * room_normal(&rng, key, 2);
                l.v1 += spec->noise * room_normal(&rng, key, 3);
                assert_ok(line_list_add(&list, &l, &err), err);
            }
            const int stray = (int)(spec->stray * list.count);
            for (int k = 0; k < stray; k++) {
                const uint64_t key = (uint64_t)(1000000 + i * ROOM_EDGES + k);
                const double u = 640 * rng_uniform(&rng, key, 0), x = 640 * rng_uniform(&rng, key, 1),
                             angle = PI * rng_uniform(&rng, key, 2), half = 15 + 60 * rng_uniform(&rng, key, 3);
                const struct view_line l = {u - half * cos(angle), x - half * sin(angle), u + half * cos(angle),
                                            x + half * sin(angle)};
                assert_ok(line_list_add(&list, &l, &err), err);
            }
            const struct vec3 off = vec3_make(spec->pose_error * room_normal(&rng, (uint64_t)(2000000 + i), 0),
                                              spec->pose_error * room_normal(&rng, (uint64_t)(2000000 + i), 1),
                                              spec->pose_error * room_normal(&rng, (uint64_t)(2000000 + i), 2));
            v->cam_from_world = rotation_turn(level, vec3_scale(off, DEGREE));
            v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
            assert_ok(world_lines_add(&r->lines, v, i, &list, &err), err);
            line_list_release(&list);
        }
    assert_ok(world_lines_place(&r->lines, &r->set, 0.3, &err), err);
}

static inline void line_room_release(struct line_room *r) { world_lines_release(&r->lines); }

/* Up as the cameras are held. */
static inline struct vec3 line_room_up(void) { return vec3_make(0, 0, 1); }

/* Makes the room and finds its directions. Returns the heading of each line, which the caller frees. */
static inline int *line_room_headings(struct room_frame *f, struct line_room *r, const struct line_room_spec *spec)
{
    static const struct frame_params params = FRAME_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    *f = (struct room_frame){0};
    line_room_make(r, spec);
    assert_ok(line_directions_find(f, &r->lines, line_room_up(), &params, &err), err);
    assert_true(f->known);
    int *headings = malloc(((size_t)r->lines.count + 1) * sizeof *headings);
    assert_non_null(headings);
    for (int i = 0; i < r->lines.count; i++) headings[i] = line_heading(f, &r->lines.lines[i]);
    return headings;
}

#endif
