/* clutter_filter.h - which clutter a picture shows: zones of an edit that are cleared, and things that it clears, keeps
 * or moves. */
#ifndef REMODEL_CLUTTER_FILTER_H
#define REMODEL_CLUTTER_FILTER_H

#include "common/relight/placed_things.h"

/* {0} lets all clutter pass. */
struct clutter_filter {
    const struct texture_map *map;     /* NULL: no zones */
    const struct thing_volume *volume; /* NULL: no things */
    const uint8_t *fate;               /* enum thing_fate of each id of the volume, from 0 */
    uint32_t only;                     /* the thing that alone passes; 0: all do */
    const uint8_t *gone;               /* of each pixel of the picture: nothing passes; NULL: of none */
};

/* What the photographs' own places show of the clutter. map: NULL: for one thing alone, which the caller sets. */
struct clutter_filter clutter_filter_of(const struct placed_things *t, const struct texture_map *map);
/* Whether anything can be dropped. */
bool clutter_filter_is_needed(const struct clutter_filter *f);
/* Whether clutter at a point of the unedited model's frame is left out. */
bool clutter_filter_drops(const struct clutter_filter *f, struct vec3 p);

#endif
