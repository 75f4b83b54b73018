/* frame_points.h - points on the walls that straight edges show. */
#ifndef REMODEL_FRAME_POINTS_H
#define REMODEL_FRAME_POINTS_H

#include "common/capture/point_cloud.h"
#include "common/capture/room_frame.h"
#include "common/model/model_axes.h"

/* Adds oriented points on the frame's walls to a cloud in the model's frame, from the floor to the ceiling of this
 * height, a grid of `edge`. A point counts as many views as places show its wall. */
enum status frame_points_add(struct point_cloud *cloud, const struct room_frame *frame, const struct model_axes *axes,
                             double height, double edge, struct err *err);

#endif
