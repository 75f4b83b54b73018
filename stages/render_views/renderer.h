/* renderer.h - finished frames: visibility and blending, hole filling, depth of field, effect layers.
 *
 *            segments                            holes                                  depth of field
 * offline    all views' surfaces in one soft z   exemplar-based inpainting, consistent  pinhole frames averaged over
 *                                                along a path                           the lens
 * fast       two surfaces per view, then a       narrow holes from their surroundings,  blur by a MIP map
 *            soft z across views                 wide ones by a pull-push pyramid
 *
 * Both blend photos of one exposure; the finished frame gets that of the photos around its camera (photo_exposure.h).
 * Effect layers are the last pass. */
#ifndef REMODEL_RENDER_VIEWS_RENDERER_H
#define REMODEL_RENDER_VIEWS_RENDERER_H

#include <stdbool.h>

#include "common/film/effects.h"
#include "common/layers/layer_render.h"
#include "stages/render_views/aperture.h"
#include "stages/render_views/defocus.h"
#include "stages/render_views/fill_path.h"

#define RENDER_PARAMS(X)                                                                                     \
    X(renderer, choice, "offline", 0, 0, "offline|fast",                                                     \
      "rendering method: offline has the best quality, fast is for thousands of pictures")                   \
    X(soft_z, double, SOFT_Z_WIDTHS, 0, 100, "",                                                             \
      "width of the soft z-buffer, in depth uncertainties; 0: the scene's depth range")                      \
    X(views, choice, "mesh", 0, 0, "mesh|nearest",                                                           \
      "views rendered: the three that the view mesh selects for each ray, blended, or only the nearest one") \
    X(more_views, int, LAYER_MORE_VIEWS, 0, LAYER_MORE_VIEWS, "",                                            \
      "offline: number of nearest views that are blended, and vote, besides those of the view mesh")         \
    X(fill_diameter, int, 6, 0, 64, "px",                                                                    \
      "holes narrower than this are filled from their surroundings; 0: no hole is filled")                   \
    X(exposure, choice, "matched", 0, 0, "matched|taken",                                                    \
      "photos are brought to one exposure before they are blended, or blended as they were taken")           \
    EXEMPLAR_PARAMS(X)                                                                                       \
    FILL_PATH_PARAMS(X)                                                                                      \
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
    int frame;        /* being rendered */
    bool half_sphere; /* set by the caller: frames of the path are half-spheres */
};

/* Brings the scene's photos to one exposure if params say so; before renderer_init(). */
enum status renderer_match_exposures(struct layer_scene *scene, const struct render_params *params, struct err *err);
/* scene, path and effects must outlive the renderer; path may be NULL, effects empty. */
void renderer_init(struct renderer *r, const struct layer_scene *scene, const struct camera_path *path,
                   const struct effects *effects, const struct render_params *params);
/* Renders frame `frame` (from 0) of the path. A half-sphere has no depth of field, and is filled only within what the
 * photos show: all around stays empty. The result does not depend on frames rendered before. */
enum status renderer_frame(struct renderer *r, int frame, struct rendered_frame *out, struct err *err);
/* Renders a single pinhole picture, without effects. */
enum status renderer_camera(struct renderer *r, const struct view *camera, struct rendered_frame *out, struct err *err);
void renderer_release(struct renderer *r);

#endif
