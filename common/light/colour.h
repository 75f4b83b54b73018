/* colour.h - rgb triples, by value: scene-linear, Rec.709 primaries. A triple is an albedo (0..1), a radiance or an
 * irradiance; the code that holds it says which. */
#ifndef REMODEL_COLOUR_H
#define REMODEL_COLOUR_H

#include "common/image/luminance.h"

struct rgb {
    double r, g, b;
};

static inline struct rgb rgb_make(double r, double g, double b) { return (struct rgb){r, g, b}; }
static inline struct rgb rgb_grey(double v) { return (struct rgb){v, v, v}; }
static inline struct rgb rgb_add(struct rgb a, struct rgb b) { return rgb_make(a.r + b.r, a.g + b.g, a.b + b.b); }
static inline struct rgb rgb_scale(struct rgb a, double s) { return rgb_make(a.r * s, a.g * s, a.b * s); }
static inline struct rgb rgb_multiply(struct rgb a, struct rgb b) { return rgb_make(a.r * b.r, a.g * b.g, a.b * b.b); }
/* a at t = 0, b at t = 1 */
static inline struct rgb rgb_mix(struct rgb a, struct rgb b, double t)
{
    return rgb_add(rgb_scale(a, 1 - t), rgb_scale(b, t));
}
static inline double rgb_max(struct rgb a)
{
    double m = a.r > a.g ? a.r : a.g;
    return m > a.b ? m : a.b;
}
static inline double rgb_luminance(struct rgb a) { return LUMINANCE_R * a.r + LUMINANCE_G * a.g + LUMINANCE_B * a.b; }

#endif
