/* distance.c - exact Euclidean distance transform [Felzenszwalb 2012].
 *
 * The squared distance D(x, y) = min over (u, v) outside of (x - u)^2 + (y - v)^2 separates into two passes. Columns:
 * g(x, y) = min over v of (y - v)^2 for outside pixels (x, v), by one sweep down and one up. Rows: D(x, y) = min over u
 * of (x - u)^2 + g(u, y) is the lower envelope of the parabolas with apex (u, g(u, y)). The envelope is built from left
 * to right: the last parabola is removed while the new one crosses it left of where it begins. Both passes are linear
 * in the number of pixels.
 *
 * Differs from the source: columns use the two sweeps of distances, since the input is binary, and columns without an
 * outside pixel (infinite g) are left out of the envelope. */
#include "common/math/distance.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Squared distances to the nearest 0 in the same column. */
static void columns(float *squared, const uint8_t *inside, int width, int height)
{
    const float far = INFINITY;
    for (int y = 0; y < height; y++) /* distances from above, not squared yet */
        for (int x = 0; x < width; x++) {
            const size_t p = (size_t)y * (size_t)width + (size_t)x;
            squared[p] = !inside[p] ? 0 : y ? squared[p - (size_t)width] + 1 : far;
        }
    for (int y = height - 1; y >= 0; y--)
        for (int x = 0; x < width; x++) {
            const size_t p = (size_t)y * (size_t)width + (size_t)x;
            if (y + 1 < height && squared[p + (size_t)width] + 1 < squared[p])
                squared[p] = squared[p + (size_t)width] + 1;
        }
    for (size_t p = 0; p < (size_t)width * (size_t)height; p++) squared[p] *= squared[p];
}

/* The lower envelope of a row: parabola k has its apex at (at[k], height[k]) and is the lowest from from[k] on. */
struct envelope {
    double *from;
    int *at;
    float *height;
};

static void row(float *d, int width, const struct envelope *e)
{
    int count = 0;
    for (int x = 0; x < width; x++) {
        if (!(d[x] < INFINITY)) continue;
        double from = -HUGE_VAL;
        while (count > 0) {
            const double at = e->at[count - 1];
            from = ((double)d[x] + (double)x * x - (double)e->height[count - 1] - at * at) / (2 * (x - at));
            if (from > e->from[count - 1]) break;
            count--;
            from = -HUGE_VAL;
        }
        e->at[count] = x;
        e->height[count] = d[x];
        e->from[count++] = from;
    }
    for (int x = 0, k = 0; x < width && count; x++) {
        while (k + 1 < count && e->from[k + 1] <= x) k++;
        const float across = (float)(x - e->at[k]);
        d[x] = e->height[k] + across * across;
    }
}

enum status distance_squared(float *squared, const uint8_t *inside, int width, int height, struct err *err)
{
    const size_t n = (size_t)width;
    struct envelope e = {malloc(n * sizeof *e.from), malloc(n * sizeof *e.at), malloc(n * sizeof *e.height)};
    const bool allocated = e.from && e.at && e.height;
    if (allocated) {
        columns(squared, inside, width, height);
        for (int y = 0; y < height; y++) row(squared + (size_t)y * n, width, &e);
    }
    free(e.from);
    free(e.at);
    free(e.height);
    return allocated ? ST_OK
                     : err_nomem(err, "a row of distances", n * (sizeof *e.from + sizeof *e.at + sizeof *e.height));
}
