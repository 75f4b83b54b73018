/* light_quotient.c - see light_quotient.h.
 *
 * Mathematics. A Lambertian surface sends out L = a E / pi, so that L' = L E' / E. The albedo a = pi L / E that
 * photograph and gather imply may be larger than any surface has, where E is too small: something that the model lacks
 * lights the place, or it lies behind furniture that the gather does not know. Then E' / E is too large as well, and
 * rounds of light would gain energy. Where a exceeds A = 0.95, an increase of light is reflected by A instead:
 *   L' = L + A (E' - E) / pi, that is E' / E replaced by 1 + A (E' / E - 1) / a.
 * It holds down to E = 0, without a division by E. A decrease keeps the quotient E' / E, so that no light is left where
 * all lights go out. Both agree at E' = E. */
#include "common/relight/light_quotient.h"

#include <math.h>

#include "common/math/numbers.h"

static const double MAX_QUOTIENT = 1e30; /* a finite number, also as a float and times a radiance */

static double quotient(double before, double after, double radiance, bool *is_bounded)
{
    if (after == before) return 1;
    if (after < before) return fmax(after, 0) / before;
    if (!(PI * radiance > LIGHT_ALBEDO_MAX * before)) return before > 0 ? fmin(after / before, MAX_QUOTIENT) : 1;
    if (is_bounded) *is_bounded = true;
    return fmin(1 + LIGHT_ALBEDO_MAX * (after - before) / (PI * radiance), MAX_QUOTIENT);
}

struct rgb light_quotient(struct rgb before, struct rgb after, struct rgb radiance, bool *is_bounded)
{
    return rgb_make(quotient(before.r, after.r, radiance.r, is_bounded),
                    quotient(before.g, after.g, radiance.g, is_bounded),
                    quotient(before.b, after.b, radiance.b, is_bounded));
}

static double albedo(double before, double radiance)
{
    if (!(radiance > 0)) return 0;
    return before > 0 ? PI * radiance / before : INFINITY;
}

struct rgb light_albedo(struct rgb before, struct rgb radiance)
{
    return rgb_make(albedo(before.r, radiance.r), albedo(before.g, radiance.g), albedo(before.b, radiance.b));
}
