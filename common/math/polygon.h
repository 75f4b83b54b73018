/* polygon.h - polygons of a plane. */
#ifndef REMODEL_POLYGON_H
#define REMODEL_POLYGON_H

#include <stdbool.h>

/* Whether a polygon holds a point, by the parity of the crossings of its sides. */
static inline bool polygon_holds(const double (*corners)[2], int count, double x, double y)
{
    bool inside = false;
    for (int i = 0, j = count - 1; i < count; j = i++) {
        const double *a = corners[i], *b = corners[j];
        if ((a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0]) inside = !inside;
    }
    return inside;
}

#endif
