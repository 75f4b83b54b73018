/* fit_params.h - the stage's parameters. */
#ifndef REMODEL_FIT_PARAMS_H
#define REMODEL_FIT_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define FIT_PARAMS(X)                                                                                                 \
    X(response, choice, "auto", 0, 0, "auto|srgb|recover",                                                            \
      "how samples of bracketed photos follow light; auto: by the sRGB curve, unless their exposures say otherwise; " \
      "a scene's response.txt wins over all of them")                                                                 \
    X(views, int, 8, 1, 1000, "", "that are looked at, spread over the list")                                         \
    X(places, int, 3000, 50, 100000, "", "of each view at most, where it is even")                                    \
    X(most_spread, double, 0.05, 0, 10, "",                                                                           \
      "by how much, relatively, the ratio of two exposures may vary with the level of light before the sRGB curve "   \
      "is given up")

struct fit_params {
    FIT_PARAMS(PARAM_FIELD)
};
#define FIT_PARAMS_DEFAULT        \
    {                             \
        FIT_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param fit_param_table[];

#endif
