/* thing_volume.h - which thing each place of the rooms belongs to: out/SCENE/things/volume.exr.
 *
 * A grid of cubes (voxels) in the model's frame. Voxel (x, y, z) reaches from origin + voxel (x, y, z) to the next one;
 * its values are at [(z * size[1] + y) * size[0] + x]: id: 0: no thing; else its number in things.txt, from 1;
 * distance: of its centre from the surface that the views show, above 0 before it and below 0 behind it, in [-1, 1] of
 * a band that is a few voxels wide, and THING_UNSEEN where no view says anything, and behind the model's own
 * surfaces. The file holds the slices one below the other: channels id (uint) and distance (half), size[0] columns,
 * size[1] size[2] rows. */
#ifndef REMODEL_THING_VOLUME_H
#define REMODEL_THING_VOLUME_H

#include <stdint.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

struct voxel_grid {
    struct vec3 origin; /* model units */
    double voxel;       /* edge of a voxel, model units */
    int size[3];
};

#define THING_UNSEEN 2.0f

/* {0} is the empty state. */
struct thing_volume {
    struct voxel_grid grid;
    uint32_t *id;    /* owned */
    float *distance; /* owned */
};

static inline size_t voxel_count(const struct voxel_grid *g)
{
    return (size_t)g->size[0] * (size_t)g->size[1] * (size_t)g->size[2];
}
/* Index of the voxel that holds a point; -1: it is outside of the grid. */
int64_t thing_voxel_at(const struct voxel_grid *g, struct vec3 p);
struct vec3 thing_voxel_centre(const struct voxel_grid *g, int64_t at);

/* The thing at a point of the model's frame; 0: none. */
static inline uint32_t thing_volume_at(const struct thing_volume *v, struct vec3 p)
{
    const int64_t at = v->id ? thing_voxel_at(&v->grid, p) : -1;
    return at < 0 ? 0 : v->id[at];
}

/* The distance at a point from the surface of a thing, trilinear; THING_UNSEEN: a voxel around it is of another thing,
 * of none, or unseen. */
float thing_volume_distance(const struct thing_volume *v, uint32_t id, struct vec3 p);
/* The direction away from that surface, of length 1; 0: it is not known. */
struct vec3 thing_volume_normal(const struct thing_volume *v, uint32_t id, struct vec3 p);

enum status thing_volume_write(const struct thing_volume *v, const char *path, const struct provenance *prov,
                               struct err *err);
/* ST_DATA: the size of the picture is not that of its grid; an id above max_id; a distance out of range. A failure
 * leaves v empty. */
enum status thing_volume_read(struct thing_volume *v, const char *path, uint32_t max_id, struct provenance *prov,
                              struct err *err);
void thing_volume_release(struct thing_volume *v);

#endif
