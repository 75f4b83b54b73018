/* pose.h - where a camera stands and how it is turned. */
#ifndef REMODEL_POSE_H
#define REMODEL_POSE_H

#include "common/base/err.h"
#include "common/math/vec.h"

/* p_cam = R(rotation) p_world + translation. */
struct pose {
    struct quat rotation;
    struct vec3 translation;
};

struct vec3 pose_apply(const struct pose *cam_from_world, struct vec3 world);
struct vec3 pose_center(const struct pose *cam_from_world); /* the camera's centre in world coordinates */

/* The rotation of a camera whose x (right), y (down) and z (forward) axes have these directions in the world; they may
 * have any one length. ST_DATA, with `where` in front: they are not perpendicular, or mirrored. */
enum status pose_turn_from_axes(struct mat3 *cam_from_world, const struct vec3 axes[3], const char *where,
                                struct err *err);

#endif
