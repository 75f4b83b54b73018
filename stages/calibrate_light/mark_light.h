/* mark_light.h - the light of measured places, in the unit of the scene's views. */
#ifndef REMODEL_MARK_LIGHT_H
#define REMODEL_MARK_LIGHT_H

#include "common/gather/model_field.h"
#include "common/model/scene_inputs.h"
#include "stages/calibrate_light/calibrate_params.h"
#include "stages/calibrate_light/lux_marks.h"

struct mark_inputs {
    const char *views;               /* folder */
    const struct scene_inputs *in;   /* cameras and lenses; axes if there is a field */
    const struct model_field *field; /* NULL: without one, illuminance is an error */
    const struct gatherer *gatherer;
    const struct calibrate_params *params;
    struct provenance *prov;
};

/* Fills list[i], of marks->count elements, from marks->items[i]; the caller frees their names, also after a failure.
 * ST_DATA with file and line: an unknown view or face, a pixel outside of its photo or that shows no surface of the
 * model, a saturated patch, no light at all. */
enum status mark_light_find(struct lux_measurement *list, const struct lux_marks *marks, const struct mark_inputs *in,
                            struct err *err);

#endif
