/* frame_prior.h - what a view is expected to see of the room: floor, ceiling and walls that are known before its depth.
 */
#ifndef REMODEL_FRAME_PRIOR_H
#define REMODEL_FRAME_PRIOR_H

#include "common/capture/room_frame.h"
#include "stages/segment_depth/plane_match.h"

#define PRIOR_PLANES 24

struct frame_prior {
    struct plane planes[PRIOR_PLANES]; /* that the view is expected to see */
    int count;
    double trust;  /* how much it counts beside the pictures, 0 .. 1 */
    int *expected; /* of each segment: index into planes, -1: nothing is known; owned */
    float *gain;   /* of each segment: by how much less it costs there; owned */
};

/* The planes that segments of the view are expected to lie on. trust: of room_frame_trust(). prior is empty if the
 * frame knows none; the caller releases it in each case. */
enum status frame_prior_make(struct frame_prior *prior, const struct room_frame *frame, double trust,
                             const struct view *view, const struct segmentation *s, struct err *err);
/* Sets the gains. distinct: of each segment, how distinctly it matches, 0 .. 1. */
void frame_prior_weigh(struct frame_prior *prior, const double *distinct, const struct segmentation *s);
void frame_prior_release(struct frame_prior *prior);

#endif
