/* placed_thing.h - a thing at a place of its own. */
#ifndef REMODEL_PLACED_THING_H
#define REMODEL_PLACED_THING_H

#include <stdint.h>

#include "common/capture/view.h"

/* The point p of the photographs' room stands at turn p + shift. */
struct placed_thing {
    uint32_t id;
    char *name; /* of the thing or of its copy; owned */
    struct mat3 turn;
    struct vec3 shift;
};

/* Where a placed thing has the point p of the photographs' room, and the other way. */
struct vec3 placed_thing_place(const struct placed_thing *p, struct vec3 at);
struct vec3 placed_thing_origin(const struct placed_thing *p, struct vec3 at);
/* The camera that sees the thing where it was as `camera` sees it at its new place. */
struct view placed_thing_camera(const struct placed_thing *p, const struct view *camera);

#endif
