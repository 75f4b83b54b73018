/* lines_params.h - parameters of find_lines. */
#ifndef REMODEL_LINES_PARAMS_H
#define REMODEL_LINES_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define LINES_PARAMS(X)                                                                                  \
    X(min_length, double, 0.03, 0.001, 1, "", "shortest line, as a part of the longer side of the view") \
    X(contrast, double, 4, 0, 100, "",                                                                   \
      "limit of local contrast, which shows edges of blank walls; 0: the picture as it is")

struct lines_params {
    LINES_PARAMS(PARAM_FIELD)
};
#define LINES_PARAMS_DEFAULT        \
    {                               \
        LINES_PARAMS(PARAM_DEFAULT) \
    }

#endif
