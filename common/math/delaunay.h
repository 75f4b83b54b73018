/* delaunay.h - Delaunay triangulation of points in the plane, on qhull. */
#ifndef REMODEL_DELAUNAY_H
#define REMODEL_DELAUNAY_H

#include "common/base/err.h"

/* *triangles (the caller frees it): indices into points, counter-clockwise (x right, y up), the least index first, in
 * ascending order: the same for the same points. Of points that coincide one is used. Fewer than three distinct
 * points, or all on a line (to 1e-9 of their extent), make no triangle: *count 0, *triangles NULL. Coordinates are
 * finite. */
enum status delaunay(const double (*points)[2], int point_count, int (**triangles)[3], int *count, struct err *err);

#endif
