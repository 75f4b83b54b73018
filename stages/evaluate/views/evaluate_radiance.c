/* evaluate_radiance.c - radiance of the views and of the merged exposures against the true radiance of their
 * photographs: radiance.*, radiance.merged.*, and the scale that rendered pictures are compared with.
 *
 * Overview. Radiance of products has an unknown unit: exposures fix ratios only. So there are two rounds over all
 * pictures. The first finds the scale, the median over all pixels of true luminance over found luminance; the
 * median, because clipped lamps and wrong pixels would move a mean. The second multiplies by it and measures the
 * errors (radiance_error.h). Reading everything twice keeps one picture in memory.
 *
 * Each picture also gets the scale that it alone would give. Their spread, the largest over the smallest minus 1,
 * says how well exposures were brought to one scale, whatever that scale is.
 *
 * Views are compared through the lenses of their photographs: the truth is resampled to the view. A merged exposure
 * is the photograph itself, so its pixels are compared by their place in the picture, without a lens; a truth of
 * another size is allowed, one of another shape is skipped with a note.
 *
 * The scale of the views becomes e->radiance_scale, with which all rendered pictures are compared (renders.c). */
#include "stages/evaluate/views/views_metrics.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/photo_match.h"
#include "stages/evaluate/measure/radiance_error.h"
#include "stages/evaluate/truth/linear_picture.h"

struct radiance_case { /* a picture of a photograph that has a true radiance */
    char path[FILE_PATH], input[FILE_PATH], truth[FILE_PATH];
    char name[256];
    struct picture_map map;
    double scale; /* true radiance of 1, from this picture alone; 0: none */
};

struct radiance_cases {
    struct radiance_case *list;
    int count, wrong_size;
    const char *prefix; /* "radiance" or "radiance.merged" */
    bool by_view;
};

static enum status read_case(struct evaluation *e, const struct radiance_case *c, struct linear_picture *found,
                             struct image *truth, struct err *err)
{
    struct linear_picture whole = {0};
    if (!provenance_add_file(e->prov, c->input, c->path, err)) linear_picture_read(found, c->path, err);
    if (!err->status && (found->rgb.width != c->map.lens.width || found->rgb.height != c->map.lens.height))
        err_set(err, ST_DATA, "%s is %d x %d px, but its camera %d x %d; make it again.", c->path, found->rgb.width,
                found->rgb.height, c->map.lens.width, c->map.lens.height);
    if (!err->status && !linear_picture_read(&whole, c->truth, err)) picture_of_truth(truth, &whole.rgb, &c->map, err);
    linear_picture_release(&whole);
    return err->status;
}

/* What is done with a picture and its truth, in two rounds: first ratios, then errors with the scale. */
struct radiance_round {
    struct quantiles *ratios;
    struct radiance_error *errors; /* NULL: the first round */
    double scale;
};

static enum status add_case(struct evaluation *e, struct radiance_cases *cases, int i, struct radiance_round *round,
                            struct err *err)
{
    struct radiance_case *c = &cases->list[i];
    struct linear_picture found = {0};
    struct image truth = {0};
    struct quantiles own = {0};
    struct radiance_error errors = {0};
    double rms;
    read_case(e, c, &found, &truth, err);
    struct radiance_pixels p = {found.rgb.data, truth.data,
                                found.known,    (size_t)c->map.lens.width * (size_t)c->map.lens.height,
                                round->scale,   0};
    if (!err->status && !round->errors && !quantiles_init(&own, err)) {
        radiance_ratios_add(&own, &p);
        radiance_ratios_add(round->ratios, &p);
        c->scale = own.count ? quantiles_get(&own, 0.5) : 0;
    } else if (!err->status && round->errors && !radiance_error_init(&errors, err)) {
        const char *view = c->name, *of = cases->prefix;
        radiance_error_add(&errors, &p);
        radiance_error_add(round->errors, &p);
        if (c->scale > 0) evaluation_metric(e, view, of, "scale", c->scale, err);
        if (!err->status && errors.errors.count)
            evaluation_metric(e, view, of, "error50", 100 * quantiles_get(&errors.errors, 0.5), err);
        if (!err->status && radiance_error_rms(&errors, &rms)) evaluation_metric(e, view, of, "rms", 100 * rms, err);
    }
    radiance_error_release(&errors);
    quantiles_release(&own);
    image_release(&truth);
    linear_picture_release(&found);
    return err->status;
}

