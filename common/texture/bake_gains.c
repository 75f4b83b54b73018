/* bake_gains.c - bake_find_gains(): one gain a view and colour.
 *
 * Photographs of one room differ in exposure, white balance and daylight. Where two views show the same texel, the
 * median of the logarithms of their ratios says by how much. The gains are the least-squares solution of all these
 * differences, each weighted by its number of texels up to a limit, with a weak pull towards 1 that also holds a view
 * which overlaps with none. The viewpoint's own views keep the gain 1; without a viewpoint the pull alone fixes the
 * level.
 *
 * Medians come from histograms, so that memory is the same for any number of texels. The system is solved by
 * Gauss-Seidel sweeps: it is small, and each row is dominated by its diagonal. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/texture/bake.h"

enum { BINS = 121, STRIDE = 3 };             /* of the ratio's logarithm; every STRIDE-th texel counts */
enum { MIN_SHARED = 40, MAX_SHARED = 1000 }; /* texels that two views must share; more than that count no more */
enum { SWEEPS = 300 };
static const double LARGEST = 1.2; /* logarithm of a ratio in the last bin */
static const double PULL = 0.5;    /* weight of a gain of 1, in texels */
static const double DARK = 0.02;   /* of white: darker texels are left out */

/* Node 0 is the viewpoint, node 1 + i source i. */
struct ratios {
    uint16_t (*bins)[3][BINS]; /* of each pair of nodes i < j: log(colour of i / colour of j) */
    uint16_t *shared;
    double dark;
    int nodes;
};

static size_t pair_of(int i, int j) { return (size_t)j * (size_t)(j - 1) / 2 + (size_t)i; }

static void count_pair(struct ratios *r, int i, const float a[3], int j, const float b[3])
{
    if (i == j) return;
    if (i > j) {
        count_pair(r, j, b, i, a);
        return;
    }
    const size_t at = pair_of(i, j);
    for (int c = 0; c < 3; c++)
        if (!(a[c] > r->dark && b[c] > r->dark)) return;
    if (r->shared[at] == UINT16_MAX) return;
    r->shared[at]++;
    for (int c = 0; c < 3; c++) {
        const double log_ratio = log((double)a[c] / b[c]);
        const int bin = (int)lround((log_ratio / LARGEST + 1) * (BINS - 1) / 2);
        r->bins[at][c][bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin]++;
    }
}

static int node_of(const struct bake *b, int source) { return b->sources[source].own ? 0 : 1 + source; }

static void count_texel(struct ratios *r, const struct bake *b, size_t texel)
{
    const struct candidate *c = b->lists[b->list[texel]];
    const int count = b->counts[b->list[texel]];
    for (int i = 0; i < count; i++) {
        const int node = node_of(b, c[i].source);
        if (c[i].state == SOURCE_POOR) break; /* and all after it */
        if (b->role[texel] == TEXEL_ORIGINAL) count_pair(r, 0, b->rgb + 3 * texel, node, c[i].rgb);
        for (int j = i + 1; j < count && c[j].state != SOURCE_POOR; j++)
            count_pair(r, node, c[i].rgb, node_of(b, c[j].source), c[j].rgb);
    }
}

static double median_of(const uint16_t bins[BINS], int shared)
{
    int before = 0, k = 0;
    while (k < BINS - 1 && before + bins[k] < (shared + 1) / 2) before += bins[k++];
    const double inside = bins[k] ? (0.5 * shared - before) / bins[k] - 0.5 : 0;
    return ((k + inside) * 2 / (BINS - 1) - 1) * LARGEST;
}

/* gain[node]: logarithms; that of node 0 stays 0. log(gain_i colour_i) = log(gain_j colour_j) for each pair. */
static void solve(double *gain, const struct ratios *r, int channel)
{
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int i = 1; i < r->nodes; i++) {
            double sum = 0, weight = PULL;
            for (int j = 0; j < r->nodes; j++) {
                if (i == j) continue;
                const size_t at = i < j ? pair_of(i, j) : pair_of(j, i);
                if (r->shared[at] < MIN_SHARED) continue;
                const double w = r->shared[at] < MAX_SHARED ? r->shared[at] : MAX_SHARED;
                const double m = median_of(r->bins[at][channel], r->shared[at]);
                sum += w * (gain[j] + (i < j ? -m : m));
                weight += w;
            }
            gain[i] = sum / weight;
        }
}

enum status bake_find_gains(struct bake *b, struct err *err)
{
    struct ratios r = {.dark = DARK * b->white, .nodes = 1 + b->source_count};
    const size_t pairs = (size_t)r.nodes * (size_t)(r.nodes - 1) / 2 + 1;
    double *gain = malloc((size_t)r.nodes * sizeof *gain);
    r.bins = calloc(pairs, sizeof *r.bins);
    r.shared = calloc(pairs, sizeof *r.shared);
    if (!gain || !r.bins || !r.shared) err_nomem(err, "ratios of views", pairs * sizeof *r.bins);
    for (size_t i = 0; !err->status && i < b->texel_count; i++)
        if (b->list[i] >= 0 && b->list[i] % STRIDE == 0) count_texel(&r, b, i);
    for (int c = 0; !err->status && c < 3; c++) {
        memset(gain, 0, (size_t)r.nodes * sizeof *gain);
        solve(gain, &r, c);
        for (int i = 0; i < b->source_count; i++)
            b->sources[i].gain[c] = b->sources[i].own ? 1 : (float)exp(gain[1 + i]);
    }
    free(gain);
    free(r.bins);
    free(r.shared);
    return err->status;
}
