/* contents_photos.c - the list of photographs, their thumbnails, and photographs that are not in the list. */
#include "stages/report/contents_parts.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/base/array.h"
#include "common/base/parallel.h"

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
    const char *folder;
};

static void make_photo_cards(void *ctx, size_t begin, size_t end, int thread)
{
    const struct photo_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct photo_card *card = &job->c->photo_cards[i];
        struct photo photo = {0};
        struct err err = ERR_INIT;
        char path[PATH_SIZE];
        snprintf(path, sizeof path, "%s/%s", job->folder, card->record->file);
        if (photo_read(&photo, path, &err) || picture_from_photo(&card->picture, &photo, PICTURE_HEIGHT, &err))
            snprintf(card->problem, sizeof card->problem, "%.*s", NOTE_SIZE - 1, err.text);
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
    struct photo_job job = {c, folder};
    if (path_is_folder(folder)) parallel_for((size_t)c->photos.count, 1, make_photo_cards, &job);
    return find_left_out(c, folder, err);
}
