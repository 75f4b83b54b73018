/* vita_params.h - the parameters of bake_vita: those of all textures, then its own. */
#ifndef REMODEL_VITA_PARAMS_H
#define REMODEL_VITA_PARAMS_H

#include "common/texture/texture_params.h"

/* name, type, default, min, max, unit, help */
#define VITA_PARAMS(X)                                                                         \
    X(texels, int, 250, 4, 4000, "", "texels in the height of the model; a texel is a square") \
    X(batch, double, 4, 0.1, 100, "million", "texels that are baked at a time, which bounds the memory")

struct vita_params {
    struct texture_params texture; /* first: its rows of the table have offsets into it */
    VITA_PARAMS(PARAM_FIELD)
};
#define VITA_PARAMS_DEFAULT                                           \
    {                                                                 \
        .texture = TEXTURE_PARAMS_DEFAULT, VITA_PARAMS(PARAM_DEFAULT) \
    }

#endif
