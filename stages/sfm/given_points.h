/* given_points.h - whether the points of a given model serve the photos of the scene.
 *
 * Many programs write points that no photo observes, or only one: scripts that add a dense cloud, exporters of networks
 * that estimate cameras. Such points say where the scene is, but not which photos show the same. */
#ifndef REMODEL_GIVEN_POINTS_H
#define REMODEL_GIVEN_POINTS_H

#include <stdbool.h>

#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

enum { MIN_SHARED_POINTS = 8 }; /* of a photo, with other photos */

struct point_support {
    int placed;       /* photos of the scene that the model places */
    int supported;    /* of these: they share MIN_SHARED_POINTS points with other placed photos */
    long long shared; /* points that at least two placed photos observe */
};

/* ST_NOMEM. */
enum status given_points_count(struct point_support *s, const struct sfm_model *m, const struct photo_list *photos,
                               struct err *err);

/* Fewer than half of the placed photos are supported: the model counts as one without points. With fewer than two
 * placed photos nothing can be done about it, and the points suffice. */
bool given_points_suffice(const struct point_support *s);

#endif
