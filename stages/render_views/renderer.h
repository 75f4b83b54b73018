/* renderer.h - a finished frame: rendered, its holes filled, depth of field, effect layers.
 *
 *            segments                             holes                              depth of field
 * offline    all of all views in one soft z       patches copied from the far side,   the view moved over the aperture
 *                                                 carried along a path
 * fast       two surfaces a view, then a soft z   narrow ones from around, wide ones  blur through a pyramid
 *                                                 by a pyramid
 * Effect layers are the last pass of both. */
#ifndef REMODEL_RENDER_VIEWS_RENDERER_H
#define REMODEL_RENDER_VIEWS_RENDERER_H

#include "common/film/effects.h"
#include "common/layers/layer_render.h"
#include "stages/render_views/aperture.h"
#include "stages/render_views/defocus.h"
#include "stages/render_views/fill_path.h"

#define RENDER_PARAMS(X)                                                                                           \
    X(renderer, choice, "offline", 0, 0, "offline|fast",                                                           \
      "best quality; or what thousands of pictures can be had with")                                               \
    X(soft_z, double, SOFT_Z_WIDTHS, 0, 100, "",                                                                   \
      "width of the soft z, in depth uncertainties; 0: the whole scene's depth range")                             \
    X(views, choice, "mesh", 0, 0, "mesh|nearest",                                                                 \
      "those that surround each ray, blended; or the nearest to the camera alone")                                 \
    X(more_views, int, LAYER_MORE_VIEWS, 0, LAYER_MORE_VIEWS, "",                                                  \
      "offline: nearest views that are blended and vote beside the three that surround a ray")                     \
    X(fill_diameter, int, 6, 0, 64, "px", "holes narrower than this are filled from around; 0: no hole is filled") \
    EXEMPLAR_PARAMS(X)                                                                                             \
    FILL_PATH_PARAMS(X)                                                                                            \
    APERTURE_PARAMS(X)

struct render_params {
    RENDER_PARAMS(PARAM_FIELD)
};
#define RENDER_PARAMS_DEFAULT        \
    {                                \
        RENDER_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param render_param_table[];

struct renderer {
    const struct layer_scene *scene;
    const struct camera_path *path; /* NULL: single cameras */
    const struct effects *effects;
    struct layer_render_options options;
    struct exemplar_params exemplar;
    struct exemplar_depth depth;
    struct aperture_options aperture;
    int fill_diameter;
    struct fill_path fill;
    struct defocus defocus;
    int frame; /* the one that is being rendered */
};

/* All must outlive the renderer; path may be NULL, effects empty. */
void renderer_init(struct renderer *r, const struct layer_scene *scene, const struct camera_path *path,
                   const struct effects *effects, const struct render_params *params);
/* Frame `frame` (from 0) of the path. The same bytes whatever frames were rendered before. */
enum status renderer_frame(struct renderer *r, int frame, struct rendered_frame *out, struct err *err);
/* A pinhole picture by itself, without effects. */
enum status renderer_camera(struct renderer *r, const struct view *camera, struct rendered_frame *out, struct err *err);
void renderer_release(struct renderer *r);

#endif
