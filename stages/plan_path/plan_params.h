/* plan_params.h - the parameters of plan_path. */
#ifndef REMODEL_PLAN_PARAMS_H
#define REMODEL_PLAN_PARAMS_H

#include "common/base/param.h"

/* name, type, default, least, most, unit, help */
#define PLAN_PARAMS(X)                                                                                                 \
    X(seconds, double, 4, 0, 3600, "s", "length of the film")                                                          \
    X(fps, double, 30, 1, 240, "1/s", "frames a second")                                                               \
    X(ease, choice, "smooth", 0, 0, "none|smooth", "how a move starts and stops")                                      \
    X(width, int, 0, 0, 16384, "px", "of a film of keys, made even (sample_validity decides on moves); 0: by a photo") \
    X(height, int, 0, 0, 16384, "px", "of a film of keys, likewise")                                                   \
    X(max_side, int, 1280, 16, 16384, "px", "longest side of a film of keys where width and height are 0")             \
    X(max_angle, double, 25, 0.1, 180, "degrees", "between the ends of a move, seen from the scene's centroid")        \
    X(pairs, int, 12, 1, 20736, "", "longest pairs of ends whose parallax is measured")                                \
    X(refine, choice, "yes", 0, 0, "yes|no", "whether all pairs are, and ends then leave the grid")                    \
    X(parallax_side, int, 192, 16, 4096, "px", "longest side of the pictures in which parallax is measured")           \
    X(max_blur, double, 0.02, 0, 1, "", "widest circle of confusion, as a part of the film's longer side")             \
    X(saturate, double, 1.6, 0, 100, "", "what the subject's saturation changes to")                                   \
    X(desaturate, double, 0.1, 0, 1, "", "what the saturation of all but the subject changes to")                      \
    X(brighten, double, 1.5, 0, 100, "", "what the subject's brightness changes to")                                   \
    X(dim, double, 0.4, 0, 1, "", "what the brightness of all but the subject changes to")

struct plan_params {
    PLAN_PARAMS(PARAM_FIELD)
};
#define PLAN_PARAMS_DEFAULT        \
    {                              \
        PLAN_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param plan_param_table[];

/* CLI_PARAMS' check: ST_USAGE if the film has fewer than two frames. */
enum status plan_params_check(const void *values, struct err *err);

#endif
