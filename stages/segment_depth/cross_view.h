/* cross_view.h - what the depth maps that neighbouring views had in the round before say about a segment's plane.
 *
 * A point of the plane is carried into each neighbour, whose depth there is at the point (they agree), nearer (something hides the
 * point from the neighbour: its picture says nothing), or farther (the neighbour sees through the point: one of the two is
 * wrong). After C. L. Zitnick, S. B. Kang, "Stereo for Image-Based Rendering using Image Over-Segmentation", 2007. */
#ifndef REMODEL_CROSS_VIEW_H
#define REMODEL_CROSS_VIEW_H

#include "common/layers/layered_depth.h"
#include "stages/segment_depth/plane_match.h"

/* Reads the depth of a view in the round before: segments and the interior's ids; d is {0} on entry. */
struct depth_source {
    enum status (*read)(void *ctx, int view_idx, struct layered_depth *d, struct err *err);
    void *ctx;
};

#define CROSS_PLACES 8 /* of a segment; as many as a vector has lanes */

/* A segment's places as a neighbour sees them: [u' v' 1] ~ turned + shift / z. */
struct cross_places {
    float turned[3][CROSS_PLACES];
    float steps
        [CROSS_PLACES]; /* steps of the view in a unit of inverse depth of the neighbour, both at the same distance */
};

struct cross_plane {
    float a, b, c, confidence;
};

struct cross_neighbour {
    double base[3][3], shift[3]; /* as match_neighbour, at the picture's own size */
    struct layered_depth depth;
    struct cross_places *places; /* of each segment of the view */
    struct cross_plane *planes;  /* by the ids of depth; 0 stands for no segment */
};

struct cross_view {
    struct cross_neighbour neighbours[MAX_NEIGHBOURS];
    int count;
    double step;                      /* of inverse depth: about one pixel */
    float (*places)[2][CROSS_PLACES]; /* of each segment: u, v */
    int *first_proposal;              /* count + 1: planes of neighbours' segments whose middles lie in a segment */
    struct plane *proposals;
};

/* x is {0} on entry; release it also after a failure. */
enum status cross_view_make(struct cross_view *x, const struct segmentation *s, const struct camera_set *set,
                            int view_idx, const int *neighbours, int count, double step,
                            const struct depth_source *source, struct err *err);
void cross_view_release(struct cross_view *x);

/* 0: all neighbours agree; a little above 1: all are sure that they see through the plane. *hidden: bit k is set if the segment is behind
 * something in neighbour k. */
float cross_view_cost(const struct cross_view *x, int segment, struct plane plane, unsigned *hidden);

/* Neighbours that agree at the segment's middle, weighted by their own confidence: views that all have inherited a depth do not make
 * it sure. */
double cross_view_agreeing(const struct cross_view *x, int segment, struct plane plane);

#endif
