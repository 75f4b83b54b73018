/* segment_project.h - projection of a view's segments, planes in its pixels, into a novel camera.
 *
 * See segment_project.c. Pixel centres at + 0.5. */
#ifndef REMODEL_SEGMENT_PROJECT_H
#define REMODEL_SEGMENT_PROJECT_H

#include <stdbool.h>

#include "common/layers/layer_view.h"

#define PROJECT_SLACK      1e-3 /* px, of a bounding box in target pixels */
#define PROJECT_MIN_FACING 1e-6 /* min 1 - p . k: below, the plane is seen edge-on or from behind */
#define PROJECT_MIN_RATIO  1e-6 /* min ratio of the depths in the novel camera and in the view */

struct view_relation {                    /* pixels from pixels: M and k of segment_project.c, both ways */
    double m[3][3], k[3];                 /* view from novel */
    double inverse_m[3][3], inverse_k[3]; /* novel from view */
    int width, height;                    /* of the novel camera */
};

void segment_relation_make(struct view_relation *r, const struct view *view, const struct view *novel);

struct projected_segment {
    double from_target[3][3]; /* homography: target position (x, y, 1) -> index into the padded texels */
    double inverse_z[3];      /* 1/z_novel = inverse_z . (x, y, 1) */
    double u0, v0, u1, v1;    /* bounding box in the padded texels */
    int x0, y0, x1, y1;       /* bounding box in target pixels, inclusive */
};

/* False: the novel camera cannot see the segment. */
bool segment_project(struct projected_segment *s, const struct view_relation *r, const struct depth_segment *segment,
                     const struct segment_shape *shape);

#endif
