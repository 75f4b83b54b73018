/* central_views.h - the views of a scene from the middle outwards. */
#ifndef REMODEL_CENTRAL_VIEWS_H
#define REMODEL_CENTRAL_VIEWS_H

#include "common/capture/camera_set.h"

/* order[set->view_count]: views by the distance of their centres to the centres' centroid; of those at one distance
 * (the views of one photo) first those that look where most views look. */
enum status central_views(int *order, const struct camera_set *set, struct err *err);

#endif
