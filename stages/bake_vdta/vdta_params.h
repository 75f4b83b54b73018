/* vdta_params.h - the parameters of bake_vdta: those of all textures, then its own. */
#ifndef REMODEL_VDTA_PARAMS_H
#define REMODEL_VDTA_PARAMS_H

#include "common/texture/texture_params.h"

/* name, type, default, min, max, unit, help */
#define VDTA_PARAMS(X)                                                                                      \
    X(reveal, choice, "edits", 0, 0, "edits|all",                                                           \
      "faces that the viewpoint does not show: what the edits reveal of them, or all that is in the frame") \
    X(own_photo, choice, "used", 0, 0, "used|withheld",                                                     \
      "withheld: the viewpoint's texels come from the other photos alone; to measure how well these predict it")

struct vdta_params {
    struct texture_params texture; /* first: its rows of the table have offsets into it */
    VDTA_PARAMS(PARAM_FIELD)
};
#define VDTA_PARAMS_DEFAULT                                           \
    {                                                                 \
        .texture = TEXTURE_PARAMS_DEFAULT, VDTA_PARAMS(PARAM_DEFAULT) \
    }

#endif
