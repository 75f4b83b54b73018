/* photo_data.h - a photograph in memory, and what readers of its formats share. */
#ifndef REMODEL_PHOTO_DATA_H
#define REMODEL_PHOTO_DATA_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/err.h"

struct photo_info { /* 0 or "" where the file does not say */
    int width, height;
    int bits;        /* a sample: 8 or 16; 32: linear already, as EXR and raw files are */
    int orientation; /* EXIF 1..8; 1 if absent */
    double focal_mm, focal35_mm, seconds, f_number, iso;
    char make[64], model[64];
};

struct photo {
    struct photo_info info;
    uint16_t *samples; /* RGB interleaved, w * h * 3, owned; 8-bit files hold 0..255, 16-bit files 0..65535 */
    float *values;     /* in place of samples where bits is 32: linear, finite, not negative; owned */
    float saturation;  /* what values are cut at; 0: they are not */
};

void photo_release(struct photo *p);

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
/* What a file says of itself: up to a NUL, and `most` characters; the printable ASCII of it, no blanks at its ends. */
void photo_keep_text(char *to, size_t size, const char *from, size_t most);

#endif
