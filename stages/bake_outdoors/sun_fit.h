/* sun_fit.h - the sun's direction and size from the edges of its patches, to a fraction of a degree. */
#ifndef REMODEL_SUN_FIT_H
#define REMODEL_SUN_FIT_H

#include "common/gather/atlas_squares.h"

struct sun_fit {
    struct vec3 direction; /* unit, towards the sun, model frame */
    double radius;         /* of its disk, degrees */
    double error;          /* of the direction, degrees: half the width of its interval of 95 % */
    double gain;           /* share of the contrast of pairs at edges of the patches that the sun explains, 0 to 1 */
    double chance;         /* the same of a sun that makes dark, in the same place: what chance explains */
};

/* Refines f->direction. texels: squares close to the edges of its patches. ST_NOMEM. Same bits for any number of
 * threads. */
enum status sun_fit_edges(struct sun_fit *f, const struct atlas_squares *texels, const struct model_rays *model,
                          struct err *err);

/* Sets share[i] to the part of the sun's disk that square i sees. */
void sun_shares(float *share, const struct atlas_squares *texels, const struct model_rays *model, struct vec3 direction,
                double radius);

/* A unit direction `degrees` off a unit direction, at an angle (radians) around it. */
struct vec3 sun_aside(struct vec3 direction, double angle, double degrees);

/* How much of the contrast at its edges a direction explains once `known` has explained what it can: the gain of a
 * direction whose patches lie on the same edges is small. texels: close to the edges of `other`. ST_NOMEM. */
enum status sun_fit_rest(double *gain, const struct sun_fit *known, const struct sun_fit *other,
                         const struct atlas_squares *texels, const struct model_rays *model, struct err *err);

#endif
