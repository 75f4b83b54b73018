/* irradiance_pictures.c - see irradiance_pictures.h.
 *
 * A picture of irradiance holds at each pixel the irradiance of the surface that the unedited scene shows there, also
 * after an edit, and 0 where that surface is gone. So pictures before and after belong together pixel by pixel, and a
 * true value is that of the one true pixel that contains the centre of a found pixel: interpolation would mix surfaces
 * with zeros. A pixel is on the model if the first face of O/model/model.txt that its ray meets lies in a plane within
 * [evaluate] surface_distance of the true point. */
#include "stages/evaluate/light/irradiance_pictures.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stages/evaluate/light/irradiance_ratio.h"
#include "stages/evaluate/measure/radiance_error.h"
#include "stages/evaluate/scene/model_pixels.h"
#include "stages/evaluate/scene/renders.h"
#include "stages/evaluate/scene/true_planes.h"

struct pictures_job {
    struct evaluation *e;
    struct model_pixels model;
    double scale; /* of found irradiance */
    struct radiance_error errors[PICTURE_PARTS];
    struct ratio_error ratios[PICTURE_PARTS];
    int before_count, pair_count; /* pictures that were measured */
    uint64_t true_pixels;         /* of the pictures before an edit, with irradiance */
};

struct compared { /* a found picture and its truth, pixel by pixel */
    struct linear_picture found;
    float *truth;                 /* R G B A; A 0: no true irradiance */
    uint8_t *part[PICTURE_PARTS]; /* NULL of PART_MODEL and PART_OTHER: unknown */
    size_t count;
};

