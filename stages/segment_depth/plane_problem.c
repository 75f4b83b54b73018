/* plane_problem.c - terms of the energy.
 *
 * Matching dominates the cost of a unary term, so that a term is first bounded from below: by the cheap terms, and by
 * the minimum of the sweep's matching costs over the depths that the plane covers. A move that asks for costs up to a
 * limit then skips most planes without reading a picture. */
#include "stages/segment_depth/plane_problem.h"

#include <math.h>
#include <string.h>

#define GROUND_COST   0.3f /* of a segment that lies below the ground */
#define GROUND_MARGIN 0.9f /* of the ground's inverse depth: a segment may be that far below at no cost */
#define SLACK         0.1f /* by which a slanted plane may match better than all constant depths that it covers */

/* A bound that a segment's matching cost on a plane rarely falls below. */
static float match_lower_bound(const struct plane_problem *p, int segment, struct plane plane)
{
    if (!p->cost) return p->min_match ? p->min_match[segment] - SLACK : MATCH_BEST;
    const struct segment *g = &p->m->segments->segments[segment];
    const double middle = (plane_at(plane, g->cx, g->cy) - p->min_inverse_z) / p->step;
    const double reach =
        0.5 + 0.5 * (fabs(plane.a) * (g->x1 - g->x0 + 1) + fabs(plane.b) * (g->y1 - g->y0 + 1)) / p->step;
    if (middle + reach > p->planes || middle - reach < -1) return MATCH_BEST; /* depths that were not tried */
    const int low = middle - reach > 0 ? (int)(middle - reach) : 0;
    const int high = middle + reach < p->planes - 2 ? (int)(middle + reach) + 1 : p->planes - 1;
    const float *cost = p->cost + (size_t)segment * (size_t)p->planes;
    float lowest = MATCH_WORST;
    for (int k = low; k <= high; k++) lowest = cost[k] < lowest ? cost[k] : lowest;
    return lowest - SLACK;
}

static bool is_expected(const struct plane_problem *p, int segment, struct plane plane)
{
    const struct plane *there = problem_expects(p, segment);
    return there && memcmp(there, &plane, sizeof plane) == 0;
}

float problem_unary_cost(const struct plane_problem *p, int segment, struct plane plane, float max_cost)
{
    const struct segment *g = &p->m->segments->segments[segment];
    if (given_depth_has(p->given, segment)) return given_depth_equals(p->given, segment, plane) ? 0 : PLANE_FORBIDDEN;
    if (!problem_allows(p, g, plane)) return PLANE_FORBIDDEN;
    unsigned occluded = 0;
    const float size = (float)g->pixels / (float)p->params->segment_pixels;
    float data = (float)point_evidence_cost(p->points, segment, plane, g->cx, g->cy);
    if (scene_planes_have(p->scene, plane))
        data -= (float)(point_evidence_far(p->points, plane, g->cx, g->cy) + (p->cross ? 0 : SCENE_GAIN));
    if (is_expected(p, segment, plane)) data -= p->prior->gain[segment];
    const struct plane *ground = scene_planes_ground(p->scene);
    if (ground && plane_at(plane, g->cx, g->cy) < (double)GROUND_MARGIN * plane_at(*ground, g->cx, g->cy))
        data += GROUND_COST;
    const float left = max_cost / size - data - match_lower_bound(p, segment, plane),
                part = (float)p->params->cross_view;
    if (!(left >= 0)) return PLANE_FORBIDDEN;
    if (p->cross) {
        const float cross =
            part * cross_view_bounded(p->cross, segment, plane, part > 0 ? left / part : INFINITY, &occluded);
        if (cross > left) return PLANE_FORBIDDEN;
        data += cross;
    }
    data += (p->rough ? match_cost_rough : match_cost)(p->m, segment, plane, occluded);
    return size * data;
}

double problem_pairwise_bound(const struct plane_problem *p, int border)
{
    return p->params->smoothness * (double)p->weights[border] + 2 * p->slant * p->m->segments->borders[border].length;
}

/* A plane of the scene is paid for already. */
static int slants(const struct plane_problem *p, struct plane plane)
{
    return (plane.a != 0 || plane.b != 0) && !scene_planes_have(p->scene, plane);
}

double problem_pairwise_cost(const struct plane_problem *p, int segment, int border, struct plane own,
                             struct plane other)
{
    const struct border *t = &p->m->segments->borders[border];
    const struct segment *g = &p->m->segments->segments[segment], *h = &p->m->segments->segments[t->other];
    const double a = own.a - other.a, b = own.b - other.b, c = own.c - other.c;
    if (a == 0 && b == 0 && c == 0) return 0;
    const double gap = fabs(a * (double)t->u + b * (double)t->v + c) + 0.5 * fabs(a * g->cx + b * g->cy + c) +
                       0.5 * fabs(a * h->cx + b * h->cy + c);
    const double steps = 0.5 * gap / p->step, jump = p->params->jump;
    const double slant = p->slant * t->length * (slants(p, own) + slants(p, other));
    return p->params->smoothness * (double)p->weights[border] * (steps < jump ? steps / jump : 1) + slant;
}
