/* surface_points.h - reads points at which light is asked for: lines "X Y Z NX NY NZ", a point and the normal of its
 * surface. */
#ifndef REMODEL_SURFACE_POINTS_H
#define REMODEL_SURFACE_POINTS_H

#include "common/base/err.h"
#include "common/math/vec.h"

struct surface_point {
    struct vec3 at, normal; /* unit */
};

/* {0} is the empty state. */
struct surface_points {
    struct surface_point *list; /* owned */
    int count;
};

/* The list is overwritten, and empty after a failure. ST_DATA with file and line: another number of numbers, a normal
 * of length 0; or no point at all. */
enum status surface_points_read(struct surface_points *points, const char *path, struct err *err);
void surface_points_release(struct surface_points *points);

#endif
