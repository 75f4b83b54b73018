/* run_colmap.h - COLMAP's sparse reconstruction of a set of photographs.
 *
 * COLMAP sees links with safe names (ID.EXT) in the work folder, never the photos' folder. It has no CUDA here, so
 * features and matches are made on the CPU. Its exit code alone is not trusted: what it made is counted. */
#ifndef REMODEL_RUN_COLMAP_H
#define REMODEL_RUN_COLMAP_H

#include "common/base/param.h"
#include "stages/sfm/sfm_folder.h"

#define SFM_PARAMS(X)                                                                                                 \
    X(camera_model, choice, "SIMPLE_RADIAL", 0, 0,                                                                    \
      "SIMPLE_RADIAL|SIMPLE_PINHOLE|PINHOLE|RADIAL|OPENCV|OPENCV_FISHEYE|FULL_OPENCV|EQUISOLID",                      \
      "lens model that COLMAP fits; for fisheye lenses EQUISOLID, fitted as OPENCV_FISHEYE from an equisolid start, " \
      "or OPENCV_FISHEYE")                                                                                            \
    X(camera_params, text, "", 0, 0, "",                                                                              \
      "the lens to start from, in COLMAP's order with commas, of EQUISOLID F or F,CX,CY in px; empty: from EXIF")     \
    X(refine_camera, choice, "yes", 0, 0, "yes|no", "no keeps the lens that camera_params gives")                     \
    X(single_camera, choice, "auto", 0, 0, "auto|yes|no",                                                             \
      "one lens for all photos; auto: if size, focal length and make are the same")                                   \
    X(matcher, choice, "auto", 0, 0, "auto|exhaustive|sequential",                                                    \
      "pairs to match; auto: all, or for more than 200 photos neighbours in order of name")                           \
    X(max_features, int, 8192, 100, 100000, "", "features a photo")                                                   \
    X(max_image_size, int, 3200, 200, 20000, "px", "larger photos are scaled down to this to find features")

struct sfm_params {
    SFM_PARAMS(PARAM_FIELD)
};
#define SFM_PARAMS_DEFAULT        \
    {                             \
        SFM_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param sfm_param_table[];

/* camera_params must be as many numbers as camera_model has (EQUISOLID: 1 or 3), focal lengths > 0. */
enum status sfm_params_check(const void *values, struct err *err);

/* One lens for all photos? ST_USAGE: "yes" was asked for but sizes differ. */
enum status sfm_single_camera(bool *single, const struct photo_list *photos, const struct sfm_params *params,
                              struct err *err);

/* The lens to start from, as camera_params has it, where COLMAP itself would not find it in EXIF: of PNG photos, which
 * all have one size and one known focal length on 35 mm film. "" where that is not so. */
enum { SFM_LENS_TEXT = 400 };
void sfm_png_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos, const struct sfm_params *params);

/* The start of an equisolid fisheye, r = 2 f sin(theta / 2), as OPENCV_FISHEYE's eight numbers: with the series of
 * 2 sin(theta / 2) / theta = 1 - theta^2 / 24 + theta^4 / 1920 - ... The focal length is that of camera_params, or
 * what all photos' EXIF
 * states for 35 mm film. ST_USAGE: not EQUISOLID's numbers, photos of several sizes or lenses, or no focal length. */
enum status sfm_equisolid_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos,
                               const struct sfm_params *params, struct err *err);

/* What the log of `colmap feature_extractor` says about one picture. */
struct feature_count {
    char *name;   /* owned */
    int features; /* -1: COLMAP could not read it */
};
struct feature_counts {
    struct feature_count *list;
    int count;
};
enum status feature_counts_read(struct feature_counts *c, const char *log, struct err *err);
void feature_counts_release(struct feature_counts *c);

struct sfm_input {
    const char *photos, *masks,
        *records; /* folders; masks: NULL or of ID.png (common/capture/photo_mask.h): black is not looked at */
    const struct photo_list *list;
    const struct sfm_params *params;
};

/* Adds COLMAP's models of the photos to the folder, their images named by the photos' files. ST_DATA with the likely
 * reason, by photo, if nothing could be placed. */
enum status run_colmap(struct sfm_folder *f, const struct sfm_input *in, const struct provenance *prov,
                       struct err *err);

/* Finds the points that cameras of known pose see: features and matches as above, then triangulation; poses and lenses
 * stay. Images that are none of the photos are lost. Where nothing can be found the model is left as it is, with a
 * warning. */
enum status triangulate(struct sfm_model *m, const struct sfm_folder *f, const struct sfm_input *in, struct err *err);

#endif
