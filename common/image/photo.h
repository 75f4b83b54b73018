/* photo.h - photographs as cameras store them: JPEG, PNG, TIFF with EXIF, raw files, EXR; and pictures for people to
 * look at.
 *
 * Rows are those of the stored file: EXIF orientation is reported, never applied. */
#ifndef REMODEL_PHOTO_H
#define REMODEL_PHOTO_H

#include "common/image/image.h"
#include "common/image/photo_data.h"

/* JPEG, PNG and TIFF of 8 or 16 bits. Errors name the file and say what to do: another format (by content, not by
 * name), empty, truncated (a JPEG that ends early is an error, not a grey lower half), CMYK or YCCK, larger than 2^28
 * pixels, a size of 0. Grey becomes RGB; alpha is dropped. */
enum status photo_read(struct photo *p, const char *path, struct err *err);
/* EXR and raw files too, whose light is linear (info.bits 32). An EXR with many samples at its largest value, 1 in
 * 10 000, is cut there; else nothing in it saturates. Raw files are developed by libraw: common/image/photo_raw.c says how. */
enum status photo_read_any(struct photo *p, const char *path, struct err *err);
enum status photo_read_info(struct photo_info *info, const char *path, struct err *err); /* of any; headers only */

/* 3 channels, linearised by the sRGB curve: white is 1. p has samples. */
enum status photo_to_linear(struct image *out, const struct photo *p, struct err *err);

/* 8-bit RGB (channels 3) or grey (1), through an outfile. quality: 1..100. Deterministic bytes. */
enum status png_write(const char *path, const unsigned char *pixels, int width, int height, int channels,
                      struct err *err);
enum status jpeg_write(const char *path, const unsigned char *rgb, int width, int height, int quality, struct err *err);
/* A JPEG as a camera stores it: with EXIF of what `info` says (make, model, orientation, focal lengths, exposure time,
 * f-number, ISO speed; 0 and "" are left out). Its width, height and bits are not looked at. */
enum status photo_write_jpeg(const char *path, const unsigned char *rgb, int width, int height, int quality,
                             const struct photo_info *info, struct err *err);
/* A rectangle of the photo's pixels as they are, 8 or 16 bits, as PNG with the same EXIF as above. Its samples read
 * back are the photo's. */
enum status photo_write_part(const char *path, const struct photo *p, int x, int y, int width, int height,
                             const struct photo_info *info, struct err *err);
/* JPEG in memory; *bytes is malloc'ed, the caller frees it. */
enum status jpeg_encode(unsigned char **bytes, size_t *size, const unsigned char *rgb, int width, int height,
                        int quality, struct err *err);

#endif
