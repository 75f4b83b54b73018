/* false_colour.h - colours that stand for numbers, as 8-bit sRGB. */
#ifndef REMODEL_FALSE_COLOUR_H
#define REMODEL_FALSE_COLOUR_H

/* From dark blue-violet at 0 through red to light yellow at 1; t is clamped, and a NaN is 0. Lightness grows strictly
 * with t, so that greyscale prints keep the order. */
void colour_of_ramp(double t, unsigned char rgb[3]);

/* The n-th of a row of colours that differ from their neighbours, and all from grey and magenta. */
void colour_of_category(int n, unsigned char rgb[3]);

#endif
