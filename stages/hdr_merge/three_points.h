/* three_points.h - the poses from which a camera sees three points along three rays. */
#ifndef REMODEL_THREE_POINTS_H
#define REMODEL_THREE_POINTS_H

#include "common/capture/camera.h"

enum { THREE_POINTS_MAX = 14 };

/* rays: of length 1, in camera coordinates, in any direction, also behind the camera. Returns the number of poses
 * cam_from_world, at most THREE_POINTS_MAX; 0 if the points or the rays are practically on a line. All solutions are
 * among them, to about eight digits; others are not: the caller compares them with the points. */
int three_points_poses(struct pose poses[THREE_POINTS_MAX], const struct vec3 rays[3], const struct vec3 points[3]);

#endif
