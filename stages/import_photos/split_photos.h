/* split_photos.h - cuts photographs of a multi-lens camera into their pictures, which later steps use as the photos.
 *
 * The pictures of photo ID are ID_c1r1.png, ID_c2r1.png ... (column, row, from 1, in the photo as stored). Apart from
 * split.txt their folder contains nothing else. Their samples are the photo's, of 8 or 16 bits. They have the EXIF
 * values of the photo that this program reads; the focal length for 35 mm film is adapted to their smaller diagonal, so
 * that the angle per pixel stays the same. A picture is cut again only if its photo, the grid or the file itself has
 * changed. */
#ifndef REMODEL_SPLIT_PHOTOS_H
#define REMODEL_SPLIT_PHOTOS_H

#include "stages/import_photos/photo_scan.h"
#include "stages/import_photos/split_grid.h"

/* Photos of the scan that cannot be cut have `err` set. ST_DATA: some photos cannot be cut, or there are none;
 * split.txt then stays unchanged. Pictures of removed or excluded photos are deleted. */
enum status split_photos(struct photo_scan *scan, const struct split_grid *grid, const char *out, struct err *err);

#endif
