/* clutter_filter.c - see clutter_filter.h. */
#include "stages/render_model/clutter_filter.h"

/* Of the height. Clutter above it that belongs to no thing is part of a lamp: the depth of lamps is never sure. */
#define CEILING 0.85

struct clutter_filter clutter_filter_of(const struct placed_things *t, const struct texture_map *map)
{
    bool matters = !map || map->zone_count; /* the volume tells where a zone ends below the ceiling */
    for (int i = 0; t->fate && i <= t->list.count; i++) matters |= t->fate[i] != THING_STAYS;
    return (struct clutter_filter){.map = map, .volume = t->fate && matters ? &t->volume : NULL, .fate = t->fate};
}

bool clutter_filter_is_needed(const struct clutter_filter *f)
{
    return f->only || f->volume || (f->map && f->map->zone_count);
}

bool clutter_filter_drops(const struct clutter_filter *f, struct vec3 p)
{
    const uint32_t id = f->volume ? thing_volume_at(f->volume, p) : 0;
    if (f->only) return id != f->only;
    if (id && f->fate[id] != THING_STAYS) return f->fate[id] == THING_IS_GONE;
    if (!f->map || !f->map->zone_count) return false;
    if (f->volume && p.z > f->volume->grid.origin.z + CEILING * f->volume->grid.voxel * f->volume->grid.size[2])
        return false;
    return texture_map_clears(f->map, p);
}
