/* openings.h - faces of walls with the points and lines of sight that show them, and openings of walls from these. */
#ifndef REMODEL_OPENINGS_H
#define REMODEL_OPENINGS_H

#include <math.h>

#include "common/math/numbers.h"
#include "stages/suggest_model/suggest.h"

/* By which a line of sight must pass a face to cross it, as a fraction of the ceiling's height. */
#define BEYOND 0.06

struct wall_side {  /* a face of a wall */
    int axis, sign; /* of its normal */
    double at;
    signed char *cells; /* +1 solid, -1 seen through, 0 unknown; across x up */
    int net;            /* sum of cells */
};
struct finder {
    const struct point_cloud *cloud;
    const struct view *views;
    int view_count;
    const struct suggest_params *params;
    struct ray_list rays;
    double height, low[2], high[2]; /* the ceiling's height; bounds of the points in x and y */
    struct wall_side *faces;        /* owned */
    int face_count, across[2], up;  /* numbers of cells along x, y and z */
};

static inline double along(struct vec3 p, int axis) { return axis ? p.y : p.x; }

static inline bool faces_along(const struct finder *f, const struct cloud_point *p, int axis, int sign)
{
    return sign * (double)p->normal[axis] >= cos(f->params->max_angle * PI / 180);
}

/* Whether a line of sight crosses a face's plane from its front, and ends well behind it; *s, *z: the crossing. */
static inline bool crosses(const struct finder *f, const struct ray *r, int axis, int sign, double at, double *s,
                           double *z)
{
    const struct vec3 a = f->views[r->view].center, b = f->cloud->points[r->point].position;
    const double from = sign * (along(a, axis) - at), to = sign * (along(b, axis) - at);
    if (from <= 0 || to > -BEYOND * f->height) return false;
    const double t = from / (from - to);
    *s = along(a, 1 - axis) + t * (along(b, 1 - axis) - along(a, 1 - axis));
    *z = a.z + t * (b.z - a.z);
    return true;
}

/* Adds the openings of a wall to the suggestion. */
enum status openings_find(struct suggestion *s, const struct finder *f, int wall, struct err *err);

#endif
