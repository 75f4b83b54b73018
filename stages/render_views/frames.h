/* frames.h - frames of a camera path, or of single cameras, as EXR files.
 *
 * Channels R G B A (half, scene-linear, premultiplied) and Z (float, depth along the camera's axis, 0 unknown).
 * Attributes remodel:holes and remodel:unfilled (fractions of the pixels, before and after filling), and remodel:h
 * (common/layers/hole_measure.h; missing if the frame is one hole). */
#ifndef REMODEL_RENDER_VIEWS_FRAMES_H
#define REMODEL_RENDER_VIEWS_FRAMES_H

#include <stdbool.h>

#include "stages/render_views/renderer.h"

/* Crop and scale of a picture. */
struct frame_part {
    int x, y, width, height; /* in pixels of the picture; width 0: the whole picture */
    double scale;            /* applied after the crop */
};
/* crop: "X,Y,WIDTH,HEIGHT", NULL: the whole picture; scale: a factor, NULL: 1. ST_USAGE: not of this form. */
enum status frame_part_read(struct frame_part *part, const char *crop, const char *scale, struct err *err);
/* Changes the camera to that of the part, with the same rays. ST_USAGE: the crop is not inside the picture, or the size
 * of the result is not from 1 to 65536. */
enum status frame_part_camera(struct view *camera, const struct frame_part *part, struct err *err);

/* Renders the wanted frames into folder/NNNN.exr. ST_DATA: a frame sees nothing of the scene. */
enum status frames_render(const struct camera_path *path, const bool *wanted, struct renderer *renderer,
                          const char *folder, const struct provenance *prov, struct err *err);

/* Sets wanted[i] of each camera i: all cameras if count is 0, else those named. ST_USAGE: unknown name. */
enum status frame_select_cameras(bool *wanted, const struct camera_set *cameras, const char *const *names, int count,
                                 struct err *err);

/* Renders one frame per wanted camera, of the camera's size, into folder/NAME.exr. It also has the channel hole (half):
 * 1 where no view covers the pixel, before filling. A camera that sees nothing gets an empty frame and a warning. */
enum status frame_render_cameras(const struct camera_set *cameras, const bool *wanted, struct renderer *renderer,
                                 const char *folder, const struct provenance *prov, struct err *err);

#endif
