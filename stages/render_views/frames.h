/* frames.h - the frames of a camera path as EXR files: R G B A (half, linear, premultiplied) and Z (float, depth in the
 * frame's camera, 0 unknown), attributes remodel:holes and remodel:unfilled (fractions of the pixels). */
#ifndef REMODEL_RENDER_VIEWS_FRAMES_H
#define REMODEL_RENDER_VIEWS_FRAMES_H

#include <stdbool.h>

#include "common/camera_path.h"
#include "common/layer_render.h"
#include "common/param.h"

#define RENDER_PARAMS(X)                                                               \
    X(soft_z, double, SOFT_Z_WIDTHS, 0, 100, "",                                       \
      "width of the soft z, in depth uncertainties; 0: the whole scene's depth range") \
    X(fill_diameter, int, 6, 0, 64, "px", "holes narrower than this are filled from around; 0: no hole is filled")

struct render_params {
    RENDER_PARAMS(PARAM_FIELD)
};
#define RENDER_PARAMS_DEFAULT        \
    {                                \
        RENDER_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param render_param_table[];

/* wanted[i] for frame i + 1 of "1:30,45": ranges and single numbers, from 1. ST_USAGE: anything else, a number that
 * is no frame of the path, an empty list. */
enum status frames_select(bool *wanted, int frame_count, const char *list, struct err *err);

/* Renders the wanted frames into folder/NNNN.exr. A frame that sees nothing of the scene is ST_DATA with its number. */
enum status frames_render(const struct camera_path *path, const bool *wanted, const struct layer_scene *scene,
                          const struct render_params *params, const char *folder, const struct provenance *prov,
                          struct err *err);

/* wanted[i] for camera i: all, or with names those. ST_USAGE: a name that is no camera. */
enum status cameras_select(bool *wanted, const struct camera_set *cameras, const char *const *names, int count,
                           struct err *err);

/* One frame a wanted camera, of its own size, into folder/NAME.exr, which also has the channel hole (half): 1 where no
 * view covers the pixel, before filling. A camera that sees nothing gets an empty frame and a warning. */
enum status cameras_render(const struct camera_set *cameras, const bool *wanted, const struct layer_scene *scene,
                           const struct render_params *params, const char *folder, const struct provenance *prov,
                           struct err *err);

#endif
