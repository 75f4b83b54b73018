/* fill_path.h - holes filled so that they do not flicker along a camera path.
 *
 * A frame filled by itself differs from its neighbours by whatever patches happened to match best. So some frames at
 * fixed places of the path, the anchors (the first, every Nth and the last), are filled once; what was filled there is
 * kept as points in the world. A frame's holes take the points of the anchor before and of the one behind, blended by
 * the distance along the path, and only what no point covers is filled anew.
 *
 * Anchors agree with one another because they take over points too: the last from the first, the middle one from both,
 * and so on in halves. What is in a frame depends on the path, the parameters and the frame's number alone, not on the
 * frames asked for before. Whoever asks for frames in order renders each anchor once; one frame by itself costs at most
 * 2 + log2(anchors) others. Kept are the filled pixels of as many anchors, no frame.
 *
 * Colours scene-linear; depth along the camera's axis. */
#ifndef REMODEL_RENDER_VIEWS_FILL_PATH_H
#define REMODEL_RENDER_VIEWS_FILL_PATH_H

#include "common/capture/camera_path.h"
#include "stages/render_views/exemplar_fill.h"

#define FILL_PATH_PARAMS(X)                                                                                      \
    X(fill_anchors, int, 20, 0, 100000, "frames",                                                                \
      "frames from one to the next whose filled holes the frames between take over; 0: each frame is filled by " \
      "itself")

#define FILL_ANCHORS_MOST 34 /* kept at once: two ends and a middle for each halving of 2^31 */

/* Renders frame `frame` (from 0) of the path without filling: holes have alpha 0 and depth 0. */
typedef enum status fill_path_render(void *ctx, int frame, struct rendered_frame *out, struct err *err);

struct fill_path_options {
    struct exemplar_depth depth;
    struct exemplar_params exemplar;
    int fill_diameter; /* as of exemplar_fill; 0: nothing is filled */
    int fill_anchors;
};

struct fill_point {
    struct vec3 at; /* in the world */
    float rgb[3];
};

struct fill_anchor {
    int index; /* anchor 0, 1, ..; -1: none is kept */
    struct fill_point *points;
    size_t count;
};

struct fill_path {
    const struct camera_path *path;
    fill_path_render *render;
    void *ctx;
    struct fill_path_options options;
    struct fill_anchor anchors[FILL_ANCHORS_MOST]; /* first, last, middle of these, middle of one half, .. */
    int rendered;                                  /* anchors rendered so far */
    struct exemplar_stats stats;                   /* of the last frame: what was filled anew */
};

/* The path must outlive the fill. `{0}` may be released. */
void fill_path_init(struct fill_path *fill, const struct camera_path *path, fill_path_render *render, void *ctx,
                    const struct fill_path_options *options);

/* Fills f, which was rendered from `camera`: that of frame `frame` (from 0), or one within its aperture. Sets
 * unfilled_fraction. Same bytes for any number of threads and any frames before. */
enum status fill_path_frame(struct fill_path *fill, int frame, const struct view *camera, struct rendered_frame *f,
                            struct err *err);
void fill_path_release(struct fill_path *fill);

/* How much filled pixels change from a frame to the next: every filled pixel of a is taken by its depth into b, where
 * the four pixels around must be filled too; difference is the sum over those pixels of the mean over R G B of |sqrt a
 * - sqrt b|, b interpolated linearly. Adds to both; flicker is difference / pixels. */
void fill_flicker_add(double *difference, double *pixels, const struct rendered_frame *a, const struct view *camera_a,
                      const struct rendered_frame *b, const struct view *camera_b);

#endif
