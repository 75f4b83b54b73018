/* obj_polygon.h - a polygon of an OBJ file as triangles. */
#ifndef REMODEL_OBJ_POLYGON_H
#define REMODEL_OBJ_POLYGON_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/math/vec.h"

struct obj_corner {
    struct vec3 at, normal; /* normal 0: the file gives none */
};

/* Cuts a polygon of 3 or more corners, which may be concave and slightly bent, into triangles: (*triangles)[3 i + k] is
 * a corner, counted from 0; the caller frees them. *crosses: the polygon crosses itself; its triangles are then those
 * of a fan about the first corner. ST_NOMEM. */
enum status obj_polygon_triangles(int **triangles, int *count, bool *crosses, const struct obj_corner *corners, int n,
                                  struct err *err);

#endif
