/* photo_formats.h - the readers of formats that have a file of their own: photo_tiff.c, photo_raw.c. photo.c calls them. */
#ifndef REMODEL_PHOTO_FORMATS_H
#define REMODEL_PHOTO_FORMATS_H

#include <stdbool.h>

#include "common/image/photo_data.h"

/* A TIFF, whatever is in it; ask photo_is_raw() first. */
bool photo_is_tiff(const struct photo_bytes *file);
/* pixels: else the header alone. The EXIF that is there goes to p->info. */
enum status photo_read_tiff(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);

/* A camera's raw file: by its own mark, or a TIFF whose first picture is small, a mosaic of colours, or packed by no
 * method of TIFF's own. */
bool photo_is_raw(const struct photo_bytes *file);
enum status photo_read_raw(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
/* What a TIFF says of itself that makes it a raw file: DNG's version, a reduced first picture, a mosaic, an unknown
 * method. */
bool photo_tiff_is_raw(const struct photo_bytes *file);

#endif
