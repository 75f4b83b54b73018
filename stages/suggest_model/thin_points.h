/* thin_points.h - a cloud with at most one point per cube and direction of the normal. */
#ifndef REMODEL_THIN_POINTS_H
#define REMODEL_THIN_POINTS_H

#include "common/capture/point_cloud.h"

struct thin_points {
    struct point_cloud cloud;
    float *weight; /* owned; of each point: the sum of the confidences of the points that it stands for */
};

/* The points of one cube of this edge whose normals lie in one of ten directions (up, down, eight in plan) become one
 * point: their mean. The caller releases the result, which a failure leaves empty. */
enum status points_thin(struct thin_points *thin, const struct point_cloud *cloud, double edge, struct err *err);
void thin_points_release(struct thin_points *thin);

#endif
