/* sun_lamps.h - the light indoors that the textures lack, as lamps below the ceilings. */
#ifndef REMODEL_SUN_LAMPS_H
#define REMODEL_SUN_LAMPS_H

#include "stages/bake_outdoors/sun_indoors.h"

/* Lamps that shine down, their intensity falling with the cosine. {0}: none. Everything is owned. */
struct sun_lamps {
    struct vec3 *at;        /* model frame */
    double (*intensity)[3]; /* straight down: irradiance at distance 1 */
    int count;
};

/* Fits lamps to how bright unlit surfaces are. edges: squares close to the edges of the sun's patches; direction and
 * radius (degrees) are the sun's. The caller releases l, also after a failure. ST_NOMEM. Same bits for any number of
 * threads. */
enum status sun_lamps_fit(struct sun_lamps *l, const struct sun_indoors *in, const struct atlas_squares *edges,
                          struct vec3 direction, double radius, struct err *err);
void sun_lamps_release(struct sun_lamps *l);

/* The irradiance from all lamps at a point of a surface with a unit normal. */
struct rgb sun_lamps_irradiance(const struct sun_lamps *l, const struct model_rays *model, struct vec3 at,
                                struct vec3 normal);

#endif
