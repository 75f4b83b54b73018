/* lamp.h - a lamp: a disk or a quad that shines into a room. */
#ifndef REMODEL_LAMP_H
#define REMODEL_LAMP_H

#include <stdbool.h>

#include "common/light/colour.h"
#include "common/math/vec.h"

/* Of the model's size, 5 cm of 10 m: a lamp that is at most this far behind a surface is still in front of it. A lamp
 * is a place of a ceiling or hangs under it, and photographs and the model agree on that to some centimetres only. */
#define LAMP_REACH 0.005

enum lamp_shape { LAMP_DISK, LAMP_QUAD };

/* A lamp has radiance S cos(t)^exponent towards an angle t <= beta from its normal, and 0 beyond. */
struct lamp {
    char *name; /* owned */
    enum lamp_shape shape;
    struct vec3 centre, normal; /* unit, towards the room */
    struct vec3 x, y;           /* half edges of a quad; of a disk, orthogonal half axes of length `radius` */
    double radius;              /* of a disk */
    struct rgb radiance;        /* S */
    double beta, exponent;      /* radians, at most pi / 2 */
    bool bound;                 /* S is a lower bound: the lamp is saturated where it was measured */
};

/* Radiance of a lamp towards a unit direction that points away from it. */
struct rgb lamp_radiance(const struct lamp *l, struct vec3 direction);
/* Irradiance from an unhidden lamp at a point with a unit normal, by quadrature to 1e-6 of it (closed forms where there
 * are some). */
struct rgb lamp_irradiance(const struct lamp *l, struct vec3 at, struct vec3 normal);

#endif
