/* image_effects.h - what a film does besides moving (thesis 3.4.3): depth of field, focus, saturation and
 * brightness. */
#ifndef REMODEL_IMAGE_EFFECTS_H
#define REMODEL_IMAGE_EFFECTS_H

#include "common/capture/camera_path.h"
#include "common/film/effects.h"
#include "common/film/validity.h"
#include "stages/plan_path/plan_params.h"

/* The widest aperture (diameter, scene units) at a camera that is in focus at `focus`, of the box around whose disk all
 * four corners are valid viewpoints: grown until one of them is not, then halved in between. No wider than makes a
 * circle of confusion of max_blur (px) of what is infinitely far. 0: not even a small one is valid. */
enum status aperture_search(double *aperture, struct viewpoint_test *test, const struct view *camera, double focus,
                            double max_blur, struct err *err);

/* Sets every frame's aperture and focus: the aperture goes linearly, eased as the move is, between a pinhole and the
 * widest one at the end that has it; focus is on the subject, and is pulled from the first to the second. parts: each
 * frame's place on the way, 0 to 1. *widest gets the widest aperture; 0: it cannot open, and all frames are pinhole. */
enum status focus_frames(struct camera_path *path, double *widest, const double *parts, struct viewpoint_test *test,
                         const struct validity *v, const struct subject_list *subjects,
                         const struct plan_params *params, struct err *err);

/* The layer of the effect's tone, if it has one: in a box around the subject, or outside it, from what is there at the
 * first frame to the parameter's value at the last. */
enum status tone_layers(struct effects *layers, const struct validity *v, const struct subject_list *subjects,
                        const struct camera_path *path, const struct plan_params *params, struct err *err);

#endif
