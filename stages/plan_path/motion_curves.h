/* motion_curves.h - smooth curves through keys: numbers, positions and orientations over time.
 *
 * Seconds; radians; rotations are world_from_cam, so angular velocities are in the camera's axes. Every curve passes
 * through its keys exactly, is C1, and depends on nearby keys alone. Two keys give a straight line and a rotation about
 * one axis. Between equal consecutive keys nothing moves. */
#ifndef REMODEL_MOTION_CURVES_H
#define REMODEL_MOTION_CURVES_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/math/vec.h"

struct curve { /* a number over time, monotone between its keys (common/math/monotone.h) */
    double *time, *value, *slope;
    int count;
};

/* Allocates `count` keys; the caller fills in increasing times and the values. */
enum status curve_init(struct curve *c, int count, struct err *err);
/* Computes the slopes. rest: the curve starts and ends with slope 0. */
void curve_fit(struct curve *c, bool rest);
/* The value at a time; constant before the first key and after the last. */
double curve_at(const struct curve *c, double time);
void curve_release(struct curve *c);

/* Position and orientation over time. The caller fills position, rotation and distance.time. */
struct motion {
    int count;
    struct vec3 *position;
    struct quat *rotation;         /* unit */
    struct vec3 *tangent;          /* computed: direction of the path at each key, of length <= 1 */
    struct vec3 *rotation_tangent; /* computed: axis of rotation at each key, of length <= 1 */
    struct curve distance;         /* computed: length of the path's chords over time */
    struct curve angle;            /* computed: sum of the angles between keys over time */
};
enum status motion_init(struct motion *m, int count, struct err *err);
void motion_fit(struct motion *m, bool rest);
void motion_at(const struct motion *m, double time, struct vec3 *position, struct quat *rotation);
/* Velocity and angular velocity at the first or the last key. */
void motion_rates(const struct motion *m, bool last, struct vec3 *velocity, struct vec3 *angular_velocity);
void motion_release(struct motion *m);

/* A cubic from a (t = 0) to b (t = 1) with the derivatives da and db with respect to t at its ends. */
struct vec3 motion_position_between(struct vec3 a, struct vec3 b, struct vec3 da, struct vec3 db, double t);
/* The same for unit quaternions, by the shorter way; da and db are angular velocities. */
struct quat motion_rotation_between(struct quat a, struct quat b, struct vec3 da, struct vec3 db, double t);

#endif
