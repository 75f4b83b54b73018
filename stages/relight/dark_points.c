/* dark_points.c - see dark_points.h.
 *
 * Furniture's place comes from estimated depth. Where that is off, a point lies behind a wall, or in a wall that the
 * edit adds: no light comes there before or after, and the quotient is 1, or 0: a bright rim or black specks in a
 * picture whose light changes. A photograph that shows something there says that the place is wrong, not that it is
 * dark. So such pixels are filled from those beside them, ring by ring. Where all lights go out, the pixels beside them
 * have the quotient 0, and so have these. */
#include "stages/relight/dark_points.h"

#include <stdlib.h>
#include <string.h>

#include "stages/relight/quotients.h"

static const double DARK = 1e-6; /* of the picture's mean irradiance */

static double mean_light(const struct irradiance *e, size_t n)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        const double light = rgb_luminance(e[i].value);
        sum += light;
        count += light > 0;
    }
    return count ? sum / (double)count : 0;
}

enum { KNOWN, UNKNOWN, NONE };

/* The mean of the known pixels of the 8 around one; false: there are none. */
static bool mean_around(float to[4], const float (*quotient)[4], const unsigned char *state, const struct pixels *p,
                        size_t i)
{
    const int x = (int)(i % (size_t)p->width), y = (int)(i / (size_t)p->width);
    float sum[3] = {0};
    int count = 0;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++) {
            const size_t n = (size_t)v * (size_t)p->width + (size_t)u;
            if (u < 0 || v < 0 || u >= p->width || v >= p->height || state[n] != KNOWN) continue;
            for (int k = 0; k < 3; k++) sum[k] += quotient[n][k];
            count++;
        }
    if (!count) return false;
    for (int k = 0; k < 3; k++) to[k] = sum[k] / (float)count;
    to[3] = RELIT_BOUNDED;
    return true;
}

enum status dark_points_fill(float (*quotient)[4], const struct irradiance *before, const struct irradiance *after,
                             const struct pixels *p, bool things, struct err *err)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    const double dark[2] = {DARK * mean_light(before, n), DARK * mean_light(after, n)};
    unsigned char *state = malloc(n + 1);
    size_t *left = malloc((n + 1) * sizeof *left), count = 0;
    float(*means)[4] = NULL;
    if (!state || !left) err_nomem(err, "pixels", n * sizeof *left);
    for (size_t i = 0; !err->status && i < n; i++) {
        const bool is_dark = !(rgb_luminance(before[i].value) > dark[0]) || !(rgb_luminance(after[i].value) > dark[1]);
        const bool is_known = p->kind[i] == PIXEL_TEXTURE || p->kind[i] == PIXEL_CLUTTER;
        state[i] = quotient[i][3] > RELIT_NONE && is_known ? KNOWN : NONE;
        const bool is_too_bright = things && p->kind[i] == PIXEL_TEXTURE && quotient[i][3] == RELIT_BOUNDED;
        if (state[i] == NONE || !(is_too_bright || (p->kind[i] == PIXEL_CLUTTER && is_dark))) continue;
        state[i] = UNKNOWN;
        left[count++] = i;
    }
    if (!err->status && count && !(means = malloc(count * sizeof *means))) err_nomem(err, "pixels", count);
    for (size_t done = 1; !err->status && done && count; count -= done) {
        done = 0;
        for (size_t k = 0; k < count; k++) { /* all of a ring before any of it counts as known */
            const size_t at = left[k];
            if (!mean_around(means[done], (const float(*)[4])quotient, state, p, at)) continue;
            left[k] = left[done];
            left[done++] = at;
        }
        for (size_t k = 0; k < done; k++) {
            memcpy(quotient[left[k]], means[k], sizeof *quotient);
            state[left[k]] = KNOWN;
        }
        memmove(left, left + done, (count - done) * sizeof *left);
    }
    free(state);
    free(left);
    free(means);
    return err->status;
}
