/* layer_render.h - layered depth maps seen from a novel camera (thesis 3.6), in two ways.
 *
 * Each segment is a plane (1/z linear in its view's pixels), so its picture in the novel camera is a homography: a
 * target pixel is taken back to the segment's view (common/layers/segment_project.h), where the cells' ids tell whether it
 * belongs to the segment (common/layers/layer_visibility.h).
 *
 *   fast     in each view the two nearest surfaces, front to back and saturating; across the views that the view mesh
 *            names for the pixel, a soft z-buffer (thesis eq. 3.1, common/layers/soft_z.h) blends by weight x w x alpha
 *   offline  the surfaces of those views and of the nearest ones beside them in one soft z, in which views that see
 *            otherwise speak against a surface (soft_z_merge); colours are looked up bicubically
 *
 * Four things are not in the thesis. The offline renderer's further views, and their votes. Blending weights are the
 * view mesh's at points 16 px apart, bilinear between. A view's weight falls off towards the border of its picture, so
 * that the border leaves no line. And a pixel is a hole only if nothing else covers it either: where the views that
 * the mesh names leave it below alpha 0.5, the nearest other view (by centre) that sees something there takes their
 * place, unless most of them, by weight, see through it at something farther. Of what is left common/layers/hole_fill.h fills
 * as much as the options say, from the far side.
 *
 * Depth is z along the novel camera's axis, in scene units; colour is scene-linear. */
#ifndef REMODEL_LAYER_RENDER_H
#define REMODEL_LAYER_RENDER_H

#include "common/layers/layer_scene.h"
#include "common/layers/rendered_frame.h"

#define SOFT_Z_WIDTHS      8 /* the usual soft_z */
#define SOFT_Z_FILL_WIDTHS 3 /* of the reversed one that fills holes: narrow, so that only the far side comes in */

#define LAYER_MORE_VIEWS 12

struct layer_render_options {
    bool offline;
    bool nearest_alone; /* the view nearest to the camera and no other: what blending is compared with */
    int more_views;     /* offline: this many of the nearest views, at most LAYER_MORE_VIEWS */
    double soft_z;      /* width of the soft z, in depth uncertainties; 0: the thesis' (rho, rho / 10) */
    int fill_diameter; /* holes narrower than this (px) are filled by the reverse soft z in 7x7, wider ones by a pyramid
                           that prefers the far side; 0: none is filled */
};

/* The frame's buffers are kept from call to call if the size is the same. Same bits for any number of threads. */
enum status layer_render(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                         const struct layer_render_options *options, struct err *err);

/* Coverage alone: out->hole and hole_fraction (rgba and z stay NULL); `scale` reduces the novel camera (0 < scale <=
 * 1). The holes are those of layer_render with the usual soft z. */
enum status layer_coverage(struct rendered_frame *out, const struct layer_scene *scene, const struct view *novel,
                           double scale, struct err *err);

#endif
