/* lamps_on_faces.h - fits all lamps of a scene together to the light on its photographed faces. */
#ifndef REMODEL_FIT_LIGHTS_LAMPS_ON_FACES_H
#define REMODEL_FIT_LIGHTS_LAMPS_ON_FACES_H

#include "stages/fit_lights/face_light.h"
#include "stages/fit_lights/unseen_lamps.h"

/* Fits the lamps of the scene for which is_free is set, and those that nobody marked; the others shine as they are.
 * Fills lamps, one for each of the scene; sets intensity and error of u->lamps that are known. u: gathered.
 * ST_NOMEM. */
enum status lamps_on_faces_fit(struct face_lamp *lamps, const bool *is_free, struct unseen_lamps *u,
                               const struct lit_scene *scene, const struct model_rays *furnished, struct err *err);

#endif
