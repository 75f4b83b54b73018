/* fast.h - inline replacements for library functions in inner loops, with the same bits on every system. */
#ifndef REMODEL_FAST_H
#define REMODEL_FAST_H

/* Unlike fmin() and fmax(), these return b when either argument is a NaN. */
static inline double fast_min(double a, double b) { return a < b ? a : b; }
static inline double fast_max(double a, double b) { return a > b ? a : b; }

/* Cosine and sine of `turns` full turns, 0 <= turns <= 1, to within 1e-13: Taylor series of the angle to the nearest
 * quarter turn. */
static inline void fast_cos_sin(double turns, double *c, double *s)
{
    const int quarter = (int)(4 * turns + 0.5);
    const double a = (turns - 0.25 * quarter) * 6.283185307179586477, aa = a * a;
    const double sine =
        a *
        (1 + aa * (-1.0 / 6 +
                   aa * (1.0 / 120 +
                         aa * (-1.0 / 5040 + aa * (1.0 / 362880 + aa * (-1.0 / 39916800 + aa * (1.0 / 6227020800)))))));
    const double cosine =
        1 + aa * (-0.5 + aa * (1.0 / 24 +
                               aa * (-1.0 / 720 +
                                     aa * (1.0 / 40320 + aa * (-1.0 / 3628800 +
                                                               aa * (1.0 / 479001600 + aa * (-1.0 / 87178291200)))))));
    const double first = quarter & 1 ? sine : cosine, second = quarter & 1 ? cosine : sine;
    *c = (quarter + 1) & 2 ? -first : first;
    *s = quarter & 2 ? -second : second;
}

#endif
