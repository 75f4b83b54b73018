/* light_sampling.h - the lights of a scene as seen from a surface point: lamps, windows, the sun.
 *
 * For next-event estimation one light is chosen at a time, with a probability in proportion to an estimate of its
 * contribution; a light that cannot reach the point (behind its face, outside its cone) is never chosen. A window is a
 * portal: a direction through it is sampled, and if nothing blocks it, the sky and the sun are seen there. For rays
 * that hit a light by chance, lights_pdf_face() and lights_pdf_sky() give the density with which the light would have
 * been sampled in that direction, for multiple importance sampling of both strategies [Veach 1995]. */
#ifndef REMODEL_LIGHT_SAMPLING_H
#define REMODEL_LIGHT_SAMPLING_H

#include "stages/simulate/geometry.h"

#define MAX_LIGHTS 128

enum light_kind { LIGHT_QUAD, LIGHT_DISK, LIGHT_WINDOW, LIGHT_SUN };

struct scene_light {
    enum light_kind kind;
    struct vec3 corner; /* of quads and windows; the centre of a disk */
    struct vec3 x, y;   /* unit edges of quads and windows */
    struct vec3 n;      /* the direction in which it shines: of windows indoors; of the sun towards it */
    double width, height, area, radius; /* m, m^2; area of the sun: sr */
    double cos_cone, tan_cone, exponent;
    struct rgb radiance;
    double luminance; /* of the radiance; of a window, of the sky on average */
};

struct lights {
    struct scene_light list[MAX_LIGHTS];
    int count;
    struct sky sky;
    int *of_face; /* for each face: the index of its light, or -1; owned */
};

/* How often each light is sampled from one point of a surface. */
struct light_selection {
    struct vec3 point;
    double probability[MAX_LIGHTS]; /* they sum to 1, or are all 0 if no light reaches the point directly */
};

struct light_sample {
    struct vec3 direction; /* unit, towards the light */
    double distance;       /* INFINITY: outdoors */
    double pdf;            /* per solid angle, of all lights together */
    struct rgb radiance;   /* if nothing is in the way */
};

/* g->rays must be committed. ST_DATA: more than MAX_LIGHTS - 1 lamps and windows; ST_NOMEM. */
enum status lights_init(struct lights *l, const struct scene *s, const struct scene_geometry *g, struct err *err);
void lights_release(struct lights *l);

void lights_select(struct light_selection *c, const struct lights *l, struct vec3 point, struct vec3 normal);

/* u[0] chooses the light, u[1] and u[2] a point on it. False: no light can be seen there. */
bool lights_sample(struct light_sample *s, const struct lights *l, const struct light_selection *c, const double u[3]);

/* Density (1/sr) with which lights_sample() chooses this direction, for a ray that hit a face, or nothing. */
double lights_pdf_face(const struct lights *l, const struct light_selection *c, const struct ray_hit *hit,
                       struct vec3 direction);
double lights_pdf_sky(const struct lights *l, const struct light_selection *c, struct vec3 direction);

/* Radiance that a lamp's face emits back along a ray that hits it. */
struct rgb lights_emitted(const struct lights *l, const struct ray_hit *hit, struct vec3 direction);

/* Sampling for several surface points at once: with `chance`, the probability of each light, one place on a light is
 * chosen and seen from each point. Places on lamps and windows are uniform over their area. */
struct light_point {
    int light;
    struct vec3 at; /* of the sun: the unit direction */
};

/* u as for lights_sample(). False: all chances are 0. */
bool lights_choose_point(struct light_point *z, const struct lights *l, const double chance[MAX_LIGHTS],
                         const double u[3]);

/* The place as seen from `point`, with the density of all lights together in that direction. False: no light comes
 * from there. */
bool lights_from_point(struct light_sample *s, const struct lights *l, const double chance[MAX_LIGHTS],
                       const struct light_point *z, struct vec3 point);

/* Density (1/sr) with which a chosen place lies in this direction from `point`, for a ray that hit a lamp's face, or
 * nothing. */
double lights_point_pdf_face(const struct lights *l, const double chance[MAX_LIGHTS], struct vec3 point,
                             const struct ray_hit *hit, struct vec3 direction);
double lights_point_pdf_sky(const struct lights *l, const double chance[MAX_LIGHTS], struct vec3 point,
                            struct vec3 direction);

#endif
