/* cone_edge.c - see cone_edge.h.
 *
 * Overview. Rays leave the lamp's centre on a cone of half angle beta about its normal, evenly in azimuth. On a plane
 * their hits lie on a conic: below a lamp that looks straight down from the height h, on a circle of radius h
 * tan(beta). The lamp has a size, so that its light ends in a penumbra about this curve.
 *
 * Two neighbours are joined unless they are much further apart than the rays are there, which they are where the curve
 * passes from one surface to another behind it. */
#include "stages/fit_lights/cone_edge.h"

#include <math.h>

#include "common/light/frame.h"
#include "common/math/numbers.h"

enum { OUTLINE_POINTS = 96 /* a multiple of 4 */ };
#define WIDEST (89.5 * DEGREE) /* beyond, the cone is the whole half space */
#define APART  8.0             /* times the distance of neighbouring rays at a surface that faces them */

bool cone_edge_ray(struct curve_point *p, const struct lamp *l, struct vec3 d, const struct model_rays *model,
                   unsigned *face)
{
    struct vec3 from = vec3_add(l->centre, vec3_scale(l->normal, 4 * model->rays.epsilon));
    struct ray_hit hit;
    if (!ray_scene_hit(&model->rays, from, d, &hit)) return false;
    if (!hit.front) { /* the lamp lies a little behind the surface that it is in */
        from = vec3_add(hit.point, vec3_scale(d, 4 * model->rays.epsilon));
        if (!ray_scene_hit(&model->rays, from, d, &hit) || !hit.front) return false;
    }
    *p = (struct curve_point){hit.point, hit.normal, false};
    *face = hit.id;
    return true;
}

void cone_edge_find(struct curve *c, const struct lamp *l, const struct model_rays *model)
{
    double distance[CURVE_POINTS];
    int step[CURVE_POINTS]; /* the ray of each point */
    c->count = 0;
    if (!(l->beta < WIDEST)) return;
    for (int i = 0; i < CURVE_POINTS; i++) {
        const struct vec3 d = frame_direction(l->normal, sin(l->beta), cos(l->beta), (double)i / CURVE_POINTS);
        unsigned face;
        if (!cone_edge_ray(&c->points[c->count], l, d, model, &face)) continue;
        distance[c->count] = vec3_length(vec3_sub(c->points[c->count].at, l->centre));
        step[c->count++] = i;
    }
    for (int i = 0; i < c->count; i++) {
        const int next = (i + 1) % c->count;
        const double spacing = 2 * PI / CURVE_POINTS * sin(l->beta) * fmin(distance[i], distance[next]);
        const double apart = vec3_length(vec3_sub(c->points[next].at, c->points[i].at));
        c->points[i].joins = (step[i] + 1) % CURVE_POINTS == step[next] && apart < APART * spacing;
    }
}

void cone_outline(struct curve *c, const struct lamp *l)
{
    c->count = OUTLINE_POINTS;
    for (int i = 0; i < c->count; i++) {
        const double turns = (double)i / c->count, side = 4 * turns, along = 2 * (side - floor(side)) - 1;
        double a = cos(2 * PI * turns), b = sin(2 * PI * turns);
        if (l->shape == LAMP_QUAD) {
            a = side < 1 ? 1 : side < 2 ? -along : side < 3 ? -1 : along;
            b = side < 1 ? along : side < 2 ? 1 : side < 3 ? -along : -1;
        }
        const struct vec3 off = vec3_add(vec3_scale(l->x, a), vec3_scale(l->y, b));
        c->points[i] = (struct curve_point){vec3_add(l->centre, off), l->normal, true};
    }
}
