/* glossy_room.h - a box room of known radiance, and what its glossy floor shows: truth for fits of materials.
 *
 * The walls and the ceiling have one radiance each, but for panels: lamps, windows, a dark door. What the floor
 * reflects is integrated over their areas, by Lambert's formula for polygons and by Gauss' rule on cells that are small
 * beside the lobe. The fit integrates over directions instead, by rays through room_look(). */
#ifndef REMODEL_GLOSSY_ROOM_H
#define REMODEL_GLOSSY_ROOM_H

#include <math.h>

#include "common/base/rng.h"
#include "common/gather/light_field.h"
#include "common/light/brdf.h"
#include "common/math/numbers.h"

enum { ROOM_WALLS = 5, ROOM_PANELS = 6 }; /* walls: x = 0, x = max, y = 0, y = max, ceiling */

struct room_panel {
    struct vec3 centre, x, y; /* half edges */
    struct rgb radiance;
    int wall;
};

struct glossy_room {
    struct vec3 size;
    struct room_panel wall[ROOM_WALLS], panel[ROOM_PANELS];
    struct emitter emitters[ROOM_PANELS];
    int emitter_count;
};

static inline double room_random(const struct rng *rng, uint64_t room, int *at, double low, double high)
{
    return low + (high - low) * rng_uniform(rng, room, (uint64_t)(*at)++);
}

static inline void room_add_panel(struct glossy_room *r, int i, int wall, double u, double v, double half_u,
                                  double half_v, struct rgb radiance)
{
    const struct room_panel *w = &r->wall[wall];
    const double lu = vec3_length(w->x), lv = vec3_length(w->y);
    r->panel[i] = (struct room_panel){vec3_add(w->centre, vec3_add(vec3_scale(w->x, u), vec3_scale(w->y, v))),
                                      vec3_scale(w->x, half_u / lu), vec3_scale(w->y, half_v / lv), radiance, wall};
    if (rgb_luminance(radiance) > 3) {
        const struct room_panel *p = &r->panel[i];
        r->emitters[r->emitter_count++] = (struct emitter){
            EMITTER_QUAD, p->centre, p->x, p->y, vec3_normalize(vec3_cross(p->x, p->y)), 0, rgb_luminance(radiance),
            PI / 2,       0};
    }
}

/* A random room: two lamps, a small spot, two windows, a dark door. */
static inline void room_make(struct glossy_room *r, uint64_t seed)
{
    const struct rng rng = rng_make(seed, "glossy_room", "room");
    int at = 0;
    *r = (struct glossy_room){.size = vec3_make(5, 4, 2.7)};
    const struct vec3 h = vec3_scale(r->size, 0.5), x = {h.x, 0, 0}, y = {0, h.y, 0}, z = {0, 0, h.z};
    /* x cross y points into the room */
    const struct room_panel walls[ROOM_WALLS] = {{{0, h.y, h.z}, y, z, {0, 0, 0}, 0},
                                                 {{r->size.x, h.y, h.z}, z, y, {0, 0, 0}, 1},
                                                 {{h.x, 0, h.z}, z, x, {0, 0, 0}, 2},
                                                 {{h.x, r->size.y, h.z}, x, z, {0, 0, 0}, 3},
                                                 {{h.x, h.y, r->size.z}, y, x, {0, 0, 0}, 4}};
    for (int w = 0; w < ROOM_WALLS; w++) {
        r->wall[w] = walls[w];
        const double grey = room_random(&rng, seed, &at, 0.2, 1);
        r->wall[w].radiance =
            rgb_make(grey, grey * room_random(&rng, seed, &at, 0.7, 1), grey * room_random(&rng, seed, &at, 0.5, 1));
    }
    for (int i = 0; i < 2; i++) {
        const double lamp = room_random(&rng, seed, &at, 8, 30);
        room_add_panel(r, i, 4, room_random(&rng, seed, &at, -0.5, 0.5), i ? 0.5 : -0.5,
                       room_random(&rng, seed, &at, 0.15, 0.5), room_random(&rng, seed, &at, 0.15, 0.5),
                       rgb_make(lamp, 0.9 * lamp, 0.7 * lamp));
    }
    const double spot = room_random(&rng, seed, &at, 60, 200), sky = room_random(&rng, seed, &at, 4, 15);
    room_add_panel(r, 2, 4, room_random(&rng, seed, &at, -0.8, 0.8), 0, 0.1, 0.1,
                   rgb_make(spot, 0.85 * spot, 0.6 * spot));
    room_add_panel(r, 3, 0, room_random(&rng, seed, &at, -0.4, 0.4), 0.1, room_random(&rng, seed, &at, 0.3, 0.8), 0.6,
                   rgb_make(0.8 * sky, sky, 1.2 * sky));
    room_add_panel(r, 4, 3, room_random(&rng, seed, &at, -0.4, 0.4), 0.1, room_random(&rng, seed, &at, 0.3, 0.8), 0.6,
                   rgb_make(0.9 * sky, sky, 1.1 * sky));
    room_add_panel(r, 5, 1, -0.2, room_random(&rng, seed, &at, -0.6, 0.6), 1, 0.4, rgb_make(0.05, 0.04, 0.03));
}

