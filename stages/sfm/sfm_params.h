/* sfm_params.h - the stage's parameters. */
#ifndef REMODEL_SFM_PARAMS_H
#define REMODEL_SFM_PARAMS_H

#include <stdbool.h>

#include "common/base/param.h"
#include "common/capture/camera.h"

#define SFM_PARAMS(X)                                                                                                \
    X(camera_model, choice, "SIMPLE_RADIAL", 0, 0,                                                                   \
      "SIMPLE_RADIAL|SIMPLE_PINHOLE|PINHOLE|RADIAL|OPENCV|OPENCV_FISHEYE|FULL_OPENCV|EQUISOLID",                     \
      "lens model that COLMAP fits; for fisheye lenses OPENCV_FISHEYE, or EQUISOLID: OPENCV_FISHEYE started as "     \
      "an equisolid lens")                                                                                           \
    X(camera_params, text, "", 0, 0, "",                                                                             \
      "initial lens parameters in COLMAP's order, separated by commas; for EQUISOLID F or F,CX,CY in px; empty:"     \
      " from EXIF")                                                                                                  \
    X(refine_camera, choice, "yes", 0, 0, "yes|no", "refine the lens parameters; no keeps camera_params fixed")      \
    X(single_camera, choice, "auto", 0, 0, "auto|yes|no",                                                            \
      "one lens for all photos; auto: if all have the same size, focal length, make and model, and are of one clip " \
      "or none")

struct sfm_params {
    SFM_PARAMS(PARAM_FIELD)
};
#define SFM_PARAMS_DEFAULT        \
    {                             \
        SFM_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param sfm_param_table[];

/* camera_params must have as many numbers as camera_model (EQUISOLID: 1 or 3), with focal lengths > 0. */
enum status sfm_params_check(const void *values, struct err *err);

bool sfm_is_equisolid(const struct sfm_params *params);

/* Parses numbers separated by commas, none before the first or after the last. Returns their count, of which at most
 * CAMERA_MAX_PARAMS are stored; -1: syntax error. */
int sfm_parse_numbers(double numbers[CAMERA_MAX_PARAMS], const char *text);

#endif
