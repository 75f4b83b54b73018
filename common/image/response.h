/* response.h - how a camera's samples follow light: response.txt.
 *
 *   remodel-response 1
 *   curve srgb
 * or
 *   remodel-response 1
 *   curve table 256
 *   R G B           256 lines: linear light of the samples 0/255, 1/255, ... 255/255, each column rising or level
 *
 * Between its lines a table goes linearly. Light of 1 is white by the sRGB curve; a table's own white may differ from
 * it. */
#ifndef REMODEL_RESPONSE_H
#define REMODEL_RESPONSE_H

#include <stdbool.h>

#include "common/image/photo.h"

enum { RESPONSE_LEVELS = 256 };

struct response {
    bool table; /* else the sRGB curve; {0} is sRGB */
    float light[3][RESPONSE_LEVELS];
};

/* Light of a sample, colour by colour; sample in [0, 1]. */
float response_light(const struct response *r, int colour, float sample);
/* The sample that has this light; clamps to [0, 1]. */
float response_sample(const struct response *r, int colour, float light);
/* Light of every sample of 8 or 16 bits, three tables one after the other; the caller frees them. NULL: no memory. */
float *response_tables(const struct response *r, int bits, struct err *err);

/* ST_DATA with file and line: unknown version or curve, numbers that are negative or fall. */
enum status response_read(struct response *r, const char *path, struct err *err);

#endif
