/* move_layout.h - setup of a scene's moves: centremost view, centroid, reference frame, lens [Colburn 2014, 3.4.2]. */
#ifndef REMODEL_MOVE_LAYOUT_H
#define REMODEL_MOVE_LAYOUT_H

#include "common/film/shot.h"
#include "common/layers/scene_points.h"
#include "stages/sample_validity/validity_params.h"

/* Fills shot, and view_idx with the centremost view's index. ups: each view's upright direction in its own camera;
 * NULL: all are stored upright. ST_DATA: nothing visible has a depth, or the centroid is behind the centremost view. */
enum status layout_find(struct shot_setup *shot, int *view_idx, const struct layer_scene *scene,
                        const struct scene_points *points, const struct vec3 *ups, const struct validity_params *params,
                        struct err *err);

#endif
