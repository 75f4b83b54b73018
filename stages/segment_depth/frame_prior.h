/* frame_prior.h - what a view is expected to see of the room: floor, ceiling and walls that straight edges show. */
#ifndef REMODEL_FRAME_PRIOR_H
#define REMODEL_FRAME_PRIOR_H

#include "common/capture/room_frame.h"
#include "stages/segment_depth/plane_prior.h"

/* The planes that segments of the view are expected to lie on. frame may be NULL; then nothing is expected. The caller
 * releases the prior in each case. */
enum status frame_prior_make(struct plane_prior *prior, const struct room_frame *frame, const struct view *view,
                             const struct segmentation *s, struct err *err);
/* Sets the gains. trust: of room_frame_trust(). distinct: of each segment, how distinctly it matches, 0 .. 1. */
void frame_prior_weigh(struct plane_prior *prior, double trust, const double *distinct, const struct segmentation *s);

#endif
