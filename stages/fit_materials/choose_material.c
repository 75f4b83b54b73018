/* choose_material.c - model selection by cross-validation.
 *
 * A model with more unknowns always fits its own samples better. Whether it is nearer to the surface shows on samples
 * that it was not fitted to: the points of the surface are dealt to FOLDS groups, and each group is predicted by fits
 * to the others. All samples of a point are in one group, because they share its texture.
 *
 * d_p = sum over the samples of point p of the loss of Lambert less that of the glossy model; its mean over points, and
 * the standard error of the mean, tell whether the lobe is needed: the simpler model stays unless the gain exceeds
 * MIN_GAIN standard errors [Hastie 2009, 7.10]. Of two glossy models that are needed, the one with the smaller error is
 * chosen. All losses are in units of the smallest residual scale of the fits to all samples. */
#include "stages/fit_materials/choose_material.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/rng.h"

enum { FOLDS = 5, MIN_POINTS = 6 };
#define MIN_GAIN 2.0

/* Groups of samples that share a point. */
static int count_points(const struct material_samples *s)
{
    int count = 0;
    for (int i = 0; i < s->count; i++) count += !i || s->point[i] != s->point[i - 1];
    return count;
}

/* The fold of each sample: points in blocks of FOLDS, each block dealt in random order. */
static void deal(int *fold, const struct material_samples *s)
{
    const struct rng rng = rng_make(0, "fit_materials", "folds");
    int order[FOLDS], at = -1;
    for (int i = 0; i < s->count; i++) {
        if (!i || s->point[i] != s->point[i - 1]) at++;
        const int block = at / FOLDS;
        for (int k = 0; k < FOLDS; k++) order[k] = k;
        for (int k = FOLDS - 1; k > 0; k--) {
            const int other = (int)(rng_u32(&rng, (uint64_t)block, (uint64_t)k) % (uint32_t)(k + 1)), kept = order[k];
            order[k] = order[other];
            order[other] = kept;
        }
        fold[i] = order[at % FOLDS];
    }
}

struct validation {
    const struct material_samples *s;
    double scale;
    int *fold;
    bool *used;
    double *scratch, *losses[MATERIAL_KINDS]; /* [count] of held-out samples */
};

static void validation_release(struct validation *v)
{
    free(v->fold);
    free(v->used);
    free(v->scratch);
    for (int k = 0; k < MATERIAL_KINDS; k++) free(v->losses[k]);
}

static enum status validation_init(struct validation *v, const struct material_samples *s, struct err *err)
{
    const size_t count = (size_t)s->count + 1;
    *v = (struct validation){.s = s, .scale = INFINITY};
    v->fold = calloc(count, sizeof *v->fold);
    v->used = calloc(count, sizeof *v->used);
    v->scratch = calloc(count, sizeof *v->scratch);
    bool ok = v->fold && v->used && v->scratch;
    for (int k = 0; k < MATERIAL_KINDS; k++) ok = (v->losses[k] = calloc(count, sizeof *v->losses[k])) && ok;
    if (ok) return ST_OK;
    validation_release(v);
    return err_nomem(err, "the cross-validation of a material", 6 * count * sizeof(double));
}

/* The losses of the samples of one fold, predicted from the others. */
static enum status hold_out(struct validation *v, const struct material_fit *full, int fold, struct err *err)
{
    struct material_fit part;
    for (int i = 0; i < v->s->count; i++) v->used[i] = v->fold[i] != fold;
    if (material_fit_again(&part, full, v->s, v->used, err) ||
        material_fit_losses(v->scratch, &part, v->s, v->scale, err))
        return err->status;
    for (int i = 0; i < v->s->count; i++)
        if (v->fold[i] == fold) v->losses[full->kind][i] = v->scratch[i];
    return ST_OK;
}

