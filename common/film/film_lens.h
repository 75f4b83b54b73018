/* film_lens.h - size, focal length and upright direction of a film of a scene's views. */
#ifndef REMODEL_FILM_LENS_H
#define REMODEL_FILM_LENS_H

#include "common/capture/camera_set.h"

struct film_size {     /* what was asked for */
    int width, height; /* 0: by the shape of the middle view */
    int max_side;      /* of the longer side where both are 0 */
};

/* lens: the film's size, made even; the views' mean focal length, so that the film's picture lies within a photo's of
 * the shape of the middle view (of the set's index `middle`: common/capture/central_views.h); the principal point in the
 * middle; the name "film", no pose. up: the views' mean upright direction, of length 1, in the world. ups: a view's
 * upright direction in its own camera (0 -1 0 for a picture that is stored upright), one a view; NULL: all upright. */
void film_lens(struct view *lens, struct vec3 *up, const struct camera_set *set, int middle, const struct vec3 *ups,
               const struct film_size *size);

#endif
