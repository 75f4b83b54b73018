/* evaluate_relit.c - pictures of edited scenes under the light that the edit makes: edited.E.relit_*,
 * edited.E.unlit_psnr.
 *
 * Relit pictures are RENDERED/relit-E/NAME, and RENDERED/edited-E/NAME are those before they were relit; if there is no
 * RENDERED/relit-E, they are FOLDER/relight/E/VIEW.exr and FOLDER/relight/E/unlit/VIEW.exr. Both are compared with
 * TRUTH/edited-E/hdr over the pixels that show the same surface before and after the edit, and whose true light
 * changes. What the edit reveals is measured apart. */
#include "stages/evaluate/light/light_metrics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/exr.h"
#include "stages/evaluate/light/relit_error.h"
#include "stages/evaluate/render/revealed_error.h"
#include "stages/evaluate/scene/model_pixels.h"
#include "stages/evaluate/scene/renders.h"
#include "stages/evaluate/scene/true_planes.h"

enum { MIN_PIXELS = 200 }; /* of a picture, for values of its own */
static const double MAX_HALF = 65504;

struct relit_sums { /* by part of the picture */
    struct encoded_error relit[PICTURE_PARTS], unlit[PICTURE_PARTS], limit[PICTURE_PARTS], revealed[PICTURE_PARTS];
    struct quantiles ratios[PICTURE_PARTS];
    uint64_t pixels[PICTURE_PARTS], all; /* that are compared; of the pictures */
};

struct relit_job {
    struct evaluation *e;
    const struct true_set *set;
    struct renders relit, unlit;
    struct model_pixels model; /* after the edit */
    struct relit_sums sums;    /* of the edit */
    int unpaired, by_radiance; /* pictures */
};

/* What is true at the pixels of a picture, and which of them are compared. */
struct relit_truth {
    float *before, *after; /* irradiance, or radiance; R G B */
    bool is_irradiance;
    uint8_t *kept, *revealed, *mask, *part[PICTURE_PARTS]; /* PART_MODEL and PART_OTHER may be NULL */
    size_t count;
};

static enum status sums_init(struct relit_sums *s, struct err *err)
{
    *s = (struct relit_sums){.all = 0};
    for (int k = 0; k < PICTURE_PARTS; k++)
        if (quantiles_init(&s->ratios[k], err)) return err->status;
    return ST_OK;
}

static void sums_release(struct relit_sums *s)
{
    for (int k = 0; k < PICTURE_PARTS; k++) quantiles_release(&s->ratios[k]);
}

static void truth_release_all(struct relit_truth *t)
{
    free(t->before);
    free(t->after);
    free(t->kept);
    free(t->revealed);
    free(t->mask);
    for (int k = 0; k < PICTURE_PARTS; k++) free(t->part[k]);
}

/* -------------------------------------------------------------------------------------------------------- the truth */

/* The true light before and after the edit. Without pictures of irradiance the radiance decides. *found: there is
 * either. */
static enum status read_light(struct relit_truth *t, bool *found, struct relit_job *job, const struct render *r,
                              struct err *err)
{
    char before[FILE_PATH], after[FILE_PATH];
    t->is_irradiance = true_plain_file(before, job->e, "irradiance", r->of->name) &&
                       true_set_file(after, job->set, "irradiance", r->of->name);
    *found = t->is_irradiance;
    if (!*found) *found = true_plain_file(before, job->e, "hdr", r->of->name);
    if (!*found) return ST_OK;
    if (true_colours_seen(t->before, job->e, before, &r->map, err)) return err->status;
    return true_colours_seen(t->after, job->e, t->is_irradiance ? after : r->truth, &r->map, err);
}

/* Which pixels are on the model after the edit. */
static enum status read_parts(struct relit_truth *t, struct relit_job *job, const struct render *r, struct err *err)
{
    char depth[FILE_PATH];
    if (!job->model.known || !true_set_file(depth, job->set, "depth", r->of->name)) return ST_OK;
    int32_t *index = malloc(t->count * sizeof *index);
    if (!index) return err_nomem(err, "pixels", t->count * sizeof *index);
    picture_true_pixels(index, r->of->lens.width, r->of->lens.height, &r->map);
    model_pixels_find(t->part, &job->model, job->e, r->of, depth, index, t->count, err);
    free(index);
    return err->status;
}

