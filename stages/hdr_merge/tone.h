/* tone.h - 8-bit pictures of radiance in which dark and bright parts can both be seen: what structure from motion looks
 * at. */
#ifndef REMODEL_HDR_TONE_H
#define REMODEL_HDR_TONE_H

#include "common/image/image.h"

/* rgb: 3 bytes a pixel, sRGB. Radiance of 1 is white at the exposure that all views share, so that a surface looks the
 * same in all of them but for what surrounds it. Deterministic. */
enum status tone_map(unsigned char *rgb, const struct image *radiance, struct err *err);

#endif
