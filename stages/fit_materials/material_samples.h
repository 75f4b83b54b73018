/* material_samples.h - what photographs show of a material, and the light that it reflects there.
 *
 * A sample is a point of the surface in one view. What a lobe makes of the light is a sum over directions of
 * weight * exp(-s t): t says how far a direction is from the mirror direction, s how narrow the lobe is
 *   Phong  t = -ln(R.L),       s = n,           weight = flux
 *   Ward   t = tan^2(N,H),     s = 1 / alpha^2, weight = flux sqrt((N.L) / (N.V))
 * where flux is radiance times solid angle. So the light of a sample is kept by t alone, for each model, and any lobe
 * is computed from that. The vectors are those of common/light/brdf.h. */
#ifndef REMODEL_MATERIAL_SAMPLES_H
#define REMODEL_MATERIAL_SAMPLES_H

#include "common/base/err.h"
#include "common/light/brdf.h"

#define PHONG_MIN 1.0 /* exponent n */
#define PHONG_MAX 5000.0
#define WARD_MIN  0.02 /* roughness alpha */
#define WARD_MAX  1.0

/* {0} is the empty state; everything is owned. Rows are samples by channels: row 3 i + c. */
struct material_samples {
    int count;
    int *point;         /* of each sample: those of one point of the surface have the same number */
    double *radiance;   /* [3 count] towards the viewer */
    double *variance;   /* [3 count] of that; not negative */
    double *irradiance; /* [3 count] */
    double *node;       /* of t */
    double *lobe[2];    /* Phong, Ward: [nodes][3 count] weights of the light at each node of t */
};

enum status material_samples_init(struct material_samples *s, int count, struct err *err);
void material_samples_release(struct material_samples *s);

/* Adds the light from a direction to what the lobes of sample i see. Nothing is added if the light or the viewer is
 * below the horizon. All vectors are unit. */
void material_samples_add(struct material_samples *s, int i, struct vec3 normal, struct vec3 view,
                          struct vec3 direction, struct rgb flux);

/* What lobes are in the fit: ln s, and the lobe's scale ks per unit of reflectance (straight down, all light reflected
 * is 1): (n + 1) / (2 pi) for Phong; Ward's ks is that reflectance already. */
double material_lobe_log_s(enum brdf_kind kind, double shape);
double material_lobe_shape(enum brdf_kind kind, double log_s);
double material_lobe_ks(enum brdf_kind kind, double log_s);

/* value[row]: radiance of the lobe with reflectance 1; slope, unless it is NULL, its derivative by ln s. */
void material_lobe_integrals(const struct material_samples *s, enum brdf_kind kind, double log_s, double *value,
                             double *slope);

#endif