static void compared_release(struct compared *c)
{
    linear_picture_release(&c->found);
    free(c->truth);
    for (int k = 0; k < PICTURE_PARTS; k++) free(c->part[k]);
    *c = (struct compared){0};
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status add_true_input(struct evaluation *e, const char *path, struct err *err)
{
    char name[FILE_PATH];
    snprintf(name, sizeof name, "truth%.4000s", path + strlen(e->truth_folder));
    return provenance_add_file(e->prov, name, path, err);
}

/* The irradiance of the true pixel of each found one. Sets part[PART_ALL], where something was found and is true. */
static enum status read_truth(struct pictures_job *job, struct compared *c, const struct render *r, int32_t *index,
                              struct err *err)
{
    struct linear_picture truth = {0};
    if (!add_true_input(job->e, r->truth, err)) linear_picture_read(&truth, r->truth, err);
    if (!err->status && (truth.rgb.width != r->of->lens.width || truth.rgb.height != r->of->lens.height))
        err_set(err, ST_DATA, "%s is %d x %d px, but the truth's camera is %d x %d px.", r->truth, truth.rgb.width,
                truth.rgb.height, r->of->lens.width, r->of->lens.height);
    if (!err->status) picture_true_pixels(index, truth.rgb.width, truth.rgb.height, &r->map);
    for (size_t i = 0; !err->status && i < c->count; i++) {
        if (index[i] < 0) continue;
        const float *from = truth.rgb.data + 3 * (size_t)index[i];
        memcpy(c->truth + 4 * i, from, 3 * sizeof *from);
        c->truth[4 * i + 3] = from[0] + from[1] + from[2] > 0;
        c->part[PART_ALL][i] = c->truth[4 * i + 3] > 0;
    }
    linear_picture_release(&truth);
    return err->status;
}

static enum status read_compared(struct compared *c, struct pictures_job *job, const struct renders *list,
                                 const struct render *r, struct err *err)
{
    char name[FILE_PATH], depth[FILE_PATH];
    const struct camera *lens = &r->map.lens;
    *c = (struct compared){.count = (size_t)lens->width * (size_t)lens->height};
    c->truth = calloc(4 * c->count, sizeof *c->truth);
    c->part[PART_ALL] = calloc(c->count, 1);
    int32_t *index = malloc(c->count * sizeof *index);
    if (!c->truth || !c->part[PART_ALL] || !index) err_nomem(err, "irradiance", 5 * c->count);
    if (!err->status && !file_path(name, "rendered", list->where, strrchr(r->path, '/'), err) &&
        !provenance_add_file(job->e->prov, name, r->path, err))
        linear_picture_read(&c->found, r->path, err);
    if (!err->status && (c->found.rgb.width != lens->width || c->found.rgb.height != lens->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but its camera %d x %d; render it again.", r->path, c->found.rgb.width,
                c->found.rgb.height, lens->width, lens->height);
    if (!err->status) read_truth(job, c, r, index, err);
    if (!err->status && job->model.known && true_plain_file(depth, job->e, "depth", r->of->name))
        model_pixels_find(c->part, &job->model, job->e, r->of, depth, index, c->count, err);
    free(index);
    if (err->status) compared_release(c);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- metrics */

static enum status add_metric(struct evaluation *e, const char *view, const char *name, int part, double value,
                              struct err *err)
{
    char text[64];
    snprintf(text, sizeof text, "%s%s", name, picture_part_suffixes[part]);
    return evaluation_metric(e, view, "irradiance", text, value, err);
}

/* The errors of a picture, or of all pictures (view NULL). */
static enum status add_picture_errors(struct evaluation *e, const char *view,
                                      const struct radiance_error errors[PICTURE_PARTS], struct err *err)
{
    for (int k = 0; !err->status && k < PICTURE_PARTS; k++) {
        double rms;
        if (radiance_error_rms(&errors[k], &rms)) add_metric(e, view, "picture_rms", k, 100 * rms, err);
        if (!err->status && errors[k].errors.count)
            add_metric(e, view, "picture_error50", k, 100 * quantiles_get(&errors[k].errors, 0.5), err);
    }
    return err->status;
}

static enum status add_ratio_errors(struct evaluation *e, const char *view,
                                    const struct ratio_error ratios[PICTURE_PARTS], struct err *err)
{
    for (int k = 0; !err->status && k < PICTURE_PARTS; k++) {
        const struct ratio_error *r = &ratios[k];
        if (!r->pixels || !(r->reference > 0)) continue;
        if (!add_metric(e, view, "ratio_rms", k, 100 * sqrt(r->square / r->reference), err) &&
            !add_metric(e, view, "ratio_change", k, 100 * sqrt(r->change / r->reference), err) &&
            !add_metric(e, view, "ratio_error50", k, 100 * quantiles_get(&r->errors, 0.5), err))
            add_metric(e, view, "ratio_error90", k, 100 * quantiles_get(&r->errors, 0.9), err);
    }
    const uint64_t missing = ratios[PART_ALL].missing, all = missing + ratios[PART_ALL].pixels;
    if (!err->status && all) add_metric(e, view, "ratio_missing", PART_ALL, 100 * (double)missing / (double)all, err);
    return err->status;
}

/* Measures a picture before any edit, or after one (view "edited-E/NAME"), and adds it to the job's sums if `sum`. */
static enum status measure_picture(struct pictures_job *job, const struct compared *c, const char *view, bool sum,
                                   struct err *err)
{
    struct radiance_error errors[PICTURE_PARTS] = {{0}};
    uint8_t *mask = malloc(c->count);
    if (!mask) err_nomem(err, "a mask", c->count);
    for (int k = 0; !err->status && k < PICTURE_PARTS; k++) {
        if (radiance_error_init(&errors[k], err) || !c->part[k]) continue;
        for (size_t i = 0; i < c->count; i++) mask[i] = c->part[k][i] && c->found.known[i];
        const struct radiance_pixels p = {c->found.rgb.data, c->truth, mask, c->count, job->scale, 0};
        radiance_error_add(&errors[k], &p);
        if (sum) radiance_error_add(&job->errors[k], &p);
    }
    for (size_t i = 0; !err->status && sum && i < c->count; i++) job->true_pixels += c->part[PART_ALL][i];
    if (!err->status) add_picture_errors(job->e, view, errors, err);
    for (int k = 0; k < PICTURE_PARTS; k++) radiance_error_release(&errors[k]);
    free(mask);
    return err->status;
}

/* R G B of the truth without its fourth channel. */
static float *without_alpha(const struct compared *c)
{
    float *rgb = malloc(3 * c->count * sizeof *rgb);
    for (size_t i = 0; rgb && i < c->count; i++) memcpy(rgb + 3 * i, c->truth + 4 * i, 3 * sizeof *rgb);
    return rgb;
}

/* Adds the ratio of two pictures to the sums of the job and of the edit, and the picture's own to the table. */
static enum status measure_ratio(struct pictures_job *job, struct ratio_error of_edit[PICTURE_PARTS],
                                 const struct compared *a, const struct compared *b, const char *view, struct err *err)
{
    struct ratio_error own[PICTURE_PARTS] = {{0}};
    uint8_t *known = malloc(a->count);
    float *before = without_alpha(a), *after = without_alpha(b);
    if (!known || !before || !after) err_nomem(err, "ratios", 6 * a->count * sizeof *before);
    for (size_t i = 0; !err->status && i < a->count; i++) known[i] = a->found.known[i] && b->found.known[i];
    for (int k = 0; !err->status && k < PICTURE_PARTS; k++) {
        if (ratio_error_init(&own[k], err) || !a->part[k]) continue;
        const struct ratio_pixels p = {a->found.rgb.data, b->found.rgb.data, known, before, after,
                                       a->part[k],        a->count};
        ratio_error_add(&own[k], &p);
        ratio_error_add(&of_edit[k], &p);
        ratio_error_add(&job->ratios[k], &p);
    }
    if (!err->status) add_ratio_errors(job->e, view, own, err);
    for (int k = 0; k < PICTURE_PARTS; k++) ratio_error_release(&own[k]);
    free(known);
    free(before);
    free(after);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- sets */

/* renders_find() in RENDERED, or if it has no such folder, in FOLDER/relight. */
static enum status find_pictures(struct renders *list, struct evaluation *e, const struct true_set *set,
                                 struct err *err)
{
    char folder[FILE_PATH], relight[FILE_PATH], beside[FILE_PATH];
    const char *rendered = e->rendered;
    if (file_path(folder, rendered, set->where, "", err) || file_path(relight, e->folder, "relight", "", err) ||
        file_path(beside, relight, set->where, "", err))
        return err->status;
    if (!path_is_folder(folder) && path_is_folder(beside)) e->rendered = relight;
    renders_find(list, e, set, err);
    e->rendered = rendered;
    int kept = 0, encoded = 0;
    for (int i = 0; !err->status && i < list->count; i++) {
        const char *dot = strrchr(list->list[i].path, '.');
        const bool linear = dot && !strcmp(dot, ".exr");
        encoded += !linear;
        if (linear) list->list[kept++] = list->list[i];
    }
    if (!err->status) list->count = kept;
    if (!err->status && encoded)
        metric_note(&e->table, err, "skipped %d pictures of %s: irradiance is compared in EXR files alone", encoded,
                    set->prefix);
    return err->status;
}

static enum status measure_pair(struct pictures_job *job, struct ratio_error of_edit[PICTURE_PARTS],
                                const struct renders *list, const struct render *r, const struct renders *before,
                                int *unpaired, struct err *err)
{
    const struct render *first = renders_partner(before, r);
    struct compared a = {0}, b = {0};
    char view[400];
    snprintf(view, sizeof view, "%s/%s", list->set->where, r->name);
    if (!read_compared(&b, job, list, r, err)) measure_picture(job, &b, view, false, err);
    if (!err->status && !first) {
        (*unpaired)++;
    } else if (!err->status) {
        if (!read_compared(&a, job, before, first, err)) measure_ratio(job, of_edit, &a, &b, view, err);
        job->pair_count++;
    }
    compared_release(&a);
    compared_release(&b);
    return err->status;
}

static enum status measure_edit(struct pictures_job *job, const char *where, const struct renders *before,
                                struct err *err)
{
    struct evaluation *e = job->e;
    struct true_set set = {0};
    struct renders list = {0};
    struct ratio_error of_edit[PICTURE_PARTS] = {{0}};
    int unpaired = 0;
    true_set_read(&set, e->truth_folder, where, e->prov, err);
    if (!err->status && set.count) find_pictures(&list, e, &set, err);
    for (int k = 0; !err->status && k < PICTURE_PARTS; k++) ratio_error_init(&of_edit[k], err);
    for (int i = 0; !err->status && i < list.count; i++)
        measure_pair(job, of_edit, &list, &list.list[i], before, &unpaired, err);
    if (!err->status) add_ratio_errors(e, where, of_edit, err);
    if (!err->status && unpaired)
        metric_note(&e->table, err,
                    "skipped the ratios of %d pictures of %s: irradiance/ has no picture of the same name and camera",
                    unpaired, set.prefix);
    for (int k = 0; k < PICTURE_PARTS; k++) ratio_error_release(&of_edit[k]);
    renders_release(&list);
    true_set_release(&set);
    return err->status;
}

static enum status measure_edits(struct pictures_job *job, const struct renders *before, struct err *err)
{
    struct evaluation *e = job->e;
    struct true_edits edits = {0};
    char where[64], folder[FILE_PATH];
    int with_truth = 0;
    true_edits_find(&edits, e->truth_folder, err);
    for (int i = 0; !err->status && i < edits.count; i++) {
        snprintf(where, sizeof where, "edited-%s/irradiance", edits.names[i]);
        if (file_path(folder, e->truth_folder, where, "", err) || !path_is_folder(folder)) continue;
        with_truth++;
        measure_edit(job, where, before, err);
    }
    if (!err->status && !with_truth)
        metric_note(&e->table, err, "skipped ratios of irradiance: the truth has no edited-E/irradiance");
    if (!err->status && job->pair_count &&
        !evaluation_metric(e, NULL, "irradiance", "ratio_pictures", job->pair_count, err))
        add_ratio_errors(e, NULL, job->ratios, err);
    true_edits_release(&edits);
    return err->status;
}

/* Without radiance.scale: the median ratio over all pixels of the pictures before an edit; 0 if they are black. */
static enum status find_scale(struct pictures_job *job, const struct renders *before, struct err *err)
{
    struct quantiles ratios = {0};
    job->scale = job->e->radiance_scale;
    if (job->scale > 0 || !before->count) return ST_OK;
    quantiles_init(&ratios, err);
    for (int i = 0; !err->status && i < before->count; i++) {
        struct compared c = {0};
        read_compared(&c, job, before, &before->list[i], err);
        const struct radiance_pixels p = {c.found.rgb.data, c.truth, c.found.known, c.count, 1, 0};
        if (!err->status) radiance_ratios_add(&ratios, &p);
        compared_release(&c);
    }
    if (!err->status && ratios.count) {
        job->scale = quantiles_get(&ratios, 0.5);
        metric_note(&job->e->table, err,
                    "note: the scale of pictures of irradiance is their median ratio %.5g, because no view of a "
                    "photo with a true radiance gives it",
                    job->scale);
    }
    quantiles_release(&ratios);
    return err->status;
}

static enum status measure_before(struct pictures_job *job, const struct renders *before, struct err *err)
{
    for (int i = 0; !err->status && i < before->count; i++) {
        struct compared c = {0};
        if (!read_compared(&c, job, before, &before->list[i], err))
            measure_picture(job, &c, before->list[i].name, true, err);
        compared_release(&c);
        job->before_count++;
    }
    if (err->status || !job->before_count) return err->status;
    if (evaluation_metric(job->e, NULL, "irradiance", "pictures", job->before_count, err)) return err->status;
    const double all = (double)job->true_pixels, found = (double)job->errors[PART_ALL].pixels;
    if (all > 0 && add_metric(job->e, NULL, "picture_missing", PART_ALL, 100 * (all - found) / all, err))
        return err->status;
    return add_picture_errors(job->e, NULL, job->errors, err);
}

enum status evaluate_irradiance_pictures(struct evaluation *e, struct err *err)
{
    struct pictures_job job = {.e = e};
    struct true_set set = {0};
    struct renders before = {0};
    true_set_read(&set, e->truth_folder, "irradiance", e->prov, err);
    if (!err->status && !set.count)
        return metric_note(&e->table, err, "skipped pictures of irradiance: the truth has none (irradiance/NAME.exr)");
    for (int k = 0; !err->status && k < PICTURE_PARTS; k++)
        if (!radiance_error_init(&job.errors[k], err)) ratio_error_init(&job.ratios[k], err);
    if (!err->status && !find_pictures(&before, e, &set, err) && before.count &&
        !model_pixels_read(&job.model, e, "model", "pictures of irradiance", err) && !find_scale(&job, &before, err) &&
        !measure_before(&job, &before, err))
        measure_edits(&job, &before, err);
    for (int k = 0; k < PICTURE_PARTS; k++) {
        radiance_error_release(&job.errors[k]);
        ratio_error_release(&job.ratios[k]);
    }
    model_pixels_release(&job.model);
    renders_release(&before);
    true_set_release(&set);
    return err->status;
}
