/* point_cloud.h - oriented points of a scene: out/SCENE/points/points.ply (docs/formats.md).
 *
 * Positions and normals are in world coordinates, positions in scene units; a normal has length 1 and points to the
 * side from which the surface was seen. */
#ifndef REMODEL_POINT_CLOUD_H
#define REMODEL_POINT_CLOUD_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

struct cloud_point {
    struct vec3 position;
    float normal[3];
    uint8_t color[3]; /* sRGB for display, clipped at white; the views have the radiance */
    uint16_t views;   /* number of views that agree, at least 1 */
    float confidence; /* 0 .. 1 */
};

struct point_cloud {
    struct cloud_point *points; /* owned */
    size_t count;
    double cell; /* cell size of the grid on which points were merged, in scene units; 0: not merged */
};

/* Writes a binary little-endian PLY file; equal clouds give equal bytes. prov may be NULL. ST_DATA: a point that
 * reading would reject. */
enum status point_cloud_write(const struct point_cloud *cloud, const char *path, const struct provenance *prov,
                              struct err *err);
/* Reads only files of point_cloud_write(). ST_DATA, with the line of the header or the point: other headers, a wrong
 * file size, values that are not finite, normals of another length, confidence outside 0 .. 1, no view. */
enum status point_cloud_read(struct point_cloud *cloud, const char *path, struct provenance *prov, struct err *err);
/* Keeps one point of every n, in their order, so that at most `most` remain (0: one). Returns n. */
size_t point_cloud_thin(struct point_cloud *cloud, size_t most);
void point_cloud_release(struct point_cloud *cloud);

static inline struct vec3 cloud_normal(const struct cloud_point *p)
{
    return vec3_make(p->normal[0], p->normal[1], p->normal[2]);
}
static inline void cloud_set_normal(struct cloud_point *p, struct vec3 n)
{
    p->normal[0] = (float)n.x;
    p->normal[1] = (float)n.y;
    p->normal[2] = (float)n.z;
}

#endif
