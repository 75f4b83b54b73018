/* validity.h - regions of valid viewpoints, one for each end of a move; out/SCENE/parallax/EFFECT/validity.txt, written
 * by sample_validity and read by plan_path.
 *
 *   remodel-validity 1
 *   effect EFFECT
 *   film W H FOCAL CX CY             FOCAL: f, in px
 *   zoom Z                           f is the views' mean focal length times Z
 *   near_limit D median_depth D
 *   up X Y Z  and  origin, axis_x, axis_y, axis_z, centroid
 *   box LOW_X LOW_Y HIGH_X HIGH_Y    bounding box of the views' centres in the frame of origin and axes
 *   limits H OUTSIDE SIDE            of a valid viewpoint (struct viewpoint_limits)
 *   step S                           resolution of the cells' z
 *   on_axis 0|1                      1: the ends lie on the z axis, and each region is one cell
 *   end target X Y Z focal F         one of these three forms, for the start and then for the end
 *   end target X Y Z focal F most S X Y Z X Y Z X Y Z X Y Z    a quadrilateral that is shown at most S px high
 *   end target X Y Z size S X Y Z X Y Z X Y Z X Y Z     a quadrilateral that keeps its size
 *   region C R                       after each end, followed by C x R cells in row-major order
 *   cell X Y none
 *   cell X Y from LOW_Z to HIGH_Z    z points towards the scene */
#ifndef REMODEL_VALIDITY_H
#define REMODEL_VALIDITY_H

#include "common/base/provenance.h"
#include "common/film/shot.h"
#include "common/film/viewpoint.h"

struct validity_cell {
    double x, y;
    bool valid;       /* z = 0 is valid */
    double low, high; /* range of valid z, scene units; low <= 0 <= high where sampled */
};

struct validity_region {
    int columns, rows;
    struct validity_cell *cells; /* owned */
};

struct validity {
    struct film_effect effect;
    struct shot_setup shot;
    struct shot_move move;
    double zoom; /* f in units of the views' mean focal length */
    double step; /* resolution of the cells' z, scene units */
    struct viewpoint_limits limits;
    struct validity_region region[2]; /* start, end */
};

enum status validity_region_init(struct validity_region *r, int columns, int rows, struct err *err);
int validity_region_count(const struct validity_region *r); /* number of valid cells */
/* Bilinear interpolation between cells: returns the weight of the valid ones about (x, y), from 0 to 1 where all are;
 * low and high get the sums of their weighted ranges of z. */
double validity_region_at(const struct validity_region *r, double x, double y, double *low, double *high);

/* ST_DATA with file, line, what was found and what was expected; on failure v is left empty. */
enum status validity_read(struct validity *v, const char *path, struct provenance *prov, struct err *err);
enum status validity_write(const struct validity *v, const char *path, const struct provenance *prov, struct err *err);
void validity_release(struct validity *v);

#endif
