/* central_views.h - the views of a scene from the centre outwards. */
#ifndef REMODEL_CENTRAL_VIEWS_H
#define REMODEL_CENTRAL_VIEWS_H

#include "common/capture/camera_set.h"

/* order[set->view_count]: the views by distance of their camera centres from the centroid of all centres. Views at the
 * same distance (those of one photo) are ordered by their agreement with the mean viewing direction, best first. */
enum status central_views(int *order, const struct camera_set *set, struct err *err);

#endif
