/* split_photos.h - cuts photographs of a multi-lens camera into their pictures, which are photos from then on.
 *
 * The pictures of photo ID are ID_c1r1.png, ID_c2r1.png ... (column, row, from 1, as the photo is stored) in a folder that holds
 * nothing else but split.txt. Their samples are the photo's own, of 8 or 16 bits. They bear its EXIF as far as this
 * program reads it; what its focal length equals on 35 mm film is told for their smaller diagonal, so that it means the same angle
 * for every pixel. A picture is cut again only if its photo, the grid or the file itself has changed. */
#ifndef REMODEL_SPLIT_PHOTOS_H
#define REMODEL_SPLIT_PHOTOS_H

#include "stages/import_photos/photo_scan.h"
#include "stages/import_photos/split_grid.h"

/* Photos of the scan that cannot be cut have `err` set. ST_DATA: there are such, or no photo at all; then what was cut before
 * stays listed. Pictures of photos that are there no more, or are left out, are removed. */
enum status split_photos(struct photo_scan *scan, const struct split_grid *grid, const char *out, struct err *err);

#endif
