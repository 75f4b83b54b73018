/* axes_error.h - how far a room's canonical axes, floor and ceiling are from the true ones. */
#ifndef REMODEL_AXES_ERROR_H
#define REMODEL_AXES_ERROR_H

#include "common/math/vec.h"

struct axes_errors {
    double up;      /* degrees between the two directions up */
    double all;     /* degrees of the turn that takes the found axes to the true ones; which wall is x is nobody's
                       error, so the least of the four quarter turns about up counts */
    double floor;   /* |found height - true height|, in units of the truth */
    double ceiling; /* the same */
};

/* Axes are the rows x, y, z (up) of right-handed rotations into the room's frame, from the same world frame (that of
 * the truth); heights are along the own axis up, from that frame's origin. */
struct room_axes {
    struct mat3 axes;
    double floor, ceiling;
};
struct axes_errors axes_errors(const struct room_axes *found, const struct room_axes *truth);

#endif
