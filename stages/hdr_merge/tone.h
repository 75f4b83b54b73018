/* tone.h - tone-maps radiance to 8 bits with detail in dark and bright parts, for structure from motion. */
#ifndef REMODEL_HDR_TONE_H
#define REMODEL_HDR_TONE_H

#include "common/image/image.h"

/* rgb gets 3 bytes per pixel, sRGB. Radiance 1 is white at the exposure shared by all views, so that a surface looks
 * the same in all of them except for the influence of its surroundings. Deterministic. */
enum status tone_map(unsigned char *rgb, const struct image *radiance, struct err *err);

#endif
