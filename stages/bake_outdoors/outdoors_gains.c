/* outdoors_gains.c - one gain for each photo, so that photos agree on the outdoors.
 *
 * Photos of different times show a street under different light. With l the logarithm of the luminance that a photo
 * shows in a cell and g that of the photo's gain, all photos of a cell should have the same g + l. The cell's level is
 * the median of theirs, or of the reference images where there are any; a photo's g is the median of level - l over its
 * cells. Both are found in turn, from g = 0, which converges in a few rounds because most photos share most of what
 * they show. Medians ignore the cells in which a frame or a curtain hides the outdoors. A photo that shares few cells
 * is pulled towards the gain 1. Without reference images the mean of all g, weighted by cells, is 0. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/weighted.h"
#include "stages/bake_outdoors/outdoors_gather.h"

enum { ROUNDS = 12 };
#define PULL    20.0  /* cells: weight of a gain of 1 */
#define DARKEST 1e-9f /* of a luminance */

/* A photo's pixel of a cell that others show too. */
struct share {
    size_t cell;
    double level; /* logarithm */
};

struct shares {
    const struct outdoors_cells *cells;
    const struct outdoors_picture *pictures;
    struct share *list; /* in order of photo */
    size_t *first;      /* of each photo, and the end */
    double *levels;     /* of each cell */
    struct weighted *scratch;
    int photos;
    bool references;
};

static int list_length(const struct outdoors_candidate list[MAX_CANDIDATES])
{
    int n = 0;
    while (n < MAX_CANDIDATES && list[n].picture >= 0) n++;
    return n;
}

static double luminance_level(const struct outdoors_candidate *c) { return log((double)fmaxf(c->luminance, DARKEST)); }

/* Whether a candidate counts, given the cell's number of candidates that measure. */
static bool counts(const struct shares *s, const struct outdoors_candidate *c, int measured)
{
    return !c->clipped && measured > 1 && !s->pictures[c->picture].reference;
}

static int count_measured(const struct outdoors_candidate list[MAX_CANDIDATES])
{
    int n = 0;
    for (int k = 0; k < list_length(list); k++) n += !list[k].clipped;
    return n;
}

static enum status list_shares(struct shares *s, struct err *err)
{
    const size_t cells = (size_t)s->cells->width * (size_t)s->cells->height;
    size_t total = 0, most = 1;
    s->first = calloc((size_t)s->photos + 2, sizeof *s->first);
    s->levels = calloc(cells, sizeof *s->levels);
    if (!s->first || !s->levels) return err_nomem(err, "cells", cells * sizeof *s->levels);
    for (size_t i = 0; i < cells; i++)
        for (int k = 0; k < list_length(s->cells->lists[i]); k++) {
            const struct outdoors_candidate *c = &s->cells->lists[i][k];
            s->references |= s->pictures[c->picture].reference;
            if (counts(s, c, count_measured(s->cells->lists[i])))
                s->first[s->pictures[c->picture].photo + 2]++, total++;
        }
    for (int p = 0; p <= s->photos; p++) {
        if (s->first[p + 1] > most) most = s->first[p + 1];
        if (p > 0) s->first[p + 1] += s->first[p];
    }
    s->list = malloc((total + 1) * sizeof *s->list);
    s->scratch = malloc((most + MAX_CANDIDATES) * sizeof *s->scratch);
    if (!s->list || !s->scratch) return err_nomem(err, "cells of photos", total * sizeof *s->list);
    for (size_t i = 0; i < cells; i++)
        for (int k = 0; k < list_length(s->cells->lists[i]); k++) {
            const struct outdoors_candidate *c = &s->cells->lists[i][k];
            if (!counts(s, c, count_measured(s->cells->lists[i]))) continue;
            s->list[s->first[s->pictures[c->picture].photo + 1]++] = (struct share){i, luminance_level(c)};
        }
    return ST_OK; /* first[p] .. first[p + 1] are the shares of photo p */
}

/* The level of a cell under the present gains. */
static double cell_level(struct shares *s, size_t cell, const double *gain)
{
    const struct outdoors_candidate *list = s->cells->lists[cell];
    int count = 0;
    for (int pass = 0; pass < 2 && !count; pass++) /* references, otherwise photos */
        for (int k = 0; k < list_length(list); k++) {
            const struct outdoors_picture *p = &s->pictures[list[k].picture];
            if (list[k].clipped || p->reference != !pass) continue;
            s->scratch[count++] = (struct weighted){luminance_level(&list[k]) + gain[p->photo], 1};
        }
    return weighted_percentile(s->scratch, (size_t)count, 0.5);
}

static double median_gain(struct shares *s, int photo)
{
    const size_t first = s->first[photo], count = s->first[photo + 1] - first;
    for (size_t k = 0; k < count; k++) {
        const struct share *share = &s->list[first + k];
        s->scratch[k] = (struct weighted){s->levels[share->cell] - share->level, 1};
    }
    return weighted_percentile(s->scratch, count, 0.5) * (double)count / ((double)count + PULL);
}

static void centre(double *gain, const struct shares *s)
{
    double sum = 0, weight = 0;
    for (int p = 0; p < s->photos; p++) {
        const double w = (double)(s->first[p + 1] - s->first[p]);
        sum += w * gain[p];
        weight += w;
    }
    for (int p = 0; p < s->photos; p++)
        if (s->first[p + 1] > s->first[p]) gain[p] -= sum / weight;
}

enum status outdoors_find_gains(double *gain, int photos, const struct outdoors_cells *cells,
                                const struct outdoors_picture *pictures, struct err *err)
{
    struct shares s = {.cells = cells, .pictures = pictures, .photos = photos};
    const size_t cell_count = (size_t)cells->width * (size_t)cells->height;
    list_shares(&s, err);
    for (int p = 0; p < photos; p++) gain[p] = 0;
    for (int round = 0; !err->status && round < ROUNDS; round++) {
        for (size_t i = 0; i < cell_count; i++)
            if (list_length(cells->lists[i]) > 1) s.levels[i] = cell_level(&s, i, gain);
        for (int p = 0; p < photos; p++)
            if (s.first[p + 1] > s.first[p]) gain[p] = median_gain(&s, p);
        if (!s.references) centre(gain, &s);
    }
    for (int p = 0; p < photos; p++) gain[p] = exp(gain[p]);
    free(s.first);
    free(s.levels);
    free(s.list);
    free(s.scratch);
    return err->status;
}
