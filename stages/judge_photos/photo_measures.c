/* photo_measures.c - edges along rows and columns, counted by their width in tenths of a pixel. */
#include "stages/judge_photos/photo_measures.h"

#include <math.h>
#include <string.h>

#include "common/image/luma.h"

enum { TENTHS = 10, MAX_WIDTH = 40, BINS = TENTHS * MAX_WIDTH };
enum { MIN_EDGES = 200 }; /* in a direction, to tell a width */
enum { MIN_HEIGHT = 36 }; /* of an edge; the luma is 0 to 255 */
enum { NOISE = 2 };       /* a step against an edge's direction that does not end it */
enum { WHITE = 252, BLACK = 5 };

struct edge_widths {
    long long bins[BINS], count;
};

static void count_edge(struct edge_widths *w, int height, int step)
{
    if (height < MIN_HEIGHT || step <= NOISE) return;
    const int bin = TENTHS * height / step;
    if (bin >= BINS) return; /* shading, not an edge */
    w->bins[bin]++;
    w->count++;
}

/* Counts the edges of one line of pixels that lie `stride` bytes apart. */
static void count_line(struct edge_widths *w, const unsigned char *luma, int count, size_t stride)
{
    int direction = 0, begin = luma[0], far = luma[0], step = 0;
    for (int i = 1; i < count; i++) {
        const int value = luma[(size_t)i * stride], change = value - luma[(size_t)(i - 1) * stride];
        if (direction == 0 || change * direction < -NOISE) {
            count_edge(w, (far - begin) * direction, step);
            begin = far = luma[(size_t)(i - 1) * stride];
            direction = change > 0 ? 1 : change < 0 ? -1 : 0;
            step = 0;
        } else if (value == far && change == 0 && (far - begin) * direction >= MIN_HEIGHT) {
            count_edge(w, (far - begin) * direction, step); /* it ends on a plateau */
            direction = 0;
            continue;
        }
        if (change * direction > step) step = change * direction;
        if ((value - far) * direction > 0) far = value;
    }
    count_edge(w, (far - begin) * direction, step);
}

/* The lower quartile, px; 0: too few edges. */
static double quartile(const struct edge_widths *w)
{
    long long below = 0;
    if (w->count < MIN_EDGES) return 0;
    for (int i = 0; i < BINS; i++) {
        below += w->bins[i];
        if (4 * below >= w->count) return (i + 0.5) / TENTHS;
    }
    return MAX_WIDTH;
}

/* Whether a square of a sixteenth of the shorter side, with this corner, is black. */
static bool is_black(const unsigned char *luma, int width, int height, bool right, bool bottom)
{
    const int side = (width < height ? width : height) / 16 + 1;
    long long black = 0;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            const int u = right ? width - 1 - x : x, v = bottom ? height - 1 - y : y;
            black += luma[(size_t)v * (size_t)width + (size_t)u] <= 4 * BLACK;
        }
    return 100 * black >= 99LL * side * side;
}

void photo_measures_take(struct photo_measures *m, const unsigned char *rgb, int width, int height, unsigned char *luma)
{
    const size_t pixels = (size_t)width * (size_t)height;
    struct edge_widths rows = {0}, columns = {0};
    long long bright = 0, dark = 0;
    for (size_t i = 0; i < pixels; i++) {
        const unsigned char *c = rgb + 3 * i;
        luma[i] = luma_of(c);
        bright += c[0] >= WHITE && c[1] >= WHITE && c[2] >= WHITE;
        dark += luma[i] <= BLACK;
    }
    for (int y = 0; y < height; y++) count_line(&rows, luma + (size_t)y * (size_t)width, width, 1);
    for (int x = 0; x < width; x++) count_line(&columns, luma + x, height, (size_t)width);
    m->edge = fmax(quartile(&rows), quartile(&columns));
    m->bright = (double)bright / (double)pixels;
    m->dark = (double)dark / (double)pixels;
    m->round = m->dark < 0.9 && is_black(luma, width, height, false, false) &&
               is_black(luma, width, height, true, false) && is_black(luma, width, height, false, true) &&
               is_black(luma, width, height, true, true);
}
