/* material_samples.c - lobes of any width from light that was gathered once.
 *
 * A fit tries many lobes on the same light. Integrating each of them over directions costs a power or an exponential
 * per direction. But both lobes are exp(-s t), with t(direction) free of unknowns (material_samples.h), so that their
 * integral is a Laplace transform of the light's distribution over t:
 *   I(s) = sum w_k exp(-s t_k),   dI / d ln s = -s sum w_k t_k exp(-s t_k)
 * The distribution is kept at nodes t_j = a (e^(h j) - 1), which are as fine as the narrowest lobe needs near 0 and
 * have a constant ratio beyond. A weight is shared by the two nodes about its t so that the sums of w and of w t are
 * kept. The exponential is then replaced by its chord: too large by at most (h (s t + s a))^2 / 8 exp(-s t), 1e-4 of
 * the lobe's peak. All rows share the nodes: an evaluation takes one exponential per node, and sums that run over
 * contiguous rows.
 *
 * Phong is the form of [Colburn 2014, A.1.10] with the cosine cancelled, Ward the isotropic model of [Ward 1992]. */
#include "stages/fit_materials/material_samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/light/fast.h"
#include "common/math/numbers.h"

enum { NODES = 480 };
#define NODE_START 2e-4  /* a */
#define NODE_RATIO 0.024 /* h */
#define T_MAX      18.0  /* beyond, exp(-18) of the widest lobe is left out; below the last node */
#define S_T_MAX    40.0  /* nodes beyond this s t are left out */
#define BLOCK      128   /* rows whose sums stay in the cache */

void material_samples_release(struct material_samples *s)
{
    if (!s) return;
    free(s->point);
    free(s->radiance);
    free(s->variance);
    free(s->irradiance);
    free(s->node);
    for (int k = 0; k < 2; k++) free(s->lobe[k]);
    *s = (struct material_samples){0};
}

enum status material_samples_init(struct material_samples *s, int count, struct err *err)
{
    const size_t rows = 3 * (size_t)count, items = rows ? rows : 1;
    *s = (struct material_samples){.count = count};
    s->point = calloc(items, sizeof *s->point);
    s->radiance = calloc(items, sizeof *s->radiance);
    s->variance = calloc(items, sizeof *s->variance);
    s->irradiance = calloc(items, sizeof *s->irradiance);
    s->node = calloc(NODES, sizeof *s->node);
    for (int k = 0; k < 2; k++) s->lobe[k] = calloc(items * NODES, sizeof *s->lobe[k]);
    for (int j = 0; s->node && j < NODES; j++) s->node[j] = NODE_START * expm1(NODE_RATIO * j);
    if (s->node && s->point && s->radiance && s->variance && s->irradiance && s->lobe[0] && s->lobe[1]) return ST_OK;
    material_samples_release(s);
    return err_nomem(err, "the samples of a material", rows * (2 * NODES + 4) * sizeof(double));
}

/* Adds weights at t to the two nodes about it. */
static void add_at(struct material_samples *s, int kind, int i, double t, const double weight[3])
{
    if (!(t < T_MAX)) return;
    const int j = (int)(log1p(t / NODE_START) / NODE_RATIO);
    const double here = s->node[j], share = clamp((t - here) / (s->node[j + 1] - here), 0, 1);
    const size_t rows = 3 * (size_t)s->count;
    double *to = s->lobe[kind] + (size_t)j * rows + 3 * (size_t)i;
    for (int c = 0; c < 3; c++) {
        to[c] += weight[c] * (1 - share);
        to[rows + (size_t)c] += weight[c] * share;
    }
}

void material_samples_add(struct material_samples *s, int i, struct vec3 normal, struct vec3 view,
                          struct vec3 direction, struct rgb flux)
{
    const double cos_l = vec3_dot(normal, direction), cos_v = vec3_dot(normal, view);
    if (!(cos_l > 0) || !(cos_v > 0)) return;
    const double weight[3] = {flux.r, flux.g, flux.b};
    /* 1 - cos of the angle to the mirror direction, from the difference, which does not cancel */
    const struct vec3 mirror = vec3_sub(vec3_scale(normal, 2 * cos_v), view), apart = vec3_sub(direction, mirror);
    const double off = 0.5 * vec3_dot(apart, apart);
    if (off < 1) add_at(s, 0, i, -log1p(-off), weight);
    /* tan^2(N,H): the part of V + L across the normal over the part along it */
    const struct vec3 sum = vec3_add(view, direction);
    const double along = cos_l + cos_v;
    const struct vec3 across = vec3_sub(sum, vec3_scale(normal, along));
    const double scale = sqrt(cos_l / cos_v), ward[3] = {flux.r * scale, flux.g * scale, flux.b * scale};
    add_at(s, 1, i, vec3_dot(across, across) / (along * along), ward);
}

double material_lobe_log_s(enum brdf_kind kind, double shape)
{
    return kind == BRDF_WARD ? -2 * log(shape) : log(shape);
}

double material_lobe_shape(enum brdf_kind kind, double log_s)
{
    return kind == BRDF_WARD ? clamp(exp(-0.5 * log_s), WARD_MIN, WARD_MAX) : clamp(exp(log_s), PHONG_MIN, PHONG_MAX);
}

double material_lobe_ks(enum brdf_kind kind, double log_s)
{
    return kind == BRDF_WARD ? 1 : (exp(log_s) + 1) / (2 * PI);
}

/* sums[0][r] += factor lobe[r], sums[1][r] += slope lobe[r] for the rows of a block. */
static void add_node(double sums[2][BLOCK], const double *restrict lobe, int rows, double factor, double slope)
{
    for (int r = 0; r < rows; r++) sums[0][r] += factor * lobe[r];
    if (slope != 0)
        for (int r = 0; r < rows; r++) sums[1][r] += slope * lobe[r];
}

void material_lobe_integrals(const struct material_samples *s, enum brdf_kind kind, double log_s, double *value,
                             double *slope)
{
    const double width = exp(log_s);
    /* Ward: ks / (4 pi alpha^2) = s / (4 pi) */
    const double scale = kind == BRDF_WARD ? width / (4 * PI) : (width + 1) / (2 * PI);
    const double growth = kind == BRDF_WARD ? 1 : width / (width + 1); /* d ln scale / d ln s */
    const size_t rows = 3 * (size_t)s->count;
    const double *lobe = s->lobe[kind == BRDF_WARD];
    double factor[NODES], fall[NODES];
    int nodes = 0;
    for (; nodes < NODES && width * s->node[nodes] < S_T_MAX; nodes++) {
        const double st = width * s->node[nodes];
        factor[nodes] = scale * exp(-st);
        fall[nodes] = slope ? (growth - st) * factor[nodes] : 0;
    }
    for (size_t from = 0; from < rows; from += BLOCK) {
        const size_t count = rows - from < BLOCK ? rows - from : BLOCK;
        double sums[2][BLOCK] = {{0}};
        for (int j = 0; j < nodes; j++) add_node(sums, lobe + (size_t)j * rows + from, (int)count, factor[j], fall[j]);
        memcpy(value + from, sums[0], count * sizeof *value);
        if (slope) memcpy(slope + from, sums[1], count * sizeof *slope);
    }
}
