/* lights.h - what light is looked for at, from a point of a surface: lamps, windows, the sun.
 *
 * A window is a portal: a direction through it is chosen, and if nothing stands in the way the sky and the sun are seen
 * there. One light is chosen at a time, by a guess of what it gives; a light that cannot reach the point (behind its
 * face, out of its cone) is not chosen. Rays that meet a light by chance ask lights_pdf() for the density with which it
 * would have been chosen, so that both ways can be weighed (E. Veach, 1995). */
#ifndef REMODEL_SIMULATE_LIGHTS_H
#define REMODEL_SIMULATE_LIGHTS_H

#include "common/light/sky.h"
#include "stages/simulate/geometry.h"

#define MOST_LIGHTS 32

enum light_kind { LIGHT_QUAD, LIGHT_DISK, LIGHT_WINDOW, LIGHT_SUN };

struct scene_light {
    enum light_kind kind;
    struct vec3 corner, x, y,
        n; /* quads, windows: unit edges x, y; disks: centre in corner; n: where it shines, of windows indoors */
    double width, height, area, radius; /* m */
    double cos_cone, tan_cone, exponent;
    struct rgb radiance;
    double luminance; /* expected; of a window the sky's */
};

struct lights {
    struct scene_light list[MOST_LIGHTS];
    int count;
    struct sky sky;
    int *of_face; /* which light a face is; -1: none; owned */
};

/* What the lights promise to one point of a surface. */
struct light_chances {
    struct vec3 point;
    double chance[MOST_LIGHTS]; /* sum to 1, or are all 0: no light reaches the point directly */
};

struct light_sample {
    struct vec3 direction; /* towards the light */
    double distance;       /* INFINITY: outdoors */
    double pdf;            /* per solid angle, of all lights together */
    struct rgb radiance;   /* if nothing stands in the way */
};

/* The geometry must be committed. ST_DATA: more than MOST_LIGHTS lamps and windows. */
enum status lights_init(struct lights *l, const struct scene *s, const struct scene_geometry *g, struct err *err);
void lights_release(struct lights *l);

void lights_chances(struct light_chances *c, const struct lights *l, struct vec3 point, struct vec3 normal);

/* For a number that chooses the light and two that choose a place on it. False: no light there. */
bool lights_sample(struct light_sample *s, const struct lights *l, const struct light_chances *c, const double u[3]);

/* The density with which a lamp's face, or the outdoors, would have been chosen in this direction. */
double lights_pdf_face(const struct lights *l, const struct light_chances *c, const struct ray_hit *hit,
                       struct vec3 direction);
double lights_pdf_sky(const struct lights *l, const struct light_chances *c, struct vec3 direction);

/* What a lamp's face emits against a ray that hits it. */
struct rgb lights_emitted(const struct lights *l, const struct ray_hit *hit, struct vec3 direction);

#endif
