/* rectify.c - resamples a photograph into its view's pinhole camera, in linear colour.
 *
 * reads   VIEWS/cameras.txt, images.txt, lenses.txt   the view's camera, and the photo's lens
 *         RECORDS/ID.txt, PHOTOS/FILE                 the photo
 * writes  OUT                                         VIEW.exr: R G B (linear), A */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "common/lens_list.h"
#include "common/photo_list.h"
#include "common/view_image.h"
#include "stages/rectify/resample.h"

/* The caller frees it. NULL: no memory. */
static char *joined(const char *folder, const char *file)
{
    size_t size = strlen(folder) + strlen(file) + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s/%s", folder, file);
    return path;
}

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

static enum status read_photo(struct image *linear, const char *photos, const char *file, struct provenance *prov,
                              struct err *err)
{
    struct photo photo = {0};
    char *path = joined(photos, file), *input = joined("photos", file);
    enum status st = path && input ? ST_OK : err_nomem(err, "a file name", strlen(photos) + strlen(file));
    if (!st) st = photo_read(&photo, path, err);
    if (!st) st = photo_to_linear(linear, &photo, err);
    if (!st) st = provenance_add_file(prov, input, path, err);
    photo_release(&photo);
    free(input);
    free(path);
    return st;
}

static enum status rectify(const char *name, const char *photos, const char *records, const char *views,
                           const char *out, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct lens_list lenses = {0};
    struct photo_record record = {0};
    struct image linear = {0}, rectified = {0};
    const struct view *view = NULL;
    const struct lens *lens = NULL;
    char *lens_path = joined(views, "lenses.txt");
    enum status st = lens_path ? ST_OK : err_nomem(err, "a file name", strlen(views));
    if (!st) st = camera_set_read(&set, views, err);
    if (!st) st = lens_list_read(&lenses, lens_path, err);
    if (!st) st = find_view(&view, &lens, &set, &lenses, name, views, err);
    if (!st) st = photo_record_read(&record, records, lens->photo, err);
    if (!st) st = read_photo(&linear, photos, record.file, prov, err);
    if (!st) {
        struct mat3 photo_from_view = mat3_transpose(mat3_from_quat(lens->view_from_photo));
        st = resample_photo(&rectified, &linear, &lens->camera, &photo_from_view, view, err);
        if (st) err_context(err, "%s/%s", photos, record.file);
    }
    if (!st) st = view_image_write(&rectified, out, view, prov, "approximate", err);
    image_release(&rectified);
    image_release(&linear);
    photo_record_release(&record);
    lens_list_release(&lenses);
    camera_set_release(&set);
    free(lens_path);
    return st;
}

int main(int argc, char **argv)
{
    const char *view = NULL, *photos = NULL, *records = NULL, *views = NULL, *out = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Resamples a photograph into its view's pinhole camera, in linear colour."),
        CLI_STR("view", &view, CLI_REQUIRED, "view to make"),
        CLI_STR("photos", &photos, CLI_REQUIRED, "folder of photographs"),
        CLI_STR("records", &records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras and lenses"),
        CLI_STR("out", &out, CLI_REQUIRED, "EXR to write"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "rectify", opts, &prov, &err) != CLI_RUN ||
        rectify(view, photos, records, views, out, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
