/* planes.h - a scene of two planes, a slanted wall and a tilted board in front of it, and its exact depth maps.
 *
 * World: x right, y down, z forward; the cameras are near the origin. */
#ifndef REMODEL_TESTS_PLANES_H
#define REMODEL_TESTS_PLANES_H

#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/fuse_points/surface.h"

#define assert_near(a, b, tolerance)                                                                      \
    do {                                                                                                  \
        if (!(fabs((double)(a) - (double)(b)) <= (tolerance)))                                            \
            fail_msg("%s is %.9g, wanted %.9g to %g", #a, (double)(a), (double)(b), (double)(tolerance)); \
    } while (0)

enum { WIDTH = 96, HEIGHT = 72, VIEWS = 4, BOARD = 1, WALL = 2 };

static const double sigma = 0.01;

struct world {
    struct view views[VIEWS];
    struct camera_set set;
    struct layered_depth depths[VIEWS];
    int reads;
};

struct flat { /* normal . X = offset; towards the cameras */
    struct vec3 normal;
    double offset;
};

static inline struct flat wall(void)
{
    const struct vec3 n = vec3_normalize(vec3_make(0.3, -0.1, -1));
    return (struct flat){n, vec3_dot(n, vec3_make(0, 0, 4))};
}
static inline struct flat board(void)
{
    const struct vec3 n = vec3_normalize(vec3_make(-0.2, 0.4, -1));
    return (struct flat){n, vec3_dot(n, vec3_make(0, 0, 2.5))};
}
static inline bool on_board(struct vec3 p) { return fabs(p.x - 0.1) < 0.5 && fabs(p.y) < 0.4; }
static inline double distance_to(struct flat f, struct vec3 p) { return vec3_dot(f.normal, p) - f.offset; }

/* The plane as a segment of a view: n . (R^T (X - t)) = d. */
static inline struct depth_segment segment_of(struct flat f, const struct view *v, uint32_t id)
{
    const struct vec3 n = mat3_apply(v->cam_from_world, f.normal);
    const double d = f.offset + vec3_dot(n, v->translation);
    const double a = n.x / (d * v->fx), b = n.y / (d * v->fy);
    return (struct depth_segment){id, 0, {a, b, n.z / d - a * v->cx - b * v->cy}, sigma, 1, 0};
}

static inline struct vec3 cut(struct flat f, const struct view *v, double u, double y)
{
    const struct vec3 ray = vec3_sub(view_unproject(v, u, y, 1), v->center);
    return vec3_add(v->center, vec3_scale(ray, (f.offset - vec3_dot(f.normal, v->center)) / vec3_dot(f.normal, ray)));
}

static inline void make_depth(struct world *w, int i)
{
    struct layered_depth *d = &w->depths[i];
    const struct view *v = &w->views[i];
    struct err err = ERR_INIT;
    layered_depth_release(d);
    assert_ok(layered_depth_init(d, WIDTH, HEIGHT, &err), err);
    d->segments = calloc(2, sizeof *d->segments);
    d->segment_count = 2;
    d->segments[0] = segment_of(board(), v, BOARD);
    d->segments[1] = segment_of(wall(), v, WALL);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const size_t at = (size_t)(y * WIDTH + x);
            const bool near = on_board(cut(board(), v, x + 0.5, y + 0.5));
            const float rgba[2][4] = {{1, 0.25f, 0, 1}, {0, 0.25f, 1, 1}};
            d->interior.id[at] = near ? BOARD : WALL;
            memcpy(d->interior.rgba + 4 * at, rgba[near ? 0 : 1], sizeof rgba[0]);
        }
}

static inline void world_make(struct world *w)
{
    static const struct vec3 centers[VIEWS] = {{-0.3, -0.2, 0}, {0.3, -0.2, 0.1}, {-0.3, 0.2, -0.1}, {0.3, 0.25, 0}};
    *w = (struct world){.set = {.views = w->views, .view_count = VIEWS}};
    for (int i = 0; i < VIEWS; i++) {
        struct view *v = &w->views[i];
        const double turn = 0.05 * (i - 1.5);
        *v = (struct view){&"abcd"[i], WIDTH, HEIGHT, 80, 82, WIDTH / 2.0, HEIGHT / 2.0, .center = centers[i]};
        v->cam_from_world = mat3_from_quat((struct quat){cos(turn / 2), 0, sin(turn / 2), 0});
        v->translation = vec3_scale(mat3_apply(v->cam_from_world, centers[i]), -1);
        make_depth(w, i);
    }
}

static inline void world_release(struct world *w)
{
    for (int i = 0; i < VIEWS; i++) layered_depth_release(&w->depths[i]);
}

static inline void *copy_of(const void *from, size_t bytes)
{
    void *to = malloc(bytes);
    assert_non_null(to);
    return memcpy(to, from, bytes);
}

static inline enum status read_map(void *ctx, int i, struct layered_depth *d, struct err *err)
{
    struct world *w = ctx;
    const struct layered_depth *from = &w->depths[i];
    const size_t pixels = (size_t)from->width * (size_t)from->height;
    (void)err;
    w->reads++;
    *d = (struct layered_depth){.width = from->width, .height = from->height, .segment_count = from->segment_count};
    d->segments = copy_of(from->segments, (size_t)from->segment_count * sizeof *d->segments);
    d->interior.id = copy_of(from->interior.id, pixels * sizeof *d->interior.id);
    d->interior.rgba = copy_of(from->interior.rgba, pixels * 4 * sizeof *d->interior.rgba);
    return ST_OK;
}

static inline struct depth_reader source_of(struct world *w) { return (struct depth_reader){read_map, read_map, w}; }

#endif
