/* blocks.h - blocks of space whose points err together.
 *
 * Neighbouring points come from the same segments of the same pictures. Standard errors are therefore not those of
 * independent points: a block's residuals count as one observation, however many points it has (the cluster-robust
 * "sandwich" of least squares). */
#ifndef REMODEL_BLOCKS_H
#define REMODEL_BLOCKS_H

#include "common/capture/point_cloud.h"

enum { BLOCKS_ACROSS = 12, BLOCKS = BLOCKS_ACROSS * BLOCKS_ACROSS * BLOCKS_ACROSS };

/* Median distance of points from the origin: the size of what was photographed. */
enum status cloud_size(double *size, const struct point_cloud *cloud, struct vec3 origin, struct err *err);
/* p: from the origin, in any fixed axes. What lies farther out belongs to the outermost block. */
int block_of(struct vec3 p, double size);

#endif
