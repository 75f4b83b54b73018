/* rectify.c - resamples a photograph to the pinhole cameras of its views, in linear colour.
 *
 * reads   VIEWS/cameras.txt, images.txt, lenses.txt   the cameras of the views, the lens of the photo
 *         RECORDS/ID.txt, PHOTOS/FILE                 the photo, or PHOTOS/ID.exr, merged from several exposures
 *         MASKS/ID.png                                optional mask; black pixels get alpha 0
 * writes  OUT/VIEW.exr                                R G B (linear), A, sigma and clipped, for each view of the photo
 *                                                     or each --view
 *
 * A photo is read once for all of its views (a fisheye photo has several), since reading can take longer than
 * resampling. */
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/capture/lens_list.h"
#include "common/capture/linear_photo.h"
#include "common/capture/photo_mask.h"
#include "common/capture/view_image.h"
#include "common/product/product.h"
#include "stages/rectify/rectify_params.h"
#include "stages/rectify/resample.h"

#define PARAM_STRUCT struct rectify_params
static const struct param rectify_param_table[] = {RECTIFY_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct rectify_request {
    const char *photo, *photos, *masks, *records, *views, *out; /* the options of these names */
    struct cli_list names;                                      /* the views to write; empty: all views of the photo */
    struct rectify_params params;
};

struct photo_source { /* the photograph, read once for all views */
    struct linear_photo photo;
    struct photo_mask mask;
    char radiometry[RADIOMETRY_SIZE];
};

static enum status read_source(struct photo_source *s, const struct rectify_request *r, struct provenance *prov,
                               struct err *err)
{
    struct photo_record record = {0};
    const struct single_exposure assumed = {r->params.electrons, r->params.read_noise, r->params.saturated,
                                            r->params.dark};
    if (!photo_record_read(&record, r->records, r->photo, NULL, err) &&
        !linear_photo_open(&s->photo, s->radiometry, r->photos, &record, &assumed, prov, err))
        photo_mask_read(&s->mask, r->masks, r->records, &record, prov, err);
    photo_record_release(&record);
    return err->status;
}

static enum status make_view(const struct photo_source *s, const struct rectify_request *r, const struct lens *lens,
                             const struct view *view, const struct provenance *prov, struct err *err)
{
    struct image rectified = {0};
    struct photo_quality quality = {0};
    const bool whole = s->photo.linear.data;
    const struct resample_source source = {.linear = whole ? &s->photo.linear : NULL,
                                           .photo = whole ? NULL : &s->photo,
                                           .masked = s->mask.masked,
                                           .quality = whole ? &s->photo.quality : NULL};
    char path[FILE_PATH];
    const struct mat3 photo_from_view = mat3_transpose(mat3_from_quat(lens->view_from_photo));
    product_path_in(path, r->out, PRODUCT_VIEW, &(struct product_key){.view = view->name}, err);
    if (!err->status && resample_photo(&rectified, &quality, &source, &lens->camera, &photo_from_view, view, err))
        err_context(err, "photo %s", r->photo);
    if (!err->status) view_image_write(&rectified, &quality, path, view, prov, s->radiometry, err);
    image_release(&rectified);
    photo_quality_release(&quality);
    return err->status;
}

static bool is_wanted(const struct rectify_request *r, const char *view)
{
    for (int i = 0; i < r->names.count; i++)
        if (!strcmp(r->names.items[i], view)) return true;
    return !r->names.count;
}

static enum status check_request(const struct rectify_request *r, const struct lens_list *lenses, struct err *err)
{
    int views = 0;
    for (int l = 0; l < lenses->count; l++) views += !strcmp(lenses->lenses[l].photo, r->photo);
    if (!views)
        return err_set(err, ST_USAGE, "photo %s has no view in %s/lenses.txt, whose lines begin with VIEW PHOTO.",
                       r->photo, r->views);
    for (int i = 0; i < r->names.count; i++) {
        int l = lens_list_find(lenses, r->names.items[i]);
        if (l < 0 || strcmp(lenses->lenses[l].photo, r->photo))
            return err_set(err, ST_USAGE, "photo %s has no view %s; %s/lenses.txt lists its views.", r->photo,
                           r->names.items[i], r->views);
    }
    return ST_OK;
}

static enum status rectify(const struct rectify_request *r, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct lens_list lenses = {0};
    struct photo_source source = {0};
    char lens_path[FILE_PATH];
    if (!product_path_in(lens_path, r->views, PRODUCT_LENSES, NULL, err) &&
        !camera_set_read(&set, r->views, NULL, err) && !lens_list_read(&lenses, lens_path, NULL, err) &&
        !check_request(r, &lenses, err))
        read_source(&source, r, prov, err);
    for (int l = 0; !err->status && l < lenses.count; l++) {
        const struct lens *lens = &lenses.lenses[l];
        if (strcmp(lens->photo, r->photo) || !is_wanted(r, lens->view)) continue;
        int v = camera_set_find(&set, lens->view);
        if (v < 0)
            err_set(err, ST_DATA, "view %s is in %s/lenses.txt but not in images.txt; run sfm_import again.",
                    lens->view, r->views);
        else
            make_view(&source, r, lens, &set.views[v], prov, err);
    }
    linear_photo_release(&source.photo);
    photo_mask_release(&source.mask);
    lens_list_release(&lenses);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct rectify_request r = {.params = RECTIFY_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Resamples a photograph to the pinhole cameras of its views, in linear colour."),
        CLI_STR("photo", &r.photo, CLI_REQUIRED, "id of the photograph"),
        CLI_LIST("view", &r.names, CLI_OPTIONAL, "view to write; default: all views of the photograph"),
        CLI_STR("photos", &r.photos, CLI_REQUIRED, "folder of photographs, or of merged exposures"),
        CLI_STR("masks", &r.masks, CLI_OPTIONAL, "folder of masks ID.png; black pixels get alpha 0"),
        CLI_STR("records", &r.records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("views", &r.views, CLI_REQUIRED, "folder of cameras.txt, images.txt and lenses.txt"),
        CLI_STR("out", &r.out, CLI_REQUIRED, "folder to write VIEW.exr into"),
        CLI_PARAMS(rectify_param_table, &r.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "rectify", opts, &prov, &err) != CLI_RUN || rectify(&r, &prov, &err)) err_report(&err);
    provenance_release(&prov);
    cli_list_release(&r.names);
    return err_exit_code(&err);
}
