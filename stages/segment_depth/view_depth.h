/* view_depth.h - layered depth of one view, from pictures and cameras. */
#ifndef REMODEL_VIEW_DEPTH_H
#define REMODEL_VIEW_DEPTH_H

#include "common/capture/room_frame.h"
#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "common/light/model_rays.h"
#include "common/model/model_axes.h"
#include "stages/segment_depth/neighbours.h"
#include "stages/segment_depth/segment_params.h"

/* Where a view's inputs come from. The callbacks fill what is empty on entry; the algorithm releases it. */
struct view_source {
    enum status (*read)(void *ctx, int view_idx, struct image *im, struct err *err);
    /* The view's depth in the previous round, segments and the interior's ids; NULL in the first round. */
    enum status (*read_depth)(void *ctx, int view_idx, struct layered_depth *d, struct err *err);
    void *ctx;
    /* Depth that the user provides: z of each of the view's pixels, 0 if unknown; malloc'ed, NULL if none is given. The
     * callback may be NULL. */
    enum status (*read_given)(void *ctx, int view_idx, float **z, struct err *err);
    const struct vec3 *ups; /* of each view: the upright direction in its camera (upright.h); NULL: all stand upright */
    const struct room_frame *frame; /* what is known of the room; NULL: nothing */
    const struct model_rays *model; /* the solid model, after the first round; NULL: there is none yet */
    const struct model_axes *axes;  /* its frame */
};

/* out: {0} on entry; the caller releases it. neighbours, neighbour_count: the views that were read besides view_idx.
 * ST_DATA: no neighbour and no given depth. Same bits for any number of threads. */
enum status view_depth(struct layered_depth *out, int neighbours[MAX_NEIGHBOURS], int *neighbour_count,
                       const struct camera_set *set, int view_idx, const struct view_source *source,
                       const struct segment_params *params, struct err *err);

#endif
