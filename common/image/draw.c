/* draw.c - see draw.h. */
#include "common/image/draw.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/image/luminance.h"

static void blend(unsigned char *to, const unsigned char colour[3], double part)
{
    for (int c = 0; c < 3; c++) to[c] = (unsigned char)lround(to[c] + part * (colour[c] - to[c]));
}

/* The pixels near a segment within the picture. */
static void stroke(const struct canvas *k, double x0, double y0, double x1, double y1, double half,
                   const unsigned char colour[3])
{
    const int w = k->width, h = k->height;
    const double dx = x1 - x0, dy = y1 - y0, square = dx * dx + dy * dy, reach = half + 1;
    const int top = (int)fmin(fmax(fmin(y0, y1) - reach, 0), h);
    const int bottom = (int)fmin(fmax(fmax(y0, y1) + reach, -1), h - 1);
    for (int y = top; y <= bottom; y++) {
        /* the part of the line near this row */
        double left = fmin(x0, x1), right = fmax(x0, x1);
        if (fabs(dy) > 0) {
            const double a = x0 + (y + 0.5 - reach - y0) / dy * dx, b = x0 + (y + 0.5 + reach - y0) / dy * dx;
            left = fmax(left, fmin(a, b));
            right = fmin(right, fmax(a, b));
        }
        const int last = (int)fmin(fmax(right + reach, -1), w - 1);
        for (int x = (int)fmin(fmax(left - reach, 0), w); x <= last; x++) {
            const double px = x + 0.5 - x0, py = y + 0.5 - y0;
            const double t = square > 0 ? fmin(fmax((px * dx + py * dy) / square, 0), 1) : 0;
            const double part = half + 0.5 - hypot(px - t * dx, py - t * dy);
            if (part > 0) blend(k->rgb + 3 * ((size_t)y * (size_t)w + (size_t)x), colour, fmin(part, 1));
        }
    }
}

/* Clips the segment to the rectangle [Liang 1984]; false: nothing is left. */
static bool clip(double *x0, double *y0, double *x1, double *y1, double w, double h)
{
    const double dx = *x1 - *x0, dy = *y1 - *y0;
    const double p[4] = {-dx, dx, -dy, dy}, q[4] = {*x0, w - *x0, *y0, h - *y0};
    double from = 0, to = 1;
    for (int i = 0; i < 4; i++) {
        if (p[i] < 0)
            from = fmax(from, q[i] / p[i]);
        else if (p[i] > 0)
            to = fmin(to, q[i] / p[i]);
        else if (q[i] < 0)
            return false;
    }
    if (!(from < to)) return false;
    *x1 = *x0 + to * dx;
    *y1 = *y0 + to * dy;
    *x0 += from * dx;
    *y0 += from * dy;
    return true;
}

void draw_line(const struct canvas *k, double x0, double y0, double x1, double y1, double half,
               const unsigned char colour[3])
{
    if (clip(&x0, &y0, &x1, &y1, k->width, k->height)) stroke(k, x0, y0, x1, y1, half, colour);
}

void draw_dot(const struct canvas *k, double x, double y, double radius, const unsigned char colour[3])
{
    for (int py = (int)fmax(0, y - radius - 1); py < k->height && py <= y + radius + 1; py++)
        for (int px = (int)fmax(0, x - radius - 1); px < k->width && px <= x + radius + 1; px++) {
            const double off = hypot(px + 0.5 - x, py + 0.5 - y);
            unsigned char *to = k->rgb + 3 * ((size_t)py * (size_t)k->width + (size_t)px);
            for (int c = 0; off <= radius && c < 3; c++) to[c] = off > radius - 1 ? 0 : colour[c];
        }
}

enum status image_expose(struct image *im, double share, double level, struct err *err)
{
    const size_t pixels = (size_t)im->width * (size_t)im->height;
    float *sorted = malloc(pixels * sizeof *sorted);
    size_t count = 0;
    if (!sorted) return err_nomem(err, "a picture", pixels * sizeof *sorted);
    for (size_t i = 0; i < pixels; i++) {
        const float *p = im->data + 4 * i;
        if (p[3] > 0.5f) sorted[count++] = luminance_of(p);
    }
    sort_floats(sorted, count);
    const float limit = count ? sorted[(size_t)(share * (double)(count - 1))] : 0;
    for (size_t i = 0; limit > 0 && i < 4 * pixels; i++)
        if (i % 4 != 3) im->data[i] *= (float)level / limit;
    free(sorted);
    return ST_OK;
}
