/* placed_things.h - the things of an edit: which are gone from the photographs, and which stand elsewhere. */
#ifndef REMODEL_PLACED_THINGS_H
#define REMODEL_PLACED_THINGS_H

#include "common/light/model_rays.h"
#include "common/model/thing_list.h"
#include "common/model/thing_volume.h"
#include "common/relight/placed_thing.h"
#include "common/texture/texture_map.h"

enum thing_fate { THING_STAYS, THING_IS_KEPT, THING_IS_GONE }; /* kept: also in a zone that is cleared */

/* Places on the surface of a thing, spread over it, and the box around its voxels. Model frame. */
enum { THING_POINTS = 64 };
struct thing_points {
    struct vec3 at[THING_POINTS];
    int count;
    struct vec3 low, high; /* through the centres of its outer voxels; of what lies flat also through the corners of its
                            * outline; low.x > high.x: it has none */
};

/* {0} is the empty state: all clutter stays. Everything is owned. */
struct placed_things {
    struct thing_list list;
    struct thing_volume volume;
    uint8_t *fate; /* enum thing_fate of each id, from 0 */
    struct placed_thing *placed;
    int placed_count;
    struct thing_points *points; /* of each id, from 0: some of its surface */
};

/* Reads the products of find_things, and places the things of which an edit's map says something. folder: of the
 * things; NULL: zones clear no things, and none are known. map: NULL: all things stay. before, after: the model that
 * the photographs show, and the edited one. ST_DATA: the map names a thing that was not found; a thing would be in a
 * wall or in another thing, or off what it stands on, with the distance. Such errors name the script and the line of
 * the statement. */
enum status placed_things_read(struct placed_things *t, const char *folder, const struct texture_map *map,
                               const struct model_rays *before, const struct model_rays *after, struct provenance *prov,
                               struct err *err);
void placed_things_release(struct placed_things *t);

/* Where a thing is in the photographs' room, and what it is drawn from. */
struct thing_shape {
    uint32_t id;
    const struct thing_volume *volume;
    const struct thing_points *points;
    const struct flat_outline *outline; /* of what lies flat: exact, where voxels are coarse; empty: of other things */
};
struct thing_shape placed_things_shape(const struct placed_things *t, uint32_t id);
/* The outline of a thing that lies flat; NULL: it does not. */
const struct flat_outline *placed_things_outline(const struct placed_things *t, uint32_t id);
/* The thing that lies flat at a point of the photographs' room, within half a voxel of its face; 0: none of that
 * fate. */
uint32_t placed_things_flat_at(const struct placed_things *t, struct vec3 p, enum thing_fate fate);

/* Whether a placed thing has a point of the photographs' room. */
bool placed_thing_holds(const struct placed_things *t, const struct placed_thing *p, struct vec3 was);

#endif
