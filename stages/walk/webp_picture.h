/* webp_picture.h - pictures as WebP in base64, which every browser decodes. */
#ifndef REMODEL_WEBP_PICTURE_H
#define REMODEL_WEBP_PICTURE_H

#include <stdbool.h>
#include <stdio.h>

#include "common/base/err.h"

/* Encodes 8-bit RGBA: colours with loss, alpha without. The caller frees *bytes. Same bytes for the same pixels.
 * quality: 1 to 100; effort: 0 to 6. */
enum status webp_picture_encode(unsigned char **bytes, size_t *size, const unsigned char *rgba, int width, int height,
                                int quality, int effort, struct err *err);

#endif
