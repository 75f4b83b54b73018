/* frame.h - directions about an axis. */
#ifndef REMODEL_FRAME_H
#define REMODEL_FRAME_H

#include "common/light/fast.h"
#include "common/math/vec.h"

/* Unit x and y that make a right-handed orthonormal frame with the unit vector z [Duff 2017]; continuous in z but for
 * z.z = 0. */
static inline void frame_from_normal(struct vec3 z, struct vec3 *x, struct vec3 *y)
{
    const double sign = z.z < 0 ? -1 : 1, a = -1 / (sign + z.z), b = z.x * z.y * a;
    *x = vec3_make(1 + sign * z.x * z.x * a, sign * b, -sign * z.x);
    *y = vec3_make(b, sign + z.y * z.y * a, -z.y);
}

/* The unit vector at an angle, given by sine and cosine, from a unit axis, `turns` (0..1) of a full turn around it. */
static inline struct vec3 frame_direction(struct vec3 axis, double sin_t, double cos_t, double turns)
{
    struct vec3 x, y;
    double c, s;
    frame_from_normal(axis, &x, &y);
    fast_cos_sin(turns, &c, &s);
    return vec3_add(vec3_add(vec3_scale(x, sin_t * c), vec3_scale(y, sin_t * s)), vec3_scale(axis, cos_t));
}

#endif
