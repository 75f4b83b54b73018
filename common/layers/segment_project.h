/* segment_project.h - a view's segments, planes in its pixels, as a novel camera sees them.
 *
 * A segment's plane p = (a, b, c), 1/z = p . (u, v, 1), and the relative pose X_view = R X_novel + t give, in
 * pixels,
 *   M = K_view R K_novel^-1,   k = K_view t,   m = M^T p / (1 - p . k)
 *   1/z_novel = m . (x, y, 1),   (u, v, 1) ~ (M + k m^T) (x, y, 1)
 * and 1 - p . k <= 0 where the novel camera is behind the plane: such a segment is not seen. */
#ifndef REMODEL_SEGMENT_PROJECT_H
#define REMODEL_SEGMENT_PROJECT_H

#include <stdbool.h>

#include "common/layers/layer_view.h"

struct view_relation {                    /* "to pixels from pixels", both ways */
    double m[3][3], k[3];                 /* view from novel */
    double inverse_m[3][3], inverse_k[3]; /* novel from view */
    int width, height;                    /* of the novel camera */
};

void view_relation_make(struct view_relation *r, const struct view *view, const struct view *novel);

struct projected_segment {
    /* target position (x, y; pixel centres at + 0.5) -> index into the padded texels, homogeneous */
    double from_target[3][3];
    double inverse_z[3];   /* 1/z_novel = inverse_z . (x, y, 1) */
    double u0, v0, u1, v1; /* where in the padded texels it may have coverage */
    int x0, y0, x1, y1;    /* target pixels, inclusive, that it may touch */
};

/* False if the novel camera cannot see it. */
bool segment_project(struct projected_segment *s, const struct view_relation *r, const struct depth_segment *segment,
                     const struct segment_shape *shape);

#endif
