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
    if (!file_path(folder, e->folder, where, "", err) && !camera_set_read(&set->cameras, folder, e->prov, err) &&
        !product_path_in(path, folder, PRODUCT_LENSES, NULL, err))
        lens_list_read(&set->lenses, path, e->prov, err);
    for (int i = 0; !err->status && i < set->cameras.view_count; i++) {
        const char *view = set->cameras.views[i].name;
        const struct lens *lens = photo_lens_of_view(&set->cameras, &set->lenses, i);
        if (!lens)
            err_set(err, ST_DATA, "%s has no line for view %s of images.txt; import the model again.", path, view);
        else if (photo_list_find_id(&e->photos, lens->photo) < 0)
            err_set(err, ST_DATA, "%s: photo %s has no record; import the photos and the model again.", path,
                    lens->photo);
    }
    return err->status;
}

static enum status note_missing(struct evaluation *e, struct err *err)
{
    struct metric_table *t = &e->table;
    if (!e->truth_folder) metric_note(t, err, "skipped camera and depth errors: no TRUTH is given");
    if (!err->status && !e->has_held)
        metric_note(t, err, "skipped PSNR, SSIM and holes: no photo is held out (HOLDOUT)");
    if (!err->status && !e->truth_folder) metric_note(t, err, "skipped irradiance: no TRUTH is given");
    if (!err->status && !e->truth_folder) metric_note(t, err, "skipped texture errors: no TRUTH is given");
    return err->status;
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
    if (!file_path(path, from->shared, "photos", "", err)) file_path(rendered, folder, "rendered", "", err);
    e.rendered = from->rendered ? from->rendered : rendered;
    if (!err->status && !photo_list_read(&e.photos, path, err) && !read_views(&e, &e.views, "views", err))
        evaluation_path(path, &e, PRODUCT_IMAGES, &(struct product_key){.views = "holdout/views"}, err);
    e.has_held = !err->status && path_is_file(path);
    if (e.has_held) read_views(&e, &e.held, "holdout/views", err);
    if (!err->status && truth) truth_read(&e.truth, truth, &e.photos, params->far, prov, err);
    e.shared_inputs = prov->count;
    if (!err->status) note_missing(&e, err);
    if (!err->status && truth) evaluate_cameras(&e, err);
    if (!err->status && !evaluate_axes(&e, err)) evaluate_walls(&e, err);
    if (!err->status && truth) evaluate_edited_walls(&e, err);
    if (!err->status && truth) evaluate_faces(&e, err);
    if (!err->status) evaluate_depths(&e, err);
    if (!err->status && e.has_held) evaluate_pictures(&e, err);
    if (!err->status && truth) evaluate_radiance(&e, err);
    if (!err->status && truth) evaluate_renders(&e, err);
    if (!err->status && truth) evaluate_revealed(&e, err);
    if (!err->status && truth) evaluate_relit(&e, err);
    if (!err->status) evaluate_films(&e, err);
    if (!err->status && truth) evaluate_irradiance(&e, err);
    if (!err->status && truth) evaluate_shell(&e, err);
    if (!err->status && !evaluate_textures(&e, err)) evaluate_texture_cover(&e, err);
    if (!err->status && e.has_held) evaluate_heldout_textures(&e, err);
    if (!err->status && !evaluation_path(path, &e, PRODUCT_VIEW_METRICS, NULL, err) &&
        !metric_table_write(&e.table, true, path, prov, err))
        metric_table_write(&e.table, false, out, prov, err);
    evaluation_release(&e);
    return err->status;
}
