/* false_colour.c - see false_colour.h.
 *
 * The ramp is a path through OKLab [Ottosson 2020]: lightness linear in t, hue from blue-violet through red to yellow,
 * chroma within sRGB's gamut. So equal steps of t look equal. */
#include "common/image/false_colour.h"

#include <math.h>

#include "common/image/image.h"
#include "common/math/numbers.h"

static void colour_from_oklab(double light, double a, double b, unsigned char rgb[3])
{
    double l = pow(light + 0.3963377774 * a + 0.2158037573 * b, 3);
    double m = pow(light - 0.1055613458 * a - 0.0638541728 * b, 3);
    double s = pow(light - 0.0894841775 * a - 1.2914855480 * b, 3);
    double linear[3] = {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                        -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
    for (int c = 0; c < 3; c++) rgb[c] = (unsigned char)(255 * srgb_from_linear((float)linear[c]) + 0.5f);
}

void colour_of_ramp(double t, unsigned char rgb[3])
{
    t = t > 0 ? t < 1 ? t : 1 : 0;
    double light = 0.20 + 0.72 * t, hue = (285 + 165 * t) * DEGREE;
    double chroma = 0.095 + 0.42 * t * pow(1 - t, 1.5), a = chroma * cos(hue), b = chroma * sin(hue);
    colour_from_oklab(light, a, b, rgb);
}

/* Steps of the golden ratio spread any number of hues evenly; magenta is at 328 degrees. */
void colour_of_category(int n, unsigned char rgb[3])
{
    static const double LIGHT[3] = {0.72, 0.60, 0.84};
    const double turn = 0.6180339887498949 * n, hue = (30 + 250 * (turn - floor(turn))) * DEGREE;
    colour_from_oklab(LIGHT[n % 3], 0.13 * cos(hue), 0.13 * sin(hue), rgb);
}
