/* layer_render.h - renders layered depth maps from a novel camera [Colburn 2014, 3.6]: a fast and an offline renderer.
 *
 * Depth is z along the novel camera's axis, in scene units; colour is scene-linear. See layer_render.c. */
#ifndef REMODEL_LAYER_RENDER_H
#define REMODEL_LAYER_RENDER_H

#include "common/layers/hole_fill.h"
#include "common/layers/layer_scene.h"
#include "common/layers/rendered_frame.h"

#define SOFT_Z_WIDTHS 32 /* default width of the soft z */
/* Width of the reversed soft z of hole filling: narrow, so that only the far side counts. */
#define SOFT_Z_FILL_WIDTHS 3

#define LAYER_MORE_VIEWS 12

struct layer_render_options {
    bool offline;
    bool nearest_alone; /* render only the view nearest to the camera, for comparison with blending */
    int more_views;     /* offline: nearest views blended besides the view mesh's, at most LAYER_MORE_VIEWS */
    double soft_z;      /* width of the soft z, in depth uncertainties; 0: the scene's depth range, as in the thesis */
    int fill_diameter;  /* holes narrower than this (px) are filled from their neighbourhood, wider ones by a pyramid;
                           0: no hole is filled */
};

/* Buffers of `out` are reused if the size is the same. Same bits for any number of threads. ST_NOMEM. */
enum status layer_render(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                         const struct layer_render_options *options, struct err *err);

/* The photos that layer_render uses for this camera; they belong to the scene. */
struct hole_photos layer_photos(const struct layer_scene *scene, const struct view *novel,
                                const struct layer_render_options *options);

/* Coverage only: sets out->hole and hole_fraction; rgba and z stay NULL. The picture is reduced by `scale`, 0 < scale
 * <= 1. The holes are those of layer_render with SOFT_Z_WIDTHS, without extra views. */
enum status layer_coverage(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                           double scale, struct err *err);

#endif
