/* panorama.h - equirectangular photos (360 x 180 degrees), and the pinhole views that are cut out of them. */
#ifndef REMODEL_PANORAMA_H
#define REMODEL_PANORAMA_H

#include "stages/import_photos/import_params.h"
#include "stages/import_photos/photo_scan.h"

/* Marks the panoramas of the scan and returns their number. [import_photos] panoramas = auto: photos of 2:1 that say so
 * (GPano), or whose left edge continues the right one and whose upper and lower rows hardly vary; yes: all photos of
 * 2:1. Photos that cannot be read are none; later steps name them. */
int panorama_find(struct photo_scan *scan, const struct photo_params *params);

/* The side of the views: pixels in the middle of a view are as fine as the panorama's. */
int panorama_side(const struct photo *panorama);
/* Cuts a view (panorama_name.h) out of a photo of 8 or 16 bits. The caller releases it. */
enum status panorama_cut(struct photo *view, const struct photo *panorama, int yaw, struct err *err);

#endif
