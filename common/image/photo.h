/* photo.h - reads photographs (JPEG, PNG, TIFF, HEIC, AVIF, WebP, JPEG XL, raw files, EXR) with their EXIF data;
 * writes JPEG and PNG.
 *
 * Rows are in the order of the file: EXIF orientation is reported, never applied, but for its mirror: rows of mirrored
 * photos (2, 4, 5, 7) are reversed, and the turn that is left is reported. HEIC and AVIF stand upright. */
#ifndef REMODEL_PHOTO_H
#define REMODEL_PHOTO_H

#include "common/base/provenance.h"
#include "common/image/image.h"
#include "common/image/photo_data.h"

/* Reads JPEG, PNG, TIFF, HEIC, AVIF, WebP and JPEG XL of 8 or 16 bits. Grey becomes RGB; alpha is dropped,
 * but counted (p->transparent) for PNG, TIFF and WebP.
 * ST_DATA, naming the file and what to do: another format (by content, not by name), an empty or truncated file (a
 * JPEG that ends early is an error, not a grey lower half), CMYK or YCCK, no pixels or more than 2^28. On failure p
 * is empty. */
enum status photo_read(struct photo *p, const char *path, struct err *err);
/* The same, recorded in prov as `name`. */
enum status photo_read_input(struct photo *p, const char *path, const char *name, struct provenance *prov,
                             struct err *err);
/* The same, recorded in prov as `name`. A JPEG has bytes instead of samples, which take half of the memory. */
enum status photo_read_compact(struct photo *p, const char *path, const char *name, struct provenance *prov,
                               struct err *err);
/* Reads EXR, TIFF of floating-point samples and raw files too, which are linear (info.bits 32). An EXR with more than
 * 1 in 10 000 samples at its largest value counts as clipped there, otherwise as unclipped. Raw files are developed by
 * libraw as described in photo_raw.c. */
enum status photo_read_any(struct photo *p, const char *path, struct err *err);
/* The same, but a JPEG with a gain map becomes its linear HDR (info.bits 32), in Rec.709. ST_DATA: the map is missing
 * or damaged. */
enum status photo_read_hdr(struct photo *p, const char *path, struct err *err);
/* As photo_read_any(), or with gain maps photo_read_hdr(), but keeps no pixels: a large JPEG takes little memory. */
enum status photo_check(struct photo *p, const char *path, bool gain_maps, struct err *err);
/* Any format; these read headers only. */
enum status photo_read_info(struct photo_info *info, const char *path, struct err *err);
enum status photo_read_hdr_info(struct photo_info *info, const char *path, struct err *err); /* of photo_read_hdr() */
/* A JPEG in memory, into bytes; `name` is for errors. ST_DATA: it is damaged. */
enum status photo_decode_jpeg(struct photo *p, const unsigned char *bytes, size_t size, const char *name,
                              struct err *err);

/* Linear Rec.709, by the photo's colour space or the sRGB curve: 3 channels, white is 1; colours outside of Rec.709
 * have components below 0. p must have samples. */
enum status photo_to_linear(struct image *out, const struct photo *p, struct err *err);

/* The same of parts. {0} is the empty state; the photo must stay. */
struct photo_light {
    const struct photo *photo;
    const float *curves[3]; /* of red, green, blue */
    float *curve;           /* that of sRGB; owned */
};
enum status photo_light_init(struct photo_light *l, const struct photo *p, struct err *err);
/* `count` pixels from pixel `first` on, in order of rows. The same values as photo_to_linear(). */
void photo_light_take(const struct photo_light *l, float *rgb, size_t first, size_t count);
void photo_light_release(struct photo_light *l);

/* Write 8-bit RGB (channels 3) or grey (1) through an outfile. quality: 1..100. The same pixels give the same bytes. */
enum status png_write(const char *path, const unsigned char *pixels, int width, int height, int channels,
                      struct err *err);
enum status jpeg_write(const char *path, const unsigned char *rgb, int width, int height, int quality, struct err *err);
/* Writes a JPEG with the EXIF data of `info`: make, model, time taken, orientation, focal lengths, exposure time,
 * f-number, ISO speed; 0 and "" are omitted. Ignores width, height and bits of info. */
enum status photo_write_jpeg(const char *path, const unsigned char *rgb, int width, int height, int quality,
                             const struct photo_info *info, struct err *err);
/* Writes a rectangle of the photo as PNG of 8 or 16 bits, with EXIF data as above. Samples are unchanged. */
enum status photo_write_part(const char *path, const struct photo *p, int x, int y, int width, int height,
                             const struct photo_info *info, struct err *err);
/* Encodes a JPEG in memory. The caller frees *bytes. */
enum status jpeg_encode(unsigned char **bytes, size_t *size, const unsigned char *rgb, int width, int height,
                        int quality, struct err *err);

#endif
