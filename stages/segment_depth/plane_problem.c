/* plane_problem.c - see plane_problem.h. */
#include "stages/segment_depth/plane_problem.h"

#include <math.h>

#define SLACK 0.1f /* a slanted plane may match by so much better than all constant depths that it covers */

/* What a segment's match on a plane hardly ever costs less than. */
static float least_match(const struct plane_problem *p, int segment, struct plane plane)
{
    if (!p->cost) return p->least_match ? p->least_match[segment] - SLACK : MATCH_BEST;
    const struct segment *g = &p->m->segments->segments[segment];
    const double middle = (plane_at(plane, g->cx, g->cy) - p->least) / p->step;
    const double reach =
        0.5 + 0.5 * (fabs(plane.a) * (g->x1 - g->x0 + 1) + fabs(plane.b) * (g->y1 - g->y0 + 1)) / p->step;
    const int low = middle - reach > 0 ? (int)(middle - reach) : 0;
    const int high = middle + reach < p->planes - 2 ? (int)(middle + reach) + 1 : p->planes - 1;
    const float *cost = p->cost + (size_t)segment * (size_t)p->planes;
    float least = MATCH_WORST;
    for (int k = low; k <= high; k++) least = cost[k] < least ? cost[k] : least;
    return least - SLACK;
}

float problem_unary(const struct plane_problem *p, int segment, struct plane plane, float most)
{
    const struct segment *g = &p->m->segments->segments[segment];
    if (given_depth_knows(p->given, segment)) return given_depth_is(p->given, segment, plane) ? 0 : PLANE_NEVER;
    if (!plane_keeps_to(plane, g, p->least, p->most)) return PLANE_NEVER;
    unsigned hidden = 0;
    const float size = (float)g->pixels / (float)p->params->segment_pixels;
    const float slant = plane.a != 0 || plane.b != 0 ? (float)p->params->slant : 0;
    float data = p->cross ? (float)p->params->cross_view * cross_view_cost(p->cross, segment, plane, &hidden) : 0;
    data += (float)point_evidence_cost(p->points, segment, plane, g->cx, g->cy);
    if (size * (data + least_match(p, segment, plane)) + slant > most) return PLANE_NEVER;
    data += (p->rough ? match_cost_rough : match_cost)(p->m, segment, plane, hidden);
    return size * data + slant;
}

double problem_pair(const struct plane_problem *p, int segment, int touch, struct plane own, struct plane other)
{
    const struct touch *t = &p->m->segments->touches[touch];
    const struct segment *g = &p->m->segments->segments[segment], *h = &p->m->segments->segments[t->other];
    const double a = own.a - other.a, b = own.b - other.b, c = own.c - other.c;
    const double gap = fabs(a * (double)t->u + b * (double)t->v + c) + 0.5 * fabs(a * g->cx + b * g->cy + c) +
                       0.5 * fabs(a * h->cx + b * h->cy + c);
    const double steps = 0.5 * gap / p->step, jump = p->params->jump;
    return p->params->smoothness * (double)p->weights[touch] * (steps < jump ? steps / jump : 1);
}
