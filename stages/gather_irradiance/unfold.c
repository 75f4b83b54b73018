/* unfold.c - see unfold.h.
 *
 * A cube of side 2 about the point. The top is at z = 1; the side at x = 1 lies to the right of it, and so on, its
 * upper edge, z = 1, at the top's edge and its lower, z = 0, at the picture's. */
#include "stages/gather_irradiance/unfold.h"

#include <math.h>

#include "common/math/numbers.h"

bool unfold_direction(struct vec3 *direction, int n, int x, int y)
{
    const int half = n / 2;
    const bool column = x >= half && x < half + n, row = y >= half && y < half + n;
    const double u = (x - half + 0.5) / half - 1, v = (y - half + 0.5) / half - 1; /* -1 .. 1 on the top */
    if (x < 0 || y < 0 || x >= 2 * n || y >= 2 * n || !(column || row)) return false;
    if (column && row)
        *direction = vec3_make(u, v, 1);
    else if (row)
        *direction = vec3_make(u > 0 ? 1 : -1, v, 2 - fabs(u));
    else
        *direction = vec3_make(u, v > 0 ? 1 : -1, 2 - fabs(v));
    return true;
}

/* The pixel of a coordinate of the top or of a side's edge, -1 .. 1. */
static int along(double u, int n) { return n / 2 + clamp_int((int)floor((u + 1) * n / 2), 0, n - 1); }

/* The pixel of a height on a side, 1 .. 0, from the top outwards; `behind`: towards smaller pixels. */
static int outwards(double height, bool behind, int n)
{
    const int half = n / 2, step = clamp_int((int)floor((1 - height) * half), 0, half - 1);
    return behind ? half - 1 - step : half + n + step;
}

void unfold_pixel(int *x, int *y, int n, struct vec3 d)
{
    const double ax = fabs(d.x), ay = fabs(d.y);
    if (d.z >= ax && d.z >= ay) {
        *x = along(d.x / d.z, n);
        *y = along(d.y / d.z, n);
    } else if (ax >= ay) {
        *x = outwards(d.z / ax, d.x < 0, n);
        *y = along(d.y / ax, n);
    } else {
        *x = along(d.x / ay, n);
        *y = outwards(d.z / ay, d.y < 0, n);
    }
}

void unfold_frame(struct vec3 *right, struct vec3 *down, struct vec3 normal)
{
    const struct vec3 up = fabs(normal.z) > 0.99 ? vec3_make(0, 1, 0) : vec3_make(0, 0, 1);
    *down = vec3_normalize(vec3_sub(vec3_scale(normal, vec3_dot(up, normal)), up));
    *right = vec3_cross(*down, normal);
}
