/* point_lamp.h - what a small lamp gives a surface. */
#ifndef REMODEL_POINT_LAMP_H
#define REMODEL_POINT_LAMP_H

#include "common/light/model_rays.h"

enum point_lamp_kind {
    POINT_LAMP_DOWNWARDS, /* flat, with its face down: its intensity falls with the cosine to straight down */
    POINT_LAMP_ROUND      /* the same intensity to all sides */
};

/* Irradiance at a point with this unit normal from a lamp of intensity 1: cosines / distance^2, in 1 / units^2. It is 0
 * behind the surface or the lamp, and where the model is between. */
double point_lamp_factor(const struct model_rays *model, enum point_lamp_kind kind, struct vec3 lamp, struct vec3 at,
                         struct vec3 normal);

#endif
