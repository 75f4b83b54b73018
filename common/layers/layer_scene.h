/* layer_scene.h - a scene of layered depth maps, ready for rendering: cameras, packed layers, view mesh. */
#ifndef REMODEL_LAYER_SCENE_H
#define REMODEL_LAYER_SCENE_H

#include "common/layers/layer_view.h"
#include "common/layers/photo_exposure.h"
#include "common/layers/soft_z.h"
#include "common/layers/view_mesh.h"

struct layer_scene { /* depths[i] and views[i] belong to set->views[i] */
    const struct camera_set *set;
    struct layered_depth *depths; /* owned; size and segments only: the layers' planes are NULL after packing */
    struct layer_view *views;     /* owned; the packed layers */
    struct view_mesh mesh;
    double near_depth, far_depth; /* 2nd and 98th percentiles of the segments' depths over all views, each in its own
                                     camera, weighted by pixels */
    double sigma;                 /* median of the relative uncertainties of the segments, weighted by pixels */
    struct photo_exposures exposures; /* that were removed from the views' photos */
};

/* Reads depth_folder/VIEW.exr of every view and adds each file to prov (may be NULL). The set must outlive the scene.
 * ST_DATA: a depth map's size differs from its camera's. */
enum status layer_scene_read(struct layer_scene *scene, const struct camera_set *set, const char *depth_folder,
                             struct provenance *prov, struct err *err);
/* As layer_scene_read, from one depth map per view in memory. The scene takes ownership of their contents and leaves
 * depths[i] empty, also on failure. */
enum status layer_scene_init(struct layer_scene *scene, const struct camera_set *set, struct layered_depth *depths,
                             struct err *err);
/* Brings the photos to one exposure, once; frames then need photo_exposures_apply(). ST_NOMEM. */
enum status layer_scene_match_exposures(struct layer_scene *scene, struct err *err);
/* The scene's soft z-buffer; widths: in depth uncertainties, 0: the scene's depth range, as in the thesis. */
struct soft_z layer_scene_soft_z(const struct layer_scene *scene, double widths);
void layer_scene_release(struct layer_scene *scene);

#endif
