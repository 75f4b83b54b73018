/* photo_formats.h - readers of single photo formats, and EXIF: what photo.c calls in photo_jpeg.c, photo_png.c,
 * photo_tiff.c, photo_raw.c, photo_heif.c, photo_webp.c, photo_jxl.c, photo_gain.c, photo_colour.c, photo_exif.c. */
#ifndef REMODEL_PHOTO_FORMATS_H
#define REMODEL_PHOTO_FORMATS_H

#include <stdbool.h>

#include "common/image/photo_data.h"

/* Readers fill p->info, with EXIF data if there are any, and with `pixels` also the samples or values. On failure p may
 * be partly filled; the caller releases it. */
enum photo_want {
    PHOTO_HEADER,
    PHOTO_CHECK, /* decodes the pixels, to find damages, and keeps none */
    PHOTO_SAMPLES,
    PHOTO_BYTES, /* in p->bytes; samples if the photo's space needs 16 bits */
};
enum status photo_read_jpeg(struct photo *p, const struct photo_bytes *file, enum photo_want want, struct err *err);
enum status photo_read_png(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_tiff(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_raw(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_heif(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_webp(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);
enum status photo_read_jxl(struct photo *p, const struct photo_bytes *file, bool pixels, struct err *err);

/* Give p what its file says of its colours; readers call one of them last, with `pixels` after the samples are read. */
/* ICC bytes; size 0: none, then EXIF decides. Samples of a profile of tables become 16 bits. ST_DATA with the path. */
enum status photo_set_icc(struct photo *p, const unsigned char *icc, size_t size, bool pixels, const char *path,
                          struct err *err);
/* Codes of ITU-T H.273. */
enum status photo_set_codes(struct photo *p, int primaries, int transfer, const char *path, struct err *err);
/* gamma: 0: the curve of sRGB. */
enum status photo_set_primaries(struct photo *p, const struct chromaticities *primaries, double gamma, const char *name,
                                const char *path, struct err *err);

/* Gives a JPEG that has a gain map its linear HDR: info.bits becomes 32, and values replace the samples, if it has any.
 * A photo without one stays as it is. ST_DATA with the path: the map is missing or damaged. */
enum status photo_apply_gain(struct photo *p, const struct photo_bytes *file, enum photo_want want, struct err *err);

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
