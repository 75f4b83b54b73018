/* fuse_params.h - parameters of fuse_points. */
#ifndef REMODEL_FUSE_PARAMS_H
#define REMODEL_FUSE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define FUSE_PARAMS(X)                                                                                              \
    X(min_views, int, 3, 1, 1000, "",                                                                               \
      "minimum number of views that agree on a point, its own included; all if the scene has fewer")                \
    X(tolerance, double, 0.5, 0.01, 100, "",                                                                        \
      "maximum depth difference between views that agree, in standard deviations of the difference")                \
    X(min_confidence, double, 0.5, 0, 1, "", "minimum confidence of a segment; others give no points and no votes") \
    X(max_seen_through, double, 0.25, 0, 1000, "",                                                                  \
      "maximum confidence of the views that see through a point, relative to the views that agree on it")           \
    X(normal_window, int, 24, 0, 1000, "px",                                                                        \
      "half width of the window of depths that corrects a point's normal; 0: normals of segments alone")            \
    X(grid, double, 0.002, 1e-6, 1, "",                                                                             \
      "edge of the grid's cells that points are merged in, relative to the scene's median depth")                   \
    X(grid_size, double, 0, 0, 1e9, "scene units", "edge of the grid's cells as a length; 0: from grid")

struct fuse_params {
    FUSE_PARAMS(PARAM_FIELD)
};
#define FUSE_PARAMS_DEFAULT        \
    {                              \
        FUSE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param fuse_param_table[];

#endif
