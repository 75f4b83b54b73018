/* made_pair.h - pairs of pictures of known flow: a textured wall, and a textured square in front of it. */
#ifndef REMODEL_TESTS_MADE_PAIR_H
#define REMODEL_TESTS_MADE_PAIR_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "stages/morph_views/flow_match.h"

enum { MADE_WIDTH = 160, MADE_HEIGHT = 120 };

struct made_pair {
    double wall[2], square[2]; /* their flow from the first picture to the second, px */
    bool has_square;
    double gain; /* of the second picture */
};

static inline double made_hash(int x, int y, int seed)
{
    uint32_t h = (uint32_t)x * 374761393u + (uint32_t)y * 668265263u + (uint32_t)seed * 2246822519u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return ((h ^ (h >> 16)) & 0xffff) / 65535.0;
}

/* Value noise of two sizes, 0.02 .. 0.62. */
static inline double made_texture(double x, double y, int seed)
{
    double sum = 0;
    for (int k = 0; k < 2; k++) {
        double size = k ? 9 : 3, u = x / size, v = y / size, fx = u - floor(u), fy = v - floor(v);
        int ix = (int)floor(u), iy = (int)floor(v);
        fx = fx * fx * (3 - 2 * fx);
        fy = fy * fy * (3 - 2 * fy);
        double a = made_hash(ix, iy, seed + k), b = made_hash(ix + 1, iy, seed + k);
        double c = made_hash(ix, iy + 1, seed + k), d = made_hash(ix + 1, iy + 1, seed + k);
        sum += (1 - fy) * ((1 - fx) * a + fx * b) + fy * ((1 - fx) * c + fx * d);
    }
    return 0.02 + 0.3 * sum;
}

static inline bool made_in_square(double x, double y) { return x >= 60 && x < 105 && y >= 40 && y < 85; }

static inline void made_picture(struct image *im, const struct made_pair *pair, int second)
{
    for (int y = 0; y < MADE_HEIGHT; y++)
        for (int x = 0; x < MADE_WIDTH; x++) {
            double sx = x - second * pair->square[0], sy = y - second * pair->square[1];
            double wx = x - second * pair->wall[0], wy = y - second * pair->wall[1];
            bool front = pair->has_square && made_in_square(sx, sy);
            for (int c = 0; c < 3; c++)
                image_at(im, x, y)[c] = (float)((second ? pair->gain : 1) * (front ? made_texture(sx, sy, 50 + 7 * c)
                                                                                   : made_texture(wx, wy, 7 * c)));
        }
}

/* Fraction of the pixels well inside the square (or else the wall) whose flow is correct to `within` px. */
static inline double made_right(const struct flow *f, const struct made_pair *pair, bool square, double within)
{
    int right = 0, count = 0;
    const double *flow = square ? pair->square : pair->wall;
    for (int y = 24; y < MADE_HEIGHT - 24; y++)
        for (int x = 24; x < MADE_WIDTH - 24; x++) {
            bool inside = x >= 66 && x < 99 && y >= 46 && y < 79, outside = x < 45 || x > 120 || y < 30 || y > 97;
            if (pair->has_square && !(square ? inside : outside)) continue;
            const float *uv = f->uv + 2 * (y * MADE_WIDTH + x);
            count++;
            right += hypot(uv[0] - flow[0], uv[1] - flow[1]) <= within;
        }
    return (double)right / count;
}

/* Two cameras side by side: nearer points are farther to the left in the second picture. */
static inline struct pair_geometry made_side_by_side(void)
{
    struct pair_geometry g = {.kind = EPIPOLAR_FUNDAMENTAL, .focal = 200, .width = MADE_WIDTH, .height = MADE_HEIGHT};
    g.fundamental[5] = -1;
    g.fundamental[7] = 1;
    for (int i = 0; i < 3; i++) g.rotation[4 * i] = 1;
    g.translation[0] = -1;
    return g;
}

#endif
