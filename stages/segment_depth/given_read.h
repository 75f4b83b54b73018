/* given_read.h - depth that a user brings: DIR/NAME.exr or DIR/NAME.png, NAME being a view's.
 *
 * Samples are z along the camera's axis in scene units, 0, NaN and infinity unknown. An EXR's channel is Z, or the only one;
 * a PNG is grey, 8 or 16 bit. DIR/depth.txt tells what samples mean, a line each, both may be missing:
 *   scale NUMBER           z is a sample times NUMBER; without it 1, but a PNG must have it
 *   pixels view|photo      the picture is of the view, or of the photo that the view was made from, with its lens
 * Without `pixels` the size tells: the view's own, then the photo's own, then the aspect ratio of the view, then of the photo. */
#ifndef REMODEL_GIVEN_READ_H
#define REMODEL_GIVEN_READ_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"

enum given_pixels { PIXELS_BY_SIZE, PIXELS_OF_VIEW, PIXELS_OF_PHOTO };

struct given_units {
    double scale; /* 0: not told */
    enum given_pixels pixels;
};

/* ST_DATA with file and line. */
enum status given_units_read(struct given_units *u, const char *path, struct err *err);

/* *z: of each pixel of the view the nearest sample, 0 where it is unknown; the caller frees it; NULL if there is no file. lens: of the
 * view, NULL if it is not known. ST_DATA: the file cannot be read, has another aspect ratio, a depth below 0, a PNG without
 * scale. */
enum status given_read(float **z, const char *folder, const struct view *view, const struct lens *lens,
                       struct provenance *prov, struct err *err);

#endif
