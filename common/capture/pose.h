/* pose.h - where a camera stands and how it is turned. */
#ifndef REMODEL_POSE_H
#define REMODEL_POSE_H

#include "common/math/vec.h"

/* p_cam = R(rotation) p_world + translation. */
struct pose {
    struct quat rotation;
    struct vec3 translation;
};

struct vec3 pose_apply(const struct pose *cam_from_world, struct vec3 world);
struct vec3 pose_center(const struct pose *cam_from_world); /* the camera's centre in world coordinates */

#endif
