/* visible_lanes.h - linear functions of the pixel, for eight neighbours of a row at a time. */
#ifndef REMODEL_RENDER_VISIBLE_LANES_H
#define REMODEL_RENDER_VISIBLE_LANES_H

#include <immintrin.h>

#define LANES 8

/* x column + y row + origin, at the centre of a pixel. */
struct linear {
    double x, y, origin;
};

static inline double linear_at(const struct linear *l, double x, double y) { return l->x * x + l->y * y + l->origin; }

/* The same in single precision, counted from some pixel. Equal functions of opposite signs have equal values of
 * opposite signs. */
struct lanes {
    __m256 row; /* at the first eight pixels */
    __m256 down, right;
};

static inline struct lanes lanes_from(const struct linear *l, int x, int y)
{
    const __m256 slope = _mm256_set1_ps((float)l->x), start = _mm256_set1_ps((float)linear_at(l, x, y));
    const __m256 steps = _mm256_set_ps(7, 6, 5, 4, 3, 2, 1, 0);
    return (struct lanes){_mm256_add_ps(start, _mm256_mul_ps(slope, steps)), _mm256_set1_ps((float)l->y), slope};
}

/* The values of eight pixels, `down` rows and `right` columns further. */
static inline __m256 lanes_value(const struct lanes *l, __m256 down, __m256 right)
{
    return _mm256_add_ps(_mm256_add_ps(l->row, _mm256_mul_ps(l->down, down)), _mm256_mul_ps(l->right, right));
}

#endif
