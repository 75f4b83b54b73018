/* cross_view.h - consistency of a plane with the depth that neighbouring views had in the previous round. */
#ifndef REMODEL_CROSS_VIEW_H
#define REMODEL_CROSS_VIEW_H

#include "common/layers/layered_depth.h"
#include "stages/segment_depth/plane_match.h"

/* Reads the depth of a view in the previous round: segments and the interior's ids; d is {0} on entry. */
struct previous_depth_source {
    enum status (*read)(void *ctx, int view_idx, struct layered_depth *d, struct err *err);
    void *ctx;
};

#define CROSS_SAMPLES 8 /* pixels of a segment that are compared; as many as a vector has lanes */

/* The samples of a segment in a neighbour: [u' v' 1] ~ rotated + shift / z. */
struct cross_warp {
    float rotated[3][CROSS_SAMPLES];
};

struct cross_plane {
    float a, b, c, confidence;
};

/* The neighbour's surface as the view sees it at the samples of a segment. */
struct cross_front {
    float inverse[CROSS_SAMPLES];      /* 1/z */
    uint8_t confidence[CROSS_SAMPLES]; /* 255 is 1; 0: it is not seen there */
};

struct cross_neighbour {
    double base[3][3], shift[3]; /* as match_neighbour, at the picture's own size */
    struct layered_depth depth;
    struct cross_warp *warps;   /* of each segment of the view */
    struct cross_front *fronts; /* of each segment of the view */
    struct cross_plane *planes; /* by the ids of depth; 0 is no segment */
};

struct cross_view {
    struct cross_neighbour neighbours[MAX_NEIGHBOURS];
    int count;
    double step;                        /* of inverse depth: about one pixel */
    float (*samples)[2][CROSS_SAMPLES]; /* of each segment: u, v */
    int *first_proposal;     /* count + 1: proposals of segment i are [first_proposal[i], first_proposal[i + 1]) */
    struct plane *proposals; /* planes of the neighbours' segments whose centroids project into the segment */
};

/* x is {0} on entry; release it also after a failure. */
enum status cross_view_make(struct cross_view *x, const struct segmentation *s, const struct camera_set *set,
                            int view_idx, const int *neighbours, int count, double step,
                            const struct previous_depth_source *source, struct err *err);
void cross_view_release(struct cross_view *x);

/* Mean inconsistency: 0 if all neighbours agree; a little above 1 if all are confident that they see through the plane;
 * up to 1.65 if it lies behind confident surfaces of all, which the view would see through.
 * *occluded: bit k is set if a surface of neighbour k hides the segment from it. */
float cross_view_cost(const struct cross_view *x, int segment, struct plane plane, unsigned *occluded);
/* The same; a value above max_cost, and any *occluded, as soon as it is clear that it exceeds max_cost. */
float cross_view_bounded(const struct cross_view *x, int segment, struct plane plane, float max_cost,
                         unsigned *occluded);

/* Number of neighbours that agree at the segment's middle, each weighted by its confidence: views that have all
 * inherited a depth do not confirm it. */
double cross_view_support(const struct cross_view *x, int segment, struct plane plane);

#endif
