/* luma.h - Rec.709 luma of display values R G B: grey pictures of photographs.
 *
 * Weights are 218, 732 and 74 of 1024, so that 8 bits give the same bytes on every machine. */
#ifndef REMODEL_LUMA_H
#define REMODEL_LUMA_H

#include <stdint.h>

/* of 8 bits, rounded */
static inline unsigned char luma_of(const unsigned char rgb[3])
{
    return (unsigned char)((218u * rgb[0] + 732u * rgb[1] + 74u * rgb[2] + 512u) >> 10);
}

/* of samples whose largest value is 2^(8 + shift) - 1, as 8 bits: rounded, at most 255 */
static inline unsigned char luma_of_samples(const uint16_t rgb[3], unsigned shift)
{
    const unsigned luma = (218u * rgb[0] + 732u * rgb[1] + 74u * rgb[2] + (512u << shift)) >> (10 + shift);
    return (unsigned char)(luma > 255 ? 255 : luma);
}

#endif
