/* plane_problem.c - see plane_problem.h. */
#include "stages/segment_depth/plane_problem.h"

#include <math.h>

float problem_unary(const struct plane_problem *p, int segment, struct plane plane)
{
    const struct segment *g = &p->m->segments->segments[segment];
    if (given_depth_knows(p->given, segment)) return given_depth_is(p->given, segment, plane) ? 0 : PLANE_NEVER;
    if (!plane_keeps_to(plane, g, p->least, p->most)) return PLANE_NEVER;
    unsigned hidden = 0;
    float data = p->cross ? (float)p->params->cross_view * cross_view_cost(p->cross, segment, plane, &hidden) : 0;
    data += (p->rough ? match_cost_half : match_cost)(p->m, segment, plane, hidden) +
            (float)point_evidence_cost(p->points, segment, plane, g->cx, g->cy);
    const float size = (float)g->pixels / (float)p->params->segment_pixels;
    return size * data + (plane.a != 0 || plane.b != 0 ? (float)p->params->slant : 0);
}

double problem_pair(const struct plane_problem *p, int segment, int touch, struct plane own, struct plane other)
{
    const struct touch *t = &p->m->segments->touches[touch];
    const struct segment *g = &p->m->segments->segments[segment], *h = &p->m->segments->segments[t->other];
    const double a = own.a - other.a, b = own.b - other.b, c = own.c - other.c;
    const double gap = fabs(a * (double)t->u + b * (double)t->v + c) + 0.5 * fabs(a * g->cx + b * g->cy + c) +
                       0.5 * fabs(a * h->cx + b * h->cy + c);
    const double steps = 0.5 * gap / p->step, jump = p->params->jump;
    return p->params->smoothness * (double)p->weights[touch] * fmin(steps / jump, 1);
}
