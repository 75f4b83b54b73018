/* choose_pair.h - which two viewpoints' textures a free camera takes, and their shares. */
#ifndef REMODEL_RENDER_CHOOSE_PAIR_H
#define REMODEL_RENDER_CHOOSE_PAIR_H

#include "stages/render_model/room_camera.h"

/* Unstructured-lumigraph weights [Buehler 2001] of whole viewpoints: see choose_pair.c. Without a viewpoint that shows
 * anything of the picture both are -1. Shares change continuously as the camera moves. */
struct texture_pair choose_pair(const struct room *room, const struct room_camera *camera);

#endif
