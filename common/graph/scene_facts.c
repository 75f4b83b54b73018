/* scene_facts.c - see scene_facts.h. */
#include "common/graph/scene_facts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/product/product.h"

const char *scene_setting(const char *variable)
{
    char name[64];
    snprintf(name, sizeof name, "REMODEL_%s", variable);
    const char *value = getenv(name);
    return value ? value : "";
}

bool scene_setting_is(const char *variable, const char *value) { return !strcmp(scene_setting(variable), value); }

bool scene_asks_for(const struct scene_facts *f, const char *product) { return name_list_has(&f->products, product); }

/* Reads VARIABLE of a product that lists names for Make. */
static enum status read_list(struct name_list *list, const char *root, enum product_id id,
                             const struct product_key *key, const char *variable, struct err *err)
{
    char file[FILE_PATH], path[FILE_PATH];
    if (product_path(file, id, key, err) || file_path(path, root, file, "", err)) return err->status;
    return name_list_read(list, path, variable, err);
}

struct view_of_photo {
    const char *view;
    int photo_length, place;
};

/* By photo, then in the order of the list. */
static int by_photo(const void *a, const void *b)
{
    const struct view_of_photo *v = a, *w = b;
    const int n = v->photo_length < w->photo_length ? v->photo_length : w->photo_length;
    const int order = memcmp(v->view, w->view, (size_t)n);
    if (order) return order;
    if (v->photo_length != w->photo_length) return v->photo_length < w->photo_length ? -1 : 1;
    return v->place < w->place ? -1 : 1;
}

static bool same_photo(const struct view_of_photo *v, const struct view_of_photo *w)
{
    return v->photo_length == w->photo_length && !memcmp(v->view, w->view, (size_t)v->photo_length);
}

/* A view is called PHOTO or PHOTO@k. */
static enum status group_views(struct view_groups *groups, const struct name_list *views, struct err *err)
{
    const size_t count = (size_t)views->count;
    struct view_of_photo *sorted = calloc(count + 1, sizeof *sorted);
    groups->views = calloc(count + 1, sizeof *groups->views);
    groups->photos = calloc(count + 1, sizeof *groups->photos);
    if (!sorted || !groups->views || !groups->photos) err_nomem(err, "views", count);
    for (int i = 0; !err->status && i < views->count; i++)
        sorted[i] = (struct view_of_photo){views->names[i], (int)strcspn(views->names[i], "@"), i};
    if (!err->status && count) qsort(sorted, count, sizeof *sorted, by_photo);
    for (size_t i = 0; !err->status && i < count; i++) {
        groups->views[i] = sorted[i].view;
        if (!i || !same_photo(&sorted[i - 1], &sorted[i])) {
            if (!name_list_add(&groups->names, sorted[i].view, (size_t)sorted[i].photo_length, err))
                groups->photos[groups->count++].views = groups->views + i;
        }
        if (!err->status) groups->photos[groups->count - 1].count++;
    }
    for (int i = 0; !err->status && i < groups->count; i++) groups->photos[i].photo = groups->names.names[i];
    free(sorted);
    return err->status;
}

static void release_groups(struct view_groups *groups)
{
    free(groups->photos);
    free(groups->views);
    name_list_release(&groups->names);
}

/* The edits to draw and to relight: EDIT, or else those that DRAW names, or else all. */
static enum status read_edits(struct scene_facts *f, struct err *err)
{
    char path[FILE_PATH];
    struct name_list wanted = {0};
    if (file_path(path, f->folder, "model.txt", "", err)) return err->status;
    f->has_model = path_is_file(path);
    if (!f->has_model) return ST_OK;
    if (!file_path(path, f->folder, "edits", "", err)) name_list_add_files(&f->edits, path, "", ".txt", err);
    if (!err->status)
        name_list_add_words(&wanted, *scene_setting("EDIT") ? scene_setting("EDIT") : scene_setting("DRAW"), err);
    for (int i = 0; !err->status && i < f->edits.count; i++)
        if (!wanted.count || name_list_has(&wanted, f->edits.names[i]))
            name_list_add(&f->drawn_edits, f->edits.names[i], strlen(f->edits.names[i]), err);
    name_list_release(&wanted);
    return err->status;
}

/* The words of a setting, each once. */
static enum status read_words(struct name_list *list, const char *variable, struct err *err)
{
    if (!name_list_add_words(list, scene_setting(variable), err)) name_list_sort(list);
    return err->status;
}

