/* evaluation.c - see evaluation.h; evaluate_*.c compute the metrics. */
#include "stages/evaluate/evaluation.h"

#include "stages/evaluate/light/light_metrics.h"
#include "stages/evaluate/model/model_metrics.h"
#include "stages/evaluate/render/render_metrics.h"
#include "stages/evaluate/texture/texture_metrics.h"
#include "stages/evaluate/views/views_metrics.h"

static enum status read_views(struct evaluation *e, struct view_set *set, const char *where, struct err *err)
{
    char path[FILE_PATH], folder[FILE_PATH];
    enum status st = file_path(folder, e->folder, where, "", err);
    if (!st) st = camera_set_read(&set->cameras, folder, e->prov, err);
    if (!st) st = product_path_in(path, folder, PRODUCT_LENSES, NULL, err);
    if (!st) st = lens_list_read(&set->lenses, path, e->prov, err);
    for (int i = 0; !st && i < set->cameras.view_count; i++) {
        const char *view = set->cameras.views[i].name;
        const struct lens *lens = photo_lens_of_view(&set->cameras, &set->lenses, i);
        if (!lens)
            st = err_set(err, ST_DATA, "%s has no line for view %s of images.txt; import the model again.", path, view);
        else if (photo_list_find_id(&e->photos, lens->photo) < 0)
            st = err_set(err, ST_DATA, "%s: there is no record of photo %s; import photos and model again.", path,
                         lens->photo);
    }
    return st;
}

static enum status note_missing(struct evaluation *e, struct err *err)
{
    struct metric_table *t = &e->table;
    enum status st = ST_OK;
    if (!e->truth_folder) st = metric_note(t, err, "skipped camera and depth errors: no TRUTH is given");
    if (!st && !e->has_held) st = metric_note(t, err, "skipped PSNR, SSIM and holes: no photo is held out (HOLDOUT)");
    if (!st && !e->truth_folder) st = metric_note(t, err, "skipped irradiance: no TRUTH is given");
    if (!st && !e->truth_folder) st = metric_note(t, err, "skipped texture errors: no TRUTH is given");
    return st;
}

static void evaluation_release(struct evaluation *e)
{
    truth_release(&e->truth);
    metric_table_release(&e->table);
    lens_list_release(&e->held.lenses);
    camera_set_release(&e->held.cameras);
    lens_list_release(&e->views.lenses);
    camera_set_release(&e->views.cameras);
    photo_list_release(&e->photos);
}

enum status evaluate(const struct evaluate_inputs *from, const char *out, const struct evaluate_params *params,
                     struct provenance *prov, struct err *err)
{
    const char *folder = from->folder, *truth = from->truth;
    struct evaluation e = {
        .folder = folder, .shared = from->shared, .params = params, .prov = prov, .truth_folder = truth};
    char path[FILE_PATH], rendered[FILE_PATH];
    enum status st = file_path(path, from->shared, "photos", "", err);
    if (!st) st = file_path(rendered, folder, "rendered", "", err);
    e.rendered = from->rendered ? from->rendered : rendered;
    if (!st) st = photo_list_read(&e.photos, path, err);
    if (!st) st = read_views(&e, &e.views, "views", err);
    if (!st) st = evaluation_path(path, &e, PRODUCT_IMAGES, &(struct product_key){.views = "holdout/views"}, err);
    e.has_held = !st && path_is_file(path);
    if (e.has_held) st = read_views(&e, &e.held, "holdout/views", err);
    if (!st && truth) st = truth_read(&e.truth, truth, &e.photos, params->far, prov, err);
    e.shared_inputs = prov->count;
    if (!st) st = note_missing(&e, err);
    if (!st && truth) st = evaluate_cameras(&e, err);
    if (!st) st = evaluate_axes(&e, err);
    if (!st) st = evaluate_walls(&e, err);
    if (!st && truth) st = evaluate_edited_walls(&e, err);
    if (!st && truth) st = evaluate_faces(&e, err);
    if (!st) st = evaluate_depths(&e, err);
    if (!st && e.has_held) st = evaluate_pictures(&e, err);
    if (!st && truth) st = evaluate_radiance(&e, err);
    if (!st && truth) st = evaluate_renders(&e, err);
    if (!st && truth) st = evaluate_revealed(&e, err);
    if (!st && truth) st = evaluate_relit(&e, err);
    if (!st) st = evaluate_films(&e, err);
    if (!st && truth) st = evaluate_irradiance(&e, err);
    if (!st && truth) st = evaluate_shell(&e, err);
    if (!st) st = evaluate_textures(&e, err);
    if (!st) st = evaluate_texture_cover(&e, err);
    if (!st && e.has_held) st = evaluate_heldout_textures(&e, err);
    if (!st) st = evaluation_path(path, &e, PRODUCT_VIEW_METRICS, NULL, err);
    if (!st) st = metric_table_write(&e.table, true, path, prov, err);
    if (!st) st = metric_table_write(&e.table, false, out, prov, err);
    evaluation_release(&e);
    return st;
}
