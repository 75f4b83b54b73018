/* view_layers.h - the layers of a view's ids: face and depth of each pixel, depth jumps, clutter. */
#ifndef REMODEL_VIEW_LAYERS_H
#define REMODEL_VIEW_LAYERS_H

#include "common/layers/layered_depth.h"
#include "common/light/view_trace.h"
#include "common/texture/view_ids.h"
#include "stages/trace_ids/trace_params.h"

/* Sets ids->id and z. */
void view_trace_ids(struct view_ids *ids, const struct view_trace *t);

/* Sets ids->jump. depth: of the view, for the pixels that the view does not have. */
enum status view_jumps_find(struct view_ids *ids, const struct view_trace *t, const struct layered_depth *depth,
                            const struct trace_params *params, struct err *err);

/* Sets ids->clutter. scale: model units per scene unit. */
enum status view_clutter_find(struct view_ids *ids, const struct view_trace *t, const struct layered_depth *depth,
                              double scale, const struct trace_params *params, struct err *err);

#endif