/* The folders of the eyes below a film's: flat ones, and half-spheres. */
static enum status read_eyes(struct scene_facts *f, struct err *err)
{
    static const char *const folders[] = {"/left", "/right", "/vr180/left", "/vr180/right"};
    if (read_words(&f->eyes, "EYES", err)) return err->status;
    const bool sphere = name_list_has(&f->eyes, "vr180"), flat = f->eyes.count > sphere;
    for (int i = 0; !err->status && i < 4; i++)
        if (i < 2 ? flat : sphere) name_list_add(&f->eye_folders, folders[i], strlen(folders[i]), err);
    return err->status;
}

/* Lines `photo NAME in STATE` of states.txt; what else they may say is for light_levels to check. */
static enum status read_other_light(struct scene_facts *f, struct err *err)
{
    struct textfile t = {0};
    char path[FILE_PATH], *word;
    if (file_path(path, f->folder, "states.txt", "", err) || !path_is_file(path)) return err->status;
    if (textfile_open(&t, path, err)) return err->status;
    while (!err->status && textfile_next(&t)) {
        struct err unread = ERR_INIT;
        if (textfile_word(&t, "a statement", &word, &unread) || strcmp(word, "photo") != 0 ||
            textfile_word(&t, "a photo's name", &word, &unread) || !scan_is_photo_name(word))
            continue;
        if (!name_list_has(&f->other_light, word)) name_list_add(&f->other_light, word, strlen(word), err);
    }
    textfile_release(&t);
    return err->status;
}

enum status scene_facts_read(struct scene_facts *f, const char *scene_folder, const char *shared, const char *own,
                             const char *bin, struct err *err)
{
    const char *slash = strrchr(scene_folder, '/');
    struct name_list bracketed = {0};
    int64_t frames = 0;
    *f = (struct scene_facts){.scene = slash ? slash + 1 : scene_folder, .folder = scene_folder, .shared = shared};
    f->own = own;
    f->bin = bin;
    f->choose = scene_setting("CHOOSE");
    f->compares_held = *scene_setting("HOLDOUT") || *scene_setting("HOLDOUT_VIEWS");
    if (read_other_light(f, err)) return err->status;
    f->holds_out = f->compares_held || f->other_light.count > 0;
    f->frames_per_job =
        scan_int(scene_setting("FRAMES_PER_JOB"), &frames) && frames > 0 && frames < 1000000 ? (int)frames : 30;
    /* BUILD/bin has BUILD/code beside it */
    slash = strrchr(bin, '/');
    if (asprintf(&f->code, "%.*scode", slash ? (int)(slash + 1 - bin) : 0, bin) < 0) {
        f->code = NULL;
        return err_nomem(err, "a path", strlen(bin));
    }
    const struct product_key none = {0}, held = {.views = HELD_VIEWS}, references = {.records = "lri/photos"};
    (void)(name_list_add_words(&f->products, scene_setting("PRODUCTS"), err) ||
           name_list_add_words(&f->films, scene_setting("FILMS"), err) || read_words(&f->formats, "FILM", err) ||
           read_eyes(f, err) || read_list(&f->photos, shared, PRODUCT_PHOTOS_MK, &none, "PHOTO_IDS", err) ||
           read_list(&bracketed, shared, PRODUCT_PHOTOS_MK, &none, "BRACKETED", err) ||
           read_list(&f->references, shared, PRODUCT_PHOTOS_MK, &references, "PHOTO_IDS", err) ||
           read_list(&f->views, own, PRODUCT_VIEWS_MK, &none, "VIEWS", err) ||
           (f->holds_out && read_list(&f->held, own, PRODUCT_VIEWS_MK, &held, "VIEWS", err)) ||
           group_views(&f->viewpoints, &f->views, err) || group_views(&f->held_viewpoints, &f->held, err) ||
           read_edits(f, err));
    f->bracketed = bracketed.count > 0;
    f->is_pair = f->photos.count == 2 && !*scene_setting("EFFECT_NAMED");
    name_list_release(&bracketed);
    return err->status;
}

void scene_facts_release(struct scene_facts *f)
{
    struct name_list *lists[] = {&f->products,    &f->films, &f->photos,      &f->references,
                                 &f->views,       &f->held,  &f->other_light, &f->edits,
                                 &f->drawn_edits, &f->eyes,  &f->eye_folders, &f->formats};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) name_list_release(lists[i]);
    release_groups(&f->viewpoints);
    release_groups(&f->held_viewpoints);
    free(f->code);
    *f = (struct scene_facts){0};
}
