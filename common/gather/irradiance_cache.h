/* irradiance_cache.h - irradiance at many points, of which neighbours are close to each other: a picture, or texels. */
#ifndef REMODEL_IRRADIANCE_CACHE_H
#define REMODEL_IRRADIANCE_CACHE_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/gather/irradiance.h"

/* The same grid in a second field, for the change of light from one to the other. Both fields have equal emitters: then
 * the same rays are sent in both, and points whose surroundings are equal get equal bits. */
struct irradiance_cache_other {
    const struct light_field *field;   /* NULL: one field only */
    const struct gather_point *points; /* a normal of 0 0 0 where those of the first field have none, and only there */
    struct irradiance *results;        /* set like the first field's */
    float *errors; /* NULL, or set: relative standard error of the quotient of both fields' luminance; 0: none */
    /* NULL, or not 0 where the light in the second field counts by itself, not by the quotient. */
    const unsigned char *whole;
    /* 1: light is gathered at each point. More: at the corners of cells of so many columns and rows, and within a cell
     * where the corners' quotients differ by more than the target, or the surface bends; the others are interpolated.
     * What is smaller than a cell may be missed. */
    int step;
};

struct irradiance_cache_job {
    const struct light_field *field;
    const struct gather_point *points; /* width * height; a normal of 0 0 0: none */
    struct irradiance_cache_other other;
    int width, height;
    double target; /* relative error; with a second field, also of the quotient of both */
    int rays;      /* most, of direct light at a point */
    uint64_t key;
    void (*done)(void *ctx,
                 size_t points); /* NULL, or told how many more points are done, also 0; by several threads */
    void *done_ctx;
};

struct irradiance_cache_stats {
    size_t records;
    double record_rays, direct_rays;
};

/* False: the field has so many emitters that a point does not use them all, and two points may use different ones. */
bool irradiance_cache_suits(const struct light_field *f);

/* Sets results[i] for the points with a normal; the others get 0. Same bits for any number of threads. ST_NOMEM. */
enum status irradiance_cache_fill(struct irradiance *results, const struct irradiance_cache_job *j,
                                  struct irradiance_cache_stats *stats, struct err *err);

#endif
