/* made_plan.h - points that cameras see of a made plan of walls and boxes, by rays, with noise and stray points. */
#ifndef REMODEL_TESTS_MADE_PLAN_H
#define REMODEL_TESTS_MADE_PLAN_H

#include <math.h>

#include "common/base/rng.h"
#include "stages/suggest_model/suggest.h"

enum { MADE_WALLS = 64, MADE_VIEWS = 64, MADE_SIDE = 64 };

struct made_wall {
    double a[2], b[2], foot, top; /* seen from both sides */
};
struct made_plan {
    struct made_wall walls[MADE_WALLS];
    int wall_count;
    double high, low[2], most[2]; /* of the ceiling; bounds of floor and ceiling */
    struct view views[MADE_VIEWS];
    int view_count;
    double noise, stray; /* of the distance; share of the points */
};

static inline void made_wall(struct made_plan *p, double ax, double ay, double bx, double by, double foot, double top)
{
    p->walls[p->wall_count++] = (struct made_wall){{ax, ay}, {bx, by}, foot, top};
}

/* The walls of a closed or open line of corners. */
static inline void made_line(struct made_plan *p, const double (*corners)[2], int count, bool closed)
{
    for (int i = 0; i + (closed ? 0 : 1) < count; i++)
        made_wall(p, corners[i][0], corners[i][1], corners[(i + 1) % count][0], corners[(i + 1) % count][1], 0,
                  p->high);
}

static inline void made_box(struct made_plan *p, double x0, double y0, double x1, double y1, double top)
{
    made_wall(p, x0, y0, x1, y0, 0, top);
    made_wall(p, x1, y0, x1, y1, 0, top);
    made_wall(p, x1, y1, x0, y1, 0, top);
    made_wall(p, x0, y1, x0, y0, 0, top);
}

/* The k-th of four views in all directions, 96 degrees wide. */
static inline void look_around(struct view *view, struct vec3 at, int k)
{
    const double a = k * M_PI / 2, c = cos(a), s = sin(a);
    *view = (struct view){.name = "v", .width = 400, .height = 400, .fx = 180, .fy = 180, .cx = 200, .cy = 200};
    view->cam_from_world = (struct mat3){{{s, -c, 0}, {0, 0, -1}, {c, s, 0}}};
    view->center = at;
    view->translation = vec3_scale(mat3_apply(view->cam_from_world, at), -1);
}

static inline void made_camera(struct made_plan *p, double x, double y)
{
    for (int k = 0; k < 4; k++) look_around(&p->views[p->view_count++], vec3_make(x, y, 1.4), k);
}

static inline double gauss(const struct rng *rng, uint64_t i, uint64_t k)
{
    return sqrt(-2 * log(1 - rng_uniform(rng, i, k))) * cos(2 * M_PI * rng_uniform(rng, i, k + 1));
}

/* The depth t at which the ray from c along d meets the plan, and the normal there; false: nowhere. */
static inline bool made_hit(const struct made_plan *p, struct vec3 c, struct vec3 d, double *t, struct vec3 *n)
{
    *t = HUGE_VAL;
    for (int k = 0; k < 2; k++) { /* floor and ceiling */
        const double z = k ? p->high : 0, at = (z - c.z) / d.z, x = c.x + at * d.x, y = c.y + at * d.y;
        if (!(at > 0 && at < *t) || x < p->low[0] || y < p->low[1] || x > p->most[0] || y > p->most[1]) continue;
        *t = at;
        *n = vec3_make(0, 0, k ? -1 : 1);
    }
    for (int i = 0; i < p->wall_count; i++) {
        const struct made_wall *w = &p->walls[i];
        const double ex = w->b[0] - w->a[0], ey = w->b[1] - w->a[1], det = d.x * ey - d.y * ex;
        const double px = w->a[0] - c.x, py = w->a[1] - c.y;
        const double at = (px * ey - py * ex) / det, s = (px * d.y - py * d.x) / det, z = c.z + at * d.z;
        if (!(at > 0 && at < *t && s >= 0 && s <= 1 && z >= w->foot && z <= w->top)) continue;
        *t = at;
        *n = vec3_normalize(vec3_make(ey, -ex, 0));
        if (vec3_dot(*n, d) > 0) *n = vec3_scale(*n, -1);
    }
    return *t < 12;
}

/* What all views see; the caller frees the points. */
static inline struct point_cloud made_points(const struct made_plan *p, uint64_t seed)
{
    const struct rng rng = rng_make(seed, "suggest", "made");
    struct point_cloud cloud = {.points = calloc((size_t)p->view_count * MADE_SIDE * MADE_SIDE, sizeof *cloud.points)};
    for (int v = 0; cloud.points && v < p->view_count; v++)
        for (int k = 0; k < MADE_SIDE * MADE_SIDE; k++) {
            const uint64_t i = (uint64_t)v * MADE_SIDE * MADE_SIDE + (uint64_t)k;
            const struct view *view = &p->views[v];
            const double px = (k % MADE_SIDE + rng_uniform(&rng, i, 0)) * view->width / MADE_SIDE;
            const double py = (k / MADE_SIDE + rng_uniform(&rng, i, 1)) * view->height / MADE_SIDE;
            const struct vec3 d = vec3_sub(view_unproject(view, px, py, 1), view->center);
            struct vec3 n;
            double t;
            if (!made_hit(p, view->center, d, &t, &n)) continue;
            const bool stray = rng_uniform(&rng, i, 2) < p->stray;
            t *= stray ? 0.3 + 1.2 * rng_uniform(&rng, i, 3) : 1 + p->noise * gauss(&rng, i, 4);
            n = vec3_normalize(vec3_add(n, vec3_make(0.1 * gauss(&rng, i, 6), 0.1 * gauss(&rng, i, 8), 0)));
            if (vec3_dot(n, d) >= 0) continue;
            cloud.points[cloud.count++] = (struct cloud_point){.position = vec3_add(view->center, vec3_scale(d, t)),
                                                               .normal = {(float)n.x, (float)n.y, (float)n.z},
                                                               .views = 4,
                                                               .confidence = 1};
        }
    return cloud;
}

#endif
