/* sun_indoors.h - the light indoors without the sun, and what surfaces make of it. */
#ifndef REMODEL_SUN_INDOORS_H
#define REMODEL_SUN_INDOORS_H

#include "common/gather/atlas_squares.h"
#include "common/gather/irradiance.h"
#include "common/gather/model_field.h"
#include "common/texture/outdoors.h"

/* What a gather sees: the textures of the model, its furniture, and through its openings the outdoors without the sun.
 */
struct sun_indoors {
    const struct atlas_scene *scene; /* its model may have the triangles of furniture behind its faces */
    const struct outdoors *outdoors;
    const struct field_surfaces *furniture; /* what these triangles send out; NULL: the model has none */
    const struct model_rays *bare;          /* the model without them; NULL: as the scene's */
};

/* The field that gathers read; `in` must live as long. */
struct light_field sun_indoors_field(const struct sun_indoors *in);

#endif
