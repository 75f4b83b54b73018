/* plane_prior.h - what a view is expected to see: planes of the room that are known before the view's depth. */
#ifndef REMODEL_PLANE_PRIOR_H
#define REMODEL_PLANE_PRIOR_H

#include "stages/segment_depth/plane_match.h"

#define PRIOR_PLANES 24

struct plane_prior {
    struct plane planes[PRIOR_PLANES]; /* that the view is expected to see */
    int count;
    int *expected; /* of each segment: index into planes, -1: nothing is known; owned */
    float *gain;   /* of each segment: by how much less it costs there; owned, 0 at first */
};

/* A plane that may be expected, and how many pixels of the view expect it. */
struct prior_candidate {
    struct vec3 normal; /* in the view's axes, normal . X = 1 */
    double pixels;
};

/* Expects nothing yet. The caller releases the prior, also after a failure. */
enum status plane_prior_init(struct plane_prior *prior, int segments, struct err *err);
/* Keeps the candidates that most pixels expect; prior->expected holds indices of candidates on entry. */
enum status plane_prior_keep(struct plane_prior *prior, const struct prior_candidate *candidates, int count,
                             const struct view *view, const struct segmentation *s, struct err *err);
void plane_prior_release(struct plane_prior *prior);

#endif
