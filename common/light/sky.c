/* sky.c - the procedural panorama.
 *
 * By azimuth and elevation: a sky that pales towards the horizon, with clouds; a row of buildings with windows, in
 * cells of equal azimuth; trees in front of them; fields below the horizon. Textured enough for features on it to be
 * matched between photographs. Buildings and trees are darker or brighter with the luminance of the sky. */
#include "common/light/sky.h"

#include <math.h>

#include "common/light/fast.h"
#include "common/light/value_noise.h"
#include "common/math/numbers.h"

#define BUILDINGS       54  /* cells around the horizon */
#define MAX_TREE_HEIGHT 7.3 /* degrees of elevation */

void sky_init(struct sky *sky, const struct sky_params *params)
{
    const struct sun *sun = &params->sun;
    /* the order of these products is part of the results: DEGREE would change their last bits */
    const double az = sun->azimuth * PI / 180, el = sun->elevation * PI / 180;
    *sky = (struct sky){.has_sun = params->has_sun, .has_panorama = params->has_panorama, .panorama = params->panorama};
    sky->to_sun = vec3_make(cos(el) * cos(az), cos(el) * sin(az), sin(el));
    sky->sun_cos = cos(sun->angular_radius * PI / 180);
    sky->sun_radiance = sun->radiance;
    if (params->panorama.has_shape)
        sky->at_zenith = sky_shape_luminance(&params->panorama.shape, vec3_make(0, 0, 1), sky->to_sun);
}

/* Noise around the horizon, periodic in azimuth (`turn` 0..1): two periods are blended where they meet. */
static double ring(uint32_t seed, double turn, double cells, double y)
{
    const double t = smooth_step(0.95, 1, turn), x = turn * cells;
    const double noise = noise_octaves(seed, x, y, 2);
    return t > 0 ? (1 - t) * noise + t * noise_octaves(seed, x - cells, y, 2) : noise;
}

static struct rgb panorama_radiance(const struct panorama *p, struct vec3 d)
{
    const double el = asin(fast_max(-1, fast_min(1, d.z))) * (180 / PI), turn = 0.5 + atan2(d.y, d.x) / (2 * PI);
    const double bright = rgb_luminance(p->sky);
    if (el < 0) { /* fields on a plane */
        const double near = 1 / fast_max(0.02, -d.z);
        return rgb_scale(p->ground, 0.9 + 0.5 * noise_octaves(p->seed + 5, 2 * d.x * near, 2 * d.y * near, 4));
    }
    if (el > 30) { /* above all buildings and trees */
        const double cloud =
            smooth_step(0, 0.5, noise_octaves(p->seed, 4 * d.x / (d.z + 0.3), 4 * d.y / (d.z + 0.3), 5));
        return rgb_mix(p->sky, rgb_grey(1.3 * bright), 0.45 * cloud);
    }

    const double tree_top = el > MAX_TREE_HEIGHT ? 0
                                                 : 1.6 + 4.5 * fast_max(0, ring(p->seed + 1, turn, 90, 0.5)) +
                                                       1.2 * ring(p->seed + 2, turn, 700, 0.5);
    if (el < tree_top) {
        const double leaf = ring(p->seed + 3, turn, 1100, 3 * el), lit = 0.5 + 0.5 * el / (tree_top + 0.5);
        const struct rgb green =
            rgb_mix(rgb_make(0.05, 0.09, 0.03), rgb_make(0.16, 0.2, 0.06), 0.5 + 0.5 * ring(p->seed + 4, turn, 40, 9));
        return rgb_scale(green, bright * lit * (1 + 0.8 * leaf));
    }
    const double cell = turn * BUILDINGS;
    const uint32_t house = noise_hash(p->seed, noise_floor(cell), 3);
    const double x = cell - floor(cell), top = 3 + 13 * noise_unit(house, 0) * noise_unit(house, 1);
    const double side = 0.25 * noise_unit(house, 2);
    if (el < top && x > side) {
        const double columns = 4 + floor(5 * noise_unit(house, 3)), rows = 1.1 + 0.8 * noise_unit(house, 4);
        const double fx = (x - side) / (1 - side) * columns, fy = (top - el) / rows;
        const uint32_t pane = noise_hash(house, noise_floor(fx), noise_floor(fy));
        const double wx = fabs(fx - floor(fx) - 0.5), wy = fabs(fy - floor(fy) - 0.5);
        struct rgb c = rgb_mix(rgb_make(0.42, 0.26, 0.2), rgb_make(0.5, 0.48, 0.42), noise_unit(house, 5));
        c = rgb_scale(c, 0.6 + 0.7 * noise_unit(house, 6));
        if (wx < 0.27 && wy < 0.3 && top - el > 0.4)
            c = rgb_scale(rgb_make(0.7, 0.85, 1), 0.1 + 0.6 * noise_unit(pane, 0));
        return rgb_scale(c, bright);
    }
    const double cloud = smooth_step(0.05, 0.5, ring(p->seed + 6, turn, 14, el / 9));
    const struct rgb haze = rgb_mix(p->sky, rgb_grey(1.25 * bright), 0.7 * exp(-el / 14));
    return rgb_mix(haze, rgb_grey(1.35 * bright), 0.4 * cloud);
}

static struct rgb shape_radiance(const struct sky *sky, struct vec3 d)
{
    const struct panorama *p = &sky->panorama;
    if (!(d.z > 0)) return p->ground;
    return rgb_scale(p->sky, sky_shape_luminance(&p->shape, d, sky->to_sun) / sky->at_zenith);
}

struct rgb sky_radiance(const struct sky *sky, struct vec3 direction)
{
    struct rgb c = rgb_grey(0);
    if (sky->has_panorama)
        c = sky->panorama.has_shape ? shape_radiance(sky, direction) : panorama_radiance(&sky->panorama, direction);
    if (sky->has_sun && vec3_dot(direction, sky->to_sun) > sky->sun_cos) c = rgb_add(c, sky->sun_radiance);
    return c;
}
