/* fit_texture.h - how the reflectance of materials varies from place to place. */
#ifndef REMODEL_FIT_LIGHTS_FIT_TEXTURE_H
#define REMODEL_FIT_LIGHTS_FIT_TEXTURE_H

#include "common/base/err.h"
#include "stages/fit_lights/fit_problem.h"

enum {
    MAX_SAMPLED = 160, /* points of a material that tell how it varies */
    TEXTURE_GRAINS = 4,
    TEXTURE_KINDS = 7 * TEXTURE_GRAINS + 1,
    TEXTURE_PRIOR = 4 /* as many points' worth of the assumed deviation */
};

/* How neighbours vary together. */
struct texture_kind {
    double length, grain;
};
/* The k-th of TEXTURE_KINDS; the last one: at random. longest: the extent of a material's points. */
struct texture_kind fit_texture_kind(int k, double longest);
/* Between two points, as a fraction of their variance. */
double fit_texture_correlation(const struct light_fit *f, int a, int b, struct texture_kind kind);

struct texture_sample {
    int points[MAX_SAMPLED], count;
    double longest;
};
/* The points of a material, or MAX_SAMPLED of them. */
struct texture_sample fit_texture_sample(const struct light_fit *f, int material);

/* Estimates the variation of each material from the present logarithms and excess variances of its points. */
void fit_texture_estimate(struct problem *p);

/* Sets the factor of the residuals' covariance and what depends on it. ST_DATA: two points have the same place and no
 * noise. */
enum status fit_texture_set_covariance(struct problem *p, struct err *err);

/* Renews the excess variance of each point by how far it lies from what the others predict. */
void fit_texture_set_excess(struct problem *p);

/* Renews the variance of the offset of each mark by what the fit finds of it. */
void fit_texture_set_marks(struct problem *p);

#endif
