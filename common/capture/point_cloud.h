/* point_cloud.h - oriented points of a scene: out/SCENE/points/points.ply (docs/formats.md).
 *
 * Positions and normals are in the world's axes, positions in scene units; a normal has length 1 and points to where the
 * surface was seen from. */
#ifndef REMODEL_POINT_CLOUD_H
#define REMODEL_POINT_CLOUD_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

struct cloud_point {
    struct vec3 position;
    float normal[3];
    uint8_t color[3]; /* sRGB: to look at, cut at white; the views have the radiance */
    uint16_t views;   /* that agree, at least 1 */
    float confidence; /* 0 .. 1 */
};

struct point_cloud {
    struct cloud_point *points; /* owned */
    size_t count;
    double cell; /* edge of the grid on which points were merged, in scene units; 0: they were not */
};

/* Binary little-endian PLY; the same bytes for the same cloud. prov may be NULL. ST_DATA: a value that reading would refuse. */
enum status point_cloud_write(const struct point_cloud *cloud, const char *path, const struct provenance *prov,
                              struct err *err);
/* Only what point_cloud_write() writes. ST_DATA names the header's line or the point where a file is something else: cut, longer
 * than it says, values not finite, normals whose length is not 1, confidence outside 0 .. 1, no view. */
enum status point_cloud_read(struct point_cloud *cloud, const char *path, struct err *err);
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
