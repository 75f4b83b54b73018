/* colour_space.h - what the numbers of a photo mean: from an ICC profile, from primaries and a gamma, or from codes.
 *
 * Everything becomes linear Rec.709 (the primaries of sRGB). Colours outside of it have components below 0, and light
 * brighter than white, as HDR photos have it, is above 1. */
#ifndef REMODEL_COLOUR_SPACE_H
#define REMODEL_COLOUR_SPACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "common/base/err.h"

/* A space other than sRGB. Photos in sRGB have none. */
struct colour_space {
    char name[64];      /* as its profile calls it, or what gave it */
    unsigned char *icc; /* the profile; NULL if codes gave it; owned */
    size_t icc_size;
    int primaries, transfer; /* codes of ITU-T H.273; 0 if a profile gave it */
    int levels;              /* of a sample: 256 or 65536; 1: values, which are linear */
    float *light;            /* linear light of every level: three tables, red first; NULL for values; owned */
    double matrix[3][3];     /* from that light to linear Rec.709 */
};

/* x and y of red, green, blue and white. */
struct chromaticities {
    double xy[4][2];
};

/* Each gives *space, which the caller releases; NULL: it is sRGB, to half a per cent. bits: 8 or 16 of samples, 32 for
 * values, which are linear. ST_DATA: the space is damaged or unknown. */

/* Of an ICC profile. *tables: the profile is one of tables, and *space that of samples which colour_space_widen() has
 * converted. ST_DATA with the photo's path: a damaged profile, or one for something else than RGB and grey. */
enum status colour_space_from_icc(struct colour_space **space, bool *tables, const unsigned char *icc, size_t size,
                                  int bits, const char *path, struct err *err);
/* Of primaries and a gamma (1: linear, 0: the curve of sRGB), with white adapted by Bradford's transform. */
enum status colour_space_from_primaries(struct colour_space **space, const struct chromaticities *primaries,
                                        double gamma, int bits, const char *name, struct err *err);
/* Of the codes that HEIC, AVIF, PNG and videos have [ITU 2021]; unspecified ones (2) are those of sRGB. */
enum status colour_space_from_codes(struct colour_space **space, int primaries, int transfer, int bits,
                                    const char *path, struct err *err);
/* Adobe RGB (1998), which many cameras name only in EXIF. */
enum status colour_space_adobe(struct colour_space **space, int bits, struct err *err);
void colour_space_release(struct colour_space *space); /* NULL is allowed */

/* Converts samples of 8 or 16 bits by a profile of tables, to 16 bits in a space that holds all colours of surfaces. */
enum status colour_space_widen(uint16_t *samples, size_t pixels, int bits, const unsigned char *icc, size_t size,
                               const char *path, struct err *err);

/* Whether two photos are in one space; NULL is sRGB. */
bool colour_space_same(const struct colour_space *a, const struct colour_space *b);
/* The light of the largest sample: 1 but for HDR photos; NULL is sRGB. */
float colour_space_white(const struct colour_space *space);
/* Takes linear light of the space to linear Rec.709, in place, with several threads. */
void colour_space_to_rec709(const struct colour_space *space, float *rgb, size_t pixels);

#endif