static inline bool room_panel_holds(const struct room_panel *p, struct vec3 at)
{
    const struct vec3 off = vec3_sub(at, p->centre);
    return fabs(vec3_dot(off, p->x)) <= vec3_dot(p->x, p->x) && fabs(vec3_dot(off, p->y)) <= vec3_dot(p->y, p->y);
}

static inline struct light_look room_seen(const struct glossy_room *r, struct vec3 from, struct vec3 d)
{
    const double o[3] = {from.x, from.y, from.z}, u[3] = {d.x, d.y, d.z}, size[3] = {r->size.x, r->size.y, r->size.z};
    double nearest = INFINITY;
    int wall = -1;
    for (int k = 0; k < 3; k++) {
        if (u[k] == 0) continue;
        const double t = ((u[k] > 0 ? size[k] : 0) - o[k]) / u[k];
        if (t < nearest) nearest = t, wall = k == 2 ? (u[k] > 0 ? 4 : -1) : 2 * k + (u[k] > 0);
    }
    struct light_look seen = {{0, 0, 0}, nearest, LIGHT_TEXTURE, -1};
    if (wall < 0) return seen;
    const struct vec3 at = vec3_add(from, vec3_scale(d, nearest));
    seen.radiance = r->wall[wall].radiance;
    for (int i = 0; i < ROOM_PANELS; i++)
        if (r->panel[i].wall == wall && room_panel_holds(&r->panel[i], at)) {
            seen.radiance = r->panel[i].radiance;
            seen.source = rgb_luminance(seen.radiance) > 3 ? LIGHT_LAMP : LIGHT_TEXTURE;
        }
    return seen;
}

static inline void room_look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                             const struct vec3 direction[RAY_PACKET], unsigned active,
                             struct light_look seen[RAY_PACKET])
{
    (void)normal;
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1) seen[k] = room_seen(ctx, from[k], direction[k]);
}

static inline struct light_field room_field(const struct glossy_room *r)
{
    return (struct light_field){r, room_look, r->emitters, r->emitter_count};
}

/* ------------------------------------------------------------------------------------------------------------ truth */

/* Lambert's formula: the irradiance of a floor point from a parallelogram above the floor, of radiance 1. */
static inline double room_form_factor(const struct room_panel *p, struct vec3 at)
{
    static const double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    struct vec3 to[4];
    double sum = 0;
    for (int k = 0; k < 4; k++)
        to[k] = vec3_normalize(vec3_sub(
            vec3_add(p->centre, vec3_add(vec3_scale(p->x, corner[k][0]), vec3_scale(p->y, corner[k][1]))), at));
    for (int k = 0; k < 4; k++) {
        const struct vec3 across = vec3_cross(to[k], to[(k + 1) % 4]);
        const double sine = vec3_length(across), angle = atan2(sine, vec3_dot(to[k], to[(k + 1) % 4]));
        if (sine > 0) sum += angle * across.z / sine;
    }
    return fabs(sum) / 2;
}

struct room_lobe {
    const struct brdf *b;
    struct vec3 at, view, mirror;
    double width; /* radians */
};

static inline double room_cell(const struct room_lobe *l, struct vec3 centre, struct vec3 x, struct vec3 y)
{
    static const double node[3] = {-0.7745966692414834, 0, 0.7745966692414834}, weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    const struct vec3 up = {0, 0, 1}, across = vec3_cross(x, y);
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const struct vec3 to =
                vec3_sub(vec3_add(centre, vec3_add(vec3_scale(x, node[i]), vec3_scale(y, node[j]))), l->at);
            const double r2 = vec3_dot(to, to), r = sqrt(r2);
            double pdf;
            const struct rgb f = brdf_eval(l->b, up, l->view, vec3_scale(to, 1 / r), &pdf);
            sum += weight[i] * weight[j] * f.r * fabs(vec3_dot(across, to)) / (r2 * r);
        }
    return sum;
}

