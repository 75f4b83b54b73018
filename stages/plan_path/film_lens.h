/* film_lens.h - size, focal length and upright direction of a film of a scene's views. */
#ifndef REMODEL_FILM_LENS_H
#define REMODEL_FILM_LENS_H

#include "stages/plan_path/establishing_dolly.h"

/* lens: the film's size, by the parameters or the shape of the view nearest the middle of all, made even; the views'
 * mean focal length, so that the film's picture lies within a photo's; the principal point in the middle. No name, no
 * pose. up: the views' mean upright direction, of length 1, in the world. ups: as plan_establishing_dolly() takes
 * them. set has a view. */
void film_lens(struct view *lens, struct vec3 *up, const struct camera_set *set, const struct vec3 *ups,
               const struct plan_params *params);

#endif
