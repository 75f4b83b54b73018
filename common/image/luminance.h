/* luminance.h - Rec.709 luminance of scene-linear R G B.
 *
 * Pictures are summed in float, measures in double; the sums differ in their last bits, so a product keeps its form. */
#ifndef REMODEL_LUMINANCE_H
#define REMODEL_LUMINANCE_H

#define LUMINANCE_R 0.2126
#define LUMINANCE_G 0.7152
#define LUMINANCE_B 0.0722
/* initialises an array of 3 */
#define LUMINANCE_WEIGHTS                     \
    {                                         \
        LUMINANCE_R, LUMINANCE_G, LUMINANCE_B \
    }

/* summed in float */
static inline float luminance_of(const float rgb[3])
{
    return (float)LUMINANCE_R * rgb[0] + (float)LUMINANCE_G * rgb[1] + (float)LUMINANCE_B * rgb[2];
}

/* summed in double: of doubles, and of a picture's floats */
static inline double luminance_of_doubles(const double rgb[3])
{
    return LUMINANCE_R * rgb[0] + LUMINANCE_G * rgb[1] + LUMINANCE_B * rgb[2];
}
static inline double luminance_precise(const float rgb[3])
{
    return LUMINANCE_R * (double)rgb[0] + LUMINANCE_G * (double)rgb[1] + LUMINANCE_B * (double)rgb[2];
}

#endif
