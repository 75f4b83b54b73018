/* outdoors_params.h - parameters of bake_outdoors. */
#ifndef REMODEL_OUTDOORS_PARAMS_H
#define REMODEL_OUTDOORS_PARAMS_H

#include "common/base/param.h"

enum { CELL = 4 }; /* px: side of the cells of the picture in which one source is chosen */

/* name, type, default, min, max, unit, help */
#define OUTDOORS_PARAMS(X)                                                                                           \
    X(height, int, 2048, 16, 8192, "px",                                                                             \
      "height of the picture of the outdoors, a multiple of 4; it is twice as wide")                                 \
    X(prefer, choice, "references", 0, 0, "references|photos",                                                       \
      "pictures that show a direction where both do: lighting reference images, or photos, which are often sharper") \
    X(edge, double, 5, 0, 100, "px", "distance from what is not outdoors within which a picture shows no outdoors")  \
    X(max_clutter, double, 0.6, 0, 1, "", "clutter of a view's pixel from which it does not show the outdoors")      \
    X(agree, double, 0.3, 0.001, 10, "",                                                                             \
      "largest difference of a photo from the median of all that show a direction, as a natural logarithm")          \
    X(sun, choice, "find", 0, 0, "find|none",                                                                        \
      "a sun that no lighting reference image shows: found from its patches on floors and walls, or none")

struct outdoors_params {
    OUTDOORS_PARAMS(PARAM_FIELD)
};
#define OUTDOORS_PARAMS_DEFAULT        \
    {                                  \
        OUTDOORS_PARAMS(PARAM_DEFAULT) \
    }

#endif
