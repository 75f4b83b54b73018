/* things_params.h - parameters of find_things. */
#ifndef REMODEL_THINGS_PARAMS_H
#define REMODEL_THINGS_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define THINGS_PARAMS(X)                                                                                     \
    X(voxel, double, 0.01, 0.001, 0.1, "", "edge of a voxel, relative to the height of the model")           \
    X(max_voxels, int, 100, 1, 268, "millions", "maximum number of voxels; larger houses get larger voxels") \
    X(min_views, int, 2, 1, 100, "", "minimum number of views that show a surface of a thing at a voxel")    \
    X(min_weight, double, 0.8, 0, 100, "", "minimum sum of the confidence of these views")                   \
    X(min_size, double, 0.1, 0, 10, "",                                                                      \
      "minimum length of a thing, corner to corner, relative to the height of the model")                    \
    X(min_voxels, int, 100, 1, 1000000, "", "minimum number of voxels of a thing's surface")                 \
    X(margin, double, 0.02, 0, 1, "",                                                                        \
      "maximum distance of what belongs to a thing from its surface, relative to the height of the model")

struct things_params {
    THINGS_PARAMS(PARAM_FIELD)
};
#define THINGS_PARAMS_DEFAULT        \
    {                                \
        THINGS_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param things_param_table[];

#endif
