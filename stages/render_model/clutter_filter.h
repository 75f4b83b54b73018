/* clutter_filter.h - which clutter a picture shows: zones of an edit that are cleared, and things that it clears, keeps
 * or moves. */
#ifndef REMODEL_CLUTTER_FILTER_H
#define REMODEL_CLUTTER_FILTER_H

#include "common/model/thing_volume.h"
#include "common/texture/texture_map.h"

enum thing_fate { THING_STAYS, THING_IS_KEPT, THING_IS_GONE }; /* kept: also in a zone that is cleared */

/* Places on the surface of a thing, spread over it. */
enum { THING_POINTS = 64 };
struct thing_points {
    struct vec3 at[THING_POINTS]; /* model frame */
    int count;
};

/* {0} lets all clutter pass. */
struct clutter_filter {
    const struct texture_map *map;     /* NULL: no zones */
    const struct thing_volume *volume; /* NULL: no things */
    const uint8_t *fate;               /* enum thing_fate of each id of the volume, from 0 */
    uint32_t only;                     /* the thing that alone passes; 0: all do */
    const uint8_t *gone;               /* of each pixel of the picture: nothing passes; NULL: of none */
};

/* Whether anything can be dropped. */
bool clutter_filter_is_needed(const struct clutter_filter *f);
/* Whether clutter at a point of the unedited model's frame is left out. */
bool clutter_filter_drops(const struct clutter_filter *f, struct vec3 p);

#endif
