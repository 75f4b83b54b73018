/* contents_evaluation.c - metrics, and held-out photographs beside what was rendered in their place. */
#include "stages/report/contents_parts.h"

#include <stdlib.h>
#include <sys/stat.h>

#include "common/base/parallel.h"
#include "stages/report/passing.h"

struct held_job {
    struct contents *c;
    const char *folder;
};

static void make_held_cards(void *ctx, size_t begin, size_t end, int thread)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    const struct held_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct held_card *card = &job->c->held_cards[i];
        int lens = lens_list_find(&job->c->held_lenses, card->view->name);
        int photo = lens < 0 ? -1 : photo_list_find_id(&job->c->photos, job->c->held_lenses.lenses[lens].photo);
        int orientation = photo < 0 ? 1 : job->c->photos.photos[photo].info.orientation;
        for (int k = 0; k < 2; k++) {
            struct err err = ERR_INIT;
            struct exr_image im = {0};
            const struct product_key key = {.views = "holdout/views", .view = card->view->name};
            char path[FILE_PATH];
            if (contents_product(path, job->folder, k ? PRODUCT_HELD_FRAME : PRODUCT_VIEW, &key) &&
                !exr_read(&im, path, NAMES, 3, &err))
                picture_from_exr(k ? &card->frame : &card->picture, &im, orientation, HELD_HEIGHT, &err);
            exr_image_release(&im);
            if (!card->problem[0]) snprintf(card->problem, sizeof card->problem, "%.*s", NOTE_SIZE - 1, err.text);
        }
    }
}

enum status contents_read_held(struct contents *c, const char *folder, struct err *err)
{
    char path[PATH_SIZE];
    struct err problem = ERR_INIT;
    if (!contents_product(path, folder, PRODUCT_LENSES, &(struct product_key){.views = "holdout/views"})) return ST_OK;
    if (lens_list_read(&c->held_lenses, path, NULL, &problem))
        return contents_note(c, err, "The held-out photographs are unknown. %s", problem.text);
    snprintf(path, sizeof path, "%s/holdout/views", folder);
    if (camera_set_read(&c->held, path, NULL, &problem))
        return contents_note(c, err, "The held-out photographs are unknown. %s", problem.text);
    c->held_cards = calloc((size_t)c->held.view_count + 1, sizeof *c->held_cards);
    if (!c->held_cards) return err_nomem(err, "held-out views", (size_t)c->held.view_count * sizeof *c->held_cards);
    for (int i = 0; i < c->held.view_count; i++) {
        int lens = lens_list_find(&c->held_lenses, c->held.views[i].name);
        int photo = lens < 0 ? -1 : photo_list_find_id(&c->photos, c->held_lenses.lenses[lens].photo);
        c->held_cards[i].view = &c->held.views[i];
        if (photo >= 0) c->photo_cards[photo].held_out = true;
    }
    struct held_job job = {c, folder};
    parallel_for((size_t)c->held.view_count, 1, make_held_cards, &job);
    for (int i = 0; i < c->held.view_count; i++)
        if (passing_refuse(c->held_cards[i].problem, err)) return err->status;
    return ST_OK;
}

enum status contents_read_metrics(struct contents *c, const char *folder, struct err *err)
{
    char path[FILE_PATH];
    struct err problem = ERR_INIT;
    if (!contents_product(path, folder, PRODUCT_METRICS, NULL)) return ST_OK;
    if (metric_rows_read(&c->metrics, path, false, &problem))
        return contents_note(c, err, "The metrics cannot be read. %s", problem.text);
    c->has_metrics = true;
    if (product_path_below(path, folder, PRODUCT_VIEW_METRICS, NULL, &problem) ||
        metric_rows_read(&c->view_metrics, path, true, &problem))
        return contents_note(c, err, "The metrics of the views cannot be read. %s", problem.text);
    return ST_OK;
}

/* Without a truth or a hold-out the metrics are not made with the page, and may be those of an older run. */
enum status contents_check_age(struct contents *c, const char *folder, struct err *err)
{
    struct stat table, map;
    char path[FILE_PATH];
    if (!c->has_metrics || !contents_product(path, folder, PRODUCT_METRICS, NULL) || stat(path, &table)) return ST_OK;
    for (int i = 0; i < c->views.view_count; i++) {
        const struct product_key key = {.view = c->views.views[i].name};
        if (!contents_product(path, folder, PRODUCT_DEPTH, &key) || stat(path, &map) || map.st_mtime <= table.st_mtime)
            continue;
        return contents_note(c, err, "The metrics are older than the depth maps; run make evaluate to update them.");
    }
    return ST_OK;
}
