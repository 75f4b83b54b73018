/* brdf.h - how a surface scatters light: Lambert, Phong, Ward.
 *
 * With N the normal, V towards the viewer, L towards the light, R the mirror image of L about N, H between V and L:
 *   Lambert  albedo / pi
 *   Phong    albedo / pi + ks (R.V)^n / (N.L)
 *   Ward     albedo / pi + ks exp(-tan^2(N,H) / alpha^2) / (4 pi alpha^2 sqrt((N.L)(N.V)))
 * Phong's lobe in this form is not reciprocal. What bounds the light in a closed room is the reflectance seen from a
 * viewer, the integral of f cos(N, L) over L; that is what brdf_gloss_albedo() gives the largest value of. */
#ifndef REMODEL_SIMULATE_BRDF_H
#define REMODEL_SIMULATE_BRDF_H

#include <stdbool.h>

#include "common/math/vec.h"
#include "stages/simulate/colour.h"

enum brdf_kind { BRDF_LAMBERT, BRDF_PHONG, BRDF_WARD };

struct brdf {
    enum brdf_kind kind;
    struct rgb albedo;
    double ks, shape; /* Phong: exponent; Ward: alpha */
    double gloss;     /* brdf_gloss_albedo(), for choosing lobes */
};

/* f cos(N, L), and the density with which brdf_sample() chooses L (per solid angle). Zero below the horizon. */
struct rgb brdf_eval(const struct brdf *b, struct vec3 n, struct vec3 view, struct vec3 light, double *pdf);

/* A direction for three numbers in [0, 1); false if it falls below the horizon: no light then. */
bool brdf_sample(const struct brdf *b, struct vec3 n, struct vec3 view, const double u[3], struct vec3 *light);

/* The lobe's reflectance towards the viewer who sees most of it (2 pi ks / (n + 1) for Phong; by quadrature for Ward). */
double brdf_gloss_albedo(enum brdf_kind kind, double ks, double shape);

/* Right-handed axes x, y for a unit z. */
void frame_from_normal(struct vec3 z, struct vec3 *x, struct vec3 *y);

/* The unit vector at an angle from an axis, `turns` (0..1) around it. */
struct vec3 direction_about(struct vec3 axis, double sin_t, double cos_t, double turns);

#endif
