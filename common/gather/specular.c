/* specular.c - light that a glossy surface reflects to a viewer.
 *
 * Overview. A pixel of a glossy surface has the radiance albedo E / pi + k_s I_s. E is its irradiance, and I_s what is
 * computed here with k_s = 1: the lobe's own directions are one more strategy beside those towards emitters
 * (mixture.c). A narrow lobe is best sampled by itself, a wide one under a small lamp by the lamp; the weights see to
 * both.
 *
 * Mathematics. I = integral of L(w) f(w, view) cos(w): for Phong L k_s (R.V)^n, in which the cosine cancels [Colburn
 * 2014, A.1.10]; for Ward L k_s exp(-tan^2(N,H) / alpha^2) / (4 pi alpha^2) sqrt(cos_light / cos_view) [Ward 1992]. In
 * uniform light of radiance 1 with the viewer overhead, Phong's is 2 pi k_s / (n + 1).
 *
 * Source: [Colburn 2014, 5.4] for the integrals, [Veach 1995] for the mixture. */
#include "common/gather/specular.h"

#include <math.h>

#include "common/gather/mixture.h"

enum { FIRST = 512, FIRST_BESIDE = 128 };

static bool reflects(const struct brdf *b, struct vec3 normal, struct vec3 view)
{
    return b->kind != BRDF_LAMBERT && b->gloss > 0 && vec3_dot(normal, view) > 0;
}

static void integrate(struct irradiance *e, const struct light_field *f, struct gather_point p, const struct brdf *brdf,
                      struct vec3 view, double target, double beside, int least, int most, uint64_t key)
{
    struct mixture m;
    *e = (struct irradiance){.nearest = INFINITY};
    if (!reflects(brdf, p.normal, view)) return;
    mixture_lobe_init(&m, f, p, brdf, view);
    mixture_gather_to(e, &m, target, beside, least, most, key);
}

void specular_integral(struct irradiance *e, const struct light_field *f, struct gather_point p,
                       const struct brdf *brdf, struct vec3 view, double target, int most, uint64_t key)
{
    integrate(e, f, p, brdf, view, target, 0, FIRST, most, key);
}

void specular_integral_beside(struct irradiance *e, const struct light_field *f, struct gather_point p,
                              const struct brdf *brdf, struct vec3 view, double beside, double target, int most,
                              uint64_t key)
{
    integrate(e, f, p, brdf, view, target, beside, FIRST_BESIDE, most, key);
}

struct rgb specular_estimate(const struct light_field *f, struct gather_point p, const struct brdf *brdf,
                             struct vec3 view, int rays, uint64_t key)
{
    struct mixture m;
    struct irradiance e;
    if (!reflects(brdf, p.normal, view)) return rgb_grey(0);
    mixture_lobe_init(&m, f, p, brdf, view);
    m.least = MIXTURE_REPLICATES;
    mixture_gather(&e, &m, rays, key, false);
    return e.value;
}
