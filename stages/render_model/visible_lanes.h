/* visible_lanes.h - linear functions of the pixel, for eight neighbours of a row at a time. */
#ifndef REMODEL_RENDER_VISIBLE_LANES_H
#define REMODEL_RENDER_VISIBLE_LANES_H

#include "common/math/lanes.h"

#define LANES 8

/* x column + y row + origin, at the centre of a pixel. */
struct linear {
    double x, y, origin;
};

static inline double linear_at(const struct linear *l, double x, double y) { return l->x * x + l->y * y + l->origin; }

/* The same in single precision, counted from some pixel. Equal functions of opposite signs have equal values of
 * opposite signs. */
struct lanes {
    f32x8 row; /* at the first eight pixels */
    f32x8 down, right;
};

static inline struct lanes lanes_from(const struct linear *l, int x, int y)
{
    const f32x8 slope = f32x8_all((float)l->x), start = f32x8_all((float)linear_at(l, x, y));
    const f32x8 steps = {0, 1, 2, 3, 4, 5, 6, 7};
    return (struct lanes){start + slope * steps, f32x8_all((float)l->y), slope};
}

/* The values of eight pixels, `down` rows and `right` columns further. */
static inline f32x8 lanes_value(const struct lanes *l, f32x8 down, f32x8 right)
{
    return l->row + l->down * down + l->right * right;
}

#endif
