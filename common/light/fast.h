/* fast.h - inline replacements for library functions in inner loops, with the same bits on every system. */
#ifndef REMODEL_FAST_H
#define REMODEL_FAST_H

#include "common/math/lanes.h"

/* Unlike fmin() and fmax(), these return b when either argument is a NaN. */
static inline double fast_min(double a, double b) { return a < b ? a : b; }
static inline double fast_max(double a, double b) { return a > b ? a : b; }

/* Taylor series of sin(a) / a and cos(a) in aa = a^2, of numbers or lanes. */
#define FAST_SINE_SERIES(aa)                                                                             \
    (1 + (aa) * (-1.0 / 6 + (aa) * (1.0 / 120 + (aa) * (-1.0 / 5040 +                                    \
                                                        (aa) * (1.0 / 362880 + (aa) * (-1.0 / 39916800 + \
                                                                                       (aa) * (1.0 / 6227020800)))))))
#define FAST_COSINE_SERIES(aa)                                                                        \
    (1 + (aa) * (-0.5 +                                                                               \
                 (aa) * (1.0 / 24 +                                                                   \
                         (aa) * (-1.0 / 720 + (aa) * (1.0 / 40320 + (aa) * (-1.0 / 3628800 +          \
                                                                            (aa) * (1.0 / 479001600 + \
                                                                                    (aa) * (-1.0 / 87178291200))))))))
static const double fast_turn = 6.283185307179586477;

/* Cosine and sine of `turns` full turns, 0 <= turns <= 1, to within 1e-13: Taylor series of the angle to the nearest
 * quarter turn. */
static inline void fast_cos_sin(double turns, double *c, double *s)
{
    const int quarter = (int)(4 * turns + 0.5);
    const double a = (turns - 0.25 * quarter) * fast_turn, aa = a * a;
    const double sine = a * FAST_SINE_SERIES(aa), cosine = FAST_COSINE_SERIES(aa);
    const double first = quarter & 1 ? sine : cosine, second = quarter & 1 ? cosine : sine;
    *c = (quarter + 1) & 2 ? -first : first;
    *s = quarter & 2 ? -second : second;
}

/* The same of four numbers, with the same bits. */
static inline void fast_cos_sin4(f64x4 turns, f64x4 *c, f64x4 *s)
{
    const i32x4 quarter = i32x4_truncate_f64(4 * turns + 0.5);
    const i64x4 q = __builtin_convertvector(quarter, i64x4);
    const f64x4 a = (turns - 0.25 * f64x4_from_i32(quarter)) * fast_turn, aa = a * a;
    const f64x4 sine = a * FAST_SINE_SERIES(aa), cosine = FAST_COSINE_SERIES(aa);
    const i64x4 odd = (q & 1) != 0;
    const f64x4 first = f64x4_if(odd, sine, cosine), second = f64x4_if(odd, cosine, sine);
    *c = f64x4_if(((q + 1) & 2) != 0, -first, first);
    *s = f64x4_if((q & 2) != 0, -second, second);
}

#endif
