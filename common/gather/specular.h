/* specular.h - light that a glossy surface reflects to a viewer [Colburn 2014, 5.4]. */
#ifndef REMODEL_SPECULAR_H
#define REMODEL_SPECULAR_H

#include "common/gather/irradiance.h"
#include "common/light/brdf.h"

/* The integral of radiance times the lobe of a brdf times the cosine, over the hemisphere: what its lobe (Phong, Ward)
 * reflects to the viewer in the unit direction `view`, its albedo left out. 0 for BRDF_LAMBERT, for a lobe without
 * gloss and for a viewer below the surface. Rays go by the lobe and towards all emitters; as many as the standard error
 * of the luminance asks for, `target` (a fraction of the value), but at most `most`. mean_inverse and `from` are those
 * of the light that is reflected. The same key, point and field give the same bits. */
void specular_integral(struct irradiance *e, const struct light_field *f, struct gather_point p,
                       const struct brdf *brdf, struct vec3 view, double target, int most, uint64_t key);

/* The same until the standard error is at most `target` of the luminance with `beside` added: what else the surface
 * shows, in the unit of the integral. Where that is bright, fewer rays do. */
void specular_integral_beside(struct irradiance *e, const struct light_field *f, struct gather_point p,
                              const struct brdf *brdf, struct vec3 view, double beside, double target, int most,
                              uint64_t key);

/* One rough estimate, for gathers that average many: about `rays` rays, 8 of each strategy or more. No error is
 * learned. */
struct rgb specular_estimate(const struct light_field *f, struct gather_point p, const struct brdf *brdf,
                             struct vec3 view, int rays, uint64_t key);

#endif
