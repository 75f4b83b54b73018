/* model_prior.h - what a view is expected to see of the solid model. */
#ifndef REMODEL_MODEL_PRIOR_H
#define REMODEL_MODEL_PRIOR_H

#include "common/light/view_trace.h"
#include "stages/segment_depth/plane_problem.h"

/* The planes of the faces that segments of the view show if nothing stands before them, and of floor and ceiling where
 * walls have no room; nothing is expected behind panes. trace: of the view, in the size of its segments. scale: units
 * of the model in a unit of the scene. The caller releases the prior in each case. */
enum status model_prior_make(struct plane_prior *prior, const struct view_trace *trace, double scale,
                             const struct view *view, const struct segmentation *s, struct err *err);
/* Sets the gains. sure: of each segment, the confidence of its depth before, 0 .. 1. */
void model_prior_weigh(struct plane_prior *prior, double gain, const double *sure, const struct segmentation *s);

#endif
