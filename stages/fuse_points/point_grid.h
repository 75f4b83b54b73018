/* point_grid.h - points of many views merged in a grid of cubes.
 *
 * Cell (i, j, k) is [i, i + 1) x [j, j + 1) x [k, k + 1) times the edge. A sample joins a point of its cell if its
 * normal is within 60 degrees of the point's, so that the two sides of a thin object, and the walls at a corner, stay
 * apart. A point is the mean of its samples weighted by confidence, summed in the order in which they were added. */
#ifndef REMODEL_POINT_GRID_H
#define REMODEL_POINT_GRID_H

#include "common/capture/point_cloud.h"

struct fused_sample {
    struct vec3 position, normal; /* the normal of length 1 */
    float color[3];               /* linear */
    float confidence;             /* 0 .. 1 */
    int views;
};

struct grid_cell;
struct point_grid {
    double edge;
    struct grid_cell *cells; /* in order of their first sample */
    size_t count, capacity;
    uint32_t *slots; /* cell + 1, 0 empty; a power of two */
    size_t slot_count;
};

enum status point_grid_init(struct point_grid *g, double edge, struct err *err); /* edge > 0 */
/* Adds a sample; ignores it if it is farther than 2^52 cells from the origin. */
enum status point_grid_add(struct point_grid *g, const struct fused_sample *s, struct err *err);
/* Writes the merged points, in order of their first samples, to cloud, which is {0} on entry. */
enum status point_grid_points(struct point_cloud *cloud, const struct point_grid *g, struct err *err);
void point_grid_release(struct point_grid *g);

#endif
