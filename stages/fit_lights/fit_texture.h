/* fit_texture.h - how the reflectance of materials varies from place to place. */
#ifndef REMODEL_FIT_LIGHTS_FIT_TEXTURE_H
#define REMODEL_FIT_LIGHTS_FIT_TEXTURE_H

#include "common/base/err.h"
#include "stages/fit_lights/fit_problem.h"

/* Estimates the variation of each material from the present logarithms and excess variances of its points. */
void fit_texture_estimate(struct problem *p);

/* Sets the factor of the residuals' covariance and what depends on it. ST_DATA: two points have the same place and no
 * noise. */
enum status fit_texture_set_covariance(struct problem *p, struct err *err);

/* Renews the excess variance of each point by how far it lies from what the others predict. */
void fit_texture_set_excess(struct problem *p);

#endif
