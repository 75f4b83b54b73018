/* sigma_bins.c - whether the stated uncertainty of depth is right at each of its sizes.
 *
 * A histogram over the logarithm of sigma, with levels of 1 %, holds how many pixels there are and how many of them are
 * within one and two sigmas. It is cut into bins of as many pixels each afterwards [Guo 2017]. So memory does not grow
 * with the pixels, and their order does not matter. */
#include "stages/evaluate/views/sigma_bins.h"

#include <math.h>
#include <stdlib.h>

#define FINEST   1e-6 /* all smaller sigmas are one level */
#define COARSEST 1e3
#define LEVEL    0.01 /* of the natural logarithm */

struct sigma_level {
    uint64_t pixels, within[2];
};

static int level_count(void) { return (int)ceil(log(COARSEST / FINEST) / LEVEL) + 1; }

enum status sigma_bins_init(struct sigma_bins *b, struct err *err)
{
    const size_t count = (size_t)level_count();
    *b = (struct sigma_bins){.levels = calloc(count, sizeof *b->levels)};
    return b->levels ? ST_OK : err_nomem(err, "levels of uncertainty", count * sizeof *b->levels);
}

void sigma_bins_add(struct sigma_bins *b, double sigma, double error)
{
    const double bounded = fmin(fmax(sigma, FINEST), COARSEST);
    struct sigma_level *level = &b->levels[(int)(log(bounded / FINEST) / LEVEL)];
    level->pixels++;
    for (int k = 0; k < 2; k++) level->within[k] += error <= (k + 1) * sigma;
    b->pixels++;
}

void sigma_bins_get(const struct sigma_bins *b, struct sigma_bin bins[SIGMA_BINS])
{
    const double size = (double)b->pixels / SIGMA_BINS;
    int level = 0;
    double left = (double)b->levels[0].pixels; /* pixels of the level that are in no bin yet */
    for (int i = 0; i < SIGMA_BINS; i++) {
        double wanted = size, within[2] = {0, 0};
        while (wanted > 1e-9 * size && level < level_count()) {
            const struct sigma_level *at = &b->levels[level];
            const double taken = fmin(left, wanted);
            for (int k = 0; k < 2 && at->pixels; k++) within[k] += taken * (double)at->within[k] / (double)at->pixels;
            if (taken > 0) bins[i].most = FINEST * exp((level + 0.5) * LEVEL);
            wanted -= taken;
            left -= taken;
            if (!(left > 0) && ++level < level_count()) left = (double)b->levels[level].pixels;
        }
        for (int k = 0; k < 2; k++) bins[i].within[k] = within[k] / (size - wanted);
    }
}

void sigma_bins_release(struct sigma_bins *b)
{
    free(b->levels);
    b->levels = NULL;
}
