/* frame_params.h - parameters of find_frame. */
#ifndef REMODEL_FRAME_PARAMS_H
#define REMODEL_FRAME_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define FRAME_PARAMS(X)                                                                                         \
    X(min_lines, int, 40, 3, 1000000, "", "minimum number of lines in all views")                               \
    X(min_up, double, 0.045, 0, 1, "", "minimum length of upright lines, as a part of the length of all lines") \
    X(min_pair, double, 0.09, 0, 1, "",                                                                         \
      "minimum length of lines along two perpendicular headings, as a part of the length of all lines")         \
    X(min_one, double, 0.03, 0, 1, "",                                                                          \
      "minimum length of lines along each of the two, as a part of the length of all lines")                    \
    X(min_heading, double, 0.04, 0, 1, "",                                                                      \
      "minimum length of lines along a further heading, as a part of the length of all lines")

struct frame_params {
    FRAME_PARAMS(PARAM_FIELD)
};
#define FRAME_PARAMS_DEFAULT        \
    {                               \
        FRAME_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param frame_param_table[];

#endif
