/* components.h - the things of a fused volume: its connected surfaces, joined and split by what a user marked. */
#ifndef REMODEL_COMPONENTS_H
#define REMODEL_COMPONENTS_H

#include "common/model/thing_volume.h"
#include "stages/find_things/fuse_views.h"
#include "stages/find_things/things_params.h"

/* A place that a user marked as part of a thing. */
struct thing_seed {
    int name;   /* index of the thing's name */
    int64_t at; /* voxel; -1: no surface is there */
};

/* Sets id[voxel], one for each of the grid, to 1 + the number of the connected surface that it belongs to, largest
 * first; 0: of none. Surfaces shorter than min_size, or of fewer than min_voxels, are left out. height: of the model.
 * *count: of surfaces. */
enum status components_find(uint32_t *id, int *count, const struct fused_volume *f, const struct things_params *params,
                            double height, int views, struct err *err);

/* Joins surfaces that have seeds of one name, and splits those with seeds of several: each voxel goes to the seed that
 * is nearest along the surface. names: their number. named[k] gets the id of name k, 0 if no seed of it is on a
 * surface; the ids of all are counted anew, largest first. */
enum status components_mark(uint32_t *id, int *count, const struct voxel_grid *grid, const struct thing_seed *seeds,
                            int seed_count, uint32_t *named, int names, struct err *err);

/* Gives voxels within `steps` voxels of a surface, as a walk from voxel to voxel, its id. */
enum status components_grow(uint32_t *id, const struct voxel_grid *grid, int steps, struct err *err);

/* Gives what is below the lowest voxel of a thing, in each column of voxels, its id, as far down as no other thing is:
 * legs are too thin for depth. lowest: of each id, the slice down to which this goes; -1: not at all. */
void components_stand(uint32_t *id, const struct voxel_grid *grid, const int *lowest);

#endif
