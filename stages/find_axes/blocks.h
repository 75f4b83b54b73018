/* blocks.h - blocks of space whose points have correlated errors.
 *
 * Neighbouring points come from the same segments of the same pictures, so their errors are not independent. For
 * standard errors a block's residuals count as one observation, however many points it has (the cluster-robust sandwich
 * estimator of least squares). */
#ifndef REMODEL_BLOCKS_H
#define REMODEL_BLOCKS_H

#include "common/capture/point_cloud.h"

enum { BLOCKS_ACROSS = 12, BLOCKS = BLOCKS_ACROSS * BLOCKS_ACROSS * BLOCKS_ACROSS };

/* The size of a scene: the median distance of its points from the origin. */
enum status block_cloud_size(double *size, const struct point_cloud *cloud, struct vec3 origin, struct err *err);
/* Index of the block of p, which is relative to the origin, in any fixed axes. Points farther out belong to the
 * outermost blocks. */
int block_of(struct vec3 p, double size);

#endif
