/* pan_params.h - parameters of pan_scan. */
#ifndef REMODEL_PAN_PARAMS_H
#define REMODEL_PAN_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define PAN_PARAMS(X)                                                                                                  \
    X(view, text, "", 0, 0, "", "view whose photograph is shown; empty: the nearest to the middle camera of the path") \
    X(tolerance, double, 0.01, 0.0001, 10, "",                                                                         \
      "error of a point beyond which it weighs less in fitting a crop, as a fraction of the frame's longer side")

struct pan_params {
    PAN_PARAMS(PARAM_FIELD)
};
#define PAN_PARAMS_DEFAULT        \
    {                             \
        PAN_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param pan_param_table[];

#endif
