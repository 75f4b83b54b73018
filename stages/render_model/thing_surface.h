/* thing_surface.h - the fused surface of a thing, where the views' own layers do not show it. */
#ifndef REMODEL_THING_SURFACE_H
#define REMODEL_THING_SURFACE_H

#include "common/relight/placed_things.h"
#include "stages/render_model/clutter_scene.h"

struct thing_rows {
    size_t first, last; /* of a picture; last is not one of them */
};

/* Draws the surface of a thing under what a layer has of it: every pixel whose ray meets the surface becomes covered,
 * at the rim of what lies flat in part; *rows: no others were. shell: as of clutter_blend(). camera: scene frame; the
 * views of the choice are loaded. Same bits for any number of threads. */
enum status thing_surface_draw(struct thing_rows *rows, struct clutter_layer *layer, const float *shell,
                               const struct clutter_scene *scene, const struct clutter_choice *choice,
                               const struct view *camera, const struct thing_shape *thing, struct err *err);

#endif
