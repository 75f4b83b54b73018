/* find_params.h - parameters of find_subjects. */
#ifndef REMODEL_FIND_PARAMS_H
#define REMODEL_FIND_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define FIND_PARAMS(X)                                                                                             \
    X(max_views, int, 5, 1, 1000, "",                                                                              \
      "maximum number of views searched for faces, from the most central on, until one has some")                  \
    X(side, int, 1024, 64, 8192, "px", "longer side of the picture that faces are detected in")                    \
    X(min_face, double, 0.05, 0.01, 1, "", "minimum width of a face, relative to side")                            \
    X(confirm_views, int, 6, 0, 1000, "",                                                                          \
      "maximum number of other views in which a face is checked, those from the most similar directions first")    \
    X(max_angle, double, 30, 0.5, 90, "degrees",                                                                   \
      "maximum angle at the face between its view and a view that checks it")                                      \
    X(min_confirmed, double, 0.5, 0, 1, "",                                                                        \
      "minimum fraction of the checking views that detect the face at its place in space")                         \
    X(min_score, double, 30, 0, 1e6, "",                                                                           \
      "minimum score of a face: its overlapping detection windows, averaged over its view and the checking views") \
    X(min_lone_score, double, 50, 0, 1e6, "", "minimum score of a face that fewer than two other views can check")

struct find_params {
    FIND_PARAMS(PARAM_FIELD)
};
#define FIND_PARAMS_DEFAULT        \
    {                              \
        FIND_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param find_param_table[];

#endif
