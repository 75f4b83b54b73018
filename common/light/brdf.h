/* brdf.h - reflectance models of a surface: Lambert, Phong, Ward.
 *
 * A brdf f (1/sr) is reflected radiance per irradiance. With N the normal, V the direction to the viewer, L the
 * direction to the light (all unit vectors, away from the surface), R the mirror image of L about N, H halfway between
 * V and L:
 *   Lambert  albedo / pi
 *   Phong    albedo / pi + ks (R.V)^n / (N.L)
 *   Ward     albedo / pi + ks exp(-tan^2(N,H) / alpha^2) / (4 pi alpha^2 sqrt((N.L)(N.V)))
 * Phong's lobe in this form is not reciprocal. Light in a closed room is bounded by the reflectance towards a viewer,
 * the integral of f cos(N,L) over L; brdf_gloss_albedo() gives the lobe's maximum over viewers. Reflectances have no
 * unit: radiance in, radiance out; a Lambertian surface under irradiance E has radiance albedo E / pi. */
#ifndef REMODEL_BRDF_H
#define REMODEL_BRDF_H

#include <stdbool.h>

#include "common/light/colour.h"
#include "common/math/vec.h"

enum brdf_kind { BRDF_LAMBERT, BRDF_PHONG, BRDF_WARD };

struct brdf {
    enum brdf_kind kind;
    struct rgb albedo; /* of the diffuse part */
    double ks, shape;  /* Phong: shape is the exponent n; Ward: the roughness alpha */
    double gloss;      /* brdf_gloss_albedo(kind, ks, shape): how often the lobe is sampled; 0 leaves the lobe out */
};

/* Returns f cos(N,L). *pdf is the density (1/sr) with which brdf_sample() chooses `light`. Both are zero when the
 * viewer or the light is below the horizon. */
struct rgb brdf_eval(const struct brdf *b, struct vec3 n, struct vec3 view, struct vec3 light, double *pdf);

/* Chooses a unit direction from three numbers in [0, 1). False: it is below the horizon, where brdf_eval() is zero;
 * count that sample as zero. */
bool brdf_sample(const struct brdf *b, struct vec3 n, struct vec3 view, const double u[3], struct vec3 *light);

/* The lobe's reflectance towards the viewer who sees most of it: 2 pi ks / (n + 1) for Phong, a maximum over 20 viewing
 * angles by quadrature for Ward, 0 for Lambert. */
double brdf_gloss_albedo(enum brdf_kind kind, double ks, double shape);

#endif
