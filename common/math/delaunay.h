/* delaunay.h - Delaunay triangulation in the plane. */
#ifndef REMODEL_DELAUNAY_H
#define REMODEL_DELAUNAY_H

#include "common/base/err.h"

/* *triangles gets the indices of each triangle's points, counter-clockwise (x right, y up), smallest index first;
 * triangles are in ascending order, so that the same points give the same result. The caller frees it. One of several
 * coincident points is used. Fewer than three distinct points, or collinear points (to 1e-9 of their extent), give no
 * triangles: *count 0, *triangles NULL. Coordinates must be finite. */
enum status delaunay(const double (*points)[2], int point_count, int (**triangles)[3], int *count, struct err *err);

#endif
