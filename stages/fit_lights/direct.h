/* direct.h - light of lamps at annotated points, with the shadows that the model and its furniture cast. */
#ifndef REMODEL_FIT_LIGHTS_DIRECT_H
#define REMODEL_FIT_LIGHTS_DIRECT_H

#include "stages/fit_lights/lit_scene.h"

/* Which parts of each lamp each point sees. {0} is the empty state. */
struct direct_light {
    const struct lit_scene *scene;
    uint64_t *seen; /* [lamp][point]: a bit for each part of the lamp; owned */
};

/* model: what throws shadows, the model with or without furniture. ST_NOMEM. */
enum status direct_light_make(struct direct_light *d, const struct lit_scene *scene, const struct model_rays *model,
                              struct err *err);
void direct_light_release(struct direct_light *d);

/* Irradiance at a point from a lamp of radiance 1 with the cone beta (radians) and the exponent. */
double direct_light_at(const struct direct_light *d, int lamp, int point, double beta, double exponent);

#endif
