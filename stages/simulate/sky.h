/* sky.h - what is seen outdoors, infinitely far away: sky, skyline, trees, ground, and the sun's disk. */
#ifndef REMODEL_SIMULATE_SKY_H
#define REMODEL_SIMULATE_SKY_H

#include "stages/simulate/scene_file.h"

struct sky {
    bool has_sun, has_panorama;
    struct panorama panorama;
    struct vec3 sun; /* unit vector towards it */
    double sun_cos;  /* of its angular radius */
    struct rgb sun_radiance;
};

void sky_init(struct sky *sky, const struct scene *s);
struct rgb sky_radiance(const struct sky *sky, struct vec3 direction);

#endif
