/* cluster_params.h - parameters of choose_views. */
#ifndef REMODEL_CLUSTER_PARAMS_H
#define REMODEL_CLUSTER_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define CLUSTER_PARAMS(X)                                                                                              \
    X(around, text, "auto", 0, 0, "",                                                                                  \
      "views that films are made from: all; auto, a cluster of them if the scene looks all round; or the cluster "     \
      "around the view of this name")                                                                                  \
    X(min_agreement, double, 0.5, 0, 1, "",                                                                            \
      "length of the mean of the viewing directions below which the scene looks all round: 1 for parallel views, 0 "   \
      "for views in all directions alike")                                                                             \
    X(max_angle, double, 45, 0, 180, "degrees", "largest angle between a view of a cluster and the view it is around") \
    X(min_shared, double, 0.25, 0, 1, "",                                                                              \
      "smallest fraction of sparse points, of the view that has fewer, that both see")                                 \
    X(full_angle, double, 10, 0.1, 90, "degrees", "angle between two rays to a point from which on it counts fully")

struct cluster_params {
    CLUSTER_PARAMS(PARAM_FIELD)
};
#define CLUSTER_PARAMS_DEFAULT        \
    {                                 \
        CLUSTER_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param cluster_param_table[];

#endif
