/* pose.c - where a camera stands and how it is turned. */
#include "common/capture/pose.h"

struct vec3 pose_apply(const struct pose *cam_from_world, struct vec3 world)
{
    return vec3_add(mat3_apply(mat3_from_quat(cam_from_world->rotation), world), cam_from_world->translation);
}

struct vec3 pose_center(const struct pose *cam_from_world)
{
    struct mat3 world_from_cam = mat3_transpose(mat3_from_quat(cam_from_world->rotation));
    return vec3_scale(mat3_apply(world_from_cam, cam_from_world->translation), -1);
}
