/* irradiance_pictures.h - pictures of irradiance before and after edits, against TRUTH/irradiance and
 * TRUTH/edited-E/irradiance: irradiance.picture_* and irradiance.ratio_*. */
#ifndef REMODEL_IRRADIANCE_PICTURES_H
#define REMODEL_IRRADIANCE_PICTURES_H

#include "stages/evaluate/scene/evaluation_parts.h"

enum status evaluate_irradiance_pictures(struct evaluation *e, struct err *err);

#endif
