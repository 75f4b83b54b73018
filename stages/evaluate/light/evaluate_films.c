/* evaluate_films.c - how steady the light of relit films is: edited.E.flicker*. It needs no truth.
 *
 * Films are FOLDER/relight/E/tour: unlit/NNNN.exr, frames/NNNN.exr. A place on a surface has one quotient of light,
 * whatever the frame; what differs between a frame and the next is seen as flicker. */
#include "stages/evaluate/light/light_metrics.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stages/evaluate/light/flicker.h"

/* Adds the picture FILM/FOLDER/NAME to the inputs; path: it. */
static enum status add_picture(char path[FILE_PATH], struct evaluation *e, const char *film, const char *folder,
                               const char *name, struct err *err)
{
    char below[FILE_PATH], input[FILE_PATH];
    if (file_path(below, film, folder, "", err) || file_path(path, below, name, "", err)) return err->status;
    snprintf(input, sizeof input, "%.4000s", path + strlen(e->folder) + 1);
    return provenance_add_file(e->prov, input, path, err);
}

/* name: NNNN.exr. */
static enum status frame_read(struct film_frame *f, struct evaluation *e, const char *film, const char *name,
                              struct err *err)
{
    static const char *const channels[4] = {"R", "G", "B", "made"};
    struct exr_image relit = {0};
    char path[FILE_PATH];
    if (!add_picture(path, e, film, "unlit", name, err) && !model_picture_read(&f->unlit, path, NULL, err) &&
        !add_picture(path, e, film, "frames", name, err) && !exr_read(&relit, path, channels, 4, err))
        flicker_frame_set_quotients(f, &relit, path, err);
    exr_image_release(&relit);
    return err->status;
}

static int is_frame(const struct dirent *entry)
{
    const size_t digits = strspn(entry->d_name, "0123456789");
    return digits > 0 && !strcmp(entry->d_name + digits, ".exr");
}

static enum status compare_frames(struct quantiles *differences, uint64_t *places, struct evaluation *e,
                                  const char *film, struct err *err)
{
    struct film_frame frames[2] = {{.quotient = NULL}, {.quotient = NULL}};
    struct dirent **entries = NULL;
    char folder[FILE_PATH];
    if (file_path(folder, film, "frames", "", err)) return err->status;
    const int count = path_is_folder(folder) ? scandir(folder, &entries, is_frame, alphasort) : 0;
    if (count < 0) err_errno(err, "list", folder);
    for (int i = 0; i < count; i++) {
        if (!err->status) frame_read(&frames[i % 2], e, film, entries[i]->d_name, err);
        if (!err->status && i) *places += flicker_add(differences, &frames[(i + 1) % 2], &frames[i % 2]);
        free(entries[i]);
    }
    free(entries);
    flicker_frame_release(&frames[0]);
    flicker_frame_release(&frames[1]);
    return err->status;
}

static enum status measure_film(struct evaluation *e, const char *edit, const char *film, struct err *err)
{
    struct quantiles q;
    char prefix[300];
    uint64_t places = 0;
    if (!quantiles_init(&q, err)) compare_frames(&q, &places, e, film, err);
    snprintf(prefix, sizeof prefix, "edited.%.255s", edit);
    if (!err->status && places && !evaluation_metric(e, NULL, prefix, "flicker50", 100 * quantiles_get(&q, 0.5), err))
        evaluation_metric(e, NULL, prefix, "flicker95", 100 * quantiles_get(&q, 0.95), err);
    quantiles_release(&q);
    return err->status;
}

enum status evaluate_films(struct evaluation *e, struct err *err)
{
    char folder[FILE_PATH], below[FILE_PATH], film[FILE_PATH];
    struct dirent **entries = NULL;
    if (file_path(folder, e->folder, "relight", "", err)) return err->status;
    const int count = path_is_folder(folder) ? scandir(folder, &entries, NULL, alphasort) : 0;
    if (count < 0) err_errno(err, "list", folder);
    for (int i = 0; i < count; i++) {
        const char *edit = entries[i]->d_name;
        if (!err->status && edit[0] != '.') {
            if (!file_path(below, folder, edit, "", err)) file_path(film, below, "tour", "", err);
            if (!err->status && path_is_folder(film)) measure_film(e, edit, film, err);
        }
        free(entries[i]);
    }
    free(entries);
    return err->status;
}
