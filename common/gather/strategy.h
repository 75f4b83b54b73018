/* strategy.h - ways to choose directions of rays at a point: by the cosine, by a gloss lobe, or towards an emitter. */
#ifndef REMODEL_STRATEGY_H
#define REMODEL_STRATEGY_H

#include <stdbool.h>

#include "common/gather/irradiance.h"
#include "common/light/brdf.h"
#include "common/light/sobol.h"
#include "common/math/lanes.h"

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

/* Four unit directions. */
struct directions4 {
    f64x4 x, y, z;
};

/* Four directions from two numbers in [0, 1) each; the result has a bit for each that is above the horizon. The others
 * count as 0. */
unsigned strategy_sample4(const struct strategy *s, f64x4 u, f64x4 v, struct directions4 *directions);
/* The densities (1/sr) with which it chooses unit directions above the horizon. */
f64x4 strategy_density4(const struct strategy *s, const struct directions4 *directions);

/* Directions of `count` samples from points->sample on, at most a packet, by the first two numbers of a group: those
 * above the horizon, one after another. Returns how many they are. points->sample is a multiple of RAY_PACKET. */
int strategy_packet(const struct strategy *s, const struct sobol *points, uint32_t group, int count,
                    struct vec3 directions[RAY_PACKET]);

/* One of them, with the same bits; four take little longer. False: below the horizon. */
bool strategy_sample(const struct strategy *s, const double u[2], struct vec3 *direction);
double strategy_density(const struct strategy *s, struct vec3 direction);

#endif
