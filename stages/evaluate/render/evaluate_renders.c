/* evaluate_renders.c - rendered pictures of TRUTH/novel and TRUTH/edited-E against the truth: novel.*, edited.E.*
 *
 * A picture has a camera of its own, which the similarity of the cameras brings into the truth's world, or it is a view
 * of the scene, which shares the lens and the centre of its photograph. */
#include "stages/evaluate/render/render_metrics.h"

#include <stdlib.h>
#include <string.h>

#include "stages/evaluate/measure/picture_error.h"
#include "stages/evaluate/measure/radiance_error.h"
#include "stages/evaluate/scene/renders.h"

struct render_sums { /* over the pictures that have the metric */
    double psnr, flip, ssim, psnr_covered, holes, rms, rms_clipped, error50, offset;
    int pictures, with_ssim, covered, with_rms, with_clipped, with_error;
};

/* Psnr and ssim of the two pictures encoded with `white` as white. */
static enum status encoded_errors(struct picture_errors *errors, bool *none, const struct render *r,
                                  const struct image *truth, double white, struct err *err)
{
    const int width = truth->width, height = truth->height;
    const size_t pixels = (size_t)width * (size_t)height;
    struct image frame = {0}, wanted = {0};
    struct err why = ERR_INIT;
    uint8_t *bytes = malloc(7 * pixels);
    if (!bytes) err_nomem(err, "pictures", 7 * pixels);
    *none = false;
    if (!err->status && !image_init(&frame, width, height, 3, err)) image_init(&wanted, width, height, 3, err);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        for (size_t c = 0; c < 3; c++) {
            frame.data[3 * i + c] = (float)(r->scale / white * r->picture.rgb.data[3 * i + c]);
            wanted.data[3 * i + c] = (float)(truth->data[4 * i + c] / white);
        }
        bytes[6 * pixels + i] = truth->data[4 * i + 3] > 0;
    }
    if (!err->status) {
        image_to_srgb8(&wanted, bytes);
        image_to_srgb8(&frame, bytes + 3 * pixels);
        picture_errors(errors, bytes, bytes + 3 * pixels, bytes + 6 * pixels, r->picture.hole, width, height, &why);
        *none = why.status == ST_DATA;
        if (why.status && !*none) err_set(err, why.status, "%s", why.text);
    }
    image_release(&wanted);
    image_release(&frame);
    free(bytes);
    return err->status;
}

static enum status add_encoded(struct evaluation *e, const char *of, const char *name, const struct picture_errors *p,
                               struct render_sums *s, struct err *err)
{
    s->pictures++;
    s->psnr += p->psnr;
    s->flip += p->flip;
    s->holes += p->holes;
    if (!evaluation_metric(e, name, of, "psnr", p->psnr, err) &&
        !evaluation_metric(e, name, of, "flip", p->flip, err) &&
        !evaluation_metric(e, name, of, "holes", 100 * p->holes, err) && p->has_ssim) {
        s->ssim += p->ssim;
        s->with_ssim++;
        evaluation_metric(e, name, of, "ssim", p->ssim, err);
    }
    if (!err->status && p->has_covered) {
        s->psnr_covered += p->psnr_covered;
        s->covered++;
        evaluation_metric(e, name, of, "psnr_covered", p->psnr_covered, err);
    }
    return err->status;
}

/* Linear errors: `whole` of all light, NULL of a picture that white limits; `clipped` with both clipped at white. */
static enum status add_linear(struct evaluation *e, const char *of, const char *name,
                              const struct radiance_error *whole, const struct radiance_error *clipped,
                              struct render_sums *s, struct err *err)
{
    double rms;
    if (whole && radiance_error_rms(whole, &rms)) {
        s->rms += rms;
        s->with_rms++;
        evaluation_metric(e, name, of, "rms", 100 * rms, err);
    }
    if (!err->status && radiance_error_rms(clipped, &rms)) {
        s->rms_clipped += rms;
        s->with_clipped++;
        evaluation_metric(e, name, of, "rms_clipped", 100 * rms, err);
    }
    const struct radiance_error *all = whole ? whole : clipped;
    if (!err->status && all->errors.count) {
        const double middle = quantiles_get(&all->errors, 0.5);
        s->error50 += middle;
        s->with_error++;
        evaluation_metric(e, name, of, "error50", 100 * middle, err);
    }
    return err->status;
}

