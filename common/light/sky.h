/* sky.h - radiance of the outdoors by direction: a procedural panorama of sky, skyline, trees and ground, or one of the
 * CIE's skies above a level ground, and the sun's disk.
 *
 * Everything is infinitely far away. Directions are unit vectors with z up; azimuth counts from x towards y. Radiance
 * is scene-linear Rec.709, in the scene's unit. */
#ifndef REMODEL_SKY_H
#define REMODEL_SKY_H

#include <stdbool.h>
#include <stdint.h>

#include "common/daylight/sky_standard.h"
#include "common/light/colour.h"
#include "common/math/vec.h"

struct sun {
    double azimuth, elevation, angular_radius; /* degrees */
    struct rgb radiance;                       /* of the disk */
};

struct panorama {
    uint32_t seed;          /* of clouds, houses and trees */
    struct rgb sky, ground; /* radiance, on average: at the zenith, and below the horizon */
    bool has_shape;         /* a sky of this shape alone; the ground is level */
    struct sky_shape shape;
};

struct sky_params {
    bool has_sun, has_panorama; /* without a panorama the sky is black */
    struct sun sun;
    struct panorama panorama;
};

struct sky {
    bool has_sun, has_panorama;
    struct panorama panorama;
    double at_zenith;   /* of its shape */
    struct vec3 to_sun; /* unit vector to the centre of the disk */
    double sun_cos;     /* cosine of its angular radius */
    struct rgb sun_radiance;
};

/* Nothing to release. */
void sky_init(struct sky *sky, const struct sky_params *params);

struct rgb sky_radiance(const struct sky *sky, struct vec3 direction);

#endif
