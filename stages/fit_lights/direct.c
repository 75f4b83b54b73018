/* direct.c - see direct.h.
 *
 * The irradiance of an unhidden lamp is exact (lamp_irradiance()). Where the model hides a part of the lamp, it is
 * scaled by the share of the light of 64 parts, equal in area, whose middles the point sees. */
#include "stages/fit_lights/direct.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 8, PARTS = SIDE * SIDE };

/* The middle of a part: a square grid, mapped to the disk by area [Shirley 1997]. */
static struct vec3 part_of(const struct lamp *l, int part)
{
    double x = (2 * (part % SIDE) + 1.0) / SIDE - 1, y = (2 * (part / SIDE) + 1.0) / SIDE - 1;
    if (l->shape == LAMP_DISK) {
        const bool wide = fabs(x) >= fabs(y);
        const double r = wide ? x : y, turn = wide ? 0.25 * M_PI * y / x : 0.5 * M_PI - 0.25 * M_PI * x / y;
        x = r * cos(turn);
        y = r * sin(turn);
    }
    return vec3_add(l->centre, vec3_add(vec3_scale(l->x, x), vec3_scale(l->y, y)));
}

/* Surfaces up to `reach` before the lamp's plane do not hide it, as in model_field.c. */
static uint64_t seen_from(const struct lamp *l, const struct lit_point *p, const struct ray_scene *rays, double reach)
{
    const struct vec3 from = vec3_add(p->at, vec3_scale(p->normal, 4 * rays->epsilon));
    const double below = vec3_dot(vec3_sub(from, l->centre), l->normal);
    const double end = fmax(1 - reach / below, 0);
    uint64_t seen = 0;
    if (!(below > 0)) return 0; /* it shines to the other side */
    for (int i = 0; i < PARTS; i++)
        if (!ray_scene_blocked(rays, from, vec3_sub(part_of(l, i), from), end)) seen |= UINT64_C(1) << i;
    return seen;
}

enum status direct_light_make(struct direct_light *d, const struct lit_scene *scene, const struct model_rays *model,
                              struct err *err)
{
    const size_t points = (size_t)scene->point_count, lamps = (size_t)scene->lights.lamp_count;
    *d = (struct direct_light){scene, calloc(points * lamps + 1, sizeof *d->seen)};
    const double reach = LAMP_REACH * model_rays_size(model);
    if (!d->seen) return err_nomem(err, "lamps seen from points", points * lamps * sizeof *d->seen);
    for (size_t l = 0; l < lamps; l++)
        for (size_t i = 0; i < points; i++)
            d->seen[l * points + i] = seen_from(&scene->lights.lamps[l], &scene->points[i], &model->rays, reach);
    return ST_OK;
}

void direct_light_release(struct direct_light *d)
{
    free(d->seen);
    *d = (struct direct_light){0};
}

static double part_light(const struct lamp *l, int part, const struct lit_point *p)
{
    const struct vec3 w = vec3_sub(part_of(l, part), p->at);
    const double r = vec3_length(w);
    if (!(r > 0)) return 0;
    const struct vec3 away = vec3_scale(w, -1 / r);
    return lamp_radiance(l, away).r * fmax(0, -vec3_dot(p->normal, away)) * fmax(0, vec3_dot(l->normal, away)) /
           (r * r);
}

double direct_light_at(const struct direct_light *d, int lamp, int point, double beta, double exponent)
{
    const struct lit_point *p = &d->scene->points[point];
    struct lamp l = d->scene->lights.lamps[lamp];
    const uint64_t seen = d->seen[(size_t)lamp * (size_t)d->scene->point_count + (size_t)point];
    if (!seen) return 0;
    l.radiance = rgb_grey(1);
    l.beta = beta;
    l.exponent = exponent;
    const double whole = lamp_irradiance(&l, p->at, p->normal).r;
    if (seen == UINT64_MAX || !(whole > 0)) return whole;
    double all = 0, open = 0;
    for (int i = 0; i < PARTS; i++) {
        const double e = part_light(&l, i, p);
        all += e;
        if (seen >> i & 1) open += e;
    }
    return all > 0 ? whole * open / all : 0;
}
