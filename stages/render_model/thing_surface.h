/* thing_surface.h - the fused surface of a thing, where the views' own layers do not show it. */
#ifndef REMODEL_THING_SURFACE_H
#define REMODEL_THING_SURFACE_H

#include "common/model/thing_volume.h"
#include "stages/render_model/clutter_scene.h"

struct thing_rows {
    size_t first, last; /* of a picture; last is not one of them */
};

/* Draws the surface of the thing `id` under what a layer has of it: every pixel whose ray meets the surface becomes
 * covered; *rows: no others were. points: of that thing. shell: as of clutter_blend(). camera: scene frame; the views
 * of the choice are loaded. Same bits for any number of threads. */
void thing_surface_draw(struct thing_rows *rows, struct clutter_layer *layer, const float *shell,
                        const struct clutter_scene *scene, const struct clutter_choice *choice,
                        const struct view *camera, const struct thing_volume *volume, uint32_t id,
                        const struct thing_points *points);

#endif
