/* monotone.h - cubic interpolation that never leaves the range of its neighbours: Fritsch and Butland (1984), with the
 * weights of unequal intervals.
 *
 * The slope at a knot is the weighted harmonic mean of the slopes on both sides, 0 where they differ in sign: the
 * curve is C1, local (a knot changes two intervals on either side), rises where its knots rise, and is constant
 * between equal ones. */
#ifndef REMODEL_MONOTONE_H
#define REMODEL_MONOTONE_H

#include <math.h>

/* At a knot between intervals of lengths h0, h1 > 0 with mean slopes s0, s1. */
static inline double monotone_slope(double h0, double s0, double h1, double s1)
{
    if (!(s0 * s1 > 0)) return 0;
    return 3 * (h0 + h1) / ((2 * h1 + h0) / s0 + (h1 + 2 * h0) / s1);
}

/* A slope as far as an interval of mean slope s can take it and stay monotone. */
static inline double monotone_limit(double slope, double s)
{
    if (!(slope * s > 0)) return 0;
    return copysign(fmin(fabs(slope), 3 * fabs(s)), s);
}

/* At the outer end of the first of two intervals: that of the parabola through the three knots, limited. */
static inline double monotone_end_slope(double h0, double s0, double h1, double s1)
{
    return monotone_limit(s0 + (s0 - s1) * (h0 / (h0 + h1)), s0);
}

/* From a to b over an interval of length h, at the part 0 <= t <= 1 of it. Clamped for the sake of rounding and of
 * slopes too steep to be numbers: the result lies between a and b. */
static inline double monotone_value(double a, double b, double h, double slope_a, double slope_b, double t)
{
    const double u = 1 - t, v = a + (b - a) * (t * t * (3 - 2 * t)) + h * (t * u) * (slope_a * u - slope_b * t);
    return fmin(fmax(v, fmin(a, b)), fmax(a, b));
}

#endif
