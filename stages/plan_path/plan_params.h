/* plan_params.h - parameters of plan_path. */
#ifndef REMODEL_PLAN_PARAMS_H
#define REMODEL_PLAN_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define PLAN_PARAMS(X)                                                                                                 \
    X(seconds, double, 4, 0, 3600, "s", "duration of a planned move")                                                  \
    X(fps, double, 30, 1, 240, "1/s", "frames per second")                                                             \
    X(ease, choice, "smooth", 0, 0, "none|smooth",                                                                     \
      "start and end of moves and keyframed shots: smooth, at rest; none, at speed")                                   \
    X(width, int, 0, 0, 16384, "px",                                                                                   \
      "width of a keyframed film, rounded to even (a move's is set in sample_validity); 0: from height or a photo")    \
    X(height, int, 0, 0, 16384, "px", "height of a keyframed film, rounded to even; 0: from width or a photo")         \
    X(max_side, int, 1280, 16, 16384, "px", "longer side of a keyframed film, at most, if width and height are 0")     \
    X(max_angle, double, 25, 0.1, 180, "degrees", "largest angle between the ends of a move, at the scene's centroid") \
    X(min_shown, double, 0.6, 0, 1, "",                                                                                \
      "least that both ends of an establishing dolly show, as a part of what the centremost view shows")               \
    X(pairs, int, 12, 1, 20736, "",                                                                                    \
      "longest pairs of ends that compete if refine is no; else used for the thesis's scores and as fallback")         \
    X(refine, choice, "yes", 0, 0, "yes|no", "measure all pairs of ends and then refine the best pair off the grid")   \
    X(parallax_side, int, 192, 16, 4096, "px", "longer side of the pictures in which parallax is measured")            \
    X(max_blur, double, 0.02, 0, 1, "",                                                                                \
      "largest circle of confusion, as a fraction of the frame's longer side; 0: no depth of field")                   \
    X(saturate, double, 1.6, 0, 100, "", "final saturation of the subject in saturate effects; 1: unchanged")          \
    X(desaturate, double, 0.1, 0, 1, "",                                                                               \
      "final saturation of everything but the subject in desaturate effects; 1: unchanged")                            \
    X(brighten, double, 1.5, 0, 100, "", "final brightness of the subject in brighten effects; 1: unchanged")          \
    X(dim, double, 0.4, 0, 1, "", "final brightness of everything but the subject in dim effects; 1: unchanged")

struct plan_params {
    PLAN_PARAMS(PARAM_FIELD)
};
#define PLAN_PARAMS_DEFAULT        \
    {                              \
        PLAN_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param plan_param_table[];

/* Check for CLI_PARAMS. ST_USAGE if the film would have fewer than two frames. */
enum status plan_params_check(const void *values, struct err *err);

#endif
