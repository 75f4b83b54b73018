/* pan_params.h - the parameters of pan_scan. */
#ifndef REMODEL_PAN_PARAMS_H
#define REMODEL_PAN_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define PAN_PARAMS(X)                                                                                                  \
    X(view, text, "", 0, 0, "", "whose photograph is shown; empty: the view nearest to the middle camera of the path") \
    X(tolerance, double, 0.01, 0.0001, 10, "",                                                                         \
      "points that a crop misses by more than this part of the frame's longer side weigh less")

struct pan_params {
    PAN_PARAMS(PARAM_FIELD)
};
#define PAN_PARAMS_DEFAULT        \
    {                             \
        PAN_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param pan_param_table[];

#endif
