/* start_lens.h - the lens that COLMAP starts from. */
#ifndef REMODEL_START_LENS_H
#define REMODEL_START_LENS_H

#include "common/capture/photo_list.h"
#include "stages/sfm/sfm_params.h"

/* Whether all photos share one lens. ST_USAGE: single_camera is yes, but sizes differ. */
enum status sfm_single_camera(bool *single, const struct photo_list *photos, const struct sfm_params *params,
                              struct err *err);

enum { SFM_LENS_TEXT = 400 };

/* The initial parameters for COLMAP's camera model, separated by commas: camera_params, or one of the two below. "":
 * COLMAP reads the focal length from EXIF itself. Errors as of sfm_equisolid_lens(). */
enum status sfm_start_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos, const struct sfm_params *params,
                           struct err *err);

/* The PINHOLE lens of a view of a panorama; false: the photo is none. */
bool sfm_panorama_lens(char text[SFM_LENS_TEXT], const struct photo_record *photo);

/* COLMAP does not read EXIF from PNG. If all photos are PNGs of one size with the same focal length for 35 mm film,
 * text gets the parameters that COLMAP would choose for JPEGs; otherwise "". */
void sfm_png_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos, const struct sfm_params *params);

/* An equisolid fisheye as OPENCV_FISHEYE's eight parameters. The focal length is that of camera_params, otherwise the
 * one that EXIF of all photos states for 35 mm film. ST_USAGE: photos of different sizes or lenses, or no focal
 * length. */
enum status sfm_equisolid_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos,
                               const struct sfm_params *params, struct err *err);

#endif
