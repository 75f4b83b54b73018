/* exemplar_fill.h - fills holes by copying patches, from the far side (Criminisi, Perez and Toyama 2004, as thesis
 * 3.6.2 changed it for depth).
 *
 * A hole is a set of 8-connected pixels of alpha 0. Its rim - the known pixels beside it - is split by depth into a
 * near and a far cluster, if it has two; then only what is farther than the border between the clusters spreads into
 * the hole, is copied from and is compared with. Every hole is filled from what was known before any was filled, and
 * from itself: so neither their order nor threads matter.
 *
 * Colours are scene-linear; patches are compared by the square root of each channel, which is nearly even to the eye
 * and makes the choice of a patch independent of exposure. Depth is z along the camera's axis. */
#ifndef REMODEL_RENDER_VIEWS_EXEMPLAR_FILL_H
#define REMODEL_RENDER_VIEWS_EXEMPLAR_FILL_H

#include "common/base/param.h"
#include "common/layers/rendered_frame.h"
#include "common/layers/soft_z.h"

/* fill_diameter stands with render_views' own parameters */
#define EXEMPLAR_PARAMS(X)                                                          \
    X(fill_patch, int, 5, 3, 15, "px", "width of the patches that fill holes; odd") \
    X(fill_window, int, 100, 8, 4096, "px", "width of the square around a patch in which its like is looked for")

struct exemplar_params {
    EXEMPLAR_PARAMS(PARAM_FIELD)
};
#define EXEMPLAR_PARAMS_DEFAULT        \
    {                                  \
        EXEMPLAR_PARAMS(PARAM_DEFAULT) \
    }

struct exemplar_depth { /* what the filling knows of depth in a scene */
    struct soft_z soft;
    float sigma; /* relative uncertainty of the depths */
};

struct exemplar_stats {
    size_t empty, narrow;     /* pixels without colour; of them in holes narrower than fill_diameter */
    int holes, classified;    /* wide holes; of them with a near and a far side */
    size_t patches, no_patch; /* copied; places where no whole patch could be copied from: filled by blending */
    size_t moved;             /* searches whose window had no whole patch */
};

/* Fills rgba and z where alpha is 0 and sets unfilled_fraction; nothing stays empty unless all is (or the diameter is
 * 0: then nothing is filled). Holes that are narrower than `diameter` throughout are filled by
 * common/layers/hole_fill.h. An even fill_patch counts as the next odd one. stats may be NULL. Same bits for any number
 * of threads. */
enum status exemplar_fill(struct rendered_frame *frame, const struct exemplar_depth *depth, int diameter,
                          const struct exemplar_params *params, struct exemplar_stats *stats, struct err *err);

/* The border between a near and a far cluster of depths: the middle, in ln z, between the means of the two clusters
 * that exact 1-D 2-means finds in ln z. 0 if there are not two: see exemplar_fill.c. Depths that are 0 do not count;
 * sorts z. */
float exemplar_far_border(float *z, size_t count, float sigma);

#endif
