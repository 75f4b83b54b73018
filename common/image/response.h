/* response.h - the response curve of a camera, from sample to light: response.txt.
 *
 *   remodel-response 1
 *   curve srgb
 * or
 *   remodel-response 1
 *   curve table 256
 *   R G B           256 lines: linear light of the samples 0/255, 1/255, ... 255/255; no column may fall
 *
 * A table is interpolated linearly. Light of 1 is white by the sRGB curve; white by a table may differ from 1. */
#ifndef REMODEL_RESPONSE_H
#define REMODEL_RESPONSE_H

#include <stdbool.h>

#include "common/image/photo.h"
#include "common/product/product.h"

enum { RESPONSE_LEVELS = 256 };

struct response {
    bool table; /* false: the curve of `space` or of sRGB, which {0} is */
    float light[3][RESPONSE_LEVELS];
    const struct colour_space *space; /* of samples; not owned; may be NULL */
};

/* Linear light of a sample in [0, 1]. colour: 0 red, 1 green, 2 blue. */
float response_light(const struct response *r, int colour, float sample);
/* Light of every sample of 8 or 16 bits: three tables in a row, red first. The caller frees them. NULL: ST_NOMEM is
 * set. */
float *response_tables(const struct response *r, int bits, struct err *err);

/* ST_DATA with file and line: unknown version or curve, a negative number, a curve that falls or is constant. */
enum status response_read(struct response *r, const char *path, struct provenance *prov, struct err *err);

#endif
