/* plane_proposals.c - candidate planes of the expansion moves.
 *
 * [Taniai 2018] proposes the plane of a random member of the cell, and random perturbations of it that shrink from pass
 * to pass. Here planes also come from geometry that interiors are made of: horizontal planes through a segment,
 * vertical planes through two, planes through three; and from the local minima of the sweep's cost volume. */
#include "stages/segment_depth/plane_proposals.h"

#include <math.h>

bool proposal_through_three(struct plane *out, const struct plane_problem *p, const struct plane *planes,
                            const int *members, int count, struct cell_random *random)
{
    const struct segment *g[3];
    double z[3];
    for (int k = 0; k < 3; k++) {
        const int i = random_member(random, members, count);
        g[k] = &p->m->segments->segments[i];
        z[k] = plane_at(planes[i], g[k]->cx, g[k]->cy);
    }
    const double ux = g[1]->cx - g[0]->cx, uy = g[1]->cy - g[0]->cy, vx = g[2]->cx - g[0]->cx, vy = g[2]->cy - g[0]->cy;
    const double det = ux * vy - uy * vx, reach = hypot(ux, uy) * hypot(vx, vy);
    if (!(fabs(det) > 0.2 * reach) || !(reach > 0)) return false;
    const double a = ((z[1] - z[0]) * vy - (z[2] - z[0]) * uy) / det,
                 b = ((z[2] - z[0]) * ux - (z[1] - z[0]) * vx) / det;
    *out = (struct plane){a, b, z[0] - a * g[0]->cx - b * g[0]->cy};
    return true;
}

/* A segment's centroid at its current depth, in the camera's axes. */
static struct vec3 centroid_point(const struct plane_problem *p, const struct plane *planes, int i)
{
    const struct segment *g = &p->m->segments->segments[i];
    const struct view *v = p->view;
    const double z = 1 / plane_at(planes[i], g->cx, g->cy);
    return vec3_make((g->cx - v->cx) / v->fx * z, (g->cy - v->cy) / v->fy * z, z);
}

static bool plane_from_normal(const struct view *v, struct vec3 normal, struct vec3 point, struct plane *out)
{
    const double distance = vec3_dot(normal, point);
    if (!(fabs(distance) > 1e-6 * vec3_length(point))) return false;
    *out = plane_of_normal(v, vec3_scale(normal, 1 / distance));
    return isfinite(out->a) && isfinite(out->b) && isfinite(out->c);
}

bool proposal_horizontal(struct plane *out, const struct plane_problem *p, const struct plane *planes, int i)
{
    return plane_from_normal(p->view, p->down, centroid_point(p, planes, i), out);
}

bool proposal_of_family(struct plane *out, const struct plane_problem *p, const struct plane *planes, int i, int family)
{
    return plane_from_normal(p->view, p->families->normal[family], centroid_point(p, planes, i), out);
}

bool proposal_vertical(struct plane *out, const struct plane_problem *p, const struct plane *planes, int i, int j)
{
    const struct vec3 point = centroid_point(p, planes, i), along = vec3_sub(centroid_point(p, planes, j), point),
                      n = vec3_cross(p->down, along);
    if (!(vec3_length(n) > 0.2 * vec3_length(along)) || i == j) return false;
    return plane_from_normal(p->view, vec3_normalize(n), point, out);
}

struct plane proposal_from_sweep(const struct plane_problem *p, const struct plane *planes, int i,
                                 struct cell_random *random)
{
    enum { MINIMA = 4 };
    const float *cost = p->cost + (size_t)i * (size_t)p->planes;
    int best[MINIMA], count = 0;
    for (int l = 0; l < p->planes; l++) {
        if ((l > 0 && cost[l - 1] < cost[l]) || (l + 1 < p->planes && cost[l + 1] <= cost[l])) continue;
        int at = count < MINIMA ? count++ : cost[l] < cost[best[MINIMA - 1]] ? MINIMA - 1 : MINIMA;
        if (at == MINIMA) continue;
        for (; at > 0 && cost[best[at - 1]] > cost[l]; at--) best[at] = best[at - 1];
        best[at] = l;
    }
    const int label = count ? best[(int)(random_number(random) * count)] : (int)(random_number(random) * p->planes);
    const double z = p->min_inverse_z + label * p->step;
    const struct segment *g = &p->m->segments->segments[i];
    struct plane own = planes[i];
    if (random_number(random) < 0.5) own.a = own.b = 0;
    return (struct plane){own.a, own.b, z - own.a * g->cx - own.b * g->cy};
}

struct plane proposal_perturbed(const struct plane_problem *p, const struct plane *planes, int i, double change,
                                double size, struct cell_random *random)
{
    const struct segment *g = &p->m->segments->segments[i];
    struct plane own = planes[i];
    const double z = plane_at(own, g->cx, g->cy) + (2 * random_number(random) - 1) * change;
    if (own.a != 0 || own.b != 0 || random_number(random) < 0.5) {
        own.a += (2 * random_number(random) - 1) * change / size;
        own.b += (2 * random_number(random) - 1) * change / size;
    }
    return (struct plane){own.a, own.b, z - own.a * g->cx - own.b * g->cy};
}