/* Mean and standard error over points of the gain of a model. */
static void measure_gain(struct material_choice *c, const struct validation *v, enum brdf_kind kind)
{
    const struct material_samples *s = v->s;
    double sum = 0, squares = 0, gain = 0;
    int points = 0;
    for (int i = 0; i < s->count; i++) {
        gain += v->losses[BRDF_LAMBERT][i] - v->losses[kind][i];
        if (i + 1 < s->count && s->point[i + 1] == s->point[i]) continue;
        sum += gain;
        squares += gain * gain;
        gain = 0;
        points++;
    }
    const double mean = sum / points, variance = fmax(0, squares / points - mean * mean);
    const double per_channel = (double)points / (3.0 * s->count);
    c->gain[kind] = mean * per_channel;
    c->gain_error[kind] = points > 1 ? sqrt(variance / (points - 1)) * per_channel : 0;
}

static enum status validate(struct material_choice *c, struct validation *v, struct err *err)
{
    for (int k = 0; k < MATERIAL_KINDS; k++)
        if (c->fitted[k]) v->scale = fmin(v->scale, c->fit[k].scale);
    deal(v->fold, v->s);
    for (int k = 0; k < MATERIAL_KINDS; k++) {
        if (!c->fitted[k]) continue;
        for (int fold = 0; fold < FOLDS; fold++)
            if (hold_out(v, &c->fit[k], fold, err)) return err->status;
        double sum = 0;
        for (int i = 0; i < v->s->count; i++) sum += v->losses[k][i];
        c->error[k] = sum / (3.0 * v->s->count);
        measure_gain(c, v, (enum brdf_kind)k);
    }
    c->folds = FOLDS;
    return ST_OK;
}

static bool is_needed(const struct material_choice *c, enum brdf_kind kind)
{
    return c->fitted[kind] && c->fit[kind].gloss_known && c->fit[kind].ks > 0 &&
           c->gain[kind] > MIN_GAIN * c->gain_error[kind];
}

static void decide(struct material_choice *c)
{
    c->kind = BRDF_LAMBERT;
    const bool phong = is_needed(c, BRDF_PHONG), ward = is_needed(c, BRDF_WARD);
    if (!phong && !ward) {
        const bool any = c->fit[BRDF_PHONG].gloss_known || c->fit[BRDF_WARD].gloss_known;
        c->why = any ? "no lobe predicts held-out samples better by more than the error of the comparison"
                     : "the samples do not tell a lobe from the diffuse part";
        return;
    }
    c->kind = phong && (!ward || c->error[BRDF_PHONG] <= c->error[BRDF_WARD]) ? BRDF_PHONG : BRDF_WARD;
    c->why = phong && ward ? "both lobes predict held-out samples better than none, and this one best"
                           : "this lobe alone predicts held-out samples better than none";
}

/* Fits one model and validates it against Lambert. */
static enum status fit_kinds(struct material_choice *c, const struct material_samples *s, const bool kinds[3],
                             struct err *err)
{
    struct validation v;
    *c = (struct material_choice){0};
    for (int k = 0; k < MATERIAL_KINDS; k++) {
        if (!kinds[k]) continue;
        if (material_fit(&c->fit[k], s, (enum brdf_kind)k, NULL, err)) return err->status;
        c->fitted[k] = true;
    }
    if (count_points(s) < MIN_POINTS) return ST_OK;
    if (validation_init(&v, s, err)) return err->status;
    validate(c, &v, err);
    validation_release(&v);
    return err->status;
}

enum status material_choose(struct material_choice *c, const struct material_samples *s, struct err *err)
{
    const bool enough = count_points(s) >= MIN_POINTS, kinds[3] = {true, enough, enough};
    if (fit_kinds(c, s, kinds, err)) return err->status;
    if (c->folds)
        decide(c);
    else
        c->why = "the samples are of too few points to hold any out";
    return ST_OK;
}

enum status material_declared(struct material_choice *c, const struct material_samples *s, enum brdf_kind kind,
                              struct err *err)
{
    const bool kinds[3] = {true, kind == BRDF_PHONG, kind == BRDF_WARD};
    if (fit_kinds(c, s, kinds, err)) return err->status;
    c->kind = kind;
    c->why = "declared";
    if (kind == BRDF_LAMBERT || c->fit[kind].gloss_known) return ST_OK;
    return err_set(
        err, ST_DATA,
        "the %d samples do not tell a lobe of model %s from the diffuse part; add views from other directions, "
        "draw the region where a highlight is seen, or declare it lambert.",
        s->count, material_kind_name(kind));
}
