/* given_read.h - depth maps that the user provides: DIR/NAME.exr or DIR/NAME.png, where NAME is a view's.
 *
 * Samples are z along the camera's axis in scene units; 0, NaN and infinity are unknown. An EXR has a channel Z, or a
 * single channel; a PNG is grey with 8 or 16 bits. DIR/depth.txt describes the samples, one line each, both optional:
 *   scale NUMBER           z is a sample times NUMBER; 1 without it, but required for PNG
 *   pixels view|photo      whether the map shows the view, or the photo that the view was made from, with its lens
 * distortion Without `pixels` the map's size decides: equal to the view, else equal to the photo, else the aspect ratio
 * of the view, else that of the photo. */
#ifndef REMODEL_GIVEN_READ_H
#define REMODEL_GIVEN_READ_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"

enum given_pixels { PIXELS_BY_SIZE, PIXELS_OF_VIEW, PIXELS_OF_PHOTO };

struct given_units {
    double scale; /* 0: not given */
    enum given_pixels pixels;
};

/* Reads depth.txt. ST_DATA with file and line. */
enum status given_units_read(struct given_units *u, const char *path, struct err *err);

/* *z: depth of each pixel of the view by the nearest sample, 0 if unknown; malloc'ed, NULL if there is no file. lens:
 * the view's, NULL if it is unknown. ST_DATA: an unreadable file, another aspect ratio, a negative depth, a PNG without
 * scale. */
enum status given_read(float **z, const char *folder, const struct view *view, const struct lens *lens,
                       struct provenance *prov, struct err *err);

#endif
