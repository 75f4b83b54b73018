/* sky_standard.c - how the luminance of a sky varies with direction.
 *
 * Mathematics. [CIE 2003]: at angle z from the zenith and chi from the sun, luminance is f(chi) phi(z), with gradation
 * phi(z) = 1 + a exp(b / cos z) and indicatrix f(chi) = 1 + c (exp(d chi) - exp(d pi / 2)) + e cos^2 chi. All-weather
 * skies [Perez 1993] have the same form, without the second exponential of f. The overcast sky of [Moon 1942] has its
 * own; the standard keeps it as type 16.
 *
 * The horizontal illuminance is the integral over the sky of luminance times the sine of the altitude. A grid in
 * altitude and azimuth samples the luminance at the middles of its cells, each of which has its integral of the sine in
 * closed form. A sky is symmetric about the plane through zenith and sun, so that half of the azimuths do. Columns are
 * narrower near the sun, where skies have a peak. */
#include "common/daylight/sky_standard.h"

#include "common/math/numbers.h"

enum { ROWS = 48, COLUMNS = 48 };
static const double HORIZON = 0.01; /* cosine to the zenith below which the sky stays the same */

/* The standard's table 1: a, b of the gradation, c, d, e of the indicatrix. */
static const double types[SKY_TYPES][5] = {
    {4, -0.70, 0, -1, 0},       {4, -0.70, 2, -1.5, 0.15},  {1.1, -0.8, 0, -1, 0},       {1.1, -0.8, 2, -1.5, 0.15},
    {0, -1, 0, -1, 0},          {0, -1, 2, -1.5, 0.15},     {0, -1, 5, -2.5, 0.30},      {0, -1, 10, -3, 0.45},
    {-1, -0.55, 2, -1.5, 0.15}, {-1, -0.55, 5, -2.5, 0.30}, {-1, -0.55, 10, -3, 0.45},   {-1, -0.32, 10, -3, 0.45},
    {-1, -0.32, 16, -3, 0.30},  {-1, -0.15, 16, -3, 0.30},  {-1, -0.15, 24, -2.8, 0.15},
};

struct sky_shape sky_standard_shape(int type)
{
    if (type == SKY_TRADITIONAL) return (struct sky_shape){.traditional = true};
    const double *t = types[type - 1];
    return (struct sky_shape){t[0], t[1], t[2], t[3], t[4], exp(t[3] * PI / 2), false};
}

bool sky_standard_needs_sun(int type)
{
    return type <= SKY_TYPES && (types[type - 1][2] != 0 || types[type - 1][4] != 0);
}

static double luminance_at(const struct sky_shape *s, double up, double cos_sun)
{
    if (s->traditional) return (1 + 2 * fmax(up, 0)) / 3;
    const double chi = acos(clamp(cos_sun, -1, 1));
    const double gradation = 1 + s->a * exp(s->b / fmax(up, HORIZON));
    const double indicatrix = 1 + s->c * (exp(s->d * chi) - s->beside) + s->e * cos(chi) * cos(chi);
    return fmax(gradation * indicatrix, 0);
}

double sky_shape_luminance(const struct sky_shape *s, struct vec3 direction, struct vec3 to_sun)
{
    return luminance_at(s, direction.z, vec3_dot(direction, to_sun));
}

double sky_standard(int type, struct vec3 direction, struct vec3 to_sun)
{
    const struct sky_shape shape = sky_standard_shape(type);
    return sky_shape_luminance(&shape, direction, to_sun);
}

static double square(double x) { return x * x; }

double sky_shape_illuminance(const struct sky_shape *s, struct vec3 to_sun)
{
    const double sun_up = to_sun.z, sun_level = sqrt(fmax(1 - sun_up * sun_up, 0));
    double sum = 0;
    for (int row = 0; row < ROWS; row++) {
        const double altitude = (row + 0.5) / ROWS * PI / 2, up = sin(altitude), level = cos(altitude);
        double of_row = 0;
        for (int column = 0; column < COLUMNS; column++) {
            const double u = (column + 0.5) / COLUMNS, turn = PI * u * u; /* from the sun; its width grows as 2 u */
            of_row += 2 * u * luminance_at(s, up, up * sun_up + level * sun_level * cos(turn));
        }
        sum += (square(sin((row + 1.0) / ROWS * PI / 2)) - square(sin((double)row / ROWS * PI / 2))) * of_row;
    }
    return PI * sum / COLUMNS;
}
