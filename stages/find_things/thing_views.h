/* thing_views.h - which pixels of a view show which thing, and which view shows each thing best. */
#ifndef REMODEL_THING_VIEWS_H
#define REMODEL_THING_VIEWS_H

#include "common/capture/camera_set.h"
#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "common/model/thing_list.h"
#include "common/model/thing_mask.h"
#include "common/model/thing_volume.h"
#include "common/texture/view_ids.h"

/* Sets mask[pixel] to the id of the thing that the view shows there, 0: none. camera: model frame; scale: model units
 * per scene unit. A segment of the depth map of which half the pixels show a thing shows it whole: segments end at
 * edges of colour, and depth has holes. ST_NOMEM. */
enum status thing_shows_find(uint32_t *mask, const struct thing_volume *volume, const struct view *camera,
                             const struct layered_depth *depth, const struct view_ids *ids, double scale,
                             struct err *err);
/* Voxels of the things' surfaces. */
struct surface_voxel {
    struct vec3 at; /* its centre, model frame */
    uint32_t id;
};

/* Sets meets[pixel] to the thing whose surface the ray of the pixel meets first, more than a voxel before the model; 0:
 * none. Where the view's own depth is wrong or missing, the other views tell what is there. Voxels are drawn as the
 * squares that hold them, so surfaces have no holes. */
void thing_meets_find(uint32_t *meets, const struct surface_voxel *voxels, size_t count, double voxel,
                      const struct view *camera, const struct view_ids *ids, double scale, float *nearest);

/* What the views show of a thing. {0} is the state before the first view. */
struct thing_sight {
    int views;                                      /* that show enough of it */
    int best;                                       /* index of the view that shows it best */
    double score;                                   /* of that view */
    double sum[3];                                  /* of the radiance of its pixels */
    int64_t pixels;                                 /* whose radiance is in the sum */
    double side_sum[THING_SIDES][3];                /* the same of each side, weighted by how a pixel faces */
    double side_weights[THING_SIDES * THING_SIDES]; /* sums of products of these weights */
    int low[2], high[2];                            /* px: its rectangle there */
};

/* What tells which way the surface of a pixel faces. */
struct thing_geometry {
    const struct thing_volume *volume;
    const struct view *camera; /* model frame */
    const float *z;            /* depth of each pixel, scene units */
    double scale;              /* model units per scene unit */
};
/* Adds the radiance of a view's pixels to the sights. photo: of the view. geometry: NULL: sides stay as they are. */
void thing_sights_add_radiance(struct thing_sight *sights, const uint32_t *mask, const struct image *photo,
                               const struct thing_geometry *geometry);
/* Sets the mean radiance of a thing, and that of its sides that explains its pixels best; a side that few of them show
 * is near the mean. */
void thing_sight_radiance(struct thing *t, const struct thing_sight *s);
/* Adds a view's mask to the sights, one for each of `count` things. ST_NOMEM. */
enum status thing_sights_add(struct thing_sight *sights, int count, const uint32_t *mask, const struct view *view,
                             int view_index, struct err *err);

#endif
