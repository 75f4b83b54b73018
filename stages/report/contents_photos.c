/* contents_photos.c - the list of photographs, their thumbnails, and photographs that are not in the list. */
#include "stages/report/contents_parts.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "stages/report/passing.h"

enum { PHOTO_HEIGHT = 200, MANY_PHOTOS = 100, PHOTO_HEIGHT_OF_MANY = 120 }; /* of thumbnails, px */

static bool is_photo_name(const char *name)
{
    const char *dot = strrchr(name, '.');
    return name[0] != '.' && dot && (!strcasecmp(dot, ".jpg") || !strcasecmp(dot, ".jpeg") || !strcasecmp(dot, ".png"));
}

/* Photographs of the folder that are not in the list. */
static enum status find_left_out(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    int count = scandir(folder, &names, NULL, alphasort);

    if (count < 0)
        return contents_note(c, err, "The folder of photographs cannot be read (%s), so there are no thumbnails.",
                             strerror(errno));
    for (int i = 0; i < count; i++) {
        const char *name = names[i]->d_name;
        if (!err->status && is_photo_name(name) && photo_list_find_file(&c->photos, name) < 0 &&
            !array_append(&c->left_out, (size_t)c->left_out_count, sizeof *c->left_out, "names of photos", err))
            snprintf(c->left_out[c->left_out_count++], sizeof *c->left_out, "%s", name);
        free(names[i]);
    }
    free(names);
    return err->status;
}

struct photo_job {
    struct contents *c;
    const char *folder, *shared;
    int height;
};

/* Merged exposures: their radiance, so that a twentieth of the pixels is white. */
static enum status read_merged(struct picture *p, const char *path, int orientation, int height, struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    struct exr_image im = {0};
    float *values = NULL;
    size_t n = 0;
    if (!exr_read(&im, path, NAMES, 3, err)) {
        const size_t size = (size_t)im.width * (size_t)im.height, step = size / 40000 + 1;
        const struct exr_plane *green = exr_find(&im, "G");
        values = malloc((size / step + 1) * sizeof *values);
        if (!values) err_nomem(err, "a thumbnail", size / step * sizeof *values);
        for (size_t i = 0; values && green->f && i < size; i += step) values[n++] = green->f[i];
        if (n) sort_floats(values, n);
        const float white = n ? values[n * 19 / 20] : 0;
        for (int k = 0; !err->status && white > 0 && k < im.count; k++)
            for (size_t i = 0; im.planes[k].f && i < size; i++) im.planes[k].f[i] /= white;
        if (!err->status) picture_from_exr(p, &im, orientation, height, err);
    }
    free(values);
    exr_image_release(&im);
    return err->status;
}

static void make_photo_cards(void *ctx, size_t begin, size_t end, int thread)
{
    const struct photo_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct photo_card *card = &job->c->photo_cards[i];
        struct photo photo = {0};
        struct err err = ERR_INIT;
        char path[PATH_SIZE], merged[FILE_PATH];
        snprintf(path, sizeof path, "%s/%s", job->folder, card->record->file);
        if (contents_product(merged, job->shared, PRODUCT_HDR, &(struct product_key){.photo = card->record->id}))
            read_merged(&card->picture, merged, card->record->info.orientation, job->height, &err);
        else if (!photo_read(&photo, path, &err))
            picture_from_photo(&card->picture, &photo, job->height, &err);
        if (err.status) snprintf(card->problem, sizeof card->problem, "%.*s", NOTE_SIZE - 1, err.text);
        photo_release(&photo);
    }
}

enum status contents_read_photos(struct contents *c, const char *shared, const char *folder, struct err *err)
{
    char path[PATH_SIZE];
    struct err problem = ERR_INIT;
    snprintf(path, sizeof path, "%s/photos", shared);
    if (photo_list_read(&c->photos, path, &problem))
        return contents_note(c, err, "There is no list of photographs. %s", problem.text);
    c->has_photos = true;
    c->photo_cards = calloc((size_t)c->photos.count + 1, sizeof *c->photo_cards);
    if (!c->photo_cards) return err_nomem(err, "photos", (size_t)c->photos.count * sizeof *c->photo_cards);
    for (int i = 0; i < c->photos.count; i++) c->photo_cards[i].record = &c->photos.photos[i];
    struct photo_job job = {c, folder, shared, c->photos.count > MANY_PHOTOS ? PHOTO_HEIGHT_OF_MANY : PHOTO_HEIGHT};
    if (path_is_folder(folder)) parallel_for((size_t)c->photos.count, 1, make_photo_cards, &job);
    for (int i = 0; i < c->photos.count; i++)
        if (passing_refuse(c->photo_cards[i].problem, err)) return err->status;
    return find_left_out(c, folder, err);
}
