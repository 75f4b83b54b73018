/* validity_params.h - parameters of sample_validity. */
#ifndef REMODEL_VALIDITY_PARAMS_H
#define REMODEL_VALIDITY_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define VALIDITY_PARAMS(X)                                                                                         \
    X(width, int, 0, 0, 16384, "px", "width of the film, rounded to even; 0: from height or the centremost view")  \
    X(height, int, 0, 0, 16384, "px", "height of the film, rounded to even; 0: from width or the centremost view") \
    X(max_side, int, 1280, 16, 16384, "px", "longer side of the film, at most, if width and height are 0")         \
    X(max_h, double, 2, 0, 1e6, "", "hole measure H below which a viewpoint is valid")                             \
    X(max_outside, double, 0.03, 0, 1, "",                                                                         \
      "largest fraction of a frame beyond the borders of the views blended there")                                 \
    X(max_zoom, double, 1.5, 1, 4, "", "longest focal length f of the film, as a multiple of the views' mean")     \
    X(grid, int, 12, 1, 64, "", "columns and rows of the grid of cells across the views")                          \
    X(extent, double, 2, 0.1, 10, "", "size of the grid, in sizes of the bounding box of the views' centres")      \
    X(check_side, int, 480, 16, 4096, "px", "longer side of the pictures in which holes are measured")             \
    X(tolerance, double, 0.005, 1e-5, 1, "",                                                                       \
      "resolution of the z limits of a cell, as a fraction of the median depth")                                   \
    X(check_cells, int, 6, 0, 4096, "", "number of cells sampled again in full pictures, to report the error; 0: none")

struct validity_params {
    VALIDITY_PARAMS(PARAM_FIELD)
};
#define VALIDITY_PARAMS_DEFAULT        \
    {                                  \
        VALIDITY_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param validity_param_table[];

#endif
