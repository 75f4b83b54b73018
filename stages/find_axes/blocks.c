/* blocks.c - blocks of space, and the size of a scene. */
#include "stages/find_axes/blocks.h"

#include <stdlib.h>

#include "common/base/sort.h"

static const double EDGE = 0.33; /* of a block, in scene sizes: 12 blocks cover four scene sizes */

enum status block_cloud_size(double *size, const struct point_cloud *cloud, struct vec3 origin, struct err *err)
{
    enum { MAX_SAMPLES = 20000 }; /* of evenly spaced points */
    const size_t step = cloud->count / MAX_SAMPLES + 1;
    double *d = malloc((cloud->count / step + 1) * sizeof *d);
    size_t count = 0;
    if (!d) return err_nomem(err, "distances", (cloud->count / step + 1) * sizeof *d);
    for (size_t i = 0; i < cloud->count; i += step)
        d[count++] = vec3_length(vec3_sub(cloud->points[i].position, origin));
    sort_doubles(d, count);
    *size = count ? d[count / 2] : 0;
    free(d);
    return ST_OK;
}

int block_of(struct vec3 p, double size)
{
    const double c[3] = {p.x, p.y, p.z};
    int at = 0;
    for (int k = 0; k < 3; k++) {
        const double b = floor(c[k] / (EDGE * size)) + BLOCKS_ACROSS / 2;
        at = at * BLOCKS_ACROSS + (b >= 0 ? b < BLOCKS_ACROSS ? (int)b : BLOCKS_ACROSS - 1 : 0);
    }
    return at;
}
