/* texture_frames.h - the frame of a door or window, in the texture of its wall, goes with it; for texture_rules.c. */
#ifndef REMODEL_BUILD_MODEL_TEXTURE_FRAMES_H
#define REMODEL_BUILD_MODEL_TEXTURE_FRAMES_H

#include "stages/build_model/texture/texture_wishes.h"

/* Adds rules to a face of a wall for the openings that an edit moved along it. base_face: its own place in the base;
 * `by` leads there. Other faces get none. */
enum status texture_frames_add(struct texture_face *to, const struct texture_models *m, int face, int base_face,
                               struct vec3 by, struct err *err);

#endif
