/* strategy.h - ways to choose directions of rays at a point: by the cosine, by a gloss lobe, or towards an emitter. */
#ifndef REMODEL_STRATEGY_H
#define REMODEL_STRATEGY_H

#include <stdbool.h>

#include "common/gather/irradiance.h"
#include "common/light/brdf.h"

enum strategy_kind {
    STRATEGY_COSINE,
    STRATEGY_LOBE,
    STRATEGY_DISK,      /* by area */
    STRATEGY_QUAD,      /* by area */
    STRATEGY_RECTANGLE, /* by solid angle */
    STRATEGY_SUN        /* by solid angle */
};

/* A rectangle in the frame of its own axes, as the point sees it. */
struct seen_rectangle {
    struct vec3 x, y, z;                /* unit */
    double x0, x1, y0, y1, z0;          /* z0 < 0 */
    double b0, b1, offset, solid_angle; /* of [Urena 2013] */
};

/* Filled by strategy_*(); belongs to one point. */
struct strategy {
    enum strategy_kind kind;
    struct gather_point point;
    struct vec3 x, y; /* with the normal an orthonormal frame */
    const struct brdf *lobe;
    struct vec3 view;
    const struct emitter *emitter;
    struct vec3 to, half[2], dual[2]; /* of a disk or quad: its centre from the point, half axes; q = to + a half[0] + b
                                         half[1] has a = dual[0] . (q - to) */
    double area;
    struct seen_rectangle rectangle;
    double estimate; /* of the emitter's irradiance if nothing hides it */
};

void strategy_cosine(struct strategy *s, struct gather_point p);
/* By the lobe of a brdf (its albedo counts as 0) towards a viewer in the unit direction `view`. Keeps a pointer to
 * it. */
void strategy_lobe(struct strategy *s, struct gather_point p, const struct brdf *lobe, struct vec3 view);
/* Towards an emitter; keeps a pointer to it. False: it cannot light the point. */
bool strategy_emitter(struct strategy *s, struct gather_point p, const struct emitter *emitter);

/* A unit direction from two numbers in [0, 1). False: below the horizon; the sample counts as 0. */
bool strategy_sample(const struct strategy *s, const double u[2], struct vec3 *direction);
/* The density (1/sr) with which strategy_sample() chooses a unit direction above the horizon. */
double strategy_density(const struct strategy *s, struct vec3 direction);

#endif
