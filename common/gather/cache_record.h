/* cache_record.h - indirect irradiance at a point with its gradients. */
#ifndef REMODEL_CACHE_RECORD_H
#define REMODEL_CACHE_RECORD_H

#include "common/gather/mixture.h"

struct cache_record {
    struct gather_point point;
    struct rgb value;             /* indirect irradiance: all light but MIXTURE_LIGHTS */
    struct vec3 turn[3], move[3]; /* gradients of r, g, b by rotation of the normal and by translation */
    double error;                 /* standard error of the luminance */
    double radius;                /* within which light changes little: the harmonic mean distance, or less */
    double light[LIGHT_SOURCES];  /* luminance by source */
    double nearest, mean_inverse;
    int rays;
};

/* What each cell of the hemisphere sees: luminance without MIXTURE_LIGHTS. With one key and number of rays, a cell of
 * two fields has the same ray. */
enum { CACHE_CELLS_MAX = 72 * 228 };
struct cache_cells {
    int rings, columns;
    float light[CACHE_CELLS_MAX]; /* column by column */
};

/* Gathers once with about `rays` rays, at most 16 k. The same key, point and number give the same directions in any
 * field. cells: NULL, or set. */
void cache_record_gather_once(struct cache_record *r, const struct light_field *f, struct gather_point p, int rays,
                              uint64_t key, struct cache_cells *cells);

/* Standard error of the luminance of b - q a, from the cells of both: without the noise that they share. */
double cache_cells_error(const struct cache_cells *a, const struct cache_cells *b, double q);

/* Gathers with at least `least` rays, up to 16 times that, until the standard error is at most `target` of the
 * luminance with `beside`, the luminance of direct light, added. */
void cache_record_gather(struct cache_record *r, const struct light_field *f, struct gather_point p, double target,
                         double beside, int least, uint64_t key);

/* The value at another point nearby; never negative. */
struct rgb cache_record_at(const struct cache_record *r, struct gather_point p);

#endif