/* Measures all cases; *scale: the median ratio over their pixels, 0 if there is none. */
static enum status measure(struct evaluation *e, struct radiance_cases *cases, double *scale, struct err *err)
{
    struct quantiles ratios = {0};
    struct radiance_error errors = {0};
    struct radiance_round round = {&ratios, NULL, 1};
    const char *of = cases->prefix;
    double rms, from = 0, to = 0;
    if (!quantiles_init(&ratios, err)) radiance_error_init(&errors, err);
    *scale = 0;
    for (int i = 0; !err->status && i < cases->count; i++) add_case(e, cases, i, &round, err);
    if (!err->status && ratios.count) {
        *scale = round.scale = quantiles_get(&ratios, 0.5);
        round.errors = &errors;
        for (int i = 0; !err->status && i < cases->count; i++) add_case(e, cases, i, &round, err);
        for (int i = 0; i < cases->count; i++) {
            const double s = cases->list[i].scale / *scale;
            if (!(s > 0)) continue;
            from = from > 0 ? fmin(from, s) : s;
            to = fmax(to, s);
        }
        if (!err->status && !evaluation_metric(e, NULL, of, "scale", *scale, err) &&
            !evaluation_metric(e, NULL, of, "scale_spread", 100 * (to / from - 1), err) &&
            !evaluation_metric(e, NULL, of, "error50", 100 * quantiles_get(&errors.errors, 0.5), err) &&
            !evaluation_metric(e, NULL, of, "error90", 100 * quantiles_get(&errors.errors, 0.9), err))
            evaluation_metric(e, NULL, of, "pictures", cases->count, err);
        if (!err->status && radiance_error_rms(&errors, &rms)) evaluation_metric(e, NULL, of, "rms", 100 * rms, err);
    } else if (!err->status) {
        metric_note(&e->table, err, "skipped %s: no pixel has light both in a picture and in the truth", of);
    }
    radiance_error_release(&errors);
    quantiles_release(&ratios);
    return err->status;
}

static enum status new_case(struct radiance_cases *cases, struct radiance_case **c, const char *truth, const char *name,
                            struct err *err)
{
    if (array_append(&cases->list, (size_t)cases->count, sizeof *cases->list, "pictures", err)) return err->status;
    *c = &cases->list[cases->count++];
    **c = (struct radiance_case){0};
    snprintf((*c)->truth, sizeof(*c)->truth, "%s", truth);
    snprintf((*c)->name, sizeof(*c)->name, "%s", name);
    return ST_OK;
}

static enum status add_views(struct evaluation *e, struct radiance_cases *cases, int photo, const char *truth,
                             struct err *err)
{
    const struct view_set *sets[2] = {&e->views, &e->held};
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < sets[k]->cameras.view_count; i++) {
            const struct view *view = &sets[k]->cameras.views[i];
            const struct product_key key = {.view = view->name, .views = k ? "holdout/views" : "views"};
            struct radiance_case *c = NULL;
            char path[FILE_PATH];
            if (evaluation_photo(e, sets[k], i) != photo) continue;
            if (evaluation_path(path, e, PRODUCT_VIEW, &key, err)) return err->status;
            if (!path_is_file(path)) continue;
            if (new_case(cases, &c, truth, view->name, err) || product_path(c->input, PRODUCT_VIEW, &key, err))
                return err->status;
            memcpy(c->path, path, sizeof path);
            c->map = evaluation_map_of_view(sets[k], i);
        }
    return ST_OK;
}

static enum status add_merged(struct evaluation *e, struct radiance_cases *cases, const struct true_picture *true_photo,
                              int photo, const char *truth, struct err *err)
{
    const struct photo_record *record = &e->photos.photos[photo];
    const struct product_key key = {.photo = record->id};
    struct radiance_case *c = NULL;
    char path[FILE_PATH];
    if (evaluation_path(path, e, PRODUCT_HDR, &key, err)) return err->status;
    if (!path_is_file(path)) return ST_OK;
    if (record->info.width * true_photo->lens.height != record->info.height * true_photo->lens.width) {
        cases->wrong_size++;
        return ST_OK;
    }
    if (new_case(cases, &c, truth, record->id, err) || product_path(c->input, PRODUCT_HDR, &key, err))
        return err->status;
    memcpy(c->path, path, sizeof path);
    /* pixels belong together by their place in the picture, whatever the lens */
    struct camera grid = {CAMERA_PINHOLE, record->info.width, record->info.height, {1, 1, 0, 0}};
    c->map = (struct picture_map){grid, grid, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    return ST_OK;
}

enum status evaluate_radiance(struct evaluation *e, struct err *err)
{
    struct true_set set = {0};
    struct radiance_cases views = {.prefix = "radiance"}, merged = {.prefix = "radiance.merged"};
    double of_merged = 0;
    int pictures = 0;
    true_set_read(&set, e->truth_folder, "", e->prov, err);
    for (int i = 0; !err->status && i < set.count; i++) {
        const int photo = photo_list_match(&e->photos, set.pictures[i].name);
        char truth[FILE_PATH], name[FILE_PATH];
        if (photo < 0 || !true_set_file(truth, &set, "hdr", set.pictures[i].name)) continue;
        if (!file_path(name, "truth/hdr", set.pictures[i].name, ".exr", err) &&
            !provenance_add_file(e->prov, name, truth, err) && !add_views(e, &views, photo, truth, err))
            add_merged(e, &merged, &set.pictures[i], photo, truth, err);
        pictures++;
    }
    if (!err->status && !views.count)
        metric_note(&e->table, err, "skipped radiance: %s",
                    pictures ? "no photo with a true radiance has a view"
                             : "the truth has no radiance of these photos (hdr/NAME.exr)");
    if (!err->status && views.count) measure(e, &views, &e->radiance_scale, err);
    if (!err->status && merged.count) measure(e, &merged, &of_merged, err);
    if (!err->status && merged.wrong_size)
        metric_note(&e->table, err,
                    "skipped the merged radiance of %d photos: the truth's pictures have another "
                    "shape",
                    merged.wrong_size);
    free(merged.list);
    free(views.list);
    true_set_release(&set);
    return err->status;
}
