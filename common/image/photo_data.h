/* photo_data.h - photographs in memory, and helpers for the readers of their formats. */
#ifndef REMODEL_PHOTO_DATA_H
#define REMODEL_PHOTO_DATA_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/image/colour_space.h"

struct photo_info { /* unknown values are 0 or "" */
    int width, height;
    int bits;        /* of a sample: 8, 16, or 32 for linear values (EXR and raw files) */
    int orientation; /* EXIF 1..8; 1 if absent */
    double focal_mm, focal35_mm, seconds, f_number, iso;
    char make[64], model[64];
    double taken;    /* DateTimeOriginal with its sub-seconds, as seconds since 1970 by the camera's clock */
    char colour[64]; /* the colour space if it is not sRGB, as its profile calls it */
    bool adobe_rgb;  /* EXIF says so */
};

struct photo {
    struct photo_info info;
    uint16_t *samples;          /* RGB interleaved, w * h * 3, owned; 8-bit files hold 0..255, 16-bit files 0..65535 */
    uint8_t *bytes;             /* instead of samples of 8 bits if so asked; owned */
    float *values;              /* instead of samples if bits is 32: linear, finite; owned */
    float saturation;           /* the value at which `values` are clipped; 0: not clipped */
    struct colour_space *space; /* NULL: sRGB, or linear Rec.709 for values; owned */
    double transparent;         /* share of the pixels that alpha hides; samples are as if it did not */
    int pages;                  /* of a TIFF that has several photos: their number; else 0 */
    double jpeg_variance;       /* of the errors of a JPEG's luma by quantization, in sample values^2; 0: no JPEG */
};

void photo_release(struct photo *p);
void photo_release_pixels(struct photo *p); /* what is known of them stays */

struct photo_bytes { /* a file's contents in memory */
    const char *path;
    unsigned char *bytes; /* owned */
    size_t size;
};

/* ST_DATA unless the size is 1 to 2^28 pixels. */
enum status photo_check_size(const char *path, uint64_t width, uint64_t height, struct err *err);
/* Allocate samples, or values, for the size in p->info. */
enum status photo_init_samples(struct photo *p, struct err *err);
enum status photo_init_values(struct photo *p, struct err *err);
/* The largest value if more than 1 in 10 000 samples have it, else 0. */
float photo_find_saturation(const struct photo *p);
/* Copies text from a file, up to a NUL or max_length characters: only printable ASCII, without blanks at the ends. */
void photo_keep_text(char *to, size_t size, const char *from, size_t max_length);
/* The seconds since 1970 of EXIF's "2024:05:01 12:02:02" and sub-seconds "35"; 0 if the text is not a time. */
double photo_time(const char *date, const char *subseconds);

#endif
