/* solve_inputs.h - what is known before the lamps of a scene are found. */
#ifndef REMODEL_FIT_LIGHTS_SOLVE_INPUTS_H
#define REMODEL_FIT_LIGHTS_SOLVE_INPUTS_H

#include "stages/fit_lights/direct.h"
#include "stages/fit_lights/face_light.h"
#include "stages/fit_lights/fit_lights_params.h"
#include "stages/fit_lights/observe_lights.h"

struct solve_inputs {
    struct lit_scene *scene; /* its lamps get radiance, beta, exponent */
    const struct annotation_list *notes;
    const struct observations *seen;
    const struct direct_light *direct;
    const double (*indirect)[3];   /* of each point */
    const struct model_rays *rays; /* for the names of faces and the height */
    const struct fit_lights_params *params;
    const struct face_lamp *faces; /* what all faces tell of each lamp; NULL: nothing */
    bool is_provisional;           /* without intervals and warnings: the lamps are fitted again */
};

#endif
