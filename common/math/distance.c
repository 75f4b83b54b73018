/* distance.c - see distance.h. Columns first, by two sweeps; then each row is the lower envelope of parabolas. */
#include "common/math/distance.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Squared distances to the nearest 0 of the same column. */
static void columns(float *squared, const uint8_t *inside, int width, int height)
{
    const float far = INFINITY;
    for (int y = 0; y < height; y++) /* distances first, from above */
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

struct envelope { /* of a row: parabola k stands at `at`, is lowest from `from` on, and has `height` there */
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
    const bool good = e.from && e.at && e.height;
    if (good) {
        columns(squared, inside, width, height);
        for (int y = 0; y < height; y++) row(squared + (size_t)y * n, width, &e);
    }
    free(e.from);
    free(e.at);
    free(e.height);
    return good ? ST_OK : err_nomem(err, "a row of distances", n * (sizeof *e.from + sizeof *e.at + sizeof *e.height));
}
