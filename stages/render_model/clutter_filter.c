/* clutter_filter.c - see clutter_filter.h. */
#include "stages/render_model/clutter_filter.h"

bool clutter_filter_is_needed(const struct clutter_filter *f)
{
    return f->only || f->volume || (f->map && f->map->zone_count);
}

bool clutter_filter_drops(const struct clutter_filter *f, struct vec3 p)
{
    const uint32_t id = f->volume ? thing_volume_at(f->volume, p) : 0;
    if (f->only) return id != f->only;
    if (id && f->fate[id] != THING_STAYS) return f->fate[id] == THING_IS_GONE;
    return f->map && f->map->zone_count && texture_map_clears(f->map, p);
}
