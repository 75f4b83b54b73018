/* view_image.h - the picture of a rectified view: out/SCENE/views/VIEW.exr, scene-linear R G B (half), A (half, 1
 * inside the photo); sigma (half), the standard deviation of the luminance divided by it, up to 1; clipped (half), the
 * sum of PHOTO_BRIGHT and PHOTO_DARK. */
#ifndef REMODEL_VIEW_IMAGE_H
#define REMODEL_VIEW_IMAGE_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"
#include "common/capture/photo_quality.h"
#include "common/image/exr.h"
#include "common/image/image.h"

/* The channels of the file, in the order of enum view_channel. */
enum view_channel { VIEW_R, VIEW_G, VIEW_B, VIEW_A, VIEW_SIGMA, VIEW_CLIPPED, VIEW_CHANNELS };
struct view_planes {
    struct exr_image exr;
    const float *channel[VIEW_CHANNELS]; /* of exr */
};

/* Reads the first `count` channels of FOLDER/VIEW.exr. p is {0} on entry; the caller releases it in each case. ST_DATA:
 * the size differs from the camera's; a channel is missing, or has integers. */
enum status view_planes_read(struct view_planes *p, const char *folder, const struct view *view, int count,
                             struct provenance *prov, struct err *err);
void view_planes_release(struct view_planes *p);

/* 4 channels R G B A. ST_DATA: the size differs from the camera's. */
enum status view_image_read(struct image *im, const char *folder, const struct view *view, struct provenance *prov,
                            struct err *err);
/* quality: noise and marks of the pixels, for the channels sigma and clipped; NULL: without them. */
enum status view_image_write(const struct image *im, const struct photo_quality *quality, const char *path,
                             const struct view *view, const struct provenance *prov, const char *radiometry,
                             struct err *err);

/* Sets the EXR's worldToCamera from the view. */
void view_image_set_camera(struct exr_image *im, const struct view *view);

#endif
