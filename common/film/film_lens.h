/* film_lens.h - frame size, focal length and upright direction of a film, derived from the scene's views. */
#ifndef REMODEL_FILM_LENS_H
#define REMODEL_FILM_LENS_H

#include "common/capture/camera_set.h"

struct film_size {     /* requested size, px */
    int width, height; /* 0: follows the aspect ratio of the middle view */
    int max_side;      /* limit of the longer side if both are 0 */
};

/* Fills lens: the size, rounded to even numbers; the views' mean focal length relative to their longer side, scaled so
 * that the frame lies within a photo of the middle view's shape; the principal point in the centre; the name "film"; no
 * pose. Fills up: unit mean of the views' upright directions, in the world; the middle view's where they cancel out.
 * middle: index of the middle view in the set (common/capture/central_views.h). ups: each view's upright direction in
 * its own camera, (0, -1, 0) for a picture stored upright; NULL: all are. */
void film_lens(struct view *lens, struct vec3 *up, const struct camera_set *set, int middle, const struct vec3 *ups,
               const struct film_size *size);

#endif