static inline double room_lobe_over(const struct room_lobe *l, struct vec3 centre, struct vec3 x, struct vec3 y)
{
    const struct vec3 to = vec3_sub(centre, l->at);
    const double distance = vec3_length(to), radius = vec3_length(x) + vec3_length(y);
    const double reach = radius < distance ? asin(radius / distance) : PI;
    const double off = acos(clamp(vec3_dot(to, l->mirror) / distance, -1, 1));
    if (off - reach > 7 * l->width) return 0;
    if (reach < 0.4 * fmin(l->width, 0.6)) return room_cell(l, centre, x, y);
    const struct vec3 hx = vec3_scale(x, 0.5), hy = vec3_scale(y, 0.5);
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += room_lobe_over(
            l, vec3_add(centre, vec3_add(vec3_scale(hx, k & 1 ? 1 : -1), vec3_scale(hy, k & 2 ? 1 : -1))), hx, hy);
    return sum;
}

/* Irradiance of a floor point, and what the lobe of b (its albedo 0) reflects of the room to a viewer. */
static inline struct rgb room_irradiance(const struct glossy_room *r, struct vec3 at)
{
    struct rgb sum = rgb_grey(0);
    for (int w = 0; w < ROOM_WALLS; w++)
        sum = rgb_add(sum, rgb_scale(r->wall[w].radiance, room_form_factor(&r->wall[w], at)));
    for (int i = 0; i < ROOM_PANELS; i++) {
        const struct room_panel *p = &r->panel[i];
        const struct rgb more = rgb_add(p->radiance, rgb_scale(r->wall[p->wall].radiance, -1));
        sum = rgb_add(sum, rgb_scale(more, room_form_factor(p, at)));
    }
    return sum;
}

static inline struct rgb room_reflection(const struct glossy_room *r, const struct brdf *b, struct vec3 at,
                                         struct vec3 view)
{
    const struct room_lobe l = {b, at, view, vec3_make(-view.x, -view.y, view.z),
                                b->kind == BRDF_WARD ? 2 * b->shape : 1 / sqrt(b->shape)};
    struct rgb sum = rgb_grey(0);
    for (int w = 0; w < ROOM_WALLS; w++)
        sum = rgb_add(
            sum, rgb_scale(r->wall[w].radiance, room_lobe_over(&l, r->wall[w].centre, r->wall[w].x, r->wall[w].y)));
    for (int i = 0; i < ROOM_PANELS; i++) {
        const struct room_panel *p = &r->panel[i];
        const struct rgb more = rgb_add(p->radiance, rgb_scale(r->wall[p->wall].radiance, -1));
        sum = rgb_add(sum, rgb_scale(more, room_lobe_over(&l, p->centre, p->x, p->y)));
    }
    return sum;
}

/* ------------------------------------------------------------------------------------------------------ the samples */

/* A standard normal number. */
static inline double room_normal(const struct rng *rng, uint64_t pixel, uint64_t index)
{
    const double u = rng_uniform(rng, pixel, 2 * index), v = rng_uniform(rng, pixel, 2 * index + 1);
    return sqrt(-2 * log(1 - u)) * cos(2 * PI * v);
}

/* Point i of a grid of columns x rows on the floor, at least 0.4 from the walls. */
static inline struct vec3 room_grid_point(const struct glossy_room *r, int i, int columns, int rows)
{
    const double u = (i % columns + 0.5) / columns, v = (i / columns + 0.5) / rows;
    return vec3_make(0.4 + u * (r->size.x - 0.8), 0.4 + v * (r->size.y - 0.8), 0);
}

/* A viewer at a random place of the room. */
static inline struct vec3 room_viewer(const struct glossy_room *r, uint64_t seed, int view)
{
    const struct rng rng = rng_make(seed, "glossy_room", "viewer");
    int at = 3 * view;
    const double x = room_random(&rng, seed, &at, 0.4, r->size.x - 0.4);
    const double y = room_random(&rng, seed, &at, 0.4, r->size.y - 0.4);
    return vec3_make(x, y, room_random(&rng, seed, &at, 1.1, 2));
}

#endif
