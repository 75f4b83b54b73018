/* layout.h - what a film of a scene starts from: the centremost view, the scene's centroid, the frame of reference and
 * the lens (thesis 3.4.2). */
#ifndef REMODEL_SAMPLE_VALIDITY_LAYOUT_H
#define REMODEL_SAMPLE_VALIDITY_LAYOUT_H

#include "common/film/shot.h"
#include "common/layers/scene_points.h"
#include "stages/sample_validity/validity_params.h"

/* The centroid is the median of the segments in the middle of the central views' pictures; the frame's origin the
 * centremost view's centre, its z axis the normal of the plane of the centres; up the mean of the views' upright
 * directions (ups: one a view, in its camera's axes; NULL: all are stored upright); the focal length the views' mean.
 * center_view gets the centremost view's index. ST_DATA: nothing there has a depth. */
enum status layout_find(struct shot *shot, int *center_view, const struct layer_scene *scene,
                        const struct scene_points *points, const struct vec3 *ups, const struct validity_params *params,
                        struct err *err);

#endif
