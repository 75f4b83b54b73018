/* wall_raster.h - what the views show of a wall's plane: per cell, how bright it is and whether views see through it.
 *
 * Everything is in the model's frame. */
#ifndef REMODEL_WALL_RASTER_H
#define REMODEL_WALL_RASTER_H

#include <stdbool.h>
#include <stdint.h>

#include "common/capture/point_cloud.h"
#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "stages/suggest_model/wall_line.h"

/* Which cubes of space contain points. {0} is empty: no cube does. */
struct occupancy {
    unsigned char *cells; /* owned */
    int size[3];
    double low[3], edge;
};
enum status raster_occupancy_make(struct occupancy *o, const struct point_cloud *cloud, const double low[3],
                                  const double high[3], double edge, struct err *err);
void raster_occupancy_release(struct occupancy *o);

#define RASTER_MIN_WEIGHT 0.05 /* of a vote without confidence */

struct wall_cell {
    double on, beyond; /* votes of views whose depth is on the plane, or behind it; weighted by confidence */
    double mirrored;   /* the part of `beyond` whose mirror image in the plane is a point of the scene */
    double brightness; /* sum of log luminance, of `samples` views */
    int samples;
};
struct wall_raster {
    struct wall_line line; /* of the wall's face */
    double begin, cell, height;
    int across, up;
    struct wall_cell *cells; /* owned; across x up, a column's cells together */
};

/* A raster of the line's plane from S begin to end and from the floor to the height. The caller releases it. */
enum status wall_raster_init(struct wall_raster *r, const struct wall_line *line, double begin, double end,
                             double height, double cell, struct err *err);
void wall_raster_release(struct wall_raster *r);

/* Adds a view (in the model's frame) with its picture and its depth, which is in scene units: `scale` is the number of
 * model units per scene unit. Views behind the wall add nothing. */
void wall_raster_add(struct wall_raster *r, const struct view *view, const struct image *picture,
                     const struct layered_depth *depth, double scale, const struct occupancy *scene);

static inline struct wall_cell *wall_raster_at(const struct wall_raster *r, int x, int y)
{
    return &r->cells[(size_t)x * (size_t)r->up + (size_t)y];
}

#endif
