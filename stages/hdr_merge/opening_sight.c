/* opening_sight.c - rays against the walls of plan.txt: a ray sees the outdoors through an opening if it passes the
 * opening's rectangle on both faces of its wall, and crosses no other wall on its way there but in an opening. Both
 * rectangles are narrowed by EDGE of their size, because the model's edges are not exact. Walls along no axis hide
 * nothing, as the plan does not hold where they end; nor does furniture. */
#include "stages/hdr_merge/opening_sight.h"

#include <math.h>

static const double EDGE = 0.02;

bool opening_sight_init(struct opening_sight *s, const struct model_plan *plan, int opening)
{
    *s = (struct opening_sight){.plan = plan, .wall = &plan->walls[plan->openings[opening].wall], .opening = opening};
    return model_opening_corners(plan, opening, s->corners);
}

double opening_sight_diagonal(const struct opening_sight *s)
{
    return vec3_length(vec3_sub(s->corners[1], s->corners[0]));
}

struct vec3 opening_sight_at(const struct opening_sight *s, double u, double v)
{
    const struct vec3 a = s->corners[0], b = s->corners[1];
    return vec3_make(a.x + u * (b.x - a.x), a.y + u * (b.y - a.y), a.z + v * (b.z - a.z));
}

/* Where a ray crosses a plane normal . (x, y) = offset: its multiple of the direction; < 0: nowhere ahead. */
static double crossing(const struct model_wall *w, double offset, struct vec3 from, struct vec3 d)
{
    const double speed = w->normal[0] * d.x + w->normal[1] * d.y;
    const double t = (offset - w->normal[0] * from.x - w->normal[1] * from.y) / speed;
    return speed == 0 || !(t >= 0) ? -1 : t;
}

static bool is_along_axis(const struct model_wall *w) { return fmin(fabs(w->normal[0]), fabs(w->normal[1])) <= 1e-9; }

/* edge: share of the size that is left out on each side. */
static bool is_within(const struct model_opening *o, double s, double z, double edge)
{
    const double ds = edge * (o->s[1] - o->s[0]), dz = edge * (o->z[1] - o->z[0]);
    return s > o->s[0] + ds && s < o->s[1] - ds && z > o->z[0] + dz && z < o->z[1] - dz;
}

static double along(const struct model_wall *w, struct vec3 p) { return fabs(w->normal[0]) > 0.5 ? p.y : p.x; }

static bool wall_hides(const struct model_plan *plan, int wall, struct vec3 p)
{
    const struct model_wall *w = &plan->walls[wall];
    const double s = along(w, p);
    if (s <= w->span[0] || s >= w->span[1] || p.z <= w->foot || p.z >= w->top) return false;
    for (int i = 0; i < plan->opening_count; i++)
        if (plan->openings[i].wall == wall && is_within(&plan->openings[i], s, p.z, 0)) return false;
    return true;
}

bool opening_sight_passes(const struct opening_sight *s, struct vec3 from, struct vec3 direction)
{
    const struct model_opening *o = &s->plan->openings[s->opening];
    double reach = 0;
    for (int face = 0; face < 2; face++) {
        const double t = crossing(s->wall, s->wall->offset - face * s->wall->thickness, from, direction);
        const struct vec3 p = vec3_add(from, vec3_scale(direction, t));
        if (t < reach || !is_within(o, along(s->wall, p), p.z, EDGE)) return false;
        if (!face) reach = t;
    }
    for (int i = 0; i < s->plan->wall_count; i++) {
        const struct model_wall *w = &s->plan->walls[i];
        for (int face = 0; i != o->wall && is_along_axis(w) && face < 2; face++) {
            const double t = crossing(w, w->offset - face * w->thickness, from, direction);
            if (t >= 0 && t < reach && wall_hides(s->plan, i, vec3_add(from, vec3_scale(direction, t)))) return false;
        }
    }
    return true;
}
