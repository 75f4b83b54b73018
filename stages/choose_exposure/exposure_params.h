/* exposure_params.h - parameters of choose_exposure. */
#ifndef REMODEL_CHOOSE_EXPOSURE_PARAMS_H
#define REMODEL_CHOOSE_EXPOSURE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define EXPOSURE_PARAMS(X)                                                                                             \
    X(saturated, double, 0.03, 0, 1, "", "part of the pixels that a camera's own choice of exposure leaves saturated") \
    X(views, int, 200, 1, 1000000, "", "most views to look at, spread over the scene's list of views")

struct exposure_params {
    EXPOSURE_PARAMS(PARAM_FIELD)
};
#define EXPOSURE_PARAMS_DEFAULT        \
    {                                  \
        EXPOSURE_PARAMS(PARAM_DEFAULT) \
    }

#endif
