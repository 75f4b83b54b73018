/* photo_formats.h - what photo.c and its readers of single formats share. */
#ifndef REMODEL_PHOTO_FORMATS_H
#define REMODEL_PHOTO_FORMATS_H

#include <stdbool.h>

#include "photo.h"

struct photo_bytes { /* a file in memory */
    const char *path;
    unsigned char *bytes; /* owned */
    size_t size;
};

/* ST_DATA unless there are 1 to 2^28 pixels. */
enum status photo_check_size(const char *path, uint64_t width, uint64_t height, struct err *err);
/* Memory for as many samples, or values, as info says. */
enum status photo_init_samples(struct photo *p, struct err *err);
enum status photo_init_values(struct photo *p, struct err *err);
/* The largest value if many have it, else 0. */
float photo_find_saturation(const struct photo *p);

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