/* *found is false if the truth lacks ids, depth or light of this picture. */
static enum status read_truth(struct relit_truth *t, bool *found, struct relit_job *job, const struct render *r,
                              struct err *err)
{
    struct surface_planes planes;
    *t = (struct relit_truth){.count = (size_t)r->map.lens.width * (size_t)r->map.lens.height};
    t->before = malloc(3 * t->count * sizeof *t->before);
    t->after = malloc(3 * t->count * sizeof *t->after);
    t->kept = malloc(t->count);
    t->revealed = malloc(t->count);
    t->mask = malloc(t->count);
    t->part[PART_ALL] = malloc(t->count);
    true_planes_read(&planes, found, job->e, job->set, r->of->name, &r->map, err);
    if (!err->status && !(t->before && t->after && t->kept && t->revealed && t->mask && t->part[PART_ALL]))
        err_nomem(err, "true light", 6 * t->count * sizeof *t->before);
    if (!err->status && *found) {
        const struct true_surface surface = {{planes.ids[0], planes.ids[1]}, {planes.depths[0], planes.depths[1]}};
        memset(t->part[PART_ALL], 1, t->count);
        revealed_kept_find(t->kept, &surface, t->count);
        revealed_find(t->revealed, &surface, t->count);
        read_light(t, found, job, r, err);
    }
    if (!err->status && *found) {
        relit_changes_keep(t->kept, t->before, t->after, t->count);
        read_parts(t, job, r, err);
    }
    true_planes_release(&planes);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- pictures */

static void choose(struct relit_truth *t, const uint8_t *from, int part)
{
    for (size_t i = 0; i < t->count; i++) t->mask[i] = t->part[part] && t->part[part][i] && from[i];
}

static void add_picture(struct relit_sums *s, struct relit_truth *t, const struct render *relit,
                        const struct render *unlit, const struct image *truth, double white)
{
    struct radiance_pixels r = {relit->picture.rgb.data, truth->data, t->mask, t->count, relit->scale, white};
    const struct radiance_pixels u = {unlit->picture.rgb.data, truth->data, t->mask, t->count, unlit->scale, white};
    s->all += t->count;
    for (int k = 0; k < PICTURE_PARTS; k++) {
        choose(t, t->revealed, k);
        relit_encoded_error_add(&s->revealed[k], &r);
        choose(t, t->kept, k);
        relit_encoded_error_add(&s->relit[k], &r);
        relit_encoded_error_add(&s->unlit[k], &u);
        for (size_t i = 0; i < t->count; i++) s->pixels[k] += t->mask[i] && truth->data[4 * i + 3] > 0;
    }
}

/* What the picture in the old light would show if its change of light were the true one. */
static void add_limit(struct relit_sums *s, struct relit_truth *t, const struct render *unlit,
                      const struct image *truth, const float *best, double white)
{
    const struct radiance_pixels p = {best, truth->data, t->mask, t->count, unlit->scale, white};
    for (int k = 0; k < PICTURE_PARTS; k++) {
        choose(t, t->kept, k);
        relit_encoded_error_add(&s->limit[k], &p);
    }
}

static enum status add_limits(struct relit_sums *own, struct relit_job *job, struct relit_truth *t,
                              const struct render *unlit, const struct image *truth, struct err *err)
{
    if (!t->is_irradiance) return ST_OK;
    const size_t size = 3 * t->count * sizeof(float);
    float *best = malloc(size);
    if (!best) return err_nomem(err, "a picture in the true light", size);
    memcpy(best, unlit->picture.rgb.data, size);
    relit_change_apply(best, t->before, t->after, t->kept, t->count);
    add_limit(own, t, unlit, truth, best, job->e->white);
    add_limit(&job->sums, t, unlit, truth, best, job->e->white);
    free(best);
    return ST_OK;
}

/* The quotients beside a relit picture, NAME-ratio.exr, if there are any. */
static enum status add_quotients(struct relit_sums *own, struct relit_job *job, struct relit_truth *t,
                                 const struct render *r, struct err *err)
{
    struct linear_picture q = {0};
    char name[FILE_PATH], path[FILE_PATH];
    const size_t stem = strlen(r->path) - strlen(strrchr(r->path, '.'));
    snprintf(path, sizeof path, "%.*s-ratio.exr", (int)stem, r->path);
    if (!t->is_irradiance || !path_is_file(path)) return ST_OK;
    if (!file_path(name, "rendered", job->relit.where, strrchr(path, '/'), err) &&
        !provenance_add_file(job->e->prov, name, path, err))
        linear_picture_read(&q, path, err);
    if (!err->status && (q.rgb.width != r->map.lens.width || q.rgb.height != r->map.lens.height))
        err_set(err, ST_DATA, "%s is %d x %d px, but the picture beside it %d x %d; relight it again.", path,
                q.rgb.width, q.rgb.height, r->map.lens.width, r->map.lens.height);
    for (int k = 0; !err->status && k < PICTURE_PARTS; k++) {
        choose(t, t->kept, k);
        relit_quotient_errors_add(&own->ratios[k], q.rgb.data, t->before, t->after, t->mask, t->count);
        relit_quotient_errors_add(&job->sums.ratios[k], q.rgb.data, t->before, t->after, t->mask, t->count);
    }
    linear_picture_release(&q);
    return err->status;
}

static enum status add_metric(struct relit_job *job, const char *view, const char *name, int part, double value,
                              struct err *err)
{
    char text[64];
    snprintf(text, sizeof text, "%s%s", name, picture_part_suffixes[part]);
    return evaluation_metric(job->e, view, job->set->prefix, text, value, err);
}

static enum status add_part(struct relit_job *job, const char *view, const struct relit_sums *s, int k, uint64_t least,
                            struct err *err)
{
    double relit, unlit, limit, revealed;
    if (s->pixels[k] >= least && relit_encoded_error_psnr(&s->relit[k], &relit) &&
        relit_encoded_error_psnr(&s->unlit[k], &unlit)) {
        if (!add_metric(job, view, "relit_psnr", k, relit, err) &&
            !add_metric(job, view, "unlit_psnr", k, unlit, err) &&
            !add_metric(job, view, "relit_gain", k, relit - unlit, err))
            add_metric(job, view, "relit_pixels", k, 100 * (double)s->pixels[k] / (double)s->all, err);
        if (!err->status && relit_encoded_error_psnr(&s->limit[k], &limit))
            add_metric(job, view, "relit_limit_psnr", k, limit, err);
        if (!err->status && s->ratios[k].count)
            add_metric(job, view, "relit_ratio_error50", k, 100 * quantiles_get(&s->ratios[k], 0.5), err);
    }
    if (!err->status && s->revealed[k].samples >= 3 * least && relit_encoded_error_psnr(&s->revealed[k], &revealed))
        add_metric(job, view, "relit_revealed_psnr", k, revealed, err);
    return err->status;
}

static enum status add_metrics(struct relit_job *job, const char *view, const struct relit_sums *s, uint64_t least,
                               struct err *err)
{
    for (int k = 0; k < PICTURE_PARTS; k++)
        if (add_part(job, view, s, k, least, err)) return err->status;
    return ST_OK;
}

/* The true picture at the pixels of a view, in the unit of the views, for people to compare. */
static enum status write_truth(const struct relit_job *job, const struct render *r, const struct image *truth,
                               struct err *err)
{
    static const char *const channels[3] = {"R", "G", "B"};
    const char *edit = job->set->where + strlen("edited-");
    const struct product_key key = {.edit = edit, .view = r->name};
    char path[FILE_PATH];
    struct exr_image im = {0};
    struct provenance prov = *job->e->prov; /* shares its arrays with it */
    prov.count = job->e->shared_inputs;
    if (job->relit.own_cameras || !(job->e->radiance_scale > 0)) return ST_OK;
    if (!evaluation_path(path, job->e, PRODUCT_TRUTH_RELIT, &key, err))
        exr_image_init(&im, truth->width, truth->height, err);
    for (int k = 0; !err->status && k < 3; k++) {
        exr_add_plane(&im, channels[k], EXR_HALF, NULL, err);
        for (size_t i = 0; !err->status && i < (size_t)truth->width * (size_t)truth->height; i++)
            im.planes[k].f[i] = (float)fmin((double)truth->data[4 * i + (size_t)k] / job->e->radiance_scale, MAX_HALF);
    }
    if (!err->status) exr_write(&im, path, &prov, err);
    exr_image_release(&im);
    return err->status;
}

static enum status measure_pair(struct relit_job *job, struct relit_truth *t, struct render *r, struct render *u,
                                struct err *err)
{
    struct image truth = {0}, again = {0};
    struct relit_sums own;
    if (!sums_init(&own, err) && !render_read(job->e, &job->relit, r, &truth, err))
        render_read(job->e, &job->unlit, u, &again, err);
    if (!err->status) {
        add_picture(&own, t, r, u, &truth, job->e->white);
        add_picture(&job->sums, t, r, u, &truth, job->e->white);
        if (!add_limits(&own, job, t, u, &truth, err)) add_quotients(&own, job, t, r, err);
    }
    if (!err->status && !add_metrics(job, r->name, &own, MIN_PIXELS, err)) write_truth(job, r, &truth, err);
    linear_picture_release(&r->picture);
    linear_picture_release(&u->picture);
    image_release(&truth);
    image_release(&again);
    sums_release(&own);
    return err->status;
}

static enum status measure(struct relit_job *job, struct render *r, struct err *err)
{
    struct render *unlit = renders_partner(&job->unlit, r);
    struct relit_truth t;
    bool found;
    if (!unlit) {
        job->unpaired++;
        return ST_OK;
    }
    if (!read_truth(&t, &found, job, r, err) && found) {
        job->by_radiance += !t.is_irradiance;
        measure_pair(job, &t, r, unlit, err);
    }
    truth_release_all(&t);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ edits */

/* The folders of relit pictures and of those before, as the inputs call them, and their paths; false: there are
 * none. */
static bool find_folders(char names[2][80], char paths[2][FILE_PATH], const struct evaluation *e, const char *edit)
{
    struct err none = ERR_INIT;
    snprintf(names[0], 80, "relit-%s", edit);
    snprintf(names[1], 80, "edited-%s", edit);
    if (!file_path(paths[0], e->rendered, names[0], "", &none) &&
        !file_path(paths[1], e->rendered, names[1], "", &none) && path_is_folder(paths[0]))
        return true;
    snprintf(names[0], 80, "relight/%s", edit);
    snprintf(names[1], 80, "relight/%s/unlit", edit);
    return !file_path(paths[0], e->folder, names[0], "", &none) &&
           !file_path(paths[1], e->folder, names[1], "", &none) && path_is_folder(paths[1]);
}

static enum status find_pictures(struct relit_job *job, const char *edit, struct err *err)
{
    char names[2][80], paths[2][FILE_PATH];
    if (!find_folders(names, paths, job->e, edit))
        return metric_note(&job->e->table, err, "skipped relit pictures of %s: there are none", job->set->prefix);
    if (renders_find_in(&job->relit, job->e, job->set, paths[0], names[0], err)) return err->status;
    return job->relit.count ? renders_find_in(&job->unlit, job->e, job->set, paths[1], names[1], err) : ST_OK;
}

static enum status add_notes(struct relit_job *job, struct err *err)
{
    const char *of = job->set->prefix;
    if (job->unpaired)
        metric_note(&job->e->table, err,
                    "skipped %d relit pictures of %s: their pictures in the old light, with the same names and "
                    "cameras, are missing",
                    job->unpaired, of);
    if (!err->status && job->by_radiance)
        metric_note(&job->e->table, err,
                    "note: of %d relit pictures of %s, where light changes is found from radiance, because the "
                    "truth has no irradiance of them",
                    job->by_radiance, of);
    return err->status;
}

static enum status measure_edit(struct evaluation *e, const char *edit, struct err *err)
{
    struct true_set set = {0};
    struct relit_job job = {.e = e, .set = &set};
    char where[64];
    snprintf(where, sizeof where, "edited-%s", edit);
    if (!true_set_read(&set, e->truth_folder, where, e->prov, err)) sums_init(&job.sums, err);
    if (!err->status && set.count) find_pictures(&job, edit, err);
    if (!err->status && job.unlit.count) {
        snprintf(where, sizeof where, "remodel/%s", edit);
        if (!renders_scale(e, &job.relit, err)) model_pixels_read(&job.model, e, where, "relit pictures", err);
    }
    for (int i = 0; !err->status && e->white > 0 && i < job.relit.count; i++) measure(&job, &job.relit.list[i], err);
    if (!err->status && job.sums.all) add_metrics(&job, NULL, &job.sums, 1, err);
    if (!err->status) add_notes(&job, err);
    sums_release(&job.sums);
    model_pixels_release(&job.model);
    renders_release(&job.unlit);
    renders_release(&job.relit);
    true_set_release(&set);
    return err->status;
}

enum status evaluate_relit(struct evaluation *e, struct err *err)
{
    struct true_edits edits = {0};
    true_edits_find(&edits, e->truth_folder, err);
    for (int i = 0; !err->status && i < edits.count; i++) measure_edit(e, edits.names[i], err);
    true_edits_release(&edits);
    return err->status;
}