/* Both errors of radiance of a picture that was read. */
static enum status linear_errors(struct evaluation *e, const char *of, const struct render *r,
                                 const struct image *truth, struct render_sums *s, struct err *err)
{
    struct radiance_error whole = {0}, clipped = {0};
    struct radiance_pixels p = {
        r->picture.rgb.data, truth->data, NULL, (size_t)truth->width * (size_t)truth->height, r->scale, 0};
    if (!radiance_error_init(&whole, err) && !radiance_error_init(&clipped, err)) {
        if (!r->picture.encoded) radiance_error_add(&whole, &p);
        p.clip = e->white;
        radiance_error_add(&clipped, &p);
        add_linear(e, of, r->name, r->picture.encoded ? NULL : &whole, &clipped, s, err);
    }
    radiance_error_release(&clipped);
    radiance_error_release(&whole);
    return err->status;
}

static enum status measure(struct evaluation *e, const struct renders *list, struct render *r, struct render_sums *s,
                           struct err *err)
{
    struct image truth = {0};
    struct picture_errors errors;
    const char *of = list->set->prefix;
    bool none = false;
    if (!render_read(e, list, r, &truth, err)) encoded_errors(&errors, &none, r, &truth, e->white, err);
    if (!err->status && none) {
        metric_note(&e->table, err, "skipped %s of %s: its camera sees nothing of the true picture", r->name, of);
    } else if (!err->status) {
        if (!add_encoded(e, of, r->name, &errors, s, err)) linear_errors(e, of, r, &truth, s, err);
        s->offset = fmax(s->offset, r->offset);
    }
    image_release(&truth);
    linear_picture_release(&r->picture);
    return err->status;
}

static enum status add_means(struct evaluation *e, const char *of, const struct render_sums *s, bool own,
                             struct err *err)
{
    const int n = s->pictures;
    if (!evaluation_metric(e, NULL, of, "pictures", n, err) &&
        !evaluation_metric(e, NULL, of, "white", e->white, err) &&
        !evaluation_metric(e, NULL, of, "psnr", s->psnr / n, err) &&
        !evaluation_metric(e, NULL, of, "flip", s->flip / n, err))
        evaluation_metric(e, NULL, of, "holes", 100 * s->holes / n, err);
    if (!err->status && own) evaluation_metric(e, NULL, of, "offset", s->offset, err);
    if (!err->status && s->with_ssim) evaluation_metric(e, NULL, of, "ssim", s->ssim / s->with_ssim, err);
    if (!err->status && s->covered) evaluation_metric(e, NULL, of, "psnr_covered", s->psnr_covered / s->covered, err);
    if (!err->status && s->with_rms) evaluation_metric(e, NULL, of, "rms", 100 * s->rms / s->with_rms, err);
    if (!err->status && s->with_clipped)
        evaluation_metric(e, NULL, of, "rms_clipped", 100 * s->rms_clipped / s->with_clipped, err);
    if (!err->status && s->with_error) evaluation_metric(e, NULL, of, "error50", 100 * s->error50 / s->with_error, err);
    return err->status;
}

static enum status measure_set(struct evaluation *e, const struct true_set *set, struct err *err)
{
    struct renders list = {0};
    struct render_sums s = {0};
    renders_find(&list, e, set, err);
    if (!err->status && list.count) renders_scale(e, &list, err);
    for (int i = 0; !err->status && e->white > 0 && i < list.count; i++) measure(e, &list, &list.list[i], &s, err);
    if (!err->status && s.pictures) add_means(e, set->prefix, &s, list.own_cameras, err);
    renders_release(&list);
    return err->status;
}

static enum status evaluate_set(struct evaluation *e, const char *where, struct err *err)
{
    struct true_set set = {0};
    true_set_read(&set, e->truth_folder, where, e->prov, err);
    if (!err->status && set.count) renders_write_cameras(e, &set, err);
    if (!err->status && set.count) measure_set(e, &set, err);
    true_set_release(&set);
    return err->status;
}

enum status evaluate_renders(struct evaluation *e, struct err *err)
{
    struct true_edits edits = {0};
    if (!evaluate_set(e, "novel", err)) true_edits_find(&edits, e->truth_folder, err);
    for (int i = 0; !err->status && i < edits.count; i++) {
        char where[64];
        snprintf(where, sizeof where, "edited-%s", edits.names[i]);
        evaluate_set(e, where, err);
    }
    if (!err->status && edits.others)
        metric_note(&e->table, err,
                    "skipped %d edited scenes of the truth: a name is at most 40 letters, digits, "
                    "_ and -",
                    edits.others);
    true_edits_release(&edits);
    return err->status;
}
