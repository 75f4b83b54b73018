/* spline.h - smooth curves through keyed numbers, places and orientations.
 *
 * Seconds; radians; rotations are world_from_cam, so that an angular velocity has the camera's axes. Every curve
 * passes its keys exactly, is C1, and depends on the keys near by alone. Two keys: a straight line, a turn about one
 * axis. Equal keys one after the other: no motion between them. */
#ifndef REMODEL_SPLINE_H
#define REMODEL_SPLINE_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/math/vec.h"

struct curve { /* of a number over time, monotone between its keys (common/math/monotone.h) */
    double *time, *value, *slope;
    int count;
};

/* Room for `count` keys, for the caller to fill: times that rise, and values. */
enum status curve_init(struct curve *c, int count, struct err *err);
/* rest: it starts and ends with slope 0. */
void curve_fit(struct curve *c, bool rest);
/* Held before the first key and after the last. */
double curve_at(const struct curve *c, double time);
void curve_release(struct curve *c);

/* Where a camera goes and how it turns. The caller fills `place` and `turn`, and the times along.time. */
struct motion {
    int count;
    struct vec3 *place;
    struct quat *turn;           /* unit */
    struct vec3 *course, *spin;  /* made: direction of the path and axis of the turn at each key, of length <= 1 */
    struct curve along, turning; /* made: length of the path's chords, and of the turns, over time */
};
enum status motion_init(struct motion *m, int count, struct err *err);
void motion_fit(struct motion *m, bool rest);
void motion_at(const struct motion *m, double time, struct vec3 *place, struct quat *turn);
/* Velocity and angular velocity at the first key or the last one. */
void motion_rates(const struct motion *m, bool last, struct vec3 *velocity, struct vec3 *spin);
void motion_release(struct motion *m);

/* A cubic from a to b at the part t of it, with derivatives da and db by t at its ends. */
struct vec3 place_between(struct vec3 a, struct vec3 b, struct vec3 da, struct vec3 db, double t);
/* The same of unit quaternions, the shorter way. */
struct quat turn_between(struct quat a, struct quat b, struct vec3 da, struct vec3 db, double t);

#endif
