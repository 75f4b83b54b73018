/* evaluate_pictures.c - rendered pictures against the held-out photographs: holdout.* */
#include "stages/evaluate/views/views_metrics.h"

#include <stdlib.h>

#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "stages/evaluate/measure/picture_error.h"

struct picture_sums { /* over the pictures that have the metric */
    double psnr, flip, ssim, psnr_covered, ssim_covered, holes;
    int pictures, with_ssim, covered, with_ssim_covered;
    int min_size[2], max_size[2]; /* width and height, px */
};

static enum status add_picture(struct evaluation *e, const struct view *view, const struct picture_errors *p,
                               struct picture_sums *s, struct err *err)
{
    struct metric_table *t = &e->table;
    s->psnr += p->psnr;
    s->flip += p->flip;
    s->holes += p->holes;
    s->pictures++;
    if (!metric_add(t, view->name, "holdout.psnr", p->psnr, err) &&
        !metric_add(t, view->name, "holdout.flip", p->flip, err) &&
        !metric_add(t, view->name, "holdout.holes", 100 * p->holes, err) && p->has_ssim) {
        s->ssim += p->ssim;
        s->with_ssim++;
        metric_add(t, view->name, "holdout.ssim", p->ssim, err);
    }
    if (!err->status && p->has_covered) {
        s->psnr_covered += p->psnr_covered;
        s->covered++;
        metric_add(t, view->name, "holdout.psnr_covered", p->psnr_covered, err);
    }
    if (!err->status && p->has_ssim_covered) {
        s->ssim_covered += p->ssim_covered;
        s->with_ssim_covered++;
        metric_add(t, view->name, "holdout.ssim_covered", p->ssim_covered, err);
    }
    return err->status;
}

/* Photo and frame as 8-bit sRGB, and the masks of the pixels inside the photo and of holes. */
struct pictures {
    uint8_t *photo, *frame, *inside, *hole;
};

static enum status read_pictures(struct evaluation *e, const struct view *view, struct pictures *p, struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B", "hole"};
    size_t pixels = (size_t)view->width * (size_t)view->height;
    struct image photo = {0}, frame = {0};
    struct exr_image im = {0};
    char path[FILE_PATH], folder[FILE_PATH];
    p->photo = malloc(3 * pixels);
    p->frame = malloc(3 * pixels);
    p->inside = malloc(pixels);
    p->hole = malloc(pixels);
    if (!p->photo || !p->frame || !p->inside || !p->hole) err_nomem(err, "pictures", 8 * pixels);
    if (!err->status && !file_path(folder, e->folder, "holdout/views", "", err) &&
        !view_image_read(&photo, folder, view, e->prov, err) &&
        !evaluation_path(path, e, PRODUCT_HELD_FRAME, &(struct product_key){.view = view->name}, err))
        exr_read_product(&im, PRODUCT_HELD_FRAME, path, NAMES, 4, e->prov, err);
    if (!err->status && (im.width != view->width || im.height != view->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but its view is %d x %d px; render it again.", path, im.width,
                im.height, view->width, view->height);
    if (!err->status) image_init(&frame, im.width, im.height, 3, err);
    for (int c = 0; !err->status && c < 4; c++) {
        const struct exr_plane *plane = exr_find(&im, NAMES[c]);
        if (!plane->f)
            err_set(err, ST_DATA, "%s: channel %s holds integers, wanted half or float; render it again.", path,
                    NAMES[c]);
        for (size_t i = 0; !err->status && i < pixels; i++)
            if (c < 3)
                frame.data[3 * i + (size_t)c] = plane->f[i];
            else
                p->hole[i] = plane->f[i] > 0.5f;
    }
    if (!err->status) {
        image_to_srgb8(&photo, p->photo);
        image_to_srgb8(&frame, p->frame);
        for (size_t i = 0; i < pixels; i++) p->inside[i] = photo.data[4 * i + 3] > 0;
    }
    exr_image_release(&im);
    image_release(&photo);
    image_release(&frame);
    return err->status;
}

static enum status evaluate_picture(struct evaluation *e, const struct view *view, struct picture_sums *s,
                                    struct err *err)
{
    struct pictures p = {0};
    struct picture_errors errors;
    struct err why = ERR_INIT;
    if (!read_pictures(e, view, &p, err)) {
        picture_errors(&errors, p.photo, p.frame, p.inside, p.hole, view->width, view->height, &why);
        if (why.status == ST_DATA)
            metric_note(&e->table, err, "skipped the held-out view %s: %s", view->name, why.text);
        else if (why.status)
            err_set(err, why.status, "%s", why.text);
        else
            add_picture(e, view, &errors, s, err);
    }
    int size[2] = {view->width, view->height};
    for (int k = 0; k < 2; k++) {
        if (!s->min_size[k] || size[k] < s->min_size[k]) s->min_size[k] = size[k];
        if (size[k] > s->max_size[k]) s->max_size[k] = size[k];
    }
    free(p.photo);
    free(p.frame);
    free(p.inside);
    free(p.hole);
    return err->status;
}

enum status evaluate_pictures(struct evaluation *e, struct err *err)
{
    const struct camera_set *held = &e->held.cameras;
    struct metric_table *t = &e->table;
    struct picture_sums s = {0};
    int missing = 0;
    for (int i = 0; !err->status && i < held->view_count; i++) {
        char path[FILE_PATH];
        evaluation_path(path, e, PRODUCT_HELD_FRAME, &(struct product_key){.view = held->views[i].name}, err);
        if (!err->status && path_is_file(path))
            evaluate_picture(e, &held->views[i], &s, err);
        else if (!err->status)
            missing++;
    }
    if (!err->status && missing)
        metric_note(t, err, "skipped %d of %d held-out views: they were not rendered", missing, held->view_count);
    if (err->status || !s.pictures) return err->status;
    if (s.min_size[0] == s.max_size[0] && s.min_size[1] == s.max_size[1])
        metric_note(t, err, "note: held-out pictures are compared at their own size, %d x %d px", s.max_size[0],
                    s.max_size[1]);
    else
        metric_note(t, err, "note: held-out pictures are compared at their own sizes, %d x %d to %d x %d px",
                    s.min_size[0], s.min_size[1], s.max_size[0], s.max_size[1]);
    if (!err->status && !metric_add(t, NULL, "holdout.pictures", s.pictures, err) &&
        !metric_add(t, NULL, "holdout.psnr", s.psnr / s.pictures, err) &&
        !metric_add(t, NULL, "holdout.flip", s.flip / s.pictures, err))
        metric_add(t, NULL, "holdout.holes", 100 * s.holes / s.pictures, err);
    if (!err->status && s.with_ssim) metric_add(t, NULL, "holdout.ssim", s.ssim / s.with_ssim, err);
    if (!err->status && s.covered) metric_add(t, NULL, "holdout.psnr_covered", s.psnr_covered / s.covered, err);
    if (!err->status && s.with_ssim_covered)
        metric_add(t, NULL, "holdout.ssim_covered", s.ssim_covered / s.with_ssim_covered, err);
    return err->status;
}
