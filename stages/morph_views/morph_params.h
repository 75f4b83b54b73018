/* morph_params.h - the parameters of morph_views. */
#ifndef REMODEL_MORPH_PARAMS_H
#define REMODEL_MORPH_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define MORPH_PARAMS(X)                                                                                              \
    X(seconds, double, 4, 0, 3600, "s", "length of the film")                                                        \
    X(fps, double, 30, 1, 240, "1/s", "frames a second")                                                             \
    X(max_side, int, 1280, 64, 16384, "px", "longest side of the film; smaller photos keep their size")              \
    X(ease, choice, "smooth", 0, 0, "none|smooth", "how the morph starts and stops")                                 \
    X(search, double, 0.25, 0.01, 0.5, "", "farthest that a point moves, as a part of the film's longest side")      \
    X(epipolar, double, 0.35, 0, 10, "", "cost of a match off its epipolar line; the worst look of a match costs 2") \
    X(epipolar_width, double, 3, 0.1, 1000, "px", "distance from the line from which that cost grows no more")       \
    X(min_matched, double, 0.1, 0, 1, "", "part of the pixels that must match for two photos to be morphed")

struct morph_params {
    MORPH_PARAMS(PARAM_FIELD)
};
#define MORPH_PARAMS_DEFAULT        \
    {                               \
        MORPH_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param morph_param_table[];

/* CLI_PARAMS' check: ST_USAGE if the film has fewer than two frames. */
enum status morph_params_check(const void *values, struct err *err);

#endif
