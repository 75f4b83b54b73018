/* morph_params.h - the parameters of morph_views. */
#ifndef REMODEL_MORPH_PARAMS_H
#define REMODEL_MORPH_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define MORPH_PARAMS(X)                                                                                               \
    X(seconds, double, 4, 0, 3600, "s", "length of the film")                                                         \
    X(fps, double, 30, 1, 240, "1/s", "frames per second")                                                            \
    X(max_side, int, 1280, 64, 16384, "px", "maximum width and height of the film; smaller photos keep their size")   \
    X(ease, choice, "smooth", 0, 0, "none|smooth", "start and stop of the morph: smooth or at constant speed")        \
    X(search, double, 0.25, 0.01, 0.5, "",                                                                            \
      "search range: maximum motion of a point, relative to the film's longer side")                                  \
    X(epipolar, double, 0.35, 0, 10, "", "maximum cost of a match off its epipolar line; the data cost is at most 2") \
    X(epipolar_width, double, 3, 0.1, 1000, "px", "distance from the epipolar line at which its cost is truncated")   \
    X(min_matched, double, 0.1, 0, 1, "", "minimum fraction of pixels with a match; photos with less are not morphed")

struct morph_params {
    MORPH_PARAMS(PARAM_FIELD)
};
#define MORPH_PARAMS_DEFAULT        \
    {                               \
        MORPH_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param morph_param_table[];

/* Check for CLI_PARAMS. ST_USAGE: the film has fewer than two frames. */
enum status morph_params_check(const void *values, struct err *err);

#endif
