/* rectify.c - resamples a photograph into its view's pinhole camera, in linear colour.
 *
 * reads   VIEWS/cameras.txt, images.txt, lenses.txt   the view's camera, and the photo's lens
 *         RECORDS/ID.txt, PHOTOS/FILE                 the photo; of a view of several exposures PHOTOS/ID.exr, merged
 *         MASKS/ID.png                                black where the view is to have no pixel; need not be there
 * writes  OUT                                         VIEW.exr: R G B (linear), A */
#include "common/cli.h"
#include "common/file_path.h"
#include "common/lens_list.h"
#include "common/linear_photo.h"
#include "common/photo_mask.h"
#include "common/view_image.h"
#include "stages/rectify/resample.h"

static enum status find_view(const struct view **view, const struct lens **lens, const struct camera_set *set,
                             const struct lens_list *lenses, const char *name, const char *folder, struct err *err)
{
    int v = camera_set_find(set, name), l = lens_list_find(lenses, name);
    if (v < 0 || l < 0)
        return err_set(err, ST_USAGE, "there is no view %s in %s/%s; its views are listed in %s/views.mk.", name,
                       folder, v < 0 ? "images.txt" : "lenses.txt", folder);
    *view = &set->views[v];
    *lens = &lenses->lenses[l];
    return ST_OK;
}

static enum status rectify(const char *name, const char *photos, const char *masks, const char *records,
                           const char *views, const char *out, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct lens_list lenses = {0};
    struct photo_record record = {0};
    struct photo_mask mask = {0};
    struct image linear = {0}, rectified = {0};
    const struct view *view = NULL;
    const struct lens *lens = NULL;
    char lens_path[FILE_PATH], radiometry[RADIOMETRY_SIZE] = "";
    enum status st = file_path(lens_path, views, "lenses.txt", "", err);
    if (!st) st = camera_set_read(&set, views, err);
    if (!st) st = lens_list_read(&lenses, lens_path, err);
    if (!st) st = find_view(&view, &lens, &set, &lenses, name, views, err);
    if (!st) st = photo_record_read(&record, records, lens->photo, err);
    if (!st) st = linear_photo_read(&linear, radiometry, photos, &record, prov, err);
    if (!st) st = photo_mask_read(&mask, masks, records, &record, prov, err);
    if (!st) {
        struct mat3 photo_from_view = mat3_transpose(mat3_from_quat(lens->view_from_photo));
        st = resample_photo(&rectified, &linear, mask.masked, &lens->camera, &photo_from_view, view, err);
        if (st) err_context(err, "%s/%s", photos, record.file);
    }
    if (!st) st = view_image_write(&rectified, out, view, prov, radiometry, err);
    image_release(&rectified);
    image_release(&linear);
    photo_mask_release(&mask);
    photo_record_release(&record);
    lens_list_release(&lenses);
    camera_set_release(&set);
    return st;
}

int main(int argc, char **argv)
{
    const char *view = NULL, *photos = NULL, *masks = NULL, *records = NULL, *views = NULL, *out = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Resamples a photograph into its view's pinhole camera, in linear colour."),
        CLI_STR("view", &view, CLI_REQUIRED, "view to make"),
        CLI_STR("photos", &photos, CLI_REQUIRED, "folder of photographs, or of merged exposures"),
        CLI_STR("masks", &masks, CLI_OPTIONAL, "folder of masks ID.png, black where the view is to have no pixel"),
        CLI_STR("records", &records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras and lenses"),
        CLI_STR("out", &out, CLI_REQUIRED, "EXR to write"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "rectify", opts, &prov, &err) != CLI_RUN ||
        rectify(view, photos, masks, records, views, out, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
