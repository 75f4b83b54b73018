/* image_effects.h - image effects of a move: depth of field, focus, saturation and brightness [Colburn 2014, 3.4.3]. */
#ifndef REMODEL_IMAGE_EFFECTS_H
#define REMODEL_IMAGE_EFFECTS_H

#include "common/capture/camera_path.h"
#include "common/film/effects.h"
#include "common/film/validity.h"
#include "stages/plan_path/plan_params.h"

/* Sets each frame's aperture and focus. The aperture runs linearly, eased as the move, between a pinhole and the widest
 * valid aperture at the end that has it. Focus is on the subject; it is pulled from the first to the second. fractions:
 * each frame's position on the path, 0 to 1. *widest gets the widest aperture (diameter, scene units); 0: it cannot
 * open, and all frames are pinhole. */
enum status effects_focus(struct camera_path *path, double *widest, const double *fractions,
                          struct viewpoint_test *test, const struct validity *v, const struct subject_list *subjects,
                          const struct plan_params *params, struct err *err);

/* Fills layers with the effect's saturation or brightness layer, if it has one: inside or outside a box around the
 * subject, from no change at the first frame to the parameter's value at the last. */
enum status effects_tone_layers(struct effects *layers, const struct validity *v, const struct subject_list *subjects,
                                const struct camera_path *path, const struct plan_params *params, struct err *err);

#endif
