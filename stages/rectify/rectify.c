/* rectify.c - resamples a photograph into its view's pinhole camera, in linear colour.
 *
 * reads   VIEWS/cameras.txt, images.txt, lenses.txt   the view's camera, and the photo's lens
 *         RECORDS/ID.txt, PHOTOS/FILE                 the photo; of a view of several exposures PHOTOS/ID.exr, merged
 *         MASKS/ID.png                                black where the view is to have no pixel; need not be there
 * writes  OUT                                         VIEW.exr: R G B (linear), A */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/cli.h"
#include "common/exr.h"
#include "common/file_path.h"
#include "common/lens_list.h"
#include "common/photo_list.h"
#include "common/photo_mask.h"
#include "common/view_image.h"
#include "stages/rectify/resample.h"

enum { RADIOMETRY_SIZE = 256 };

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

/* PHOTOS/FILE, scene-linear by the sRGB curve. */
static enum status read_photo(struct image *linear, const char *path, struct err *err)
{
    struct photo photo = {0};
    enum status st = photo_read(&photo, path, err);
    if (!st) st = photo_to_linear(linear, &photo, err);
    photo_release(&photo);
    return st;
}

/* What hdr_merge made of the photo's exposures. */
static enum status read_merged(struct image *linear, const char *path, char radiometry[RADIOMETRY_SIZE],
                               struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image exr = {0};
    enum status st = exr_read(&exr, path, names, 3, err);
    for (int c = 0; !st && c < 3; c++)
        if (!exr_find(&exr, names[c])->f)
            st = err_set(err, ST_DATA, "%s: channel %s holds integers, wanted half or float; merge the view again.",
                         path, names[c]);
    if (!st) st = image_init(linear, exr.width, exr.height, 3, err);
    for (size_t c = 0; !st && c < 3; c++) {
        const float *from = exr_find(&exr, names[c])->f;
        size_t pixels = (size_t)exr.width * (size_t)exr.height;
        for (size_t i = 0; i < pixels; i++) linear->data[3 * i + c] = fmaxf(from[i], 0);
    }
    const char *is = exr_attribute(&exr, "remodel:radiometry");
    if (!st && is) snprintf(radiometry, RADIOMETRY_SIZE, "%s", is);
    exr_image_release(&exr);
    return st;
}

static enum status read_source(struct image *linear, char radiometry[RADIOMETRY_SIZE], const char *photos,
                               const struct photo_record *record, struct provenance *prov, struct err *err)
{
    const bool merged = record->bracket_count > 0;
    const char *file = merged ? record->id : record->file, *suffix = merged ? ".exr" : "";
    char path[FILE_PATH];
    strcpy(radiometry, "approximate");
    enum status st = provenance_add_in(prov, merged ? "hdr" : "photos", photos, file, suffix, path, err);
    if (!st) st = merged ? read_merged(linear, path, radiometry, err) : read_photo(linear, path, err);
    return st;
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
    if (!st) st = read_source(&linear, radiometry, photos, &record, prov, err);
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
