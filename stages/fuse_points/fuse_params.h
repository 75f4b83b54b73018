/* fuse_params.h - the parameters of fuse_points. */
#ifndef REMODEL_FUSE_PARAMS_H
#define REMODEL_FUSE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define FUSE_PARAMS(X)                                                                                                \
    X(views, int, 3, 1, 1000, "", "that must agree on a point, its own included; all of them if the scene has fewer") \
    X(tolerance, double, 0.5, 0.01, 100, "",                                                                          \
      "views agree if their depths differ by less, in uncertainties of the two")                                      \
    X(confident, double, 0.5, 0, 1, "", "segments of less confidence give no points and have no vote")                \
    X(seen_through, double, 0.25, 0, 1000, "",                                                                        \
      "votes of views that look through a point, as a part of those that agree, at most")                             \
    X(normal_window, int, 24, 0, 1000, "px",                                                                          \
      "half width of the window whose depths correct a point's normal; 0: segments' normals alone")                   \
    X(grid, double, 0.002, 1e-6, 1, "",                                                                               \
      "edge of a cell in which points are merged, as a part of the scene's median depth")                             \
    X(grid_size, double, 0, 0, 1e9, "scene units", "the same as a length; 0: grid says it")

struct fuse_params {
    FUSE_PARAMS(PARAM_FIELD)
};
#define FUSE_PARAMS_DEFAULT        \
    {                              \
        FUSE_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param fuse_param_table[];

#endif
