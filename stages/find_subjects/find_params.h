/* find_params.h - the parameters of find_subjects. */
#ifndef REMODEL_FIND_PARAMS_H
#define REMODEL_FIND_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define FIND_PARAMS(X)                                                                                        \
    X(views, int, 5, 1, 1000, "", "from the centremost on, in which faces are looked for until one has some") \
    X(side, int, 1024, 64, 8192, "px", "longest side of the picture in which faces are looked for")           \
    X(least_face, double, 0.05, 0.01, 1, "", "width of a face, at least, as a part of that side")             \
    X(asked, int, 6, 0, 1000, "",                                                                             \
      "other views, those that look most alike first, in which a face is looked for again")                   \
    X(max_angle, double, 30, 0.5, 90, "degrees", "seen from the face, within which other views are asked")    \
    X(confirm, double, 0.5, 0, 1, "", "part of the asked views that must see a face at its place in space")   \
    X(least_score, double, 30, 0, 1e6, "",                                                                    \
      "overlapping windows that take it for a face, the mean of these views, at least")                       \
    X(lone_score, double, 50, 0, 1e6, "", "the same where fewer than two other views can be asked")

struct find_params {
    FIND_PARAMS(PARAM_FIELD)
};
#define FIND_PARAMS_DEFAULT        \
    {                              \
        FIND_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param find_param_table[];

#endif
