/* tour_picture.h - a tour drawn on the plan of its model, to check it by eye. */
#ifndef REMODEL_TOUR_PICTURE_H
#define REMODEL_TOUR_PICTURE_H

#include "common/capture/camera_path.h"
#include "common/model/model_plan.h"
#include "stages/plan_tour/tour_graph.h"

/* SVG: rooms, walls, openings, boxes, viewpoints (hollow: left out), the stops with their photos' ids, the way of the
 * frames, and where the camera looks, twice a second. Walls that are parallel to no axis are shown by their rooms. */
enum status tour_picture_write(const struct camera_path *path, const struct tour_graph *g,
                               const struct tour_stop *stops, int stop_count, const struct model_plan *plan,
                               const struct model_axes *axes, const char *file, struct err *err);

#endif
