/* sky_luminance.h - sky, ground and sun in absolute units: cd/m2 by direction, lx on surfaces.
 *
 * Directions are unit vectors, z up. Illuminances of the sun are those of a surface that faces it. */
#ifndef REMODEL_SKY_LUMINANCE_H
#define REMODEL_SKY_LUMINANCE_H

#include "common/daylight/sky_patches.h"
#include "common/daylight/sky_standard.h"
#include "common/daylight/sun_position.h"

/* Lumens of a watt of white light: Radiance's convention (WHTEFFICACY), by which its pictures in W/m2/sr are luminances
 * in cd/m2. The irradiances of weather files have a spectrum and an efficacy of their own (sky_from_weather). */
#define WHITE_EFFICACY 179.0

#define DEW_POINT_TYPICAL 11.0 /* degrees Celsius, where none is known */
#define GROUND_TYPICAL    0.2  /* albedo of the ground outdoors */

struct sky_luminance {
    struct sky_shape shape;
    struct vec3 to_sun;
    double level;   /* cd/m2 where the shape is 1 */
    double diffuse; /* horizontal illuminance of the sky, without the sun */
    double sun;     /* illuminance of the sun on a surface that faces it; 0 below the horizon */
    double ground;  /* cd/m2: luminance below the horizon, albedo / pi x the horizontal illuminance */
};

/* Weather of an hour. */
struct sky_weather {
    double direct_normal, diffuse_horizontal; /* irradiances, W/m2 */
    double dew_point;                         /* degrees Celsius */
};

enum sky_cover { SKY_COVER_CLEAR, SKY_COVER_PARTLY, SKY_COVER_OVERCAST };

/* A sky of a standard type (SKY_TRADITIONAL for daylight factors) with a horizontal illuminance, and a sun. */
struct sky_luminance sky_of_type(int type, struct vec3 to_sun, double diffuse, double sun, double albedo);

/* A sky without a weather file: as bright as skies are on average with the sun at that height [IESNA 2000]. Its type is
 * SKY_CLEAR, 7 (partly cloudy, brighter around the sun) or SKY_TRADITIONAL. Black at night. */
struct sky_luminance sky_of_cover(enum sky_cover cover, const struct sun_position *sun, double north, double albedo);

/* The all-weather sky [Perez 1993], its illuminances by the efficacies of [Perez 1990]. Black at night. */
struct sky_luminance sky_from_weather(const struct sky_weather *w, const struct sun_position *sun, double north,
                                      double albedo);

/* cd/m2, without the sun's disk; the ground below the horizon. */
double sky_luminance_at(const struct sky_luminance *s, struct vec3 direction);
/* lx, on an unobstructed horizontal surface, the sun included. */
double sky_horizontal_illuminance(const struct sky_luminance *s);
/* Luminance of the sun's disk, cd/m2. */
double sky_sun_luminance(const struct sky_luminance *s);

/* The mean luminance of each patch, without the sun; of `patches->count` elements. The horizontal illuminance of the
 * patches is that of the sky to rounding. */
void sky_patch_luminances(double *luminance, const struct sky_patches *patches, const struct sky_luminance *s);

#endif
