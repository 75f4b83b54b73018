/* relight_params.h - parameters of relight. */
#ifndef REMODEL_RELIGHT_PARAMS_H
#define REMODEL_RELIGHT_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define RELIGHT_PARAMS(X)                                                                                            \
    X(target_error, double, 0.02, 0.0001, 1, "", "relative error of the quotient of light at which a gather ends")   \
    X(rays, int, 8192, 64, 1 << 24, "", "most rays towards lights at a pixel, and most rays of a glossy reflection") \
    X(step, int, 4, 1, 32, "px",                                                                                     \
      "light is gathered at the corners of cells so wide, and between them where it or the surface differs; 1: at "  \
      "each pixel")                                                                                                  \
    X(smooth, int, 3, 0, 6, "", "passes that smooth the noise of the quotient along surfaces")                       \
    X(penumbra, int, 6, 0, 16, "px",                                                                                 \
      "most shift of the edge of an old shadow or patch of sun that is fitted to the photograph; 0: none is fitted") \
    X(light, choice, "gathered", 0, 0, "gathered|atlas",                                                             \
      "gathered at each pixel, with sharp shadows; or that of the atlas of update_vita: fast, and the same from "    \
      "every "                                                                                                       \
      "camera, for films")                                                                                           \
    X(integrals, choice, "no", 0, 0, "no|yes",                                                                       \
      "also write the integrals of light, by lamp, from which materials and lamps can be changed without a new "     \
      "gather")                                                                                                      \
    X(exposure, double, 0, 0, 1e9, "",                                                                               \
      "radiance times this is 1 at white; 0: that of the picture before it was relit, or what still shows the room")

struct relight_params {
    RELIGHT_PARAMS(PARAM_FIELD)
};
#define RELIGHT_PARAMS_DEFAULT        \
    {                                 \
        RELIGHT_PARAMS(PARAM_DEFAULT) \
    }

#endif
