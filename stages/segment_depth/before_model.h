/* before_model.h - which segments of a view stand before the solid model, and which lie on it. */
#ifndef REMODEL_BEFORE_MODEL_H
#define REMODEL_BEFORE_MODEL_H

#include "stages/segment_depth/plane_problem.h"

/* Moves what stands off the model without evidence to the plane that is expected there, and marks it as inherited. All
 * arrays: of each segment; found: of furniture_sweep_find(). p->weights: of the borders. ST_NOMEM. */
enum status before_model_settle(struct plane *planes, bool *inherited, const double *confidence,
                                const struct plane *found, const struct plane_problem *p, struct err *err);

#endif
