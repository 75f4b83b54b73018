/* fill_path.h - hole filling without flicker along a camera path.
 *
 * A frame's result depends only on the path, the parameters and the frame's number, not on the frames rendered before.
 * Rendering frames in order renders each anchor frame once; a single frame costs at most 2 + log2(anchors) extra
 * frames. Only the filled pixels of that many anchors are kept, no frames. Colours are scene-linear; depth is z along
 * the camera's axis. See fill_path.c. */
#ifndef REMODEL_RENDER_VIEWS_FILL_PATH_H
#define REMODEL_RENDER_VIEWS_FILL_PATH_H

#include "common/capture/camera_path.h"
#include "stages/render_views/exemplar_fill.h"

#define FILL_PATH_PARAMS(X)                                                                                         \
    X(fill_anchor_spacing, int, 20, 0, 100000, "frames",                                                            \
      "offline: spacing of the anchor frames, whose filled holes are reprojected into the frames between them; 0: " \
      "each frame is filled independently")

#define FILL_MAX_ANCHORS 34 /* kept at once: two ends, and a middle for each halving of 2^31 */

/* Renders frame `frame` (from 0) of the path without hole filling: holes have alpha 0 and depth 0. */
typedef enum status fill_path_render(void *ctx, int frame, struct rendered_frame *out, struct err *err);

/* The photos that a frame of this camera is rendered from. */
typedef struct hole_photos fill_path_photos(void *ctx, const struct view *camera);

struct fill_path_options {
    struct exemplar_depth depth;
    struct exemplar_params exemplar;
    int fill_diameter;        /* as in exemplar_fill; 0: nothing is filled */
    int fill_anchor_spacing;  /* frames; 0: no anchors */
    fill_path_photos *photos; /* called with the ctx of fill_path_init; NULL: unknown */
};

struct fill_point {       /* a filled pixel */
    struct vec3 position; /* world */
    float rgb[3];
};

struct fill_anchor {
    int index; /* anchor 0, 1, ..; -1: empty */
    struct fill_point *points;
    size_t count;
};

struct fill_path {
    const struct camera_path *path;
    fill_path_render *render;
    void *ctx;
    struct fill_path_options options;
    struct fill_anchor anchors[FILL_MAX_ANCHORS]; /* first, last, the middle of these, the middle of one half, .. */
    int rendered;                                 /* anchors rendered so far */
    struct exemplar_stats stats;                  /* of the last frame: the part filled by inpainting */
};

/* The path must outlive the fill. `{0}` may be released. */
void fill_path_init(struct fill_path *fill, const struct camera_path *path, fill_path_render *render, void *ctx,
                    const struct fill_path_options *options);

/* Fills f, rendered from `camera`: the camera of frame `frame` (from 0), or one within its aperture. Sets
 * unfilled_fraction. Same bits for any number of threads, and for any frames rendered before. */
enum status fill_path_frame(struct fill_path *fill, int frame, const struct view *camera, struct rendered_frame *f,
                            struct err *err);
void fill_path_release(struct fill_path *fill);

#endif
