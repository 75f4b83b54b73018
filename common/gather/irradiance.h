/* irradiance.h - irradiance at a point: the integral of radiance times cosine over the hemisphere about its normal
 * [Colburn 2014, 5.3.1], by one of several estimators behind one interface. */
#ifndef REMODEL_GATHER_IRRADIANCE_H
#define REMODEL_GATHER_IRRADIANCE_H

#include "common/gather/light_field.h"

struct gather_point {
    struct vec3 at, normal; /* unit */
};

/* An irradiance, radiance times steradian. */
struct irradiance {
    struct rgb value;
    struct rgb error;           /* its standard error, as far as the estimator can tell; 0: it cannot */
    double from[LIGHT_SOURCES]; /* the share of its luminance from each source; they sum to 1, or are 0 in the dark */
    double nearest;             /* distance of the nearest surface */
    double mean_inverse;        /* inverse of the distances' harmonic mean over the hemisphere, cosine-weighted */
    int rays;
};

/* A plain hemicube with n x n pixels on its top [Cohen 1985], n even. Form factors are integrals over the pixels in
 * closed form: they sum to 1 to rounding. Owned by the caller. hemicube.c */
#define HEMICUBE_MAX 1024 /* pixels in a row */
struct hemicube;
/* ST_USAGE: n is odd or out of range; ST_NOMEM. */
enum status hemicube_make(struct hemicube **h, int n, struct err *err);
void hemicube_free(struct hemicube *h);        /* NULL is allowed */
double hemicube_sum(const struct hemicube *h); /* of all form factors */
void hemicube_irradiance(struct irradiance *e, const struct hemicube *h, const struct light_field *f,
                         struct gather_point p);

/* Low-discrepancy rays: some by the cosine, some towards the emitters, all weighted together by the balance heuristic
 * [Veach 1995]. `key` selects the random numbers: the same key, point and field give the same bits. ray_gather.c */
void ray_irradiance(struct irradiance *e, const struct light_field *f, struct gather_point p, int rays, uint64_t key);
/* The same until the standard error of the luminance is at most `target` (a fraction of the value) or `most` rays are
 * spent. */
void ray_irradiance_to(struct irradiance *e, const struct light_field *f, struct gather_point p, double target,
                       int most, uint64_t key);

#endif
