/* point_grid.h - points of many views merged on a grid of cubes in the world.
 *
 * Cell (i, j, k) is [i, i + 1) x [j, j + 1) x [k, k + 1) times the edge. Samples of one cell become one point if their normals
 * are within 60 degrees of the point's, so that the two sides of a thin thing, and the walls of a corner, stay apart. A
 * point is the mean of its samples, each weighing its confidence, taken in the order in which they were added. */
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
    size_t count, room;
    uint32_t *slots; /* cell + 1, 0 empty; a power of two */
    size_t slot_count;
};

enum status point_grid_init(struct point_grid *g, double edge, struct err *err); /* edge > 0 */
/* A sample farther than 2^52 cells from the origin is left out. */
enum status point_grid_add(struct point_grid *g, const struct fused_sample *s, struct err *err);
/* cloud: {0}; its points in the grid's order. */
enum status point_grid_points(struct point_cloud *cloud, const struct point_grid *g, struct err *err);
void point_grid_release(struct point_grid *g);

#endif
