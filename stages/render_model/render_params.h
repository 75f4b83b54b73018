/* render_params.h - parameters of render_model. */
#ifndef REMODEL_RENDER_MODEL_PARAMS_H
#define REMODEL_RENDER_MODEL_PARAMS_H

#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define RENDER_MODEL_PARAMS(X)                                                                                       \
    X(clutter, choice, "drawn", 0, 0, "drawn|none",                                                                  \
      "furniture and other things that the model does not hold: drawn from the photos' layers, or none: bare rooms") \
    X(photo, choice, "where_unchanged", 0, 0, "where_unchanged|no",                                                  \
      "from an original view: the photo's own pixels where the edit changes nothing, or textures everywhere")        \
    X(margin, double, 5, 0, 1000, "px", "nearer than this to a pixel that the edit changes the photo is not used")   \
    X(exposure, double, 0, 0, 1e9, "",                                                                               \
      "radiance times this is 1 at white, in all pictures; 0: the exposure that choose_exposure found")              \
    X(radiance, choice, "no", 0, 0, "no|yes|all",                                                                    \
      "from original views: also write the radiance, as EXR; all: also of views that the edit leaves alone, and of " \
      "films instead of frames")                                                                                     \
    X(samples, int, 2, 1, 8, "", "places along each side of a pixel whose colours are averaged")                     \
    X(memory, int, 700, 16, 1000000, "MiB", "pages of atlases, and as much again of views, that are kept in memory")

struct render_model_params {
    RENDER_MODEL_PARAMS(PARAM_FIELD)
};
#define RENDER_MODEL_PARAMS_DEFAULT        \
    {                                      \
        RENDER_MODEL_PARAMS(PARAM_DEFAULT) \
    }

#endif
