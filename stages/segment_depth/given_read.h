/* given_read.h - depth maps that the user provides: DIR/NAME.exr, .png, .pfm, .tif or .tiff, where NAME is a view's.
 *
 * Samples are z along the camera's axis in scene units; 0, NaN, infinity and sentinels (given_map.h) are unknown.
 * DIR/depth.txt describes the samples, one line each, all optional:
 *   scale NUMBER            z is a sample times NUMBER; 1 without it, but required for whole numbers (PNG, some TIFF)
 *   samples depth|disparity disparity: z is NUMBER divided by a sample; without a scale it follows from sparse points
 *   pixels view|photo       whether the map shows the view, or the photo that the view was made from, with its lens
 *                           distortion
 * Without `pixels` the map's size decides: equal to the view, else equal to the photo, else the aspect ratio of the
 * view, else that of the photo. */
#ifndef REMODEL_GIVEN_READ_H
#define REMODEL_GIVEN_READ_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"

enum given_pixels { PIXELS_BY_SIZE, PIXELS_OF_VIEW, PIXELS_OF_PHOTO };

enum given_samples { SAMPLES_UNSAID, SAMPLES_DEPTH, SAMPLES_DISPARITY };

struct given_units {
    double scale; /* 0: not given */
    enum given_samples samples;
    enum given_pixels pixels;
};

/* Reads depth.txt. ST_DATA with file and line. */
enum status given_units_read(struct given_units *u, const char *path, struct err *err);

/* What was read. z: of each pixel of the view by the nearest sample, 0 if unknown; malloc'ed, NULL if there is no file.
 * disparity: that is what depth.txt says; without a scale, which `relative` says, z is the disparity itself. */
struct given {
    float *z;
    bool disparity, relative;
};

/* lens: the view's, NULL if it is unknown. lone: the view is the only one of its scene, so that its scale is free, and
 * `folder` may be a file. ST_DATA: an unreadable file, another aspect ratio, a negative depth, whole numbers without
 * scale, or of a lone view without a line `samples`. */
enum status given_read(struct given *g, const char *folder, const struct view *view, const struct lens *lens, bool lone,
                       struct provenance *prov, struct err *err);

#endif
