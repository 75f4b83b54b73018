/* patch_values.c - see patch_values.h. */
#include "stages/light_levels/patch_values.h"

#include <math.h>

#include "common/math/numbers.h"

/* The cell at or before a coordinate, and how far the coordinate is on the way to the next one. */
static int cell_before(double at, double low, double step, int count, double *part)
{
    const double place = step > 0 ? clamp((at - low) / step - 0.5, 0, count - 1) : 0;
    const int first = (int)fmin(floor(place), fmax(0, count - 2));
    *part = place - first;
    return first;
}

double patch_values_at(const struct light_patches *p, const double *values, int face, struct vec3 at)
{
    const struct patch_cells *c = &p->cells[face];
    double part[2], sum = 0;
    if (!c->patch) return NAN;
    const int x = cell_before(vec3_dot(c->u, at), c->low[0], c->step[0], c->columns, &part[0]);
    const int y = cell_before(vec3_dot(c->v, at), c->low[1], c->step[1], c->rows, &part[1]);
    for (int i = 0; i < 4; i++) {
        const double weight = (i & 1 ? part[0] : 1 - part[0]) * (i & 2 ? part[1] : 1 - part[1]);
        if (!(weight > 0)) continue;
        const int patch = c->patch[(y + (i >> 1)) * c->columns + x + (i & 1)];
        if (patch < 0) return NAN;
        sum += weight * values[patch];
    }
    return sum;
}
