/* planes.h - walls, floors and ceilings as the planes across three axes with the most points, and axes refined by them.
 *
 * The points' positions on a wide plane determine its direction far better than their normals do. */
#ifndef REMODEL_PLANES_H
#define REMODEL_PLANES_H

#include <stdbool.h>

#include "common/capture/point_cloud.h"
#include "stages/find_axes/axes_params.h"

struct room_plane {
    int axis, side; /* the plane's normal is axis (0 x, 1 y, 2 z) times side (1 or -1) */
    double offset;  /* of the plane along the axis, from planes_find()' origin */
    double spread;  /* standard deviation of its points across it, robust */
    size_t count;   /* number of its points */
};

struct room_planes {
    struct room_plane *planes; /* owned; by axis, side and offset */
    int count;
};

/* axes: rows in the world. If turn: they are refined, and *tilt_error, standard errors of the rotations about them in
 * radians, is updated. origin: offsets are measured from there. planes is empty on entry; the caller releases it.
 * Finding no planes is not an error. */
enum status planes_find(struct room_planes *planes, struct mat3 *axes, bool turn, struct vec3 *tilt_error,
                        struct vec3 origin, const struct point_cloud *cloud, const struct axes_params *params,
                        struct err *err);
void planes_release(struct room_planes *planes);

#endif
