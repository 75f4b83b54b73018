/* thing_hull.h - what a thing may fill: the places that it hides from all views. */
#ifndef REMODEL_THING_HULL_H
#define REMODEL_THING_HULL_H

#include "common/relight/placed_things.h"
#include "stages/render_model/clutter_scene.h"

/* Voxels of the volume, in the box of a thing. {0}: empty. */
struct thing_hull {
    struct voxel_grid grid; /* of the box */
    uint8_t *solid;         /* of each voxel; owned */
};

/* The views of the choice are loaded. Same bits for any number of threads. ST_NOMEM. */
enum status thing_hull_find(struct thing_hull *hull, const struct clutter_scene *scene,
                            const struct clutter_choice *choice, const struct thing_shape *thing, struct err *err);
void thing_hull_release(struct thing_hull *hull);

/* p: model frame. */
static inline bool thing_hull_at(const struct thing_hull *hull, struct vec3 p)
{
    const int64_t at = hull->solid ? thing_voxel_at(&hull->grid, p) : -1;
    return at >= 0 && hull->solid[at];
}

#endif
