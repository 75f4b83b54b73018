/* pose.c - where a camera stands and how it is turned. */
#include "common/capture/pose.h"

#include <math.h>
#include <stdbool.h>

#define MAX_OFF 1e-3 /* cosine of two axes, and relative difference of their lengths */

struct vec3 pose_apply(const struct pose *cam_from_world, struct vec3 world)
{
    return vec3_add(mat3_apply(mat3_from_quat(cam_from_world->rotation), world), cam_from_world->translation);
}

struct vec3 pose_center(const struct pose *cam_from_world)
{
    struct mat3 world_from_cam = mat3_transpose(mat3_from_quat(cam_from_world->rotation));
    return vec3_scale(mat3_apply(world_from_cam, cam_from_world->translation), -1);
}

static bool is_turned(const struct vec3 axes[3])
{
    const double length = vec3_length(axes[0]);
    if (!isfinite(length) || !(length > 1e-9)) return false;
    for (int i = 0; i < 3; i++) {
        if (!(fabs(vec3_length(axes[i]) / length - 1) < MAX_OFF)) return false;
        if (!(fabs(vec3_dot(axes[i], axes[(i + 1) % 3])) < MAX_OFF * length * length)) return false;
    }
    return vec3_dot(vec3_cross(axes[0], axes[1]), axes[2]) > 0;
}

enum status pose_turn_from_axes(struct mat3 *cam_from_world, const struct vec3 axes[3], const char *where,
                                struct err *err)
{
    if (!is_turned(axes))
        return err_set(err, ST_DATA,
                       "%s: found a pose that is not a rotation, wanted three perpendicular axes of one length.",
                       where);
    for (int i = 0; i < 3; i++) {
        const struct vec3 axis = vec3_normalize(axes[i]);
        cam_from_world->m[i][0] = axis.x;
        cam_from_world->m[i][1] = axis.y;
        cam_from_world->m[i][2] = axis.z;
    }
    return ST_OK;
}
