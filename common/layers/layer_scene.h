/* layer_scene.h - what a renderer of layered depth maps holds of a scene: cameras, packed layers, the view mesh. */
#ifndef REMODEL_LAYER_SCENE_H
#define REMODEL_LAYER_SCENE_H

#include "common/layers/layer_view.h"
#include "common/layers/soft_z.h"
#include "common/layers/view_mesh.h"

struct layer_scene { /* views, their layers, the mesh; depths[i] belongs to set->views[i] */
    const struct camera_set *set;
    struct layered_depth *depths; /* owned; size and segments: the planes are packed and given back (NULL) */
    struct layer_view *views;     /* owned; one a view */
    struct view_mesh mesh;
    double near_depth, far_depth; /* percentiles (2, 98) of the segments' depths over all views, in their own cameras,
                                     a segment counting by its pixels */
    double sigma;                 /* the median of their relative uncertainties */
};

/* Reads depth_folder/VIEW.exr of every view. ST_DATA if a size differs from the camera's. Adds each file to prov
 * (may be NULL). The set must outlive the scene. */
enum status layer_scene_read(struct layer_scene *scene, const struct camera_set *set, const char *depth_folder,
                             struct provenance *prov, struct err *err);
/* From depth maps in memory, one a view; their contents pass to the scene and depths[i] is left empty, on failure
 * too. */
enum status layer_scene_init(struct layer_scene *scene, const struct camera_set *set, struct layered_depth *depths,
                             struct err *err);
/* The soft z of a scene; widths in depth uncertainties, 0: the thesis'. */
struct soft_z layer_scene_soft_z(const struct layer_scene *scene, double widths);
void layer_scene_release(struct layer_scene *scene);

#endif
