/* raster.c - draws triangles with a depth buffer, and soft discs. */
#include "stages/build_model/picture/raster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void raster_release(struct raster *r)
{
    if (!r) return;
    free(r->near);
    free(r->rgb);
    *r = (struct raster){0};
}

enum status raster_init(struct raster *r, int width, int height, const unsigned char *background, struct err *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *r = (struct raster){width, height, malloc(pixels * sizeof *r->near), background ? malloc(3 * pixels) : NULL};
    if (!r->near || (background && !r->rgb)) {
        raster_release(r);
        return err_nomem(err, "a picture", 7 * pixels);
    }
    for (size_t i = 0; i < pixels; i++) {
        r->near[i] = -HUGE_VALF;
        if (background) memcpy(r->rgb + 3 * i, background, 3);
    }
    return ST_OK;
}

void raster_triangle(struct raster *r, struct vec3 a, struct vec3 b, struct vec3 c, const unsigned char *color)
{
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (!(fabs(area) > 0)) return;
    const double low_x = fmin(a.x, fmin(b.x, c.x)), high_x = fmax(a.x, fmax(b.x, c.x));
    const double low_y = fmin(a.y, fmin(b.y, c.y)), high_y = fmax(a.y, fmax(b.y, c.y));
    if (!(high_x > 0 && high_y > 0 && low_x < r->width && low_y < r->height)) return;
    const int x0 = (int)fmax(0, floor(low_x)), x1 = (int)fmin(r->width - 1, ceil(high_x));
    const int y0 = (int)fmax(0, floor(low_y)), y1 = (int)fmin(r->height - 1, ceil(high_y));
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            const double px = x + 0.5, py = y + 0.5;
            const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
            const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
            const double w = 1 - u - v;
            if (u < 0 || v < 0 || w < 0) continue;
            const size_t at = (size_t)y * (size_t)r->width + (size_t)x;
            const float near = (float)(u * a.z + v * b.z + w * c.z);
            if (near <= r->near[at]) continue;
            r->near[at] = near;
            if (r->rgb) memcpy(r->rgb + 3 * at, color, 3);
        }
}

void raster_dot(unsigned char *rgb, int width, int height, double x, double y, double radius,
                const unsigned char color[3], double opacity)
{
    if (!(x > -radius - 1 && y > -radius - 1 && x < width + radius + 1 && y < height + radius + 1)) return;
    const int x0 = (int)fmax(0, floor(x - radius - 1)), x1 = (int)fmin(width - 1, ceil(x + radius + 1));
    const int y0 = (int)fmax(0, floor(y - radius - 1)), y1 = (int)fmin(height - 1, ceil(y + radius + 1));
    for (int j = y0; j <= y1; j++)
        for (int i = x0; i <= x1; i++) {
            const double part = opacity * fmin(1, fmax(0, radius + 0.5 - hypot(i + 0.5 - x, j + 0.5 - y)));
            unsigned char *p = rgb + 3 * ((size_t)j * (size_t)width + (size_t)i);
            for (int c = 0; c < 3; c++) p[c] = (unsigned char)(p[c] + part * (color[c] - p[c]) + 0.5);
        }
}
