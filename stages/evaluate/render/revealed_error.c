/* revealed_error.c - see revealed_error.h. */
#include "stages/evaluate/render/revealed_error.h"

#include <math.h>
#include <stdlib.h>

#include "common/image/image.h"

size_t revealed_find(uint8_t *mask, const struct true_surface *s, size_t count)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t before = s->ids[0][i], after = s->ids[1][i];
        const float near = s->depths[0][i], far = s->depths[1][i];
        const bool moved = near > 0 && far > 0 && fabsf(near - far) > (float)REVEALED_DEPTH * far;
        mask[i] = after && (before != after || moved);
        found += mask[i];
    }
    return found;
}

void revealed_kept_find(uint8_t *mask, const struct true_surface *s, size_t count)
{
    revealed_find(mask, s, count);
    for (size_t i = 0; i < count; i++) mask[i] = s->ids[0][i] && s->ids[1][i] && !mask[i];
}

static bool counts(const struct radiance_pixels *p, size_t i)
{
    return (!p->mask || p->mask[i]) && p->truth[4 * i + 3] > 0;
}

struct gain { /* sums over a face: found x true, found x found */
    double cross, square;
};

static void find_gains(struct gain *gains, const struct radiance_pixels *p, const uint32_t *ids)
{
    for (size_t i = 0; i < p->count; i++) {
        if (!counts(p, i)) continue;
        for (size_t c = 0; c < 3; c++) {
            const double found = fmin(p->clip, p->scale * (double)p->found[3 * i + c]);
            gains[ids[i]].cross += found * fmin(p->clip, (double)p->truth[4 * i + c]);
            gains[ids[i]].square += found * found;
        }
    }
}

bool revealed_psnr(double *psnr, const struct radiance_pixels *p, const uint32_t *ids)
{
    uint32_t most = 0;
    for (size_t i = 0; i < p->count; i++) most = ids[i] > most ? ids[i] : most;
    struct gain *gains = calloc((size_t)most + 1, sizeof *gains);
    double sum = 0;
    size_t samples = 0;
    if (!gains) return false;
    find_gains(gains, p, ids);
    for (size_t i = 0; i < p->count; i++) {
        if (!counts(p, i)) continue;
        const struct gain *g = &gains[ids[i]];
        const double gain = g->square > 0 ? g->cross / g->square : 1;
        for (size_t c = 0; c < 3; c++) {
            const float found = srgb_from_linear((float)(gain * p->scale * (double)p->found[3 * i + c] / p->clip));
            const float truth = srgb_from_linear((float)((double)p->truth[4 * i + c] / p->clip));
            sum += ((double)found - (double)truth) * ((double)found - (double)truth);
            samples++;
        }
    }
    free(gains);
    if (!samples) return false;
    *psnr = 10 * log10((double)samples / fmax(sum, 1e-10 * (double)samples));
    return true;
}
