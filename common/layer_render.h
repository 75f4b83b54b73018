/* layer_render.h - layered depth maps seen from a novel camera (thesis 3.6; the interactive renderer's way).
 *
 * Each segment is a plane (1/z linear in its view's pixels), so its picture in the novel camera is a homography: a
 * target pixel is taken back to the segment's view, where the layers' ids tell whether it belongs to the segment
 * (common/layer_raster.h). In each view segments go front to back and saturate; across the views that the view mesh
 * names for the pixel, a soft z-buffer (thesis eq. 3.1, common/soft_z.h) blends by weight x w x alpha.
 *
 * Two things are not in the thesis. A view's weight falls off towards the border of its picture, so that the border
 * leaves no line. And a pixel is a hole only if nothing else covers it either: where the views that the mesh names
 * leave it below alpha 0.5, the nearest other view (by centre) that sees something there takes their place, unless
 * most of them, by weight, see through it at something farther. What is left is filled from the far side
 * (common/hole_fill.h).
 *
 * Depth is z along the novel camera's axis, in scene units; colour is scene-linear. */
#ifndef REMODEL_LAYER_RENDER_H
#define REMODEL_LAYER_RENDER_H

#include "camera_set.h"
#include "layered_depth.h"
#include "view_mesh.h"

struct layer_view; /* a view packed for rendering, 24 bytes a pixel: common/layer_raster.h */

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
void layer_scene_release(struct layer_scene *scene);

#define SOFT_Z_WIDTHS 3 /* the usual soft_z */

struct layer_render_options {
    double soft_z;     /* width of the soft z, in depth uncertainties; 0: the thesis' (rho, rho / 10) */
    int fill_diameter; /* holes narrower than this (px) are filled by the reverse soft z in 7x7, wider ones by a pyramid
                          that prefers the far side; 0: none is filled */
};

struct rendered_frame {
    int width, height;
    float *rgba;                             /* w * h * 4, linear, premultiplied; alpha 1, or 0 in what is not filled */
    float *z;                                /* w * h, depth in the novel camera, 0 unknown */
    uint8_t *hole;                           /* w * h: 1 where no segment was, before filling */
    double hole_fraction, unfilled_fraction; /* of the pixels: before and after filling */
};

/* The frame's buffers are kept from call to call if the size is the same. Same bits for any number of threads. */
enum status layer_render(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                         const struct layer_render_options *options, struct err *err);
void rendered_frame_release(struct rendered_frame *frame);

/* Coverage alone: out->hole and hole_fraction (rgba and z stay NULL); `scale` reduces the novel camera (0 < scale <=
 * 1). The holes are those of layer_render with the usual soft z. */
enum status layer_coverage(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                           double scale, struct err *err);

#endif
