/* axes_error.c - see axes_error.h. */
#include "stages/evaluate/model/axes_error.h"

/* The angle of a rotation, degrees; from its quaternion, which is exact for small angles. */
static double angle_of(struct mat3 r)
{
    struct quat q = quat_from_mat3(r);
    return 2 * atan2(vec3_length(vec3_make(q.x, q.y, q.z)), fabs(q.w)) * 180 / M_PI;
}

struct axes_errors axes_errors(const struct room_axes *found, const struct room_axes *truth)
{
    static const struct mat3 QUARTER = {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
    struct vec3 a = mat3_row(found->axes, 2);
    struct vec3 b = mat3_row(truth->axes, 2);
    struct mat3 turned = found->axes;
    struct axes_errors e = {.up = atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) * 180 / M_PI,
                            .all = 180,
                            .floor = fabs(found->floor - truth->floor),
                            .ceiling = fabs(found->ceiling - truth->ceiling)};
    for (int k = 0; k < 4; k++) {
        e.all = fmin(e.all, angle_of(mat3_multiply(turned, mat3_transpose(truth->axes))));
        turned = mat3_multiply(QUARTER, turned);
    }
    return e;
}
