/* soft_z.h - the soft z-buffer (thesis eq. 3.1): surfaces that nearly agree in depth share a pixel.
 *
 *   w(dz) = 1                                               dz <= gamma
 *           1/2 (1 + cos(pi (dz - gamma) / (rho - 2 gamma)))  gamma < dz <= rho - gamma
 *           0                                               beyond;     gamma = rho / 10
 *
 * The thesis has rho = the scene's depth range. Here, with a width of k > 0 uncertainties, two depths z_a, z_b of
 * relative uncertainties s_a, s_b have u = sqrt((s_a z_a)^2 + (s_b z_b)^2) and rho = 2 k u: the weight is 1/2 at dz
 * = k u and 0 from 1.8 k u on. */
#ifndef REMODEL_SOFT_Z_H
#define REMODEL_SOFT_Z_H

struct soft_z {
    float widths; /* k; 0: rho is `range` everywhere, the thesis' */
    float range;  /* far - near of the scene, robust */
};

/* Uncertainties below this (relative) are taken for it: no depth map is that sure, and rounding is not a depth jump. */
#define SOFT_Z_SIGMA_LEAST 1e-3f

float soft_z_weight(float dz, float gamma, float rho);

/* rho of two depths with their relative uncertainties. */
float soft_z_rho(const struct soft_z *s, float z_a, float sigma_a, float z_b, float sigma_b);

/* How far apart in depth two fragments of one view may be and still be the same surface: k s z, or rho / 10 with the
 * thesis' range. */
float soft_z_reach(const struct soft_z *s, float z, float sigma);

struct soft_z_sample { /* what one view shows in a pixel */
    float rgba[4];     /* premultiplied */
    float z, sigma;    /* of its front surface; sigma relative */
    float blend;       /* the view's blending weight */
};

/* Blends the samples (alpha > 0) of a pixel: colour by blend x w x alpha, normalised; depth sum(w z) / sum(w),
 * without blending weights. The closest sample decides w; but a sample that is hardly there - blend below 0.05, or
 * alpha below 0.5 - hides others in proportion only, and counts in the depth in proportion, so that a view that
 * enters or leaves does so without a jump:
 *   p = min(1, blend / 0.05) min(1, alpha / 0.5);  w_i = min over c closer than i of 1 - p_c (1 - w(z_i - z_c))
 * which is the formula above wherever every p is 1. rgba gets alpha 1. */
void soft_z_blend(const struct soft_z *s, const struct soft_z_sample *samples, int count, float rgba[4], float *z);

#endif
