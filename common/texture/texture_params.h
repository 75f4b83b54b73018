/* texture_params.h - what both bakes decide texels by. A stage lists these parameters before its own. */
#ifndef REMODEL_TEXTURE_PARAMS_H
#define REMODEL_TEXTURE_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define TEXTURE_PARAMS(X)                                                                                              \
    X(max_sources, int, 32, 1, 250, "views", "maximum number of views that are read as sources of texels at a time")   \
    X(edge, double, 5, 0, 30, "px", "distance from a jump of the model's depth within which a view shows no texel")    \
    X(max_slant, double, 80, 10, 89.9, "degrees",                                                                      \
      "maximum angle between the ray of a source and the surface's normal")                                            \
    X(max_noise, double, 0.25, 0, 1, "", "maximum relative noise of a source's pixel (sigma of the view)")             \
    X(max_clutter, double, 0.6, 0, 1, "",                                                                              \
      "clutter of a view's pixel from which it shows something in front of the surface; 1: nothing is refused for it") \
    X(min_clutter, double, 0.3, 0, 1, "",                                                                              \
      "clutter from which other views decide by their colours whether the pixel shows the surface")                    \
    X(thing_margin, double, 3, 0, 100, "px",                                                                           \
      "distance from a thing within which a view shows no texel of what is behind: the thing's rim")                   \
    X(agree, double, 0.15, 0.001, 10, "", "largest difference of colours that agree, as a natural logarithm")          \
    X(max_gradient, double, 0.1, 0, 1000, "",                                                                          \
      "difference of neighbours, in display units, from which it counts little in compositing")

struct texture_params {
    TEXTURE_PARAMS(PARAM_FIELD)
};
#define TEXTURE_PARAMS_DEFAULT        \
    {                                 \
        TEXTURE_PARAMS(PARAM_DEFAULT) \
    }

/* ST_USAGE: parameters that contradict each other. */
enum status texture_params_check(const struct texture_params *p, struct err *err);

#endif
