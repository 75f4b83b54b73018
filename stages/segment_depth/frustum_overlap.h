/* frustum_overlap.h - which parts of a view other views see, as far as their cameras tell. */
#ifndef REMODEL_FRUSTUM_OVERLAP_H
#define REMODEL_FRUSTUM_OVERLAP_H

#include "stages/segment_depth/neighbours.h"

#define FRUSTUM_TILES 12 /* of a view in each direction */

/* How well a pair of rays at this angle, in degrees, fixes a depth: little near 0, 1 from 5 to 20, 1/e at 20 + wide. */
double frustum_angle_weight(double degrees, double wide);

/* One place of each tile: where its middle lies, at the depth of the nearest points. */
struct frustum_tiles {
    struct vec3 place[FRUSTUM_TILES * FRUSTUM_TILES];
    double inverse_z[FRUSTUM_TILES * FRUSTUM_TILES];
};

/* False: neither the view nor the scene has points, so that no depth is known. */
bool frustum_tiles_make(struct frustum_tiles *t, const struct camera_set *set, int view_idx,
                        const struct observed_points *seen);

/* How well another view shows the place of each tile, 0 .. 1: 0 where it is outside of its picture, where both see it
 * from the same direction, or where the other camera stands behind it. Returns the sum. */
double frustum_overlap(double shown[FRUSTUM_TILES * FRUSTUM_TILES], const struct frustum_tiles *t,
                       const struct view *view, const struct view *other);

#endif
