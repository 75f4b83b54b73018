/* fit_params.h - parameters of fit_response. */
#ifndef REMODEL_FIT_PARAMS_H
#define REMODEL_FIT_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define FIT_PARAMS(X)                                                                                           \
    X(response, choice, "auto", 0, 0, "auto|srgb|recover",                                                      \
      "response curve of bracketed photos: the sRGB curve, a curve recovered from the exposures, or auto: the " \
      "sRGB curve unless the exposures contradict it; ignored if the scene has a response.txt")                 \
    X(views, int, 8, 1, 1000, "", "number of bracketed views used for the fit, spread evenly over the list")    \
    X(max_patches, int, 3000, 50, 100000, "", "largest number of uniform patches sampled in each view")         \
    X(max_spread, double, 0.05, 0, 10, "",                                                                      \
      "largest relative variation of exposure ratios over the levels of light at which response = auto keeps "  \
      "the sRGB curve")

struct fit_params {
    FIT_PARAMS(PARAM_FIELD)
};
#define FIT_PARAMS_DEFAULT        \
    {                             \
        FIT_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param fit_param_table[];

#endif
