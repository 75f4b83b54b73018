/* frames.h - the frames of a camera path as EXR files: R G B A (half, linear, premultiplied) and Z (float, depth in the
 * frame's camera, 0 unknown), attributes remodel:holes and remodel:unfilled (fractions of the pixels), and remodel:h
 * (common/layers/hole_measure.h; none where nothing is seen at all). */
#ifndef REMODEL_RENDER_VIEWS_FRAMES_H
#define REMODEL_RENDER_VIEWS_FRAMES_H

#include <stdbool.h>

#include "stages/render_views/renderer.h"

/* A part of a picture, and how large it is made: "X,Y,W,H" in pixels of the picture, "S". NULL: all of it, 1. */
struct frame_part {
    int x, y, width, height; /* width 0: all */
    double scale;
};
/* ST_USAGE with what was found. */
enum status frame_part_read(struct frame_part *part, const char *crop, const char *scale, struct err *err);
/* The camera of the part: the same rays. ST_USAGE: the part is not within the picture, or nothing is left of it. */
enum status frame_part_camera(struct view *camera, const struct frame_part *part, struct err *err);

/* Renders the wanted frames into folder/NNNN.exr. A frame that sees nothing of the scene is ST_DATA with its number. */
enum status frames_render(const struct camera_path *path, const bool *wanted, struct renderer *renderer,
                          const char *folder, const struct provenance *prov, struct err *err);

/* wanted[i] for camera i: all, or with names those. ST_USAGE: a name that is no camera. */
enum status cameras_select(bool *wanted, const struct camera_set *cameras, const char *const *names, int count,
                           struct err *err);

/* One frame a wanted camera, of its own size, into folder/NAME.exr, which also has the channel hole (half): 1 where no
 * view covers the pixel, before filling. A camera that sees nothing gets an empty frame and a warning. */
enum status cameras_render(const struct camera_set *cameras, const bool *wanted, struct renderer *renderer,
                           const char *folder, const struct provenance *prov, struct err *err);

#endif
