/* exemplar_fill.h - exemplar-based inpainting of holes from the far side [Criminisi 2004], [Colburn 2014, 3.6.2].
 *
 * A hole is a set of 8-connected pixels of alpha 0. Each hole is filled from the pixels known before any hole was
 * filled, and from itself, so neither the order of the holes nor threads matter. Colours are scene-linear; depth is z
 * along the camera's axis. See exemplar_fill.c. */
#ifndef REMODEL_RENDER_VIEWS_EXEMPLAR_FILL_H
#define REMODEL_RENDER_VIEWS_EXEMPLAR_FILL_H

#include "common/base/param.h"
#include "common/layers/hole_fill.h"

/* fill_diameter is among render_views' own parameters */
#define EXEMPLAR_PARAMS(X)                                                                                \
    X(fill_patch, int, 5, 3, 15, "px", "offline: width of the patches copied into holes; even: one more") \
    X(fill_window, int, 100, 8, 4096, "px", "offline: width of the window in which a matching patch is searched")

struct exemplar_params {
    EXEMPLAR_PARAMS(PARAM_FIELD)
};
#define EXEMPLAR_PARAMS_DEFAULT        \
    {                                  \
        EXEMPLAR_PARAMS(PARAM_DEFAULT) \
    }

struct exemplar_depth { /* depth statistics of a scene */
    struct soft_z soft;
    float sigma; /* relative uncertainty of the depths */
};

struct exemplar_stats {
    size_t empty, narrow;     /* pixels without colour; those of them in narrow holes */
    int holes, classified;    /* wide holes; those of them with a near and a far side */
    int overhangs;            /* wide holes beyond the photos, which are filled from all sides */
    size_t patches, no_patch; /* patches copied; patches filled by blending, because there was no source */
    size_t moved;             /* searches without a source patch in the first window */
};

/* Fills rgba and z where alpha is 0 and sets unfilled_fraction. Nothing stays empty, unless the whole frame is empty or
 * the diameter is 0, which disables filling. Holes narrower than `diameter` everywhere are filled by hole_fill.h. An
 * even fill_patch counts as the next odd number. photos and stats may be NULL. ST_NOMEM. Same bits for any number of
 * threads. */
enum status exemplar_fill(struct rendered_frame *frame, const struct hole_photos *photos,
                          const struct exemplar_depth *depth, int diameter, const struct exemplar_params *params,
                          struct exemplar_stats *stats, struct err *err);

/* Border between a near and a far cluster of depths: the midpoint, in ln z, of the means of the two clusters that exact
 * 1-D 2-means finds. 0: there are not two clusters, by the criteria in exemplar_fill.c. Ignores depths of 0; sorts
 * z. */
float exemplar_far_border(float *z, size_t count, float sigma);

#endif
