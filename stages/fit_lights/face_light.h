/* face_light.h - the radiance of lamps from the light that they throw on all photographed faces. */
#ifndef REMODEL_FIT_LIGHTS_FACE_LIGHT_H
#define REMODEL_FIT_LIGHTS_FACE_LIGHT_H

#include "common/gather/atlas_squares.h"

struct face_light {
    const struct atlas_squares *squares; /* of the textured faces */
    const double (*known)[3];            /* irradiance of each square from all but these lamps */
    const double *factors;               /* [lamp][square] irradiance from a lamp of radiance 1 */
    int lamp_count;
};

/* What the faces tell of a lamp. */
struct face_lamp {
    bool is_known; /* else the rest means nothing */
    double radiance[3];
    double error[3]; /* standard errors of its logarithm */
};

/* Fills lamps[lamp_count]. A lamp that lights too few faces, or whose error is large, is not known. ST_NOMEM. Same bits
 * for any number of threads. */
enum status face_light_fit(struct face_lamp *lamps, const struct face_light *l, struct err *err);

#endif
