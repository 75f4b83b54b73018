/* hole_measure.c - the hole measure H; see hole_measure.h for the formula. */
#include "common/layers/hole_measure.h"

#include <math.h>

#include "common/math/distance.h"

enum status hole_measure(double *h, const uint8_t *hole, int width, int height, float *scratch, struct err *err)
{
    const double scale = (width > height ? width : height) / (double)H_REFERENCE_SIDE;
    double total = 0;
    if (distance_squared(scratch, hole, width, height, err)) return err->status;
    for (int y = 0; y < height; y++) {
        const float *row = scratch + (size_t)y * (size_t)width;
        double sum = 0;
        for (int x = 0; x < width; x++) sum += (double)(row[x] * sqrtf(row[x]));
        total += sum;
    }
    *h = total / (scale * scale * scale) / ((double)width * height);
    return ST_OK;
}
