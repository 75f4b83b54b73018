/* photo_formats.h - readers of single photo formats, and EXIF: what photo.c calls in photo_jpeg.c, photo_png.c,
 * photo_tiff.c, photo_raw.c, photo_heif.c, photo_webp.c, photo_jxl.c and photo_exif.c. */
#ifndef REMODEL_PHOTO_FORMATS_H
#define REMODEL_PHOTO_FORMATS_H

#include <stdbool.h>

#include "common/image/photo_data.h"

/* Readers fill p->info, with EXIF data if there are any, and with `pixels` also the samples or values. On failure p may
 * be partly filled; the caller releases it. */
enum status photo_read_jpeg(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_png(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_tiff(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_raw(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_heif(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_webp(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_jxl(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);

/* A TIFF that is a raw file: it has a DNG version, its first image is reduced or a colour filter mosaic, or its
 * compression is unknown to libtiff. */
bool photo_tiff_is_raw(const struct photo_bytes *file);

/* Reads the EXIF data of a JPEG or PNG file into info; without any, sets the orientation to 1. ST_NOMEM. */
enum status photo_exif_read(struct photo_info *info, const struct photo_bytes *file, bool png, struct err *err);
enum { PHOTO_MAX_EXIF = 1 << 20 }; /* bytes; no camera writes more: damaged */
/* The same of an EXIF block alone, with the mark "Exif" or without. */
enum status photo_exif_take(struct photo_info *info, const unsigned char *block, size_t size, struct err *err);
/* An EXIF block for an APP1 segment: "Exif" and two zeros (PHOTO_EXIF_MARK bytes), then the TIFF block with what info
 * holds. The caller frees it. ST_NOMEM. */
enum { PHOTO_EXIF_MARK = 6 };
enum status photo_exif_block(unsigned char **block, unsigned *size, const struct photo_info *info, struct err *err);

#endif
