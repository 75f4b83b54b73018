/* photo_order.h - the photographs of a folder in the order in which the camera took them.
 *
 * By time: by EXIF's DateTimeOriginal, if all photos have it; by sub-seconds too, if more than half of the photos have
 * some. Photos of the same time are in order of the counter in their names, which wraps: 9999 precedes 0001.
 * By name: by file name, numbers by value.
 * Pictures cut out of photos are ordered lens by lens. */
#ifndef REMODEL_PHOTO_ORDER_H
#define REMODEL_PHOTO_ORDER_H

#include "stages/import_photos/photo_scan.h"

enum photo_order { ORDER_BY_TIME, ORDER_BY_NAME };

/* Puts the indices of the photos that are not excluded into `photos` (room for scan->count); *count is 0 if their times
 * are not known. ST_NOMEM. */
enum status photo_order_find(int *photos, int *count, const struct photo_scan *scan, enum photo_order order,
                             struct err *err);

#endif
