/* axes_error.h - errors of a room's canonical axes, floor and ceiling. */
#ifndef REMODEL_AXES_ERROR_H
#define REMODEL_AXES_ERROR_H

#include "common/math/vec.h"

struct axes_errors {
    double up;      /* angle between the two up directions, degrees */
    double all;     /* angle between found and true axes, degrees: the minimum over the four quarter turns about up,
                       because either wall may be x */
    double floor;   /* |found height - true height|, in the unit of the truth */
    double ceiling; /* the same */
};

/* The axes are the rows x, y, z (up) of a right-handed rotation from the truth's world into the room's frame; heights
 * are along its own up axis, from the origin of that world. */
struct room_axes {
    struct mat3 axes;
    double floor, ceiling;
};
struct axes_errors axes_errors(const struct room_axes *found, const struct room_axes *truth);

#endif
