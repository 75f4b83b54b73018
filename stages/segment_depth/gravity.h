/* gravity.h - which way is down in a scene, and where its ground lies. */
#ifndef REMODEL_GRAVITY_H
#define REMODEL_GRAVITY_H

#include "common/capture/camera_set.h"

/* The ground: the nearly level plane below which there are hardly any sparse points. */
struct ground {       /* points X on it: down . X = offset, in the scene's frame and units */
    struct vec3 down; /* unit vector */
    double offset;
};

/* Sets *down, a unit vector in the scene's frame, to the direction of gravity: the mean of what is down in the photos
 * (ups: as upright_mean() takes them); if all are tilted up or down, as walls show it. *known
 * is false if photos of one viewing direction show no walls: they may all be tilted. ST_NOMEM. */
enum status gravity_find(struct vec3 *down, bool *known, const struct camera_set *set, const struct vec3 *ups,
                         struct err *err);

/* Finds the ground, at most GROUND_TILT degrees from level. *found is false if the points show none below all cameras.
 * ST_NOMEM. */
enum status gravity_find_ground(struct ground *g, bool *found, const struct camera_set *set, struct vec3 down,
                                struct err *err);

#define GROUND_TILT 1

#endif
