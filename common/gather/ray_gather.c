/* ray_gather.c - irradiance by low-discrepancy rays: the cosine and all emitters, weighted together (mixture.c).
 *
 * For a target, an integral is repeated with so many rays as the last error asks for, if errors fall as n^-0.75. The
 * last integral alone is the result. */
#include "common/gather/mixture.h"

enum { FIRST = 512 };

void ray_irradiance(struct irradiance *e, const struct light_field *f, struct gather_point p, int rays, uint64_t key)
{
    struct mixture m;
    mixture_init(&m, f, p, MIXTURE_ALL);
    mixture_gather(e, &m, rays, key, false);
}

void ray_irradiance_to(struct irradiance *e, const struct light_field *f, struct gather_point p, double target,
                       int most, uint64_t key)
{
    struct mixture m;
    mixture_init(&m, f, p, MIXTURE_ALL);
    mixture_gather_to(e, &m, target, 0, FIRST, most, key);
}
