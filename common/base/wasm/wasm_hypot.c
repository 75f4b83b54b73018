/* wasm_hypot.c - the length of (x, y), rounded as the C library of Linux rounds it, so that a model has the same bytes
 * in a page.
 *
 * The root h of the rounded sum is corrected by what is left, x^2 + y^2 - h^2, whose squares are computed exactly, as
 * sums of two numbers [Dekker 1971]. Very large and very small numbers are computed with more bits instead. */
#include <math.h>

struct square {
    double high, low; /* their sum is the square */
};

static struct square square_exactly(double x)
{
    const double split = 134217729 * x, head = split - (split - x), tail = x - head, high = x * x;
    return (struct square){high, ((head * head - high) + 2 * head * tail) + tail * tail};
}

double hypot(double x, double y)
{
    const double a = fabs(x), b = fabs(y), large = a > b ? a : b, small = a > b ? b : a;
    if (isinf(a) || isinf(b)) return HUGE_VAL;
    if (!(large < 1e140 && small > 1e-140)) return (double)sqrtl((long double)x * x + (long double)y * y);
    const struct square p = square_exactly(large), q = square_exactly(small);
    const double h = sqrt(p.high + q.high);
    const struct square s = square_exactly(h);
    return h + ((((p.high - s.high) + q.high) + p.low - s.low) + q.low) / (2 * h);
}
