/* fuse_views.h - fuses the depth of all views into one volume of signed distances [Curless 1996]. */
#ifndef REMODEL_FUSE_VIEWS_H
#define REMODEL_FUSE_VIEWS_H

#include "common/capture/view.h"
#include "common/layers/layered_depth.h"
#include "common/model/thing_volume.h"
#include "common/texture/view_ids.h"

/* What the views say of each voxel. {0} is the empty state; everything is owned. */
struct fused_volume {
    struct voxel_grid grid;
    float *sum;     /* of weighted distances to the surface, in [-1, 1] of its band; above 0: before it */
    float *weight;  /* sum of weights, 0: no view knows the voxel */
    uint8_t *views; /* that show a surface of clutter within its band, at most 255 */
};

enum status fuse_volume_init(struct fused_volume *f, const struct voxel_grid *grid, struct err *err);
void fuse_volume_release(struct fused_volume *f);

/* A view as it is fused. */
struct fused_view {
    struct view camera;                /* model frame */
    const struct layered_depth *depth; /* scene units, like those of ids */
    const struct view_ids *ids;
    const bool *is_pane; /* of each id: the face is a pane of glass */
    int id_count;
    double scale; /* model units per scene unit */
};

/* Adds a view. ST_DATA: sizes differ. Same bits for any number of threads. */
enum status fuse_volume_add(struct fused_volume *f, const struct fused_view *view, struct err *err);

#endif
