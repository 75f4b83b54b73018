/* monotone.h - monotone cubic interpolation without overshoot [Fritsch 1984], weighted for unequal intervals.
 *
 * The slope at a knot is the weighted harmonic mean of the slopes on both sides, or 0 if their signs differ. The curve
 * is C1 and local (a knot affects two intervals on either side); it is monotone where its knots are and constant
 * between equal knots. */
#ifndef REMODEL_MONOTONE_H
#define REMODEL_MONOTONE_H

#include <math.h>

/* The slope at a knot between intervals of lengths h0, h1 > 0 with mean slopes s0, s1. */
static inline double monotone_slope(double h0, double s0, double h1, double s1)
{
    if (!(s0 * s1 > 0)) return 0;
    return 3 * (h0 + h1) / ((2 * h1 + h0) / s0 + (h1 + 2 * h0) / s1);
}

/* Limits a slope so that an interval of mean slope s stays monotone. */
static inline double monotone_limit(double slope, double s)
{
    if (!(slope * s > 0)) return 0;
    return copysign(fmin(fabs(slope), 3 * fabs(s)), s);
}

/* The slope at the outer end of the first of two intervals: that of the parabola through the three knots, limited. */
static inline double monotone_end_slope(double h0, double s0, double h1, double s1)
{
    return monotone_limit(s0 + (s0 - s1) * (h0 / (h0 + h1)), s0);
}

/* The value in an interval of length h from a to b at 0 <= t <= 1. Clamped to lie between a and b in spite of rounding
 * and of slopes that overflow. */
static inline double monotone_value(double a, double b, double h, double slope_a, double slope_b, double t)
{
    const double u = 1 - t, v = a + (b - a) * (t * t * (3 - 2 * t)) + h * (t * u) * (slope_a * u - slope_b * t);
    return fmin(fmax(v, fmin(a, b)), fmax(a, b));
}

#endif
