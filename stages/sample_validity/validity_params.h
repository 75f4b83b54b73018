/* validity_params.h - the parameters of sample_validity. */
#ifndef REMODEL_VALIDITY_PARAMS_H
#define REMODEL_VALIDITY_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define VALIDITY_PARAMS(X)                                                                                            \
    X(width, int, 0, 0, 16384, "px", "of the film, made even; 0: by the centremost view's shape")                     \
    X(height, int, 0, 0, 16384, "px", "of the film, made even; 0: by the centremost view's shape")                    \
    X(max_side, int, 1280, 16, 16384, "px", "longest side of the film where width and height are 0")                  \
    X(max_h, double, 2, 0, 1e6, "", "a viewpoint is valid below this H, the thesis' measure of holes")                \
    X(max_outside, double, 0.03, 0, 1, "", "part of a frame beyond the borders of the views that it blends, at most") \
    X(max_zoom, double, 1.5, 1, 4, "", "longest focal length f of a film, as a multiple of the views' mean")          \
    X(grid, int, 12, 1, 64, "", "columns and rows of places across the views")                                        \
    X(extent, double, 2, 0.1, 10, "", "how far the grid reaches, in sizes of the box of the views' centres")          \
    X(check_side, int, 480, 16, 4096, "px", "longest side of the pictures in which holes are looked for")             \
    X(tolerance, double, 0.005, 1e-5, 1, "", "how exactly the region's z is found, as a part of the median depth")    \
    X(check_cells, int, 6, 0, 4096, "", "places whose z is found again in full pictures, to tell the error")

struct validity_params {
    VALIDITY_PARAMS(PARAM_FIELD)
};
#define VALIDITY_PARAMS_DEFAULT        \
    {                                  \
        VALIDITY_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param validity_param_table[];

#endif
